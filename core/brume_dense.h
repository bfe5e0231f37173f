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
