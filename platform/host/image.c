/* SPDX-License-Identifier: MIT */
/*
 * Images in memory, the choice of a format, and whole files in and out.
 */
#include "image.h"
#include "image_codec.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "out_file.h"

#define MESSAGE_SIZE 256

int image_error(char *err, size_t err_size, const char *fmt, ...)
{
    va_list ap;

    if (err_size == 0)
        return -1;
    va_start(ap, fmt);
    if (vsnprintf(err, err_size, fmt, ap) < 0)
        err[0] = '\0';
    va_end(ap);
    for (; *err; err++)
        if ((unsigned char)*err < 32 || *err == 127)
            *err = '?';
    return -1;
}

/// Images ///

size_t image_samples(const struct image *image)
{
    return (size_t)image->width * (size_t)image->height *
           (size_t)image->channels;
}

static int check_size(int width, int height, int channels, size_t sample_size,
                      char *err, size_t err_size)
{
    if (width < 1 || height < 1 || width > IMAGE_MAX_SIDE ||
        height > IMAGE_MAX_SIDE)
        return image_error(err, err_size,
                           "size %d x %d: each side must be 1 to %d", width,
                           height, IMAGE_MAX_SIDE);
    if (channels != 1 && channels != 3 && (channels != 4 || sample_size != 1))
        return image_error(err, err_size, "%d channels: must be 1, 3 or 4",
                           channels);
    if ((uint64_t)width * (uint64_t)height * (uint64_t)channels * sample_size >
        IMAGE_MAX_BYTES)
        return image_error(err, err_size, "size %d x %d: more than 2^31 bytes",
                           width, height);
    return 0;
}

static int new_pixels(struct image *image, int width, int height, int channels,
                      size_t sample_size, void **pixels, char *err,
                      size_t err_size)
{
    memset(image, 0, sizeof *image);
    if (check_size(width, height, channels, sample_size, err, err_size))
        return -1;
    *pixels =
        calloc((size_t)width * (size_t)height, (size_t)channels * sample_size);
    if (!*pixels)
        return image_error(err, err_size, "no memory for %d x %d pixels", width,
                           height);
    image->width = width;
    image->height = height;
    image->channels = channels;
    return 0;
}

int image_new_u8(struct image *image, int width, int height, int channels,
                 char *err, size_t err_size)
{
    void *pixels;

    if (new_pixels(image, width, height, channels, 1, &pixels, err, err_size))
        return -1;
    image->u8 = pixels;
    return 0;
}

int image_new_f32(struct image *image, int width, int height, int channels,
                  char *err, size_t err_size)
{
    void *pixels;

    if (new_pixels(image, width, height, channels, sizeof *image->f32, &pixels,
                   err, err_size))
        return -1;
    image->f32 = pixels;
    return 0;
}

void image_free(struct image *image)
{
    free(image->u8);
    free(image->f32);
    memset(image, 0, sizeof *image);
}

int image_is_grey(const struct image *image)
{
    const uint8_t *p = image->u8;
    size_t samples = image_samples(image);

    if (image->channels != 3)
        return image->channels == 1;
    for (size_t i = 0; i < samples; i += 3)
        if (p[i] != p[i + 1] || p[i] != p[i + 2])
            return 0;
    return 1;
}

/// Formats ///

static int lower(int c)
{
    return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c;
}

static int same_extension(const char *a, const char *b)
{
    while (*a && lower(*a) == lower(*b)) {
        a++;
        b++;
    }
    return lower(*a) == lower(*b);
}

int image_format_of(const char *path, enum image_format *format, char *err,
                    size_t err_size)
{
    static const char extension[4][5] = {".png", ".ppm", ".pgm", ".pfm"};
    const char *slash = strrchr(path, '/');
    const char *dot = strrchr(slash ? slash : path, '.');

    for (int i = 0; dot && i < 4; i++)
        if (same_extension(dot, extension[i])) {
            *format = (enum image_format)i;
            return 0;
        }
    return image_error(err, err_size,
                       "%s: unknown extension; known: .png .ppm .pgm .pfm",
                       path);
}

/// Reading ///

/* Everything up to the end of f; works on pipes too. */
static int read_stream(FILE *f, struct image_file *file, char *err,
                       size_t err_size)
{
    size_t room = 0, got = 1;

    for (; got > 0; file->size += got) {
        if (file->size == room) {
            uint8_t *more;
            if (file->size > IMAGE_MAX_BYTES)
                return image_error(err, err_size, "more than 2^31 bytes");
            room = room ? 2 * room : 65536;
            if (!(more = realloc(file->data, room)))
                return image_error(err, err_size, "no memory for the file");
            file->data = more;
        }
        got = fread(file->data + file->size, 1, room - file->size, f);
    }
    if (ferror(f))
        return image_error(err, err_size, "cannot read: %s", strerror(errno));
    return 0;
}

int image_get(const char *path, struct image_file *file, char *err,
              size_t err_size)
{
    FILE *f = fopen(path, "rb");
    int status;

    file->data = NULL;
    file->size = 0;
    if (!f)
        return image_error(err, err_size, "cannot open: %s", strerror(errno));
    status = read_stream(f, file, err, err_size);
    fclose(f);
    return status;
}

static int decode(enum image_format format, const struct image_file *file,
                  struct image *image, char *err, size_t err_size)
{
    switch (format) {
    case IMAGE_PNG:
        return image_png_decode(file->data, file->size, image, err, err_size);
    case IMAGE_PFM:
        return image_pfm_decode(file->data, file->size, image, err, err_size);
    default:
        return image_pnm_decode(file->data, file->size, image, err, err_size);
    }
}

int image_read(const char *path, struct image *image, char *err,
               size_t err_size)
{
    char message[MESSAGE_SIZE] = "";
    struct image_file file = {NULL, 0};
    enum image_format format;
    int status;

    memset(image, 0, sizeof *image);
    if (image_format_of(path, &format, err, err_size))
        return -1;
    status = image_get(path, &file, message, sizeof message);
    if (status == 0)
        status = decode(format, &file, image, message, sizeof message);
    free(file.data);
    if (status == 0)
        return 0;
    image_free(image);
    return image_error(err, err_size, "%s: %s", path, message);
}

/// Writing ///

int image_put(const char *path, const struct image_file *file, char *err,
              size_t err_size)
{
    struct out_file out;

    if (out_open(&out, path, err, err_size))
        return -1;
    if (out_write(&out, file->data, file->size, err, err_size)) {
        out_abandon(&out);
        return -1;
    }
    return out_close(&out, err, err_size);
}

static int check_image(const struct image *image, enum image_format format,
                       char *err, size_t err_size)
{
    if (check_size(image->width, image->height, image->channels,
                   image->f32 ? sizeof(float) : 1, err, err_size))
        return -1;
    if (!image->u8 == !image->f32)
        return image_error(err, err_size, "image without pixels");
    if (format != IMAGE_PFM && !image->u8)
        return image_error(err, err_size,
                           "float pixels fit only in a .pfm file");
    if (format != IMAGE_PNG && image->channels == 4)
        return image_error(err, err_size,
                           "RGBA pixels fit only in a .png file");
    if (format == IMAGE_PGM && !image_is_grey(image))
        return image_error(err, err_size, "RGB pixels do not fit in a PGM");
    return 0;
}

int image_encode(enum image_format format, const struct image *image,
                 struct pool *pool, struct image_file *file, char *err,
                 size_t err_size)
{
    if (check_image(image, format, err, err_size))
        return -1;
    switch (format) {
    case IMAGE_PNG:
        return image_png_encode_with(pool, image, file, err, err_size);
    case IMAGE_PFM: return image_pfm_encode(image, file, err, err_size);
    default:
        return image_pnm_encode(image, format == IMAGE_PGM ? 1 : 3, file, err,
                                err_size);
    }
}

int image_write_as(const char *path, enum image_format format,
                   const struct image *image, char *err, size_t err_size)
{
    char message[MESSAGE_SIZE] = "";
    struct image_file file = {NULL, 0};
    int status =
        image_encode(format, image, NULL, &file, message, sizeof message);

    if (status == 0)
        status = image_put(path, &file, message, sizeof message);
    free(file.data);
    if (status == 0)
        return 0;
    return image_error(err, err_size, "%s: %s", path, message);
}

int image_write(const char *path, const struct image *image, char *err,
                size_t err_size)
{
    enum image_format format;

    if (image_format_of(path, &format, err, err_size))
        return -1;
    return image_write_as(path, format, image, err, err_size);
}
