/* SPDX-License-Identifier: MIT */
/*
 * The loads of a march without the march: the places that a frame looked up,
 * in their order, and nothing but a cell's word and the voxel's, gathered or
 * one by one. So what the machine takes for them, with the caches as they are.
 */
#include "ours.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

/* A trilinear lookup reads four rows of two voxels, each within a word. */
static const uint32_t k_rows[4] = {0, 8, 64, 72};

static uint32_t replay1(const struct ours_places *p)
{
    const uint8_t *pool = p->volume->pool;
    uint32_t sum = 0;
    for (size_t i = 0; i < p->count; i++) {
        uint32_t cell = p->volume->cells[p->place[i] >> 9];
        if (cell & BRUME_CELL_EMPTY)
            continue;
        const uint8_t *voxel = pool + cell * 512u + (p->place[i] & 511u);
        for (uint32_t r = 0; r < p->rows; r++)
            sum += voxel[k_rows[r]];
    }
    return sum;
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) static uint32_t
replay8(const struct ours_places *p)
{
    const int *cells = (const int *)p->volume->cells;
    const int *pool = (const int *)(const void *)p->volume->pool;
    const __m256i low = _mm256_set1_epi32(511), none = _mm256_setzero_si256();
    __m256i sum = none;
    for (size_t i = 0; i + 8 <= p->count; i += 8) {
        __m256i at = _mm256_loadu_si256((const __m256i *)(p->place + i));
        __m256i cell =
            _mm256_i32gather_epi32(cells, _mm256_srli_epi32(at, 9), 4);
        __m256i brick = _mm256_cmpgt_epi32(cell, _mm256_set1_epi32(-1));
        at = _mm256_add_epi32(_mm256_slli_epi32(cell, 9),
                              _mm256_and_si256(at, low));
        for (uint32_t r = 0; r < p->rows; r++) {
            __m256i row =
                _mm256_add_epi32(at, _mm256_set1_epi32((int)k_rows[r]));
            sum = _mm256_add_epi32(
                sum, _mm256_mask_i32gather_epi32(none, pool, row, brick, 1));
        }
    }
    return (uint32_t)_mm256_extract_epi32(sum, 0);
}

__attribute__((target("avx512f"))) static uint32_t
replay16(const struct ours_places *p)
{
    const void *cells = (const void *)p->volume->cells, *pool = p->volume->pool;
    const __m512i low = _mm512_set1_epi32(511), none = _mm512_setzero_si512();
    __m512i sum = none;
    for (size_t i = 0; i + 16 <= p->count; i += 16) {
        __m512i at = _mm512_loadu_si512(p->place + i);
        __m512i cell =
            _mm512_i32gather_epi32(_mm512_srli_epi32(at, 9), cells, 4);
        __mmask16 brick = _mm512_cmpgt_epi32_mask(cell, _mm512_set1_epi32(-1));
        at = _mm512_add_epi32(_mm512_slli_epi32(cell, 9),
                              _mm512_and_epi32(at, low));
        for (uint32_t r = 0; r < p->rows; r++) {
            __m512i row =
                _mm512_add_epi32(at, _mm512_set1_epi32((int)k_rows[r]));
            sum = _mm512_add_epi32(
                sum, _mm512_mask_i32gather_epi32(none, brick, row, pool, 1));
        }
    }
    return (uint32_t)_mm512_reduce_add_epi32(sum);
}
#endif

bool ours_can_replay(int lanes)
{
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (lanes == 8)
        return __builtin_cpu_supports("avx2") != 0;
    if (lanes == 16)
        return __builtin_cpu_supports("avx512f") != 0;
#endif
    return lanes == 1;
}

void ours_replay(const struct ours_places *places, int lanes)
{
    static volatile uint32_t sink;
#if defined(__x86_64__)
    if (lanes != 1) {
        sink = lanes == 8 ? replay8(places) : replay16(places);
        return;
    }
#endif
    sink = replay1(places);
    (void)sink;
}
