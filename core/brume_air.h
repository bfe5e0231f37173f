/* SPDX-License-Identifier: MIT */
/*
 * Light at samples outside of the pool, where fog is: what of the volume lies
 * between them and the sun, or the sky. For brume_lit.c.
 */
#ifndef BRUME_AIR_H
#define BRUME_AIR_H

#include "brume_sun.h"

#if BRUME_WITH_LIGHTING

/* The nearest position in the pool. */
static inline void hold_in_pool(const struct brume_frame *f,
                                const uint32_t p[3], uint32_t out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = as_signed(p[i]) < 0 ? 0 : p[i];
        if (out[i] >= f->limit[i])
            out[i] = f->limit[i] - 1u;
    }
}

/* Is p on a side of the pool from which this way leads away? A sum of two such
 * coordinates may wrap into the pool; of all others none does. */
static inline bool leads_away(const struct brume_frame *f, const uint32_t p[3],
                              const int32_t way[3])
{
    for (int i = 0; i < 3; i++) {
        bool low = as_signed(p[i]) < 0, high = !low && p[i] >= f->limit[i];
        if ((low && way[i] <= 0) || (high && way[i] >= 0))
            return true;
    }
    return false;
}

/* sum_log for p outside of the pool. */
static inline uint32_t sum_log_outside(const struct brume_frame *f,
                                       const struct brume_light_ray *light,
                                       const uint32_t p[3],
                                       const struct kernel *k)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < light->samples; i++)
        if (light_inside(f, light, p[0], p[1], p[2], i))
            sum += light_sample(f, p[0], p[1], p[2], (uint32_t)light->first[0],
                                (uint32_t)light->first[1],
                                (uint32_t)light->first[2], i, *k);
    return sum;
}

#if BRUME_WITH_FOG
/* Where the way from p outside towards the sun enters the pool, Q16.16; false
 * when it passes by. */
static inline bool way_to_pool(const struct brume_frame *f, const uint32_t p[3],
                               uint32_t *t_in)
{
    uint32_t t_out = 0xffffffffu;
    *t_in = 0;
    if (leads_away(f, p, f->sun))
        return false;
    for (int i = 0; i < 3; i++) {
        bool low = as_signed(p[i]) < 0, high = !low && p[i] >= f->limit[i];
        bool down = f->sun[i] < 0;
        if (f->sun[i] == 0)
            continue;
        uint32_t out = down ? p[i] + 1u : f->limit[i] - p[i];
        out = brume_times(out, 0, f->lit.fog.pace[i]);
        t_out = out < t_out ? out : t_out;
        if (!low && !high)
            continue;
        uint32_t in = down ? p[i] - (f->limit[i] - 1u) : 0u - p[i];
        in = brume_times(in, 0, f->lit.fog.pace[i]);
        *t_in = in > *t_in ? in : *t_in;
    }
    /* By rounding it may seem to leave before it enters. */
    return *t_in <= t_out || *t_in - t_out < 16u;
}

#if BRUME_WITH_UNIFORM
/* sum_uniform: from the sample before the pool on. */
static inline uint32_t sum_uniform_outside(const struct brume_frame *f,
                                           const struct brume_light_ray *light,
                                           const uint32_t p[3], uint32_t t_in,
                                           const struct kernel *k)
{
    uint32_t n = brume_times(t_in, 0, f->lit.fog.per_light_step);
    n -= n < 2 ? n : 2;
    struct brume_light_ray rest = *light;
    for (uint32_t tries = 0; tries < 5 && n < light->samples; tries++, n++) {
        for (int i = 0; i < 3; i++)
            rest.first[i] = as_signed((uint32_t)light->first[i] +
                                      n * (uint32_t)f->light_line.move[i]);
        rest.samples = light->samples - n;
        if (light_inside(f, &rest, p[0], p[1], p[2], 0))
            return sum_uniform(f, &rest, p[0], p[1], p[2], *k);
    }
    return 0;
}
#endif

#if BRUME_WITH_CACHE
/* The cache where the way enters. */
static inline uint32_t sum_cache_outside(const struct brume_frame *f,
                                         const uint32_t p[3], uint32_t t_in,
                                         const struct kernel *k)
{
    uint32_t q[3];
    for (int i = 0; i < 3; i++) {
        uint32_t m = magnitude(f->sun[i]); /* Q30 * Q16 -> Q16 */
        uint32_t way = mul_hi_floor(m, t_in) << 2 | (m * t_in) >> 30;
        q[i] = p[i] + (f->sun[i] < 0 ? 0u - way : way);
    }
    hold_in_pool(f, q, q);
    return sum_cache(f, q, k->moved);
}
#endif

/* sun_sum for p outside of the pool. */
static inline uint32_t sun_sum_outside(const struct brume_frame *f,
                                       const struct brume_light_ray *light,
                                       const uint32_t p[3],
                                       const struct kernel *k)
{
    uint32_t t_in;
    if (f->lit.light == BRUME_NO_LIGHT || !way_to_pool(f, p, &t_in))
        return 0;
    switch (f->lit.light) {
#if BRUME_WITH_UNIFORM
    case BRUME_UNIFORM: return sum_uniform_outside(f, light, p, t_in, k);
#endif
#if BRUME_WITH_CONE
    case BRUME_CONE: return sum_cone(f, light, p, 0, k, false);
#endif
#if BRUME_WITH_CACHE
    case BRUME_CACHE: return sum_cache_outside(f, p, t_in, k);
#endif
    default: return sum_log_outside(f, light, p, k);
    }
}
#endif

#endif

#endif
