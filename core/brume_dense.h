/* SPDX-License-Identifier: MIT */
/* Dense grids of bytes: the cache of the sun's depth, the sky's visibility. */
#ifndef BRUME_DENSE_H
#define BRUME_DENSE_H

#include "brume_lookup.h"

#if BRUME_WITH_CACHE || BRUME_WITH_AMBIENT
/* A dense grid, x fastest, of codes or of plain values. */
struct dense {
    const uint8_t *values;
    uint16_t size[3];
    bool codes; /* of struct brume_cache */
};

/* 2^13 (2^(q/24) - 1), rounded: below 2^24. */
static inline uint32_t depth_of_code(uint32_t q)
{
    static const uint16_t k_power[24] = {
        8192,  8432,  8679,  8933,  9195,  9465,  9742,  10027,
        10321, 10624, 10935, 11255, 11585, 11925, 12274, 12634,
        13004, 13385, 13777, 14181, 14596, 15024, 15464, 15918};
    uint32_t octave = q * 171u >> 12; /* q / 24, exact below 256 */
    return ((uint32_t)k_power[q - 24u * octave] << octave) - 8192u;
}

#if BRUME_WITH_CACHE
/* 1 / unit of a cache; 0 when all is empty. */
static inline struct brume_number units_of_cache(const struct brume_cache *c)
{
    struct brume_number none = {0, 0};
    return c->unit.m != 0 ? brume_number_inverse(c->unit) : none;
}

/* round(24 log2(1 + depth / unit)) of a sum towards the sun */
static inline uint8_t code_of_sum(const struct brume_frame *f, uint32_t sum,
                                  struct brume_number per_unit)
{
    static const struct brume_number k_one = {0x80000000u, -31};
    struct brume_number depth =
        brume_number_mul(brume_number_of(sum, 0), f->lit.sun_unit);
    struct brume_number x =
        brume_number_plus(k_one, brume_number_mul(depth, per_unit));
    uint32_t y = (uint32_t)brume_log2(x); /* Q16.16, < 1024 */
    uint32_t q = (y * 24u + 0x8000u) >> 16;
    return (uint8_t)(q < 255u ? q : 255u);
}

/* Where point i of a cache is along an axis, Q16.16. */
static inline uint32_t middle_of_point(uint32_t i, uint32_t spacing_log2)
{
    return (2u * i + 1u) << (15u + spacing_log2);
}
#endif

/* The point itself: depth as above, or a plain value in Q8.16. */
static inline uint32_t dense_at(const struct dense *g, uint32_t x, uint32_t y,
                                uint32_t z)
{
    uint32_t q = g->values[(z * g->size[1] + y) * g->size[0] + x];
    return g->codes ? depth_of_code(q) : q << 16;
}

/* The cell of 2^log2 that a coordinate is in, of `size` from 0 on; the nearest
 * one when it is outside. */
static inline uint32_t held(uint32_t p, uint32_t size, uint32_t log2)
{
    uint32_t cell = as_signed(p) < 0 ? 0 : p >> log2;
    return cell < size ? cell : size - 1u;
}

/* Between two values below 2^24, rounded; w / 256. */
static inline uint32_t blended(uint32_t a, uint32_t b, uint32_t w)
{
    return (mix_of(a, b, w) + 128u) >> 8;
}

/* Between the eight points around p, Q16.16, the first point at 0. */
static inline uint32_t dense_between(const struct dense *g, const uint32_t p[3])
{
    uint32_t low[3], high[3], weight[3], plane[2];
    for (int i = 0; i < 3; i++) {
        low[i] = held(p[i], g->size[i], 16);
        high[i] = low[i] + (low[i] + 1u < g->size[i] ? 1u : 0);
        weight[i] = as_signed(p[i]) < 0 ? 0 : p[i] >> 8 & 255u;
    }
    for (uint32_t n = 0; n < 2; n++) {
        uint32_t z = n ? high[2] : low[2];
        uint32_t a = blended(dense_at(g, low[0], low[1], z),
                             dense_at(g, high[0], low[1], z), weight[0]);
        uint32_t b = blended(dense_at(g, low[0], high[1], z),
                             dense_at(g, high[0], high[1], z), weight[0]);
        plane[n] = blended(a, b, weight[1]);
    }
    return blended(plane[0], plane[1], weight[2]);
}
#endif

#endif
