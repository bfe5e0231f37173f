/* SPDX-License-Identifier: MIT */
/* sRGB (IEC 61966-2-1): 8-bit codes and linear values. */
#ifndef BRUME_HOST_SRGB_H
#define BRUME_HOST_SRGB_H

#include <stddef.h>
#include <stdint.h>

/* The linear value of a code, 0 to 255, or of what is between two. */
double srgb_linear(double code);

/* The codes whose values are nearest, as sRGB counts it, to `n` linear ones;
 * 0 and 255 stand for all below and above. */
void srgb_encode(const float *linear, uint8_t *out, size_t n);

#endif
