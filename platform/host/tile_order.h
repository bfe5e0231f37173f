/* SPDX-License-Identifier: MIT */
/*
 * The order in which tiles of a picture are taken: along Hilbert's curve, so
 * that tiles which follow each other look up the same bricks. Measured against
 * rows and Morton's order in docs/BENCH.md.
 */
#ifndef BRUME_HOST_TILE_ORDER_H
#define BRUME_HOST_TILE_ORDER_H

#include <stdint.h>

/* Place on Hilbert's curve through a square of 2^15 a side; x, y < 2^15. */
uint32_t tile_order_hilbert(uint32_t x, uint32_t y);

/* A tile and its place in some order. */
struct tile_place {
    uint32_t key;
    uint16_t x, y;
};

/* Sorts `n` tiles by key. */
void tile_order_sort(struct tile_place *tiles, unsigned n);

/* All across * down tiles along the curve, from malloc; NULL without memory. */
struct tile_place *tile_order_new(unsigned across, unsigned down);

#endif
