/* SPDX-License-Identifier: MIT */
/*
 * The memory behind a scene's lighting: struct brume_lighting, and what it
 * points to. A scene made by scene_apply points into it, so it must stay where
 * it is, and as it is, until the last frame of that scene is drawn. No copies.
 *
 * Errors: as in scene_file.h.
 */
#ifndef BRUME_HOST_SCENE_LIGHT_H
#define BRUME_HOST_SCENE_LIGHT_H

#include "scene_file.h"

#define SCENE_LIGHT_FIRST SCENE_PHASE
#define SCENE_LIGHT_KEYS (SCENE_KEYS - SCENE_LIGHT_FIRST)

struct scene_light {
    struct brume_lighting lighting;
    struct brume_phase phase[BRUME_MAX_OCTAVES];
    struct brume_cache cache; /* of light = cache: see sun_cache.h */
    struct brume_lamp lamps[BRUME_MAX_LAMPS];
    struct brume_clusters clusters; /* of the frame being drawn */
    struct brume_fog fog;
    struct brume_fog_shape fog_shapes[BRUME_MAX_FOG_SHAPES];
    struct brume_surface surface;
    struct brume_sun_map sun_map;
    const struct scene_file_data *file[SCENE_FILE_KEYS]; /* or NULL */
    uint32_t emission[256][3];
    const struct emission_file *emission_file; /* or NULL */
    /* of the keys from SCENE_LIGHT_FIRST on, said or by default */
    double value[SCENE_LIGHT_KEYS][SCENE_VALUES];
};

/* scene_apply's part: sets scene->lighting, to NULL when the keys of lighting
 * say what a scene without them is. The rest of the scene is known. */
int scene_light_apply(const struct scene_settings *settings,
                      const struct volume_file *file, struct brume_scene *scene,
                      struct scene_light *light, char *err, size_t err_size);

/* Does its picture have colour whatever the background? */
bool scene_light_has_colour(const struct scene_light *light);

void scene_light_print(FILE *to, const struct scene_light *light);

#endif
