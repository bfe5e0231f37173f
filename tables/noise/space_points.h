/* SPDX-License-Identifier: MIT */
/* Points of the spaces of vector noise, in integers; private to space*.c. */
#ifndef BRUME_TABLES_SPACE_POINTS_H
#define BRUME_TABLES_SPACE_POINTS_H

#include "space.h"

/* Directions are vectors of this length in int16_t coordinates: squared
 * distances of all spaces stay below SPACE_SQUARES. */
#define SPACE_RADIUS 181
#define SPACE_SQUARES (3 * 255 * 255 + 1)

bool space_is_sphere(enum noise_space space);

/* Point i of 2^bits, as a texel's bytes. */
void space_point(enum noise_space space, uint32_t i, uint32_t bits,
                 uint8_t bytes[3]);

/* A texel as a vector: bytes, or a direction of length SPACE_RADIUS. Unused
 * coordinates are 0. */
void space_vector(enum noise_space space, const uint8_t *bytes,
                  int16_t vector[3]);

/* Distance of two vectors by the square of their Euclidean distance: that
 * distance, in 1/64, or the angle in 1/32768 of 180 degrees. */
void space_distances(enum noise_space space, uint16_t distance[SPACE_SQUARES]);

/* A half-space n x > c. */
struct half_space {
    int32_t normal[3]; /* Q1.14, any length near 1 */
    int32_t offset;    /* Q14 */
};

/* Half-space i of 2^bits with the measure of Crofton's formula, from a net
 * shifted by three random words. */
void space_half_space(enum noise_space space, uint32_t i, uint32_t bits,
                      const uint32_t shift[3], struct half_space *h);

#endif
