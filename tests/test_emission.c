/* SPDX-License-Identifier: MIT */
/*
 * Emission (core/brume_emission.h, section EMIT): what opens, what is refused,
 * and that damaged assets stay within their bytes; closed forms of what glows;
 * and that what has no part in it changes no byte.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/lit.h"
#include "tap.h"

#define ONE 0x10000u
#define FLIPS 4000

enum { W = 40, H = 30, RAYS = W * H };

static struct brume_frame frame;
static struct brume_radiance first[RAYS], second[RAYS];
static uint32_t colours[256][3];

/// Assets ///

/* A copy of a volume, all its density 0 when `dark`, all its codes `code` when
 * that is not negative, and the value of code 255 is 1. */
static struct lit_volume glowing(const struct lit_volume *of, bool dark,
                                 int code)
{
    struct lit_volume v = {.name = "glowing"};
    size_t size = of->volume.size;
    v.asset = malloc(size);
    if (v.asset == NULL)
        abort();
    memcpy(v.asset, of->asset, size);
    v.asset = asset_add_emission(v.asset, &size, 0x80000000u, -31);
    uint32_t bricks = asset_get32(v.asset + BRUME_OFF_BRICKS);
    uint8_t *codes = v.asset + asset_section(v.asset, BRUME_SECTION_EMIT) + 16;
    if (code >= 0)
        memset(codes, code, 512u * (size_t)bricks);
    if (dark)
        memset(v.asset + asset_section(v.asset, BRUME_SECTION_POOL), 0,
               asset_section_bytes(v.asset, BRUME_SECTION_POOL));
    if (dark && asset_section(v.asset, BRUME_SECTION_RNGE))
        memset(v.asset + asset_section(v.asset, BRUME_SECTION_RNGE), 0,
               4u * (size_t)bricks);
    asset_seal(v.asset, size);
    if (brume_volume_open(&v.volume, v.asset, size, 0) != BRUME_OK)
        abort();
    return v;
}

/* The code for a copy whose section is another one: `at` >= 0: a word of its
 * head; else its length. */
static int code_with(const struct lit_volume *v, int at, uint32_t value)
{
    struct brume_volume view;
    size_t size = v->volume.size;
    uint8_t *p = malloc(size);
    if (p == NULL)
        abort();
    memcpy(p, v->asset, size);
    if (at >= 0)
        asset_put32(p + asset_section(p, BRUME_SECTION_EMIT) + at, value);
    for (uint32_t i = 0; at < 0 && i < p[BRUME_OFF_SECTIONS]; i++) {
        uint8_t *e = p + BRUME_HEADER_BYTES + BRUME_SECTION_BYTES * i;
        if (asset_get32(e) == BRUME_SECTION_EMIT)
            asset_put32(e + 8, value);
    }
    asset_seal(p, size);
    int code = brume_volume_open(&view, p, size, 0);
    free(p);
    return code;
}

static void test_asset(const struct lit_volume *v)
{
    static const struct {
        const char *what;
        int at;
        uint32_t value;
        bool good;
    } k_head[] = {
        {"value m 1", 0, 1, false},
        {"value m 2^31-1", 0, 0x7fffffffu, false},
        {"value 0", 0, 0, true},
        {"value e -1025", 4, (uint32_t)-1025, false},
        {"value e 992", 4, 992, false},
        {"value e 991", 4, 991, true},
        {"first zero", 8, 1, false},
        {"second zero", 12, 0x80000000u, false},
        {"any code", 16, 0xffffffffu, true},
    };
    uint32_t bytes = asset_section_bytes(v->asset, BRUME_SECTION_EMIT);
    bool good = code_with(v, -1, bytes) == BRUME_OK;
    for (size_t i = 0; i < sizeof k_head / sizeof *k_head; i++)
        tap_check(code_with(v, k_head[i].at, k_head[i].value) ==
                      (k_head[i].good ? BRUME_OK : BRUME_ERR_SECTION),
                  "%s: %s", k_head[i].what,
                  k_head[i].good ? "opens" : "refused");
    for (uint32_t n = 0; n < bytes; n += n < 40 ? 1 : 499)
        good = good && code_with(v, -1, n) == BRUME_ERR_SECTION;
    tap_check(good, "any shorter length: refused");
    tap_check(v->volume.emission ==
                      v->asset + asset_section(v->asset, BRUME_SECTION_EMIT) +
                          16 &&
                  v->volume.emission_max.m == 0x80000000u,
              "the view has it");
}

/// Scenes ///

/* A black sun, and colours that fall with the code. */
static struct brume_lighting of_glow(double scale)
{
    struct brume_lighting l = {.emission_colour =
                                   (const uint32_t(*)[3])colours};
    l.emission_scale = (uint64_t)(scale * 4294967296.0);
    for (uint32_t i = 0; i < 256; i++)
        for (uint32_t c = 0; c < 3; c++)
            colours[i][c] = (i + 1u) * (ONE / 128u) >> c;
    return l;
}

static struct brume_scene scene_of(const struct lit_volume *v,
                                   const struct brume_lighting *l, int filter)
{
    struct brume_scene s = lit_scene(v, W, H, l);
    s.filter = (uint8_t)filter;
    s.jitter = BRUME_JITTER_BOTH;
    s.noise = BRUME_NOISE_WHITE;
    s.step = ONE + ONE / 5;
    return s;
}

/// What changes nothing ///

/* Emission of zeros, of scale 0, or without colours, and lighting without. */
static void test_nothing(const struct lit_volume *v, int filter)
{
    struct lit_volume dark = glowing(v, false, 0), lit = glowing(v, false, -1);
    struct brume_lighting l = of_glow(0.5), none = l;
    for (int c = 0; c < 3; c++)
        l.sun_colour[c] = none.sun_colour[c] = ONE - (uint32_t)c * 9999u;
    none.emission_colour = NULL;
    struct brume_scene s = scene_of(v, &none, filter);
    lit_march(&frame, v, &s, first);
    s.lighting = &l;
    lit_march(&frame, &dark, &s, second);
    int differ = lit_differing(first, second, RAYS);
    l.emission_scale = 0;
    lit_march(&frame, &lit, &s, second);
    differ += lit_differing(first, second, RAYS);
    s.lighting = &none;
    lit_march(&frame, &lit, &s, second);
    differ += lit_differing(first, second, RAYS);
    tap_check(differ == 0,
              "%s, filter %d: codes of 0, a scale of 0 and no colours are as "
              "without",
              v->name, filter);
    lit_volume_free(&dark);
    lit_volume_free(&lit);
}

/* What skipping, cutting and an apron have no part in. */
static void test_skip(const struct lit_volume *v, int filter)
{
    struct lit_volume lit = glowing(v, false, -1);
    struct brume_lighting l = of_glow(0.25);
    struct brume_scene s = scene_of(&lit, &l, filter);
    lit_march(&frame, &lit, &s, first);
    int differ = 0, glow = 0;
    for (int y = 0; y < H; y += 5)
        for (int x = 0; x < W; x += 8)
            brume_march_rect(&frame, (unsigned)x, (unsigned)y, 8, 5,
                             &second[y * W + x], W);
    differ += lit_differing(first, second, RAYS);
    s.skip = false;
    lit_march(&frame, &lit, &s, second);
    differ += lit_differing(first, second, RAYS);
    for (int i = 0; i < RAYS; i++)
        glow += first[i].light > first[i].blue && first[i].blue > 0;
    tap_check(differ == 0 && glow > RAYS / 10,
              "%s, filter %d: whole == tiles == without leaps (%d rays glow)",
              v->name, filter, glow);
    lit_volume_free(&lit);
}

/// Closed forms ///

/* Rays along z through the middle of a block: light of each channel is colour
 * * (1 - exp(-tau)), and what is left exp(-tau), with tau of whole steps. */
static void test_block(int filter, int code, double scale, uint32_t step)
{
    static const int k_cells[3] = {5, 5, 5}, k_low[3] = {8, 8, 8},
                     k_high[3] = {32, 32, 32};
    struct lit_volume block = lit_block(k_cells, k_low, k_high, 65280);
    struct lit_volume v = glowing(&block, true, code);
    struct brume_lighting l = of_glow(scale);
    for (int i = 0; i < 256; i++) /* faces of trilinear have other codes */
        memcpy(colours[i], colours[code], sizeof colours[i]);
    struct brume_scene s = lit_scene(&v, 1, 1, &l);
    s.filter = (uint8_t)filter;
    s.step = step;
    for (int i = 0; i < 3; i++)
        s.eye[i] = s.target[i] = 20 * (int32_t)ONE;
    s.eye[2] += 40 * (int32_t)ONE;
    lit_march(&frame, &v, &s, first);
    /* Of trilinear lookups the two faces are half of a block's, too. */
    double tau = scale * code / 255 * 24, gone = 1 - exp(-tau);
    /* A step more or less at either end, where it does not divide 24. */
    double slack = step == ONE || step == 2 * ONE || step == ONE / 2
                       ? 0
                       : tau / 24 * step / ONE * exp(-tau);
    bool good = true;
    const uint32_t light[3] = {first[0].light, first[0].green, first[0].blue};
    for (int c = 0; c < 3; c++) {
        double want = colours[code][c] * gone;
        want = want < BRUME_MAX_LIGHT ? want : BRUME_MAX_LIGHT;
        good = good && fabs(light[c] - want) <=
                           4 + slack * colours[code][c] + 2e-5 * want;
    }
    good = good &&
           fabs(first[0].transmittance / 65536.0 - exp(-tau)) <= slack + 3e-5;
    tap_check(good,
              "filter %d, code %d, tau %.4g, step %g: colour (1 - exp(-tau)): "
              "%u %u %u, %u left",
              filter, code, tau, step / 65536.0, light[0], light[1], light[2],
              first[0].transmittance);
    lit_volume_free(&v);
    lit_volume_free(&block);
}

/* Density and emission in one place, one sample, all of it lost: shares are
 * (1 - a)(1 + b) / 2 and (1 - b)(1 + a) / 2 of the ray. */
static void test_shares(double density_scale, double scale)
{
    static const int k_cells[3] = {5, 5, 5}, k_low[3] = {8, 8, 8},
                     k_high[3] = {32, 32, 32};
    struct lit_volume block = lit_block(k_cells, k_low, k_high, 65280);
    struct lit_volume v = glowing(&block, false, 255);
    struct brume_lighting l = of_glow(scale);
    for (uint32_t i = 0; i < 256; i++)
        colours[i][0] = colours[i][1] = colours[i][2] = 2 * ONE;
    for (int c = 0; c < 3; c++)
        l.sun_colour[c] = 3 * ONE;
    struct brume_scene s = lit_one_sample(&v, W, H, &l);
    s.light = BRUME_NO_LIGHT;
    s.density_scale = (uint64_t)(density_scale * 4294967296.0);
    lit_march(&frame, &v, &s, first);
    double a = exp(-density_scale * 256), b = exp(-scale * 256);
    double want = 3 * (1 - a) * (1 + b) / 2 + 2 * (1 - b) * (1 + a) / 2;
    double off = fabs(first[RAYS / 2 + W / 2].light / 65536.0 - want);
    double left = fabs(first[RAYS / 2 + W / 2].transmittance / 65536.0 - a * b);
    tap_check(off < 3e-5 && left < 2e-5,
              "shares of a = %.4f and b = %.4f: light %.5f, off by %.6f", a, b,
              want, off);
    lit_volume_free(&v);
    lit_volume_free(&block);
}

/* With albedo 0 what scatters gives nothing; exposure is emission's, too. */
static void test_albedo(const struct lit_volume *v)
{
    struct lit_volume lit = glowing(v, false, -1);
    struct brume_lighting l = of_glow(0.25);
    struct brume_scene s = scene_of(&lit, &l, BRUME_NEAREST);
    lit_march(&frame, &lit, &s, first);
    for (int c = 0; c < 3; c++)
        l.sun_colour[c] = 2 * ONE;
    s.albedo = 0;
    lit_march(&frame, &lit, &s, second);
    tap_check(lit_differing(first, second, RAYS) == 0,
              "albedo 0 under a bright sun is emission under a black one");
    l.exposure = 2 * ONE;
    lit_march(&frame, &lit, &s, second);
    int off = 0;
    for (int i = 0; i < RAYS; i++) {
        uint32_t twice = 2 * first[i].light;
        twice = twice < BRUME_MAX_LIGHT ? twice : BRUME_MAX_LIGHT;
        off += second[i].light + 1 < twice || second[i].light > twice + 1;
    }
    tap_check(off == 0, "an exposure of 2 is twice as bright");
    lit_volume_free(&lit);
}

static void test_limit(const struct lit_volume *v)
{
    struct lit_volume lit = glowing(v, false, 255);
    struct brume_lighting l = of_glow(1e6);
    struct brume_scene s = scene_of(&lit, &l, BRUME_TRILINEAR);
    uint32_t most = 0;
    colours[255][0] = colours[255][1] = colours[255][2] = 16 * ONE;
    l.exposure = 16 * ONE;
    lit_march(&frame, &lit, &s, first);
    for (int i = 0; i < RAYS; i++)
        most = first[i].light > most ? first[i].light : most;
    tap_check(most == BRUME_MAX_LIGHT, "the brightest is BRUME_MAX_LIGHT");
    lit_volume_free(&lit);
}

/// Refusals, and what is told apart ///

static void test_refusals(const struct lit_volume *v)
{
    struct lit_volume lit = glowing(v, false, -1);
    struct brume_lighting l = of_glow(0.25);
    struct brume_scene s = scene_of(&lit, &l, BRUME_NEAREST);
    int none = brume_begin_frame(&frame, &v->volume, &s);
    colours[200][1] = 16 * ONE + 1;
    int bright = brume_begin_frame(&frame, &lit.volume, &s);
    colours[200][1] = 16 * ONE;
    int good = brume_begin_frame(&frame, &lit.volume, &s);
    tap_check(none == BRUME_ERR_SECTION && bright == BRUME_ERR_SCENE &&
                  good == BRUME_OK,
              "refused: a volume without, and a colour above 16");
    lit_volume_free(&lit);
}

static void test_sameness(const struct lit_volume *v)
{
    struct lit_volume lit = glowing(v, false, -1);
    struct brume_lighting l = of_glow(0.25);
    struct brume_scene s = scene_of(&lit, &l, BRUME_NEAREST);
    uint32_t same[5];
    s.temporal = BRUME_TAA;
    s.history_bits = 16;
    s.alpha = ONE / 4;
    for (int i = 0; i < 5; i++) {
        l.emission_scale += i == 2;
        colours[77][2] += i == 3;
        l.exposure = i == 4 ? 2 * ONE : 0;
        if (brume_begin_frame(&frame, &lit.volume, &s) != BRUME_OK)
            abort();
        same[i] = frame.same;
    }
    tap_check(same[0] == same[1] && same[1] != same[2] && same[2] != same[3] &&
                  same[3] != same[4],
              "taa sees a change of scale, colours and exposure");
    lit_volume_free(&lit);
}

/// Damaged assets ///

static void flip_bits(uint8_t *p, size_t size, uint32_t *seed)
{
    int n = lit_between(seed, 1, 6);
    for (int i = 0; i < n; i++) {
        /* mostly in the heads, where it tells */
        size_t room = lit_between(seed, 0, 2) ? 320 : size;
        size_t at = ((size_t)lit_random(seed) * 37u + lit_random(seed)) % room;
        p[at] = (uint8_t)(p[at] ^ 1 << lit_between(seed, 0, 7));
    }
}

static bool renders(const struct brume_volume *v, uint32_t *seed)
{
    struct brume_lighting l = of_glow(0.25);
    struct lit_volume lit = {.volume = *v};
    struct brume_scene s =
        scene_of(&lit, &l, lit_between(seed, 0, BRUME_STOCHASTIC));
    for (int i = 0; i < 3; i++) {
        s.target[i] = v->cell_count[i] * 4 * (int32_t)ONE;
        s.eye[i] = s.target[i] + lit_between(seed, -60, 60) * (int32_t)ONE;
    }
    s.target[0]++; /* never the eye */
    s.width = 16;
    s.height = 12;
    return brume_begin_frame(&frame, v, &s) == BRUME_OK &&
           brume_march_rect(&frame, 0, 0, 16, 12, first, 16) == BRUME_OK;
}

static void test_flips(void)
{
    struct lit_volume good[LIT_CLOUDS];
    struct brume_volume v;
    uint32_t seed = 1;
    int opened = 0, refused = 0, drawn = 0;
    for (int i = 0; i < LIT_CLOUDS; i++) {
        struct lit_volume cloud = lit_cloud(i);
        good[i] = glowing(&cloud, i & 1, -1);
        lit_volume_free(&cloud);
    }
    for (int i = 0; i < FLIPS; i++) {
        size_t size = good[i % LIT_CLOUDS].volume.size;
        uint8_t *p = malloc(size);
        if (p == NULL)
            abort();
        memcpy(p, good[i % LIT_CLOUDS].asset, size);
        flip_bits(p, size, &seed);
        if (brume_volume_open(&v, p, size, BRUME_OPEN_NO_CRC) != BRUME_OK) {
            refused++;
        } else {
            opened++;
            drawn += v.emission != NULL && renders(&v, &seed);
        }
        free(p);
    }
    for (int i = 0; i < LIT_CLOUDS; i++)
        lit_volume_free(&good[i]);
    tap_check(opened > 300 && refused > 300 && drawn > 300,
              "%d assets with bits flipped: %d open, %d are refused, %d glow",
              FLIPS, opened, refused, drawn);
}

int main(void)
{
    struct lit_volume clouds[LIT_CLOUDS];
    for (int i = 0; i < LIT_CLOUDS; i++)
        clouds[i] = lit_cloud(i);
    struct lit_volume middle = lit_middle_cell();
    struct lit_volume lit = glowing(&clouds[1], false, -1);
    test_asset(&lit);
    for (int filter = BRUME_NEAREST; filter <= BRUME_STOCHASTIC; filter++) {
        for (int i = 0; i < LIT_CLOUDS; i++) {
            test_nothing(&clouds[i], filter);
            test_skip(&clouds[i], filter);
        }
        test_skip(&middle, filter);
    }
    for (int filter = BRUME_NEAREST; filter <= BRUME_TRILINEAR; filter++)
        for (int code = 1; code < 256; code += 63) {
            test_block(filter, code, 0.1, ONE);
            test_block(filter, code, 0.001, ONE / 2);
            test_block(filter, code, 2, 2 * ONE);
            test_block(filter, code, 0.02, 7 * ONE / 3);
        }
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            test_shares(i * i * i * 1e-3, j * j * j * 1e-3);
    test_albedo(&clouds[0]);
    test_limit(&clouds[2]);
    test_refusals(&clouds[0]);
    test_sameness(&clouds[0]);
    test_flips();
    lit_volume_free(&lit);
    lit_volume_free(&middle);
    for (int i = 0; i < LIT_CLOUDS; i++)
        lit_volume_free(&clouds[i]);
    return tap_done();
}
