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
    __m256i cleared = _mm256_andnot_si256(_mm256_srli_epi32((__m256i)a, 1),
                                          (__m256i)a);
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
    __m256i bits = _mm256_or_si256(_mm256_cvtepu32_epi64(a),
                                   _mm256_castpd_si256(magic));
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
    __m512d low = _mm512_div_pd(
        _mm512_cvtepu32_pd(_mm512_castsi512_si256((__m512i)a)),
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
    return (lanes)__builtin_convertvector(a, lanes_signed);
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

/// Memory ///

/*
 * One load for each lane, put together by insertions: on the Zen 4 this was
 * measured on it takes 0.6 cycles a lane while data is in the L1 cache, where
 * the gather instructions take 1.28 (both widths, masked lanes included). It
 * also reads exactly the bytes it needs, so nothing is ever read beyond a
 * table's end or the asset's. Lanes that are not wanted need a valid index.
 */
#if defined(__AVX2__)

#define LANES_QUADS (WIDE_LANES / 4)

LANES_INLINE lanes lanes_join(const __m128i quad[LANES_QUADS])
{
    __m256i low = _mm256_inserti128_si256(_mm256_castsi128_si256(quad[0]),
                                          quad[1], 1);
#if WIDE_LANES == 16
    __m256i high = _mm256_inserti128_si256(_mm256_castsi128_si256(quad[2]),
                                           quad[3], 1);
    return (lanes)_mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
#else
    return (lanes)low;
#endif
}

#endif

/* Stores v where the compiler must load it again, word by word: it would
 * rather take words out of the vector, which costs twice as much. */
LANES_INLINE void lanes_spill(uint32_t to[WIDE_LANES], lanes v)
{
    lanes_store(to, v);
    __asm__("" : "+m"(*(uint32_t(*)[WIDE_LANES])to));
}

/* base[at] */
LANES_INLINE lanes gather_words_at(const void *base, const uint32_t *i)
{
    const uint32_t *p = base;
#if defined(__AVX2__)
    __m128i quad[LANES_QUADS];
    for (int n = 0; n < LANES_QUADS; n++) {
        __m128i v = _mm_loadu_si32(p + i[4 * n]);
        v = _mm_insert_epi32(v, (int)p[i[4 * n + 1]], 1);
        v = _mm_insert_epi32(v, (int)p[i[4 * n + 2]], 2);
        quad[n] = _mm_insert_epi32(v, (int)p[i[4 * n + 3]], 3);
    }
    return lanes_join(quad);
#else
    lanes v;
    for (unsigned n = 0; n < WIDE_LANES; n++)
        v[n] = p[i[n]];
    return v;
#endif
}

LANES_INLINE lanes gather_words(const void *base, lanes at)
{
    uint32_t i[WIDE_LANES] __attribute__((aligned(64)));
    lanes_spill(i, at);
    return gather_words_at(base, i);
}

/* base[at] */
LANES_INLINE lanes gather_bytes_at(const uint8_t *base, const uint32_t *i)
{
#if defined(__AVX2__)
    __m128i quad[LANES_QUADS];
    for (int n = 0; n < LANES_QUADS; n++) {
        __m128i v = _mm_cvtsi32_si128(base[i[4 * n]]);
        v = _mm_insert_epi8(v, base[i[4 * n + 1]], 4);
        v = _mm_insert_epi8(v, base[i[4 * n + 2]], 8);
        quad[n] = _mm_insert_epi8(v, base[i[4 * n + 3]], 12);
    }
    return lanes_join(quad);
#else
    lanes v;
    for (unsigned n = 0; n < WIDE_LANES; n++)
        v[n] = base[i[n]];
    return v;
#endif
}

LANES_INLINE lanes gather_bytes(const uint8_t *base, lanes at)
{
    uint32_t i[WIDE_LANES] __attribute__((aligned(64)));
    lanes_spill(i, at);
    return gather_bytes_at(base, i);
}

/* base[at] */
LANES_INLINE lanes gather_halves_at(const void *base, const uint32_t *i)
{
    const uint16_t *p = base;
#if defined(__AVX2__)
    __m128i quad[LANES_QUADS];
    for (int n = 0; n < LANES_QUADS; n++) {
        __m128i v = _mm_cvtsi32_si128(p[i[4 * n]]);
        v = _mm_insert_epi16(v, p[i[4 * n + 1]], 2);
        v = _mm_insert_epi16(v, p[i[4 * n + 2]], 4);
        quad[n] = _mm_insert_epi16(v, p[i[4 * n + 3]], 6);
    }
    return lanes_join(quad);
#else
    lanes v;
    for (unsigned n = 0; n < WIDE_LANES; n++)
        v[n] = p[i[n]];
    return v;
#endif
}

LANES_INLINE lanes gather_halves(const void *base, lanes at)
{
    uint32_t i[WIDE_LANES] __attribute__((aligned(64)));
    lanes_spill(i, at);
    return gather_halves_at(base, i);
}

/// Octets ///

/*
 * Eight bytes each, of the corners of a cube: x is bit 0 of a byte's number, y
 * bit 1, z bit 2. mean_of_octets is their mean by weights wx, wy, wz / 256 in
 * bytes 0, 1, 2 of w: the exact sum of the eight products, of whose 24
 * fraction bits the low 16 are rounded off.
 *
 * In vectors, bytes less 128 are mixed along x by 8-bit products in pairs,
 *     a (255 - w) + b w + a,  which fits 16 bits,
 * then along y by 16-bit products in pairs, then along z. What 128 was taken
 * from comes out as 2^31, exactly, for the weights' sum is 2^24.
 */
#if defined(__AVX512F__)
typedef __m512i octets_t;
#define OCTETS(name) _mm512_##name
#define OCTETS_LOGIC(name) _mm512_##name##_si512
#define OCTETS_SPREAD(x) _mm512_broadcast_i32x4(x)
#elif defined(__AVX2__)
typedef __m256i octets_t;
#define OCTETS(name) _mm256_##name
#define OCTETS_LOGIC(name) _mm256_##name##_si256
#define OCTETS_SPREAD(x) _mm256_broadcastsi128_si256(x)
#endif

#if defined(__AVX2__)

/* Sums of products less 2^31, in the low words. w: weights, 64 bits each. */
LANES_INLINE octets_t mix_octets(octets_t v, octets_t w)
{
    const octets_t xs = OCTETS_SPREAD(
        _mm_set_epi8(8, 8, 8, 8, 8, 8, 8, 8, 0, 0, 0, 0, 0, 0, 0, 0));
    const octets_t ys = OCTETS_SPREAD(_mm_set_epi8(
        -1, 9, -1, 9, -1, 9, -1, 9, -1, 1, -1, 1, -1, 1, -1, 1));
    octets_t wx = OCTETS_LOGIC(xor)(OCTETS(shuffle_epi8)(w, xs),
                                    OCTETS(set1_epi16)(0xff));
    octets_t wy = OCTETS_LOGIC(xor)(OCTETS(shuffle_epi8)(w, ys),
                                    OCTETS(set1_epi32)(0xffff));
    wy = OCTETS(add_epi16)(wy, OCTETS(set1_epi32)(0x101));
    v = OCTETS_LOGIC(xor)(v, OCTETS(set1_epi8)(-128));
    octets_t a = OCTETS(srai_epi16)(OCTETS(slli_epi16)(v, 8), 8);
    octets_t x = OCTETS(add_epi16)(OCTETS(maddubs_epi16)(wx, v), a);
    octets_t y = OCTETS(madd_epi16)(x, wy);
    octets_t rise = OCTETS(sub_epi32)(OCTETS(srli_epi64)(y, 32), y);
    octets_t z = OCTETS(mul_epu32)(rise, OCTETS(srli_epi64)(w, 16));
    return OCTETS(add_epi32)(OCTETS(slli_epi32)(y, 8), z);
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
    octets_t half[2];
    for (int n = 0; n < 2; n++, i += 8) {
        __m256i low = _mm256_inserti128_si256(
            _mm256_castsi128_si256(load_octets(p, i[0], i[1])),
            load_octets(p, i[2], i[3]), 1);
        __m256i high = _mm256_inserti128_si256(
            _mm256_castsi128_si256(load_octets(p, i[4], i[5])),
            load_octets(p, i[6], i[7]), 1);
        octets_t v =
            _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
        __m256i ws = n ? _mm512_extracti64x4_epi64((__m512i)w, 1)
                       : _mm512_castsi512_si256((__m512i)w);
        half[n] = mix_octets(v, _mm512_cvtepu32_epi64(ws));
    }
    const __m512i low_words =
        _mm512_set_epi32(30, 28, 26, 24, 22, 20, 18, 16, 14, 12, 10, 8, 6, 4,
                         2, 0);
    lanes sum = (lanes)_mm512_permutex2var_epi32(half[0], low_words, half[1]);
    return (sum + 0x80008000u) >> 16;
#elif defined(__AVX2__)
    __m256 half[2];
    for (int n = 0; n < 2; n++, i += 4) {
        octets_t v = _mm256_inserti128_si256(
            _mm256_castsi128_si256(load_octets(p, i[0], i[1])),
            load_octets(p, i[2], i[3]), 1);
        __m128i ws = n ? _mm256_extracti128_si256((__m256i)w, 1)
                       : _mm256_castsi256_si128((__m256i)w);
        half[n] =
            _mm256_castsi256_ps(mix_octets(v, _mm256_cvtepu32_epi64(ws)));
    }
    __m256i both =
        _mm256_castps_si256(_mm256_shuffle_ps(half[0], half[1], 0x88));
    lanes sum = (lanes)_mm256_permute4x64_epi64(both, 0xd8);
    return (sum + 0x80008000u) >> 16;
#else
    for (unsigned n = 0; n < WIDE_LANES; n++) {
        uint32_t sum = 0x8000u;
        for (uint32_t b = 0; b < 8; b++) {
            uint32_t product = p[i[n]] >> 8 * b & 255u;
            for (uint32_t axis = 0; axis < 3; axis++) {
                uint32_t u = w[n] >> 8 * axis & 255u;
                product *= b >> axis & 1u ? u : 256u - u;
            }
            sum += product;
        }
        w[n] = sum >> 16;
    }
    return w;
#endif
}

/// Packing ///

/* Stores the lanes of m, close together, to `to`, which has room for all. */
#if defined(__AVX512F__)
LANES_INLINE void lanes_pack(uint32_t *to, lanes v, lanes_mask m)
{
    lanes_store(to, (lanes)_mm512_maskz_compress_epi32(m, (__m512i)v));
}
#elif defined(__AVX2__)
LANES_INLINE __m256i pack_order(unsigned bits)
{
    /* Numbers of the set bits, 3 bits each, from lane 0 on. */
    uint64_t spread = _pdep_u64(bits, 0x0101010101010101u) * 255u;
    uint64_t order = _pext_u64(0x0706050403020100u, spread);
    return _mm256_cvtepu8_epi32(_mm_cvtsi64_si128((int64_t)order));
}
LANES_INLINE void lanes_pack(uint32_t *to, lanes v, lanes_mask m)
{
    __m256i order = pack_order(mask_bits(m));
    lanes_store(to, (lanes)_mm256_permutevar8x32_epi32((__m256i)v, order));
}
#else
LANES_INLINE void lanes_pack(uint32_t *to, lanes v, lanes_mask m)
{
    for (unsigned i = 0; i < WIDE_LANES; i++)
        if (m[i])
            *to++ = v[i];
}
#endif

#endif
