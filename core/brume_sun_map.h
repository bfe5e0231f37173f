/* SPDX-License-Identifier: MIT */
/* What the sun's map says of a sample of a lit march. For brume_lit.c. */
#ifndef BRUME_SUN_MAP_H
#define BRUME_SUN_MAP_H

#include "brume_inner.h"

#if BRUME_WITH_SURFACE

/* A place relative to the map's origin, Q17.15, along one of its axes, Q18.13.
 * |place| < 2^31, and the axis is of unit length: so the sum is below 2^31. */
static inline int32_t along_map(const struct brume_lit_map *map, int n,
                                const int32_t place[3])
{
    int32_t sum = 0;
    for (int i = 0; i < 3; i++)
        sum += mul_both_signed_round(map->axis[n][i], place[i], 0);
    return sum;
}

/* In texels, Q8, from the middle of the first one; at most 2^23 either way. */
static inline int32_t map_texels(const struct brume_lit_map *map, int n,
                                 const int32_t place[3])
{
    int32_t way = along_map(map, n, place);
    uint32_t texels = brume_times(magnitude(way), 0, map->scale[n]);
    texels = texels < 1u << 23 ? texels : 1u << 23;
    return with_sign(texels, way < 0) - 128;
}

/* Is it light there, `deep` codes below the plane? */
static inline bool texel_is_light(const struct brume_sun_map *map, int32_t x,
                                  int32_t y, uint32_t deep)
{
    if (x < 0 || x >= map->width || y < 0 || y >= map->height)
        return true;
    uint32_t value = map->depth[(size_t)y * map->stride + (uint32_t)x];
    return value == 65535u || value > deep;
}

/* The share of the sun that reaches a position, Q0.16, 0 .. 65536. */
static inline uint32_t sun_map_light(const struct brume_frame *f,
                                     const uint32_t p[3])
{
    const struct brume_lit_map *map = &f->lit.map;
    int32_t place[3];
    for (int i = 0; i < 3; i++)
        place[i] = as_signed(p[i]) / 2 - map->origin[i];
    int32_t below = along_map(map, 2, place);
    if (below < map->bias) /* above the plane, too: bias >= 0 */
        return 0x10000u;
    uint32_t deep =
        brume_times((uint32_t)(below - map->bias), 0, map->scale[2]);
    int32_t u = map_texels(map, 0, place), v = map_texels(map, 1, place);
    uint32_t right = (uint32_t)u & 255u, low = (uint32_t)v & 255u, sum = 0;
    /* floor(u / 256); |u| <= 2^23 + 128 */
    int32_t x = (int32_t)(((uint32_t)u + (1u << 24)) >> 8) - (1 << 16);
    int32_t y = (int32_t)(((uint32_t)v + (1u << 24)) >> 8) - (1 << 16);
    for (int n = 0; n < 4; n++) {
        uint32_t weight =
            (n & 1 ? right : 256u - right) * (n & 2 ? low : 256u - low);
        if (texel_is_light(f->lit.sun_map, x + (n & 1), y + (n >> 1), deep))
            sum += weight;
    }
    return sum;
}

#endif

#endif
