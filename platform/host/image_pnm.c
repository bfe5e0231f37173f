/* SPDX-License-Identifier: MIT */
/*
 * The Netpbm family: PGM (P5), PPM (P6), and their float cousin PFM (Pf, PF),
 * whose rows go from the bottom up.
 */
#include "image_codec.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define HEADER_SIZE 64 /* room for any header that we write */
#define WORD_SIZE 32   /* a number of a header that we read, with its end */

struct reader {
    const uint8_t *data;
    size_t size, pos;
    char *err;
    size_t err_size;
};

/// Headers ///

static int is_space(int c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* Skip white space, and comments from # to the end of the line. */
static void skip_space(struct reader *r)
{
    while (r->pos < r->size) {
        if (r->data[r->pos] == '#') {
            while (r->pos < r->size && r->data[r->pos] != '\n')
                r->pos++;
        } else if (is_space(r->data[r->pos])) {
            r->pos++;
        } else {
            return;
        }
    }
}

/* The next word of the header, and the one white space that ends it: after
 * the last word come the pixels. */
static int get_word(struct reader *r, const char *what, char text[WORD_SIZE])
{
    size_t n = 0;

    skip_space(r);
    while (r->pos < r->size && n < WORD_SIZE - 1 && !is_space(r->data[r->pos]))
        text[n++] = (char)r->data[r->pos++];
    text[n] = '\0';
    if (r->pos == r->size)
        return image_error(r->err, r->err_size, "header truncated at its %s",
                           what);
    if (!is_space(r->data[r->pos]))
        return image_error(r->err, r->err_size, "bad %s at byte %lu", what,
                           (unsigned long)(r->pos - n));
    r->pos++;
    return 0;
}

static int get_integer(struct reader *r, const char *what, int max, int *value)
{
    char text[WORD_SIZE];

    if (get_word(r, what, text))
        return -1;
    *value = 0;
    for (const char *p = text; *p && *value <= max; p++) {
        if (*p < '0' || *p > '9')
            return image_error(r->err, r->err_size, "bad %s before byte %lu",
                               what, (unsigned long)r->pos);
        *value = 10 * *value + (*p - '0');
    }
    if (*value < 1 || *value > max)
        return image_error(r->err, r->err_size, "%s must be 1 to %d", what,
                           max);
    return 0;
}

/* The scale of a PFM: only its sign counts, negative for little-endian. */
static int get_scale(struct reader *r, int *little)
{
    char text[WORD_SIZE], *end;
    double scale;

    if (get_word(r, "scale", text))
        return -1;
    scale = strtod(text, &end);
    if (*end || !isfinite(scale) || scale == 0)
        return image_error(r->err, r->err_size, "bad scale before byte %lu",
                           (unsigned long)r->pos);
    *little = scale < 0;
    return 0;
}

static int get_size(struct reader *r, int *width, int *height)
{
    if (get_integer(r, "width", IMAGE_MAX_SIDE, width))
        return -1;
    return get_integer(r, "height", IMAGE_MAX_SIDE, height);
}

/* Whether the pixels are all there, before anything is allocated. */
static int check_room(const struct reader *r, int width, int height,
                      int channels, int sample_size)
{
    uint64_t need = (uint64_t)width * (uint64_t)height * (uint64_t)channels *
                    (uint64_t)sample_size;

    if (need > r->size - r->pos)
        return image_error(
            r->err, r->err_size, "truncated: %llu bytes of pixels, %llu needed",
            (unsigned long long)(r->size - r->pos), (unsigned long long)need);
    return 0;
}

/* 'P' and one of two letters; *channels is 3 for `rgb`, 1 for `grey`. */
static int get_magic(struct reader *r, char grey, char rgb, int *channels)
{
    if (r->size < 3 || r->data[0] != 'P' ||
        (r->data[1] != grey && r->data[1] != rgb) ||
        (!is_space(r->data[2]) && r->data[2] != '#'))
        return image_error(r->err, r->err_size,
                           "does not start with P%c or P%c", grey, rgb);
    *channels = r->data[1] == rgb ? 3 : 1;
    r->pos = 2;
    return 0;
}

/// PGM and PPM ///

static int scale_samples(const struct reader *r, struct image *image,
                         int maxval)
{
    const uint8_t *p = r->data + r->pos;
    size_t samples = image_samples(image);
    size_t row = (size_t)image->width * (size_t)image->channels;
    int half = maxval / 2;

    for (size_t i = 0; i < samples; i++) {
        if (p[i] > maxval)
            return image_error(r->err, r->err_size,
                               "row %lu: sample %d above maxval %d",
                               (unsigned long)(i / row), p[i], maxval);
        image->u8[i] = (uint8_t)((p[i] * 255 + half) / maxval);
    }
    return 0;
}

int image_pnm_decode(const uint8_t *data, size_t size, struct image *image,
                     char *err, size_t err_size)
{
    struct reader r = {data, size, 0, err, err_size};
    int width = 0, height = 0, channels = 0, maxval = 0;

    memset(image, 0, sizeof *image);
    if (get_magic(&r, '5', '6', &channels) || get_size(&r, &width, &height) ||
        get_integer(&r, "maxval", 65535, &maxval))
        return -1;
    if (maxval > 255)
        return image_error(err, err_size,
                           "maxval %d: 16-bit samples are not supported, "
                           "only up to 255",
                           maxval);
    if (check_room(&r, width, height, channels, 1) ||
        image_new_u8(image, width, height, channels, err, err_size))
        return -1;
    if (scale_samples(&r, image, maxval)) {
        image_free(image);
        return -1;
    }
    return 0;
}

/* Start a file with `header`. Returns where `size` more bytes go, NULL
 * without memory. */
static uint8_t *new_file(struct image_file *file, const char *header,
                         size_t size, char *err, size_t err_size)
{
    size_t length = strlen(header);

    file->size = length + size;
    file->data = malloc(file->size);
    if (!file->data) {
        image_error(err, err_size, "no memory for the file");
        return NULL;
    }
    memcpy(file->data, header, length);
    return file->data + length;
}

int image_pnm_encode(const struct image *image, int channels,
                     struct image_file *file, char *err, size_t err_size)
{
    size_t in = (size_t)image->channels, out = (size_t)channels;
    size_t pixels = image_samples(image) / in;
    char header[HEADER_SIZE];
    uint8_t *body;

    snprintf(header, sizeof header, "P%d\n%d %d\n255\n", channels == 1 ? 5 : 6,
             image->width, image->height);
    if (!(body = new_file(file, header, pixels * out, err, err_size)))
        return -1;
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < out; c++)
            body[i * out + c] = image->u8[i * in + (c < in ? c : 0)];
    return 0;
}

/// PFM ///

static float get_float(const uint8_t *p, int little)
{
    uint32_t bits = 0;
    float value;

    for (int i = 0; i < 4; i++)
        bits |= (uint32_t)p[little ? i : 3 - i] << (8 * i);
    memcpy(&value, &bits, sizeof value);
    return value;
}

static int check_finite(float value, int x, int y, char *err, size_t err_size)
{
    if (isfinite(value))
        return 0;
    return image_error(err, err_size, "%s at row %d, column %d",
                       isnan(value) ? "NaN" : "infinite value", y, x);
}

static int get_floats(const struct reader *r, struct image *image, int little)
{
    const uint8_t *p = r->data + r->pos;
    int n = image->channels;

    for (int y = image->height - 1; y >= 0; y--) {
        float *row = image->f32 + (size_t)y * (size_t)(image->width * n);
        for (int i = 0; i < image->width * n; i++, p += 4) {
            row[i] = get_float(p, little);
            if (check_finite(row[i], i / n, y, r->err, r->err_size))
                return -1;
        }
    }
    return 0;
}

int image_pfm_decode(const uint8_t *data, size_t size, struct image *image,
                     char *err, size_t err_size)
{
    struct reader r = {data, size, 0, err, err_size};
    int width = 0, height = 0, channels = 0, little = 0;

    memset(image, 0, sizeof *image);
    if (get_magic(&r, 'f', 'F', &channels) || get_size(&r, &width, &height) ||
        get_scale(&r, &little))
        return -1;
    if (check_room(&r, width, height, channels, 4) ||
        image_new_f32(image, width, height, channels, err, err_size))
        return -1;
    if (get_floats(&r, image, little)) {
        image_free(image);
        return -1;
    }
    return 0;
}

static void put_float(uint8_t *p, float value)
{
    uint32_t bits;

    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; i++)
        p[i] = (uint8_t)(bits >> (8 * i) & 255u);
}

int image_pfm_encode(const struct image *image, struct image_file *file,
                     char *err, size_t err_size)
{
    int n = image->channels, row = image->width * n;
    char header[HEADER_SIZE];
    uint8_t *p;

    snprintf(header, sizeof header, "P%c\n%d %d\n-1.0\n", n == 1 ? 'f' : 'F',
             image->width, image->height);
    p = new_file(file, header, 4 * image_samples(image), err, err_size);
    if (!p)
        return -1;
    for (int y = image->height - 1; y >= 0; y--)
        for (int i = 0; i < row; i++, p += 4) {
            size_t at = (size_t)y * (size_t)row + (size_t)i;
            float v = image->f32 ? image->f32[at] : (float)image->u8[at] / 255;
            if (check_finite(v, i / n, y, err, err_size))
                return -1; /* the caller frees the file */
            put_float(p, v);
        }
    return 0;
}
