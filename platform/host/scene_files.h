/* SPDX-License-Identifier: MIT */
/*
 * What a scene reads from files of its own: shapes of fog, a surface, a sun
 * map. Read once, when the key is set, so that what is wrong has the key's
 * line; and kept for the life of the program, as scenes point to it.
 *
 * Shapes are lines, in world space and in extinction per voxel:
 *
 *     sphere X,Y,Z RADIUS DENSITY [SOFTNESS]
 *     box X,Y,Z HALF_X,HALF_Y,HALF_Z DENSITY [SOFTNESS]
 *
 * The sides of boxes are along the volume's axes. A surface is a grey picture
 * of 16 bits, of the scene's size: codes of depth. A sun map: sun_map_file.h.
 *
 * Errors: as in scene_file.h.
 */
#ifndef BRUME_HOST_SCENE_FILES_H
#define BRUME_HOST_SCENE_FILES_H

#include "list_file.h"
#include "scene_keys.h"
#include "sun_map_file.h"

struct scene_file_data {
    struct scene_file_data *next;
    int key; /* SCENE_FOG_SHAPES .. SCENE_SUN_MAP */
    char path[SCENE_LINE_SIZE];
    struct list shapes;
    struct grey16 surface;
    struct sun_map_file sun_map;
};

/* The file of a key, or NULL for the word `none`. */
int scene_file_load(int key, const char *text,
                    const struct scene_file_data **out, const char *where,
                    char *err, size_t err_size);

/* Shapes for a volume's pool, up to BRUME_MAX_FOG_SHAPES of them. */
int scene_file_shapes(const struct scene_file_data *data,
                      const struct volume_file *file,
                      struct brume_fog_shape *out, char *err, size_t err_size);

#endif
