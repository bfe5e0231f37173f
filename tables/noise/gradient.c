/* SPDX-License-Identifier: MIT */
/* RMSE of integrands whose threshold varies over the picture, by simulation:
 * what a pixel's neighbours know of it is then worth less than the loss says.
 */
#include "measure.h"

#include <math.h>
#include <stdlib.h>

#define ALPHA 0.1
#define HISTORY 32u /* frames that the EMA looks back */
#define PHASES 16   /* of the wave that are tried */
#define PERIOD 32u  /* 12 cycles per 128 pixels repeat after 32 */
#define CYCLES 3    /* in a period */
/* Between them: all over the cycle, and between the 32 that pixels have. */
#define PHASE (1.0 / PHASES + 1.0 / (PHASES * PERIOD))

static const double pi = 3.14159265358979323846;

/* The picture is the texture, tiled up to a whole period. */
struct picture {
    const struct noise_texture *texture;
    uint32_t width, height;
    size_t pixels;
    float taps[MEASURE_TAPS];
    float ema[HISTORY];
    float *threshold; /* per pixel */
    float *error;     /* [frame][pixel], unfiltered */
    float *mean;      /* after the EMA */
    float *blurred;   /* and after one axis of the filter */
};

static bool open_picture(struct picture *p, const struct noise_texture *t)
{
    double taps[MEASURE_TAPS];

    p->texture = t;
    p->width = t->width < PERIOD ? PERIOD : t->width;
    p->height = t->height < PERIOD ? PERIOD : t->height;
    p->pixels = (size_t)p->width * p->height;
    p->threshold = malloc((3 + t->frames) * p->pixels * sizeof(float));
    if (!p->threshold)
        return false;
    p->mean = p->threshold + p->pixels;
    p->blurred = p->mean + p->pixels;
    p->error = p->blurred + p->pixels;
    measure_taps(MEASURE_GAUSS1, taps);
    for (int i = 0; i < MEASURE_TAPS; i++)
        p->taps[i] = (float)taps[i];
    for (uint32_t i = 0; i < HISTORY; i++)
        p->ema[i] = (float)(pow(1 - ALPHA, i) * (i + 1 < HISTORY ? ALPHA : 1));
    return true;
}

static double sum_of_squares(const float *v, uint32_t n)
{
    double sum = 0;
    for (uint32_t i = 0; i < n; i++)
        sum += (double)v[i] * v[i];
    return sum;
}

/* Threshold (1 + sin) / 2 along x or y. Returns the mean of theta (1 - theta):
 * the variance of an unfiltered pixel. */
static double set_wave(struct picture *p, bool along_y, double phase)
{
    double variance = 0;

    for (uint32_t y = 0; y < p->height; y++)
        for (uint32_t x = 0; x < p->width; x++) {
            const double at = (double)CYCLES * (along_y ? y : x) / PERIOD;
            const double theta = (1 + sin(2 * pi * (at + phase))) / 2;
            p->threshold[y * p->width + x] = (float)theta;
            variance += theta * (1 - theta);
        }
    return variance / (double)p->pixels;
}

static void sample(struct picture *p, uint32_t frame)
{
    const struct noise_texture *t = p->texture;
    float *error = p->error + frame * p->pixels;

    for (uint32_t y = 0; y < p->height; y++) {
        const uint8_t *row =
            t->values +
            ((size_t)frame * t->height + (y & (t->height - 1))) * t->width;
        const float *theta = p->threshold + y * p->width;
        for (uint32_t x = 0; x < p->width; x++) {
            const float v = ((float)row[x & (t->width - 1)] + 0.5f) / 256;
            error[y * p->width + x] =
                (v > theta[x] ? 1.0f : 0.0f) - (1 - theta[x]);
        }
    }
}

/* The mean over the frames up to `newest`. */
static void accumulate(struct picture *p, uint32_t newest)
{
    for (size_t i = 0; i < p->pixels; i++)
        p->mean[i] = 0;
    for (uint32_t age = 0; age < HISTORY; age++) {
        const uint32_t frame = (newest - age) & (p->texture->frames - 1);
        const float *error = p->error + frame * p->pixels, w = p->ema[age];
        for (size_t i = 0; i < p->pixels; i++)
            p->mean[i] += w * error[i];
    }
}

/* Both axes of the filter, in place. */
static void blur(struct picture *p)
{
    float row[256 + 2 * MEASURE_RADIUS];

    for (uint32_t y = 0; y < p->height; y++) {
        const float *from = p->mean + y * p->width;
        float *to = p->blurred + y * p->width;
        for (uint32_t x = 0; x < p->width + 2 * MEASURE_RADIUS; x++)
            row[x] = from[(x - MEASURE_RADIUS) & (p->width - 1)];
        for (uint32_t x = 0; x < p->width; x++) {
            to[x] = 0;
            for (uint32_t i = 0; i < MEASURE_TAPS; i++)
                to[x] += p->taps[i] * row[x + i];
        }
    }
    for (size_t i = 0; i < p->pixels; i++)
        p->mean[i] = 0;
    for (uint32_t y = 0; y < p->height; y++)
        for (uint32_t i = 0; i < MEASURE_TAPS; i++) {
            const uint32_t y2 = (y + i - MEASURE_RADIUS) & (p->height - 1);
            const float *from = p->blurred + y2 * p->width;
            float *to = p->mean + y * p->width;
            for (uint32_t x = 0; x < p->width; x++)
                to[x] += p->taps[i] * from[x];
        }
}

/* Mean squared error of one wave, over every newest frame. */
static double squared_error(struct picture *p)
{
    double sum = 0;

    for (uint32_t frame = 0; frame < p->texture->frames; frame++)
        sample(p, frame);
    for (uint32_t frame = 0; frame < p->texture->frames; frame++) {
        accumulate(p, frame);
        blur(p);
        sum += sum_of_squares(p->mean, (uint32_t)p->pixels);
    }
    return sum / (double)p->pixels / p->texture->frames;
}

bool measure_gradient(const struct noise_texture *t, double along[2])
{
    struct picture p;
    double gain;

    if (!open_picture(&p, t))
        return false;
    gain = sum_of_squares(p.taps, MEASURE_TAPS);
    gain *= gain * sum_of_squares(p.ema, HISTORY);
    for (int axis = 0; axis < 2; axis++) {
        double error = 0, white = 0;
        for (int i = 0; i < PHASES; i++) {
            white += gain * set_wave(&p, axis, i * PHASE);
            error += squared_error(&p);
        }
        along[axis] = sqrt(error / white);
    }
    free(p.threshold);
    return true;
}
