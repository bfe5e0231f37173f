/* SPDX-License-Identifier: MIT */
/*
 * The keys of scenes, and lines of text. Private to scene_*.c and path_file.c.
 *
 * Errors: as in scene_file.h.
 */
#ifndef BRUME_HOST_SCENE_KEYS_H
#define BRUME_HOST_SCENE_KEYS_H

#include "scene_file.h"

enum scene_kind {
    SCENE_IS_NUMBER,
    SCENE_IS_INTEGER,
    SCENE_IS_VECTOR,
    SCENE_IS_ANGLES,
    SCENE_IS_SIZE,
    SCENE_IS_COLOUR,
    SCENE_IS_WORD
};

struct scene_key_info {
    const char *name;
    enum scene_kind kind;
    double min, max;     /* of each component */
    const char *words;   /* SCENE_IS_WORD: the values 0, 1, 2... */
    const char *meaning; /* for --help, with the default */
};

extern const struct scene_key_info scene_keys[SCENE_KEYS];

/* Text to the value of a key, up to three numbers. */
int scene_read_value(int key, const char *text, double out[3],
                     const char *where, char *err, size_t err_size);

/* A line without its comment; what does not fit is left for the next, for
 * scene_check_line to refuse. False at the end of the file. */
bool scene_next_line(FILE *f, char line[SCENE_LINE_SIZE + 1]);

/* Short enough, and nothing in it that would upset a terminal. */
int scene_check_line(const char *text, const char *where, char *err,
                     size_t err_size);

/* Cuts spaces off both ends, in place. */
char *scene_trimmed(char *s);

/* Is the linear part of world_from_index more than a positive scale? */
bool scene_is_rotated(const struct volume_file *file);

#endif
