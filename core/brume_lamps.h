/* SPDX-License-Identifier: MIT */
/*
 * Light from lamps at a sample of a lit march: docs/light.md. For brume_lit.c.
 *
 * A lamp is met at each of its samples, so all that can be said of it once a
 * frame is (struct brume_lit_lamp), and what is left has no division and, for a
 * point light without phase function or shadow, no root.
 */
#ifndef BRUME_LAMPS_H
#define BRUME_LAMPS_H

#include "brume_ambient.h"
#include "brume_fog.h"

#if BRUME_WITH_LAMPS

/* The way from a sample to a lamp. */
struct lamp_way {
    uint32_t m[3];   /* magnitudes times 2^up; the largest is >= 2^30 */
    uint32_t square; /* high word of their squares' sum, 2^28 .. 3 * 2^30 */
    uint32_t up;     /* 1 .. 30 */
    bool minus[3];   /* their signs */
};

/* False beyond the lamp's radius along some axis. */
BRUME_INLINE bool lamp_way_of(struct lamp_way *w,
                              const struct brume_lit_lamp *l,
                              const uint32_t at[3])
{
    uint32_t all = 1;
    for (int i = 0; i < 3; i++) {
        uint32_t a = l->position[i], b = at[i];
        w->minus[i] = a < b;
        w->m[i] = a < b ? b - a : a - b;
        if (w->m[i] >= l->radius)
            return false;
        all |= w->m[i]; /* < 2^30 */
    }
    w->up = leading_zeros(all) - 1u;
    w->square = 0;
    for (int i = 0; i < 3; i++) {
        w->m[i] <<= w->up;
        w->square += mul_hi_floor(w->m[i], w->m[i]);
    }
    if (w->square == 0) /* the lamp's own place: as near as can be */
        w->square = 1u << 28;
    return true;
}

/* 2^62 / d of d >= 2^31, in (2^30, 2^31], up to 2^-16 of itself too low: a
 * line within 1/17, then Newton's y (2 - d y) twice. */
BRUME_INLINE uint32_t lamp_reciprocal(uint32_t d)
{
    uint32_t y = 3031741621u - mul_hi_floor(d, 2021161081u);
    y = mul_hi_floor(y, 0x80000000u - mul_hi_floor(d, y)) << 2;
    return mul_hi_floor(y, 0x80000000u - mul_hi_floor(d, y)) << 2;
}

/* (size / max(r, size))^2 (1 - (r / radius)^4)^2, Q0.32; 0 beyond the radius.
 */
BRUME_INLINE uint32_t lamp_fall(const struct brume_lit_lamp *l,
                                const struct lamp_way *w)
{
    /* (r / radius)^2, Q5.27: square < 12 times that of the radius. Beyond 32
     * octaves, nothing. */
    uint32_t down = 2u * (w->up - l->radius_shift);
    uint32_t q = down < 32 ? mul_hi_floor(w->square, l->per_radius) >> down : 0;
    if (q >= 1u << 27)
        return 0;
    uint32_t window = ~mul_hi_floor(q << 5, q << 5);
    window = mul_hi_floor(window, window);
    uint32_t n = leading_zeros(w->square);
    /* (size / r)^2 = h 2^e, h in Q2.30, 1/2 .. 2 */
    uint32_t h = mul_hi_floor(l->size, lamp_reciprocal(w->square << n));
    int32_t e = (int32_t)(n + 2u * w->up) - l->size_shift;
    if (e > 0 || (e == 0 && h >= 1u << 30))
        return window;
    if (e < -33)
        return 0;
    h = e >= -2 ? h << (e + 2) : h >> (-2 - e);
    return mul_hi_floor(h, window);
}

/// Direction ///

/* Towards the lamp, Q2.30; and 2^32 / its length times 2^-up, as brume_rsqrt
 * has it. */
static inline void lamp_unit(const struct lamp_way *w, int32_t unit[3])
{
    unsigned shift;
    uint32_t r = brume_rsqrt(w->square, &shift);
    for (int i = 0; i < 3; i++) {
        /* Q32 * Q31 -> Q31 -> Q30 */
        uint32_t u = mul_hi_floor(w->m[i], r) << shift;
        unit[i] = with_sign((u >> 1) + (u & 1u), w->minus[i]);
    }
}

/* smoothstep of the angle to a spot's direction, Q0.32. The lamp's own place
 * is in its direction. */
static inline uint32_t lamp_spot(const struct brume_lit_lamp *l,
                                 const int32_t unit[3])
{
    int32_t cosine = 0;
    for (int i = 0; i < 3; i++) /* from the lamp, not towards it */
        cosine -= mul_both_signed_round(unit[i], l->direction[i], 2);
    bool here = (unit[0] | unit[1] | unit[2]) == 0;
    if (here || (cosine >= l->cos_inner && cosine > l->cos_outer))
        return 0xffffffffu;
    if (cosine <= l->cos_outer)
        return 0;
    uint32_t x = (uint32_t)cosine - (uint32_t)l->cos_outer;
    x = mul_hi_floor(x, l->slope) << l->slope_shift; /* Q31, < 1 */
    x = x < 0x7fffffffu ? x : 0x7fffffffu;
    /* x^2 (3 - 2 x), Q30 * Q29 -> Q27 */
    return mul_hi_floor(mul_hi_floor(x, x), (3u << 29) - (x >> 1)) << 5;
}

/// Shadow ///

/* Density at a point in or outside of the pool, in codes. */
static inline uint32_t lamp_density(const struct brume_frame *f,
                                    const uint32_t p[3], const struct kernel *k)
{
    uint32_t d;
    BRUME_TALLY(light_samples, 1);
    if (p[0] >= f->limit[0] || p[1] >= f->limit[1] || p[2] >= f->limit[2] ||
        !find_density(f, p[0], p[1], p[2], &d, *k))
        return 0;
    return d;
}

/* Fog at a point, Q6.26, so that 64 of them fit a word. */
static inline uint32_t lamp_fog(const struct brume_frame *f,
                                const uint32_t p[3])
{
#if BRUME_WITH_FOG
    if (brume_has_fog(f))
        return fog_at(f, p).all >> 6;
#endif
    (void)f, (void)p;
    return 0;
}

/* exp(-depth between sample and lamp), Q2.30: the volume and fog at the lamp's
 * samples, (i + jitter) / n of the way. */
static inline uint32_t lamp_through(const struct brume_frame *f,
                                    const struct brume_lit_lamp *l,
                                    const struct lamp_way *w,
                                    const struct gathered *g,
                                    const uint32_t p[3], const struct kernel *k)
{
    uint32_t at[3], move[3], codes = 0 /* < 64 * 2^16 */, fog = 0;
    unsigned shift;
    for (int i = 0; i < 3; i++) {
        int32_t way = with_sign(w->m[i] >> w->up, w->minus[i]);
        way = mul_signed_round(way, l->per_sample, 0);
        move[i] = (uint32_t)way;
        at[i] = p[i] + (uint32_t)mul_signed_round(way, g->lamp_jitter << 16, 0);
    }
    for (uint32_t n = 0; n < l->shadow_samples; n++) {
        codes += lamp_density(f, at, k);
        fog += lamp_fog(f, at);
        for (int i = 0; i < 3; i++)
            at[i] += move[i];
    }
    /* r = square * 1 / sqrt(square), Q31, back to Q16.16 */
    uint32_t r = brume_rsqrt(w->square, &shift);
    r = (mul_hi_floor(w->square, r) << shift) >> (w->up - 1u);
    struct brume_number part = brume_number_mul(
        brume_number_of(r, -16), brume_number_of(l->per_sample, -32));
    struct brume_number depth = brume_number_mul(
        brume_number_mul(brume_number_of(codes, 0), f->lit.lamp_depth), part);
    uint32_t tau = brume_number_floor(depth, 13); /* to 1/4096, rounded */
    if (fog != 0) {
        uint32_t more = brume_number_floor(
            brume_number_mul(brume_number_of(fog, -26), part), 13);
        tau = tau + more < tau ? 0xffffffffu : tau + more;
    }
    tau = (tau >> 1) + (tau & 1u);
    if (tau > 0xffffu)
        return 0;
    return (uint32_t)brume_exp_coarse[tau >> 8] * brume_exp_fine[tau & 255u];
}

/// Sums ///

/* a 2^up, at most 2^32 - 1. */
BRUME_INLINE uint32_t lamp_times(uint32_t a, int32_t up)
{
    if (up <= 0)
        return up > -32 ? a >> -up : 0;
    if (a == 0)
        return 0;
    return up > (int32_t)leading_zeros(a) ? 0xffffffffu : a << up;
}

/* A lamp's share of what a sample receives, Q12.20. */
static inline void add_lamp(const struct brume_frame *f,
                            const struct gathered *g,
                            const struct brume_lit_lamp *l, const uint32_t p[3],
                            const uint32_t at[3], const int32_t ray[3],
                            uint32_t sum[3], const struct kernel *k)
{
    const struct brume_phase *phase = f->lit.lighting->phase;
    struct lamp_way w;
    int32_t unit[3], up = 0;
    if (!lamp_way_of(&w, l, at))
        return;
    uint32_t fall = lamp_fall(l, &w);
    if (fall == 0)
        return;
    if (l->spot || phase != NULL)
        lamp_unit(&w, unit);
    if (l->spot) {
        fall = mul_hi_floor(fall, lamp_spot(l, unit));
        if (fall == 0)
            return;
    }
    if (l->shadow_samples != 0)
        fall = mul_hi_floor(fall, lamp_through(f, l, &w, g, p, k)) << 2;
    if (phase != NULL && (w.m[0] | w.m[1] | w.m[2]) != 0) {
        struct brume_number n =
            brume_phase_value(phase, brume_one_minus_cos(ray, unit));
        fall = mul_hi_floor(fall, n.m);
        up = n.e + 32;
    }
    for (uint32_t c = 0; c < (brume_has_colour(f) ? 3u : 1u); c++) {
        uint32_t a = mul_hi_floor(fall, l->colour[c]);
        if (up != 0)
            a = lamp_times(a, up);
        sum[c] = sum[c] + a < a ? 0xffffffffu : sum[c] + a;
    }
}

/* Where a ray is among the clusters. */
static inline void begin_lamps(const struct brume_frame *f, struct gathered *g,
                               const struct brume_ray *ray)
{
    uint32_t most = 0;
    g->lamp_tile[0] = ray->x * f->lit.tile[0] >> 16;
    g->lamp_tile[1] = ray->y * f->lit.tile[1] >> 16;
    for (uint32_t i = 0; i < 3; i++)
        if (magnitude(ray->unit[i]) > most) {
            most = magnitude(ray->unit[i]);
            g->lamp_axis = i;
        }
    g->lamp_jitter = 0x8000u;
    if (BRUME_WITH_NOISE && f->lit.lamp_shadows &&
        (f->jitter & BRUME_JITTER_LIGHT) && f->noise != BRUME_NOISE_NONE)
        g->lamp_jitter = brume_noise_value(f->noise, &f->noise_table, ray->x,
                                           ray->y, brume_noise_frame(f), 1);
}

/* The lamps' light at a sample, which scatters `lost` of it, Q1.31. Samples
 * come from near to far. */
static inline void add_lamps(const struct brume_frame *f, struct gathered *g,
                             const struct brume_ray *ray, const uint32_t p[3],
                             uint32_t lost, const struct kernel *k)
{
    const struct brume_clusters *c = f->lit.clusters;
    uint32_t axis = g->lamp_axis, sum[3] = {0}, at[3];
    uint32_t along = p[axis] - (uint32_t)f->eye[axis];
    if (ray->unit[axis] < 0)
        along = 0u - along;
    while (g->lamp_slice < BRUME_CLUSTER_SLICES - 1u &&
           along >= c->end[g->lamp_slice])
        g->lamp_slice++;
    for (int i = 0; i < 3; i++)
        at[i] = p[i] + 0x80000000u;
    const uint32_t *words =
        c->lamps[g->lamp_slice][g->lamp_tile[1]][g->lamp_tile[0]];
    for (uint32_t n = 0; n < BRUME_LAMP_WORDS; n++)
        for (uint32_t bits = words[n]; bits != 0;) {
            uint32_t i = leading_zeros(bits);
            bits -= 0x80000000u >> i;
            add_lamp(f, g, &c->lamp[32u * n + i], p, at, ray->unit, sum, k);
        }
    for (uint32_t i = 0; i < (brume_has_colour(f) ? 3u : 1u); i++) {
        /* Q31 * Q20 -> Q29 */
        uint32_t high = mul_hi_floor(lost, sum[i]), low = lost * sum[i];
        uint32_t a = high >> 22 ? 0xffffffffu : high << 10 | low >> 22;
        g->lamp[i] = g->lamp[i] + a < a ? 0xffffffffu : g->lamp[i] + a;
    }
}

#endif

#endif
