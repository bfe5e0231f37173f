/* SPDX-License-Identifier: MIT */
/*
 * The PNG writer: 8-bit grey or RGB, one IDAT chunk, a filter per row.
 */
#include "image_codec.h"

#include "deflate.h"

#include <stdlib.h>
#include <string.h>

#define FILTERS 5
/* Pictures up to this many bytes are also tried without filters, which wins
 * on flat or few-coloured ones. */
#define TRY_PLAIN (2u << 20)

/* The picture as it goes into the file. */
struct rows {
    const uint8_t *pixels;
    size_t row_size, height, step; /* bytes, rows, bytes per pixel */
};

struct stream {
    uint8_t *data;
    size_t size;
};

static uint8_t *put_be32(uint8_t *p, uint32_t v)
{
    p[0] = (uint8_t)(v >> 24 & 255u);
    p[1] = (uint8_t)(v >> 16 & 255u);
    p[2] = (uint8_t)(v >> 8 & 255u);
    p[3] = (uint8_t)(v & 255u);
    return p + 4;
}

/// Filters ///

static int paeth(int a, int b, int c)
{
    int pa = abs(b - c), pb = abs(a - c), pc = abs(a + b - 2 * c);

    return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

static uint8_t difference(int value, int guess)
{
    return (uint8_t)((unsigned)(value - guess) & 255u);
}

/* Row minus its prediction. `row` and `prior`, the row above, have `step`
 * zeros in front, so that the first pixel needs no special case. */
static void filter_row(int filter, const uint8_t *row, const uint8_t *prior,
                       size_t size, size_t step, uint8_t *out)
{
    const uint8_t *left = row - step, *corner = prior - step;

    switch (filter) {
    case 0: memcpy(out, row, size); break;
    case 1:
        for (size_t i = 0; i < size; i++)
            out[i] = difference(row[i], left[i]);
        break;
    case 2:
        for (size_t i = 0; i < size; i++)
            out[i] = difference(row[i], prior[i]);
        break;
    case 3:
        for (size_t i = 0; i < size; i++)
            out[i] = difference(row[i], (left[i] + prior[i]) / 2);
        break;
    default:
        for (size_t i = 0; i < size; i++)
            out[i] = difference(row[i], paeth(left[i], prior[i], corner[i]));
        break;
    }
}

/* Sum of the bytes as signed numbers without their sign: the usual guess at
 * how well a row will compress. */
static size_t row_score(const uint8_t *p, size_t size)
{
    size_t sum = 0;

    for (size_t i = 0; i < size; i++)
        sum += p[i] < 128 ? p[i] : 256u - p[i];
    return sum;
}

/* One row with its filter byte. `scratch` holds FILTERS rows. */
static void put_best_row(const struct rows *r, const uint8_t *row,
                         const uint8_t *prior, uint8_t *scratch, uint8_t *out)
{
    size_t best_score = 0;
    int best = 0;

    for (int f = 0; f < FILTERS; f++) {
        uint8_t *filtered = scratch + (size_t)f * r->row_size;
        size_t score;
        filter_row(f, row, prior, r->row_size, r->step, filtered);
        score = row_score(filtered, r->row_size);
        if (f == 0 || score < best_score) {
            best_score = score;
            best = f;
        }
    }
    *out = (uint8_t)best;
    memcpy(out + 1, scratch + (size_t)best * r->row_size, r->row_size);
}

/* The filtered picture into `raw`. Returns -1 without memory. */
static int filter_picture(const struct rows *r, uint8_t *raw)
{
    size_t padded = r->row_size + r->step;
    uint8_t *scratch = calloc(FILTERS * r->row_size + 2 * padded, 1);
    uint8_t *row, *prior;

    if (!scratch)
        return -1;
    row = scratch + FILTERS * r->row_size + r->step;
    prior = row + padded;
    for (size_t y = 0; y < r->height; y++) {
        uint8_t *swap = prior;
        memcpy(row, r->pixels + y * r->row_size, r->row_size);
        put_best_row(r, row, prior, scratch, raw + y * (r->row_size + 1));
        prior = row;
        row = swap;
    }
    free(scratch);
    return 0;
}

static void plain_picture(const struct rows *r, uint8_t *raw)
{
    for (size_t y = 0; y < r->height; y++) {
        *raw++ = 0;
        memcpy(raw, r->pixels + y * r->row_size, r->row_size);
        raw += r->row_size;
    }
}

/// The file ///

/* Compress the filtered picture, and the plain one when that is cheap to try;
 * keep the shorter. Returns -1 without memory. */
static int compress_picture(const struct rows *r, struct stream *best)
{
    size_t size = r->height * (r->row_size + 1);
    uint8_t *raw = malloc(size);

    best->data = NULL;
    if (raw && filter_picture(r, raw) == 0)
        best->data = deflate_zlib(raw, size, DEFLATE_FILTERED, &best->size);
    if (best->data && size <= TRY_PLAIN) {
        struct stream plain;
        plain_picture(r, raw);
        plain.data = deflate_zlib(raw, size, DEFLATE_PLAIN, &plain.size);
        if (plain.data && plain.size < best->size) {
            free(best->data);
            *best = plain;
        } else {
            free(plain.data);
        }
    }
    free(raw);
    return best->data ? 0 : -1;
}

static uint8_t *put_chunk(uint8_t *p, const char *type, const uint8_t *data,
                          size_t size)
{
    uint8_t *start = p + 4;

    p = put_be32(p, (uint32_t)size);
    memcpy(p, type, 4);
    if (size > 0)
        memcpy(p + 4, data, size);
    return put_be32(p + 4 + size, deflate_crc32(0, start, size + 4));
}

/* Returns -1 without memory. */
static int put_file(const struct image *image, size_t channels,
                    const struct stream *idat, struct image_file *file)
{
    static const uint8_t signature[8] = {
        0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n',
    };
    uint8_t ihdr[13] = {0}, *p;

    file->size = sizeof signature + 3 * 12 + sizeof ihdr + idat->size;
    if (!(p = file->data = malloc(file->size)))
        return -1;
    put_be32(ihdr, (uint32_t)image->width);
    put_be32(ihdr + 4, (uint32_t)image->height);
    ihdr[8] = 8;                     /* bits per sample */
    ihdr[9] = channels == 1 ? 0 : 2; /* grey or RGB */
    memcpy(p, signature, sizeof signature);
    p = put_chunk(p + sizeof signature, "IHDR", ihdr, sizeof ihdr);
    p = put_chunk(p, "IDAT", idat->data, idat->size);
    put_chunk(p, "IEND", NULL, 0);
    return 0;
}

/* Every third sample: an RGB image that is grey, as grey. */
static uint8_t *drop_colour(const struct image *image)
{
    size_t pixels = image_samples(image) / 3;
    uint8_t *grey = malloc(pixels);

    for (size_t i = 0; grey && i < pixels; i++)
        grey[i] = image->u8[3 * i];
    return grey;
}

int image_png_encode(const struct image *image, struct image_file *file,
                     char *err, size_t err_size)
{
    size_t channels = image_is_grey(image) ? 1 : 3;
    struct rows r = {image->u8, (size_t)image->width * channels,
                     (size_t)image->height, channels};
    struct stream idat = {NULL, 0};
    uint8_t *grey = NULL;
    int status = -1;

    file->data = NULL;
    if (image->channels == 3 && channels == 1)
        r.pixels = grey = drop_colour(image);
    if (r.pixels && compress_picture(&r, &idat) == 0)
        status = put_file(image, channels, &idat, file);
    free(idat.data);
    free(grey);
    return status ? image_error(err, err_size, "no memory for the PNG") : 0;
}
