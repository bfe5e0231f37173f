/* SPDX-License-Identifier: MIT */
/*
 * Spatial filters of rays: separable kernels, plain or edge-aware.
 *
 * Light and transmittance are averaged before the background is added, so the
 * background is never blurred. All is done in the 16-bit codes of struct
 * brume_sample: as 65535 stands for 65536, a mean may be up to 2^-16 too low.
 *
 * Plain       sum_k w_k v_k, rounded to the nearest. The weights sum to 1
 *             exactly and are symmetric: a constant stays as it is, the mean
 *             does inside of the image, and a mirrored image gives the
 *             mirrored result. Two passes, each off by 1/2 at most.
 * Edge-aware  sum_k w_k e_k v_k / sum_k w_k e_k, e_k = exp(-falloff * octaves
 *             of depth between tap k and the middle): the bilateral filter of
 *             Tomasi and Manduchi ("Bilateral Filtering for Gray and Color
 *             Images", 1998) with depth as the range, taken apart into columns
 *             first and rows then as Pham and van Vliet do ("Separable
 *             Bilateral Filtering for Fast Video Preprocessing", 2005). In
 *             both passes the middle is the ray's own depth. Rays that met
 *             nothing have no depth: with them, e_k falls with the difference
 *             of transmittance. The division is exact, so a constant stays as
 *             it is.
 */
#include "brume_filter.h"

#if BRUME_WITH_SPATIAL

/// Kernels ///

/* A symmetric kernel: weights in Q0.16, from the outermost to the middle one,
 * w[radius]; the outer ones count twice. Sum 65536. */
struct kernel {
    uint32_t radius;
    uint16_t weight[BRUME_MAX_RADIUS + 1];
};

/* Each within 1 of the exact value: rounded, and what the sum then lacks of
 * 65536 is put into the middle.
 *
 * gauss1       integrals of the Gaussian of sigma 1 over pixels, by their sum
 *              (0.99953), cut where 0.995 is inside: the kernel that
 *              tables/noise optimises its `gauss1` textures for.
 * bilateral15  exp(-k^2 / 4.5), |k| <= 7, by their sum. The outermost are 0.33
 *              in Q0.16, so 0, and are left out: 13 taps do the same. */
static const struct kernel k_kernels[] = {
    {0, {0}},
    {1, {21845, 21846}},                         /* box3 */
    {2, {13107, 13107, 13108}},                  /* box5 */
    {3, {392, 3973, 15849, 25108}},              /* gauss1 */
    {1, {16384, 32768}},                         /* binomial3 */
    {2, {4096, 16384, 24576}},                   /* binomial5 */
    {6, {6, 67, 498, 2359, 7166, 13957, 17430}}, /* bilateral15 */
};

uint32_t brume_filter_radius(const struct brume_frame *frame)
{
    return k_kernels[frame->spatial].radius;
}

/// Plain ///

/* A product is at most 32768 * 131070, a sum 65536 * 65535: both < 2^32. */
static void filter_plain(const struct kernel *k,
                         const struct brume_sample *const *tap,
                         struct brume_sample *out, uint32_t n)
{
    const uint32_t radius = k->radius;
    for (uint32_t i = 0; i < n; i++) {
        const struct brume_sample *middle = tap[radius] + i;
        uint32_t w = k->weight[radius];
        uint32_t light = w * middle->light;
        uint32_t transmittance = w * middle->transmittance;
        uint16_t depth = middle->depth;
        for (uint32_t j = 0; j < radius; j++) {
            const struct brume_sample *a = tap[j] + i;
            const struct brume_sample *b = tap[2 * radius - j] + i;
            w = k->weight[j];
            light += w * ((uint32_t)a->light + b->light);
            transmittance +=
                w * ((uint32_t)a->transmittance + b->transmittance);
        }
        out[i].light = brume_round_q16(light);
        out[i].transmittance = brume_round_q16(transmittance);
        out[i].depth = depth;
    }
}

/// Edge-aware ///

/* Against the sky, a ray that lets 7/8 of the light through counts 1/e, one
 * that lets nothing through 1/2981: walls have no outline, and thin edges are
 * smoothed. With less of that, what noise makes of thin edges stays, and the
 * error against the mean of many frames exceeds that of the plain kernel
 * (tests/test_filter_edges.c). */
#define SKY_FALLOFF 8u

/* Weighted sums so far, by layer. */
struct sums {
    uint32_t light[BRUME_LAYERS], transmittance[BRUME_LAYERS], weight;
};

BRUME_INLINE void add_like(struct sums *s, const struct brume_sample *a,
                           const struct brume_sample *middle, uint32_t w,
                           uint32_t falloff, uint32_t layers, uint32_t apart)
{
    uint32_t like = brume_likeness(a, middle->depth, middle->transmittance,
                                   falloff, SKY_FALLOFF);
    w = (w * like + 0x4000u) >> 15;
    for (uint32_t l = 0; l < layers; l++) {
        s->light[l] += w * a[l * apart].light;
        s->transmittance[l] += w * a[l * apart].transmittance;
    }
    s->weight += w;
}

/* The middle's weight is the kernel's, at least 13108; the others are at most
 * the kernel's. So the sums are those of filter_plain or less, and are not 0.
 * An e_k is wrong by 2^-13 of itself and 2^-14, a weight by 1/2 after that: of
 * the sum of weights, < 2^-10 in all. So is the mean, of the range of what is
 * averaged. */
BRUME_INLINE void filter_edge(const struct kernel *k, uint32_t falloff,
                              const struct brume_sample *const *tap,
                              struct brume_sample *out, uint32_t n,
                              uint32_t layers, uint32_t apart)
{
    const uint32_t radius = k->radius;
    for (uint32_t i = 0; i < n; i++) {
        const struct brume_sample middle = tap[radius][i];
        uint32_t w = k->weight[radius];
        struct sums s = {{w * middle.light}, {w * middle.transmittance}, w};
        if (layers > 1) {
            const struct brume_sample *more = tap[radius] + i + apart;
            s.light[layers - 1u] = w * more->light;
            s.transmittance[layers - 1u] = w * more->transmittance;
        }
        for (uint32_t j = 0; j < radius; j++) {
            w = k->weight[j];
            add_like(&s, tap[j] + i, &middle, w, falloff, layers, apart);
            add_like(&s, tap[2 * radius - j] + i, &middle, w, falloff, layers,
                     apart);
        }
        for (uint32_t l = 0; l < layers; l++) {
            struct brume_sample *to = out + i + l * apart;
            to->light = brume_mean_of(s.light[l], s.weight);
            to->transmittance = brume_mean_of(s.transmittance[l], s.weight);
        }
        out[i].depth = middle.depth;
    }
}

void brume_filter_row(const struct brume_frame *frame,
                      const struct brume_sample *const *tap,
                      struct brume_sample *out, uint32_t n)
{
    const struct kernel *k = &k_kernels[frame->spatial];
    if (frame->edge_falloff != 0)
        filter_edge(k, frame->edge_falloff, tap, out, n, 1, 0);
    else
        filter_plain(k, tap, out, n);
}

#if BRUME_WITH_COLOUR
void brume_filter_colours(const struct brume_frame *frame,
                          const struct brume_sample *const *tap,
                          struct brume_sample *out, uint32_t n, uint32_t apart)
{
    const struct kernel *k = &k_kernels[frame->spatial];
    const struct brume_sample *more[BRUME_MAX_TAPS];
    if (frame->edge_falloff != 0) {
        filter_edge(k, frame->edge_falloff, tap, out, n, 2, apart);
        return;
    }
    for (uint32_t i = 0; i <= 2 * k->radius; i++)
        more[i] = tap[i] + apart;
    brume_filter_row(frame, tap, out, n);
    brume_filter_row(frame, more, out + apart, n);
}
#endif

#endif
