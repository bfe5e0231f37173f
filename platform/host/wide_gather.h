/* SPDX-License-Identifier: MIT */
/*
 * Lanes and memory: one load for each lane, tables, cubes of eight bytes, and
 * the lanes of a mask put close together.
 */
#ifndef BRUME_HOST_WIDE_GATHER_H
#define BRUME_HOST_WIDE_GATHER_H

#include "brume.h"
#include "wide_lanes.h"

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
    __m256i low =
        _mm256_inserti128_si256(_mm256_castsi128_si256(quad[0]), quad[1], 1);
#if WIDE_LANES == 16
    __m256i high =
        _mm256_inserti128_si256(_mm256_castsi128_si256(quad[2]), quad[3], 1);
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

/* Indices two by two: half the loads. */
LANES_INLINE uint64_t two_words(const uint32_t *from)
{
    uint64_t v;
    memcpy(&v, from, sizeof v);
    return v;
}

/* name_at: base[i[n]] in lane n; and name, with i in lanes. */
#if defined(__AVX2__)
#define GATHER(name, type, insert, places) \
    LANES_INLINE lanes name##_at(const type *p, const uint32_t *i) \
    { \
        __m128i quad[LANES_QUADS]; \
        for (int n = 0; n < LANES_QUADS; n++) { \
            uint64_t low = two_words(i + 4 * n); \
            uint64_t high = two_words(i + 4 * n + 2); \
            __m128i v = _mm_cvtsi32_si128((int)p[(uint32_t)low]); \
            v = insert(v, (int)p[low >> 32], places); \
            v = insert(v, (int)p[(uint32_t)high], 2 * places); \
            quad[n] = insert(v, (int)p[high >> 32], 3 * places); \
        } \
        return lanes_join(quad); \
    } \
    GATHER_LANES(name, type)
#else
#define GATHER(name, type, insert, places) \
    LANES_INLINE lanes name##_at(const type *p, const uint32_t *i) \
    { \
        lanes v; \
        for (unsigned n = 0; n < WIDE_LANES; n++) \
            v[n] = p[i[n]]; \
        return v; \
    } \
    GATHER_LANES(name, type)
#endif
#define GATHER_LANES(name, type) \
    LANES_INLINE lanes name(const type *p, lanes at) \
    { \
        uint32_t i[WIDE_LANES] __attribute__((aligned(64))); \
        lanes_spill(i, at); \
        return name##_at(p, i); \
    }

/* Without optimisation gcc's inserts are macros that narrow by themselves. */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
GATHER(gather_bytes, uint8_t, _mm_insert_epi8, 4)
GATHER(gather_halves, uint16_t, _mm_insert_epi16, 2)
GATHER(gather_words, brume_word_t, _mm_insert_epi32, 1)
#pragma GCC diagnostic pop

/* Elements i[n] and the next of each, the first in the low half. */
#if defined(__AVX2__)
LANES_INLINE int two_halves(const uint16_t *from)
{
    uint32_t v;
    memcpy(&v, from, sizeof v);
    return (int)v;
}
#endif

LANES_INLINE lanes gather_pairs_at(const uint16_t *p, const uint32_t *i)
{
#if defined(__AVX2__)
    __m128i quad[LANES_QUADS];
    for (int n = 0; n < LANES_QUADS; n++) {
        uint64_t low = two_words(i + 4 * n), high = two_words(i + 4 * n + 2);
        __m128i v = _mm_cvtsi32_si128(two_halves(p + (uint32_t)low));
        v = _mm_insert_epi32(v, two_halves(p + (low >> 32)), 1);
        v = _mm_insert_epi32(v, two_halves(p + (uint32_t)high), 2);
        quad[n] = _mm_insert_epi32(v, two_halves(p + (high >> 32)), 3);
    }
    return lanes_join(quad);
#else
    return gather_halves_at(p, i) | gather_halves_at(p + 1, i) << 16;
#endif
}

/// Tables ///

/* table[i] of 256 elements, i < 256. With AVX-512 the table is in registers, by
 * pieces, and permutations look up in all of them: a third of the instructions
 * of a gather. */
LANES_INLINE lanes lanes_of_table32(const uint32_t *table, lanes i)
{
#if defined(__AVX512F__)
    __m512i at = (__m512i)i, piece[8];
    for (int n = 0; n < 8; n++)
        piece[n] =
            _mm512_permutex2var_epi32(_mm512_loadu_si512(table + 32 * n), at,
                                      _mm512_loadu_si512(table + 32 * n + 16));
    for (int bit = 5, n = 4; n > 0; bit++, n /= 2) {
        __mmask16 high =
            _mm512_test_epi32_mask(at, _mm512_set1_epi32(1 << bit));
        for (int k = 0; k < n; k++)
            piece[k] =
                _mm512_mask_mov_epi32(piece[2 * k], high, piece[2 * k + 1]);
    }
    return (lanes)piece[0];
#else
    return gather_words(table, i);
#endif
}

LANES_INLINE lanes lanes_of_table16(const uint16_t *table, lanes i)
{
#if defined(__AVX512F__)
    __m512i at = (__m512i)i, piece[4];
    for (int n = 0; n < 4; n++)
        piece[n] =
            _mm512_permutex2var_epi16(_mm512_loadu_si512(table + 64 * n), at,
                                      _mm512_loadu_si512(table + 64 * n + 32));
    __mmask16 odd = _mm512_test_epi32_mask(at, _mm512_set1_epi32(64));
    __mmask16 high = _mm512_test_epi32_mask(at, _mm512_set1_epi32(128));
    __m512i low = _mm512_mask_mov_epi32(piece[0], odd, piece[1]);
    low = _mm512_mask_mov_epi32(low, high,
                                _mm512_mask_mov_epi32(piece[2], odd, piece[3]));
    return (lanes)_mm512_and_si512(low, _mm512_set1_epi32(0xffff));
#else
    return gather_halves(table, i);
#endif
}

/// Cubes ///

/*
 * Bytes of side^3 voxels, of bricks or with an apron: rows are `side` further,
 * slices its square. mean_of_cubes is the mean of the cubes of eight voxels
 * from number i on by weights wx, wy, wz / 256 in bytes 0, 1, 2 of w: the exact
 * sum of the eight products, of whose 24 fraction bits the low 16 are rounded
 * off.
 *
 * In vectors they are gathered as two words of four bytes, the lower and the
 * upper plane, x first. Bytes less 128 are mixed along x by 8-bit products in
 * pairs,
 *     a (255 - w) + b w + a,  which fits 16 bits,
 * then along y by 16-bit products in pairs, then along z. What 128 was taken
 * from comes out as 2^31, exactly, for the weights' sum is 2^24.
 */
#if defined(__AVX512F__)
typedef __m512i bytes_t;
#define BYTES(name) _mm512_##name
#define BYTES_LOGIC(name) _mm512_##name##_si512
#define BYTES_SPREAD(x) _mm512_broadcast_i32x4(x)
#elif defined(__AVX2__)
typedef __m256i bytes_t;
#define BYTES(name) _mm256_##name
#define BYTES_LOGIC(name) _mm256_##name##_si256
#define BYTES_SPREAD(x) _mm256_broadcastsi128_si256(x)
#endif

#if defined(__AVX2__)

LANES_INLINE int two_bytes(const uint8_t *from)
{
    uint16_t v;
    memcpy(&v, from, sizeof v);
    return v;
}

/* Two rows of two bytes, `row` bytes apart. */
LANES_INLINE lanes gather_rows(const uint8_t *p, const uint32_t *i,
                               uint32_t row)
{
    __m128i quad[LANES_QUADS];
    for (int n = 0; n < LANES_QUADS; n++, i += 4) {
        __m128i v = _mm_cvtsi32_si128(two_bytes(p + i[0]));
        v = _mm_insert_epi16(v, two_bytes(p + i[0] + row), 1);
        v = _mm_insert_epi16(v, two_bytes(p + i[1]), 2);
        v = _mm_insert_epi16(v, two_bytes(p + i[1] + row), 3);
        v = _mm_insert_epi16(v, two_bytes(p + i[2]), 4);
        v = _mm_insert_epi16(v, two_bytes(p + i[2] + row), 5);
        v = _mm_insert_epi16(v, two_bytes(p + i[3]), 6);
        quad[n] = _mm_insert_epi16(v, two_bytes(p + i[3] + row), 7);
    }
    return lanes_join(quad);
}

/* Of both planes. */
LANES_INLINE lanes mean_of_planes(const lanes four[2], lanes w)
{
    const bytes_t xs = BYTES_SPREAD(
        _mm_set_epi8(12, 12, 12, 12, 8, 8, 8, 8, 4, 4, 4, 4, 0, 0, 0, 0));
    const bytes_t ys = BYTES_SPREAD(
        _mm_set_epi8(-1, 13, -1, 13, -1, 9, -1, 9, -1, 5, -1, 5, -1, 1, -1, 1));
    bytes_t wx = BYTES_LOGIC(xor)(BYTES(shuffle_epi8)((bytes_t)w, xs),
                                  BYTES(set1_epi16)(0xff));
    bytes_t wy = BYTES_LOGIC(xor)(BYTES(shuffle_epi8)((bytes_t)w, ys),
                                  BYTES(set1_epi32)(0xffff));
    wy = BYTES(add_epi16)(wy, BYTES(set1_epi32)(0x101));
    lanes plane[2];
    for (int n = 0; n < 2; n++) {
        bytes_t v = (bytes_t)(four[n] ^ 0x80808080u);
        bytes_t a = BYTES(srai_epi16)(BYTES(slli_epi16)(v, 8), 8);
        bytes_t x = BYTES(add_epi16)(BYTES(maddubs_epi16)(wx, v), a);
        plane[n] = (lanes)BYTES(madd_epi16)(x, wy);
    }
    lanes sum = (plane[0] << 8) + (plane[1] - plane[0]) * (w >> 16);
    return (sum + 0x80008000u) >> 16;
}

#endif

LANES_INLINE lanes mean_of_cubes(const uint8_t *p, uint32_t side,
                                 const uint32_t *i, lanes w)
{
#if defined(__AVX2__)
    const lanes four[2] = {gather_rows(p, i, side),
                           gather_rows(p + side * side, i, side)};
    return mean_of_planes(four, w);
#else
    lanes wx = w & 255u, wy = w >> 8 & 255u, wz = w >> 16, plane[2];
    for (int z = 0; z < 2; z++, p += side * side) {
        lanes row[2];
        for (uint32_t y = 0; y < 2; y++) {
            lanes a = gather_bytes_at(p + side * y, i);
            lanes b = gather_bytes_at(p + side * y + 1, i);
            row[y] = (a << 8) + (b - a) * wx;
        }
        plane[z] = (row[0] << 8) + (row[1] - row[0]) * wy;
    }
    lanes sum = (plane[0] << 8) + (plane[1] - plane[0]) * wz;
    return (sum + 0x8000u) >> 16;
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
