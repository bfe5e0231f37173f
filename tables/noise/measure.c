/* SPDX-License-Identifier: MIT */
/* Loss and RMSE of a texture; measure.h has the derivation. */
#include "measure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ALPHA 0.1
#define BETA 0.1
#define HISTORY 32u                /* frames that RMSE looks back */
#define LEVELS 64u                 /* thresholds of RMSE */
#define REACH (2 * MEASURE_RADIUS) /* of a filter's autocorrelation */
#define SPAN (2 * REACH + 1)

/// Filters ///

/* The tap of a Gaussian that covers [i - 1/2, i + 1/2]; 3 is where the sum
 * passes the paper's 0.995 for sigma = 1. */
static double gauss_tap(int i)
{
    return erf((i + 0.5) / sqrt(2)) - erf((i - 0.5) / sqrt(2));
}

static double raw_tap(enum measure_filter filter, int i)
{
    const int distance = abs(i);

    switch (filter) {
    case MEASURE_GAUSS1: return gauss_tap(i);
    case MEASURE_BINOMIAL3: return distance < 2 ? 2 - distance : 0;
    case MEASURE_BOX3: return distance < 2;
    case MEASURE_BOX5: return distance < 3;
    default: return distance == 0;
    }
}

void measure_taps(enum measure_filter filter, double taps[MEASURE_TAPS])
{
    double sum = 0;
    for (int i = 0; i < MEASURE_TAPS; i++)
        sum += taps[i] = raw_tap(filter, i - MEASURE_RADIUS);
    for (int i = 0; i < MEASURE_TAPS; i++)
        taps[i] /= sum;
}

/* g[i + REACH] = autocorrelation of one axis at i. */
static void space_correlation(enum measure_filter filter, double g[SPAN])
{
    double taps[MEASURE_TAPS];

    measure_taps(filter, taps);
    memset(g, 0, SPAN * sizeof g[0]);
    for (int i = 0; i < MEASURE_TAPS; i++)
        for (int k = 0; k < MEASURE_TAPS; k++)
            g[i - k + REACH] += taps[i] * taps[k];
}

/* Weight of frame i, the newest being 0, in a history of m frames. */
static double ema_tap(uint32_t i, uint32_t m, double alpha)
{
    return pow(1 - alpha, i) * (i + 1 < m ? alpha : 1);
}

static void add_history(double *g, uint32_t m, double alpha, double weight)
{
    for (uint32_t j = 0; j < m; j++)
        for (uint32_t i = 0; i + j < m; i++)
            g[j] += weight * ema_tap(i, m, alpha) * ema_tap(i + j, m, alpha);
}

void measure_ema(double *g, uint32_t horizon, double alpha, double beta)
{
    const double all = 1 - pow(1 - beta, horizon);

    for (uint32_t j = 0; j < horizon; j++)
        g[j] = 0;
    if (beta <= 0) {
        add_history(g, horizon, alpha, 1);
        return;
    }
    for (uint32_t m = 1; m <= horizon; m++)
        add_history(g, m, alpha, beta * pow(1 - beta, m - 1) / all);
}

/* What a texture of `frames` slices sees of g, for dt = 0 .. frames - 1. */
static void wrap(double *wrapped, uint32_t frames, const double *g,
                 uint32_t horizon)
{
    for (uint32_t j = 0; j < frames; j++)
        wrapped[j] = 0;
    for (uint32_t j = 0; j < horizon; j++) {
        wrapped[j % frames] += g[j];
        if (j)
            wrapped[(frames - j % frames) % frames] += g[j];
    }
}

/// Pairs ///

/* A texture whose values were replaced by levels, its rows repeated REACH
 * pixels beyond both ends. */
struct levels {
    uint32_t width, height, frames, pitch;
    uint8_t *level;
};

static bool make_levels(struct levels *l, const struct noise_texture *t,
                        const uint8_t level_of[256])
{
    const uint32_t mask = t->width - 1, rows = t->height * t->frames;

    l->width = t->width;
    l->height = t->height;
    l->frames = t->frames;
    l->pitch = t->width + 2 * REACH;
    l->level = malloc((size_t)rows * l->pitch);
    if (!l->level)
        return false;
    for (size_t row = 0; row < rows; row++)
        for (uint32_t x = 0; x < l->pitch; x++)
            l->level[row * l->pitch + x] =
                level_of[t->values[row * t->width +
                                   ((x + 256 - REACH) & mask)]];
    return true;
}

/* At most 256 values of 255: the sum fits 16 bits, which vectorises best. */
static uint32_t sum_of_minima(const uint8_t *a, const uint8_t *b, uint32_t n)
{
    uint16_t sum = 0;
    for (uint32_t x = 0; x < n; x++)
        sum = (uint16_t)(sum + (a[x] < b[x] ? a[x] : b[x]));
    return sum;
}

/* E_p[min(level_p, level_{p + o})] for o = (dx, dy, dt), dx = -REACH .. REACH.
 */
static void pairs_of_rows(const struct levels *l, uint32_t dt, int dy,
                          double minimum[SPAN])
{
    uint64_t sum[SPAN] = {0};
    const size_t slice = (size_t)l->height * l->pitch;

    for (uint32_t t = 0; t < l->frames; t++)
        for (uint32_t y = 0; y < l->height; y++) {
            const uint32_t y2 = (y + (uint32_t)(dy + 256)) & (l->height - 1);
            const uint8_t *a = l->level + t * slice + y * l->pitch + REACH;
            const uint8_t *b =
                l->level + y2 * l->pitch + ((t + dt) & (l->frames - 1)) * slice;
            for (uint32_t i = 0; i < SPAN; i++)
                sum[i] += sum_of_minima(a, b + i, l->width);
        }
    for (uint32_t i = 0; i < SPAN; i++)
        minimum[i] = (double)sum[i] / l->width / l->height / l->frames;
}

/* sum_o G(o) E_p[min] for every filter, in levels. o and -o are alike, so
 * half of the time differences and half of the rest suffice. */
static void weigh_pairs(const struct levels *l, const double *time,
                        double sum[MEASURE_FILTERS])
{
    double g[MEASURE_FILTERS][SPAN], minimum[SPAN];

    for (int f = 0; f < MEASURE_FILTERS; f++) {
        space_correlation((enum measure_filter)f, g[f]);
        sum[f] = 0;
    }
    for (uint32_t dt = 0; dt <= l->frames / 2; dt++) {
        const bool own_mirror = dt == 0 || 2 * dt == l->frames;
        for (int dy = own_mirror ? 0 : -REACH; dy <= REACH; dy++) {
            const double twice = own_mirror && dy == 0 ? 1 : 2;
            pairs_of_rows(l, dt, dy, minimum);
            for (int f = 0; f < MEASURE_FILTERS; f++)
                for (uint32_t i = 0; i < SPAN; i++)
                    sum[f] += twice * time[dt] * g[f][dy + REACH] * g[f][i] *
                              minimum[i];
        }
    }
}

/* A value as the core's thresholds see it: x = (level + offset) / scale. With
 * LEVELS thresholds at (k + 1/2) / LEVELS, the level is how many x exceeds,
 * and the integrals of measure.h become sums with x = level / LEVELS. */
struct reading {
    uint8_t level[256];
    double scale, offset;
    double one_third; /* mean of (1 - theta)^2 */
};

static void read_exactly(struct reading *r)
{
    for (uint32_t b = 0; b < 256; b++)
        r->level[b] = (uint8_t)b;
    r->scale = 256;
    r->offset = 0.5;
    r->one_third = 1.0 / 3;
}

static void read_thresholds(struct reading *r)
{
    const uint32_t width = 256 / LEVELS;
    for (uint32_t b = 0; b < 256; b++)
        r->level[b] = (uint8_t)((b + width / 2) / width);
    r->scale = LEVELS;
    r->offset = 0;
    r->one_third = 1.0 / 3 - 1.0 / (12.0 * LEVELS * LEVELS);
}

static double mean_of_k1(const struct noise_texture *t, const struct reading *r)
{
    const size_t n = (size_t)t->width * t->height * t->frames;
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        const double x = (r->level[t->values[i]] + r->offset) / r->scale;
        sum += x - x * x / 2;
    }
    return sum / (double)n;
}

/* Expected squared error of every filter with EMA(alpha, beta), relative to
 * white noise that never repeats. */
static bool relative_errors(const struct noise_texture *t,
                            const struct reading *r, uint32_t horizon,
                            double beta, double error[MEASURE_FILTERS])
{
    double *g = malloc((horizon + t->frames) * sizeof *g), *time = g + horizon;
    struct levels l;
    const bool made = g && make_levels(&l, t, r->level);

    if (made) {
        const double white = 0.5 - r->one_third, k1 = mean_of_k1(t, r);
        measure_ema(g, horizon, ALPHA, beta);
        wrap(time, t->frames, g, horizon);
        weigh_pairs(&l, time, error);
        for (int f = 0; f < MEASURE_FILTERS; f++) {
            double s[SPAN];
            space_correlation((enum measure_filter)f, s);
            error[f] =
                (error[f] + r->offset) / r->scale - 2 * k1 + r->one_third;
            error[f] /= white * g[0] * s[REACH] * s[REACH];
        }
        free(l.level);
    }
    free(g);
    return made;
}

bool noise_measure(const struct noise_texture *t, struct noise_measures *m)
{
    struct reading r;

    read_exactly(&r);
    if (!relative_errors(t, &r, t->frames > HISTORY ? t->frames : HISTORY, BETA,
                         m->loss))
        return false;
    read_thresholds(&r);
    if (!relative_errors(t, &r, HISTORY, 0, m->rmse))
        return false;
    for (int f = 0; f < MEASURE_FILTERS; f++)
        m->rmse[f] = sqrt(m->rmse[f]);
    return measure_gradient(t, m->gradient);
}

/// Tables ///

void noise_measure_head(FILE *out)
{
    fprintf(out, "| texture | loss gauss1 | bin3 | box3 | box5 | EMA only | "
                 "RMSE, EMA only | + gauss1 | + box3 | + box5 | + bin3 | "
                 "gradient x | y |\n"
                 "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void noise_measure_row(FILE *out, const char *name,
                       const struct noise_measures *m)
{
    static const enum measure_filter loss[] = {MEASURE_GAUSS1,
                                               MEASURE_BINOMIAL3, MEASURE_BOX3,
                                               MEASURE_BOX5, MEASURE_NONE};
    static const enum measure_filter rmse[] = {MEASURE_NONE, MEASURE_GAUSS1,
                                               MEASURE_BOX3, MEASURE_BOX5,
                                               MEASURE_BINOMIAL3};
    fprintf(out, "| %s |", name);
    for (int i = 0; i < MEASURE_FILTERS; i++)
        fprintf(out, " %.4f |", m->loss[loss[i]]);
    for (int i = 0; i < MEASURE_FILTERS; i++)
        fprintf(out, " %.3f |", m->rmse[rmse[i]]);
    fprintf(out, " %.3f | %.3f |\n", m->gradient[0], m->gradient[1]);
}
