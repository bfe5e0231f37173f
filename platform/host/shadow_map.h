/* SPDX-License-Identifier: MIT */
/*
 * The core's shadow map on a host: a level map placed in the world, and its
 * texels on all processors.
 *
 * Errors: as in image.h.
 */
#ifndef BRUME_HOST_SHADOW_MAP_H
#define BRUME_HOST_SHADOW_MAP_H

#include "volume_file.h"

/* Where a map lies, in world units. What was not said is filled in. */
struct shadow_place {
    bool has_plane, has_area, has_size;
    double plane;     /* y; else below the volume by its height */
    double area[4];   /* x0 z0 x1 z1; else what the shadow may cover */
    unsigned size[2]; /* texels; else one to a voxel, at most 1024 a side */
    const uint16_t *heights; /* size[0] x size[1] of them, or NULL */
    double rise;             /* up to a height of 65535 */
};

/* Fills *place and *map: row 0 is at z0, column 0 at x0, the step is that of
 * the scene. */
int shadow_map_place(struct shadow_place *place, struct brume_shadow_map *map,
                     const struct volume_file *file,
                     const struct brume_scene *scene, char *err,
                     size_t err_size);

/* All texels, rows together; `depth` or NULL. `progress`: a bar on stderr. */
int shadow_map_render(const struct brume_shadow_map *map,
                      const struct brume_volume *volume,
                      const struct brume_scene *scene, int threads,
                      bool progress, uint8_t *transmittance,
                      struct brume_shadow_depth *depth, char *err,
                      size_t err_size);

#endif
