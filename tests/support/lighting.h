/* SPDX-License-Identifier: MIT */
/*
 * The lighting of test scenes. Needs the core alone, as scenes.h.
 */
#ifndef BRUME_TESTS_LIGHTING_H
#define BRUME_TESTS_LIGHTING_H

#include "brume.h"

/* What a scene adds to one white sun. All zero: lighting that says nothing. */
struct test_lighting {
    uint8_t phase; /* 0 isotropic, 1 hg 0.85, 2 droplets, 3 Schlick -0.5 */
    uint8_t octaves;
    uint8_t ambient, visibility;
    bool colour, sky, filmic;
    uint8_t blend; /* of the cache with itself, 1/256 */
    uint8_t lamps; /* so many; of each the reach is a tenth of the box */
    bool spots;    /* they are, and have shadows */
    uint8_t air;   /* bits: what there is besides the volume */
    bool emission; /* colours of the second grid; grey without `colour` */
};

enum test_air { AIR_FOG = 1, AIR_SHAPES = 2, AIR_SURFACE = 4, AIR_SUN_MAP = 8 };

/* Is there lighting at all in this build, and memory for it? */
#if BRUME_WITH_LIGHTING && \
    (!defined(TARGET_STATE_BYTES) || TARGET_STATE_BYTES > 0)
#define TEST_LIGHTING 1
#else
#define TEST_LIGHTING 0
#endif

/* Points a scene at that lighting, which lives on, number `slot` < 40 of its
 * kind: a slot always holds the same. Surfaces, of images up to 48x36, and the
 * lamps and their clusters are shared: one frame at a time. `volume` may have a
 * cache. */
void test_lighting_fill(struct brume_scene *out,
                        const struct test_lighting *light, unsigned slot,
                        const struct brume_volume *volume);

#endif
