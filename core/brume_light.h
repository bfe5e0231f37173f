/* SPDX-License-Identifier: MIT */
/*
 * What both marches do at a sample: leaping over empty cells, and adding up
 * density towards the sun. Inlined, where `k` is a constant (brume_march.c) or
 * known at run time (brume_lit.c).
 */
#ifndef BRUME_LIGHT_H
#define BRUME_LIGHT_H

#include "brume_lookup.h"

/// Leaping ///

/* Samples along one axis from p to the last position whose cell is less than
 * `cell` cells away. `far` = (cell - 1) << 19: the way is, forwards,
 *     (cell << 19) - 1 - (p & mask) = far + (~p & mask),
 * and backwards far + (p & mask). `inverse` is rounded down, so the quotient
 * is never too large. */
BRUME_INLINE uint32_t leap_axis(uint32_t p, int32_t move, uint32_t inverse,
                                uint32_t far, uint32_t margin)
{
    const uint32_t mask = (1u << 19) - 1u;
    uint32_t forwards = ~sign_mask(move);
    uint32_t room = far + ((p ^ forwards) & mask) - (margin & forwards);
    return mul_hi_floor(room, inverse);
}

/* How many samples to move from a position in an empty cell: at least 1, and
 * such that all between lie in cells that are empty by the cell's distance,
 * its low byte. The margin is a voxel where a lookup reads one voxel beyond,
 * else 0. A line whose `inverse` is 0 moves by one: skipping off. */
BRUME_INLINE uint32_t leap(const struct brume_frame *f,
                           const struct brume_line *line, uint32_t x,
                           uint32_t y, uint32_t z, uint32_t cell,
                           struct kernel k)
{
    uint32_t margin = k.trilinear ? f->leap_margin : 0;
    uint32_t far = (cell << 19) - (1u << 19); /* the shift drops the flag */
    uint32_t n = leap_axis(x, line->move[0], line->inverse[0], far, margin);
    uint32_t m = leap_axis(y, line->move[1], line->inverse[1], far, margin);
    n = m < n ? m : n;
    m = leap_axis(z, line->move[2], line->inverse[2], far, margin);
    n = m < n ? m : n;
    return n + 1u;
}

/// Light ///

/* Is sample i of the light ray, at p + light * 2^i, in the pool? */
BRUME_INLINE bool light_inside(const struct brume_frame *f,
                               const struct brume_light_ray *light, uint32_t px,
                               uint32_t py, uint32_t pz, uint32_t i)
{
    return px + ((uint32_t)light->first[0] << i) < f->limit[0] &&
           py + ((uint32_t)light->first[1] << i) < f->limit[1] &&
           pz + ((uint32_t)light->first[2] << i) < f->limit[2];
}

/* How many samples of the light ray are in the pool, which is convex: out
 * once, out for good. Searched from n, what the last position had. */
BRUME_INLINE uint32_t light_reach(const struct brume_frame *f,
                                  const struct brume_light_ray *light,
                                  uint32_t px, uint32_t py, uint32_t pz,
                                  uint32_t n)
{
    if (n < light->samples && light_inside(f, light, px, py, pz, n)) {
        do
            n++;
        while (n < light->samples && light_inside(f, light, px, py, pz, n));
        return n;
    }
    while (n > 0 && !light_inside(f, light, px, py, pz, n - 1))
        n--;
    return n;
}

/* d * 2^i of sample i, which is in the pool. */
BRUME_INLINE uint32_t light_sample(const struct brume_frame *f, uint32_t px,
                                   uint32_t py, uint32_t pz, uint32_t lx,
                                   uint32_t ly, uint32_t lz, uint32_t i,
                                   struct kernel k)
{
    uint32_t d;
    BRUME_TALLY(light_samples, 1);
    if (!find_density(f, px + (lx << i), py + (ly << i), pz + (lz << i), &d, k))
        return 0;
    return d << i;
}

/* Sum of d * 2^i over the first n samples, all in the pool. < 2^32: a 16-bit
 * code times 2^16 - 1. */
BRUME_INLINE uint32_t sum_log(const struct brume_frame *f,
                              const struct brume_light_ray *light, uint32_t px,
                              uint32_t py, uint32_t pz, uint32_t n,
                              struct kernel k)
{
    uint32_t lx = (uint32_t)light->first[0], sum = 0;
    uint32_t ly = (uint32_t)light->first[1], lz = (uint32_t)light->first[2];
    if (!BRUME_UNROLL_LIGHT || k.trilinear) {
        for (uint32_t i = 0; i < n; i++)
            sum += light_sample(f, px, py, pz, lx, ly, lz, i, k);
        return sum;
    }
    /* Falls through from the farthest to the nearest, so that shifts are
     * constants and nothing is counted. Compilers must not take the shifts
     * out of the march: there are no registers to keep them. */
    BRUME_OPAQUE(lx);
    BRUME_OPAQUE(ly);
    BRUME_OPAQUE(lz);
#define LIGHT_SAMPLE(i) \
    BRUME_FALLTHROUGH; \
    case (i) + 1: sum += light_sample(f, px, py, pz, lx, ly, lz, i, k)
    switch (n) {
    default:
        LIGHT_SAMPLE(15);
        LIGHT_SAMPLE(14);
        LIGHT_SAMPLE(13);
        LIGHT_SAMPLE(12);
        LIGHT_SAMPLE(11);
        LIGHT_SAMPLE(10);
        LIGHT_SAMPLE(9);
        LIGHT_SAMPLE(8);
        LIGHT_SAMPLE(7);
        LIGHT_SAMPLE(6);
        LIGHT_SAMPLE(5);
        LIGHT_SAMPLE(4);
        LIGHT_SAMPLE(3);
        LIGHT_SAMPLE(2);
        LIGHT_SAMPLE(1);
        LIGHT_SAMPLE(0);
        BRUME_FALLTHROUGH;
    case 0: return sum;
    }
}

/* Sum of d over the samples at p + first + i * light_line.move; < 2^28. */
BRUME_INLINE uint32_t sum_uniform(const struct brume_frame *f,
                                  const struct brume_light_ray *light,
                                  uint32_t px, uint32_t py, uint32_t pz,
                                  struct kernel k)
{
    const struct brume_line *line = &f->light_line;
    uint32_t n = light->samples, sum = 0, m, d;
    px += (uint32_t)light->first[0];
    py += (uint32_t)light->first[1];
    pz += (uint32_t)light->first[2];
    for (uint32_t i = 0; i < n; i += m) {
        if (px >= f->limit[0] || py >= f->limit[1] || pz >= f->limit[2])
            break;
        m = 1;
        BRUME_TALLY(light_samples, 1);
        if (find_density(f, px, py, pz, &d, k))
            sum += d;
        else
            m = leap(f, line, px, py, pz, d, k);
        px += m * (uint32_t)line->move[0];
        py += m * (uint32_t)line->move[1];
        pz += m * (uint32_t)line->move[2];
    }
    return sum;
}

/* exp(-tau) of a sum, in Q2.30. tau is rounded to 1/4096. */
BRUME_INLINE uint32_t transmittance_of(const struct brume_tau *t, uint32_t sum)
{
    if (sum > t->limit)
        return 0;
    uint32_t tau = (mul_hi_floor(sum << t->shift, t->m) + 1u) >> 1;
    BRUME_CHECK(tau <= 0xffffu);
    return (uint32_t)brume_exp_coarse[tau >> 8] * brume_exp_fine[tau & 255u];
}

#if BRUME_WITH_FOG
/* The same with `more` added to tau, Q13, < 2^30. */
BRUME_INLINE uint32_t transmittance_beyond(const struct brume_tau *t,
                                           uint32_t sum, uint32_t more)
{
    if (sum > t->limit)
        return 0;
    uint32_t tau = mul_hi_floor(sum << t->shift, t->m) + more;
    if (tau > 131070u)
        return 0;
    tau = (tau + 1u) >> 1;
    return (uint32_t)brume_exp_coarse[tau >> 8] * brume_exp_fine[tau & 255u];
}
#endif

/// Both ///

/* 1 - exp(-sigma_t * step) of a density, Q0.32. */
BRUME_INLINE uint32_t opacity(const struct brume_frame *f, uint32_t d,
                              bool narrow)
{
    if (narrow)
        return f->table[d];
    return ~mul_hi_floor(f->table[d >> 8], f->table[256u + (d & 255u)]);
}

/* Optical depth towards the sun, as a sum of codes times weights. *reach is
 * the ray's, from one sample to the next. */
BRUME_INLINE uint32_t light_sum(const struct brume_frame *f,
                                const struct brume_light_ray *light, uint32_t x,
                                uint32_t y, uint32_t z, uint32_t *reach,
                                struct kernel k)
{
    if (k.uniform)
        return sum_uniform(f, light, x, y, z, k);
    *reach = light_reach(f, light, x, y, z, *reach);
    return sum_log(f, light, x, y, z, *reach, k);
}

/* Where in the sequence of samples the light was lost: sum of lost * index,
 * Q1.31 times 2^-20. index < 2^20, so each term is below 2^31, and the sum is,
 * as the losses sum to 1. */
BRUME_INLINE uint32_t moment(uint32_t lost, uint32_t index)
{
    return mul_hi_floor(lost, index << 12);
}

#endif
