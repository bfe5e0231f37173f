/* SPDX-License-Identifier: MIT */
/*
 * What a texture looks like in frequency (Donnelly et al. 2024, fig. 2 and 3),
 * and how much of its error is where the filters do not remove it.
 */
#ifndef BRUME_TABLES_SPECTRUM_H
#define BRUME_TABLES_SPECTRUM_H

#include <stdbool.h>

#include "image.h"
#include "measure.h"

/* Make *image a grey picture, left to right: slice 0; power spectrum of the
 * slices, averaged; spectrum over x and t, averaged over y (t upwards,
 * stretched to the slice's height); spectrum of the EMA's mean, averaged over
 * starts. Zero frequency is in the centre and left out; grey is the square
 * root of power, white noise of the same distribution is 128 (in the last one
 * after the EMA). Returns 0 or -1 as image.h says. */
int noise_spectrum(const struct noise_texture *t, struct image *image,
                   char *err, size_t err_size);

/* The energy of the error's spectrum inside the pass band of spatial filter x
 * EMA(0.1, 0.1), per filter: the mean power over frequencies at which the
 * filter's squared gain is at least a half, zero frequency included, relative
 * to white. The error is that of Heaviside integrands, averaged over
 * thresholds. False when there is no memory. */
bool noise_pass_band(const struct noise_texture *t,
                     double energy[MEASURE_FILTERS]);

#endif
