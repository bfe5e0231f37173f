/* SPDX-License-Identifier: MIT */
/* How good a texture is when a pixel takes several values in every frame. */
#ifndef BRUME_TABLES_VALUES_H
#define BRUME_TABLES_VALUES_H

#include "noise.h"

struct values_measures {
    double frame; /* a single frame */
    double ema;   /* an endless history, alpha = 0.1 */
    double gauss; /* that, and gauss1 */
};

/* Where the values of a pixel and frame come from. */
enum values_source {
    VALUES_SLICES, /* `values` slices after each other */
    VALUES_R2      /* one slice, at the points of Roberts' R2 sequence */
};

/* RMSE of the mean of `values` Heaviside samples, 32 thresholds, relative to
 * what is expected of uncorrelated uniform noise. False when there is no
 * memory. */
bool values_measure(struct values_measures *m, const struct noise_texture *t,
                    uint32_t values, enum values_source source);

#endif
