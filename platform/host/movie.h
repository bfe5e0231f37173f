/* SPDX-License-Identifier: MIT */
/*
 * Where the frames of a sequence go: pictures with numbered names, one
 * animated PNG, or Y4M (YUV4MPEG2) for players and encoders.
 *
 * Errors: as in image.h. After an error nothing partial is left, but for what
 * has gone to a pipe.
 */
#ifndef BRUME_HOST_MOVIE_H
#define BRUME_HOST_MOVIE_H

#include "image.h"
#include "pool.h"
#include "profile.h"

#include <stdbool.h>

enum movie_kind {
    MOVIE_STILL,    /* one picture, under the name as it is */
    MOVIE_PICTURES, /* one each, the name a pattern (pattern.h) */
    MOVIE_APNG,
    MOVIE_Y4M
};

struct movie_format {
    enum movie_kind kind;
    enum image_format picture; /* of stills and pictures */
    const char *path;
    int width, height, channels; /* of APNG and Y4M */
    uint32_t frames;
    unsigned rate[2]; /* frames per second, a fraction; 1 .. 65535 each */
};

/* What a path is for one frame, or for many, by its extension; "-" is Y4M. */
int movie_kind_of(const char *path, bool many, struct movie_format *format,
                  char *err, size_t err_size);

struct movie;

/* NULL on errors. `profile` may be NULL; both must stay. */
struct movie *movie_open(const struct movie_format *format, struct pool *pool,
                         struct profile *profile, char *err, size_t err_size);

/* The next frame, and its number. */
int movie_add(struct movie *movie, const struct image *image, uint32_t number,
              char *err, size_t err_size);

/* Ends the file when all its frames were added, else removes it; frees. */
int movie_close(struct movie *movie, char *err, size_t err_size);

#endif
