/* SPDX-License-Identifier: MIT */
/*
 * light = cache (core/brume_cache.c): codes against integrals in double, the
 * depth that a code stands for, blending, what is refused; and how far images
 * of a cache are from those of the light it was made with.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/lit.h"
#include "tap.h"

#define ONE 0x10000u
#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

enum { W = 64, H = 48, RAYS = W * H };

static struct brume_frame frame;
static struct brume_radiance first[RAYS], second[RAYS];

static double number(struct brume_number n)
{
    return ldexp(n.m, n.e);
}

/// Codes ///

static uint32_t rows_of(const struct lit_cache *m)
{
    return (uint32_t)m->cache.size[1] * m->cache.size[2];
}

static void begin(const struct lit_volume *v, const struct brume_scene *s)
{
    if (brume_begin_frame(&frame, &v->volume, s) != BRUME_OK)
        abort();
}

/* Uniform light of steps of half a voxel, through the whole pool. */
static struct brume_scene uniform_scene(const struct lit_volume *v,
                                        const struct brume_lighting *l)
{
    struct brume_scene s = lit_scene(v, W, H, l);
    s.light = BRUME_UNIFORM;
    s.light_step = ONE / 2;
    s.light_samples = 200;
    return s;
}

static void check_rows(const struct lit_volume *v)
{
    struct brume_lighting l = lit_white();
    struct brume_scene s = uniform_scene(v, &l);
    for (unsigned spacing = 1; spacing <= 3; spacing++) {
        struct lit_cache whole = lit_cache_made(&frame, v, &s, spacing);
        struct lit_cache cut = lit_cache_room(v, spacing);
        uint32_t rows = rows_of(&whole), row = rows, seed = spacing;
        while (row > 0) { /* from the end, 0 to 9 rows at a time */
            uint32_t n = lit_random(&seed) % 10;
            n = n < row ? n : row;
            row -= n;
            if (brume_cache_rows(&cut.cache, cut.codes, &frame, row, n) !=
                BRUME_OK)
                abort();
        }
        tap_check(memcmp(whole.codes, cut.codes, whole.size) == 0,
                  "%s, spacing %d: %u rows in any cuts", v->name, 1 << spacing,
                  rows);
        free(whole.codes);
        free(cut.codes);
    }
}

/* How much of the way from p along `way` (unit) is in the box low .. high. */
static double way_inside(const double p[3], const double way[3],
                         const double low[3], const double high[3])
{
    double in = 0, out = 1e9;
    for (int i = 0; i < 3; i++) {
        double a = (low[i] - p[i]) / way[i], b = (high[i] - p[i]) / way[i];
        in = fmax(in, fmin(a, b));
        out = fmin(out, fmax(a, b));
    }
    return out > in ? out - in : 0;
}

/* Codes of a block of density 1, against the way through it: half a code is
 * log(2) / 48 = 1.45 % of 1 + depth / unit, and the samples' sum is a step of
 * 1/16 off at most on either face. */
static void check_integrals(void)
{
    const int cells[3] = {4, 5, 3}, from[3] = {6, 9, 4}, to[3] = {24, 30, 19};
    const double low[3] = {5.5, 8.5, 3.5}, high[3] = {23.5, 29.5, 18.5};
    struct lit_volume v = lit_block(cells, from, to, 65280);
    struct brume_lighting l = lit_white();
    struct brume_scene s = uniform_scene(&v, &l);
    const double length = sqrt(9 + 25 + 4),
                 way[3] = {3 / length, 5 / length, -2 / length};
    s.sun[0] = 3;
    s.sun[1] = 5;
    s.sun[2] = -2;
    s.light_step = ONE / 16;
    s.light_samples = 2000;
    for (unsigned spacing = 1; spacing <= 3; spacing++) {
        struct lit_cache m = lit_cache_made(&frame, &v, &s, spacing);
        const uint16_t *n = m.cache.size;
        double worst = 0, unit = number(m.cache.unit);
        int width = 1 << spacing, most = 0;
        for (int i = 0; i < n[0] * n[1] * n[2]; i++) {
            int at[3] = {i % n[0], i / n[0] % n[1], i / n[0] / n[1]};
            double p[3];
            for (int a = 0; a < 3; a++)
                p[a] = (at[a] + 0.5) * width - 0.5;
            double have = unit * (exp2(m.codes[i] / 24.0) - 1);
            double want = way_inside(p, way, low, high);
            worst = fmax(worst, (fabs(have - want) - 0.125) / (unit + want));
            most = m.codes[i] > most ? m.codes[i] : most;
        }
        tap_check(worst < 0.0146 && most > 150,
                  "block, spacing %d: codes are the way through it, within "
                  "%.2f %% of unit + way and 1/8 voxel",
                  width, 100 * worst);
        free(m.codes);
    }
    lit_volume_free(&v);
}

/// Looking up ///

static struct lit_volume full_block(void)
{
    return lit_block((const int[]){2, 3, 2}, (const int[]){0, 0, 0},
                     (const int[]){16, 24, 16}, 65280);
}

/* Light of one ray over an opacity of 1, where all of the cache has one depth,
 * less exp(-scale * depth); in units of its bound. unit + depth is rounded to
 * 2^-14 of itself, tau to 2^-12, a factor of exp(-tau) to 2^-15 and light to
 * 2^-16. */
static double error_of_depth(const struct lit_volume *v, struct brume_scene *s,
                             double unit, double depth)
{
    double scale = depth > 1.0 / 64 ? 1 / depth : 64; /* errors show best */
    s->light_density_scale = (uint64_t)(scale * 4294967296.0);
    lit_march(&frame, v, s, first);
    double want = exp(-scale * depth);
    double bound =
        want * (scale * (unit + depth) * ldexp(1, -14) + ldexp(1, -13)) +
        ldexp(1, -15) + ldexp(1, -17);
    return fabs(first[0].light / 65536.0 - want) / bound;
}

static void check_code_values(void)
{
    struct lit_volume v = full_block();
    struct brume_lighting l = lit_white();
    struct brume_scene s = lit_scene(&v, 1, 1, &l);
    struct lit_cache from = lit_cache_room(&v, 1), to = lit_cache_room(&v, 1);
    double worst = 0, worst_blend = 0, unit = number(from.cache.unit);
    s.light = BRUME_CACHE;
    s.density_scale = BRUME_Q32(8);
    l.cache = &from.cache;
    for (int filter = 0; filter < 3; filter++)
        for (int q = 0; q < 256; q++) {
            int other = (q * 89 + 31) % 256;
            double depth = unit * (exp2(q / 24.0) - 1);
            double beyond = unit * (exp2(other / 24.0) - 1);
            s.filter = (uint8_t)filter;
            memset(from.codes, q, from.size);
            memset(to.codes, other, to.size);
            from.cache.to = to.codes;
            from.cache.blend = 0;
            worst = fmax(worst, error_of_depth(&v, &s, unit, depth));
            from.cache.blend = 0x4000;
            depth += (beyond - depth) / 4;
            worst_blend =
                fmax(worst_blend, error_of_depth(&v, &s, unit, depth));
        }
    tap_check(worst <= 1, "each code: exp(-tau) within %.2f of its bound",
              worst);
    tap_check(worst_blend <= 1, "a quarter of the way to another: within %.2f",
              worst_blend);
    free(from.codes);
    free(to.codes);
    lit_volume_free(&v);
}

/* Depth of the cache at p, over its unit, plus 1: trilinear, or that of the
 * nearest point. *range is how far apart the eight are, 1e9 where the nearest
 * one cannot be told. */
static double depth_at(const struct brume_cache *c, const double p[3], bool tri,
                       double *range)
{
    double sum = 0, low = 1e9, high = 0, width = 1 << c->spacing_log2;
    bool near = false;
    for (int n = 0; n < 8; n++) {
        double w = 1;
        int at[3];
        for (int a = 0; a < 3; a++) {
            double q = (p[a] + 0.5) / width - 0.5, part;
            q = fmin(fmax(q, 0), c->size[a] - 1);
            part = q - floor(q);
            near = near || fabs(part - 0.5) < 1.0 / 256;
            part = tri ? part : floor(part + 0.5);
            at[a] = (int)q + (n >> a & 1);
            at[a] = at[a] < c->size[a] ? at[a] : c->size[a] - 1;
            w *= n >> a & 1 ? part : 1 - part;
        }
        double x = exp2(
            c->from[(at[2] * c->size[1] + at[1]) * c->size[0] + at[0]] / 24.0);
        sum += w * x;
        low = fmin(low, x);
        high = fmax(high, x);
    }
    *range = tri ? high - low : near ? 1e9 : 0;
    return sum;
}

/* Random codes, seen by one sample a ray. Besides what is said above, weights
 * are cut to 1/256 on three axes. */
static void check_positions(void)
{
    struct lit_volume v = full_block();
    struct brume_lighting l = lit_white();
    uint32_t seed = 1;
    double worst[2] = {0, 0};
    int samples = 0;
    for (int n = 0; n < 6; n++) {
        struct lit_cache m = lit_cache_room(&v, 1 + (unsigned)n % 3);
        struct brume_scene s = lit_one_sample(&v, W, H, &l);
        double unit = number(m.cache.unit);
        bool tri = n / 3;
        for (size_t i = 0; i < m.size; i++)
            m.codes[i] = (uint8_t)lit_between(&seed, 100, 112);
        s.light = BRUME_CACHE;
        s.filter = tri ? BRUME_TRILINEAR : BRUME_NEAREST;
        s.light_density_scale = (uint64_t)(4294967296.0 / (unit * 30));
        l.cache = &m.cache;
        lit_march(&frame, &v, &s, first);
        for (int i = 0; i < RAYS; i++) {
            double p[3], range;
            if (first[i].transmittance != 0)
                continue;
            lit_sample_position(&s, i % W, i / W, p);
            double x = depth_at(&m.cache, p, tri, &range);
            double slack = 3 * range / 256 + x * ldexp(1, -14);
            double off = x - 1 + 30 * log(first[i].light / 65536.0);
            if (range < 1e9)
                worst[tri] =
                    fmax(worst[tri], fabs(off) / (slack + 30 * ldexp(1, -12)));
            samples += range < 1e9;
        }
        free(m.codes);
    }
    tap_check(worst[0] <= 1 && worst[1] <= 1 && samples > 4000,
              "depths at %d places: nearest within %.2f of the bound, "
              "trilinear %.2f",
              samples, worst[0], worst[1]);
    lit_volume_free(&v);
}

/// Images ///

/* In a medium that fills the pool depth is linear along the sun and the same
 * across it. Points are half a spacing away at most, or the two on
 * either side. Half a light step of either image, and a rounded code: log(2) /
 * 48 of unit + depth. */
static void check_block_images(void)
{
    struct lit_volume v = full_block();
    struct brume_lighting l = lit_white();
    for (int n = 0; n < 6; n++) {
        unsigned spacing = 1 + (unsigned)n % 3;
        struct brume_scene s = uniform_scene(&v, &l);
        s.filter = (uint8_t)(n / 3);
        s.sun[0] = s.sun[2] = 0;
        s.light_density_scale = BRUME_Q32(0.0625);
        struct lit_cache m = lit_cache_made(&frame, &v, &s, spacing);
        double unit = number(m.cache.unit), worst = 0, square = 0;
        double apart = (1 << spacing) / 2.0 + 0.5;
        double bound = (apart + 0.0145 * (unit + 24)) / 16 + ldexp(1, -13);
        lit_march(&frame, &v, &s, first);
        s.light = BRUME_CACHE;
        l.cache = &m.cache;
        lit_march(&frame, &v, &s, second);
        for (int i = 0; i < RAYS; i++) {
            double lost = 1 - first[i].transmittance / 65536.0;
            double off = ((double)second[i].light - first[i].light) / 65536;
            square += off * off / RAYS;
            worst = fmax(worst, fabs(off) - bound * lost - ldexp(1, -16));
        }
        tap_check(worst <= 0 && lit_differing(first, second, RAYS) > RAYS / 4,
                  "block, spacing %d, %s: light within %.3f of what is lost; "
                  "RMSE %.5f",
                  1 << spacing, n / 3 ? "trilinear" : "nearest", bound,
                  sqrt(square));
        free(m.codes);
    }
    lit_volume_free(&v);
}

/* The cloud has no bound of its own: images get worse with the spacing, and
 * trilinear ones are better than those of the nearest point. */
static void check_cloud_images(const struct lit_volume *v)
{
    double rmse[2][3];
    for (int n = 0; n < 6; n++) {
        struct brume_lighting l = lit_white();
        struct brume_scene s = uniform_scene(v, &l);
        s.filter = (uint8_t)(n / 3);
        struct lit_cache m = lit_cache_made(&frame, v, &s, 1 + (unsigned)n % 3);
        double square = 0;
        lit_march(&frame, v, &s, first);
        s.light = BRUME_CACHE;
        l.cache = &m.cache;
        lit_march(&frame, v, &s, second);
        for (int i = 0; i < RAYS; i++) {
            double off = ((double)second[i].light - first[i].light) / 65536;
            square += off * off / RAYS;
        }
        rmse[n / 3][n % 3] = sqrt(square);
        free(m.codes);
    }
    for (int tri = 0; tri < 2; tri++)
        tap_check(rmse[tri][0] < rmse[tri][1] && rmse[tri][1] < rmse[tri][2],
                  "cloud, %s: RMSE %.5f, %.5f, %.5f of spacings 2, 4, 8",
                  tri ? "trilinear" : "nearest", rmse[tri][0], rmse[tri][1],
                  rmse[tri][2]);
    tap_check(rmse[1][0] < rmse[0][0] && rmse[1][1] < rmse[0][1] &&
                  rmse[1][2] < rmse[0][2],
              "cloud: trilinear is nearer to uniform light than nearest");
}

static void check_blends(const struct lit_volume *v)
{
    struct brume_lighting l = lit_white();
    struct brume_scene s = uniform_scene(v, &l);
    struct lit_cache a = lit_cache_made(&frame, v, &s, 2);
    s.sun[1] = -s.sun[1];
    struct lit_cache b = lit_cache_made(&frame, v, &s, 2);
    struct brume_cache c = a.cache;
    int same = 0, ends = 0, between = 0;
    s.light = BRUME_CACHE;
    l.cache = &c;
    for (uint8_t filter = 0; filter < 3; filter++) {
        s.filter = filter;
        c = a.cache;
        lit_march(&frame, v, &s, first);
        for (c.blend = 0; c.blend <= ONE; c.blend += 0x1fff) {
            lit_march(&frame, v, &s, second); /* from == to */
            same += lit_differing(first, second, RAYS);
        }
        c.to = b.codes;
        c.blend = 0;
        lit_march(&frame, v, &s, second);
        ends += lit_differing(first, second, RAYS);
        c = b.cache;
        lit_march(&frame, v, &s, first);
        c.from = a.codes;
        c.to = b.codes;
        c.blend = 0x8000;
        lit_march(&frame, v, &s, second);
        between += lit_differing(first, second, RAYS);
        c.blend = ONE;
        lit_march(&frame, v, &s, second);
        ends += lit_differing(first, second, RAYS);
    }
    tap_check(same == 0, "from == to: the same for any blend (%d)", same);
    tap_check(ends == 0 && between > RAYS / 4,
              "blend 0 is `from`, blend 1 is `to` (%d)", ends);
    free(a.codes);
    free(b.codes);
}

/// Baked ///

/* The cloud's own section is the integral of trilinear density towards +y.
 * Both codes are rounded, by log(2) / 48 of unit + depth; the core's samples
 * are 1/16 of a voxel apart. */
static void check_baked(const struct lit_volume *v)
{
    struct brume_lighting l = lit_white();
    struct brume_scene s = uniform_scene(v, &l);
    struct brume_cache baked;
    s.filter = BRUME_TRILINEAR;
    s.sun[0] = s.sun[2] = 0;
    s.light_step = ONE / 16;
    s.light_samples = 800;
    struct lit_cache m = lit_cache_made(&frame, v, &s, 1);
    if (brume_cache_baked(&baked, &v->volume) != BRUME_OK)
        abort();
    double worst = 0, unit = number(m.cache.unit), other = number(baked.unit);
    for (size_t i = 0; i < m.size; i++) {
        double have = unit * (exp2(m.codes[i] / 24.0) - 1);
        double want = other * (exp2(baked.from[i] / 24.0) - 1);
        double slack = 0.0146 * (unit + have + other + want) + 1.0 / 32;
        worst = fmax(worst, fabs(have - want) / slack);
    }
    tap_check(worst <= 1 && baked.blend == 0 && baked.spacing_log2 == 1 &&
                  memcmp(baked.size, m.cache.size, sizeof baked.size) == 0,
              "%s: the baked cache is that of uniform light (%.2f of the "
              "bound)",
              v->name, worst);
    free(m.codes);
}

/// Refusals ///

static void check_refusals(const struct lit_volume *v)
{
    struct lit_volume other = full_block();
    struct brume_lighting l = lit_white();
    struct brume_scene s = uniform_scene(v, &l);
    struct lit_cache m = lit_cache_made(&frame, v, &s, 3);
    struct brume_cache *c = &m.cache, none = m.cache;
    uint32_t all = rows_of(&m);
    uint8_t before = m.codes[m.size - 1];
    tap_check(brume_cache_bytes(&v->volume, 0) == 0 &&
                  brume_cache_bytes(&v->volume, 4) == 0 &&
                  brume_cache_bytes(&v->volume, 1) == 8000,
              "bytes of a cache: of spacings 2, 4 and 8 alone");
    tap_check(
        brume_cache_begin(c, &v->volume, 0, m.codes) == BRUME_ERR_SIZE &&
            brume_cache_begin(c, &v->volume, 4, m.codes) == BRUME_ERR_SIZE &&
            brume_cache_begin(NULL, &v->volume, 1, m.codes) == BRUME_ERR_NULL &&
            brume_cache_begin(c, NULL, 1, m.codes) == BRUME_ERR_NULL &&
            brume_cache_begin(c, &v->volume, 1, NULL) == BRUME_ERR_NULL &&
            memcmp(c, &none, sizeof none) == 0,
        "brume_cache_begin: spacings and NULL");
    tap_check(brume_cache_rows(NULL, m.codes, &frame, 0, 1) == BRUME_ERR_NULL &&
                  brume_cache_rows(c, NULL, &frame, 0, 1) == BRUME_ERR_NULL &&
                  brume_cache_rows(c, m.codes, NULL, 0, 1) == BRUME_ERR_NULL,
              "brume_cache_rows: NULL");
    tap_check(
        brume_cache_rows(c, m.codes, &frame, all, 0) == BRUME_OK &&
            brume_cache_rows(c, m.codes, &frame, 0, all + 1) ==
                BRUME_ERR_RECT &&
            brume_cache_rows(c, m.codes, &frame, all, 1) == BRUME_ERR_RECT &&
            brume_cache_rows(c, m.codes, &frame, 1, ~0u) == BRUME_ERR_RECT &&
            m.codes[m.size - 1] == before,
        "brume_cache_rows: beyond the last row");
    s.light = BRUME_CACHE;
    l.cache = c;
    begin(v, &s);
    tap_check(brume_cache_rows(c, m.codes, &frame, 0, 1) == BRUME_ERR_SCENE,
              "brume_cache_rows: of a frame that has a cache");
    memset(l.sun_colour, 0, sizeof l.sun_colour);
    begin(v, &s);
    tap_check(brume_cache_rows(c, m.codes, &frame, 0, 1) == BRUME_ERR_SCENE,
              "brume_cache_rows: of a black sun");
    s.light = BRUME_LOG;
    s.light_samples = 8;
    s.lighting = NULL;
    begin(v, &s);
    tap_check(brume_cache_rows(c, m.codes, &frame, 0, 1) == BRUME_ERR_SCENE,
              "brume_cache_rows: of a frame without lighting");
    s.lighting = &l;
    l = lit_white();
    begin(&other, &s);
    tap_check(brume_cache_rows(c, m.codes, &frame, 0, 1) == BRUME_ERR_SIZE,
              "brume_cache_rows: of another volume");
    tap_check(brume_cache_baked(c, &other.volume) == BRUME_ERR_SECTION &&
                  memcmp(c, &none, sizeof none) == 0,
              "brume_cache_baked: of a volume without");
    free(m.codes);
    lit_volume_free(&other);
}

int main(void)
{
    for (int i = 0; i < LIT_CLOUDS; i++) {
        struct lit_volume v = lit_cloud(i);
        check_rows(&v);
        check_blends(&v);
        check_baked(&v);
        if (i == 1) {
            check_cloud_images(&v);
            check_refusals(&v);
        }
        lit_volume_free(&v);
    }
    check_integrals();
    check_code_values();
    check_positions();
    check_block_images();
    return tap_done();
}
