/* SPDX-License-Identifier: MIT */
/* Void-and-cluster on a torus of frames. */
#ifndef BRUME_TABLES_CLUSTER_H
#define BRUME_TABLES_CLUSTER_H

#include "kernel.h"

/* Called now and then with the part that is done, of `all`. May be NULL. */
typedef void cluster_progress(uint64_t done, uint64_t all);

/* Ranks 0 .. width height - 1, each once in every frame, so that the pixels
 * of rank below n are as far from each other as the kernel wants, for any n.
 * False when there is no memory. */
bool cluster_rank(uint32_t *rank, const struct kernel *kernel, uint32_t width,
                  uint32_t height, uint32_t frames, uint32_t seed,
                  cluster_progress *progress);

/* Values from ranks: floor((rank + 1/2) 256 / area). All 256 alike often when
 * there are as many pixels; else different values, evenly spread. */
void cluster_values(uint8_t *values, const uint32_t *rank, uint32_t area,
                    uint32_t frames);

#endif
