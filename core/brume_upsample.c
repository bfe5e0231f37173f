/* SPDX-License-Identifier: MIT */
/*
 * Pixels between rays. With 2^r pixels per ray and side, pixel X lies at
 *
 *     (2 X + 1) / 2^(r + 1) - 1/2
 *
 * of the grid: on a ray for r = 0, else between two and never halfway.
 *
 * Bilinear  the four rays around the pixel, rounded once.
 * Aware     the same, each times its likeness to the nearest of the four, by
 *           the sum of weights: joint bilateral upsampling (Kopf, Cohen,
 *           Lischinski and Uyttendaele, "Joint Bilateral Upsampling", 2007)
 *           with a footprint of four and, for want of a guide at full
 *           resolution, the nearest ray for one.
 */
#include "brume_filter.h"

#if BRUME_WITH_RESOLUTION

struct brume_between brume_between(const struct brume_frame *frame,
                                   uint32_t pixel, int axis)
{
    const uint32_t r = frame->resolution, last = frame->grid[axis] - 1u;
    uint32_t t = pixel + (1u << r >> 1), ray = t >> r;
    struct brume_between b = {pixel, pixel, 0};
    if (r == 0)
        return b;
    b.before = ray != 0 ? ray - 1u : 0;
    b.after = ray < last ? ray : last;
    b.weight = 2u * (t & ((1u << r) - 1u)) + 1u;
    return b;
}

/* Beside the nearest ray another one counts e^-4 per octave of depth; the sky
 * beside a ray that lets nothing through, e^-2. The sky keeps its colour better
 * so, and the error against an image of full resolution is within 1 % of
 * bilinear's (tests/test_filter_edges.c). With higher values that error grows,
 * and the outline of the cloud becomes one of blocks. */
#define DEPTH_FALLOFF (4u << 16)
#define SKY_FALLOFF 2u

/* The mean of rays p, nearest first, with weights in Q0.16: the nearest has
 * more than 1/4, and all sum to 1 or, by likeness, to less. */
BRUME_INLINE void blend(struct brume_radiance *out,
                        const struct brume_sample *const p[4],
                        const uint32_t weight[4], bool aware, uint32_t log2,
                        bool colour, uint32_t apart)
{
    uint32_t light = 0, transmittance = 0, sum = 0, green = 0, blue = 0;
    for (int i = 0; i < 4; i++) {
        uint32_t w = weight[i];
        if (aware && i > 0)
            w = (w * brume_likeness(p[i], p[0]->depth, p[0]->transmittance,
                                    DEPTH_FALLOFF, SKY_FALLOFF) +
                 0x4000u) >>
                15;
        light += w * p[i]->light;
        transmittance += w * p[i]->transmittance;
        sum += w;
        if (colour) {
            green += w * p[i][apart].light;
            blue += w * p[i][apart].transmittance;
        }
    }
    out->light = light_of_sample(brume_mean_of(light, sum), log2);
    out->transmittance = of_sample(brume_mean_of(transmittance, sum));
#if BRUME_WITH_COLOUR
    if (colour) {
        out->green = light_of_sample(brume_mean_of(green, sum), log2);
        out->blue = light_of_sample(brume_mean_of(blue, sum), log2);
    }
#else
    (void)green, (void)blue;
#endif
}

BRUME_INLINE void upsample(const struct brume_frame *frame,
                           const struct brume_sample *above,
                           const struct brume_sample *below, uint32_t first,
                           uint32_t below_weight, uint32_t x, uint32_t n,
                           struct brume_radiance *out, bool colour,
                           uint32_t apart)
{
    const uint32_t log2 = brume_light_log2(frame);
    const bool aware = frame->upsample == BRUME_UPSAMPLE_AWARE;
    const uint32_t r = frame->resolution, one = 2u << r;
    /* The nearer row's share of Q0.16 / one; more than half of one */
    const bool down = below_weight > one / 2u;
    const struct brume_sample *row = down ? below : above;
    const struct brume_sample *row2 = down ? above : below;
    const uint32_t y = down ? below_weight : one - below_weight;
    const uint32_t near = y << (14u - 2u * r);
    const uint32_t far = (one - y) << (14u - 2u * r);
    for (uint32_t i = 0; i < n; i++) {
        struct brume_between b = brume_between(frame, x + i, 0);
        const bool right = b.weight > one / 2u;
        const uint32_t here = (right ? b.after : b.before) - first;
        const uint32_t there = (right ? b.before : b.after) - first;
        const uint32_t u = right ? b.weight : one - b.weight;
        const struct brume_sample *const p[4] = {row + here, row + there,
                                                 row2 + here, row2 + there};
        const uint32_t w[4] = {u * near, (one - u) * near, u * far,
                               (one - u) * far};
        blend(&out[i], p, w, aware, log2, colour, apart);
    }
}

void brume_upsample_span(const struct brume_frame *frame,
                         const struct brume_sample *above,
                         const struct brume_sample *below, uint32_t first,
                         uint32_t below_weight, uint32_t x, uint32_t n,
                         struct brume_radiance *out)
{
    upsample(frame, above, below, first, below_weight, x, n, out, false, 0);
}

#if BRUME_WITH_COLOUR
void brume_upsample_colours(const struct brume_frame *frame,
                            const struct brume_sample *above,
                            const struct brume_sample *below, uint32_t first,
                            uint32_t below_weight, uint32_t x, uint32_t n,
                            struct brume_radiance *out, uint32_t apart)
{
    upsample(frame, above, below, first, below_weight, x, n, out, true, apart);
}
#endif

#endif
