/* SPDX-License-Identifier: MIT */
/*
 * The file formats behind image.h, between a struct image and the bytes of a
 * file in memory. Private to image*.c, and to the tests, which corrupt files
 * by the thousand and must not need a disk for it.
 *
 * Decoders accept any bytes: they fail cleanly or give a valid image, and
 * allocate no more than a small multiple of what the input can really hold.
 * Messages are as in image.h, but without a path. What follows the end of the
 * picture is ignored.
 */
#ifndef BRUME_HOST_IMAGE_CODEC_H
#define BRUME_HOST_IMAGE_CODEC_H

#include "image.h"
#include "pool.h"

/* An encoded file. The receiver frees data. */
struct image_file {
    uint8_t *data;
    size_t size;
};

#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
/* Format a message into err, with control characters made '?' so that it
 * stays one line. Returns -1, so that a caller can return the call. */
int image_error(char *err, size_t err_size, const char *fmt, ...);

int image_png_decode(const uint8_t *data, size_t size, struct image *image,
                     char *err, size_t err_size);
int image_pnm_decode(const uint8_t *data, size_t size, struct image *image,
                     char *err, size_t err_size);
int image_pfm_decode(const uint8_t *data, size_t size, struct image *image,
                     char *err, size_t err_size);

/* Encoders are given valid images only: image_write_as checks. */
int image_png_encode(const struct image *image, struct image_file *file,
                     char *err, size_t err_size);
/* The same on the threads of a pool; the same bytes. */
int image_png_encode_with(struct pool *pool, const struct image *image,
                          struct image_file *file, char *err, size_t err_size);
int image_pnm_encode(const struct image *image, int channels,
                     struct image_file *file, char *err, size_t err_size);
int image_pfm_encode(const struct image *image, struct image_file *file,
                     char *err, size_t err_size);

/* A whole file, of at most IMAGE_MAX_BYTES; messages without the path. */
int image_get(const char *path, struct image_file *file, char *err,
              size_t err_size);

/* The two halves of image_write_as: a picture as a file of the format, and
 * that file in its place (see out_file.h). Messages without the path. */
int image_encode(enum image_format format, const struct image *image,
                 struct pool *pool, struct image_file *file, char *err,
                 size_t err_size);
int image_put(const char *path, const struct image_file *file, char *err,
              size_t err_size);

/* Whether the three channels of an 8-bit image are equal everywhere; 1 for
 * grey images as well. */
int image_is_grey(const struct image *image);

#endif
