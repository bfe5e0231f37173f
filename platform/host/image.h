/* SPDX-License-Identifier: MIT */
/*
 * Pictures of the host programs: in memory, and as PNG, PPM, PGM and PFM files.
 *
 * Errors: functions that can fail return 0 or -1, and then leave one line of
 * text without a newline in err[0 .. err_size - 1], cut to fit. It says what
 * is wrong and where.
 */
#ifndef BRUME_HOST_IMAGE_H
#define BRUME_HOST_IMAGE_H

#include <stddef.h>
#include <stdint.h>

#define IMAGE_MAX_SIDE 65535
#define IMAGE_MAX_BYTES 0x7FFFFFFFu /* of pixels, and of a file */

/* Row 0 on top, pixels left to right, channels together, no padding. Exactly
 * one of u8 and f32 is not NULL: 8-bit samples from 0 to 255, or floats, in
 * which 1.0 is what 255 is in 8 bits. All zero is an empty image. */
struct image {
    int width, height;
    int channels; /* 1 grey, 3 RGB; in 8 bits 4 RGBA, not premultiplied */
    uint8_t *u8;
    float *f32;
};

enum image_format {
    IMAGE_PNG, /* 8-bit grey, RGB or RGBA */
    IMAGE_PPM, /* P6: 8-bit RGB */
    IMAGE_PGM, /* P5: 8-bit grey */
    IMAGE_PFM  /* Pf or PF: float grey or RGB */
};

/* Make *image a black one. Its pixels belong to it: see image_free. */
int image_new_u8(struct image *image, int width, int height, int channels,
                 char *err, size_t err_size);
int image_new_f32(struct image *image, int width, int height, int channels,
                  char *err, size_t err_size);

/* Release the pixels and make *image empty. Empty images are fine. */
void image_free(struct image *image);

/* Samples in the image: width * height * channels. */
size_t image_samples(const struct image *image);

/* The format that a path's extension (.png .ppm .pgm .pfm, in any case)
 * stands for. Fails on others; the message lists the known ones. */
int image_format_of(const char *path, enum image_format *format, char *err,
                    size_t err_size);

/* Read a file of the format that its extension says.
 *
 * PNG: every colour type, up to 8 bits per sample, interlaced or not; alpha
 * and tRNS are dropped, palettes become RGB. PPM and PGM: binary, maxval up to
 * 255, scaled to 255; either content under either extension. PFM: both byte
 * orders, finite values only, the magnitude of the scale is ignored. Samples
 * of 16 bits are refused.
 *
 * On failure *image is empty and the message starts with the path. */
int image_read(const char *path, struct image *image, char *err,
               size_t err_size);

/* Write a file of the format that the extension says, or of `format`.
 *
 * An RGB image whose channels are equal everywhere becomes a grey PNG. PPM
 * repeats grey; PGM refuses RGB unless the channels are equal; all but PNG
 * refuse RGBA. PFM takes 8-bit
 * images too, as value / 255; the 8-bit formats refuse float images. Values
 * that are not finite are refused.
 *
 * The picture goes to `path`.tmp<process id> first, which then replaces
 * `path`: on failure the old file is untouched and nothing partial is left.
 * Only a path that exists and is not a regular file (a pipe, a symbolic link
 * such as /dev/stdout) is written directly. */
int image_write(const char *path, const struct image *image, char *err,
                size_t err_size);
int image_write_as(const char *path, enum image_format format,
                   const struct image *image, char *err, size_t err_size);

#endif
