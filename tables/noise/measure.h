/* SPDX-License-Identifier: MIT */
/*
 * How good a scalar noise texture is: loss and RMSE of filtered Heaviside
 * integrands, relative to white noise. Figures only, so in double.
 *
 * Loss. A pixel p samples the integrand [x_p > theta]; the picture is then
 * filtered in space and time with a filter F that sums to 1. With
 * G(o) = sum_q F(q) F(q + o), its autocorrelation, the expected squared error
 * for theta uniform in [0, 1] and any p is (Donnelly et al. 2024, eq. 7 with
 * its K1 and K0 terms)
 *
 *     sum_o G(o) E_p[min(x_p, x_{p+o})] - 2 E_p[x_p - x_p^2 / 2] + 1/3,
 *
 * because the integrals of [x > theta][y > theta], [x > theta](1 - theta) and
 * (1 - theta)^2 over theta are min(x, y), x - x^2/2 and 1/3. Of uncorrelated
 * uniform noise only o = 0 remains: G(0) / 6.
 *
 * Time. An EMA over a history of m frames, the newest first, has weights
 *
 *     f_m(i) = alpha (1 - alpha)^i  for i < m - 1,  (1 - alpha)^(m - 1) at the
 *     last: the first frame of a history enters it whole.
 *
 * A pixel's history begins anew with probability beta in each frame
 * (disocclusion), so m has the weight beta (1 - beta)^(m - 1), cut at a
 * horizon M and divided by 1 - (1 - beta)^M; beta = 0 means m = M always.
 * The temporal autocorrelation is (eq. 14-17)
 *
 *     G_t(j) = sum_m w(m) sum_i f_m(i) f_m(i + |j|),   |j| < M,
 *
 * and a table of T slices repeats, so it sees G_t wrapped modulo T. The
 * horizon is max(T, 32): then short tables pay for repeating themselves, and
 * tables of 32 slices are measured as the published ones are.
 */
#ifndef BRUME_TABLES_MEASURE_H
#define BRUME_TABLES_MEASURE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "noise.h"

enum measure_filter {
    MEASURE_NONE,
    MEASURE_GAUSS1,
    MEASURE_BINOMIAL3,
    MEASURE_BOX3,
    MEASURE_BOX5,
    MEASURE_FILTERS
};

#define MEASURE_RADIUS 3 /* of the widest filter, gauss1 */
#define MEASURE_TAPS (2 * MEASURE_RADIUS + 1)

/* All divided by what is expected of uncorrelated uniform noise. */
struct noise_measures {
    /* Product of the spatial filter and EMA(0.1, 0.1). */
    double loss[MEASURE_FILTERS];
    /* 64 thresholds, EMA 0.1 over the last 32 frames from every start, then
     * the spatial filter. */
    double rmse[MEASURE_FILTERS];
    /* The same after gauss1 when the threshold is (1 + sin) / 2 with 12 cycles
     * per 128 pixels: [0] along x, [1] along y. By simulation. */
    double gradient[2];
};

/* Fill *m for a texture of one channel. False when there is no memory. */
bool noise_measure(const struct noise_texture *t, struct noise_measures *m);

/* The last of it alone. */
bool measure_gradient(const struct noise_texture *t, double along[2]);

/* One Markdown table: its two head lines, and a row. */
void noise_measure_head(FILE *out);
void noise_measure_row(FILE *out, const char *name,
                       const struct noise_measures *m);

/* One axis of a spatial filter, its centre at [MEASURE_RADIUS]; sums to 1. */
void measure_taps(enum measure_filter filter, double taps[MEASURE_TAPS]);

/* g[j] = G_t(j) for j = 0 .. horizon - 1, not wrapped. */
void measure_ema(double *g, uint32_t horizon, double alpha, double beta);

#endif
