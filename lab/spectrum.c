/* SPDX-License-Identifier: MIT */
/*
 * The spectrum of what frames have wrong: power of picture - truth by
 * frequency, the mean over frames (Donnelly et al. 2024, figures 2 and 9).
 */
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fft.h"
#include "lab.h"

#define BANDS 16 /* of 1/32 cycle per pixel: up to 1/2 */

/* The largest power of two that fits, and that the transform takes. */
static int side_of(double part)
{
    int side = 1;
    while (2 * side <= part && 2 * side <= FFT_MAX)
        side *= 2;
    return side;
}

/* In the middle of the last region, which is the whole when none is given. */
static void place(struct lab_spectrum *s, const struct lab_region *r,
                  const struct image *image)
{
    s->width = side_of(r->w * image->width);
    s->height = side_of(r->h * image->height);
    s->x = (int)((r->x + r->w / 2) * image->width) - s->width / 2;
    s->y = (int)((r->y + r->h / 2) * image->height) - s->height / 2;
    s->x = s->x < 0 ? 0 : s->x;
    s->y = s->y < 0 ? 0 : s->y;
}

/* Hann's window, of squared mean 3/8: the picture does not repeat, and without
 * it the jump from one side to the other would fill the axes. */
static double window(int i, int n)
{
    return 0.5 - 0.5 * cos(2 * 3.14159265358979323846 * (i + 0.5) / n);
}

int lab_spectrum_add(struct lab_spectrum *s, const struct lab_region *region,
                     const struct lab_pair *pair)
{
    const struct image *picture = pair->picture;
    if (s->power == NULL) {
        place(s, region, picture);
        s->power =
            calloc((size_t)s->width * (size_t)s->height, sizeof *s->power);
    }
    const size_t n = (size_t)s->width * (size_t)s->height;
    double complex *plane = malloc(n * sizeof *plane);
    if (s->power == NULL || plane == NULL) {
        free(plane);
        return -1;
    }
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            size_t at = ((size_t)(s->y + y) * (size_t)picture->width +
                         (size_t)(s->x + x)) *
                        (size_t)picture->channels;
            plane[y * s->width + x] =
                ((double)picture->f32[at] - (double)pair->truth->f32[at]) *
                window(x, s->width) * window(y, s->height);
        }
    fft_box(plane, (uint32_t)s->width, (uint32_t)s->height, 1);
    for (size_t i = 0; i < n; i++)
        s->power[i] += creal(plane[i]) * creal(plane[i]) +
                       cimag(plane[i]) * cimag(plane[i]);
    free(plane);
    s->frames++;
    return 0;
}

/* Cycles per pixel, -1/2 .. 1/2. */
static double cycles(int k, int n)
{
    return (double)(k < n / 2 ? k : k - n) / n;
}

/* Zero frequency in the centre and left out; grey is the square root of power,
 * 128 where it is the mean: what white noise has everywhere. */
static int write_picture(const struct lab_spectrum *s, const char *base,
                         char *err, size_t err_size)
{
    const int w = s->width, h = s->height;
    char name[LAB_ERROR];
    struct image image = {0};
    double sum = 0;
    for (int i = 1; i < w * h; i++)
        sum += s->power[i];
    if (image_new_u8(&image, w, h, 1, err, err_size) != 0)
        return -1;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            int kx = (x + w / 2) % w, ky = (y + h / 2) % h;
            double power = kx || ky ? s->power[ky * w + kx] : 0;
            double grey = sum > 0 ? 128 * sqrt(power * (w * h - 1) / sum) : 0;
            image.u8[y * w + x] = (uint8_t)lround(fmin(grey, 255));
        }
    snprintf(name, sizeof name, "%.900s.png", base);
    int bad = image_write(name, &image, err, err_size);
    image_free(&image);
    return bad;
}

/* Power by distance from zero frequency. All bands together, weighted by their
 * counts, are the variance of the error. */
static int write_bands(const struct lab_spectrum *s,
                       const struct lab_options *o, char *err, size_t err_size)
{
    double sum[BANDS] = {0}, count[BANDS] = {0};
    const double scale = (double)s->frames * s->width * s->height * 9 / 64;
    char name[LAB_ERROR];
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            double f = hypot(cycles(x, s->width), cycles(y, s->height));
            int band = (int)(f * 2 * BANDS);
            if (band >= BANDS || (x == 0 && y == 0))
                continue;
            sum[band] += s->power[y * s->width + x];
            count[band]++;
        }
    snprintf(name, sizeof name, "%.900s.csv", o->spectrum);
    FILE *to = fopen(name, "w");
    if (to != NULL) {
        for (int i = 0; i < o->column_count; i++)
            fprintf(to, "%s,", o->columns[i].name);
        fprintf(to, "frequency,power\n");
        for (int band = 0; band < BANDS; band++) {
            for (int i = 0; i < o->column_count; i++)
                fprintf(to, "%s,", o->columns[i].value);
            fprintf(to, "%.6g,%.5g\n", (band + 0.5) / (2 * BANDS),
                    count[band] > 0 ? sum[band] / count[band] / scale : 0);
        }
    }
    if (to != NULL && fclose(to) == 0)
        return 0;
    snprintf(err, err_size, "%.900s: cannot be written", name);
    return -1;
}

int lab_spectrum_write(const struct lab_spectrum *s,
                       const struct lab_options *o, char *err, size_t err_size)
{
    if (write_picture(s, o->spectrum, err, err_size) != 0 ||
        write_bands(s, o, err, err_size) != 0)
        return 1;
    return 0;
}
