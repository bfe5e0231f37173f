/* SPDX-License-Identifier: MIT */
/*
 * Kernels of post-processing filters, as integers: what an error here counts
 * against an error there. Computed without floating point, so that they (and
 * every texture made from them) are the same on every machine.
 */
#ifndef BRUME_TABLES_KERNEL_H
#define BRUME_TABLES_KERNEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define KERNEL_MAX_RADIUS 64       /* of a filter, in pixels or frames */
#define KERNEL_MICRO 1000000       /* parameters are in millionths */
#define KERNEL_ENDLESS 0xffffffffu /* as beta: a history without a start */

enum filter_kind {
    FILTER_NONE,
    FILTER_BOX,      /* size: odd side */
    FILTER_BINOMIAL, /* size: odd side */
    FILTER_GAUSS,    /* a: sigma */
    FILTER_EMA       /* a: alpha, b: beta; time only */
};

struct filter {
    enum filter_kind kind;
    uint32_t size;
    uint32_t a, b; /* millionths */
};

enum combine { COMBINE_PRODUCT, COMBINE_SEPARATE, COMBINE_HYBRID };

struct kernel_spec {
    struct filter space, time;
    enum combine combine;
    uint32_t space_weight, time_weight; /* of the parts in space only and in
                                           time only, in millionths */
    uint32_t values; /* per pixel and frame, a power of two; 0 is 1 */
    bool plain;      /* the filters are the kernel: not convolved with
                        themselves (classic void-and-cluster) */
};

/* Parse `gauss1`, `box3`, `gauss:1.9`, `ema:0.1,0.1`, `hybrid:1`, ... On
 * failure the result is false and nothing is changed. */
bool kernel_parse_space(const char *text, struct filter *filter);
bool kernel_parse_time(const char *text, struct filter *filter);
bool kernel_parse_combine(const char *text, struct kernel_spec *spec);

/* What of a frame, dz frames away, is not 0. */
enum kernel_extent { EXTENT_NONE, EXTENT_CENTRE, EXTENT_BOX };

/* A kernel on the torus: entry (dz, j, i) is the weight between a pixel and
 * the one that is (left + i, top + j, dz) away, dz = 0 .. frames - 1. Folded:
 * cols <= width, rows <= height. All entries >= 0, their sum over all slices
 * < 2^29. The `values` slices of a frame count alike. */
struct kernel {
    uint32_t cols, rows, frames;
    uint32_t values; /* slices per frame: values that a pixel averages */
    int32_t left, top;
    uint8_t *extent; /* [frames], enum kernel_extent */
    int32_t *weight; /* [frames][rows][cols] */
};

/* Of the torus of a texture; frames = slices / values. False when there is no
 * memory. */
bool kernel_make(struct kernel *kernel, const struct kernel_spec *spec,
                 uint32_t width, uint32_t height, uint32_t slices);
void kernel_free(struct kernel *kernel);

/* The slice of value `value` in the frame dz after slice z's. */
static inline uint32_t kernel_slice(const struct kernel *k, uint32_t z,
                                    uint32_t dz, uint32_t value)
{
    return ((z / k->values + dz) & (k->frames - 1)) * k->values + value;
}

/* exp(-x), x in Q31 (any size); Q31, error below 2^-27. */
uint32_t kernel_exp(uint64_t x);

#endif
