/* SPDX-License-Identifier: MIT */
/*
 * Assets made by tests, without OpenVDB and in integers only, so that their
 * bytes are the same everywhere. Written from docs/SPEC.md.
 */
#ifndef BRUME_TESTS_ASSET_BUILDER_H
#define BRUME_TESTS_ASSET_BUILDER_H

#include "brume.h"

/* Density of a voxel in 0 .. 65280, where 65280 stands for density_max. */
typedef uint32_t density_fn(int x, int y, int z, const void *context);

struct asset_spec {
    int cells[3];
    int format; /* enum brume_format */
    bool apron;
    uint32_t max_m; /* density_max = max_m * 2^max_e, max_m >= 2^31 */
    int32_t max_e;
    density_fn *density;
    const void *context;
};

/* An asset with density_max 1.0. u8 rounds densities to multiples of 256; u8r
 * and u4r give each brick the tightest range. The world is the pool. */
struct asset_spec asset_spec_of(int cells_x, int cells_y, int cells_z,
                                int format, density_fn *density,
                                const void *context);

/* A new blob, to be freed, and its size. Aborts when memory is short. */
uint8_t *asset_build(const struct asset_spec *spec, size_t *size);

/* Rewrites the checksum after a test has changed bytes. */
void asset_seal(uint8_t *asset, size_t size);

/* Little-endian words of a blob. */
uint32_t asset_get32(const uint8_t *p);
void asset_put32(uint8_t *p, uint32_t value);
void asset_put16(uint8_t *p, uint32_t value);

/* Offset of a section, 0 when there is none. */
uint32_t asset_section(const uint8_t *asset, uint32_t id);

/// Densities ///

/* The same density in a box of voxels, low <= p < high, and 0 outside. */
density_fn density_in_box;
struct density_box {
    int low[3], high[3];
    uint32_t density;
};

/* A lumpy ball with thin veils and holes: a few octaves of value noise in
 * integers. *context: struct density_cloud. */
struct density_cloud {
    int size; /* of the pool, voxels per axis */
    uint32_t seed;
};
density_fn density_in_cloud;

#endif
