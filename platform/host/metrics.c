/* SPDX-License-Identifier: MIT */
/* Differences of samples, and of gradients. */
#include "metrics_inner.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct sums {
    double square, difference, max;
    double samples;
};

int metrics_check(const struct image *a, const struct image *b, char *err,
                  size_t err_size)
{
    if (a->width == b->width && a->height == b->height)
        return 0;
    snprintf(err, err_size, "sizes differ: %d x %d and %d x %d", a->width,
             a->height, b->width, b->height);
    return -1;
}

double *metrics_plane(size_t count, char *err, size_t err_size)
{
    double *plane = calloc(count, sizeof *plane);

    if (!plane)
        snprintf(err, err_size, "no memory for %lu samples",
                 (unsigned long)count);
    return plane;
}

double metrics_psnr(double rmse)
{
    return rmse > 0 ? 20 * log10(255 / rmse) : (double)INFINITY;
}

/// Error ///

static int min_int(int a, int b)
{
    return a < b ? a : b;
}

/* The tile whose top left pixel is (x0, y0). */
static struct sums tile_sums(const struct image *a, const struct image *b,
                             int x0, int y0)
{
    int x1 = min_int(x0 + METRICS_TILE, a->width);
    int y1 = min_int(y0 + METRICS_TILE, a->height);
    int one = metrics_channels(a), two = metrics_channels(b);
    int channels = one > two ? one : two;
    struct sums s = {0, 0, 0, 0};

    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++)
            for (int c = 0; c < channels; c++) {
                size_t i = (size_t)y * (size_t)a->width + (size_t)x;
                double d = metrics_sample(b, i, c) - metrics_sample(a, i, c);
                s.square += d * d;
                s.difference += d;
                s.max = fabs(d) > s.max ? fabs(d) : s.max;
            }
    s.samples = (double)(x1 - x0) * (y1 - y0) * channels;
    return s;
}

int metrics_error(const struct image *a, const struct image *b,
                  struct metrics_error *result, char *err, size_t err_size)
{
    struct sums all = {0, 0, 0, 0};
    double worst = 0; /* mean square */

    if (metrics_check(a, b, err, err_size))
        return -1;
    for (int y = 0; y < a->height; y += METRICS_TILE)
        for (int x = 0; x < a->width; x += METRICS_TILE) {
            struct sums s = tile_sums(a, b, x, y);
            all.square += s.square;
            all.difference += s.difference;
            all.samples += s.samples;
            all.max = s.max > all.max ? s.max : all.max;
            worst = fmax(worst, s.square / s.samples);
        }
    result->rmse = sqrt(all.square / all.samples);
    result->mean = all.difference / all.samples;
    result->max = all.max;
    result->worst_tile = sqrt(worst);
    result->psnr = metrics_psnr(result->rmse);
    return 0;
}

/// Sharpness ///

static double grey_at(const struct image *image, size_t i)
{
    double sum = 0;

    for (int c = 0; c < metrics_channels(image); c++)
        sum += metrics_sample(image, i, c);
    return sum / metrics_channels(image);
}

int metrics_sharpness(const struct image *a, const struct image *b,
                      double *sharpness, char *err, size_t err_size)
{
    double both = 0, truth = 0;

    if (metrics_check(a, b, err, err_size))
        return -1;
    for (int y = 0; y + 1 < a->height; y++)
        for (int x = 0; x + 1 < a->width; x++) {
            size_t i = (size_t)y * (size_t)a->width + (size_t)x;
            size_t below = i + (size_t)a->width;
            double ga = grey_at(a, i), gb = grey_at(b, i);
            double ax = grey_at(a, i + 1) - ga, ay = grey_at(a, below) - ga;
            double bx = grey_at(b, i + 1) - gb, by = grey_at(b, below) - gb;
            both += ax * bx + ay * by;
            truth += ax * ax + ay * ay;
        }
    *sharpness = truth > 0 ? both / truth : 1;
    return 0;
}
