/* SPDX-License-Identifier: MIT */
/*
 * The committed noise tables. Each is a source file of its own, which line 1
 * says how to make again; link those that you use. docs/noise.md compares
 * them.
 */
#ifndef BRUME_NOISE_TABLES_H
#define BRUME_NOISE_TABLES_H

#include "brume.h"

#ifdef __cplusplus
extern "C" {
#endif

/* For an unknown or any filter over time and space: the one to start with. */
extern const struct brume_noise_table brume_noise_fast;       /* 64x64x32 */
extern const struct brume_noise_table brume_noise_fast_small; /* 32x32x16 */
extern const struct brume_noise_table brume_noise_fast_tiny;  /* 4 bits */

/* Spatio-temporal blue noise. */
extern const struct brume_noise_table brume_noise_stbn;       /* 64x64x16 */
extern const struct brume_noise_table brume_noise_stbn_small; /* 32x32x16 */
extern const struct brume_noise_table brume_noise_stbn_tiny;  /* 4 bits */

/* Blue noise of one slice, for BRUME_NOISE_TABLE_GOLDEN and _R2 too; and of
 * independent slices. */
extern const struct brume_noise_table brume_noise_blue;        /* 64x64x1 */
extern const struct brume_noise_table brume_noise_blue_slices; /* 64x64x16 */

/* Random orders of 64 values, each frame its own. */
extern const struct brume_noise_table brume_noise_white8; /* 8x8x16 */

/* Bayer's matrix 8x8, for BRUME_NOISE_TABLE_GOLDEN; without a change over time
 * BRUME_NOISE_BAYER8 needs no table. */
extern const struct brume_noise_table brume_noise_bayer8;

/* Directions of the upper hemisphere, for BRUME_SKY_SAMPLED; 32x32x16, 48 KiB.
 */
extern const struct brume_direction_table brume_noise_hemisphere;

/* N-rooks sets of 1 .. 16 points in their order of use: 16 row + column. */
extern const uint8_t brume_nrooks[16][16];

#ifdef __cplusplus
}
#endif

#endif
