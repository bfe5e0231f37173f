// SPDX-License-Identifier: MIT
//
// The second reader on the sections for light, MIPS, SUNC and AMBI: it reads
// them, reports what the converter would not write, and opens and refuses what
// the core does.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "tap.h"
#include "spec_check.hpp"
#include "spec_reader.hpp"

extern "C" {
#include "support/asset_light.h"
}

using namespace reference;

namespace
{

using blob = std::vector<uint8_t>;

const density_cloud cloud = {24, 7};
const asset_light all_sections = {true, 2, true};

blob make_asset(int format, bool apron, const asset_light &light)
{
    asset_spec spec = asset_spec_of(3, 3, 3, format, density_in_cloud, &cloud);
    size_t size;
    spec.apron = apron;
    uint8_t *p = asset_add_light(asset_build(&spec, &size), &size, &light);
    const blob b(p, p + size);
    std::free(p);
    return b;
}

size_t section_at(const blob &b, uint32_t id)
{
    return asset_section(b.data(), id);
}

void seal(blob &b)
{
    asset_seal(b.data(), b.size());
}

/// Reading ///

// Of the mean's bits that say nothing of light, the builder has its own.
std::vector<std::string> findings_about_light(const blob &b)
{
    std::vector<std::string> lines;
    for (const std::string &line : check_asset(asset(b)))
        for (const char *kind : {"mips:", "sun:", "sky:"})
            if (line.compare(0, 4, std::string(kind), 0, 4) == 0)
                lines.push_back(line);
    return lines;
}

// A volume that lets all light through: every cell sees the whole sky.
void clear_sky(blob &b)
{
    const size_t at = section_at(b, BRUME_SECTION_AMBI);
    asset_put32(&b[at], 0);
    std::fill_n(b.begin() + static_cast<long>(at + 16), 27, uint8_t{255});
    seal(b);
}

void test_read(int format, bool apron, int spacing)
{
    blob b = make_asset(format, apron, {true, spacing, true});
    clear_sky(b);
    const asset a(b);
    tap_check(a.mip_levels() == 5 && a.mip_size(4).x == 2 && a.sun && a.sky &&
                  a.sun->spacing == 1 << spacing &&
                  a.sun->size.z == 24 >> spacing && a.sun->direction[1] == 1,
              "format %d, side %d, spacing %d: read", format, a.side,
              a.sun->spacing);
    const std::vector<std::string> lines = findings_about_light(b);
    tap_check(lines.empty(), "  the checks find nothing");
    for (const std::string &line : lines)
        std::printf("# %s\n", line.c_str());
}

// Accessors by hand: one brick of one density, in one of two cells.
void test_values()
{
    static const density_box box = {{8, 0, 0}, {16, 8, 8}, 128 * 256};
    asset_spec spec = asset_spec_of(2, 1, 1, BRUME_U8, density_in_box, &box);
    size_t size;
    uint8_t *p =
        asset_add_light(asset_build(&spec, &size), &size, &all_sections);
    const asset a(blob(p, p + size));
    std::free(p);
    // 180^2 < 128 * 256 <= 181^2; half of it: 128^2; and the same rules.
    tap_check(a.mip_levels() == 4 && a.mip_code(1, {3, 0, 0}) == 0 &&
                  a.mip_code(1, {4, 0, 0}) == 181 &&
                  a.mip_code(2, {3, 1, 1}) == 181 &&
                  a.mip_code(3, {0, 0, 0}) == 0 &&
                  a.mip_code(3, {1, 0, 0}) == 181,
              "codes of levels 1 to 3");
    tap_check(a.mip_code(4, {0, 0, 0}) == 63,
              "level 4: an eighth, as cells beyond the grid count");
    tap_check(std::fabs(a.mip_density(2, {3, 0, 0}) - 181 * 182 / 65280.0) <
                      1e-12 &&
                  a.mip_density(1, {8, 0, 0}) == 0 &&
                  a.mip_density(3, {-1, 0, 0}) == 0,
              "densities, 0 outside");
    // From y = 1.5 up: as much as at voxel 7, then down to 0 at 8.
    const double want = (5.5 + 0.5) * 128 * 256 / 65280.0;
    tap_check(std::fabs(a.sun_depth(255) - want) < 1e-6 &&
                  a.sun_code({2, 0, 0}) == 255 && a.sun_depth(0) == 0,
              "the deepest point has code 255, %g", a.sun_depth(255));
}

/// Reporting ///

bool reports(blob b, const std::string &kind)
{
    seal(b);
    const std::vector<std::string> lines = findings_about_light(b);
    return std::any_of(lines.begin(), lines.end(),
                       [&](const std::string &line) {
                           return line.compare(0, kind.size(), kind) == 0;
                       });
}

void test_reports()
{
    blob good = make_asset(BRUME_U8R, false, all_sections);
    clear_sky(good);
    const size_t mips = section_at(good, BRUME_SECTION_MIPS);
    const size_t mip_end =
        mips + asset_section_bytes(good.data(), BRUME_SECTION_MIPS);
    for (const size_t at : {mips, mips + 64, mip_end - 9 - 27, mip_end - 1}) {
        blob b = good;
        b[at]++;
        tap_check(reports(b, "mips"), "reported: byte %zu of MIPS", at - mips);
    }
    const size_t sun = section_at(good, BRUME_SECTION_SUNC);
    for (const size_t at : {sun + 7, sun + 19, sun + 32 + 100}) {
        blob b = good;
        b[at] = static_cast<uint8_t>(b[at] ^ 4);
        tap_check(reports(b, "sun"), "reported: byte %zu of SUNC", at - sun);
    }
    const size_t sky = section_at(good, BRUME_SECTION_AMBI);
    good[sky + 16 + 13]--;
    tap_check(reports(good, "sky"), "reported: a byte of AMBI");
}

/// Refusing ///

bool reader_opens(const blob &b)
{
    try {
        const asset a(b);
    } catch (const std::runtime_error &) {
        return false;
    }
    return true;
}

bool core_opens(const blob &b)
{
    brume_volume v;
    return brume_volume_open(&v, b.data(), b.size(), 0) == BRUME_OK;
}

uint32_t next_random(uint32_t &seed)
{
    seed ^= seed << 13;
    seed ^= seed >> 17;
    seed ^= seed << 5;
    return seed;
}

// Entries and heads with a bit or a byte changed. The core skips what it has
// no use for, so this is for a build with all of light.
void test_alike()
{
    uint32_t seed = 0x2545f491;
    int opened = 0, refused = 0, differ = 0;
    std::vector<blob> good;
    for (int i = 0; i < 6; i++)
        good.push_back(make_asset(1 + i % 3, i & 1, {true, 1 + i % 3, true}));
    for (size_t i = 0; i < 3000; i++) {
        blob b = good[i % 6];
        const uint32_t id[] = {BRUME_SECTION_MIPS, BRUME_SECTION_SUNC,
                               BRUME_SECTION_AMBI};
        const size_t entries = BRUME_HEADER_BYTES + 16 * (i % 3 ? 3 : 2);
        const bool head = next_random(seed) & 1;
        const size_t from =
            head ? section_at(b, id[next_random(seed) % 3]) : entries;
        const uint32_t r = next_random(seed);
        // The reader reports the last field of an entry, and does not refuse.
        const size_t at =
            head ? (r >> 8) % 32 : 16 * ((r >> 8) % 3) + (r >> 10) % 12;
        uint8_t &byte = b[from + at];
        byte =
            static_cast<uint8_t>(r & 1 ? r >> 24 : byte ^ 1U << (r >> 5 & 7));
        seal(b);
        const bool core = core_opens(b), reader = reader_opens(b);
        opened += core && reader;
        refused += !core && !reader;
        differ += core != reader;
    }
    tap_check(opened > 300 && refused > 300 && differ == 0,
              "3000 changed entries and heads: core and reader open %d and "
              "refuse %d, both the same",
              opened, refused);
}

} // namespace

int main()
{
    for (int spacing = 1; spacing <= 3; spacing++)
        for (bool apron : {false, true})
            test_read(spacing, apron, spacing);
    test_values();
    test_reports();
    test_alike();
    return tap_done();
}
