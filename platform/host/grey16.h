/* SPDX-License-Identifier: MIT */
/*
 * Grey pictures of 16 bits: depths, heights, what the sun sees. Apart from
 * struct image, whose samples are what an eye sees, because a depth is never
 * scaled to 8 bits.
 *
 * Errors: as in image.h; messages of grey16_read and grey16_write start with
 * the path.
 */
#ifndef BRUME_HOST_GREY16_H
#define BRUME_HOST_GREY16_H

#include "image_codec.h"

#define GREY16_NOTE_SIZE 1024

/* Row 0 on top, no padding. `values` is the picture's own. */
struct grey16 {
    int width, height;
    uint16_t *values;
    /* Comment lines of a PGM without their #, each with its newline; those
     * that do not fit are left out. */
    char note[GREY16_NOTE_SIZE];
};

/* Zeros. */
int grey16_new(struct grey16 *picture, int width, int height, char *err,
               size_t err_size);
void grey16_free(struct grey16 *picture);

/* .pgm: binary, any maxval, scaled to 65535; .png: grey of any depth. On
 * failure *picture is empty. */
int grey16_read(const char *path, struct grey16 *picture, char *err,
                size_t err_size);

/* A file in memory, 16 bits a sample, of IMAGE_PGM, with the note as its
 * comments, or IMAGE_PNG, without. */
int grey16_encode(enum image_format format, const struct grey16 *picture,
                  struct image_file *file, char *err, size_t err_size);

/* Decoders of bytes, for the tests. */
int grey16_pgm_decode(const uint8_t *data, size_t size, struct grey16 *picture,
                      char *err, size_t err_size);
/* In image_png_read.c. */
int grey16_png_decode(const uint8_t *data, size_t size, struct grey16 *picture,
                      char *err, size_t err_size);

#endif
