/* SPDX-License-Identifier: MIT */
/*
 * Lamps seen from a sample of a lit march: docs/light.md. For
 * brume_lamp_light.h, and for marches in lanes.
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

/* The way from a sample to a lamp, in halves of 2^-16 voxels. */
struct lamp_way {
    int32_t d[3];
    uint32_t square; /* its square's highest 32 bits: times 2^(32 - zeros) */
    uint32_t zeros;  /* 6 .. 63 */
};

/* The square of the way, < 2^64: three of 2^62 at most. Written out, as
 * compilers for size keep loops. */
BRUME_INLINE uint64_t lamp_square(int32_t d[3], const struct brume_lit_lamp *l,
                                  const uint32_t at[3])
{
    d[0] = as_signed(l->position[0] - at[0]);
    d[1] = as_signed(l->position[1] - at[1]);
    d[2] = as_signed(l->position[2] - at[2]);
    return brume_square(d[0]) + brume_square(d[1]) + brume_square(d[2]);
}

/* 2^62 / d of d >= 2^31, in (2^30, 2^31], up to 2^-16 of itself too low: a
 * line within 1/17, then Newton's y (2 - d y) twice. */
BRUME_INLINE uint32_t lamp_reciprocal(uint32_t d)
{
    uint32_t slope = 2021161080u;
    BRUME_OPAQUE(slope); /* one product, not a dozen shifts and sums */
    uint32_t y = 3031741620u - mul_hi_floor(d, slope);
    y = mul_hi_floor(y, 0x80000000u - mul_hi_floor(d, y)) << 2;
    return mul_hi_floor(y, 0x80000000u - mul_hi_floor(d, y)) << 2;
}

/* (1 - (r / radius)^4)^2, Q0.32. r / radius >= 2^-16. */
BRUME_INLINE uint32_t lamp_window(const struct brume_lit_lamp *l,
                                  uint32_t square, uint32_t zeros)
{
    /* (r / radius)^2 < 1, Q31 */
    uint32_t q =
        mul_hi_floor(square, l->per_radius) >> (zeros - l->radius_shift);
    uint32_t window = ~mul_hi_floor(q << 1, q << 1);
    return mul_hi_floor(window, window);
}

/* (size / max(r, size))^2, Q0.32. size / r >= 2^-16. */
BRUME_INLINE uint32_t lamp_fall(const struct brume_lit_lamp *l, uint32_t square,
                                uint32_t zeros)
{
    /* h 2^-down, h in Q2.30, 1/2 .. 2 */
    uint32_t h = mul_hi_floor(l->size, lamp_reciprocal(square));
    int32_t down = l->size_shift - (int32_t)zeros;
    if (down > 0)
        return h << 1 >> (down - 1);
    return down == 0 && h < 1u << 30 ? h << 2 : 0xffffffffu;
}

/// Direction ///

/* Towards the lamp, Q2.30, 0 at its own place; and its distance, Q16.16. */
static inline uint32_t lamp_unit(const struct lamp_way *w, int32_t unit[3])
{
    /* square = x 2^(64 - 2 half), 1/4 <= x < 1 in Q0.32 */
    uint32_t half = w->zeros >> 1, x = w->square >> (w->zeros & 1u);
    unsigned none;
    uint32_t r = brume_rsqrt(x, &none);
    for (int i = 0; i < 3; i++) {
        /* Q32 * Q31 -> Q31 -> Q30 */
        uint32_t m = magnitude(w->d[i]);
        uint32_t u = mul_hi_floor(m << half, r);
        unit[i] = with_sign((u >> 1) + (u & 1u), w->d[i] < 0);
    }
    /* sqrt(x) 2^(32 - half), doubled; half >= 3 */
    return mul_hi_floor(x, r) >> (half - 2u);
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
 * samples, (i + jitter) / n of the way, which is r long, Q16.16. */
static inline uint32_t lamp_through(const struct brume_frame *f,
                                    const struct brume_lit_lamp *l,
                                    const struct lamp_way *w, uint32_t r,
                                    uint32_t jitter, const uint32_t p[3],
                                    const struct kernel *k)
{
    uint32_t at[3], move[3], codes = 0 /* < 64 * 2^16 */, fog = 0;
    for (int i = 0; i < 3; i++) {
        /* d is below 2^29: it is within the radius */
        int32_t way = mul_signed_round(w->d[i] * 2, l->per_sample, 0);
        move[i] = (uint32_t)way;
        at[i] = p[i] + (uint32_t)mul_signed_round(way, jitter << 16, 0);
    }
    for (uint32_t n = 0; n < l->shadow_samples; n++) {
        codes += lamp_density(f, at, k);
        fog += lamp_fog(f, at);
        for (int i = 0; i < 3; i++)
            at[i] += move[i];
    }
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

/* A sum that stays at the most it can be. */
BRUME_INLINE uint32_t lamp_sum(uint32_t a, uint32_t b)
{
    return a + b < b ? 0xffffffffu : a + b;
}

/* Words of the lamps that may reach a sample. Nothing is kept from one sample
 * to the next: rays of scenes without lamps are not to pay for it. */
static inline const uint32_t *lamps_near(const struct brume_frame *f,
                                         const struct brume_ray *ray,
                                         const uint32_t p[3])
{
    const struct brume_clusters *c = f->lit.clusters;
    uint32_t slice = 0, most = 0, depth = 0;
    for (int i = 0; i < 3; i++) {
        /* away from the eye, so below 2^32, along the ray's main axis */
        uint32_t way = p[i] - (uint32_t)f->eye[i];
        if (magnitude(ray->unit[i]) <= most)
            continue;
        most = magnitude(ray->unit[i]);
        depth = ray->unit[i] < 0 ? 0u - way : way;
    }
    while (slice < BRUME_CLUSTER_SLICES - 1u && depth >= c->end[slice])
        slice++;
    return c->lamps[slice][ray->y * f->lit.tile[1] >> 16]
                   [ray->x * f->lit.tile[0] >> 16];
}

/* J of the lamps' shadows, Q0.16: the light ray's, or 1/2. */
static inline uint32_t lamp_jitter(const struct brume_frame *f,
                                   const struct brume_ray *ray)
{
    if (BRUME_WITH_NOISE && f->lit.lamp_shadows &&
        (f->jitter & BRUME_JITTER_LIGHT) && f->noise != BRUME_NOISE_NONE)
        return brume_noise_value(f->noise, &f->noise_table, ray->x, ray->y,
                                 brume_noise_frame(f), 1);
    return 0x8000u;
}

#endif

#endif
