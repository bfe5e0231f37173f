/* SPDX-License-Identifier: MIT */
/*
 * FAST noise of vectors (Donnelly et al. 2024): every slice holds the same
 * evenly spread set of points of a space; which pixel has which is optimised
 * by swaps within a slice. Integers only: the same bytes everywhere.
 *
 * The paper's loss for a vector space is that of a number, with the Euclidean
 * or the geodesic distance d(x, y) in the place of |x - y|. In both spaces
 * d(x, y) is proportional to the chance that a random half-space (a random
 * great circle) separates x and y (Crofton's formula): these are the
 * multidimensional Heaviside functions that the loss averages over.
 */
#ifndef BRUME_TABLES_SPACE_H
#define BRUME_TABLES_SPACE_H

#include <stdbool.h>
#include <stdint.h>

#include "noise.h"

enum noise_space {
    NOISE_SCALAR,     /* unit interval, 1 byte; for comparison */
    NOISE_VEC2,       /* unit square, 2 bytes, Euclidean distance */
    NOISE_VEC3,       /* unit cube, 3 bytes, Euclidean distance */
    NOISE_SPHERE,     /* uniform directions, octahedral 2 bytes, geodesic */
    NOISE_HEMISPHERE, /* uniform directions with z > 0, the same */
    NOISE_COSINE      /* directions with z > 0 and density z / pi, the same */
};

/* G(o), scaled so that G(0) is at most 2^16: weight[dt][dy + radius][dx +
 * radius], dt = 0 .. frames - 1 (wrapped to the texture's frames). */
struct noise_space_kernel {
    uint32_t radius, frames;
    const int32_t *weight;
};

/* Called now and then with the part that is done, of `all`. */
typedef void noise_progress(void *user, uint32_t done, uint32_t all);

/* Bytes per texel of a space. */
uint32_t noise_space_channels(enum noise_space space);

/* Fill a texture that has that many channels; the kernel is of its size.
 * `rounds`: how often every pixel looks for a better place; 0 is the default.
 * progress may be NULL. Takes 512 bytes a pixel and frame. False when there is
 * no memory. */
bool noise_space_fill(struct noise_texture *t, enum noise_space space,
                      const struct noise_space_kernel *kernel, uint32_t seed,
                      uint32_t rounds, noise_progress *progress, void *user);

/* sum_o G(o) (D - E_p[d(x_p, x_{p+o})]) / (G(0) D), D being the mean distance
 * of two points of slice 0: the expected squared error of filtered half-spaces
 * relative to uncorrelated points, as the loss of measure.h for numbers. For a
 * kernel that is the filters' autocorrelation, of a texture whose slices all
 * hold evenly spread points. False when there is no memory. */
bool noise_space_loss(const struct noise_texture *t, enum noise_space space,
                      const struct noise_space_kernel *kernel, double *loss);

/* The unit vector, Q1.15, of two octahedral bytes: byte b stands for
 * (2 b - 255) / 255. */
void noise_octahedral(const uint8_t bytes[2], int32_t vector[3]);

#endif
