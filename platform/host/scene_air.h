/* SPDX-License-Identifier: MIT */
/*
 * Keys of what is there besides the volume, fog, a surface, a sun map, to the
 * core's structs. Private to scene_light.c.
 *
 * Errors: as in scene_file.h.
 */
#ifndef BRUME_HOST_SCENE_AIR_H
#define BRUME_HOST_SCENE_AIR_H

#include "scene_light.h"

/* Do its keys say anything? */
bool scene_air_says_something(const struct scene_light *light);

/* Sets the lighting's fog, surface and sun map; its zenith and the scene's sun
 * and size are known. */
int scene_air_apply(const struct scene_settings *settings,
                    const struct volume_file *file,
                    const struct brume_scene *scene, struct scene_light *light,
                    char *err, size_t err_size);

#endif
