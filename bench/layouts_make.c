/* SPDX-License-Identifier: MIT */
/* The volume of layouts.h in each of its layouts. */
#include <stdlib.h>
#include <string.h>

#include "layouts.h"

/* Beyond the last element: rows are read beside and above it. */
#define SLACK 1024u

/* One cell, its brick and all that touches it from above: 9^3 voxels. */
struct block {
    uint8_t voxel[9][9][9];
    bool own; /* has a brick */
    bool any; /* is not zero */
};

static void fill_block(struct block *b, const struct brume_volume *v,
                       const uint32_t cell[3])
{
    uint32_t n[3], end[3];
    memset(b, 0, sizeof *b);
    for (int i = 0; i < 3; i++)
        end[i] = 8u * v->cell_count[i];
    b->own = !(cell_at(v, cell[0] << 19, cell[1] << 19, cell[2] << 19) &
               BRUME_CELL_EMPTY);
    for (n[2] = 0; n[2] < 9; n[2]++)
        for (n[1] = 0; n[1] < 9; n[1]++)
            for (n[0] = 0; n[0] < 9; n[0]++) {
                uint32_t x = 8 * cell[0] + n[0], y = 8 * cell[1] + n[1];
                uint32_t z = 8 * cell[2] + n[2];
                uint32_t d = x < end[0] && y < end[1] && z < end[2]
                                 ? layouts_voxel(v, x, y, z)
                                 : 0;
                b->voxel[n[2]][n[1]][n[0]] = (uint8_t)d;
                b->any = b->any || d != 0;
            }
}

/* The 2x2 codes from a voxel on, of one plane. */
static uint32_t quad_of(const struct block *b, uint32_t x, uint32_t y,
                        uint32_t z)
{
    return b->voxel[z][y][x] | (uint32_t)b->voxel[z][y][x + 1] << 8 |
           (uint32_t)b->voxel[z][y + 1][x] << 16 |
           (uint32_t)b->voxel[z][y + 1][x + 1] << 24;
}

static void put_block(const struct block *b, enum layout layout, uint8_t *to)
{
    uint32_t side = HAS_APRON(layout) ? 9 : 8;
    uint32_t high = layout == LAYOUT_QUADS ? 9 : side;
    for (uint32_t z = 0; z < high; z++)
        for (uint32_t y = 0; y < side; y++)
            for (uint32_t x = 0; x < side; x++) {
                size_t i = x + side * (y + side * z);
                uint32_t quad[2];
                if (ELEMENT_BYTES(layout) == 1) {
                    to[i] = b->voxel[z][y][x];
                    continue;
                }
                quad[0] = quad_of(b, x, y, z);
                quad[1] =
                    ELEMENT_BYTES(layout) == 8 ? quad_of(b, x, y, z + 1) : 0;
                memcpy(to + ELEMENT_BYTES(layout) * i, quad,
                       ELEMENT_BYTES(layout));
            }
}

/// Layouts ///

static const enum layout k_made[] = {LAYOUT_BRICKS,      LAYOUT_APRON,
                                     LAYOUT_QUADS,       LAYOUT_OCTETS,
                                     LAYOUT_APRON_PAGES, LAYOUT_QUAD_PAGES};
#define MADE (sizeof k_made / sizeof k_made[0])

struct maker {
    uint8_t *data[LAYOUTS];
    uint32_t *word[LAYOUTS];
    uint32_t bricks[LAYOUTS]; /* so far, that of zeros among them */
    size_t cells;
};

/* Is a block stored? Bricks as stored are those of the asset. */
static bool is_stored(const struct block *b, enum layout layout)
{
    return layout == LAYOUT_BRICKS ? b->own : b->any;
}

static size_t brick_bytes(enum layout layout)
{
    return (size_t)BRICK_ELEMENTS(layout) * ELEMENT_BYTES(layout);
}

/* Visits all cells: counts, and when there is memory fills it. */
static void visit(struct maker *m, const struct brume_volume *v, bool fill)
{
    uint32_t cell[3];
    size_t n = 0;
    for (size_t i = 0; i < MADE; i++)
        m->bricks[k_made[i]] = 1;
    for (cell[2] = 0; cell[2] < v->cell_count[2]; cell[2]++)
        for (cell[1] = 0; cell[1] < v->cell_count[1]; cell[1]++)
            for (cell[0] = 0; cell[0] < v->cell_count[0]; cell[0]++, n++) {
                struct block b;
                fill_block(&b, v, cell);
                for (size_t i = 0; i < MADE; i++) {
                    enum layout layout = k_made[i];
                    if (!is_stored(&b, layout))
                        continue;
                    uint32_t brick = m->bricks[layout]++;
                    if (!fill)
                        continue;
                    if (HAS_WORDS(layout))
                        m->word[layout][n] = brick;
                    else
                        brick = (uint32_t)n;
                    put_block(&b, layout,
                              m->data[layout] + brick * brick_bytes(layout));
                }
            }
}

bool layouts_make(struct layouts *l, size_t bytes[LAYOUTS])
{
    const struct brume_volume *v = l->frame->volume;
    struct maker m;
    bool good = true;
    memset(&m, 0, sizeof m);
    memset(bytes, 0, LAYOUTS * sizeof bytes[0]);
    m.cells = (size_t)v->cell_count[0] * v->cell_count[1] * v->cell_count[2];
    visit(&m, v, false);
    for (size_t i = 0; i < MADE; i++) {
        enum layout layout = k_made[i];
        bool pages = !HAS_WORDS(layout);
        size_t size =
            (pages ? m.cells : m.bricks[layout]) * brick_bytes(layout);
        m.data[layout] = calloc(size + SLACK, 1);
        m.word[layout] = calloc(m.cells, sizeof(uint32_t));
        l->data[layout] = m.data[layout];
        l->word[layout] = m.word[layout];
        good = good && m.data[layout] != NULL && m.word[layout] != NULL;
        bytes[layout] =
            m.bricks[layout] * brick_bytes(layout) + (pages ? 0 : 4 * m.cells);
    }
    bytes[LAYOUT_COPY] = bytes[LAYOUT_APRON_PAGES];
    bytes[LAYOUT_ASSET] = v->size;
    if (good)
        visit(&m, v, true);
    return good;
}

void layouts_free(struct layouts *l)
{
    for (int i = 0; i < LAYOUTS; i++) {
        free((void *)(uintptr_t)l->data[i]);
        free((void *)(uintptr_t)l->word[i]);
        l->data[i] = NULL;
        l->word[i] = NULL;
    }
}
