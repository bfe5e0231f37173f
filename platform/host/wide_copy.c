/* SPDX-License-Identifier: MIT */
/*
 * Copies of a volume for the wide march; wide.h says which, wide_copied.h
 * where a voxel is. Only what is not zero is written, so that pages of empty
 * space stay the system's one page of zeros: it is the processor that looks up
 * the cell.
 */
#include "wide.h"

#include <stdlib.h>
#include <string.h>

#include "brume_lookup.h"
#include "pool.h"

#define PAGE 4096u

/// Memory ///

/* Zero bytes on a page boundary, and an element of `end` bytes more; NULL when
 * it is too much, or elements cannot be counted in 32 bits. calloc takes them
 * from the system untouched. */
static void *reserve(struct wide_copy *c, int n, uint64_t bytes, size_t end)
{
    if (c->memory[n] != NULL || bytes + PAGE + end > c->most ||
        bytes / end > 0xfffffffeu)
        return NULL;
    size_t size = (size_t)bytes + PAGE + end;
    c->memory[n] = calloc(size, 1);
    if (c->memory[n] == NULL)
        return NULL;
    c->most -= size;
    uintptr_t at = (uintptr_t)c->memory[n];
    return (void *)((at + PAGE - 1u) & ~(uintptr_t)(PAGE - 1u));
}

void wide_copy_init(struct wide_copy *copy, const struct brume_volume *volume,
                    size_t most)
{
    memset(copy, 0, sizeof *copy);
    copy->volume = volume;
    copy->most = most;
}

void wide_copy_free(struct wide_copy *copy)
{
    for (int i = 0; i < WIDE_COPIES; i++)
        free(copy->memory[i]);
    wide_copy_init(copy, copy->volume, 0);
}

/// Bricks ///

/* The brick of a cell, or -1. */
static int64_t brick_of(const struct brume_volume *v, uint64_t cell)
{
    uint32_t word = le32(v->cells[cell]);
    return word & BRUME_CELL_EMPTY ? -1 : (int64_t)word;
}

static uint32_t code_of(const struct brume_volume *v, uint32_t brick,
                        uint32_t i)
{
    struct kernel k = KERNEL_OF(v->format, v->side - 8u, false, false, false);
    return code_at(v, brick, i, k);
}

/* What is done for each occupied cell: it may write what belongs to that cell
 * and to those below it by one. */
typedef void each_brick(struct wide_copy *c, const uint32_t cell[3],
                        uint32_t brick, void *to);

struct brick_job {
    struct wide_copy *copy;
    each_brick *act;
    void *to;
    uint32_t first; /* of the layers along z: every other one */
};

static void do_layer(void *arg, unsigned task, unsigned worker)
{
    const struct brick_job *job = arg;
    const struct brume_volume *v = job->copy->volume;
    uint32_t cell[3] = {0, 0, job->first + 2u * task};
    uint64_t n = (uint64_t)cell[2] * v->cell_count[1] * v->cell_count[0];
    (void)worker;
    for (; cell[1] < v->cell_count[1]; cell[1]++)
        for (cell[0] = 0; cell[0] < v->cell_count[0]; cell[0]++, n++)
            if (brick_of(v, n) >= 0)
                job->act(job->copy, cell, (uint32_t)brick_of(v, n), job->to);
}

/* Of layers that are worked on at a time, none touches another's. */
static void for_bricks(struct wide_copy *c, struct pool *pool, each_brick *act,
                       void *to)
{
    struct brick_job job = {c, act, to, 0};
    uint32_t layers = c->volume->cell_count[2];
    pool_run(pool, do_layer, &job, (layers + 1u) / 2u);
    job.first = 1;
    pool_run(pool, do_layer, &job, layers / 2u);
}

/* Number of a cell's first voxel in pages of 16^3; rows are 16 further, slices
 * 256. */
static size_t first_in_pages(const struct brume_volume *v,
                             const uint32_t cell[3])
{
    size_t row = (v->cell_count[0] + 1u) / 2u;
    size_t plane = row * ((v->cell_count[1] + 1u) / 2u);
    size_t page =
        (cell[2] >> 1) * plane + (cell[1] >> 1) * row + (cell[0] >> 1);
    return page << 12 | (cell[2] & 1u) << 11 | (cell[1] & 1u) << 7 |
           (cell[0] & 1u) << 3;
}

static uint64_t voxels_in_pages(const struct brume_volume *v)
{
    uint64_t n = 4096;
    for (int i = 0; i < 3; i++)
        n *= (v->cell_count[i] + 1u) / 2u;
    return n;
}

/// Bytes ///

static void copy_bytes(struct wide_copy *c, const uint32_t cell[3],
                       uint32_t brick, void *to)
{
    const struct brume_volume *v = c->volume;
    const uint8_t *from = v->pool + (size_t)brick * v->brick_bytes;
    uint8_t *page = (uint8_t *)to + first_in_pages(v, cell);
    uint32_t side = v->side;
    for (uint32_t z = 0; z < 8; z++)
        for (uint32_t y = 0; y < 8; y++)
            memcpy(page + (z << 8 | y << 4), from + (z * side + y) * side, 8);
}

static void make_bytes(struct wide_copy *c, struct pool *pool)
{
    uint64_t size = voxels_in_pages(c->volume);
    uint8_t *to = reserve(c, 0, size, 1);
    if (to == NULL)
        return;
    for_bricks(c, pool, copy_bytes, to);
    c->bytes = to;
    c->bytes_size = (size_t)size;
}

/// Halves ///

static void copy_halves(struct wide_copy *c, const uint32_t cell[3],
                        uint32_t brick, void *to)
{
    const struct brume_volume *v = c->volume;
    struct kernel k = KERNEL_OF(v->format, v->side - 8u, false, false, false);
    uint16_t *page = (uint16_t *)to + first_in_pages(v, cell);
    for (uint32_t i = 0; i < 512; i++) {
        uint32_t x = i & 7u, y = i >> 3 & 7u, z = i >> 6;
        uint32_t code = code_of(v, brick, x + v->side * (y + v->side * z));
        page[z << 8 | y << 4 | x] =
            (uint16_t)density_of_code(v, brick, code, 0, k);
    }
}

static void make_halves(struct wide_copy *c, struct pool *pool)
{
    uint64_t n = voxels_in_pages(c->volume);
    uint16_t *to = reserve(c, 1, 2 * n, 2);
    if (to == NULL)
        return;
    for_bricks(c, pool, copy_halves, to);
    c->halves = to;
    c->halves_size = (size_t)n;
}

/// Aprons ///

static uint64_t cells_of(const struct brume_volume *v)
{
    return (uint64_t)v->cell_count[0] * v->cell_count[1] * v->cell_count[2];
}

/* What a cell has of a brick: the lowest voxel's place in its apron, and how
 * many there are along each axis. */
struct part {
    size_t at;
    uint32_t size[3];
};

/* The voxels of a brick that the cell below it by the bits of `down` has too:
 * all that the brick's own has of it, `side`, or a face, an edge or a corner.
 * False when that cell is below the pool. */
static bool part_of(struct part *part, const struct brume_volume *v,
                    const uint32_t cell[3], uint32_t down, uint32_t side)
{
    size_t number = 0, place = 0;
    for (int i = 2; i >= 0; i--) {
        uint32_t below = down >> i & 1u;
        if (cell[i] < below)
            return false;
        number = number * v->cell_count[i] + (cell[i] - below);
        place = place * 9 + 8 * below;
        part->size[i] = below ? 1 : side;
    }
    part->at = number * WIDE_APRON + place;
    return true;
}

/* Codes of a brick to the first n of the cells that have some of it; zeros not
 * to others than its own. */
static void copy_parts(const struct brume_volume *v, const uint32_t cell[3],
                       const uint8_t *from, uint32_t side, uint32_t n,
                       uint8_t *aprons)
{
    struct part part;
    for (uint32_t down = 0; down < n; down++) {
        if (!part_of(&part, v, cell, down, side))
            continue;
        uint8_t *to = aprons + part.at;
        for (uint32_t z = 0; z < part.size[2]; z++)
            for (uint32_t y = 0; y < part.size[1]; y++)
                for (uint32_t x = 0; x < part.size[0]; x++) {
                    uint8_t code = from[x + side * (y + side * z)];
                    if (down == 0 || code != 0)
                        to[x + 9 * y + 81 * z] = code;
                }
    }
}

/* Where bricks have an apron it is taken as it is. Codes of u8 are the same in
 * all bricks; of others, a cell gets those of its own brick alone. */
static void copy_aprons(struct wide_copy *c, const uint32_t cell[3],
                        uint32_t brick, void *to)
{
    const struct brume_volume *v = c->volume;
    const uint8_t *from = v->pool + (size_t)brick * v->brick_bytes;
    bool alone = v->side == 9 || v->format != BRUME_U8;
    uint8_t codes[WIDE_APRON];
    for (uint32_t i = 0;
         v->format == BRUME_U4R && i < v->side * v->side * v->side; i++)
        codes[i] = (uint8_t)code_of(v, brick, i);
    copy_parts(v, cell, v->format == BRUME_U4R ? codes : from, v->side,
               alone ? 1 : 8, to);
}

static void copy_emission(struct wide_copy *c, const uint32_t cell[3],
                          uint32_t brick, void *to)
{
    copy_parts(c->volume, cell, c->volume->emission + (size_t)brick * 512, 8, 8,
               to);
}

/* Aprons as number n of the memories; NULL without room. */
static uint8_t *make_aprons(struct wide_copy *c, struct pool *pool, int n,
                            each_brick *act)
{
    uint64_t size = cells_of(c->volume) * WIDE_APRON;
    /* The zero one: as long as a lookup reaches. */
    uint8_t *to = reserve(c, n, size + WIDE_APRON, 1);
    if (to == NULL)
        return NULL;
    for_bricks(c, pool, act, to);
    c->aprons_size = (size_t)size;
    return to;
}

/// Half aprons ///

/* Densities of a brick's own voxels, whether it has an apron or not: those of
 * the apron may be of another range. */
static void copy_half_aprons(struct wide_copy *c, const uint32_t cell[3],
                             uint32_t brick, void *to)
{
    const struct brume_volume *v = c->volume;
    struct kernel k = KERNEL_OF(v->format, v->side - 8u, false, false, false);
    uint32_t densities[256]; /* by code */
    struct part part;
    for (uint32_t i = 0; i < 256; i++)
        densities[i] = density_of_code(v, brick, i, 0, k);
    for (uint32_t n = 0; n < 8; n++) {
        if (!part_of(&part, v, cell, n, 8))
            continue;
        uint16_t *at = (uint16_t *)to + part.at;
        for (uint32_t z = 0; z < part.size[2]; z++)
            for (uint32_t y = 0; y < part.size[1]; y++)
                for (uint32_t x = 0; x < part.size[0]; x++) {
                    uint32_t i = x + v->side * (y + v->side * z);
                    uint32_t d = densities[code_of(v, brick, i)];
                    if (d != 0)
                        at[x + 9 * y + 81 * z] = (uint16_t)d;
                }
    }
}

static void make_half_aprons(struct wide_copy *c, struct pool *pool)
{
    uint64_t n = cells_of(c->volume) * WIDE_APRON;
    uint16_t *to = reserve(c, 4, 2 * (n + WIDE_APRON), 2);
    if (to == NULL)
        return;
    for_bricks(c, pool, copy_half_aprons, to);
    c->half_aprons = to;
    c->half_aprons_size = (size_t)n;
}

/// Ranges ///

static void make_ranges(struct wide_copy *c)
{
    const struct brume_volume *v = c->volume;
    uint64_t n = cells_of(v);
    uint32_t *to = reserve(c, 3, 4 * n, 4);
    if (to == NULL)
        return;
    for (uint64_t i = 0; i < n; i++)
        if (brick_of(v, i) >= 0)
            to[i] = le32(v->ranges[brick_of(v, i)]);
    c->ranges = to;
}

void wide_copy_prepare(struct wide_copy *copy, const struct brume_frame *frame,
                       struct pool *pool)
{
    struct wide_copy *c = copy;
    const struct brume_volume *v = c->volume;
    bool u8 = v->format == BRUME_U8;
    bool trilinear = frame->kernel >> 2 & 1, clamp = frame->kernel & 1;
    if (!trilinear && u8 && c->bytes == NULL)
        make_bytes(c, pool);
    if (!trilinear && !u8 && c->halves == NULL)
        make_halves(c, pool);
    if (trilinear && (clamp || (!u8 && v->side == 8)) && c->half_aprons == NULL)
        make_half_aprons(c, pool);
    if (trilinear && !clamp && c->aprons == NULL)
        c->aprons = make_aprons(c, pool, 2, copy_aprons);
    if (trilinear && frame->lit.emits && c->emission == NULL)
        c->emission = make_aprons(c, pool, 5, copy_emission);
    if (trilinear && !clamp && !u8 && c->ranges == NULL)
        make_ranges(c);
}
