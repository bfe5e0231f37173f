/* SPDX-License-Identifier: MIT */
/*
 * Pixels to a zlib stream, with a filter per row, and chunks.
 */
#include "png_pack.h"

#include "deflate.h"

#include <stdlib.h>
#include <string.h>

#define FILTERS 5
#define BAND_ROWS 32 /* that a task filters */
/* Pictures up to this many bytes are also tried without filters, which wins
 * on flat or few-coloured ones. */
#define TRY_PLAIN (1u << 16)

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
static uint32_t row_score(const uint8_t *p, size_t size)
{
    uint32_t sum = 0; /* 3 * 65535 * 128 at most */

    for (size_t i = 0; i < size; i++)
        sum += p[i] < 128 ? p[i] : 256u - p[i];
    return sum;
}

/* One row with its filter byte. `scratch` holds FILTERS rows. */
static void put_best_row(size_t size, size_t step, const uint8_t *row,
                         const uint8_t *prior, uint8_t *scratch, uint8_t *out)
{
    uint32_t best_score = 0;
    int best = 0;

    for (int f = 0; f < FILTERS; f++) {
        uint8_t *filtered = scratch + (size_t)f * size;
        uint32_t score;
        filter_row(f, row, prior, size, step, filtered);
        score = row_score(filtered, size);
        if (f == 0 || score < best_score) {
            best_score = score;
            best = f;
        }
        if (best_score == 0) /* no other can be better */
            break;
    }
    *out = (uint8_t)best;
    memcpy(out + 1, scratch + (size_t)best * size, size);
}

/* A picture on its way into a stream. */
struct job {
    const struct png_pixels *pixels;
    size_t row_size; /* bytes, without the filter's */
    uint8_t *raw;    /* rows with their filter bytes */
    uint8_t *scratch;
    size_t scratch_size; /* of one thread */
};

static uint8_t *raw_row(const struct job *job, size_t y)
{
    return job->raw + y * (job->row_size + 1);
}

/* Rows BAND_ROWS * task and on. */
static void filter_band(void *arg, unsigned task, unsigned worker)
{
    const struct job *job = arg;
    const struct png_pixels *p = job->pixels;
    size_t size = job->row_size, padded = size + p->channels;
    size_t y = (size_t)task * BAND_ROWS, end = y + BAND_ROWS;
    uint8_t *scratch = job->scratch + worker * job->scratch_size;
    uint8_t *row = scratch + FILTERS * size + p->channels;
    uint8_t *prior = row + padded, *swap;

    memset(prior, 0, size);
    if (y > 0)
        memcpy(prior, p->data + (y - 1) * p->stride, size);
    for (; y < end && y < p->height; y++) {
        memcpy(row, p->data + y * p->stride, size);
        put_best_row(size, p->channels, row, prior, scratch, raw_row(job, y));
        swap = prior;
        prior = row;
        row = swap;
    }
}

static int filter_picture(struct pool *pool, struct job *job)
{
    const struct png_pixels *p = job->pixels;

    job->scratch_size =
        FILTERS * job->row_size + 2 * (job->row_size + p->channels);
    job->scratch = calloc(pool_threads(pool), job->scratch_size);
    if (!job->scratch)
        return -1;
    pool_run(pool, filter_band, job,
             (unsigned)((p->height + BAND_ROWS - 1) / BAND_ROWS));
    free(job->scratch);
    return 0;
}

static void plain_picture(const struct job *job)
{
    const struct png_pixels *p = job->pixels;

    for (size_t y = 0; y < p->height; y++) {
        *raw_row(job, y) = 0;
        memcpy(raw_row(job, y) + 1, p->data + y * p->stride, job->row_size);
    }
}

/// The stream ///

/* Compress the filtered picture, and the plain one when that is cheap to try;
 * keep the shorter. */
int png_pack(struct pool *pool, const struct png_pixels *pixels,
             struct image_file *stream)
{
    struct job job = {pixels, pixels->width * pixels->channels, NULL, NULL, 0};
    size_t size = pixels->height * (job.row_size + 1);

    stream->data = NULL;
    job.raw = malloc(size);
    if (job.raw && filter_picture(pool, &job) == 0)
        stream->data = deflate_zlib_with(pool, job.raw, size, DEFLATE_FILTERED,
                                         &stream->size);
    if (stream->data && size <= TRY_PLAIN) {
        struct image_file plain;
        plain_picture(&job);
        plain.data =
            deflate_zlib_with(pool, job.raw, size, DEFLATE_PLAIN, &plain.size);
        if (plain.data && plain.size < stream->size) {
            free(stream->data);
            *stream = plain;
        } else {
            free(plain.data);
        }
    }
    free(job.raw);
    return stream->data ? 0 : -1;
}

/// Chunks ///

uint8_t *png_put_be16(uint8_t *p, uint32_t value)
{
    p[0] = (uint8_t)(value >> 8 & 255u);
    p[1] = (uint8_t)(value & 255u);
    return p + 2;
}

uint8_t *png_put_be32(uint8_t *p, uint32_t value)
{
    return png_put_be16(png_put_be16(p, value >> 16), value);
}

uint8_t *png_put_chunk(uint8_t *p, const char *type, const uint8_t *data,
                       size_t size)
{
    uint8_t *start = p + 4;

    p = png_put_be32(p, (uint32_t)size);
    memcpy(p, type, 4);
    if (size > 0)
        memcpy(p + 4, data, size);
    return png_put_be32(p + 4 + size, deflate_crc32(0, start, size + 4));
}

uint8_t *png_put_start(uint8_t *p, size_t width, size_t height, size_t channels)
{
    static const uint8_t signature[PNG_SIGNATURE_BYTES] = {
        0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n',
    };
    uint8_t ihdr[PNG_IHDR_BYTES] = {0};

    png_put_be32(ihdr, (uint32_t)width);
    png_put_be32(ihdr + 4, (uint32_t)height);
    ihdr[8] = 8;                                         /* bits per sample */
    ihdr[9] = channels == 1 ? 0 : channels == 3 ? 2 : 6; /* colour type */
    memcpy(p, signature, sizeof signature);
    return png_put_chunk(p + sizeof signature, "IHDR", ihdr, sizeof ihdr);
}
