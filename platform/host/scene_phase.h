/* SPDX-License-Identifier: MIT */
/*
 * Phase functions as text, and as the core's models. Private to scene_*.c.
 *
 *     isotropic   hg:G   schlick:G   draine:ALPHA,G   droplet:MICROMETRES
 *     mix:WEIGHT,ALPHA,G_DRAINE,G
 *
 * Values of one: its number in this list, then its parameters.
 *
 * Errors: as in scene_file.h.
 */
#ifndef BRUME_HOST_SCENE_PHASE_H
#define BRUME_HOST_SCENE_PHASE_H

#include "scene_file.h"

extern const char scene_phase_words[]; /* for --help */

int scene_phase_read(const char *text, double out[SCENE_VALUES],
                     const char *where, char *err, size_t err_size);
void scene_phase_print(FILE *to, const double value[SCENE_VALUES]);

bool scene_phase_is_isotropic(const double value[SCENE_VALUES]);

/* The core's model; false for isotropic, which needs none. */
bool scene_phase_model(const double value[SCENE_VALUES],
                       struct brume_phase_model *out);

#endif
