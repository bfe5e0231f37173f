/* SPDX-License-Identifier: MIT */
/*
 * The colours that a volume glows in, by code of its second grid: none, those
 * of a black body, or those of a file. Private to the scene's files.
 *
 * Errors: as in scene_file.h.
 */
#ifndef BRUME_HOST_SCENE_EMISSION_H
#define BRUME_HOST_SCENE_EMISSION_H

#include "scene_file.h"

/* Colours from a file, 256 lines `red green blue`, 0 to 16 each, # comments.
 * They stay for the life of the program, as scenes point to them. */
struct emission_file {
    uint32_t colour[256][3]; /* Q16.16 */
    char path[SCENE_LINE_SIZE];
};

extern const char scene_emission_words[];

/* Text to the value of the key: what it is, then kelvin of codes 0 and 255
 * and the luminance of the latter. *file is set for a file, else NULL. */
int scene_emission_read(const char *text, double out[SCENE_VALUES],
                        const struct emission_file **file, const char *where,
                        char *err, size_t err_size);

void scene_emission_print(FILE *to, const double value[SCENE_VALUES],
                          const struct emission_file *file);

/* The colours; false, and they are black, for none. */
bool scene_emission_colours(const double value[SCENE_VALUES],
                            const struct emission_file *file,
                            uint32_t out[256][3]);

#endif
