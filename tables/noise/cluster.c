/* SPDX-License-Identifier: MIT */
/*
 * Void-and-cluster (Ulichney, "The void-and-cluster method for dither array
 * generation", 1993) with any kernel, on all frames together: in every round
 * each frame gets one more pixel, where the energy of all pixels so far is
 * lowest. So every frame's histogram is exact by construction.
 *
 * Ulichney starts from an arrangement of some pixels that swaps have evened
 * out, ranks those by removing the tightest cluster, and goes on by filling
 * the largest void. Here all is filling, from the empty texture on: measured
 * over all thresholds that is better than a start from 1/10 or 1/2 of the
 * pixels, and than filling from both ends.
 *
 * Filling only adds to energies. So the lowest energy of a row, once known,
 * stays a lower bound, and a frame's lowest energy is found by looking again
 * at those rows only whose bound is below it.
 */
#include "cluster.h"
#include "noise.h"

#include <stdlib.h>
#include <string.h>

/* Energies: tie-breaking noise (< 2^8) + sum of the kernel (< 2^29), and on
 * taken pixels this on top: below 2^31 together. */
#define TAKEN (1 << 30)
#define NOISE_BITS 8

struct field {
    const struct kernel *kernel;
    uint32_t width, height, frames;
    int32_t *energy; /* [frame][y][x] */
    int32_t *bound;  /* [frame][y]: no energy of the row is below */
};

/// Field ///

static size_t area_of(const struct field *f)
{
    return (size_t)f->width * f->height;
}

static bool field_make(struct field *f, const struct kernel *kernel,
                       uint32_t width, uint32_t height, uint32_t frames)
{
    *f = (struct field){kernel, width, height, frames, NULL, NULL};
    f->energy = malloc(area_of(f) * frames * sizeof *f->energy);
    f->bound = malloc((size_t)height * frames * sizeof *f->bound);
    return f->energy && f->bound;
}

static void field_free(struct field *f)
{
    free(f->energy);
    free(f->bound);
}

static void add_row(int32_t *restrict row, uint32_t width, uint32_t x,
                    const int32_t *restrict weight, uint32_t count)
{
    uint32_t first = width - x < count ? width - x : count;

    for (uint32_t i = 0; i < first; i++)
        row[x + i] += weight[i];
    for (uint32_t i = first; i < count; i++)
        row[i - first] += weight[i];
}

static void add_box(int32_t *frame, const struct field *f, uint32_t x,
                    uint32_t y, const int32_t *weight)
{
    const struct kernel *k = f->kernel;
    uint32_t left = (x + (uint32_t)k->left) & (f->width - 1);

    for (uint32_t j = 0; j < k->rows; j++) {
        uint32_t row = (y + (uint32_t)k->top + j) & (f->height - 1);
        add_row(frame + (size_t)row * f->width, f->width, left,
                weight + (size_t)j * k->cols, k->cols);
    }
}

/* Takes a pixel: its kernel is added to every energy around it. */
static void take(struct field *f, uint32_t z, uint32_t pixel)
{
    const struct kernel *k = f->kernel;
    uint32_t x = pixel & (f->width - 1), y = pixel / f->width;
    size_t size = (size_t)k->rows * k->cols;
    size_t centre = (size_t)(-k->top * (int32_t)k->cols - k->left);

    for (uint32_t i = 0; i < f->frames; i++) {
        uint32_t dz = i / k->values;
        uint32_t slice = kernel_slice(k, z, dz, i % k->values);
        int32_t *frame = f->energy + slice * area_of(f);
        const int32_t *weight = k->weight + dz * size;
        if (k->extent[dz] == EXTENT_BOX)
            add_box(frame, f, x, y, weight);
        else if (k->extent[dz] == EXTENT_CENTRE)
            frame[pixel] += weight[centre];
    }
    f->energy[z * area_of(f) + pixel] += TAKEN;
}

static int32_t lowest(const int32_t *values, uint32_t count)
{
    int32_t low = values[0];

    for (uint32_t i = 1; i < count; i++)
        low = values[i] < low ? values[i] : low;
    return low;
}

static uint32_t first_of(const int32_t *values, int32_t value)
{
    uint32_t i = 0;

    while (values[i] != value)
        i++;
    return i;
}

/* The pixel of lowest energy in a frame, the first of equals. */
static uint32_t largest_void(struct field *f, uint32_t z)
{
    int32_t *bound = f->bound + (size_t)z * f->height;
    const int32_t *frame = f->energy + z * area_of(f);

    for (;;) {
        int32_t low = lowest(bound, f->height);
        uint32_t y = first_of(bound, low);
        const int32_t *row = frame + (size_t)y * f->width;
        bound[y] = lowest(row, f->width);
        if (bound[y] == low)
            return y * f->width + first_of(row, low);
    }
}

static void field_clear(struct field *f, uint32_t seed)
{
    size_t count = area_of(f) * f->frames;

    for (size_t i = 0; i < count; i++)
        f->energy[i] = (int32_t)(noise_hash((uint32_t)i ^ noise_hash(seed)) >>
                                 (32 - NOISE_BITS));
    memset(f->bound, 0, (size_t)f->height * f->frames * sizeof *f->bound);
}

/// Ranking ///

struct ranking {
    struct field field;
    uint32_t *rank; /* [frame][y][x] */
    uint64_t done, all;
    cluster_progress *progress;
};

/* One pixel more in every frame. */
static void round_of(struct ranking *r, uint32_t rank)
{
    struct field *f = &r->field;

    for (uint32_t z = 0; z < f->frames; z++) {
        uint32_t pixel = largest_void(f, z);
        take(f, z, pixel);
        r->rank[z * area_of(f) + pixel] = rank;
    }
    r->done += f->frames;
    if (r->progress && !(rank & 15u))
        r->progress(r->done, r->all);
}

bool cluster_rank(uint32_t *rank, const struct kernel *kernel, uint32_t width,
                  uint32_t height, uint32_t frames, uint32_t seed,
                  cluster_progress *progress)
{
    struct ranking r = {.rank = rank, .progress = progress};
    bool good = field_make(&r.field, kernel, width, height, frames);
    uint32_t area = width * height;

    if (good) {
        r.all = (uint64_t)area * frames;
        field_clear(&r.field, seed);
        for (uint32_t n = 0; n < area; n++)
            round_of(&r, n);
        if (progress)
            progress(r.all, r.all);
    }
    field_free(&r.field);
    return good;
}

void cluster_values(uint8_t *values, const uint32_t *rank, uint32_t area,
                    uint32_t frames)
{
    for (size_t i = 0; i < (size_t)area * frames; i++)
        values[i] = (uint8_t)((2u * rank[i] + 1u) * 128u / area);
}
