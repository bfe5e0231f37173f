/* SPDX-License-Identifier: MIT */
/*
 * CRC-32 of large buffers: sixteen bytes a step through tables, or, where the
 * processor multiplies polynomials, sixty-four bytes a step by folding
 * (Gopal et al., "Fast CRC Computation for Generic Polynomials Using PCLMULQDQ
 * Instruction", Intel 2009).
 */
#include "deflate.h"

#include <pthread.h>
#include <stdbool.h>
#include <string.h>

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define FOLDS 1
#else
#define FOLDS 0
#endif

/* Table k advances the CRC of a byte by k more bytes. */
static uint32_t s_table[16][256];
#if FOLDS
static bool s_folds;
#endif
static pthread_once_t s_once = PTHREAD_ONCE_INIT;

static void make_tables(void)
{
    for (uint32_t i = 0; i < 256; i++) {
        uint32_t c = i;
        for (int k = 0; k < 8; k++)
            c = (c >> 1) ^ (0xEDB88320u & (0u - (c & 1u)));
        s_table[0][i] = c;
    }
    for (int k = 1; k < 16; k++)
        for (int i = 0; i < 256; i++) {
            uint32_t c = s_table[k - 1][i];
            s_table[k][i] = (c >> 8) ^ s_table[0][c & 255u];
        }
#if FOLDS
    s_folds = __builtin_cpu_supports("pclmul") != 0;
#endif
}

/* Bytes, with the CRC as the register holds it. */
static uint32_t by_table(uint32_t crc, const uint8_t *p, size_t size)
{
    for (; size >= 16; size -= 16, p += 16) {
        uint32_t next = 0;
        for (unsigned i = 0; i < 4; i++)
            next ^= s_table[15 - i][(p[i] ^ crc >> 8 * i) & 255u];
        for (unsigned i = 4; i < 16; i++)
            next ^= s_table[15 - i][p[i]];
        crc = next;
    }
    for (; size > 0; size--)
        crc = (crc >> 8) ^ s_table[0][(crc ^ *p++) & 255u];
    return crc;
}

#if FOLDS
/* x + (a moved on): a's halves times powers of x modulo the polynomial. */
__attribute__((target("pclmul"))) static inline __m128i
fold(__m128i a, __m128i x, __m128i powers)
{
    __m128i low = _mm_clmulepi64_si128(a, powers, 0x00);
    __m128i high = _mm_clmulepi64_si128(a, powers, 0x11);
    return _mm_xor_si128(x, _mm_xor_si128(low, high));
}

/* A multiple of 64 bytes, at least 64. What is left of them, sixteen bytes
 * with the same remainder, goes through the tables. */
__attribute__((target("pclmul"))) static uint32_t
by_folding(uint32_t crc, const uint8_t *p, size_t size)
{
    /* x^(512 + 32), x^(512 - 32); x^(128 + 32), x^(128 - 32); reflected */
    const __m128i by_512 = _mm_set_epi64x(0x1c6e41596, 0x154442bd4);
    const __m128i by_128 = _mm_set_epi64x(0x0ccaa009e, 0x1751997d0);
    __m128i a[4];
    uint8_t rest[16];
    for (int i = 0; i < 4; i++)
        a[i] = _mm_loadu_si128((const __m128i *)(const void *)(p + 16 * i));
    a[0] = _mm_xor_si128(a[0], _mm_cvtsi32_si128((int)crc));
    for (p += 64, size -= 64; size > 0; p += 64, size -= 64)
        for (int i = 0; i < 4; i++) {
            const void *from = p + 16 * i;
            a[i] = fold(a[i], _mm_loadu_si128((const __m128i *)from), by_512);
        }
    for (int i = 1; i < 4; i++)
        a[i] = fold(a[i - 1], a[i], by_128);
    _mm_storeu_si128((__m128i *)(void *)rest, a[3]);
    return by_table(0, rest, sizeof rest);
}
#endif

uint32_t deflate_crc32(uint32_t crc, const void *data, size_t size)
{
    const uint8_t *p = data;
    pthread_once(&s_once, make_tables);
    crc = ~crc;
#if FOLDS
    if (s_folds && size >= 64) {
        size_t whole = size & ~(size_t)63;
        crc = by_folding(crc, p, whole);
        p += whole;
        size -= whole;
    }
#endif
    return ~by_table(crc, p, size);
}
