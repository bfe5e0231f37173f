/* SPDX-License-Identifier: MIT */
/*
 * Metrics over time: see metrics.h. Every frame counts as three channels:
 * grey, and RGB which a PNG writer stored as grey, may follow each other.
 */
#include "metrics_inner.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHANNELS 3

static size_t count_of(const struct metrics_sequence *s)
{
    return CHANNELS * (size_t)s->width * (size_t)s->height;
}

/* Memory for the first frame. */
static int begin(struct metrics_sequence *s, const struct image *a, char *err,
                 size_t err_size)
{
    double **const planes[] = {&s->first, &s->before, &s->reference, &s->sum,
                               &s->square};

    s->width = a->width;
    s->height = a->height;
    for (size_t i = 0; i < sizeof planes / sizeof *planes; i++) {
        *planes[i] = metrics_plane(count_of(s), err, err_size);
        if (!*planes[i]) {
            metrics_free(s);
            return -1;
        }
    }
    return 0;
}

/* One sample of the frame: its error and its reference. Variance is summed
 * about the first error, which is close to the others. */
static void add_sample(struct metrics_sequence *s, size_t i, double error,
                       double reference)
{
    double moved, change;

    s->total_error += fabs(error);
    if (s->frames == 0) {
        s->first[i] = error;
    } else {
        moved = error - s->before[i];
        change = reference - s->reference[i];
        s->total_flicker += fabs(moved);
        s->total_square += moved * moved;
        s->total_lag -= error * change;
        s->total_change += change * change;
    }
    s->sum[i] += error - s->first[i];
    s->square[i] += (error - s->first[i]) * (error - s->first[i]);
    s->before[i] = error;
    s->reference[i] = reference;
}

int metrics_add(struct metrics_sequence *s, const struct image *a,
                const struct image *b, char *err, size_t err_size)
{
    if (metrics_check(a, b, err, err_size))
        return -1;
    if (s->frames > 0 && (a->width != s->width || a->height != s->height)) {
        snprintf(err, err_size, "%d x %d, but frames before it are %d x %d",
                 a->width, a->height, s->width, s->height);
        return -1;
    }
    if (s->frames == 0 && begin(s, a, err, err_size))
        return -1;
    for (size_t i = 0; i < metrics_pixels(a); i++)
        for (int c = 0; c < CHANNELS; c++) {
            double reference = metrics_sample(a, i, c);
            double error = metrics_sample(b, i, c) - reference;
            add_sample(s, CHANNELS * i + (size_t)c, error, reference);
        }
    s->frames++;
    return 0;
}

/* The mean, over samples, of the variance over time. */
static double variance_of(const struct metrics_sequence *s)
{
    double sum = 0, n = s->frames;

    for (size_t i = 0; i < count_of(s); i++) {
        double mean = s->sum[i] / n;
        sum += fmax(0, s->square[i] / n - mean * mean);
    }
    return sum / (double)count_of(s);
}

void metrics_finish(const struct metrics_sequence *s,
                    struct metrics_time *result)
{
    const struct metrics_time none = {0, 0, 0, 0, (double)INFINITY};
    double samples = (double)count_of(s);
    double changes = samples * (s->frames - 1);

    *result = none;
    if (s->frames == 0)
        return;
    result->ghosting = s->total_error / samples / s->frames;
    if (s->frames == 1)
        return;
    result->flicker = s->total_flicker / changes;
    result->deviation = sqrt(variance_of(s));
    result->lag = s->total_change > 0 ? s->total_lag / s->total_change : 0;
    result->psnr = metrics_psnr(sqrt(s->total_square / changes));
}

void metrics_free(struct metrics_sequence *s)
{
    free(s->first);
    free(s->before);
    free(s->reference);
    free(s->sum);
    free(s->square);
    memset(s, 0, sizeof *s);
}
