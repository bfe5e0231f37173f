/* SPDX-License-Identifier: MIT */
/*
 * What is done to rows of the grid's rays on their way to pixels.
 */
#ifndef BRUME_FILTER_H
#define BRUME_FILTER_H

#include "brume_inner.h"

/* Taps on either side of the largest kernel. */
#define BRUME_MAX_RADIUS (BRUME_WITH_SPATIAL ? 6 : 0)
#define BRUME_MAX_TAPS (2 * BRUME_MAX_RADIUS + 1)

/// Weights ///

/* exp(-tau / 4096) in Q1.15, 1 for 0. Error < 2^-14. */
BRUME_INLINE uint32_t brume_falloff(uint32_t tau)
{
    if (tau > 0xffffu) /* < 2^-23 */
        return 0;
    return ((uint32_t)brume_exp_coarse[tau >> 8] * brume_exp_fine[tau & 255u] +
            0x4000u) >>
           15;
}

/* a / 65536 to the nearest, ties to even: weights like 1/4 make many ties, and
 * these must not add up. a <= 65535 * 65536. */
BRUME_INLINE uint16_t brume_round_q16(uint32_t a)
{
    BRUME_CHECK(a <= 0xffff0000u);
    return (uint16_t)((a + 0x7fffu + ((a >> 16) & 1u)) >> 16);
}

/* a / b of a weighted sum and the sum of its weights, to the nearest. a <=
 * 65535 b, b <= 65536: a + b / 2 < 2^32. */
BRUME_INLINE uint16_t brume_mean_of(uint32_t a, uint32_t b)
{
    BRUME_CHECK(b > 0 && b <= 0x10000u && a <= 0xffffu * b);
    return (uint16_t)(b == 0x10000u ? brume_round_q16(a) : (a + (b >> 1)) / b);
}

BRUME_INLINE uint32_t brume_distance(uint32_t a, uint32_t b)
{
    return a > b ? a - b : b - a;
}

/* Likeness of a ray and one of that depth and transmittance, Q1.15: e^-falloff
 * per octave of depth or, when just one of them met something, e^-sky per
 * transmittance that they differ by: so thin edges go over into the sky, and
 * solid ones do not. falloff in Q16.16, <= 2^26; sky <= 16. The exponent is off
 * by 2^-13. */
BRUME_INLINE uint32_t brume_likeness(const struct brume_sample *a,
                                     uint32_t depth, uint32_t transmittance,
                                     uint32_t falloff, uint32_t sky)
{
    if (a->depth == depth)
        return 0x8000u;
    if (a->depth == BRUME_NO_DEPTH || depth == BRUME_NO_DEPTH)
        return brume_falloff(
            (brume_distance(a->transmittance, transmittance) * sky + 8u) >> 4);
    /* Q16 * Q11 -> Q12: 2^-15 of the product, here with one bit more. */
    uint32_t tau =
        mul_hi_floor(falloff << 5, brume_distance(a->depth, depth) << 13);
    return brume_falloff((tau + 1u) >> 1);
}

/// brume_filter.c ///

#if BRUME_WITH_SPATIAL
/* Taps on either side of the frame's kernel, 0 for none. */
uint32_t brume_filter_radius(const struct brume_frame *frame);

/* out[i] = the mean of samples tap[0 .. 2 radius][i], i < n, with the depth of
 * the middle one. So columns are filtered when taps are rows; and rows when
 * each tap is the one before it plus one sample: then `out` may be tap[0]. */
void brume_filter_row(const struct brume_frame *frame,
                      const struct brume_sample *const *tap,
                      struct brume_sample *out, uint32_t n);

/* The same for both layers, with BRUME_WITH_COLOUR: the samples of layer 1 are
 * `apart` behind those of layer 0, in taps and out. */
void brume_filter_colours(const struct brume_frame *frame,
                          const struct brume_sample *const *tap,
                          struct brume_sample *out, uint32_t n, uint32_t apart);
#endif

/// brume_upsample.c ///

/* The two rays, in a row or a column, that a pixel lies between; the same one
 * twice beyond the edge of the grid. */
struct brume_between {
    uint32_t before, after;
    uint32_t weight; /* of `after`, in 1 / 2^(r + 1) */
};

#if BRUME_WITH_RESOLUTION
/* Of pixel number `pixel` along an axis of the image. */
struct brume_between brume_between(const struct brume_frame *frame,
                                   uint32_t pixel, int axis);

/* n pixels from column x, between two rows of rays; the first ray of either is
 * number `first` of the grid. */
void brume_upsample_span(const struct brume_frame *frame,
                         const struct brume_sample *above,
                         const struct brume_sample *below, uint32_t first,
                         uint32_t below_weight, uint32_t x, uint32_t n,
                         struct brume_radiance *out);

/* The same for both layers, with BRUME_WITH_COLOUR. */
void brume_upsample_colours(const struct brume_frame *frame,
                            const struct brume_sample *above,
                            const struct brume_sample *below, uint32_t first,
                            uint32_t below_weight, uint32_t x, uint32_t n,
                            struct brume_radiance *out, uint32_t apart);
#else
BRUME_INLINE struct brume_between brume_between(const struct brume_frame *frame,
                                                uint32_t pixel, int axis)
{
    struct brume_between b = {pixel, pixel, 0};
    (void)frame;
    (void)axis;
    return b;
}
#endif

#endif
