/* SPDX-License-Identifier: MIT */
/* SSIM: see metrics.h. Windows are separable, so rows are weighed before
 * columns; five running means make the paper's moments. */
#include "metrics_inner.h"

#include <math.h>
#include <stdlib.h>

#define N METRICS_SSIM_WINDOW
#define SIGMA 1.5
#define C1 (0.01 * 255 * 0.01 * 255) /* (K1 L)^2 */
#define C2 (0.03 * 255 * 0.03 * 255) /* (K2 L)^2 */

enum moment { A, B, AA, BB, AB, MOMENTS };

static void make_weights(double w[N])
{
    double sum = 0;

    for (int i = 0; i < N; i++) {
        double x = i - N / 2;
        w[i] = exp(-x * x / (2 * SIGMA * SIGMA));
        sum += w[i];
    }
    for (int i = 0; i < N; i++)
        w[i] /= sum;
}

static double luma_at(const struct image *image, size_t i)
{
    if (image->channels == 1)
        return metrics_sample(image, i, 0);
    return 0.299 * metrics_sample(image, i, 0) +
           0.587 * metrics_sample(image, i, 1) +
           0.114 * metrics_sample(image, i, 2);
}

/* Moments of the row's windows, at out[x * MOMENTS]. */
static void weigh_row(const struct image *a, const struct image *b, int y,
                      const double w[N], double *out)
{
    for (int x = 0; x + N <= a->width; x++) {
        double *m = out + (size_t)x * MOMENTS;
        for (int k = 0; k < MOMENTS; k++)
            m[k] = 0;
        for (int i = 0; i < N; i++) {
            size_t at = (size_t)y * (size_t)a->width + (size_t)(x + i);
            double va = luma_at(a, at), vb = luma_at(b, at);
            m[A] += w[i] * va;
            m[B] += w[i] * vb;
            m[AA] += w[i] * va * va;
            m[BB] += w[i] * vb * vb;
            m[AB] += w[i] * va * vb;
        }
    }
}

/* Formula (13) of the paper. */
static double similarity(const double m[MOMENTS])
{
    double va = m[AA] - m[A] * m[A], vb = m[BB] - m[B] * m[B];
    double cov = m[AB] - m[A] * m[B];

    return (2 * m[A] * m[B] + C1) * (2 * cov + C2) /
           ((m[A] * m[A] + m[B] * m[B] + C1) * (va + vb + C2));
}

/* The mean of one row of windows, out of N weighed rows. */
static double row_mean(const double *rows, int y, size_t columns,
                       const double w[N])
{
    double sum = 0;

    for (size_t x = 0; x < columns; x++) {
        double m[MOMENTS] = {0, 0, 0, 0, 0};
        for (int j = 0; j < N; j++) {
            size_t slot = (size_t)((y + j) % N);
            for (int k = 0; k < MOMENTS; k++)
                m[k] += w[j] * rows[(slot * columns + x) * MOMENTS + (size_t)k];
        }
        sum += similarity(m);
    }
    return sum / (double)columns;
}

int metrics_ssim(const struct image *a, const struct image *b, double *ssim,
                 char *err, size_t err_size)
{
    double w[N], sum = 0, *rows;
    size_t columns;

    if (metrics_check(a, b, err, err_size))
        return -1;
    *ssim = (double)NAN;
    if (a->width < N || a->height < N)
        return 0;
    columns = (size_t)(a->width - N + 1);
    rows = metrics_plane(N * columns * MOMENTS, err, err_size);
    if (!rows)
        return -1;
    make_weights(w);
    for (int y = 0; y < a->height; y++) {
        weigh_row(a, b, y, w, rows + (size_t)(y % N) * columns * MOMENTS);
        if (y >= N - 1)
            sum += row_mean(rows, y - (N - 1), columns, w);
    }
    free(rows);
    *ssim = sum / (a->height - N + 1);
    return 0;
}
