/* SPDX-License-Identifier: MIT */
/*
 * The sun's map in the wide march: core/brume_sun_map.h in lanes, for samples
 * of the queue. Part of wide_march.c.
 */
#ifndef BRUME_HOST_WIDE_SUN_MAP_H
#define BRUME_HOST_WIDE_SUN_MAP_H

#include "wide_patch.h"

/* along_map */
LANES_INLINE lanes along_maps(const struct brume_lit_map *map, int n,
                              const lanes place[3])
{
    return along_axis(map->axis[n], place);
}

/* map_texels */
LANES_INLINE lanes maps_texels(const struct brume_lit_map *map, int n,
                               const lanes place[3])
{
    lanes way = along_maps(map, n, place);
    lanes texels = times_lanes(magnitudes(way), map->scale[n]);
    texels = lanes_min(texels, lanes_of(1u << 23));
    return with_signs(texels, signs_of(way)) - 128u;
}

/* texel_is_light */
static lanes_mask texels_are_light(const struct brume_sun_map *map, lanes x,
                                   lanes y, lanes deep)
{
    uint32_t at[2][WIDE_LANES] __attribute__((aligned(64)));
    uint32_t value[WIDE_LANES] __attribute__((aligned(64)));
    lanes_mask on = mask_and(mask_less(x, lanes_of(map->width)),
                             mask_less(y, lanes_of(map->height)));
    lanes_spill(at[0], lanes_where(on, x));
    lanes_spill(at[1], lanes_where(on, y));
    for (uint32_t n = 0; n < WIDE_LANES; n++)
        value[n] = map->depth[at[1][n] * map->stride + at[0][n]];
    FORGET(value);
    lanes v = lanes_load(value);
    lanes_mask light =
        mask_or(mask_equal(v, lanes_of(65535)), mask_less(deep, v));
    return mask_or(light, mask_less_those(mask_first(WIDE_LANES), on));
}

/* sun_map_light */
static lanes map_lights(const struct brume_frame *f, const lanes p[3])
{
    const struct brume_lit_map *map = &f->lit.map;
    lanes place[3], sum = lanes_of(0), all = lanes_of(0x10000u);
    for (int i = 0; i < 3; i++) /* halves, towards zero */
        place[i] = with_signs(magnitudes(p[i]) >> 1, signs_of(p[i])) -
                   (uint32_t)map->origin[i];
    lanes below = along_maps(map, 2, place);
    lanes bias = lanes_of((uint32_t)map->bias);
    lanes_mask under =
        mask_less_those(mask_first(WIDE_LANES), less_signed(below, bias));
    if (!mask_any(under))
        return all;
    lanes deep = times_lanes(below - bias, map->scale[2]);
    lanes u = maps_texels(map, 0, place), v = maps_texels(map, 1, place);
    lanes x = ((u + (1u << 24)) >> 8) - (1u << 16);
    lanes y = ((v + (1u << 24)) >> 8) - (1u << 16);
    u &= 255u;
    v &= 255u;
    for (uint32_t n = 0; n < 4; n++) {
        lanes weight = (n & 1 ? u : 256u - u) * (n & 2 ? v : 256u - v);
        lanes_mask light =
            texels_are_light(f->lit.sun_map, x + (n & 1), y + (n >> 1), deep);
        sum += lanes_where(light, weight);
    }
    return lanes_select(under, sum, all);
}

/* Of what samples from number `at` of the queue on scatter, what the sun's map
 * leaves of the sun. The sky sees all of it. */
LANES_CALL lanes in_sun(const struct brume_frame *f, const struct queue *q,
                        uint32_t at, lanes lost)
{
    lanes p[3];
    for (int i = 0; i < 3; i++)
        p[i] = lanes_load(q->p[i] + at);
    lanes share = map_lights(f, p);
    return lanes_select(mask_less(share, lanes_of(0x10000u)),
                        lanes_mul_hi(lost, share << 16), lost);
}

#endif
