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
    SCENE_IS_WORD,
    SCENE_IS_PHASE,    /* a word and its numbers: scene_phase.h */
    SCENE_IS_EMISSION, /* the same, or a file: scene_emission.h */
    SCENE_IS_LAMPS,    /* a file: scene_lamps.h */
    SCENE_IS_FILE      /* its path: scene_files.h */
};

struct scene_key_info {
    const char *name;
    enum scene_kind kind;
    double min, max;     /* of each component */
    const char *words;   /* SCENE_IS_WORD: the values 0, 1, 2... */
    const char *meaning; /* for --help, with the default */
};

extern const struct scene_key_info scene_keys[SCENE_KEYS];

/* Text to the value of a key. */
int scene_read_value(int key, const char *text, double out[SCENE_VALUES],
                     const char *where, char *err, size_t err_size);

/* Up to `most` numbers separated by commas, spaces or `also`; how many there
 * were, or -1 on anything else. */
int scene_read_numbers(const char *text, double *out, int most, char also);

/* A line without its comment; what does not fit is left for the next, for
 * scene_check_line to refuse. False at the end of the file. */
bool scene_next_line(FILE *f, char line[SCENE_LINE_SIZE + 1]);

/* Short enough, and nothing in it that would upset a terminal. */
int scene_check_line(const char *text, const char *where, char *err,
                     size_t err_size);

/* Does a key's value go from one keyframe to the next by and by? */
bool scene_key_moves(int key);

/* Place of a word in a list with spaces between, or -1; and the other way. */
int scene_word_index(const char *words, const char *word);
void scene_print_word(FILE *to, const char *words, unsigned index);

/* As few digits as scene_read_value needs to get the same number. */
void scene_print_number(FILE *to, double value);

/* A direction of any length in world axes, as Q2.30 in the pool's; -1 when it
 * has none. */
int scene_direction(const struct volume_file *file, const double v[3],
                    int32_t out[3]);

/* Cuts spaces off both ends, in place. */
char *scene_trimmed(char *s);

/* Is the linear part of world_from_index more than a positive scale? */
bool scene_is_rotated(const struct volume_file *file);

#endif
