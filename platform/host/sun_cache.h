/* SPDX-License-Identifier: MIT */
/*
 * The cache behind light = cache: the one that was baked into the volume when
 * it is for the scene's sun, else one that is computed before the frame and
 * kept for those after it that have the same sun.
 *
 * Errors: as in image.h.
 */
#ifndef BRUME_HOST_SUN_CACHE_H
#define BRUME_HOST_SUN_CACHE_H

#include "render.h"
#include "scene_light.h"

/* All zero: nothing yet. */
struct sun_cache {
    uint8_t *codes; /* computed ones, or NULL */
    struct brume_cache cache;
    struct brume_scene scene; /* that they were computed for */
};

/* Points light->lighting at a cache for the scene, when its light is one. The
 * scene is one that *light was filled for, of this volume, which is the
 * renderer's. */
int sun_cache_prepare(struct sun_cache *cache, struct renderer *renderer,
                      const struct brume_volume *volume,
                      const struct brume_scene *scene,
                      struct scene_light *light, char *err, size_t err_size);

/* Forgets what was computed, as for another volume; frees. */
void sun_cache_free(struct sun_cache *cache);

#endif
