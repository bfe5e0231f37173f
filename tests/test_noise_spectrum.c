/* SPDX-License-Identifier: MIT */
/* Fourier transforms, the energy in a filter's pass band, and the picture. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fft.h"
#include "formula.h"
#include "spectrum.h"
#include "tap.h"

static const double pi = 3.14159265358979323846;

/* A box of 8x4x2 against the sum that defines its transform. */
static void test_fft(void)
{
    double complex v[64], f[64];
    double worst = 0;

    for (int i = 0; i < 64; i++)
        f[i] = v[i] = (double)(i * 37 % 64) + (double)(i * 11 % 23) * I;
    fft_box(f, 8, 4, 2);
    for (int k = 0; k < 64; k++) {
        double complex sum = 0;
        for (int i = 0; i < 64; i++) {
            const double turn = (i % 8) * (k % 8) / 8.0 +
                                (i / 8 % 4) * (k / 8 % 4) / 4.0 +
                                (i / 32) * (k / 32) / 2.0;
            sum += v[i] * (cos(2 * pi * turn) - sin(2 * pi * turn) * I);
        }
        worst = fmax(worst, cabs(sum - f[k]));
    }
    tap_check(worst < 1e-10, "fft of 8x4x2: %.1e off its definition", worst);
}

/* White noise has the same power everywhere. Five standard errors of the
 * seeds' mean; the threshold's levels share the noise, so the error of one
 * texture is large. */
static void test_white(void)
{
    enum { seeds = 16 };
    double sum[MEASURE_FILTERS] = {0}, squares[MEASURE_FILTERS] = {0};
    struct noise_texture t;

    if (!noise_texture_make(&t, 64, 32, 16, 1))
        exit(1);
    for (uint32_t seed = 0; seed < seeds; seed++) {
        double energy[MEASURE_FILTERS];
        noise_white(&t, seed);
        noise_pass_band(&t, energy);
        for (int f = 0; f < MEASURE_FILTERS; f++) {
            sum[f] += energy[f] / seeds;
            squares[f] += energy[f] * energy[f] / seeds;
        }
    }
    for (int f = 0; f < MEASURE_FILTERS; f++) {
        const double error = sqrt((squares[f] - sum[f] * sum[f]) / (seeds - 1));
        tap_check(fabs(sum[f] - 1) < 5 * error && error < .1,
                  "white: filter %d passes %.4f, 1 +- %.4f", f, sum[f], error);
    }
    noise_texture_free(&t);
}

/* Bayer's 8x8 moved by the golden ratio has no power between the multiples of
 * 1/8 but zero, and there every level is met once per tile: with thresholds
 * between levels a frame's mean is exact. */
static void test_bayer(void)
{
    double energy[MEASURE_FILTERS];
    struct noise_texture t;

    if (!noise_texture_make(&t, 64, 64, 1, 1))
        exit(1);
    noise_bayer(&t, 8);
    noise_pass_band(&t, energy);
    tap_check(energy[MEASURE_BOX5] < 1e-6,
              "bayer8: box5 passes %.1e of white's energy",
              energy[MEASURE_BOX5]);
    noise_texture_free(&t);
}

/* Mean and largest grey of a panel. */
static void panel(const struct image *image, int index, double *mean, int *max)
{
    *mean = 0;
    *max = 0;
    for (int y = 0; y < 32; y++)
        for (int x = 0; x < 32; x++) {
            const int v = image->u8[y * image->width + index * 36 + x];
            *mean += v / 1024.0;
            *max = v > *max ? v : *max;
        }
}

/* Averages of many white spectra: grey is 128 times the root of their power,
 * whose mean is somewhat below 128, and the centre is black. */
static void test_picture(void)
{
    struct noise_texture t;
    struct image image;
    char err[100];
    int max;

    if (!noise_texture_make(&t, 32, 32, 16, 1))
        exit(1);
    noise_white(&t, 3);
    if (tap_check(!noise_spectrum(&t, &image, err, sizeof err) &&
                      image.width == 140 && image.height == 32,
                  "picture of 140x32")) {
        for (int i = 1; i < 3; i++) {
            double mean;
            panel(&image, i, &mean, &max);
            tap_check(mean > 120 && mean < 130 && max < 255 &&
                          image.u8[16 * 140 + 36 * i + 16] == 0,
                      "white: panel %d has mean grey %.1f", i, mean);
        }
        tap_check(!memcmp(image.u8, t.values, 32) &&
                      !memcmp(image.u8 + 140, t.values + 32, 32),
                  "picture: frame 0 on the left");
        image_free(&image);
    }
    noise_texture_free(&t);
}

int main(void)
{
    test_fft();
    test_white();
    test_bayer();
    test_picture();
    return tap_done();
}
