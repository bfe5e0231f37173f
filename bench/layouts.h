/* SPDX-License-Identifier: MIT */
/*
 * Trilinear lookups from the same voxels, of u8 without an apron, in several
 * layouts and by several multiplications, at the positions that a frame looks
 * up.
 *
 * A layout's bricks are numbered by a word for each cell, as the asset's are;
 * number 0 is a brick of zeros, for all cells without a voxel or a neighbour of
 * one. Pages have no such word: their elements lie where the cell is, and what
 * is empty is the system's page of zeros.
 */
#ifndef BRUME_BENCH_LAYOUTS_H
#define BRUME_BENCH_LAYOUTS_H

#include "brume_lookup.h"
#include "wide.h"

enum layout {
    LAYOUT_NONE,   /* positions and weights, and no lookup */
    LAYOUT_ASSET,  /* the kernel's own lookup, from the asset */
    LAYOUT_BRICKS, /* 8^3 as stored; what a neighbour has, voxel by voxel */
    LAYOUT_APRON,  /* 9^3 voxels */
    LAYOUT_QUADS,  /* of 2x2 voxels: 8x8x9 */
    LAYOUT_OCTETS, /* of 2x2x2 voxels: 8x8x8 */
    LAYOUT_APRON_PAGES, /* 9^3 voxels a cell, and no words of cells */
    LAYOUT_QUAD_PAGES,  /* 8^3 quads a cell, the same */
    LAYOUT_COPY         /* the kernel's own lookup, from its copy */
};
#define LAYOUTS 9

/* How eight codes are made one. */
enum products {
    PRODUCTS_NONE,  /* not at all, or as the kernel has it */
    PRODUCTS_32,    /* seven products of 32 bits */
    PRODUCTS_16,    /* of 8 and 16 bits in pairs, and one of 32 */
    PRODUCTS_OCTETS /* the same on eight bytes, two vectors for all lanes */
};

struct layout_kind {
    const char *name, *products_name;
    enum layout layout;
    enum products products;
};
#define LAYOUT_KINDS 15
extern const struct layout_kind layout_kinds[LAYOUT_KINDS];

/* Positions are looked up in batches of so many groups of lanes. */
#define LAYOUT_GROUPS 16u

struct layouts {
    const struct brume_frame *frame;
    const struct wide_copy *copy;
    const uint32_t *axis[3];       /* positions, Q16.16 */
    size_t count;                  /* of them, a multiple of 256 */
    const uint32_t *word[LAYOUTS]; /* brick number of each cell */
    const uint8_t *data[LAYOUTS];
};

#define HAS_APRON(l) ((l) == LAYOUT_APRON || (l) == LAYOUT_APRON_PAGES)
#define HAS_WORDS(l) ((l) != LAYOUT_APRON_PAGES && (l) != LAYOUT_QUAD_PAGES)

/* Elements of a brick and bytes of an element, of those with words. */
#define BRICK_ELEMENTS(l) \
    ((l) == LAYOUT_BRICKS  ? 512u \
     : HAS_APRON(l)        ? 729u \
     : (l) == LAYOUT_QUADS ? 576u \
                           : 512u)
#define ELEMENT_BYTES(l) \
    ((l) == LAYOUT_OCTETS                              ? 8u \
     : (l) == LAYOUT_QUADS || (l) == LAYOUT_QUAD_PAGES ? 4u \
                                                       : 1u)

/* The code of a voxel of the pool. */
static inline uint32_t layouts_voxel(const struct brume_volume *v, uint32_t x,
                                     uint32_t y, uint32_t z)
{
    uint32_t cell = cell_at(v, x << 16, y << 16, z << 16);
    if (cell & BRUME_CELL_EMPTY)
        return 0;
    return v->pool[cell * 512u + (x & 7u) + 8u * (y & 7u) + 64u * (z & 7u)];
}

/* Makes data and words of the frame's volume; false without memory. Then the
 * bytes that they take, words included. */
bool layouts_make(struct layouts *l, size_t bytes[LAYOUTS]);
void layouts_free(struct layouts *l);

/* All positions in a kind of layout; a hash of the densities, in their order,
 * which depends on the lanes: 8 and 16. */
typedef uint32_t layouts_run(const struct layouts *l, int kind);
layouts_run layouts_run_avx2, layouts_run_avx512;

#endif
