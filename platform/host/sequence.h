/* SPDX-License-Identifier: MIT */
/*
 * Frames from first to last, of one volume or of one for each frame.
 *
 * Errors: as in image.h.
 */
#ifndef BRUME_HOST_SEQUENCE_H
#define BRUME_HOST_SEQUENCE_H

#include "movie.h"
#include "path_file.h"
#include "render.h"

struct sequence {
    const char *volume; /* with `many`, may be a pattern */
    const char *out;    /* or NULL */
    const struct scene_settings *settings;
    const struct path *path; /* or NULL */
    const char *over;        /* a picture that all is drawn over, or NULL */
    bool many;               /* else one frame, and no number in names */
    uint32_t first, last;
    unsigned rate[2]; /* frames per second, a fraction */
    int threads;
    enum wide_kernel kernel;
    int pixels;         /* enum brume_pixel_format; -1: what suits the file */
    bool hash, profile; /* to stdout; to stderr */
};

/* Draws it. Returns 0, 1 when writing failed, 2 on bad input. */
int sequence_run(const struct sequence *sequence, char *err, size_t err_size);

#endif
