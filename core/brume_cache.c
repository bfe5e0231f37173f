/* SPDX-License-Identifier: MIT */
/*
 * The cache of the sun's optical depth, made on the device: rows of points at
 * a time, so that a sun that moves costs a little of each frame.
 */
#include "brume_dense.h"

#if BRUME_WITH_CACHE

/* Longest way through the pool in voxels, at most 17 % more. */
static uint32_t longest_way(const struct brume_volume *v)
{
    uint32_t sum = 0, most = 0;
    for (int i = 0; i < 3; i++) {
        uint32_t n = 8u * v->cell_count[i];
        most = n > most ? n : most;
        sum += n;
    }
    return most + (((sum - most) * 3u + 7u) >> 3);
}

size_t brume_cache_bytes(const struct brume_volume *volume,
                         unsigned spacing_log2)
{
    const uint16_t *c = volume->cell_count;
    if (spacing_log2 < 1 || spacing_log2 > 3)
        return 0;
    uint32_t plane = (uint32_t)c[0] * c[1]; /* < 2^24 */
    unsigned up = 9u - 3u * spacing_log2;
    if (mul_hi_floor(plane, (uint32_t)c[2] << up) != 0)
        return 0;
    return plane * ((uint32_t)c[2] << up);
}

int brume_cache_begin(struct brume_cache *cache,
                      const struct brume_volume *volume, unsigned spacing_log2,
                      const uint8_t *codes)
{
    if (cache == NULL || volume == NULL || codes == NULL)
        return BRUME_ERR_NULL;
    if (brume_cache_bytes(volume, spacing_log2) == 0)
        return BRUME_ERR_SIZE;
    cache->from = cache->to = codes;
    cache->blend = 0;
    cache->spacing_log2 = (uint8_t)spacing_log2;
    for (int i = 0; i < 3; i++)
        cache->size[i] = (uint16_t)(8u * volume->cell_count[i] >> spacing_log2);
    /* The largest code, 2^(255/24) = 1580 units, is the longest way through
     * the greatest density. */
    cache->unit = brume_number_mul(
        volume->density_max,
        brume_number_mul(brume_number_of(longest_way(volume), 0),
                         brume_number_inverse(brume_number_of(1579, 0))));
    return BRUME_OK;
}

int brume_cache_rows(const struct brume_cache *cache, uint8_t *codes,
                     const struct brume_frame *frame, uint32_t row,
                     uint32_t rows)
{
    if (cache == NULL || codes == NULL || frame == NULL)
        return BRUME_ERR_NULL;
    const struct brume_frame *f = frame;
    uint32_t all = (uint32_t)cache->size[1] * cache->size[2];
    uint32_t s = cache->spacing_log2, half = brume_half_voxel(f);
    if (row > all || rows > all - row)
        return BRUME_ERR_RECT;
    for (int i = 0; i < 3; i++)
        if (cache->size[i] != 8u * f->volume->cell_count[i] >> s)
            return BRUME_ERR_SIZE;
    if (!f->lit.on || f->lit.light == BRUME_CACHE ||
        f->lit.light == BRUME_NO_LIGHT)
        return BRUME_ERR_SCENE;
    struct brume_number per_unit = units_of_cache(cache);
    for (uint32_t r = row; r < row + rows; r++) {
        uint32_t p[3] = {0, r % cache->size[1], r / cache->size[1]};
        for (int i = 1; i < 3; i++)
            p[i] = middle_of_point(p[i], s) - half;
        for (uint32_t x = 0; x < cache->size[0]; x++) {
            p[0] = middle_of_point(x, s) - half;
            codes[r * cache->size[0] + x] =
                code_of_sum(f, brume_lit_sun_sum(f, p), per_unit);
        }
    }
    return BRUME_OK;
}

#endif
