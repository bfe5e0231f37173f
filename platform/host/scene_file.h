/* SPDX-License-Identifier: MIT */
/*
 * Scenes as text: `key = value` lines, `#` comments; and --set key=value.
 *
 * Errors: as in image.h; messages start with file:line or `--set`.
 */
#ifndef BRUME_HOST_SCENE_FILE_H
#define BRUME_HOST_SCENE_FILE_H

#include <stdio.h>

#include "volume_file.h"

struct scene_light;     /* scene_light.h */
struct scene_file_data; /* scene_files.h */
struct emission_file;   /* scene_emission.h */

enum scene_key {
    SCENE_SIZE,
    SCENE_EYE,
    SCENE_TARGET,
    SCENE_UP,
    SCENE_FOV,
    SCENE_SUN,
    SCENE_DENSITY_SCALE,
    SCENE_LIGHT_DENSITY_SCALE,
    SCENE_ALBEDO,
    SCENE_STEP,
    SCENE_MIN_DENSITY,
    SCENE_MIN_TRANSMITTANCE,
    SCENE_MAX_DENSITY,
    SCENE_FILTER,
    SCENE_LIGHT,
    SCENE_LIGHT_SAMPLES,
    SCENE_LIGHT_STEP,
    SCENE_JITTER,
    SCENE_NOISE,
    SCENE_FRAME,
    SCENE_BACKGROUND,
    SCENE_OUTPUT,
    SCENE_SKIP,
    SCENE_TEMPORAL,
    SCENE_HISTORY_BITS,
    SCENE_WINDOW,
    SCENE_ALPHA,
    SCENE_FETCH,
    SCENE_CLAMP,
    SCENE_GAMMA,
    SCENE_SPATIAL,
    SCENE_EDGE_FALLOFF,
    SCENE_RESOLUTION,
    SCENE_UPDATE,
    SCENE_UPSAMPLE,
    SCENE_SUBPIXEL,
    SCENE_CUT,
    SCENE_PHASE, /* the first of scene_light.c's */
    SCENE_OCTAVES,
    SCENE_OCTAVE_A,
    SCENE_OCTAVE_B,
    SCENE_OCTAVE_C,
    SCENE_SUN_COLOUR,
    SCENE_EXPOSURE,
    SCENE_AMBIENT,
    SCENE_AMBIENT_COLOUR,
    SCENE_AMBIENT_TOP,
    SCENE_AMBIENT_BOTTOM,
    SCENE_AMBIENT_PX,
    SCENE_AMBIENT_NX,
    SCENE_AMBIENT_PY,
    SCENE_AMBIENT_NY,
    SCENE_AMBIENT_PZ,
    SCENE_AMBIENT_NZ,
    SCENE_VISIBILITY,
    SCENE_VISIBILITY_SAMPLES,
    SCENE_VISIBILITY_STEP,
    SCENE_CACHE_SPACING,
    SCENE_SKY,
    SCENE_SKY_ZENITH,
    SCENE_SKY_HORIZON,
    SCENE_SKY_GROUND,
    SCENE_SUN_DISC,
    SCENE_SUN_SIZE,
    SCENE_HAZE,
    SCENE_DITHER,
    SCENE_EMISSION,
    SCENE_EMISSION_SCALE,
    SCENE_LAMPS,
    SCENE_FOG_DENSITY,
    SCENE_FOG_BASE,
    SCENE_FOG_FALLOFF,
    SCENE_FOG_FAR,
    SCENE_FOG_SHAPES, /* the first of scene_files.c's */
    SCENE_SURFACE,
    SCENE_SUN_MAP,
    SCENE_KEYS
};

#define SCENE_FILE_FIRST SCENE_FOG_SHAPES
#define SCENE_FILE_KEYS 3

#define SCENE_LINE_SIZE 512 /* of a `key = value`, with its end */
#define SCENE_WHERE_SIZE 300
#define SCENE_VALUES 5 /* of one key at most */

/* What was said, in the text's own units. Starts all zero. */
struct scene_settings {
    bool set[SCENE_KEYS];
    double value[SCENE_KEYS][SCENE_VALUES];
    const struct brume_noise_table *noise_file;          /* or NULL */
    const struct emission_file *emission_file;           /* or NULL */
    const struct scene_file_data *file[SCENE_FILE_KEYS]; /* or NULL */
    char where[SCENE_KEYS][SCENE_WHERE_SIZE]; /* file:line, cut to fit */
};

/* Option --scene FILE or --set KEY=VALUE of `brume COMMAND`: 0, or the exit
 * status 3 after a line on stderr. */
int scene_option(const char *command, struct scene_settings *settings,
                 const char *name, const char *value);

/* One `key = value`; `where` is for messages. */
int scene_set(struct scene_settings *settings, const char *text,
              const char *where, char *err, size_t err_size);
int scene_read(struct scene_settings *settings, const char *path, char *err,
               size_t err_size);

/* Lines `key = value` for what has not been set. */
int scene_fill(struct scene_settings *settings, const char *text, char *err,
               size_t err_size);

/* The core's scene: defaults that suit the volume, then what was set. It may
 * point to *light, which must stay where it is as long as the scene is used.
 * Without one (NULL) the keys of lighting are refused. */
int scene_apply(const struct scene_settings *settings,
                const struct volume_file *file, struct brume_scene *scene,
                struct scene_light *light, char *err, size_t err_size);

/* A line per key: its values, range and default. */
void scene_print_keys(FILE *to);

/* The scene as text that scene_read takes back; both of one scene_apply. */
void scene_print(FILE *to, const struct brume_scene *scene,
                 const struct scene_light *light,
                 const struct volume_file *file);

#endif
