/* SPDX-License-Identifier: MIT */
/*
 * The lit march (core/brume_lit.c) as a whole: lighting that says nothing is
 * the plain march; leaping and cutting are invisible; octaves add up; and what
 * of a lighting is refused.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "brume_noise_tables.h"
#include "support/lit.h"
#include "tap.h"

#define ONE 0x10000u

enum { W = 48, H = 36, RAYS = W * H };

static struct brume_frame frame;
static struct brume_radiance first[RAYS], second[RAYS];

static int rays_hit(const struct brume_radiance *a, int n)
{
    int count = 0;
    for (int i = 0; i < n; i++)
        count += a[i].transmittance < 0x10000u && a[i].light > 0;
    return count;
}

/// The plain march ///

/* Lookup, clamp, light and jitter of a number below 48. */
static void choose_kernel(struct brume_scene *s, int number)
{
    static const uint16_t k_samples[] = {8, 40, 0};
    s->filter = (uint8_t)(number & 1);
    s->max_density = number & 2 ? BRUME_Q32(0.4) : 0;
    s->jitter = (uint8_t)(number >> 2 & 3);
    s->noise = BRUME_NOISE_WHITE;
    s->light = (uint8_t)(number >> 4);
    s->light_samples = k_samples[s->light];
}

/* The same words of light, transmittance and depth. */
static void check_plain(const struct lit_volume *v)
{
    struct brume_lighting l = lit_white();
    int differ = 0, hit = 0;
    for (int number = 0; number < 48; number++) {
        struct brume_scene s = lit_scene(v, W, H, NULL);
        choose_kernel(&s, number);
        s.albedo = 60001;
        s.min_transmittance = 655;
        s.min_density = BRUME_Q32(0.01);
        s.step = ONE + ONE / 3;
        s.frame = (uint32_t)number;
        lit_march(&frame, v, &s, first);
        s.lighting = &l;
        lit_march(&frame, v, &s, second);
        differ += lit_differing(first, second, RAYS);
        hit += rays_hit(first, RAYS);
    }
    tap_check(differ == 0 && hit > 48 * RAYS / 10,
              "%s: white light over 48 kernels is the plain march (%d of %d "
              "rays that hit differ)",
              v->name, differ, hit);
}

/// Leaping and cutting ///

enum kind {
    STOCHASTIC,
    CONE,
    CONE_TRILINEAR,
    CACHE,
    CACHE_STOCHASTIC,
    SKY,
    OCTAVES,
    KINDS
};
static const char *const kind_name[KINDS] = {
    "stochastic",       "cone",        "trilinear cone",           "cache",
    "stochastic cache", "sampled sky", "octaves and uniform light"};

/* A way of being lit, and what it needs. */
struct lit_kind {
    struct brume_lighting lighting;
    struct brume_cache cache;
    struct brume_phase phase[3];
};

static void choose_sky(struct brume_lighting *l)
{
    l->ambient = BRUME_AMBIENT_CUBE;
    l->visibility = BRUME_SKY_SAMPLED;
    l->visibility_samples = 5;
    l->visibility_step = ONE;
    l->directions = &brume_noise_hemisphere;
    l->zenith[0] = 1;
    l->zenith[1] = 3;
    for (uint32_t i = 0; i < 18; i++)
        l->ambient_colour[i / 3][i % 3] = ONE / 8 * (i % 7);
}

static void choose_octaves(struct lit_kind *k)
{
    const struct brume_phase_model m = {.g = 1 << 29};
    for (uint32_t i = 0; i < 3; i++)
        if (brume_phase_build(&k->phase[i], &m, i, ONE / 2) != BRUME_OK)
            abort();
    k->lighting.phase = k->phase;
    k->lighting.octaves = 3;
    k->lighting.octave_a = k->lighting.octave_b = ONE / 2;
    k->lighting.sun_colour[2] = ONE / 2;
    k->lighting.haze = 90 * ONE;
}

static void choose_kind(struct lit_kind *k, struct brume_scene *s, int kind)
{
    k->lighting = lit_white();
    s->lighting = &k->lighting;
    s->jitter = BRUME_JITTER_BOTH;
    s->noise = BRUME_NOISE_WHITE;
    if (kind == STOCHASTIC || kind == CACHE_STOCHASTIC || kind == SKY)
        s->filter = BRUME_STOCHASTIC;
    if (kind == CONE_TRILINEAR)
        s->filter = BRUME_TRILINEAR;
    if (kind == CONE || kind == CONE_TRILINEAR)
        s->light = BRUME_CONE;
    if (kind == CACHE || kind == CACHE_STOCHASTIC) {
        s->light = BRUME_CACHE;
        k->lighting.cache = &k->cache;
    }
    if (kind == SKY)
        choose_sky(&k->lighting);
    if (kind == OCTAVES) {
        choose_octaves(k);
        s->light = BRUME_UNIFORM;
        s->light_samples = 30;
    }
}

static void march_tiles(struct brume_radiance *out, unsigned w, unsigned h)
{
    memset(out, 0x5a, RAYS * sizeof *out);
    for (unsigned y = 0; y < H; y += h)
        for (unsigned x = 0; x < W; x += w)
            if (brume_march_rect(&frame, x, y, W - x < w ? W - x : w,
                                 H - y < h ? H - y : h, out + y * W + x,
                                 W) != BRUME_OK)
                abort();
}

static void check_kind(const struct lit_volume *v, int kind)
{
    static struct lit_kind k;
    struct brume_scene s = lit_scene(v, W, H, NULL);
    int skip = 0, tiles = 0, single = 0, hit = 0;
    if (brume_cache_baked(&k.cache, &v->volume) != BRUME_OK)
        abort();
    choose_kind(&k, &s, kind);
    for (uint32_t i = 0; i < 3; i++) {
        s.frame = 7 * i;
        s.step = BRUME_MIN_STEP << 2 * i;
        for (int a = 0; a < 3 && i > 0; a++) /* from the other side */
            s.eye[a] = 2 * s.target[a] - s.eye[a];
        s.skip = true;
        lit_march(&frame, v, &s, first);
        hit += rays_hit(first, RAYS);
        march_tiles(second, 7, 5);
        tiles += lit_differing(first, second, RAYS);
        march_tiles(second, 1, 1);
        single += lit_differing(first, second, RAYS);
        s.skip = false;
        if (brume_begin_frame(&frame, &v->volume, &s) != BRUME_OK)
            abort();
        frame.outlines = 0;
        march_tiles(second, W, H);
        skip += lit_differing(first, second, RAYS);
    }
    tap_check(skip == 0 && hit > RAYS / 2,
              "%s, %s: skip on == skip off (%d of %d rays that hit differ)",
              v->name, kind_name[kind], skip, hit);
    tap_check(tiles == 0 && single == 0,
              "%s, %s: whole == tiles == single rays (%d, %d)", v->name,
              kind_name[kind], tiles, single);
}

/// Octaves ///

/* Octave i by itself: extinction times a^i, albedo times b^i. a and b are 0,
 * 1/2 or 1, so both are exact, and the table is that of the sum. */
static void add_octave(const struct lit_volume *v, struct brume_scene s,
                       const struct brume_lighting *all, uint32_t i,
                       uint32_t *sum)
{
    struct brume_lighting l = lit_white();
    l.phase = &all->phase[i];
    l.octaves = 1;
    s.lighting = &l;
    for (uint32_t k = 0; k < i; k++) {
        s.light_density_scale = s.light_density_scale * all->octave_a / ONE;
        s.albedo = s.albedo * (all->octave_b / 2) / (ONE / 2);
    }
    lit_march(&frame, v, &s, second);
    for (int r = 0; r < RAYS; r++)
        sum[r] += second[r].light;
}

/* The largest difference between the sum of the octaves' images and the image
 * of them all, less its bound: each of the N + 1 images is rounded to half a
 * code, and products with b^i lose 8 * 2^-29 at most. */
static double octave_excess(const struct lit_volume *v, const uint32_t abc[3],
                            uint32_t *brightest)
{
    static struct brume_phase table[BRUME_MAX_OCTAVES];
    static uint32_t sum[RAYS];
    const struct brume_phase_model m = {.g = 3 << 28};
    struct brume_lighting l = lit_white();
    struct brume_scene s = lit_scene(v, W, H, &l);
    double excess = -1;
    s.light_density_scale = BRUME_Q32(0.0625);
    l.phase = table;
    l.octave_a = abc[0];
    l.octave_b = abc[1];
    memset(sum, 0, sizeof sum);
    for (uint32_t i = 0; i < BRUME_MAX_OCTAVES; i++)
        if (brume_phase_build(&table[i], &m, i, abc[2]) != BRUME_OK)
            abort();
    for (l.octaves = 1; l.octaves <= BRUME_MAX_OCTAVES; l.octaves++) {
        add_octave(v, s, &l, l.octaves - 1, sum);
        lit_march(&frame, v, &s, first);
        for (int r = 0; r < RAYS; r++) {
            double off = fabs((double)first[r].light - sum[r]);
            excess = fmax(excess, off - (l.octaves + 1) / 2.0 - 0.001);
            if (first[r].light > *brightest)
                *brightest = first[r].light;
        }
    }
    return excess;
}

static void check_octaves(const struct lit_volume *v)
{
    static const uint32_t k_factor[] = {0, ONE / 2, ONE};
    double excess = -1;
    uint32_t brightest = 0;
    for (int n = 0; n < 27; n++) {
        const uint32_t abc[] = {k_factor[n % 3], k_factor[n / 3 % 3],
                                k_factor[n / 9]};
        excess = fmax(excess, octave_excess(v, abc, &brightest));
    }
    tap_check(excess <= 0 && brightest > 2 * ONE && brightest < BRUME_MAX_LIGHT,
              "1 .. 8 octaves, a, b, c of 0, 1/2, 1: the sum of single ones "
              "(excess %.2f codes, brightest %.2f)",
              excess, brightest / 65536.0);
}

/// What is refused, and what is not ///

/* Just inside and just outside of a field's range. */
#define EXPECT(change, error) \
    do { \
        l = good; \
        s = lit_scene(v, 8, 6, &l); \
        change; \
        tap_check(brume_begin_frame(&frame, &v->volume, &s) == (error), \
                  "%s gives " #error, #change); \
    } while (0)

static void check_ranges(const struct lit_volume *v)
{
    struct brume_lighting good = lit_white(), l;
    struct brume_scene s;
    good.ambient = BRUME_AMBIENT_GRADIENT;
    EXPECT(l.octaves = BRUME_MAX_OCTAVES, BRUME_OK);
    EXPECT(l.octaves = BRUME_MAX_OCTAVES + 1, BRUME_ERR_SCENE);
    EXPECT(l.octave_a = l.octave_b = ONE, BRUME_OK);
    EXPECT(l.octave_a = ONE + 1, BRUME_ERR_SCENE);
    EXPECT(l.octave_b = ONE + 1, BRUME_ERR_SCENE);
    EXPECT(l.exposure = 0x100, BRUME_OK);
    EXPECT(l.exposure = 0xff, BRUME_ERR_SCENE);
    EXPECT(l.exposure = 16 * ONE, BRUME_OK);
    EXPECT(l.exposure = 16 * ONE + 1, BRUME_ERR_SCENE);
    EXPECT(l.sun_colour[2] = 16 * ONE, BRUME_OK);
    EXPECT(l.sun_colour[2] = 16 * ONE + 1, BRUME_ERR_SCENE);
    EXPECT(l.ambient_colour[1][0] = 16 * ONE, BRUME_OK);
    EXPECT(l.ambient_colour[1][0] = 16 * ONE + 1, BRUME_ERR_SCENE);
    EXPECT(l.ambient_colour[2][0] = 16 * ONE + 1, BRUME_OK); /* not used */
    EXPECT(l.ambient = BRUME_AMBIENT_CUBE, BRUME_OK);
    EXPECT(l.ambient = BRUME_AMBIENT_CUBE + 1, BRUME_ERR_SCENE);
    EXPECT(l.visibility = BRUME_SKY_BAKED, BRUME_OK);
    EXPECT(l.visibility = BRUME_SKY_BAKED + 1, BRUME_ERR_SCENE);
    EXPECT((l.sky = true, l.sky_zenith[0] = 16 * ONE), BRUME_OK);
    EXPECT((l.sky = true, l.sky_zenith[0] = 16 * ONE + 1), BRUME_ERR_SCENE);
    EXPECT((l.sky = true, l.sky_horizon[1] = 16 * ONE + 1), BRUME_ERR_SCENE);
    EXPECT((l.sky = true, l.sky_ground[2] = 16 * ONE + 1), BRUME_ERR_SCENE);
    EXPECT((l.sky = true, l.sun_disc[2] = 16 * ONE + 1), BRUME_ERR_SCENE);
    EXPECT(l.haze = ONE, BRUME_OK);
    EXPECT(l.haze = ONE - 1, BRUME_ERR_SCENE);
    EXPECT(l.haze = 0xffffffff, BRUME_OK);
    EXPECT(s.albedo = 0, BRUME_OK);
    EXPECT(s.albedo = ONE, BRUME_OK);
    EXPECT(s.albedo = ONE + 1, BRUME_ERR_SCENE);
    EXPECT(s.sun[1] = -99, BRUME_OK); /* below the horizon */
    EXPECT(memset(l.sun_colour, 0, sizeof l.sun_colour), BRUME_OK);
    EXPECT((s.light = BRUME_CONE, s.light_samples = 16), BRUME_OK);
    EXPECT((s.light = BRUME_CONE, s.light_samples = 17), BRUME_ERR_SAMPLES);
    EXPECT((s.filter = BRUME_STOCHASTIC), BRUME_OK);
    EXPECT((s.filter = BRUME_STOCHASTIC + 1), BRUME_ERR_SCENE);
}

static void check_visibility_ranges(const struct lit_volume *v)
{
    struct brume_direction_table t = brume_noise_hemisphere;
    struct brume_lighting good = lit_white(), l;
    struct brume_scene s;
    good.ambient = BRUME_AMBIENT_CONSTANT;
    good.visibility = BRUME_SKY_SAMPLED;
    good.visibility_step = ONE;
    good.directions = &t;
    EXPECT(l.visibility_samples = 0, BRUME_OK);
    EXPECT(l.visibility_samples = 16, BRUME_OK);
    EXPECT(l.visibility_samples = 17, BRUME_ERR_SCENE);
    EXPECT(l.visibility_step = BRUME_MIN_STEP, BRUME_OK);
    EXPECT(l.visibility_step = BRUME_MIN_STEP - 1, BRUME_ERR_SCENE);
    EXPECT(l.visibility_step = BRUME_MAX_STEP, BRUME_OK);
    EXPECT(l.visibility_step = BRUME_MAX_STEP + 1, BRUME_ERR_SCENE);
    EXPECT(l.directions = NULL, BRUME_ERR_SCENE);
    EXPECT(t.width_log2 = t.height_log2 = 3, BRUME_OK);
    EXPECT((t.width_log2 = 2, t.height_log2 = 3), BRUME_ERR_SCENE);
    EXPECT((t.width_log2 = 3, t.height_log2 = 2), BRUME_ERR_SCENE);
    EXPECT((t.width_log2 = t.height_log2 = 8), BRUME_OK);
    EXPECT((t.width_log2 = 9, t.height_log2 = 8), BRUME_ERR_SCENE);
    EXPECT((t.width_log2 = 8, t.height_log2 = 9), BRUME_ERR_SCENE);
    t.width_log2 = t.height_log2 = 5;
    EXPECT(t.frames_log2 = 6, BRUME_OK);
    EXPECT(t.frames_log2 = 7, BRUME_ERR_SCENE);
}

static void check_cache_ranges(const struct lit_volume *v)
{
    struct brume_lighting good = lit_white(), l;
    struct brume_cache baked, c;
    struct brume_scene s;
    if (brume_cache_baked(&baked, &v->volume) != BRUME_OK)
        abort();
    good.cache = &c;
#define EXPECT_OF_CACHE(change, error) \
    c = baked; \
    EXPECT((s.light = BRUME_CACHE, change), error)
    EXPECT_OF_CACHE(c.blend = ONE, BRUME_OK);
    EXPECT_OF_CACHE(c.blend = ONE + 1, BRUME_ERR_SCENE);
    EXPECT_OF_CACHE(c.from = NULL, BRUME_ERR_SCENE);
    EXPECT_OF_CACHE(c.to = NULL, BRUME_OK);
    EXPECT_OF_CACHE((c.to = NULL, c.blend = 1), BRUME_ERR_SCENE);
    EXPECT_OF_CACHE(c.spacing_log2 = 0, BRUME_ERR_SCENE);
    EXPECT_OF_CACHE(c.spacing_log2 = 4, BRUME_ERR_SCENE);
    EXPECT_OF_CACHE(c.spacing_log2 = 2, BRUME_ERR_SCENE);
    EXPECT_OF_CACHE(c.size[0] = 0, BRUME_ERR_SCENE);
    EXPECT_OF_CACHE(c.size[1]++, BRUME_ERR_SCENE);
    EXPECT_OF_CACHE(c.size[2]--, BRUME_ERR_SCENE);
    EXPECT_OF_CACHE(s.lighting = NULL, BRUME_ERR_SCENE);
#undef EXPECT_OF_CACHE
}

/* No light at all: nothing but what is lost. */
static void check_dark(const struct lit_volume *v)
{
    struct brume_lighting l = lit_white();
    struct brume_scene s = lit_scene(v, W, H, &l);
    int bad = 0, hit = 0;
    lit_march(&frame, v, &s, first);
    for (int n = 0; n < 2; n++) {
        if (n == 0)
            memset(l.sun_colour, 0, sizeof l.sun_colour);
        else
            s.albedo = 0;
        lit_march(&frame, v, &s, second);
        for (int i = 0; i < RAYS; i++) {
            bad += second[i].light != 0 ||
                   second[i].transmittance != first[i].transmittance ||
                   second[i].depth != first[i].depth;
            hit += second[i].transmittance < ONE;
        }
        l = lit_white();
    }
    tap_check(bad == 0 && hit > RAYS / 10,
              "a black sun and an albedo of 0: dark, else the same");
}

int main(void)
{
    for (int i = 0; i < LIT_CLOUDS; i++) {
        struct lit_volume v = lit_cloud(i);
        check_plain(&v);
        for (int kind = 0; kind < KINDS; kind++)
            check_kind(&v, kind);
        if (i == 1) {
            check_octaves(&v);
            check_ranges(&v);
            check_visibility_ranges(&v);
            check_cache_ranges(&v);
            check_dark(&v);
        }
        lit_volume_free(&v);
    }
    struct lit_volume v = lit_middle_cell();
    for (int kind = 0; kind < KINDS; kind++)
        check_kind(&v, kind);
    lit_volume_free(&v);
    return tap_done();
}
