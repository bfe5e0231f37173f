/* SPDX-License-Identifier: MIT */
/*
 * zlib streams (RFC 1950, RFC 1951) and the two checksums that go with them,
 * for the PNG files of the host programs. All of it works on whole buffers in
 * memory: there is no streaming. The same input gives the same bytes on every
 * host.
 */
#ifndef BRUME_HOST_DEFLATE_H
#define BRUME_HOST_DEFLATE_H

#include "pool.h"

#include <stddef.h>
#include <stdint.h>

/* deflate_zlib: the shortest match worth taking. Text and plain data gain
 * from short matches; rows that went through a PNG filter have so few
 * distinct small values that Huffman coded literals are cheaper. */
#define DEFLATE_PLAIN 3
#define DEFLATE_FILTERED 6

/* What inflate_zlib returns: 0 or one of these. */
enum inflate_error {
    INFLATE_OK = 0,
    INFLATE_ERR_HEADER = -1,    /* not a zlib stream, or a preset dictionary */
    INFLATE_ERR_TRUNCATED = -2, /* the input ends too early */
    INFLATE_ERR_BLOCK = -3,     /* bad block type or stored length */
    INFLATE_ERR_CODE = -4,      /* impossible Huffman code or symbol */
    INFLATE_ERR_DISTANCE = -5,  /* a match reaches before the output */
    INFLATE_ERR_TOO_LONG = -6,  /* more output than the caller expects */
    INFLATE_ERR_TOO_SHORT = -7, /* less output than the caller expects */
    INFLATE_ERR_CHECKSUM = -8   /* Adler-32 differs */
};

/* Checksum of `size` bytes, continued from `crc` (0 at the start): the CRC of
 * PNG, zip and Ethernet. */
uint32_t deflate_crc32(uint32_t crc, const void *data, size_t size);

/* Adler-32 of `size` bytes, continued from `adler` (1 at the start). */
uint32_t deflate_adler32(uint32_t adler, const void *data, size_t size);

/* Compress `size` bytes, less than 2^32 - 1, into one zlib stream.
 * `min_match` is DEFLATE_PLAIN or DEFLATE_FILTERED.
 *
 * Returns the stream in a new buffer, which the caller frees, and its length
 * in *out_size; NULL when memory is short or the input too long. */
uint8_t *deflate_zlib(const uint8_t *src, size_t size, unsigned min_match,
                      size_t *out_size);

/* The same on the threads of a pool (NULL: on this one). */
uint8_t *deflate_zlib_with(struct pool *pool, const uint8_t *src, size_t size,
                           unsigned min_match, size_t *out_size);

/* Expand the zlib stream at the start of src into exactly `dst_size` bytes.
 * Any input is safe: nothing outside the two buffers is read or written. What
 * follows the stream in src is ignored. After an error dst holds a prefix of
 * unknown length.
 *
 * Returns 0 or a negative enum inflate_error. */
int inflate_zlib(const uint8_t *src, size_t src_size, uint8_t *dst,
                 size_t dst_size);

/* A few words for an enum inflate_error, to end a message with. */
const char *inflate_error_text(int error);

#endif
