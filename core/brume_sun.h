/* SPDX-License-Identifier: MIT */
/*
 * Optical depth towards the sun where a lit march needs it: by samples, by
 * cones of mips, by the cache. For brume_lit.c.
 */
#ifndef BRUME_SUN_H
#define BRUME_SUN_H

#include "brume_dense.h"
#include "brume_light.h"

#if BRUME_WITH_LIGHTING

/* Does the frame's kernel count in codes of 8 bits? */
static inline bool is_narrow_frame(const struct brume_frame *f)
{
    return f->kernel == KERNEL_ID(BRUME_U8, 0, 0, 0, 0) ||
           f->kernel == KERNEL_ID(BRUME_U8, 1, 0, 0, 0);
}

#if BRUME_WITH_CONE
/* A mean of 2^level voxels' cubes around a position, in 16-bit codes; level 1
 * or 2, in a brick. */
static inline uint32_t brick_mean(const struct brume_volume *v, uint32_t x,
                                  uint32_t y, uint32_t z, uint32_t level)
{
    uint32_t cell = cell_at(v, x, y, z), shift = 16u + level;
    uint32_t mask = level == 1 ? 3u : 1u, row = 3u - level;
    if (cell & BRUME_CELL_EMPTY)
        return 0;
    uint32_t i = (x >> shift & mask) | (y >> shift & mask) << row |
                 (z >> shift & mask) << 2u * row;
    uint32_t q = v->mips[cell * 72u + (level == 1 ? 0 : 64u) + i];
    return q * (q + 1u);
}

/* A level of mips from the third on, which are dense grids one after the
 * other. Never goes back. */
struct mip {
    uint32_t level, offset, size[3];
};

static inline void seek_mip(struct mip *m, uint32_t level)
{
    while (m->level < level && (m->size[0] | m->size[1] | m->size[2]) != 1u) {
        m->offset += m->size[0] * m->size[1] * m->size[2];
        m->level++;
        for (int i = 0; i < 3; i++)
            m->size[i] = (m->size[i] + 1u) >> 1;
    }
}

/* Mean density of a cube of 2^level voxels around a position, in 16-bit codes.
 * Level 0 and below: density itself. */
static inline uint32_t mean_at(const struct brume_frame *f, struct mip *m,
                               uint32_t x, uint32_t y, uint32_t z,
                               int32_t level, const struct kernel *k)
{
    uint32_t half = brume_half_voxel(f), d;
    BRUME_TALLY(light_samples, 1);
    if (level <= 0) {
        if (!find_density(f, x, y, z, &d, *k))
            return 0;
        return is_narrow_frame(f) ? d << 8 : d;
    }
    x += half;
    y += half;
    z += half;
    if (level < 3)
        return brick_mean(f->volume, x, y, z, (uint32_t)level);
    seek_mip(m, (uint32_t)level);
    uint32_t s = 16u + m->level;
    uint32_t row = (z >> s) * m->size[1] + (y >> s);
    uint32_t q = f->volume->mips[m->offset + row * m->size[0] + (x >> s)];
    return q * (q + 1u);
}

/* Density along the segments that samples stand for, times their length in
 * light steps: [0, 1) with the sample's own density d, then those of
 * brume_segment_of. < 2^27: a 16-bit code times at most 1280. From inside of
 * the pool it ends where the pool does. */
static inline uint32_t sum_cone(const struct brume_frame *f,
                                const struct brume_light_ray *light,
                                const uint32_t from[3], uint32_t d,
                                const struct kernel *k, bool inside)
{
    const struct brume_volume *v = f->volume;
    struct mip mip = {3,
                      v->bricks * 72u,
                      {v->cell_count[0], v->cell_count[1], v->cell_count[2]}};
    uint32_t sum = is_narrow_frame(f) ? d << 8 : d;
    for (uint32_t i = 0; i < light->samples; i++) {
        struct brume_segment s = brume_segment_of(i, f->light_samples);
        uint32_t p[3];
        for (int a = 0; a < 3; a++)
            p[a] = from[a] + (uint32_t)light->first[a] * s.length +
                   (uint32_t)f->light_line.move[a] * s.before;
        if (p[0] >= f->limit[0] || p[1] >= f->limit[1] || p[2] >= f->limit[2]) {
            if (inside)
                break;
            continue;
        }
        sum += s.length * mean_at(f, &mip, p[0], p[1], p[2],
                                  f->lit.cone_level + (int32_t)s.log2, k);
    }
    return sum;
}
#endif

#if BRUME_WITH_CACHE
/* One point of the cache: the nearest one to a position, or to one moved by
 * less than half of their distance. */
static inline uint32_t cache_point(const struct brume_frame *f,
                                   const uint8_t *values, const uint32_t p[3],
                                   const uint32_t moved[3])
{
    const struct brume_cache *c = &f->lit.cache;
    uint32_t half = brume_half_voxel(f), s = 16u + c->spacing_log2;
    uint32_t x = (p[0] + half) >> s, y = (p[1] + half) >> s;
    uint32_t z = (p[2] + half) >> s;
    if (f->lit.stochastic) {
        uint32_t low = half - (0x8000u << c->spacing_log2), up = s - 16u;
        x = held(p[0] + low + (moved[0] << up), c->size[0], s);
        y = held(p[1] + low + (moved[1] << up), c->size[1], s);
        z = held(p[2] + low + (moved[2] << up), c->size[2], s);
    }
    return depth_of_code(values[(z * c->size[1] + y) * c->size[0] + x]);
}

/* Between the eight points around it. */
static inline uint32_t cache_between(const struct brume_frame *f,
                                     const uint8_t *values, const uint32_t p[3])
{
    const struct brume_cache *c = &f->lit.cache;
    struct dense g = {values, {c->size[0], c->size[1], c->size[2]}, true};
    uint32_t half = brume_half_voxel(f), at[3];
    for (int i = 0; i < 3; i++)
        at[i] = ((p[i] + half) >> c->spacing_log2) - 0x8000u;
    return dense_between(&g, at);
}

/* 2^13 (2^(q/24) - 1), q the cache's code at a position. */
static inline uint32_t sum_cache(const struct brume_frame *f,
                                 const uint32_t p[3], const uint32_t moved[3])
{
    const struct brume_cache *c = &f->lit.cache;
    bool between = f->kernel & 4u;
    uint32_t sum = between ? cache_between(f, c->from, p)
                           : cache_point(f, c->from, p, moved);
    if (c->blend != 0) {
        uint32_t to = between ? cache_between(f, c->to, p)
                              : cache_point(f, c->to, p, moved);
        sum = blended(sum, to, c->blend >> 8);
    }
    return sum;
}
#endif

/* Optical depth towards the sun from inside of the pool, in units of lit.tau.
 */
static inline uint32_t sun_sum(const struct brume_frame *f,
                               const struct brume_light_ray *light,
                               const uint32_t p[3], uint32_t d, uint32_t *reach,
                               const struct kernel *k)
{
    uint32_t x = p[0], y = p[1], z = p[2];
    switch (f->lit.light) {
#if BRUME_WITH_UNIFORM
    case BRUME_UNIFORM: return sum_uniform(f, light, x, y, z, *k);
#endif
#if BRUME_WITH_CONE
    case BRUME_CONE: return sum_cone(f, light, p, d, k, true);
#endif
#if BRUME_WITH_CACHE
    case BRUME_CACHE: return sum_cache(f, p, k->moved);
#endif
    case BRUME_LOG:
        *reach = light_reach(f, light, x, y, z, *reach);
        return sum_log(f, light, x, y, z, *reach, *k);
    default: (void)d; return 0;
    }
}

#endif

#endif
