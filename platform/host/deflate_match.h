/* SPDX-License-Identifier: MIT */
/*
 * The LZ77 half of the compressor, over one piece of the source. Private to
 * deflate*.c.
 */
#ifndef BRUME_HOST_DEFLATE_MATCH_H
#define BRUME_HOST_DEFLATE_MATCH_H

#include "deflate_block.h"

#define DEFLATE_HASH_BITS 15

/* 0.4 MiB; may be used again and again. */
struct deflate_encoder {
    const uint8_t *src;
    size_t end; /* of the piece */
    unsigned min_match;
    unsigned tries; /* candidates that may be looked at */
    uint32_t head[1u << DEFLATE_HASH_BITS]; /* newest position + 1; 0: none */
    uint32_t chain[DEFLATE_WINDOW];         /* the one before, the same way */
    struct deflate_block block;
};

/* Compresses src[start .. end - 1] into out, which has DEFLATE_BOUND bytes for
 * it. Matches reach back before start. The last piece ends the stream; others
 * end with an empty stored block, at a byte's end. Returns the bytes written.
 */
size_t deflate_piece(struct deflate_encoder *e, const uint8_t *src,
                     size_t start, size_t end, bool last, unsigned min_match,
                     uint8_t *out);

#endif
