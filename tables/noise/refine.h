/* SPDX-License-Identifier: MIT */
/* Swaps that lower the energy of a texture. */
#ifndef BRUME_TABLES_REFINE_H
#define BRUME_TABLES_REFINE_H

#include "cluster.h"
#include "noise.h"

/* Tries `tries` swaps per pixel with random pixels of the same frame, and
 * keeps those that lower the energy. Frames keep their histograms. */
void refine_swap(struct noise_texture *t, const struct kernel *kernel,
                 uint32_t tries, uint32_t seed, cluster_progress *progress);

/* Values of the same order in every frame, but evenly spread: of two pixels
 * with the same value, a hash decides. False when there is no memory. */
bool refine_spread(struct noise_texture *t, uint32_t seed);

#endif
