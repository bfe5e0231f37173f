/* SPDX-License-Identifier: MIT */
/*
 * How far pictures are from a reference: one by one, and over time. A library
 * of the host, in double: `brume compare`, the tests and the laboratory link
 * it. Nothing here is shared with the core.
 *
 * Samples. 8 bits and floats may be mixed: 255 is 1.0. Grey against RGB counts
 * as three equal channels; alpha is dropped. Differences are in 1/255 of full
 * scale, and are not clamped: floats may leave 0 .. 1. Sums run in a fixed
 * order, so the same files give the same digits on any IEEE host.
 *
 * Order. `a` is the reference and `b` what is judged; only signs depend on it.
 *
 * Errors: as in image.h. Different sizes are the only one of two good images,
 * besides a lack of memory.
 */
#ifndef BRUME_HOST_METRICS_H
#define BRUME_HOST_METRICS_H

#include <stdbool.h>

#include "image.h"

/// Error ///

#define METRICS_TILE 8 /* pixels a side; tiles at the edges may be smaller */

/* In 1/255 of full scale, over all samples of all pixels, except psnr. */
struct metrics_error {
    double rmse;       /* root of the mean squared difference */
    double mean;       /* mean of b - a: above 0 where b is brighter */
    double psnr;       /* dB against 255; infinite for identical images */
    double max;        /* largest absolute difference */
    double worst_tile; /* largest RMSE of a METRICS_TILE square */
};

int metrics_error(const struct image *a, const struct image *b,
                  struct metrics_error *result, char *err, size_t err_size);

/* The decibels of an RMSE in 1/255: infinite for 0. */
double metrics_psnr(double rmse);

/* Gradients of b along those of a, per gradient of a, on the mean of channels:
 * 1 where b is as sharp, 0 where it is flat. Noise, which is as often along as
 * against them, does not count. 1 when a is flat. */
int metrics_sharpness(const struct image *a, const struct image *b,
                      double *sharpness, char *err, size_t err_size);

/// SSIM (metrics_ssim.c) ///

#define METRICS_SSIM_WINDOW 11 /* pixels a side */

/* The mean structural similarity of Wang, Bovik, Sheikh and Simoncelli 2004,
 * "Image quality assessment: from error visibility to structural similarity",
 * as in their program: luma (0.299, 0.587, 0.114), 11x11 Gaussian windows of
 * sigma 1.5 that lie inside the image, K1 = 0.01, K2 = 0.03, L = 255, not
 * downsampled. 1 for identical images. NaN for images with a side below 11,
 * for which the paper defines nothing. */
int metrics_ssim(const struct image *a, const struct image *b, double *ssim,
                 char *err, size_t err_size);

/// FLIP (metrics_flip.c) ///

/* Of a display 0.7 m wide with 3840 pixels seen from 0.7 m: the paper's. */
#define METRICS_FLIP_DEGREE 67.0206 /* pixels per degree of vision */

struct metrics_flip {
    double mean, max; /* 0 none to 1 */
};

/* LDR-FLIP of Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and
 * Fairchild 2020, "FLIP: A Difference Evaluator for Alternating Images". What a
 * viewer sees when the two images alternate, at `degree` pixels per degree, 1
 * to 200. Samples are clamped to 0 .. 1 and taken as sRGB codes, whatever their
 * type, or as linear light.
 *
 * `map`, if not NULL, becomes a grey float image of FLIP at each pixel. */
int metrics_flip(const struct image *a, const struct image *b, bool linear,
                 double degree, struct metrics_flip *result, struct image *map,
                 char *err, size_t err_size);

/// Maps (metrics_map.c) ///

/* Make *map a grey float image: at each pixel the mean over channels of the
 * absolute difference, 1.0 for 255. */
int metrics_error_map(const struct image *a, const struct image *b,
                      struct image *map, char *err, size_t err_size);

/* Make *picture an RGB one of a grey float map: 0 is black, `white` and more
 * the palest colour of magma (van der Walt and Smith 2015, CC0), whose
 * lightness rises evenly in between. `white` is above 0. */
int metrics_heat(const struct image *map, double white, struct image *picture,
                 char *err, size_t err_size);

/// Over time (metrics_time.c) ///

/* e = b - a is the error of a frame, d a change from the frame before. Means
 * are over all samples of all frames that have what they need. In 1/255 but
 * for lag and psnr. */
struct metrics_time {
    double ghosting;  /* mean |e|: all that is not the reference's frame, which
                         after a change is what is left of earlier ones */
    double flicker;   /* mean |d b - d a| = mean |d e| */
    double deviation; /* over time: root of the mean, over samples, of the
                         variance of e. Of b itself where a stands still */
    double lag;       /* frames that b is behind a: -sum(e d a) / sum(d a)^2;
                         0 where a stands still. k for the reference of k frames
                         ago, in steady change */
    double psnr;      /* tPSNR, in dB: of the changes d b against d a */
};

/* Private but for its size: all zero is a sequence without frames. */
struct metrics_sequence {
    int width, height, frames;
    double *first, *before, *reference, *sum, *square;
    double total_error, total_flicker, total_square, total_lag, total_change;
};

/* The next frame: b, and what it should be. Memory of 120 bytes a pixel is
 * taken with the first one. After an error the sequence is as it was. */
int metrics_add(struct metrics_sequence *s, const struct image *a,
                const struct image *b, char *err, size_t err_size);

/* Of the frames so far. One frame has no changes: flicker, deviation and lag
 * are 0, psnr infinite. */
void metrics_finish(const struct metrics_sequence *s,
                    struct metrics_time *result);

/* Release its memory and make it empty. */
void metrics_free(struct metrics_sequence *s);

#endif
