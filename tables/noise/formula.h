/* SPDX-License-Identifier: MIT */
/*
 * Noises that are formulas of pixel and frame, or a 2D table and a formula
 * over time. Integers only: the same bytes everywhere. Each fills a texture of
 * one channel; a value is the upper byte of what the core computes in 16 bits.
 * tables/ depends on nothing, so these are written a second time;
 * tests/test_noise_formula.c holds them against the core's.
 */
#ifndef BRUME_TABLES_FORMULA_H
#define BRUME_TABLES_FORMULA_H

#include <stdint.h>

#include "noise.h"

enum ign_offsets {
    IGN_JIMENEZ, /* x and y + 5.588238 per frame, for 64 frames: the core's */
    IGN_THESIS   /* x + 2.083, y + 4.867 per frame (Blomqvist 2025) */
};

/* The core's hash of x, y and frame. Seed 0 is the core's noise; another takes
 * frames 65536 * seed later. */
void noise_white(struct noise_texture *t, uint32_t seed);

/* A permutation of 0 .. 63 on 8x8 pixels, repeated; each frame has its own
 * (Fisher-Yates shuffle). */
void noise_white8(struct noise_texture *t, uint32_t seed);

/* Bayer's ordered matrix of side 4, 8 or 16; the same in every frame. */
void noise_bayer(struct noise_texture *t, uint32_t side);

/* Interleaved gradient noise. Not toroidal: a formula for any x and y, of
 * which this is a window at the origin. */
void noise_ign(struct noise_texture *t, enum ign_offsets offsets);

/* A rank-1 lattice in x, y and time, found by search for all filters of
 * measure.h at once. Not toroidal, as ign. */
void noise_rank1(struct noise_texture *t);

/* Frame 0 is there; fill the others. golden: frame f is frame 0 plus f times
 * the golden ratio's fraction, modulo 1. r2: frame 0 moved by point f of
 * Roberts' R2 sequence, toroidally. Both keep each frame's histogram (golden
 * only that of a frame with all 256 values alike). */
void noise_golden(struct noise_texture *t);
void noise_r2(struct noise_texture *t);

#endif
