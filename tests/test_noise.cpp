// SPDX-License-Identifier: MIT
//
// The noises: against the second implementation of docs/SPEC.md, against the
// formulas that they stand for, and by their statistics.
//
// Nothing here is left to chance: the noises are functions, so each figure is
// the same in every run. Where a noise should look random, the bound is five
// standard deviations of a random one: a sound generator passes, and a broken
// one misses it by far.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "noise.hpp"
#include "tap.h"

extern "C" {
#include "brume_inner.h"
}

namespace
{

struct kind {
    const char *name;
    int core;
    reference::noise reference;
};

const kind kinds[] = {
    {"none", BRUME_NOISE_NONE, reference::noise::none},
    {"white", BRUME_NOISE_WHITE, reference::noise::white},
    {"ign", BRUME_NOISE_IGN, reference::noise::ign},
    {"bayer8", BRUME_NOISE_BAYER8, reference::noise::bayer8},
    {"bayer4", BRUME_NOISE_BAYER4, reference::noise::bayer4},
    {"bayer16", BRUME_NOISE_BAYER16, reference::noise::bayer16},
    {"ign-thesis", BRUME_NOISE_IGN_THESIS, reference::noise::ign_thesis},
    {"rank1", BRUME_NOISE_RANK1, reference::noise::rank1},
    {"table", BRUME_NOISE_TABLE, reference::noise::table},
    {"table, golden", BRUME_NOISE_TABLE_GOLDEN, reference::noise::table_golden},
    {"table, r2", BRUME_NOISE_TABLE_R2, reference::noise::table_r2},
};

// A table without any symmetry, in both notations.
const reference::noise_table reference_table = [] {
    reference::noise_table t;
    t.width = 32;
    t.height = 16;
    t.frames = 4;
    uint32_t h = 1;
    for (uint32_t i = 0; i < 32 * 16 * 4; i++) {
        h = h * 1664525U + 1013904223U;
        t.values.push_back(static_cast<uint8_t>(h >> 24));
    }
    return t;
}();
const brume_noise_table core_table = {reference_table.values.data(), 5, 4, 2,
                                      8};

const uint32_t side = 256; // of the area that statistics are taken of
const double values = 65536;

uint32_t random_word()
{
    static uint32_t state = 0x9e3779b9U;
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state;
}

/// Reference ///

bool agrees(const kind &k, uint32_t x, uint32_t y, uint32_t frame)
{
    const uint32_t primary =
        brume_noise_value(k.core, &core_table, x, y, frame, 0);
    const uint32_t light =
        brume_noise_value(k.core, &core_table, x, y, frame, 1);
    return primary == reference::noise_value(k.reference, x, y, frame,
                                             reference::primary_channel,
                                             reference_table) &&
           light == reference::noise_value(k.reference, x, y, frame,
                                           reference::light_channel,
                                           reference_table) &&
           primary < 65536 && light < 65536;
}

// Coordinates and frames where something may wrap, in all combinations.
void test_reference_at_edges(const kind &k)
{
    const uint32_t at[] = {
        0,        1,           7,           8,           63,         64,
        95,       127,         128,         16383,       65535,      65536,
        1u << 24, 0x7fffffffU, 0x80000000U, 0xfffffff8U, 0xffffffffU};
    const uint32_t frames[] = {0,  1,   2,           63,          64,
                               65, 128, 0x7fffffffU, 0x80000000U, 0xffffffffU};
    int wrong = 0;
    for (const uint32_t x : at)
        for (const uint32_t y : at)
            for (const uint32_t frame : frames)
                wrong += !agrees(k, x, y, frame);
    tap_check(wrong == 0, "%s: the reference's at edges (%d wrong)", k.name,
              wrong);
}

void test_reference_at_random(const kind &k)
{
    int wrong = 0;
    for (int i = 0; i < 500000; i++) {
        const uint32_t x = random_word(), y = random_word();
        wrong += !agrees(k, x, y, random_word());
        wrong += !agrees(k, x % 16384, y % 16384, random_word() % 256);
    }
    tap_check(wrong == 0, "%s: the reference's at random (%d wrong)", k.name,
              wrong);
}

// Four bits to a value: the upper halves of a table's bytes, the lower ones
// from Bayer's matrix 4x4 at the place in the table.
void test_four_bits()
{
    static const uint32_t rows[4][4] = {
        {0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
    std::vector<uint8_t> packed;
    for (size_t i = 0; i < reference_table.values.size(); i += 2)
        packed.push_back(
            static_cast<uint8_t>(reference_table.values[i] >> 4 |
                                 (reference_table.values[i + 1] & 0xf0)));
    const brume_noise_table table = {packed.data(), 5, 4, 2, 4};
    int wrong = 0;
    for (uint32_t i = 0; i < 4 * 32 * 16; i++) {
        const uint32_t x = i % 32, y = i / 32 % 16, frame = i / 512;
        const uint32_t wide =
            brume_noise_value(BRUME_NOISE_TABLE, &core_table, x, y, frame, 0);
        wrong += brume_noise_value(BRUME_NOISE_TABLE, &table, x, y, frame, 0) !=
                 (wide & 0xf000) + 256 * rows[y % 4][x % 4] + 128;
    }
    tap_check(wrong == 0, "table of 4 bits (%d wrong)", wrong);
}

// What a frame with such a table would read beyond, or divide wrongly.
void test_tables_refused()
{
    const uint8_t *v = reference_table.values.data();
    const brume_noise_table bad[] = {{nullptr, 5, 4, 2, 8}, {v, 2, 4, 2, 8},
                                     {v, 9, 4, 2, 8},       {v, 5, 2, 2, 8},
                                     {v, 5, 9, 2, 8},       {v, 5, 4, 7, 8},
                                     {v, 5, 4, 2, 0},       {v, 5, 4, 2, 16}};
    bool refused = !brume_noise_usable(BRUME_NOISE_TABLE, nullptr) &&
                   !brume_noise_usable(BRUME_NOISE_TABLE_R2 + 1, &core_table);
    for (const brume_noise_table &t : bad)
        refused = refused && !brume_noise_usable(BRUME_NOISE_TABLE_R2, &t);
    tap_check(refused && brume_noise_usable(BRUME_NOISE_TABLE, &core_table) &&
                  brume_noise_usable(BRUME_NOISE_WHITE, nullptr),
              "tables of impossible sizes are refused");
}

void test_none()
{
    tap_check(brume_noise_value(BRUME_NOISE_NONE, nullptr, 3, 5, 7, 0) == 0 &&
                  brume_noise_value(BRUME_NOISE_NONE, nullptr, 3, 5, 7, 1) == 0,
              "none: zero");
}

/// Statistics ///

std::vector<double> area(int noise, uint32_t frame, uint32_t channel,
                         uint32_t left = 0, uint32_t top = 0)
{
    std::vector<double> out;
    for (uint32_t y = 0; y < side; y++)
        for (uint32_t x = 0; x < side; x++)
            out.push_back(brume_noise_value(noise, nullptr, left + x, top + y,
                                            frame, channel));
    return out;
}

double mean_of(const std::vector<double> &v)
{
    double sum = 0;
    for (const double x : v)
        sum += x;
    return sum / static_cast<double>(v.size());
}

// Pearson's coefficient.
double correlation(const std::vector<double> &a, const std::vector<double> &b)
{
    const double ma = mean_of(a), mb = mean_of(b);
    double aa = 0, ab = 0, bb = 0;
    for (size_t i = 0; i < a.size(); i++) {
        aa += (a[i] - ma) * (a[i] - ma);
        ab += (a[i] - ma) * (b[i] - mb);
        bb += (b[i] - mb) * (b[i] - mb);
    }
    return ab / std::sqrt(aa * bb);
}

double chi_square(const std::vector<double> &v, int bins)
{
    std::vector<double> count(static_cast<size_t>(bins));
    for (const double x : v)
        count[static_cast<size_t>(x * bins / values)]++;
    const double expected = static_cast<double>(v.size()) / bins;
    double sum = 0;
    for (const double n : count)
        sum += (n - expected) * (n - expected) / expected;
    return sum;
}

// The mean of n uniform values deviates by values / sqrt(12 n).
void test_white_mean()
{
    const double bound = 5 * values / std::sqrt(12.0) / side;
    for (const uint32_t frame : {0U, 1U, 64U, 0xffffffffU}) {
        const double mean = mean_of(area(BRUME_NOISE_WHITE, frame, 0));
        tap_check(std::fabs(mean - 32767.5) < bound,
                  "white, frame %u: mean %.1f, 32767.5 +- %.1f", frame, mean,
                  bound);
    }
}

// Chi-square of k bins has the mean k - 1 and the variance 2 (k - 1). The
// lower bound catches what is too even to be white.
void test_white_uniformity()
{
    const int bins = 256;
    const double spread = 5 * std::sqrt(2.0 * (bins - 1));
    for (uint32_t channel = 0; channel < 2; channel++) {
        const double x = chi_square(area(BRUME_NOISE_WHITE, 0, channel), bins);
        tap_check(std::fabs(x - (bins - 1)) < spread,
                  "white, channel %u: chi-square of %d bins %.1f, %d +- %.1f",
                  channel, bins, x, bins - 1, spread);
    }
}

// The coefficient of n independent pairs deviates by 1 / sqrt(n).
void check_uncorrelated(const char *what, const std::vector<double> &a,
                        const std::vector<double> &b)
{
    const double bound = 5.0 / side, r = correlation(a, b);
    tap_check(std::fabs(r) < bound, "white: %s correlate by %.4f < %.4f", what,
              r, bound);
}

void test_white_independence()
{
    const std::vector<double> here = area(BRUME_NOISE_WHITE, 5, 0);
    check_uncorrelated("channels", here, area(BRUME_NOISE_WHITE, 5, 1));
    check_uncorrelated("frames", here, area(BRUME_NOISE_WHITE, 6, 0));
    check_uncorrelated("columns", here, area(BRUME_NOISE_WHITE, 5, 0, 1, 0));
    check_uncorrelated("rows", here, area(BRUME_NOISE_WHITE, 5, 0, 0, 1));
}

/// Bayer ///

// Any 8x8 pixels, wherever cut, hold each level once, half a level off zero.
void test_bayer_levels()
{
    int wrong = 0;
    for (uint32_t at = 0; at < 128; at++) {
        std::vector<int> seen(64);
        for (uint32_t i = 0; i < 64; i++) {
            const uint32_t v =
                brume_noise_value(BRUME_NOISE_BAYER8, nullptr, 5 * at + i % 8,
                                  3 * at + i / 8, at, at & 1);
            wrong += v % 1024 != 512;
            seen[v / 1024]++;
        }
        wrong += std::count(seen.begin(), seen.end(), 1) != 64;
    }
    tap_check(wrong == 0, "bayer8: each of 64 levels once in any tile");
}

// The first rows of Bayer's matrix, as printed in 1973 and since.
void test_bayer_matrix()
{
    const uint32_t rows[2][8] = {{0, 32, 8, 40, 2, 34, 10, 42},
                                 {48, 16, 56, 24, 50, 18, 58, 26}};
    int wrong = 0;
    for (uint32_t y = 0; y < 2; y++)
        for (uint32_t x = 0; x < 8; x++)
            wrong += brume_noise_value(BRUME_NOISE_BAYER8, nullptr, x, y, 0,
                                       0) != 1024 * rows[y][x] + 512;
    tap_check(wrong == 0, "bayer8: the rows of Bayer's matrix");
}

// Neighbouring pixels dither apart: 2x2 pixels never share a quarter.
void test_bayer_quarters()
{
    int wrong = 0;
    for (uint32_t i = 0; i < 64; i++) {
        uint32_t seen = 0;
        for (uint32_t k = 0; k < 4; k++)
            seen |=
                1U << (brume_noise_value(BRUME_NOISE_BAYER8, nullptr,
                                         i % 8 + k % 2, i / 8 + k / 2, 0, 0) >>
                       14);
        wrong += seen != 15;
    }
    tap_check(wrong == 0, "bayer8: 2x2 pixels have a value in each quarter");
}

/// Interleaved gradient noise ///

double fraction(double v)
{
    return v - std::floor(v);
}

// The constants are rounded to 2^-33, which x, y and the frame multiply and
// then 52.98: 1085 * 2^-33 * 52.98 is 0.44 / 65536. Truncation loses one more.
void test_ign_formula()
{
    double worst = 0;
    for (uint32_t y = 0; y < 512; y++)
        for (uint32_t x = 0; x < 512; x++) {
            const uint32_t frame = (x + 13 * y) % 64;
            const double u = x + 5.588238 * frame, v = y + 5.588238 * frame;
            const double exact = fraction(
                52.9829189 * fraction(0.06711056 * u + 0.00583715 * v));
            const double j =
                brume_noise_value(BRUME_NOISE_IGN, nullptr, x, y, frame, 0) /
                values;
            const double off = fraction(exact - j + 0.5) - 0.5;
            worst = std::max(worst, std::fabs(off));
        }
    tap_check(worst * values < 1.44, "ign: %.3f < 1.44 units from the formula",
              worst * values);
}

void test_ign_period()
{
    int same = 0, differ = 0;
    for (uint32_t i = 0; i < 4096; i++) {
        const uint32_t x = i % 64, y = i / 64;
        const uint32_t j =
            brume_noise_value(BRUME_NOISE_IGN, nullptr, x, y, 0, 0);
        same += j == brume_noise_value(BRUME_NOISE_IGN, nullptr, x, y, 64, 0);
        differ += j != brume_noise_value(BRUME_NOISE_IGN, nullptr, x, y, 63, 0);
    }
    tap_check(same == 4096 && differ > 4000, "ign: 64 frames, then again");
}

// It is no random noise but a lattice, whose mean converges like 1 / n rather
// than 1 / sqrt(n): within a fifth of what white noise is allowed.
void test_ign_mean()
{
    const double bound = values / std::sqrt(12.0) / side;
    for (const uint32_t frame : {0U, 17U, 63U}) {
        const double mean = mean_of(area(BRUME_NOISE_IGN, frame, 0));
        tap_check(std::fabs(mean - 32767.5) < bound,
                  "ign, frame %u: mean %.1f, 32767.5 +- %.1f", frame, mean,
                  bound);
    }
}

// What it is for: any 3x3 pixels are spread over the whole range. Nine values
// of white noise have a mean that deviates by 0.096; these stay within it.
void test_ign_neighbours()
{
    double worst = 0;
    for (uint32_t y = 0; y < side; y++)
        for (uint32_t x = 0; x < side; x++) {
            double sum = 0;
            for (uint32_t k = 0; k < 9; k++)
                sum += brume_noise_value(BRUME_NOISE_IGN, nullptr, x + k % 3,
                                         y + k / 3, 0, 0);
            worst = std::max(worst, std::fabs(sum / 9 / values - 0.5));
        }
    tap_check(worst < 0.096, "ign: the mean of any 3x3 is within %.3f < 0.096",
              worst);
}

} // namespace

int main()
{
    for (const kind &k : kinds) {
        test_reference_at_edges(k);
        test_reference_at_random(k);
    }
    test_four_bits();
    test_tables_refused();
    test_none();
    test_white_mean();
    test_white_uniformity();
    test_white_independence();
    test_bayer_matrix();
    test_bayer_levels();
    test_bayer_quarters();
    test_ign_formula();
    test_ign_period();
    test_ign_mean();
    test_ign_neighbours();
    return tap_done();
}
