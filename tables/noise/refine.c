/* SPDX-License-Identifier: MIT */
/*
 * The optimiser of Donnelly et al. 2024: swaps of two pixels of a frame. The
 * energy is -sum_pq F(p - q) |v_p - v_q|. Let v_p = a < b = v_q. As
 *
 *     |b - s| - |a - s| = a + b - 2 clamp(s, a, b),
 *
 * the swap changes the energy by 2 (C_p - C_q + (F(0) - F(p - q)) (b - a)),
 * where C_p = sum_r F(p - r) clamp(v_r, a, b): the sums include p and q, whose
 * own terms the last part takes back.
 */
#include "refine.h"

#include <stdlib.h>

struct swap {
    const struct noise_texture *t;
    const struct kernel *kernel;
    uint8_t a, b;
};

static int64_t clamped(const struct swap *s, uint8_t value, int32_t weight)
{
    uint8_t v = value < s->a ? s->a : value;

    return (int64_t)weight * (v > s->b ? s->b : v);
}

/* Sums below 2^29 * 2^8. */
static int64_t row_sum(const struct swap *s, const uint8_t *row, uint32_t x,
                       const int32_t *weight)
{
    uint32_t width = s->t->width, count = s->kernel->cols;
    uint32_t first = width - x < count ? width - x : count;
    int64_t sum = 0;

    for (uint32_t i = 0; i < first; i++)
        sum += clamped(s, row[x + i], weight[i]);
    for (uint32_t i = first; i < count; i++)
        sum += clamped(s, row[i - first], weight[i]);
    return sum;
}

static int64_t box_sum(const struct swap *s, const uint8_t *frame, uint32_t x,
                       uint32_t y, const int32_t *weight)
{
    const struct kernel *k = s->kernel;
    const struct noise_texture *t = s->t;
    uint32_t left = (x + (uint32_t)k->left) & (t->width - 1);
    int64_t sum = 0;

    for (uint32_t j = 0; j < k->rows; j++) {
        uint32_t row = (y + (uint32_t)k->top + j) & (t->height - 1);
        sum += row_sum(s, frame + row * t->width, left,
                       weight + (size_t)j * k->cols);
    }
    return sum;
}

/* C of a pixel of frame z. */
static int64_t clamp_sum(const struct swap *s, uint32_t z, uint32_t pixel)
{
    const struct kernel *k = s->kernel;
    const struct noise_texture *t = s->t;
    size_t size = (size_t)k->rows * k->cols;
    size_t centre = (size_t)(-k->top * (int32_t)k->cols - k->left);
    size_t area = (size_t)t->width * t->height;
    int64_t sum = 0;

    for (uint32_t i = 0; i < t->frames; i++) {
        uint32_t dz = i / k->values;
        uint32_t slice = kernel_slice(k, z, dz, i % k->values);
        const uint8_t *frame = t->values + slice * area;
        const int32_t *weight = k->weight + dz * size;
        if (k->extent[dz] == EXTENT_BOX)
            sum += box_sum(s, frame, pixel & (t->width - 1), pixel / t->width,
                           weight);
        else if (k->extent[dz] == EXTENT_CENTRE)
            sum += clamped(s, frame[pixel], weight[centre]);
    }
    return sum;
}

/* F between two pixels of a frame. */
static int32_t between(const struct swap *s, uint32_t p, uint32_t q)
{
    const struct kernel *k = s->kernel;
    uint32_t width = s->t->width, height = s->t->height;
    uint32_t x = (q - p - (uint32_t)k->left) & (width - 1);
    uint32_t y = (q / width - p / width - (uint32_t)k->top) & (height - 1);

    return x < k->cols && y < k->rows ? k->weight[y * k->cols + x] : 0;
}

static bool improves(struct swap *s, uint32_t z, uint32_t p, uint32_t q)
{
    const uint8_t *frame =
        s->t->values + (size_t)z * s->t->width * s->t->height;

    if (frame[p] == frame[q])
        return false;
    if (frame[p] > frame[q]) {
        uint32_t swap = p;
        p = q;
        q = swap;
    }
    s->a = frame[p];
    s->b = frame[q];
    int64_t own = between(s, p, p) - between(s, p, q);
    return clamp_sum(s, z, p) - clamp_sum(s, z, q) + own * (s->b - s->a) < 0;
}

void refine_swap(struct noise_texture *t, const struct kernel *kernel,
                 uint32_t tries, uint32_t seed, cluster_progress *progress)
{
    struct swap s = {t, kernel, 0, 0};
    uint32_t area = t->width * t->height, state = noise_hash(seed);
    uint64_t all = (uint64_t)area * t->frames * tries;

    for (uint64_t i = 0; i < all; i++) {
        uint32_t z = (uint32_t)(i % t->frames);
        uint8_t *frame = t->values + (size_t)z * area;
        uint32_t p = (uint32_t)(i / t->frames) & (area - 1);
        uint32_t q = (state = noise_hash(state + 0x9e3779b9u)) & (area - 1);
        if (improves(&s, z, p, q)) {
            uint8_t value = frame[p];
            frame[p] = frame[q];
            frame[q] = value;
        }
        if (progress && !(i & 0x3fffu))
            progress(i, all);
    }
    if (progress)
        progress(all, all);
}

/// Exact histograms ///

static int ascending(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;

    return (x > y) - (x < y);
}

bool refine_spread(struct noise_texture *t, uint32_t seed)
{
    uint32_t area = t->width * t->height;
    uint64_t *key = malloc(area * sizeof *key);

    if (!key)
        return false;
    for (uint32_t z = 0; z < t->frames; z++) {
        uint8_t *frame = t->values + (size_t)z * area;
        for (uint32_t i = 0; i < area; i++)
            key[i] = (uint64_t)frame[i] << 48 |
                     (uint64_t)(noise_hash(i + area * z + seed) >> 16) << 32 |
                     i;
        qsort(key, area, sizeof *key, ascending);
        for (uint32_t n = 0; n < area; n++)
            frame[key[n] & 0xffffffffu] =
                (uint8_t)((2u * n + 1u) * 128u / area);
    }
    free(key);
    return true;
}
