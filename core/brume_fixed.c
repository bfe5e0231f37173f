/* SPDX-License-Identifier: MIT */
#include "brume_inner.h"

/// Roots and reciprocals ///

uint32_t brume_rsqrt(uint32_t x, unsigned *shift)
{
    *shift = leading_zeros(x) >> 1;
    x <<= 2 * *shift;
    /* Now x in [1/4, 1) and y = 1 / sqrt(x) in (1, 2], held in Q2.30.
     * First guess: the line 2.26 - 1.32 x, within 14 % of y. */
    uint32_t y = 2426656522u - mul_hi_floor(x, 1417339208u);
    for (int i = 0; i < 4; i++) {
        /* Newton: y (3 - x y^2) / 2. Relative error e becomes 1.5 e^2:
         * 3e-2, 1e-3, 2e-6, and then what rounding leaves. */
        uint32_t yy = mul_hi_floor(y, y);   /* Q28 */
        uint32_t xyy = mul_hi_floor(x, yy); /* Q28, < 2^29 */
        y = mul_hi_floor(y, (3u << 28) - xyy) << 3;
    }
    /* Q2.30 -> Q1.31; exactly 2 becomes the largest value below. */
    return y >= 0x7fffffffu ? 0xffffffffu : y << 1;
}

uint32_t brume_reciprocal(uint32_t d)
{
    BRUME_CHECK(d >= 0x80000000u);
    /* 16 bits by division: r = 2^63 / d * (1 - e), 0 <= e < 2^-14. */
    uint32_t r = (0xffffffffu / ((d >> 16) + 1u)) << 15;
    for (int i = 0; i < 2; i++) {
        /* Newton: r += r * (1 - d r / 2^63). */
        uint32_t e = 0x80000000u - mul_hi_floor(d, r); /* Q31, >= 0 */
        r += mul_hi_floor(r, e) << 1;
    }
    return r;
}

bool brume_normalise(int32_t v[3])
{
    uint32_t m[3], all = 0;
    for (int i = 0; i < 3; i++) {
        m[i] = magnitude(v[i]);
        all |= m[i];
    }
    if (all == 0)
        return false;
    /* Largest component to [1/4, 1/2): then 1/16 <= |m|^2 < 3/4. */
    for (; all >= 0x80000000u; all >>= 1)
        for (int i = 0; i < 3; i++)
            m[i] >>= 1;
    for (int i = 0; i < 3; i++)
        m[i] <<= leading_zeros(all) - 1u;
    uint32_t square = mul_hi_floor(m[0], m[0]) + mul_hi_floor(m[1], m[1]) +
                      mul_hi_floor(m[2], m[2]);
    unsigned shift;
    uint32_t r = brume_rsqrt(square, &shift);
    for (int i = 0; i < 3; i++) {
        /* Q32 * Q31 -> Q31, times 2^shift, to Q30. shift <= 2. */
        uint32_t u = mul_hi_floor(m[i], r) << shift;
        v[i] = with_sign((u >> 1) + (u & 1u), v[i] < 0);
    }
    return true;
}

/// Angles ///

void brume_sincos(uint32_t turn, int32_t *sine, int32_t *cosine)
{
    /* Nearest quarter turn, and the rest in [-1/8, 1/8] turns. */
    uint32_t quarter = (turn + 0x20000000u) >> 30;
    int32_t rest = as_signed(turn - (quarter << 30));
    /* Radians: rest * 2 pi, Q0.32 * Q3.29 -> Q29 -> Q31, |x| < pi/4. */
    uint32_t x = mul_hi_floor(magnitude(rest) << 2, 3373259426u);
    uint32_t xx = mul_hi_floor(x, x) << 1; /* Q31 */
    /* Taylor, nested; first term dropped: x^11/11! < 2^-29 for the sine,
     * x^12/12! < 2^-32 for the cosine. Constants 1/n(n+1) in Q0.32. */
    static const uint32_t k_sine[4] = {59652324u, 102261126u, 214748365u,
                                       715827883u};
    static const uint32_t k_cosine[5] = {47721859u, 76695845u, 143165577u,
                                         357913941u, 2147483648u};
    uint32_t s = 0x80000000u, c = 0x80000000u; /* Q31 */
    for (int i = 0; i < 4; i++)
        s = 0x80000000u - mul_hi_floor(mul_hi_floor(xx, k_sine[i]), s) * 2u;
    for (int i = 0; i < 5; i++)
        c = 0x80000000u - mul_hi_floor(mul_hi_floor(xx, k_cosine[i]), c) * 2u;
    s = mul_hi_floor(s, x); /* Q30 */
    c = (c >> 1) + (c & 1u);
    int32_t sn = with_sign(s, rest < 0), cs = (int32_t)c;
    *sine = quarter & 1 ? cs : sn;
    *cosine = quarter & 1 ? -sn : cs;
    if (quarter & 2) {
        *sine = -*sine;
        *cosine = -*cosine;
    }
}

/// Numbers ///

struct brume_number brume_number_of(uint32_t m, int32_t e)
{
    struct brume_number n = {0, 0};
    if (m != 0) {
        n.m = m << leading_zeros(m);
        n.e = e - (int32_t)leading_zeros(m);
    }
    return n;
}

struct brume_number brume_number_q32(uint64_t q32_32)
{
    uint32_t high = (uint32_t)(q32_32 >> 32), low = (uint32_t)q32_32;
    if (high == 0)
        return brume_number_of(low, -32);
    int32_t e = 0;
    for (; high < 0x80000000u; low <<= 1, e--)
        high = high << 1 | low >> 31;
    return brume_number_of(high, e);
}

struct brume_number brume_number_mul(struct brume_number a,
                                     struct brume_number b)
{
    uint32_t m = mul_hi_floor(a.m, b.m), low = a.m * b.m;
    if (m == 0)
        return brume_number_of(0, 0);
    if (m < 0x80000000u) /* >= 2^30: both operands are normalised */
        return brume_number_of(m << 1 | low >> 31, a.e + b.e + 31);
    return brume_number_of(m, a.e + b.e + 32);
}

struct brume_number brume_number_inverse(struct brume_number a)
{
    BRUME_CHECK(a.m >= 0x80000000u);
    return brume_number_of(brume_reciprocal(a.m), -63 - a.e);
}

uint32_t brume_number_floor(struct brume_number a, int32_t q)
{
    int32_t e = a.e + q;
    if (a.m == 0 || e <= -32)
        return 0;
    return e > 0 ? 0xffffffffu : a.m >> (uint32_t)-e;
}

uint32_t brume_one_minus_exp(struct brume_number x)
{
    /* Halve x until y = x / 2^n < 2^-8; with x = m 2^e and m < 2^32 that
     * is n = e + 40, and then y in Q0.40 is m itself. */
    int32_t n = x.e + 40;
    if (x.m == 0 || n <= -32)
        return 0;
    if (n > 13) /* x >= 32 */
        return 0xffffffffu;
    uint32_t y = n < 0 ? x.m >> (uint32_t)-n : x.m;
    /* y - y^2/2 + y^3/6; y^4/24 < 2^-36 is dropped. Q0.40. */
    uint32_t yy = mul_hi_floor(y, y);   /* Q48 */
    uint32_t yyy = mul_hi_floor(yy, y); /* Q56 */
    uint32_t om = y - (yy >> 9) + (mul_hi_floor(yyy, 715827883u) >> 16);
    om = (om >> 8) + ((om >> 7) & 1u); /* Q0.32 */
    for (; n > 0; n--)                 /* 1-exp(-2y) = om + om (1-om) */
        om += mul_hi_floor(om, 0u - om);
    return om;
}
