/* SPDX-License-Identifier: MIT */
#include "tile_order.h"

#include <stdlib.h>

/* From the largest square to the smallest: which quarter, and how the curve
 * lies in it. */
uint32_t tile_order_hilbert(uint32_t x, uint32_t y)
{
    uint32_t key = 0;
    for (uint32_t side = 1u << 14; side > 0; side >>= 1) {
        uint32_t right = (x & side) != 0, down = (y & side) != 0;
        key += side * side * ((3 * right) ^ down);
        if (!down) {
            if (right) {
                x = ~x;
                y = ~y;
            }
            uint32_t swap = x;
            x = y;
            y = swap;
        }
    }
    return key;
}

static int by_key(const void *a, const void *b)
{
    const struct tile_place *p = a, *q = b;
    return (p->key > q->key) - (p->key < q->key);
}

void tile_order_sort(struct tile_place *tiles, unsigned n)
{
    qsort(tiles, n, sizeof *tiles, by_key);
}

struct tile_place *tile_order_new(unsigned across, unsigned down)
{
    struct tile_place *tiles = malloc(sizeof *tiles * across * down);
    unsigned n = 0;
    if (tiles == NULL)
        return NULL;
    for (unsigned y = 0; y < down; y++)
        for (unsigned x = 0; x < across; x++) {
            struct tile_place t = {tile_order_hilbert(x, y), (uint16_t)x,
                                   (uint16_t)y};
            tiles[n++] = t;
        }
    tile_order_sort(tiles, n);
    return tiles;
}
