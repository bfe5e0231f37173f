/* SPDX-License-Identifier: MIT */
/*
 * Lanes: a vector of 32-bit words, one for each of the rays that are marched
 * side by side. Sums, products, shifts and bits are operators, by GCC's and
 * Clang's vector extensions; this file has what these lack, for each of
 *
 *     AVX-512 (F, BW, DQ, VL, CD)   16 lanes, masks in mask registers
 *     AVX2                           8 lanes
 *     anything else                  WIDE_LANES lanes, loops
 *
 * so that wide_march.c is written once. Included by files that are compiled
 * for one of them.
 */
#ifndef BRUME_HOST_WIDE_LANES_H
#define BRUME_HOST_WIDE_LANES_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#if defined(__AVX512F__)
#include <immintrin.h>
#define WIDE_LANES 16
#elif defined(__AVX2__)
#include <immintrin.h>
#define WIDE_LANES 8
#else
#define WIDE_LANES 4
#endif

#define LANES_INLINE static inline __attribute__((always_inline))

typedef uint32_t lanes __attribute__((vector_size(4 * WIDE_LANES)));
typedef int32_t lanes_signed __attribute__((vector_size(4 * WIDE_LANES)));
typedef float lanes_float __attribute__((vector_size(4 * WIDE_LANES)));

#if defined(__AVX512F__)
typedef __mmask16 lanes_mask;
#else
typedef lanes lanes_mask; /* all ones or zero */
#endif

LANES_INLINE lanes lanes_of(uint32_t a)
{
    return (lanes){0} + a;
}

/* 0, 1, 2, ... */
LANES_INLINE lanes lanes_count(void)
{
    lanes v;
    for (unsigned i = 0; i < WIDE_LANES; i++)
        v[i] = i;
    return v;
}

LANES_INLINE lanes lanes_load(const uint32_t *from)
{
    lanes v;
    memcpy(&v, from, sizeof v);
    return v;
}

LANES_INLINE void lanes_store(uint32_t *to, lanes v)
{
    memcpy(to, &v, sizeof v);
}

/// Masks ///

#if defined(__AVX512F__)

/* The first n lanes, n <= 16. */
LANES_INLINE lanes_mask mask_first(unsigned n)
{
    return (lanes_mask)((1u << n) - 1u);
}

LANES_INLINE lanes_mask mask_less(lanes a, lanes b)
{
    return _mm512_cmplt_epu32_mask((__m512i)a, (__m512i)b);
}

LANES_INLINE lanes_mask mask_equal(lanes a, lanes b)
{
    return _mm512_cmpeq_epu32_mask((__m512i)a, (__m512i)b);
}

/* Lanes whose highest bit is set. */
LANES_INLINE lanes_mask mask_high(lanes a)
{
    return _mm512_movepi32_mask((__m512i)a);
}

LANES_INLINE lanes_mask mask_and(lanes_mask a, lanes_mask b)
{
    return a & b;
}

LANES_INLINE lanes_mask mask_or(lanes_mask a, lanes_mask b)
{
    return a | b;
}

/* a but not b */
LANES_INLINE lanes_mask mask_less_those(lanes_mask a, lanes_mask b)
{
    return (lanes_mask)(a & ~b);
}

LANES_INLINE unsigned mask_bits(lanes_mask m)
{
    return m;
}

LANES_INLINE lanes lanes_select(lanes_mask m, lanes yes, lanes no)
{
    return (lanes)_mm512_mask_mov_epi32((__m512i)no, m, (__m512i)yes);
}

LANES_INLINE lanes lanes_where(lanes_mask m, lanes a)
{
    return (lanes)_mm512_maskz_mov_epi32(m, (__m512i)a);
}

#else

LANES_INLINE lanes_mask mask_first(unsigned n)
{
    lanes m;
    for (unsigned i = 0; i < WIDE_LANES; i++)
        m[i] = i < n ? 0xffffffffu : 0;
    return m;
}

LANES_INLINE lanes_mask mask_less(lanes a, lanes b)
{
    return (lanes)(a < b);
}

LANES_INLINE lanes_mask mask_equal(lanes a, lanes b)
{
    return (lanes)(a == b);
}

LANES_INLINE lanes_mask mask_high(lanes a)
{
    return (lanes)((lanes_signed)a >> 31);
}

LANES_INLINE lanes_mask mask_and(lanes_mask a, lanes_mask b)
{
    return a & b;
}

LANES_INLINE lanes_mask mask_or(lanes_mask a, lanes_mask b)
{
    return a | b;
}

LANES_INLINE lanes_mask mask_less_those(lanes_mask a, lanes_mask b)
{
    return a & ~b;
}

LANES_INLINE unsigned mask_bits(lanes_mask m)
{
#if defined(__AVX2__)
    return (unsigned)_mm256_movemask_ps((__m256)m);
#else
    unsigned bits = 0;
    for (unsigned i = 0; i < WIDE_LANES; i++)
        bits |= (m[i] & 1u) << i;
    return bits;
#endif
}

LANES_INLINE lanes lanes_select(lanes_mask m, lanes yes, lanes no)
{
#if defined(__AVX2__)
    return (lanes)_mm256_blendv_epi8((__m256i)no, (__m256i)yes, (__m256i)m);
#else
    return (yes & m) | (no & ~m);
#endif
}

LANES_INLINE lanes lanes_where(lanes_mask m, lanes a)
{
    return a & m;
}

#endif

LANES_INLINE lanes lanes_unless(lanes_mask m, lanes a)
{
#if defined(__AVX512F__)
    return lanes_where((lanes_mask)~m, a);
#else
    return a & ~m;
#endif
}

LANES_INLINE bool mask_any(lanes_mask m)
{
    return mask_bits(m) != 0;
}

/// Arithmetic ///

LANES_INLINE lanes lanes_min(lanes a, lanes b)
{
#if defined(__AVX512F__)
    return (lanes)_mm512_min_epu32((__m512i)a, (__m512i)b);
#elif defined(__AVX2__)
    return (lanes)_mm256_min_epu32((__m256i)a, (__m256i)b);
#else
    return lanes_select(mask_less(a, b), a, b);
#endif
}

LANES_INLINE lanes lanes_max(lanes a, lanes b)
{
#if defined(__AVX512F__)
    return (lanes)_mm512_max_epu32((__m512i)a, (__m512i)b);
#elif defined(__AVX2__)
    return (lanes)_mm256_max_epu32((__m256i)a, (__m256i)b);
#else
    return lanes_select(mask_less(a, b), b, a);
#endif
}

/* Zero bits above the highest set one; 32 for 0. */
LANES_INLINE lanes lanes_leading_zeros(lanes a)
{
#if defined(__AVX512CD__)
    return (lanes)_mm512_lzcnt_epi32((__m512i)a);
#elif defined(__AVX2__)
    /* The exponent of the word as a float; bits that could round it up to the
     * next power are cleared. A negative word's is never less than 31. */
    __m256i cleared =
        _mm256_andnot_si256(_mm256_srli_epi32((__m256i)a, 1), (__m256i)a);
    lanes e = (lanes)_mm256_cvtepi32_ps(cleared) << 1 >> 24;
    e = 158u - lanes_max(e, lanes_of(126));
    return lanes_select(mask_high(a), lanes_of(0), e);
#else
    for (unsigned i = 0; i < WIDE_LANES; i++)
        a[i] = a[i] == 0 ? 32u : (uint32_t)__builtin_clz(a[i]);
    return a;
#endif
}

#if defined(__AVX2__)
/* Words to doubles, by the mantissa of 2^52 + a. */
LANES_INLINE __m256d doubles_of(__m128i a)
{
    const __m256d magic = _mm256_set1_pd(0x1p52);
    __m256i bits =
        _mm256_or_si256(_mm256_cvtepu32_epi64(a), _mm256_castpd_si256(magic));
    return _mm256_sub_pd(_mm256_castsi256_pd(bits), magic);
}

/* floor(a / b) as the low words of four 64-bit ones. */
LANES_INLINE __m256i quotient_of_four(__m128i a, __m128i b)
{
    __m256d q = _mm256_floor_pd(_mm256_div_pd(doubles_of(a), doubles_of(b)));
    return _mm256_castpd_si256(_mm256_add_pd(q, _mm256_set1_pd(0x1p52)));
}
#endif

/* floor(a / b), b > 0. A quotient that is no integer is farther from the next
 * one than doubles round it. */
LANES_INLINE lanes lanes_quotient(lanes a, lanes b)
{
#if defined(__AVX512F__)
    __m512d low =
        _mm512_div_pd(_mm512_cvtepu32_pd(_mm512_castsi512_si256((__m512i)a)),
                      _mm512_cvtepu32_pd(_mm512_castsi512_si256((__m512i)b)));
    __m512d high = _mm512_div_pd(
        _mm512_cvtepu32_pd(_mm512_extracti64x4_epi64((__m512i)a, 1)),
        _mm512_cvtepu32_pd(_mm512_extracti64x4_epi64((__m512i)b, 1)));
    return (lanes)_mm512_inserti64x4(
        _mm512_castsi256_si512(_mm512_cvttpd_epu32(low)),
        _mm512_cvttpd_epu32(high), 1);
#elif defined(__AVX2__)
    __m256i low = quotient_of_four(_mm256_castsi256_si128((__m256i)a),
                                   _mm256_castsi256_si128((__m256i)b));
    __m256i high = quotient_of_four(_mm256_extracti128_si256((__m256i)a, 1),
                                    _mm256_extracti128_si256((__m256i)b, 1));
    /* Low words: 0 2 4 6 of each, then in order. */
    __m256 both = _mm256_shuffle_ps(_mm256_castsi256_ps(low),
                                    _mm256_castsi256_ps(high), 0x88);
    return (lanes)_mm256_permute4x64_epi64(_mm256_castps_si256(both), 0xd8);
#else
    return a / b;
#endif
}

LANES_INLINE lanes_float lanes_min_float(lanes_float a, lanes_float b)
{
#if defined(__AVX512F__)
    return (lanes_float)_mm512_min_ps((__m512)a, (__m512)b);
#elif defined(__AVX2__)
    return (lanes_float)_mm256_min_ps((__m256)a, (__m256)b);
#else
    for (unsigned i = 0; i < WIDE_LANES; i++)
        a[i] = a[i] < b[i] ? a[i] : b[i];
    return a;
#endif
}

LANES_INLINE lanes_float lanes_max_float(lanes_float a, lanes_float b)
{
#if defined(__AVX512F__)
    return (lanes_float)_mm512_max_ps((__m512)a, (__m512)b);
#elif defined(__AVX2__)
    return (lanes_float)_mm256_max_ps((__m256)a, (__m256)b);
#else
    for (unsigned i = 0; i < WIDE_LANES; i++)
        a[i] = a[i] > b[i] ? a[i] : b[i];
    return a;
#endif
}

/* Of words below 2^31, to the nearest. */
LANES_INLINE lanes_float lanes_to_float(lanes a)
{
    return __builtin_convertvector((lanes_signed)a, lanes_float);
}

/* Of numbers from 0 to 2^31, truncated. */
LANES_INLINE lanes lanes_from_float(lanes_float a)
{
    return (lanes) __builtin_convertvector(a, lanes_signed);
}

/* High words of the products, as mul_hi_floor of the core. */
LANES_INLINE lanes lanes_mul_hi(lanes a, lanes b)
{
#if defined(__AVX512F__)
    __m512i even = _mm512_mul_epu32((__m512i)a, (__m512i)b);
    __m512i odd = _mm512_mul_epu32(_mm512_srli_epi64((__m512i)a, 32),
                                   _mm512_srli_epi64((__m512i)b, 32));
    return (lanes)_mm512_mask_mov_epi32(_mm512_srli_epi64(even, 32), 0xaaaa,
                                        odd);
#elif defined(__AVX2__)
    __m256i even = _mm256_mul_epu32((__m256i)a, (__m256i)b);
    __m256i odd = _mm256_mul_epu32(_mm256_srli_epi64((__m256i)a, 32),
                                   _mm256_srli_epi64((__m256i)b, 32));
    return (lanes)_mm256_blend_epi32(_mm256_srli_epi64(even, 32), odd, 0xaa);
#else
    for (unsigned i = 0; i < WIDE_LANES; i++)
        a[i] = (uint32_t)((uint64_t)a[i] * b[i] >> 32);
    return a;
#endif
}

/* Shift of each lane by its own count, below 32. */
LANES_INLINE lanes lanes_shift_right(lanes a, lanes by)
{
    return a >> by;
}

#endif
