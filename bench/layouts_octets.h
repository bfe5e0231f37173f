/* SPDX-License-Identifier: MIT */
/*
 * Octets: eight bytes each, of the corners of a cube, in lanes. x is bit 0 of a
 * byte's number, y bit 1, z bit 2. They are mixed as cubes are in
 * wide_gather.h.
 */
#ifndef BRUME_BENCH_LAYOUTS_OCTETS_H
#define BRUME_BENCH_LAYOUTS_OCTETS_H

#include "wide_gather.h"

#if defined(__AVX2__)

/* Sums of products less 2^31, in the low words. w: weights, 64 bits each. */
LANES_INLINE bytes_t mix_octets(bytes_t v, bytes_t w)
{
    const bytes_t xs = BYTES_SPREAD(
        _mm_set_epi8(8, 8, 8, 8, 8, 8, 8, 8, 0, 0, 0, 0, 0, 0, 0, 0));
    const bytes_t ys = BYTES_SPREAD(
        _mm_set_epi8(-1, 9, -1, 9, -1, 9, -1, 9, -1, 1, -1, 1, -1, 1, -1, 1));
    bytes_t wx =
        BYTES_LOGIC(xor)(BYTES(shuffle_epi8)(w, xs), BYTES(set1_epi16)(0xff));
    bytes_t wy =
        BYTES_LOGIC(xor)(BYTES(shuffle_epi8)(w, ys), BYTES(set1_epi32)(0xffff));
    wy = BYTES(add_epi16)(wy, BYTES(set1_epi32)(0x101));
    v = BYTES_LOGIC(xor)(v, BYTES(set1_epi8)(-128));
    bytes_t a = BYTES(srai_epi16)(BYTES(slli_epi16)(v, 8), 8);
    bytes_t x = BYTES(add_epi16)(BYTES(maddubs_epi16)(wx, v), a);
    bytes_t y = BYTES(madd_epi16)(x, wy);
    bytes_t rise = BYTES(sub_epi32)(BYTES(srli_epi64)(y, 32), y);
    bytes_t z = BYTES(mul_epu32)(rise, BYTES(srli_epi64)(w, 16));
    return BYTES(add_epi32)(BYTES(slli_epi32)(y, 8), z);
}

LANES_INLINE __m128i load_octets(const uint64_t *p, uint32_t low, uint32_t high)
{
    return _mm_castps_si128(_mm_loadh_pi(
        _mm_castsi128_ps(_mm_loadl_epi64((const __m128i *)(p + low))),
        (const __m64 *)(p + high)));
}

#endif

LANES_INLINE lanes mean_of_octets(const uint64_t *p, const uint32_t *i, lanes w)
{
#if defined(__AVX512F__)
    bytes_t half[2];
    for (int n = 0; n < 2; n++, i += 8) {
        __m256i low = _mm256_inserti128_si256(
            _mm256_castsi128_si256(load_octets(p, i[0], i[1])),
            load_octets(p, i[2], i[3]), 1);
        __m256i high = _mm256_inserti128_si256(
            _mm256_castsi128_si256(load_octets(p, i[4], i[5])),
            load_octets(p, i[6], i[7]), 1);
        bytes_t v = _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
        __m256i ws = n ? _mm512_extracti64x4_epi64((__m512i)w, 1)
                       : _mm512_castsi512_si256((__m512i)w);
        half[n] = mix_octets(v, _mm512_cvtepu32_epi64(ws));
    }
    const __m512i low_words = _mm512_set_epi32(30, 28, 26, 24, 22, 20, 18, 16,
                                               14, 12, 10, 8, 6, 4, 2, 0);
    lanes sum = (lanes)_mm512_permutex2var_epi32(half[0], low_words, half[1]);
    return (sum + 0x80008000u) >> 16;
#elif defined(__AVX2__)
    __m256 half[2];
    for (int n = 0; n < 2; n++, i += 4) {
        bytes_t v = _mm256_inserti128_si256(
            _mm256_castsi128_si256(load_octets(p, i[0], i[1])),
            load_octets(p, i[2], i[3]), 1);
        __m128i ws = n ? _mm256_extracti128_si256((__m256i)w, 1)
                       : _mm256_castsi256_si128((__m256i)w);
        half[n] = _mm256_castsi256_ps(mix_octets(v, _mm256_cvtepu32_epi64(ws)));
    }
    __m256i both =
        _mm256_castps_si256(_mm256_shuffle_ps(half[0], half[1], 0x88));
    lanes sum = (lanes)_mm256_permute4x64_epi64(both, 0xd8);
    return (sum + 0x80008000u) >> 16;
#endif
}

#endif
