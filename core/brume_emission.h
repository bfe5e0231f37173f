/* SPDX-License-Identifier: MIT */
/*
 * What a volume gives off itself, from its second grid: docs/light.md, "All
 * that a ray may meet". For brume_lit.c.
 */
#ifndef BRUME_EMISSION_H
#define BRUME_EMISSION_H

#include "brume_ambient.h"

#if BRUME_WITH_EMISSION

/* Code of the voxel at a position, 0 in an empty cell. Bricks of EMIT have no
 * apron, whatever those of the pool have. */
static inline uint32_t emission_code(const struct brume_volume *v, uint32_t x,
                                     uint32_t y, uint32_t z)
{
    uint32_t cell = cell_at(v, x, y, z);
    if (cell & BRUME_CELL_EMPTY)
        return 0;
    uint32_t i = (x >> 16 & 7u) | (y >> 13 & 0x38u) | (z >> 10 & 0x1c0u);
    return v->emission[cell * 512u + i];
}

/* Between the eight voxels around a position, in 1/256 of a code, rounded. The
 * lookup's limit keeps x + 1 and so on in the pool. */
static inline uint32_t emission_between(const struct brume_volume *v,
                                        uint32_t x, uint32_t y, uint32_t z)
{
    uint32_t wx = x >> 8 & 255u, wy = y >> 8 & 255u, wz = z >> 8 & 255u;
    uint32_t one = 0x10000u, plane[2];
    for (uint32_t n = 0; n < 2; n++, z += one) {
        uint32_t low = mix_of(emission_code(v, x, y, z),
                              emission_code(v, x + one, y, z), wx);
        uint32_t high = mix_of(emission_code(v, x, y + one, z),
                               emission_code(v, x + one, y + one, z), wx);
        plane[n] = mix_of(low, high, wy); /* 24 bits */
    }
    return (mix_of(plane[0], plane[1], wz) + 0x8000u) >> 16;
}

/* The second grid at a sample by the scene's filter, in 1/256 of a code: 0 ..
 * 65280. The sample is where a lookup of density may find something. */
static inline uint32_t emission_at(const struct brume_frame *f,
                                   const struct gathered *g,
                                   const uint32_t p[3])
{
    const struct brume_volume *v = f->volume;
    if (f->kernel & 4u)
        return emission_between(v, p[0], p[1], p[2]);
    return emission_code(v, p[0] + g->moved[0], p[1] + g->moved[1],
                         p[2] + g->moved[2])
           << 8;
}

/* Adds `glowing`, Q1.31, of the colour of m, between those of two codes. */
static inline void add_glow(const struct brume_frame *f, struct gathered *g,
                            uint32_t m, uint32_t glowing)
{
    const uint32_t(*colour)[3] = f->lit.lighting->emission_colour;
    uint32_t code = m >> 8, w = m & 255u, next = code + (w != 0);
    for (uint32_t c = 0; c < (BRUME_WITH_COLOUR ? 3u : 1u); c++) {
        /* Q16.16 of at most 16 with 8 bits more: <= 2^28 */
        uint32_t light = mix_of(colour[code][c], colour[next][c], w);
        g->glow[c] += mul_hi_floor(glowing, light << 3); /* Q6.26 */
    }
}

/* What the sample at p glows: returns the loss, Q1.31, and makes *fade, its
 * 1 - a in Q0.32, the share (1 - a)(1 + b) / 2 of what scatters. The two never
 * take more than there is: with half of the product rounded up, fade + glow is
 * at most 1 - a b. Not inlined: it costs the march of other scenes registers.
 */
#if defined(__GNUC__)
__attribute__((noinline))
#endif
static uint32_t
glow_of(const struct brume_frame *f, struct gathered *g, const uint32_t p[3],
        uint32_t transmittance, uint32_t *fade)
{
    uint32_t m = emission_at(f, g, p);
    uint32_t glow = ~mul_hi_floor(f->lit.emission[m >> 8],
                                  f->lit.emission[256u + (m & 255u)]);
    uint32_t both = mul_hi_floor(*fade, glow);
    if (m == 0)
        return 0;
    if (both != 0)
        both = (both >> 1) + 1u;
    *fade -= both;
    uint32_t glowing = mul_hi_floor(transmittance, glow - both);
    add_glow(f, g, m, glowing);
    return glowing;
}

#endif

#endif
