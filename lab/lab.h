/* SPDX-License-Identifier: MIT */
/*
 * brume-lab: frames drawn in memory, each measured against references.
 *
 *   options.c   the command line
 *   picture.c   rows; of a picture that was drawn elsewhere
 *   sequence.c  frames of a scene, of a path, over time
 *   pack.c      a scene for a target, with the picture that it should draw
 *   measure.c   pictures against a reference, by region: what a row holds
 *   spectrum.c  the same by frequency
 */
#ifndef BRUME_LAB_H
#define BRUME_LAB_H

#include "image.h"
#include "path_file.h"
#include "render.h"
#include "scene_file.h"

#define LAB_MOST 16    /* references, regions, columns of each kind */
#define LAB_NAME 32    /* a name, with its end */
#define LAB_ERROR 1024 /* a message, with its end */

/* A part of the picture, in fractions of its sides, so that it shows the same
 * at any size. */
struct lab_region {
    char name[LAB_NAME];
    double x, y, w, h;
};

/* A picture file to compare with, or with %d in its name one a frame. */
struct lab_reference {
    char name[LAB_NAME];
    const char *path;
};

/* The same in every row, put before what is measured. */
struct lab_column {
    char name[LAB_NAME];
    const char *value;
};

struct lab_options {
    bool is_picture; /* the command `picture`: volume is one */
    bool is_pack;    /* the command `pack` */
    const char *volume;
    struct scene_settings settings;
    const char *path;           /* of keyframes, or NULL */
    const char *picture;        /* where the last frame goes, or NULL */
    const char *mean;           /* where the mean of all frames goes, or NULL */
    const char *spectrum;       /* .png and .csv of the error, or NULL */
    uint32_t cycle;             /* the scene's frame number modulo this; or 0 */
    uint32_t first, last, from; /* frames; rows begin at `from` */
    int pixels; /* enum brume_pixel_format of 8 bits; -1: linear light */
    int threads;
    enum wide_kernel kernel;
    bool time;               /* adds the column ms */
    bool flip;               /* adds the column flip */
    uint32_t only[LAB_MOST]; /* rows of these frames alone, if any */
    int only_count;
    bool cumulative; /* rows are of the mean of the frames so far */
    struct lab_reference references[LAB_MOST];
    struct lab_region regions[LAB_MOST]; /* the first is the whole */
    struct lab_column columns[LAB_MOST];
    int reference_count, region_count, column_count;
};

/* Returns -1 to go on, else the exit status, after a message. */
int lab_read_options(struct lab_options *options, int argc, char **argv);

/// Commands: rows on stdout, or none on errors; the exit status ///

int lab_sequence(const struct lab_options *options, char *err, size_t err_size);
int lab_picture(const struct lab_options *options, char *err, size_t err_size);
int lab_pack(const struct lab_options *options, char *err, size_t err_size);

/// Measures ///

/* What one row is measured of. `before` and `truth_before` belong to the frame
 * before, or are NULL. All have the same size and channels. */
struct lab_pair {
    const struct image *picture, *truth;
    const struct image *before, *truth_before;
    bool flip; /* measure it as well: it takes as long as a frame */
};

/* Columns, with commas between, and their values for a region. A measure that
 * a frame does not have leaves its cell empty. */
extern const char lab_measure_names[];
int lab_measure(FILE *to, const struct lab_pair *pair,
                const struct lab_region *region, char *err, size_t err_size);

/// Spectra (spectrum.c) ///

/* All zero before the first frame. */
struct lab_spectrum {
    int x, y, width, height; /* of the picture, in pixels */
    uint32_t frames;
    double *power; /* sums over frames; the caller frees it */
};

/* Adds a frame of float pictures; -1 without memory. */
int lab_spectrum_add(struct lab_spectrum *s, const struct lab_region *region,
                     const struct lab_pair *pair);
/* The exit status. */
int lab_spectrum_write(const struct lab_spectrum *s,
                       const struct lab_options *o, char *err, size_t err_size);

/// Rows (picture.c): 0, or the exit status after an error ///

/* In place of what is in *to. Refused unless it has the picture's size. */
int lab_read_truth(const char *path, const struct image *picture,
                   struct image *to, char *err, size_t err_size);

void lab_print_head(const struct lab_options *options, FILE *to);
int lab_print_row(const struct lab_options *options, FILE *to, uint32_t frame,
                  int reference, int region, const struct lab_pair *pair,
                  double ms, char *err, size_t err_size);

/* Closes rows that open_memstream made of *text, prints them when nothing went
 * wrong, frees them. The exit status. */
int lab_finish(FILE *rows, char **text, size_t *size, int status, bool print,
               char *err, size_t err_size);

#endif
