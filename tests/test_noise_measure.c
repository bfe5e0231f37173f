/* SPDX-License-Identifier: MIT */
/*
 * The measures of noise textures.
 *
 * Against the figures of published textures, against a Monte Carlo simulation
 * of what they stand for, and against white noise. Where chance decides, the
 * bound is five standard errors of the very samples.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formula.h"
#include "measure.h"
#include "tap.h"

/// Published textures ///

struct published {
    const char *file;
    double loss[MEASURE_FILTERS]; /* in the order of enum measure_filter */
    double rmse[MEASURE_FILTERS];
};

/* 0: not published. */
static const struct published published[] = {
    {"gauss1_0_exp0101_product",
     {0, .1190, .2512, .2668, .1878},
     {.957, .256, .407, .460, .376}},
    {"binomial3x3_exp0101_product",
     {0, .1075, .1859, .2747, .1830},
     {.925, .215, .307, .459, .346}},
    {"box3x3_exp0101_product",
     {0, .1281, .2756, .1821, .2139},
     {.909, .264, .432, .318, .384}},
    {"gauss1_0_exp0101_separate05",
     {0, .1585, .2971, .2851, .2000},
     {.405, .257, .300, .292, .252}},
    {"binomial3x3_exp0101_separate05",
     {0, .1280, .2084, .2710, .1902},
     {.438, .265, .300, .306, .275}},
};

/* The largest relative difference from the figures that are there. */
static double off(const double *is, const double *figure)
{
    double worst = 0;
    for (int f = 0; f < MEASURE_FILTERS; f++)
        if (figure[f] > 0)
            worst = fmax(worst, fabs(is[f] / figure[f] - 1));
    return worst;
}

static void test_published(const struct published *p)
{
    const char *data = getenv("DATA");
    struct noise_measures m;
    struct noise_texture t;
    char path[512], err[600];

    snprintf(path, sizeof path,
             "%s/../reference/noise/real_uniform_%s.128x128x32.raw",
             data ? data : "../shared/data", p->file);
    if (noise_texture_read(&t, path, 128, 128, 32, 1, err, sizeof err)) {
        tap_skip("published figures of %s: %s", p->file, err);
        return;
    }
    if (tap_check(noise_measure(&t, &m), "%s is measured", p->file)) {
        const double loss = off(m.loss, p->loss), rmse = off(m.rmse, p->rmse);
        tap_check(loss < .01, "%s: loss %.3f %% off the published figures",
                  p->file, 100 * loss);
        tap_check(rmse < .01, "%s: RMSE %.3f %% off the published figures",
                  p->file, 100 * rmse);
    }
    noise_texture_free(&t);
}

/// What the measures stand for ///

#define ALPHA 0.1
#define BETA 0.1
#define HISTORY 32

static uint64_t state = 12345;

/* Uniform in [0, 1), 53 bits: the SplitMix64 generator (Steele et al. 2014). */
static double chance(void)
{
    uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return (double)((z ^ z >> 31) >> 11) / 9007199254740992.0;
}

/* The filter's weight at a distance along one axis, before dividing by their
 * sum. Written from its name, not with measure_taps. */
static double weight_at(int filter, int d)
{
    const double root = sqrt(2);

    switch (filter) {
    case MEASURE_NONE: return d == 0;
    case MEASURE_GAUSS1: return (erf((d + .5) / root) - erf((d - .5) / root));
    case MEASURE_BINOMIAL3: return d == 0 ? 2 : abs(d) == 1;
    case MEASURE_BOX3: return abs(d) <= 1;
    default: return abs(d) <= 2;
    }
}

static double weight(int filter, int d)
{
    double sum = 0;
    for (int i = -3; i <= 3; i++)
        sum += weight_at(filter, i);
    return weight_at(filter, d) / sum;
}

/* Weights of m frames, the newest first: averaged as a renderer does it. */
static void ema_weights(double *w, int m)
{
    memset(w, 0, HISTORY * sizeof *w);
    w[m - 1] = 1;
    for (int i = m - 2; i >= 0; i--) {
        for (int k = i + 1; k < m; k++)
            w[k] *= 1 - ALPHA;
        w[i] = ALPHA;
    }
}

static double value(const struct noise_texture *t, int x, int y, int frame)
{
    const uint32_t i = (uint32_t)x & (t->width - 1);
    const uint32_t j = (uint32_t)y & (t->height - 1);
    const uint32_t k = (uint32_t)frame & (t->frames - 1);
    return (t->values[(k * t->height + j) * t->width + i] + .5) / 256;
}

/* The error of the filtered picture of [value > theta] at a pixel. */
static double filtered_error(const struct noise_texture *t, int filter,
                             const double *ema, double theta, const int at[3])
{
    const int radius = filter == MEASURE_NONE ? 0 : 3;
    double sum = 0;

    for (int dy = -radius; dy <= radius; dy++)
        for (int dx = -radius; dx <= radius; dx++) {
            const double w = weight(filter, dx) * weight(filter, dy);
            for (int age = 0; w > 0 && age < HISTORY; age++)
                if (ema[age] > 0 &&
                    value(t, at[0] + dx, at[1] + dy, at[2] - age) > theta)
                    sum += w * ema[age];
        }
    return sum - (1 - theta);
}

/* History lengths from 1 to HISTORY, geometric. */
static int random_history(void)
{
    const double u = chance() * (1 - pow(1 - BETA, HISTORY));
    const int m = 1 + (int)(log(1 - u) / log(1 - BETA));
    return m > HISTORY ? HISTORY : m;
}

/* The squared error of uncorrelated noise: var [x > theta], 1/6 on average,
 * times the sum of the squared weights. */
static double white_error(int filter, double mean_of_squares)
{
    double s = 0;
    for (int d = -3; d <= 3; d++)
        s += weight(filter, d) * weight(filter, d);
    return s * s * mean_of_squares / 6;
}

static double expected_ema_squares(void)
{
    double sum = 0, ema[HISTORY];

    for (int m = 1; m <= HISTORY; m++) {
        const double p =
            BETA * pow(1 - BETA, m - 1) / (1 - pow(1 - BETA, HISTORY));
        ema_weights(ema, m);
        for (int i = 0; i < m; i++)
            sum += p * ema[i] * ema[i];
    }
    return sum;
}

static void test_monte_carlo(const struct noise_texture *t, const char *name,
                             int filter, double loss)
{
    const int n = 40000;
    const double white = white_error(filter, expected_ema_squares());
    double sum = 0, squares = 0, ema[HISTORY], mean, error;

    for (int i = 0; i < n; i++) {
        const int at[3] = {(int)(chance() * t->width),
                           (int)(chance() * t->height),
                           (int)(chance() * t->frames)};
        double e;
        ema_weights(ema, random_history());
        e = filtered_error(t, filter, ema, chance(), at);
        sum += e * e / white;
        squares += e * e * e * e / white / white;
    }
    mean = sum / n;
    error = sqrt((squares / n - mean * mean) / n);
    tap_check(fabs(mean - loss) < 5 * error,
              "%s, filter %d: loss %.4f, Monte Carlo %.4f +- %.4f", name,
              filter, loss, mean, error);
}

/* All pixels, frames and 64 thresholds: the definition, without chance. */
static void test_rmse(const struct noise_texture *t, const char *name,
                      int filter, double rmse)
{
    double sum = 0, white = 0, squares = 0, ema[HISTORY];
    const int pixels = (int)(t->width * t->height);

    ema_weights(ema, HISTORY);
    for (int i = 0; i < HISTORY; i++)
        squares += ema[i] * ema[i];
    for (int k = 0; k < 64; k++) {
        const double theta = (k + .5) / 64;
        white += theta * (1 - theta) * 6 * white_error(filter, squares) / 64;
        for (int i = 0; i < pixels * (int)t->frames; i++) {
            const int at[3] = {i % (int)t->width,
                               i / (int)t->width % (int)t->height, i / pixels};
            const double e = filtered_error(t, filter, ema, theta, at);
            sum += e * e / 64 / pixels / t->frames;
        }
    }
    tap_check(fabs(sqrt(sum / white) / rmse - 1) < 1e-9,
              "%s, filter %d: RMSE %.4f is that of its definition", name,
              filter, rmse);
}

static void test_definitions(void)
{
    struct noise_texture t;
    struct noise_measures m;

    if (!noise_texture_make(&t, 8, 16, 4, 1))
        exit(1);
    noise_ign(&t, IGN_JIMENEZ);
    noise_measure(&t, &m);
    for (int f = 0; f < MEASURE_FILTERS; f++)
        test_monte_carlo(&t, "ign 8x16x4", f, m.loss[f]);
    test_rmse(&t, "ign 8x16x4", MEASURE_NONE, m.rmse[MEASURE_NONE]);
    test_rmse(&t, "ign 8x16x4", MEASURE_BOX5, m.rmse[MEASURE_BOX5]);
    noise_texture_free(&t);
    if (!noise_texture_make(&t, 16, 8, 64, 1))
        exit(1);
    noise_bayer(&t, 4);
    noise_golden(&t);
    noise_measure(&t, &m);
    test_rmse(&t, "bayer4 + golden 16x8x64", MEASURE_GAUSS1,
              m.rmse[MEASURE_GAUSS1]);
    noise_texture_free(&t);
}

/* White noise is what everything is relative to. */
static void check_one(const char *what, const double *is, int n)
{
    double sum = 0, squares = 0, mean, error;
    for (int i = 0; i < n; i++) {
        sum += is[i];
        squares += is[i] * is[i];
    }
    mean = sum / n;
    error = sqrt((squares / n - mean * mean) / (n - 1));
    tap_check(fabs(mean - 1) < 5 * error && error < .02,
              "white: %s %.4f, 1 +- %.4f", what, mean, error);
}

static void test_white_is_one(void)
{
    enum { seeds = 12 };
    double loss[MEASURE_FILTERS][seeds], rmse[MEASURE_FILTERS][seeds];
    double gradient[2][seeds];
    struct noise_texture t;
    struct noise_measures m;

    if (!noise_texture_make(&t, 64, 64, 32, 1))
        exit(1);
    for (uint32_t seed = 0; seed < seeds; seed++) {
        noise_white(&t, seed);
        noise_measure(&t, &m);
        for (int f = 0; f < MEASURE_FILTERS; f++) {
            loss[f][seed] = m.loss[f];
            rmse[f][seed] = m.rmse[f] * m.rmse[f];
        }
        for (int axis = 0; axis < 2; axis++)
            gradient[axis][seed] = m.gradient[axis] * m.gradient[axis];
    }
    for (int f = 0; f < MEASURE_FILTERS; f++) {
        check_one("loss", loss[f], seeds);
        check_one("squared RMSE", rmse[f], seeds);
    }
    check_one("squared gradient RMSE, x", gradient[0], seeds);
    check_one("squared gradient RMSE, y", gradient[1], seeds);
    noise_texture_free(&t);
}

int main(void)
{
    for (size_t i = 0; i < sizeof published / sizeof *published; i++)
        test_published(&published[i]);
    test_definitions();
    test_white_is_one();
    return tap_done();
}
