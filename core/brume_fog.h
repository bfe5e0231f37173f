/* SPDX-License-Identifier: MIT */
/* Fog at a sample of a lit march, and towards the sun: docs/light.md. For
 * brume_lit.c. */
#ifndef BRUME_FOG_H
#define BRUME_FOG_H

#include "brume_light.h"

#if BRUME_WITH_FOG

/* Fog at a place: extinction per voxel, Q0.32. */
struct fog {
    uint32_t by_height, all;
    int32_t above; /* the base, Q17.14 */
};

/// Density ///

/* density * exp(-above / falloff), off by 2^-13 of itself. */
static inline uint32_t fog_by_height(const struct brume_frame *f, int32_t above)
{
    const struct brume_lit_fog *fog = &f->lit.fog;
    if (above <= 0 || fog->per_falloff.m == 0)
        return fog->density;
    uint32_t octaves = brume_times((uint32_t)above, 0, fog->per_falloff);
    if (octaves >= 32u << 16)
        return 0;
    /* 2^-fraction = exp(-tau / 4096) by the tables */
    uint32_t tau = ((octaves & 0xffffu) * 45426u + 0x80000u) >> 20;
    uint32_t e = /* Q2.30, <= 1 */
        (uint32_t)brume_exp_coarse[tau >> 8] * brume_exp_fine[tau & 255u];
    e = e < 1u << 30 ? e << 2 : 0xffffffffu;
    return mul_hi_floor(fog->density, e) >> (octaves >> 16);
}

/* Share of a shape's density, Q0.32, of what is left of the square of half its
 * side, Q2.30, at most 1. */
static inline uint32_t edge_share(const struct brume_lit_fog *fog, uint32_t n,
                                  uint32_t square)
{
    uint32_t rest = square < 1u << 30 ? (1u << 30) - square : 0;
    return brume_times(rest, 0, fog->shape[n].edge);
}

/* Shape n at p, a position without bias. */
static inline uint32_t fog_of_shape(const struct brume_frame *f, uint32_t n,
                                    const uint32_t p[3])
{
    const struct brume_lit_fog *fog = &f->lit.fog;
    const struct brume_fog_shape *s = &f->lit.lighting->fog->shapes[n];
    bool box = s->kind == BRUME_FOG_BOX;
    uint32_t square[3]; /* Q2.30, <= 1 */
    for (int i = 0; i < 3; i++) {
        uint32_t c = (uint32_t)s->centre[i], half = s->half[box ? i : 0];
        uint32_t way = as_signed(p[i]) < s->centre[i] ? c - p[i] : p[i] - c;
        if (way >= half)
            return 0;
        uint32_t share = /* Q0.31 */
            mul_hi_floor(way << fog->shape[n].shift[i],
                         fog->shape[n].per_half[i]);
        square[i] = mul_hi_floor(share, share);
    }
    if (!box)
        return mul_hi_floor(
            s->density, edge_share(fog, n, square[0] + square[1] + square[2]));
    uint32_t density = s->density;
    for (int i = 0; i < 3; i++)
        density = mul_hi_floor(density, edge_share(fog, n, square[i]));
    return density;
}

/* The sum of all shapes at a position of the frame, at most 1. */
static inline uint32_t fog_of_shapes(const struct brume_frame *f,
                                     const uint32_t p[3])
{
    uint32_t bias = 0x8000u - brume_half_voxel(f), sum = 0;
    const uint32_t q[3] = {p[0] - bias, p[1] - bias, p[2] - bias};
    for (uint32_t n = 0; n < f->lit.fog.shape_count; n++) {
        uint32_t d = fog_of_shape(f, n, q);
        sum = sum + d < sum ? 0xffffffffu : sum + d;
    }
    return sum;
}

static inline struct fog fog_at(const struct brume_frame *f,
                                const uint32_t p[3])
{
    struct fog fog;
    uint32_t shapes = fog_of_shapes(f, p);
    fog.above = brume_along_zenith(f, p) - f->lit.fog.base;
    fog.by_height = fog_by_height(f, fog.above);
    fog.all = fog.by_height + shapes;
    if (fog.all < shapes)
        fog.all = 0xffffffffu;
    return fog;
}

/* 1 - exp(-fog * step), Q0.32. Off by 2^-16 of itself; where that is above
 * 1/16, by 2^-15 of what comes through. */
static inline uint32_t fog_opacity(const struct brume_frame *f, uint32_t fog)
{
    int32_t up = f->lit.fog.step_log2; /* -3 .. 9 */
    uint32_t n = mul_hi_floor(fog, f->lit.fog.step);
    uint32_t whole = up > 0 ? n >> (32 - up) : 0; /* Q0 */
    uint32_t part = up > 0 ? n << up : n >> -up;  /* Q0.32 */
    uint32_t sixteenths = whole << 4 | part >> 28;
    if (sixteenths > 255u)
        return 0xffffffffu;
    /* r - r^2/2 + r^3/6; r^4/24 < 2^-20 is dropped */
    uint32_t r = part & 0x0fffffffu, square = mul_hi_floor(r, r);
    uint32_t o =
        r - (square >> 1) + mul_hi_floor(mul_hi_floor(square, r), 715827883u);
    if (sixteenths == 0)
        return o;
    return ~mul_hi_floor((uint32_t)brume_exp_coarse[sixteenths] << 17, ~o);
}

/// Towards the sun ///

#define MOST_DEPTH (1u << 28) /* Q9.23: 32, which is black */

/* Of the way from p, and further there: p + way, if that is within
 * coordinates of +-32768. */
static inline bool fog_place(uint32_t q[3], const uint32_t p[3],
                             const int32_t way[3])
{
    bool within = true;
    for (int i = 0; i < 3; i++) {
        q[i] = p[i] + (uint32_t)way[i];
        bool out = (p[i] ^ q[i]) & ((uint32_t)way[i] ^ q[i]) & 0x80000000u;
        within = within && !out;
    }
    return within;
}

/* Depth of the shapes at samples 2^i light steps away, for that length each;
 * Q9.23. */
static inline uint32_t shapes_doubling(const struct brume_frame *f,
                                       const struct brume_light_ray *light,
                                       const uint32_t p[3], uint32_t sum)
{
    const uint32_t step = f->light_step << 7; /* Q23, <= 2^31 */
    int32_t way[3] = {light->first[0], light->first[1], light->first[2]};
    for (uint32_t i = 0; i < f->lit.fog.light_samples; i++) {
        uint32_t q[3], most = 0;
        if (!fog_place(q, p, way))
            break;
        uint32_t part = mul_hi_floor(fog_of_shapes(f, q), step);
        if (part >= MOST_DEPTH >> i || sum + (part << i) >= MOST_DEPTH)
            return MOST_DEPTH;
        sum += part << i;
        for (int axis = 0; axis < 3; axis++)
            most |= magnitude(way[axis]);
        if (most >> 30 != 0 || i == 15)
            break;
        for (int axis = 0; axis < 3; axis++)
            way[axis] *= 2;
    }
    return sum;
}

/* The same at equal distances. */
static inline uint32_t shapes_uniform(const struct brume_frame *f,
                                      const struct brume_light_ray *light,
                                      const uint32_t p[3])
{
    const uint32_t step = f->light_step << 7;
    uint32_t q[3], sum = 0;
    bool within = fog_place(q, p, light->first);
    for (uint32_t i = 0; within && i < f->lit.fog.light_samples; i++) {
        const uint32_t at[3] = {q[0], q[1], q[2]};
        sum += mul_hi_floor(fog_of_shapes(f, at), step);
        if (sum >= MOST_DEPTH)
            return MOST_DEPTH;
        within = fog_place(q, at, f->light_line.move);
    }
    return sum;
}

static inline uint32_t shapes_depth(const struct brume_frame *f,
                                    const struct brume_light_ray *light,
                                    const uint32_t p[3], uint32_t here)
{
    if (f->lit.fog.shape_count == 0)
        return 0;
    switch (f->lit.light) {
    case BRUME_NO_LIGHT: return 0;
    case BRUME_UNIFORM: return shapes_uniform(f, light, p);
    case BRUME_LOG: return shapes_doubling(f, light, p, 0);
    default: /* what is here stands for the first step */
        return shapes_doubling(f, light, p,
                               mul_hi_floor(here, f->light_step << 7));
    }
}

/* Optical depth of fog from p towards the sun, Q13. */
static inline uint32_t fog_depth(const struct brume_frame *f,
                                 const struct brume_light_ray *light,
                                 const uint32_t p[3], const struct fog *here)
{
    const struct brume_lit_fog *fog = &f->lit.fog;
    uint32_t way = fog->way;
    if (f->lit.light == BRUME_NO_LIGHT)
        return 0;
    if (here->above < 0 && fog->per_rise.m != 0) {
        uint32_t up = brume_times(magnitude(here->above), 0, fog->per_rise);
        way = up < fog->most_way - way ? way + up : fog->most_way;
    }
    uint32_t shapes = shapes_depth(f, light, p, here->all - here->by_height);
    return (mul_hi_floor(here->by_height, way << 1) >> 4) + (shapes >> 10);
}

#endif

#endif
