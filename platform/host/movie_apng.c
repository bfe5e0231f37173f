/* SPDX-License-Identifier: MIT */
/* Animated PNG: the chunks that PNG has, and three more. */
#include "movie_codec.h"

#include "png_pack.h"

#include <stdlib.h>
#include <string.h>

#define ACTL_BYTES 8
#define FCTL_BYTES 26
#define SEQUENCE_BYTES 4 /* in front of the data of fdAT */

struct box {
    size_t x, y, w, h;
};

int apng_start(const struct movie_format *format, struct image_file *out)
{
    uint8_t actl[ACTL_BYTES], *p;
    out->size =
        PNG_SIGNATURE_BYTES + 2 * PNG_CHUNK_BYTES + PNG_IHDR_BYTES + ACTL_BYTES;
    out->data = p = malloc(out->size);
    if (p == NULL)
        return -1;
    png_put_be32(actl, format->frames);
    png_put_be32(actl + 4, 0); /* plays without end */
    p = png_put_start(p, (size_t)format->width, (size_t)format->height,
                      (size_t)format->channels);
    png_put_chunk(p, "acTL", actl, ACTL_BYTES);
    return 0;
}

/* The smallest box that holds all pixels that differ; one pixel when none
 * does, as a frame must have some. */
static struct box changed(const struct image *a, const struct image *b)
{
    size_t w = (size_t)a->width, h = (size_t)a->height;
    size_t n = (size_t)a->channels, row = w * n;
    size_t top = h, bottom = 0, left = row, right = 0;
    for (size_t y = 0; y < h; y++) {
        const uint8_t *p = a->u8 + y * row, *q = b->u8 + y * row;
        if (memcmp(p, q, row) == 0)
            continue;
        size_t from = 0, to = row;
        while (p[from] == q[from])
            from++;
        while (p[to - 1] == q[to - 1])
            to--;
        top = y < top ? y : top;
        bottom = y + 1;
        left = from < left ? from : left;
        right = to > right ? to : right;
    }
    struct box one = {0, 0, 1, 1};
    if (bottom == 0)
        return one;
    size_t x = left / n;
    struct box box = {x, top, (right + n - 1) / n - x, bottom - top};
    return box;
}

static void put_fctl(uint8_t *p, uint32_t sequence, const struct box *box,
                     const struct movie_format *format)
{
    png_put_be32(p, sequence);
    png_put_be32(p + 4, (uint32_t)box->w);
    png_put_be32(p + 8, (uint32_t)box->h);
    png_put_be32(p + 12, (uint32_t)box->x);
    png_put_be32(p + 16, (uint32_t)box->y);
    png_put_be16(p + 20, format->rate[1]); /* seconds, a fraction */
    png_put_be16(p + 22, format->rate[0]);
    p[24] = 0; /* leave the picture as it is afterwards */
    p[25] = 0; /* replace, do not blend */
}

static int put_frame(struct apng *apng, const struct movie_format *format,
                     const struct box *box, const struct image_file *stream,
                     struct image_file *out)
{
    bool first = apng->sequence == 0;
    size_t ahead = first ? 0 : SEQUENCE_BYTES;
    uint8_t fctl[FCTL_BYTES], *p, *data = malloc(ahead + stream->size);
    out->size = 2 * PNG_CHUNK_BYTES + FCTL_BYTES + ahead + stream->size;
    out->data = p = malloc(out->size);
    if (data != NULL && p != NULL) {
        put_fctl(fctl, apng->sequence++, box, format);
        p = png_put_chunk(p, "fcTL", fctl, FCTL_BYTES);
        if (!first)
            png_put_be32(data, apng->sequence++);
        memcpy(data + ahead, stream->data, stream->size);
        png_put_chunk(p, first ? "IDAT" : "fdAT", data, ahead + stream->size);
    }
    free(data);
    return data != NULL && p != NULL ? 0 : -1;
}

/* A copy of the frame, for the next. */
static int keep(struct apng *apng, const struct image *image)
{
    char err[128];
    if (apng->last.u8 == NULL &&
        image_new_u8(&apng->last, image->width, image->height, image->channels,
                     err, sizeof err) != 0)
        return -1;
    memcpy(apng->last.u8, image->u8, image_samples(image));
    return 0;
}

int apng_frame(struct apng *apng, const struct movie_format *format,
               struct pool *pool, const struct image *image,
               struct image_file *out)
{
    struct image_file stream = {NULL, 0};
    struct box box = {0, 0, (size_t)image->width, (size_t)image->height};
    size_t n = (size_t)image->channels, stride = box.w * n;
    out->data = NULL;
    if (apng->sequence > 0)
        box = changed(&apng->last, image);
    struct png_pixels p = {image->u8 + box.y * stride + box.x * n, box.w, box.h,
                           n, stride};
    int status = png_pack(pool, &p, &stream);
    if (status == 0)
        status = put_frame(apng, format, &box, &stream, out);
    if (status == 0)
        status = keep(apng, image);
    free(stream.data);
    return status;
}

int apng_end(struct image_file *out)
{
    out->size = PNG_CHUNK_BYTES;
    out->data = malloc(out->size);
    if (out->data == NULL)
        return -1;
    png_put_chunk(out->data, "IEND", NULL, 0);
    return 0;
}

void apng_free(struct apng *apng)
{
    image_free(&apng->last);
}
