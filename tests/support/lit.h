/* SPDX-License-Identifier: MIT */
/*
 * Lit frames for tests: volumes made here, with means and depths; a scene of
 * each; and the rays of a frame. Aborts with a line of text when the core
 * refuses: tests of errors call the core themselves.
 */
#ifndef BRUME_TESTS_LIT_H
#define BRUME_TESTS_LIT_H

#include "asset_light.h"

/* A volume, and the blob it lies in, to be freed. */
struct lit_volume {
    char name[16];
    uint8_t *asset;
    struct brume_volume volume;
};

/* Opens a blob of asset_build after adding to it what `light` says (or NULL:
 * nothing). */
struct lit_volume lit_volume_of(const struct asset_spec *spec,
                                const struct asset_light *light);

/* The lumpy cloud in 5^3 cells: number 0 .. 5 is u8, u8r, u4r without and with
 * an apron. It has means, depths towards +y and what is seen of the sky. */
#define LIT_CLOUDS 6
struct lit_volume lit_cloud(int number);

/* Voxels low <= p < high of density `d` (65280: 1.0) in a pool of cells, u8,
 * with means. */
struct lit_volume lit_block(const int cells[3], const int low[3],
                            const int high[3], uint32_t d);

/* Full voxels up to the faces of one cell, in the middle of empty ones: what is
 * leapt over is next to it. It has all that clouds have. */
struct lit_volume lit_middle_cell(void);

void lit_volume_free(struct lit_volume *volume);

/* A scene of w x h rays on it: nearest, log, albedo 1, no end of rays before
 * the pool's, and their depth is known. `lighting` may be NULL. */
struct brume_scene lit_scene(const struct lit_volume *volume, int w, int h,
                             const struct brume_lighting *lighting);

/* The same with one sample a ray, at 256 voxels from the eye, which is what
 * lights it: density above 0 is opaque. And where that sample is. */
struct brume_scene lit_one_sample(const struct lit_volume *volume, int w, int h,
                                  const struct brume_lighting *lighting);
void lit_sample_position(const struct brume_scene *scene, int x, int y,
                         double out[3]);

/* Lighting that says nothing: a white sun of brightness 1. */
struct brume_lighting lit_white(void);

/* Makes the frame, and marches all its rays into w * h of `out`. */
void lit_march(struct brume_frame *frame, const struct lit_volume *volume,
               const struct brume_scene *scene, struct brume_radiance *out);

/* A cache and its codes, to be freed. */
struct lit_cache {
    struct brume_cache cache;
    uint8_t *codes;
    size_t size;
};

/* With codes of any value; and with all codes made by the scene's light. */
struct lit_cache lit_cache_room(const struct lit_volume *volume,
                                unsigned spacing_log2);
struct lit_cache lit_cache_made(struct brume_frame *frame,
                                const struct lit_volume *volume,
                                const struct brume_scene *scene,
                                unsigned spacing_log2);

/* How many of n rays differ in anything. */
int lit_differing(const struct brume_radiance *a,
                  const struct brume_radiance *b, int n);

/* Unit vector of the ray through the middle of a pixel, in double. The scene's
 * `up` is +y. */
void lit_ray(const struct brume_scene *scene, int x, int y, double out[3]);

/* 0 .. 2^24 - 1, and whole numbers from low to high. */
uint32_t lit_random(uint32_t *seed);
int lit_between(uint32_t *seed, int low, int high);

#endif
