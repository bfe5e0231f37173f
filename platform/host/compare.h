/* SPDX-License-Identifier: MIT */
/*
 * How far apart two images are, and the command `brume compare`.
 */
#ifndef BRUME_HOST_COMPARE_H
#define BRUME_HOST_COMPARE_H

#include "image.h"

#define COMPARE_TILE 8 /* pixels a side; tiles at the edges may be smaller */

/* In 1/255 of full scale, over all samples of all pixels, except psnr. */
struct compare_result {
    double rmse;       /* root of the mean squared difference */
    double mean;       /* mean of b - a: above 0 where b is brighter */
    double psnr;       /* dB against 255; infinite for identical images */
    double max;        /* largest absolute difference */
    double worst_tile; /* largest RMSE of a COMPARE_TILE square */
};

/* Compare two images of the same size. Grey against RGB: grey counts as three
 * equal channels. 8 bits against float: 255 is 1.0.
 *
 * Returns 0, or -1 with a message as in image.h when the sizes differ. */
int image_compare(const struct image *a, const struct image *b,
                  struct compare_result *result, char *err, size_t err_size);

/* The command: argv[1] on are its arguments, argv[0] is not looked at. Prints
 * the metrics to stdout, one name=value a line, errors to stderr.
 *
 * Returns the exit status: 0; 1 when the RMSE is above --max-rmse; 2 on bad
 * usage, unreadable files and differing sizes. */
int compare_main(int argc, char **argv);

#endif
