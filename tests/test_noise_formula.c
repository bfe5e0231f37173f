/* SPDX-License-Identifier: MIT */
/* The noises that are formulas, and N-rooks sets. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "brume_inner.h"
#include "formula.h"
#include "measure.h"
#include "nrooks.h"
#include "tap.h"

static double value(const struct noise_texture *t, int x, int y, int frame)
{
    const uint32_t i = (uint32_t)x & (t->width - 1);
    const uint32_t j = (uint32_t)y & (t->height - 1);
    const uint32_t k = (uint32_t)frame & (t->frames - 1);
    return (t->values[(k * t->height + j) * t->width + i] + .5) / 256;
}

static uint32_t core_differences(const struct noise_texture *t, int noise)
{
    uint32_t differ = 0, i = 0;
    for (uint32_t frame = 0; frame < t->frames; frame++)
        for (uint32_t y = 0; y < t->height; y++)
            for (uint32_t x = 0; x < t->width; x++)
                differ += t->values[i++] !=
                          brume_noise_value(noise, NULL, x, y, frame, 0) >> 8;
    return differ;
}

static void test_core(void)
{
    struct noise_texture t;

    if (!noise_texture_make(&t, 256, 128, 64, 1))
        exit(1);
    noise_white(&t, 0);
    tap_check(core_differences(&t, BRUME_NOISE_WHITE) == 0,
              "white is the core's");
    noise_ign(&t, IGN_JIMENEZ);
    tap_check(core_differences(&t, BRUME_NOISE_IGN) == 0, "ign is the core's");
    noise_bayer(&t, 8);
    tap_check(core_differences(&t, BRUME_NOISE_BAYER8) == 0,
              "bayer8 is the core's");
    noise_texture_free(&t);
}

/* Whether each of n values, `step` apart and half a step off zero, is on as
 * many of the pixels as any other, in the side x side pixels at (x, y). */
static bool even(const struct noise_texture *t, uint32_t frame, uint32_t x,
                 uint32_t y, uint32_t side, uint32_t levels)
{
    uint32_t count[256] = {0};
    const uint32_t step = 256 / levels;

    for (uint32_t i = 0; i < side * side; i++)
        count[t->values[(frame * t->height + y + i / side) * t->width + x +
                        i % side]]++;
    for (uint32_t k = 0; k < levels; k++)
        if (count[k * step + step / 2] != side * side / levels)
            return false;
    return true;
}

static bool even_tiles(const struct noise_texture *t, uint32_t side,
                       uint32_t levels)
{
    for (uint32_t frame = 0; frame < t->frames; frame++)
        for (uint32_t y = 0; y < t->height; y += side)
            for (uint32_t x = 0; x < t->width; x += side)
                if (!even(t, frame, x, y, side, levels))
                    return false;
    return true;
}

static void test_ordered(void)
{
    struct noise_texture t;

    if (!noise_texture_make(&t, 32, 32, 8, 1))
        exit(1);
    for (uint32_t side = 4; side <= 16; side *= 2) {
        noise_bayer(&t, side);
        tap_check(even_tiles(&t, side, side * side),
                  "bayer%u: each level once in each tile", side);
    }
    noise_golden(&t);
    tap_check(even_tiles(&t, 16, 256) &&
                  memcmp(t.values, t.values + 1024, 1024) != 0,
              "golden: bayer16 keeps its histogram in other frames");
    noise_white8(&t, 1);
    tap_check(even_tiles(&t, 8, 64) &&
                  memcmp(t.values, t.values + 1024, 1024) != 0,
              "white8: each level once in each tile, another order per frame");
    noise_texture_free(&t);
}

/* R2's first point is (0.7549, 0.5698): 24 and 18 of 32 pixels. */
static void test_r2(void)
{
    struct noise_texture t;
    int wrong = 0;

    if (!noise_texture_make(&t, 32, 32, 4, 1))
        exit(1);
    noise_white(&t, 7);
    noise_r2(&t);
    for (int y = 0; y < 32; y++)
        for (int x = 0; x < 32; x++)
            wrong += value(&t, x, y, 1) != value(&t, x + 24, y + 18, 0);
    tap_check(wrong == 0, "r2: frame 1 is frame 0 moved by (24, 18)");
    noise_texture_free(&t);
}

/* Against its formula in double; and what it was chosen for: less error than
 * interleaved gradient noise under every filter. */
static void test_rank1(void)
{
    struct noise_texture t;
    struct noise_measures ign, m;
    double worst = 0;
    int better = 0;

    if (!noise_texture_make(&t, 128, 128, 32, 1))
        exit(1);
    noise_ign(&t, IGN_JIMENEZ);
    noise_measure(&t, &ign);
    noise_rank1(&t);
    noise_measure(&t, &m);
    for (int i = 0; i < 128 * 128 * 32; i++) {
        const int x = i % 128, y = i / 128 % 128, frame = i / 128 / 128;
        const double v = .80014635 * x + .66377714 * y + .28119233 * frame;
        const double off = value(&t, x, y, frame) - v;
        worst = fmax(worst, fabs(off - floor(off + .5)));
    }
    for (int f = 0; f < MEASURE_FILTERS; f++)
        better += m.rmse[f] < ign.rmse[f];
    tap_check(worst < .501 / 256, "rank1: %.4f / 256 from its formula",
              worst * 256);
    tap_check(better == MEASURE_FILTERS && m.gradient[0] < ign.gradient[0] &&
                  m.gradient[1] < ign.gradient[1],
              "rank1: every RMSE below interleaved gradient noise's");
    noise_texture_free(&t);
}

/// Bytes ///

/* FNV-1a: the same on every machine. */
static uint32_t hash(const struct noise_texture *t)
{
    uint32_t h = 2166136261u;
    for (size_t i = 0; i < noise_texture_bytes(t); i++)
        h = (h ^ t->values[i]) * 16777619u;
    return h;
}

static void check_hash(const char *name, const struct noise_texture *t,
                       uint32_t expected)
{
    tap_check(hash(t) == expected, "%s: hash %08x", name, hash(t));
}

static void test_hashes(void)
{
    struct noise_texture t;

    if (!noise_texture_make(&t, 32, 16, 8, 1))
        exit(1);
    noise_white(&t, 9);
    check_hash("white, seed 9", &t, 0x9e423d7a);
    noise_r2(&t);
    check_hash("the same and r2", &t, 0xf2801de9);
    noise_white8(&t, 9);
    check_hash("white8, seed 9", &t, 0x406df705);
    noise_ign(&t, IGN_THESIS);
    check_hash("ign-thesis", &t, 0x71dfa86f);
    noise_golden(&t);
    check_hash("the same and golden", &t, 0x052180e7);
    noise_rank1(&t);
    check_hash("rank1", &t, 0x20516321);
    noise_texture_free(&t);
}

/// N-rooks ///

static uint32_t torus(int a, int b, int n)
{
    const int d = abs(a - b);
    return (uint32_t)(2 * d > n ? n - d : d);
}

static uint32_t least_distance(const struct nrooks *set, int n)
{
    uint32_t least = UINT32_MAX;
    for (int a = 0; a < n; a++)
        for (int b = 0; b < a; b++) {
            const uint32_t dx = torus(set->column[a], set->column[b], n);
            const uint32_t dy = torus(a, b, n);
            least = dx * dx + dy * dy < least ? dx * dx + dy * dy : least;
        }
    return least;
}

/* Bit i of the result is set when i is among the n numbers. */
static uint32_t members(const uint8_t *number, int n)
{
    uint32_t seen = 0;
    for (int i = 0; i < n; i++)
        seen |= 1u << number[i];
    return seen;
}

static void test_nrooks(void)
{
    /* The best of all sets: 5, 10 and 13 are where lattices of knight's
     * moves and the like exist; no n points can be sqrt(1.1548 n) apart. */
    int wrong = 0, near = 0;
    struct nrooks set;

    for (int n = 1; n <= NROOKS_MAX; n++) {
        const uint32_t all = (1u << n) - 1;
        noise_nrooks(&set, (uint32_t)n);
        wrong += members(set.column, n) != all || members(set.order, n) != all;
        near += n > 1 && least_distance(&set, n) != set.distance;
    }
    tap_check(wrong == 0, "n-rooks: one point per row and column, n = 1 .. 16");
    tap_check(near == 0, "n-rooks: the distances are what the sets say");
    noise_nrooks(&set, 5);
    tap_check(set.distance == 5, "n-rooks: five points a knight's move apart");
}

/* The committed table is what the generator writes. */
static void test_nrooks_table(void)
{
    FILE *is = fopen("core/brume_nrooks.c", "rb"), *should = tmpfile();
    int a = 0, b = 0;

    if (!is || !should) {
        tap_check(0, "core/brume_nrooks.c can be read");
        return;
    }
    noise_nrooks_write(should, "brume-noise nrooks");
    rewind(should);
    while (a == b && a != EOF) {
        a = getc(is);
        b = getc(should);
    }
    tap_check(a == b, "core/brume_nrooks.c is what its generator writes");
    fclose(is);
    fclose(should);
}

int main(void)
{
    test_core();
    test_ordered();
    test_r2();
    test_rank1();
    test_hashes();
    test_nrooks();
    test_nrooks_table();
    return tap_done();
}
