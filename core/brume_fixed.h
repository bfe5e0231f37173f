/* SPDX-License-Identifier: MIT */
/*
 * Fixed-point operations. The name says operand widths and rounding: `floor`
 * truncates towards minus infinity, `round` goes to the nearest.
 *
 * With -DBRUME_FIXED_DEBUG every stated bound is checked where it is relied
 * on, and a broken one traps. The pixels are the same.
 */
#ifndef BRUME_FIXED_H
#define BRUME_FIXED_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define BRUME_INLINE static inline __attribute__((always_inline))
#define BRUME_APART static __attribute__((noinline))
#define BRUME_OPAQUE(v) __asm__("" : "+r"(v))
#else
#define BRUME_INLINE static inline
#define BRUME_APART static
#define BRUME_OPAQUE(v) ((void)0)
#endif
#if defined(__GNUC__) && __GNUC__ >= 7 || defined(__clang__)
#define BRUME_FALLTHROUGH __attribute__((fallthrough))
#else
#define BRUME_FALLTHROUGH ((void)0)
#endif

#ifdef BRUME_FIXED_DEBUG
#define BRUME_CHECK(cond) ((cond) ? (void)0 : __builtin_trap())
#else
#define BRUME_CHECK(cond) ((void)0)
#endif

/* Counting: BRUME_CONFIG may define this to see how often the march does what.
 * By default it is nothing. Names: rays_in_pool, view_samples (lookups on view
 * rays), lit_samples (those with density enough), light_samples (lookups on
 * light rays). */
#ifndef BRUME_TALLY
#define BRUME_TALLY(name, n) ((void)0)
#endif

/* One instruction for a 32x32 -> 64 bit product? Cortex-M0 has none, and its
 * compilers would call a helper: there four 16-bit products are used. */
#ifndef BRUME_MUL64
#if defined(__ARM_ARCH_6M__) || defined(__ARM_ARCH_8M_BASE__) || \
    defined(__AVR__)
#define BRUME_MUL64 0
#else
#define BRUME_MUL64 1
#endif
#endif

/* One instruction to count leading zeros? Elsewhere compilers would call a
 * helper; there a loop does. */
#ifndef BRUME_CLZ
#if defined(__GNUC__) && \
    (defined(__x86_64__) || defined(__i386__) || defined(__aarch64__) || \
     defined(__ARM_FEATURE_CLZ) || defined(__riscv_zbb) || \
     defined(__powerpc__) || defined(__s390x__) || defined(__wasm__))
#define BRUME_CLZ 1
#else
#define BRUME_CLZ 0
#endif
#endif

/* Zero bits above the highest set one; a > 0. */
BRUME_INLINE unsigned leading_zeros(uint32_t a)
{
    BRUME_CHECK(a != 0);
#if BRUME_CLZ
    return (unsigned)__builtin_clz(a);
#else
    unsigned n = 0;
    for (; a < 0x80000000u; a <<= 1)
        n++;
    return n;
#endif
}

/* High word of a * b: Qa * Qb -> Q(a + b - 32), floor. Any operands. */
BRUME_INLINE uint32_t mul_hi_floor(uint32_t a, uint32_t b)
{
#if BRUME_MUL64
    return (uint32_t)(((uint64_t)a * b) >> 32);
#else
    uint32_t al = a & 0xffffu, ah = a >> 16;
    uint32_t bl = b & 0xffffu, bh = b >> 16;
    uint32_t mid = ah * bl + ((al * bl) >> 16); /* < 2^32 - 2^16 */
    uint32_t low = (mid & 0xffffu) + al * bh;   /* < 2^32 */
    return ah * bh + (mid >> 16) + (low >> 16);
#endif
}

/* Magnitude of a signed word; 2^31 for the lowest one. */
BRUME_INLINE uint32_t magnitude(int32_t a)
{
    return a < 0 ? 0u - (uint32_t)a : (uint32_t)a;
}

/* All ones for a negative word, else 0. */
BRUME_INLINE uint32_t sign_mask(int32_t a)
{
    return a < 0 ? 0xffffffffu : 0;
}

/* The signed word of a magnitude and a sign. m <= 2^31 - 1. */
BRUME_INLINE int32_t with_sign(uint32_t m, bool negative)
{
    BRUME_CHECK(m <= 0x7fffffffu);
    return negative ? -(int32_t)m : (int32_t)m;
}

/* A word as two's complement. C leaves the conversion of large values to the
 * implementation; this spells it out, and compiles to nothing. */
BRUME_INLINE int32_t as_signed(uint32_t a)
{
    return a <= 0x7fffffffu ? (int32_t)a : -(int32_t)(~a) - 1;
}

/* a * b / 2^(32 - up), rounded half away from zero: signed Qa times unsigned
 * Qb -> Q(a + b - 32 + up), 0 <= up <= 7. Precondition: |result| < 2^31. */
BRUME_INLINE int32_t mul_signed_round(int32_t a, uint32_t b, unsigned up)
{
    uint32_t m = magnitude(a);
    uint32_t high = mul_hi_floor(m, b), low = m * b;
    uint32_t r = (high << up) | (up ? low >> (32u - up) : 0u);
    uint32_t half = (low << up) >> 31; /* the first bit dropped */
    BRUME_CHECK((high >> (31u - up)) == 0u);
    return with_sign(r + half, a < 0);
}

/* Signed Qa * Qb -> Q(a + b - 32 + up), as mul_signed_round. */
BRUME_INLINE int32_t mul_both_signed_round(int32_t a, int32_t b, unsigned up)
{
    int32_t r = mul_signed_round(a, magnitude(b), up);
    return b < 0 ? -r : r;
}

/* a * b < c * d. Any operands but -2^31. */
BRUME_INLINE bool product_less(int32_t a, int32_t b, int32_t c, int32_t d)
{
#if BRUME_MUL64
    return (int64_t)a * b < (int64_t)c * d;
#else
    /* Magnitudes as two words, then signs; a product of 0 has either. */
    uint32_t ma = magnitude(a), mb = magnitude(b);
    uint32_t mc = magnitude(c), md = magnitude(d);
    uint32_t hi = mul_hi_floor(ma, mb), lo = ma * mb;
    uint32_t hi2 = mul_hi_floor(mc, md), lo2 = mc * md;
    bool neg = (a < 0) != (b < 0), neg2 = (c < 0) != (d < 0);
    bool less = hi < hi2 || (hi == hi2 && lo < lo2);
    bool equal = hi == hi2 && lo == lo2;
    if (neg != neg2)
        return neg && (hi | lo | hi2 | lo2) != 0;
    return neg ? !less && !equal : less;
#endif
}

/* A little-endian word of the asset. */
BRUME_INLINE uint32_t le32(uint32_t word)
{
#if defined(__BYTE_ORDER__) && defined(__ORDER_BIG_ENDIAN__)
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    return (word >> 24) | ((word >> 8) & 0xff00u) | ((word & 0xff00u) << 8) |
           (word << 24);
#else
    return word;
#endif
#else
    const uint8_t *b = (const uint8_t *)&word;
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 |
           (uint32_t)b[3] << 24;
#endif
}

#endif
