/* SPDX-License-Identifier: MIT */
/*
 * Fixed-point arithmetic in lanes, as that of core/brume_fixed.h, brume_fixed.c
 * and brume_inner.h, to the bit.
 */
#ifndef BRUME_HOST_WIDE_MATHS_H
#define BRUME_HOST_WIDE_MATHS_H

#include "brume_inner.h"
#include "wide_gather.h"

LANES_INLINE lanes signs_of(lanes a)
{
    return (lanes)((lanes_signed)a >> 31);
}

LANES_INLINE lanes magnitudes(lanes a)
{
    lanes sign = signs_of(a);
    return (a ^ sign) - sign;
}

/* m, or -m where sign is all ones. */
LANES_INLINE lanes with_signs(lanes m, lanes sign)
{
    return (m ^ sign) - sign;
}

LANES_INLINE lanes_mask less_signed(lanes a, lanes b)
{
    return mask_less(a ^ 0x80000000u, b ^ 0x80000000u);
}

/* The sum, or the most that there can be. */
LANES_INLINE lanes held_sum(lanes a, lanes b)
{
    return lanes_select(mask_less(a + b, b), lanes_of(0xffffffffu), a + b);
}

/* brume_times, of a word as it is */
LANES_INLINE lanes times_lanes(lanes a, struct brume_number n)
{
    lanes high = lanes_mul_hi(a, lanes_of(n.m)), low = a * n.m;
    int32_t up = n.e + 32;
    if (up <= 0)
        return up > -32 ? high >> (uint32_t)-up : lanes_of(0);
    lanes over = up > 31 ? high | low : high >> (32u - (uint32_t)up);
    lanes product = up > 31
                        ? lanes_of(0)
                        : high << (uint32_t)up | low >> (32u - (uint32_t)up);
    return lanes_select(mask_equal(over, lanes_of(0)), product,
                        lanes_of(0xffffffffu));
}

/* mul_signed_round: a times b, which is not negative; up is 1 .. 7. */
LANES_INLINE lanes mul_round_lanes(lanes a, lanes b, uint32_t up)
{
    lanes m = magnitudes(a), low = m * b;
    lanes r = lanes_mul_hi(m, b) << up | low >> (32u - up);
    return with_signs(r + ((low << up) >> 31), signs_of(a));
}

/* mul_both_signed_round. */
LANES_INLINE lanes mul_both_round_lanes(lanes a, lanes b, uint32_t up)
{
    return with_signs(mul_round_lanes(a, magnitudes(b), up), signs_of(b));
}

/* The sum of mul_both_signed_round(axis, p, 0) over the axes. */
LANES_INLINE lanes along_axis(const int32_t axis[3], const lanes p[3])
{
    lanes sum = lanes_of(0);
    for (int i = 0; i < 3; i++) {
        lanes m = lanes_of(magnitude(axis[i])), a = magnitudes(p[i]);
        sum += with_signs(lanes_mul_hi(m, a) + (m * a >> 31),
                          signs_of(p[i]) ^ sign_mask(axis[i]));
    }
    return sum;
}

/* brume_reciprocal */
LANES_INLINE lanes reciprocals(lanes d)
{
    lanes r = lanes_quotient(lanes_of(0xffffffffu), (d >> 16) + 1u) << 15;
    for (int i = 0; i < 2; i++) {
        lanes e = 0x80000000u - lanes_mul_hi(d, r);
        r += lanes_mul_hi(r, e) << 1;
    }
    return r;
}

/* brume_normalise; zero stays zero. */
static inline void normalise_lanes(lanes v[3])
{
    lanes m[3], all = lanes_of(0);
    for (int i = 0; i < 3; i++) {
        m[i] = magnitudes(v[i]);
        all |= m[i];
    }
    lanes over = all >> 31, shift = lanes_leading_zeros(all >> over) - 1u;
    for (int i = 0; i < 3; i++)
        m[i] = m[i] >> over << shift;
    lanes x = lanes_mul_hi(m[0], m[0]) + lanes_mul_hi(m[1], m[1]) +
              lanes_mul_hi(m[2], m[2]);
    /* brume_rsqrt; x >= 2^28, so its shift is 0 or 1. */
    lanes up = 1u - ((x >> 30 | x >> 31) & 1u);
    x <<= up << 1;
    lanes y = 2426656522u - lanes_mul_hi(x, lanes_of(1417339208u));
    for (int i = 0; i < 4; i++) {
        lanes xyy = lanes_mul_hi(x, lanes_mul_hi(y, y));
        y = lanes_mul_hi(y, (3u << 28) - xyy) << 3;
    }
    y = lanes_select(mask_less(y, lanes_of(0x7fffffffu)), y << 1,
                     lanes_of(0xffffffffu));
    for (int i = 0; i < 3; i++) {
        lanes u = lanes_mul_hi(m[i], y) << up;
        v[i] = with_signs((u >> 1) + (u & 1u), signs_of(v[i]));
    }
}

#endif
