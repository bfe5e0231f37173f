/* SPDX-License-Identifier: MIT */
/*
 * Lamps as text: a file of one lamp per line, in world space,
 *
 *     X,Y,Z RADIUS SIZE COLOUR [spot X,Y,Z INNER OUTER] [shadow SAMPLES]
 *
 * COLOUR is a grey or r,g,b, 0 to 256; a spot shines along X,Y,Z, fully within
 * INNER degrees of it and not at all from OUTER on. docs/light.md has the
 * formulas. Private to scene_*.c.
 *
 * Errors: as in scene_file.h.
 */
#ifndef BRUME_HOST_SCENE_LAMPS_H
#define BRUME_HOST_SCENE_LAMPS_H

#include "scene_file.h"

extern const char scene_lamps_words[]; /* for --help */

/* `none` or a file, which is read at once. Its lamps are kept until the
 * program ends; the value is their number, 0 for none. */
int scene_lamps_read(const char *text, double out[SCENE_VALUES],
                     const char *where, char *err, size_t err_size);
void scene_lamps_print(FILE *to, const double value[SCENE_VALUES]);

/* The core's lamps of a value, in the volume's pool space: how many, or -1. */
int scene_lamps_make(const double value[SCENE_VALUES],
                     const struct volume_file *file,
                     struct brume_lamp out[BRUME_MAX_LAMPS], char *err,
                     size_t err_size);

#endif
