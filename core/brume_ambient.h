/* SPDX-License-Identifier: MIT */
/* Light from the sky at a sample of a lit march: docs/light.md. For
 * brume_lit.c. */
#ifndef BRUME_AMBIENT_H
#define BRUME_AMBIENT_H

#include "brume_air.h"
#include "brume_dense.h"

#if BRUME_WITH_LIGHTING

/* What a ray gathers, and where its lookups are moved to. */
struct gathered {
    uint32_t sun[BRUME_MAX_OCTAVES]; /* A_i of docs/light.md, Q3.29, <= 1 */
#if BRUME_WITH_AMBIENT
    uint32_t sky[6]; /* B_j */
#endif
#if BRUME_WITH_LAMPS
    uint32_t lamp[3]; /* C_c, Q3.29, colours applied */
#endif
#if BRUME_WITH_EMISSION
    uint32_t glow[3]; /* E_c, Q6.26, <= 16 */
#endif
    uint32_t moved[3]; /* Q16.16, 0 .. 1: of stochastic lookups */
    uint32_t lit;      /* samples */
};

#if BRUME_WITH_AMBIENT
/* Q2.30 of what the asset says that the sky's share is. p is in the pool. */
static inline uint32_t baked_sky(const struct brume_frame *f,
                                 const uint32_t p[3])
{
    const struct brume_volume *v = f->volume;
    struct dense g = {
        v->sky, {v->cell_count[0], v->cell_count[1], v->cell_count[2]}, false};
    uint32_t at[3], half = brume_half_voxel(f);
    for (int i = 0; i < 3; i++)
        at[i] = ((p[i] + half) >> 3) - 0x8000u;
    /* Q8.16: 255 << 16 is 1, 2^30 */
    return mul_hi_floor(dense_between(&g, at) << 8, 1077952577u);
}

/* Number n of the directions that samples of ray (x, y) take, Q1.7 in the
 * frame of zenith: odd ones point down. */
static inline void sky_direction(const struct brume_frame *f, uint32_t x,
                                 uint32_t y, uint32_t n, int32_t out[3])
{
    const struct brume_direction_table *t = f->lit.lighting->directions;
    uint32_t frame = brume_noise_frame(f);
    x += (n * 3242174889u) >> (32u - t->width_log2);
    y += (n * 2447445414u) >> (32u - t->height_log2);
    x &= (1u << t->width_log2) - 1u;
    y &= (1u << t->height_log2) - 1u;
    frame &= (1u << t->frames_log2) - 1u;
    uint32_t i = ((frame << t->height_log2 | y) << t->width_log2) | x;
    for (int axis = 0; axis < 3; axis++) {
        int32_t a = t->values[3u * i + (uint32_t)axis];
        out[axis] = n & 1u ? -a : a;
    }
}

/* What a ray in that direction lets through, Q2.30. */
static inline uint32_t sky_transmittance(const struct brume_frame *f,
                                         const uint32_t p[3],
                                         const int32_t local[3],
                                         int32_t world[3],
                                         const struct kernel *k, bool inside)
{
    struct brume_light_ray ray;
    for (int i = 0; i < 3; i++) {
        int32_t sum = 0; /* Q16.16 steps of up to 2^24, times 1.7 at most */
        for (int axis = 0; axis < 3; axis++)
            sum += mul_signed_round(f->lit.sky_axis[axis][i],
                                    magnitude(local[axis]) << 18, 7) *
                   (local[axis] < 0 ? -1 : 1);
        ray.first[i] = sum;
        world[i] = sum;
    }
    ray.samples = f->lit.sky_samples;
    uint32_t sum = 0;
    if (inside) {
        uint32_t n = light_reach(f, &ray, p[0], p[1], p[2], ray.samples >> 1);
        sum = sum_log(f, &ray, p[0], p[1], p[2], n, *k);
    } else if (!leads_away(f, p, ray.first)) {
        sum = sum_log_outside(f, &ray, p, k);
    }
    return transmittance_of(&f->lit.sky_tau, sum);
}

/* Height in the volume's box along zenith, Q0.32. */
static inline uint32_t height_of(const struct brume_frame *f,
                                 const uint32_t p[3])
{
    int32_t above = brume_along_zenith(f, p) - f->lit.low;
    if (above <= 0)
        return 0;
    if ((uint32_t)above >= f->lit.height)
        return 0xffffffffu;
    /* above / height = above m 2^e, e = -62 - log2(height) */
    uint32_t up = (uint32_t)(f->lit.per_height.e + 62);
    return mul_hi_floor((uint32_t)above << up, f->lit.per_height.m) << 2;
}

/* Adds lost * w_j * V. `seen`, Q3.29, is lost * V. */
static inline void add_cube(struct gathered *g, uint32_t seen,
                            const int32_t way[3])
{
    /* squares, Q32, of a vector of any length: their share of the sum */
    int32_t unit[3] = {way[0], way[1], way[2]};
    brume_normalise(unit);
    for (int i = 0; i < 3; i++) {
        uint32_t m = magnitude(unit[i]) << 1; /* Q1.31 */
        uint32_t square = mul_hi_floor(m, m); /* Q2.30 */
        g->sky[2 * i + (unit[i] < 0 ? 1 : 0)] +=
            mul_hi_floor(seen, square < 1u << 30 ? square << 2 : 0xffffffffu);
    }
}

static inline void add_sky(const struct brume_frame *f, struct gathered *g,
                           const struct brume_ray *ray, const uint32_t p[3],
                           uint32_t lost, const struct kernel *k, bool inside)
{
    uint32_t through = 1u << 30;
    int32_t local[3], way[3] = {0, 0, 0};
    bool sampled = f->lit.visibility == BRUME_SKY_SAMPLED;
    if (sampled) {
        sky_direction(f, ray->x, ray->y, g->lit, local);
        through = sky_transmittance(f, p, local, way, k, inside);
    } else if (f->lit.visibility == BRUME_SKY_BAKED) {
        uint32_t nearest[3] = {p[0], p[1], p[2]};
        if (!inside)
            hold_in_pool(f, p, nearest);
        through = baked_sky(f, nearest);
    }
    uint32_t seen = mul_hi_floor(lost, through); /* Q3.29 */
    if (f->lit.ambient == BRUME_AMBIENT_GRADIENT) {
        uint32_t upper = mul_hi_floor(seen, height_of(f, p));
        g->sky[0] += upper;
        g->sky[1] += seen - upper;
    } else if (f->lit.ambient == BRUME_AMBIENT_CUBE && sampled) {
        add_cube(g, seen, way);
    } else {
        g->sky[0] += seen;
    }
}
#endif

#endif

#endif
