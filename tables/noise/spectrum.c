/* SPDX-License-Identifier: MIT */
/* Pictures and sums of spectra. */
#include "spectrum.h"

#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fft.h"

#define ALPHA 0.1
#define BETA 0.1
#define HISTORY 32u
#define GAP 4 /* pixels between the panels of a picture */

static double value(const struct noise_texture *t, size_t i)
{
    return (t->values[i * t->channels] + 0.5) / 256;
}

static double squared(double complex v)
{
    return creal(v) * creal(v) + cimag(v) * cimag(v);
}

/// Picture ///

/* What the panels are computed with: one slice or plane at a time. */
struct panels {
    const struct noise_texture *t;
    double mean, variance; /* of the values */
    double complex *plane; /* width x max(height, frames) */
    double *power;         /* the same; sums of squares */
};

static bool open_panels(struct panels *p, const struct noise_texture *t)
{
    const size_t rows = t->height > t->frames ? t->height : t->frames;
    const size_t n = (size_t)t->width * t->height * t->frames;
    double sum = 0, squares = 0;

    for (size_t i = 0; i < n; i++) {
        sum += value(t, i);
        squares += value(t, i) * value(t, i);
    }
    p->t = t;
    p->mean = sum / (double)n;
    p->variance = squares / (double)n - p->mean * p->mean;
    p->plane = malloc(t->width * rows * sizeof *p->plane);
    p->power = malloc(t->width * rows * sizeof *p->power);
    if (p->plane && p->power)
        return true;
    free(p->plane);
    free(p->power);
    return false;
}

static void clear_power(struct panels *p, uint32_t rows)
{
    memset(p->power, 0, (size_t)p->t->width * rows * sizeof *p->power);
}

static void add_power(struct panels *p, uint32_t rows)
{
    fft_box(p->plane, p->t->width, rows, 1);
    for (size_t i = 0; i < (size_t)p->t->width * rows; i++)
        p->power[i] += squared(p->plane[i]);
}

static void slice_spectrum(struct panels *p)
{
    const size_t slice = (size_t)p->t->width * p->t->height;

    clear_power(p, p->t->height);
    for (uint32_t frame = 0; frame < p->t->frames; frame++) {
        for (size_t i = 0; i < slice; i++)
            p->plane[i] = value(p->t, frame * slice + i) - p->mean;
        add_power(p, p->t->height);
    }
}

static void time_spectrum(struct panels *p)
{
    const uint32_t width = p->t->width;

    clear_power(p, p->t->frames);
    for (uint32_t y = 0; y < p->t->height; y++) {
        for (uint32_t frame = 0; frame < p->t->frames; frame++)
            for (uint32_t x = 0; x < width; x++)
                p->plane[frame * width + x] =
                    value(p->t,
                          ((size_t)frame * p->t->height + y) * width + x) -
                    p->mean;
        add_power(p, p->t->frames);
    }
}

static double ema_weight(uint32_t age)
{
    return pow(1 - ALPHA, age) * (age + 1 < HISTORY ? ALPHA : 1);
}

static void mean_spectrum(struct panels *p)
{
    const size_t slice = (size_t)p->t->width * p->t->height;

    clear_power(p, p->t->height);
    for (uint32_t newest = 0; newest < p->t->frames; newest++) {
        for (size_t i = 0; i < slice; i++)
            p->plane[i] = -p->mean;
        for (uint32_t age = 0; age < HISTORY; age++) {
            const uint32_t frame = (newest - age) & (p->t->frames - 1);
            for (size_t i = 0; i < slice; i++)
                p->plane[i] += ema_weight(age) * value(p->t, frame * slice + i);
        }
        add_power(p, p->t->height);
    }
}

static uint8_t grey(double v)
{
    return v > 255 ? 255 : (uint8_t)lround(v);
}

/* Draw the power of `rows` rows as panel `index`, zero frequency in the
 * centre; `white` is what white noise would have. */
static void draw_power(struct image *image, const struct panels *p, int index,
                       uint32_t rows, double white)
{
    const uint32_t width = p->t->width, height = p->t->height;

    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const uint32_t kx = (x + width / 2) & (width - 1);
            const uint32_t ky = (y * rows / height + rows / 2) & (rows - 1);
            const double power = kx || ky ? p->power[ky * width + kx] : 0;
            const size_t at = (size_t)y * (size_t)image->width + x +
                              (size_t)index * (width + GAP);
            image->u8[at] = grey(128 * sqrt(power / white));
        }
}

static void draw_slice(struct image *image, const struct noise_texture *t)
{
    for (uint32_t y = 0; y < t->height; y++)
        for (uint32_t x = 0; x < t->width; x++)
            image->u8[(size_t)y * (size_t)image->width + x] =
                t->values[((size_t)y * t->width + x) * t->channels];
}

int noise_spectrum(const struct noise_texture *t, struct image *image,
                   char *err, size_t err_size)
{
    const double pixels = (double)t->width * t->height;
    double white, squares = 0;
    struct panels p;

    if (image_new_u8(image, (int)(4 * t->width + 3 * GAP), (int)t->height, 1,
                     err, err_size))
        return -1;
    if (!open_panels(&p, t)) {
        image_free(image);
        snprintf(err, err_size, "no memory for the spectra");
        return -1;
    }
    memset(image->u8, 255, image_samples(image));
    for (uint32_t age = 0; age < HISTORY; age++)
        squares += ema_weight(age) * ema_weight(age);
    /* Of n values with variance v, every coefficient has the power n v; each
     * spectrum is a sum over the third axis. */
    white = p.variance * pixels * t->frames;
    draw_slice(image, t);
    slice_spectrum(&p);
    draw_power(image, &p, 1, t->height, white);
    time_spectrum(&p);
    draw_power(image, &p, 2, t->frames, white);
    mean_spectrum(&p);
    draw_power(image, &p, 3, t->height, white * squares);
    free(p.plane);
    free(p.power);
    return 0;
}

/// Pass band ///

/* Squared gain at each frequency of one axis: the transform of the filter's
 * autocorrelation, wrapped at n. */
static void space_gain(enum measure_filter filter, double *gain, uint32_t n)
{
    double complex v[FFT_MAX] = {0};
    double taps[MEASURE_TAPS];

    measure_taps(filter, taps);
    for (uint32_t i = 0; i < MEASURE_TAPS; i++)
        v[(i - MEASURE_RADIUS) & (n - 1)] += taps[i];
    fft_line(v, n);
    for (uint32_t i = 0; i < n; i++)
        gain[i] = squared(v[i]);
}

static void time_gain(double *gain, uint32_t n)
{
    const uint32_t horizon = n > HISTORY ? n : HISTORY;
    double complex v[FFT_MAX] = {0};
    double g[FFT_MAX];

    measure_ema(g, horizon, ALPHA, BETA);
    for (uint32_t j = 0; j < horizon; j++) {
        v[j & (n - 1)] += g[j];
        v[(0 - j) & (n - 1)] += j ? g[j] : 0;
    }
    fft_line(v, n);
    for (uint32_t i = 0; i < n; i++)
        gain[i] = creal(v[i]);
}

/* Add the error spectra of two thresholds to power. One is the real and one
 * the imaginary part: at k and -k together the squares are the sum of both,
 * and every band holds both. */
static void add_errors(const struct noise_texture *t, double complex *v,
                       double *power, double theta_1, double theta_2)
{
    const size_t n = (size_t)t->width * t->height * t->frames;

    for (size_t i = 0; i < n; i++) {
        const double x = value(t, i);
        v[i] =
            (x > theta_1) - (1 - theta_1) + ((x > theta_2) - (1 - theta_2)) * I;
    }
    fft_box(v, t->width, t->height, t->frames);
    for (size_t i = 0; i < n; i++)
        power[i] += squared(v[i]);
}

/* Mean power where the filter passes at least half. */
static double band_mean(const struct noise_texture *t, const double *power,
                        enum measure_filter filter)
{
    double gain_x[FFT_MAX], gain_y[FFT_MAX], gain_t[FFT_MAX], sum = 0;
    size_t count = 0, i = 0;

    space_gain(filter, gain_x, t->width);
    space_gain(filter, gain_y, t->height);
    time_gain(gain_t, t->frames);
    for (uint32_t frame = 0; frame < t->frames; frame++)
        for (uint32_t y = 0; y < t->height; y++)
            for (uint32_t x = 0; x < t->width; x++, i++)
                if (gain_x[x] * gain_y[y] * gain_t[frame] >= 0.5) {
                    sum += power[i];
                    count++;
                }
    return sum / (double)count;
}

bool noise_pass_band(const struct noise_texture *t,
                     double energy[MEASURE_FILTERS])
{
    const uint32_t thresholds = 16;
    const size_t n = (size_t)t->width * t->height * t->frames;
    double complex *v = malloc(n * sizeof *v);
    double *power = calloc(n, sizeof *power), white = 0;

    for (uint32_t k = 0; v && power && k < thresholds; k += 2) {
        const double theta_1 = (k + 0.5) / thresholds;
        const double theta_2 = (k + 1.5) / thresholds;
        add_errors(t, v, power, theta_1, theta_2);
        white += theta_1 * (1 - theta_1) + theta_2 * (1 - theta_2);
    }
    for (int f = 0; v && power && f < MEASURE_FILTERS; f++)
        energy[f] =
            band_mean(t, power, (enum measure_filter)f) / (white * (double)n);
    free(power);
    free(v);
    return white > 0;
}
