/* SPDX-License-Identifier: MIT */
/*
 * What the PNG and APNG writers share: pixels to a zlib stream, and chunks.
 * The bytes depend on the pixels alone, not on the number of threads.
 */
#ifndef BRUME_HOST_PNG_PACK_H
#define BRUME_HOST_PNG_PACK_H

#include "image_codec.h"
#include "pool.h"

/* 8-bit samples, 1, 3 or 4 (grey, RGB, RGBA) to a pixel; rows `stride` bytes
 * apart. */
struct png_pixels {
    const uint8_t *data;
    size_t width, height, channels, stride;
};

/* Filters and compresses on the pool's threads (NULL: on this one). The
 * receiver frees stream->data. Returns -1 without memory. */
int png_pack(struct pool *pool, const struct png_pixels *pixels,
             struct image_file *stream);

#define PNG_SIGNATURE_BYTES 8
#define PNG_CHUNK_BYTES 12 /* of a chunk besides its data */
#define PNG_IHDR_BYTES 13

/* These return where the next byte goes. */
uint8_t *png_put_be32(uint8_t *p, uint32_t value);
uint8_t *png_put_be16(uint8_t *p, uint32_t value);
uint8_t *png_put_chunk(uint8_t *p, const char *type, const uint8_t *data,
                       size_t size);
/* Signature and IHDR: 8 bits a sample, grey, RGB or RGBA. */
uint8_t *png_put_start(uint8_t *p, size_t width, size_t height,
                       size_t channels);

#endif
