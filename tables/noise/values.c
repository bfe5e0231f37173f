/* SPDX-License-Identifier: MIT */
/* How good a texture is when a pixel takes several values in every frame: by
 * simulation, over one period of the texture after a long history. */
#include "values.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measure.h"

#define THRESHOLDS 32
#define ALPHA 0.1
#define WARM_UP 128 /* frames: 0.9^128 is 1e-6 */

struct run {
    const struct noise_texture *t;
    uint32_t values;
    enum values_source source;
    double *error, *mean, *rows; /* of a pixel: frame, EMA, scratch */
    double taps[MEASURE_TAPS];
    double sum[3]; /* of squares: frame, EMA, filtered */
    double count;
};

/* By a part of the side, in Q32. */
static uint32_t moved(uint32_t at, uint32_t part, uint32_t side)
{
    return (at + (uint32_t)((uint64_t)part * side >> 32)) & (side - 1u);
}

/* The value's slice; x and y are moved in place. */
static uint32_t source_of(const struct run *r, uint32_t frame, uint32_t value,
                          uint32_t *x, uint32_t *y)
{
    const struct noise_texture *t = r->t;

    if (r->source == VALUES_SLICES)
        return (frame * r->values + value) & (t->frames - 1);
    /* 1/g and 1/g^2 in Q32, g^3 = g + 1 */
    *x = moved(*x, value * 3242174889u, t->width);
    *y = moved(*y, value * 2447445414u, t->height);
    return frame & (t->frames - 1);
}

static void sample(struct run *r, uint32_t frame, unsigned threshold)
{
    const struct noise_texture *t = r->t;
    size_t area = (size_t)t->width * t->height;

    for (size_t i = 0; i < area; i++) {
        unsigned below = 0;
        for (uint32_t v = 0; v < r->values; v++) {
            uint32_t x = (uint32_t)i & (t->width - 1);
            uint32_t y = (uint32_t)(i / t->width);
            uint32_t z = source_of(r, frame, v, &x, &y);
            below += t->values[(z * t->height + y) * t->width + x] < threshold;
        }
        r->error[i] = (double)below / r->values - threshold / 256.0;
        r->mean[i] += ALPHA * (r->error[i] - r->mean[i]);
    }
}

static double filtered(const struct run *r)
{
    uint32_t w = r->t->width, h = r->t->height;
    double sum = 0;

    for (uint32_t y = 0; y < h; y++)
        for (uint32_t x = 0; x < w; x++) {
            double v = 0;
            for (uint32_t i = 0; i < MEASURE_TAPS; i++)
                v += r->taps[i] *
                     r->mean[y * w + ((x + i - MEASURE_RADIUS) & (w - 1))];
            r->rows[y * w + x] = v;
        }
    for (uint32_t y = 0; y < h; y++)
        for (uint32_t x = 0; x < w; x++) {
            double v = 0;
            for (uint32_t i = 0; i < MEASURE_TAPS; i++)
                v += r->taps[i] *
                     r->rows[((y + i - MEASURE_RADIUS) & (h - 1)) * w + x];
            sum += v * v;
        }
    return sum;
}

static void simulate(struct run *r, unsigned threshold)
{
    size_t area = (size_t)r->t->width * r->t->height;
    uint32_t period = r->t->frames;

    if (r->source == VALUES_SLICES)
        period /= r->values;
    memset(r->mean, 0, area * sizeof *r->mean);
    for (uint32_t f = 0; f < WARM_UP + period; f++) {
        sample(r, f, threshold);
        if (f < WARM_UP)
            continue;
        for (size_t i = 0; i < area; i++) {
            r->sum[0] += r->error[i] * r->error[i];
            r->sum[1] += r->mean[i] * r->mean[i];
        }
        r->sum[2] += filtered(r);
        r->count += (double)area;
    }
}

bool values_measure(struct values_measures *m, const struct noise_texture *t,
                    uint32_t values, enum values_source source)
{
    size_t area = (size_t)t->width * t->height;
    struct run r = {.t = t, .values = values, .source = source};
    double white = 0, gain = 0;

    r.error = malloc(3 * area * sizeof *r.error);
    if (!r.error)
        return false;
    r.mean = r.error + area;
    r.rows = r.mean + area;
    measure_taps(MEASURE_GAUSS1, r.taps);
    for (unsigned k = 0; k < THRESHOLDS; k++) {
        double p = (k + 0.5) / THRESHOLDS;
        simulate(&r, (unsigned)(256 * p));
        white += p * (1 - p) / values / THRESHOLDS;
    }
    for (int i = 0; i < MEASURE_TAPS; i++)
        gain += r.taps[i] * r.taps[i];
    white *= r.count;
    m->frame = sqrt(r.sum[0] / white);
    m->ema = sqrt(r.sum[1] / white * (2 - ALPHA) / ALPHA);
    m->gauss = sqrt(r.sum[2] / white * (2 - ALPHA) / ALPHA) / gain;
    free(r.error);
    return true;
}
