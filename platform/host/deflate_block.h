/* SPDX-License-Identifier: MIT */
/*
 * The Huffman half of the compressor: collects literals and matches, and
 * writes them as blocks of RFC 1951, each stored, with the fixed codes or with
 * its own, whichever is shortest. Private to deflate*.c.
 */
#ifndef BRUME_HOST_DEFLATE_BLOCK_H
#define BRUME_HOST_DEFLATE_BLOCK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define DEFLATE_WINDOW 32768u
#define DEFLATE_MIN_MATCH 3u
#define DEFLATE_MAX_MATCH 258u
#define DEFLATE_LITERALS 286 /* literal/length symbols */
#define DEFLATE_DISTANCES 30
#define DEFLATE_LENGTH_CODES 19 /* symbols of the code for code lengths */
#define DEFLATE_BLOCK_TOKENS 32768u

struct deflate_match {
    unsigned length, distance; /* length 0: none */
};

struct bit_writer {
    uint8_t *out;
    size_t size;
    uint64_t acc;  /* pending bits, the first one lowest */
    unsigned bits; /* how many: below 8 between calls */
};

/* One Huffman code: the codes are bit-reversed, ready for put_bits. The fixed
 * code has two symbols that are never used.
 *
 * A length is as wide as a code for the sake of GCC 12 on AArch64: with a byte,
 * its ivopts makes the address of code[s] of twice that of length[s], less that
 * of the table. The null pointer that is left as base counts as memory of no
 * one else, assign_codes as a function that stores nothing, and calls of it are
 * dropped. With one width both are one pointer and two offsets. */
struct code_table {
    uint16_t code[DEFLATE_LITERALS + 2];
    uint16_t length[DEFLATE_LITERALS + 2];
};

/* The run-length coded code lengths of a dynamic block (3.2.7). */
struct length_run {
    uint8_t symbol, extra;
};

struct block_header {
    struct length_run run[DEFLATE_LITERALS + DEFLATE_DISTANCES];
    size_t runs;
    unsigned literals, distances, codes; /* HLIT + 257, HDIST + 1, HCLEN + 4 */
    struct code_table lengths;
    size_t cost; /* bits */
};

struct deflate_block {
    struct bit_writer bits;
    const uint8_t *src; /* where the source bytes of this block start */
    size_t span;        /* how many its tokens stand for */
    /* A match is length << 16 | distance - 1; a literal is its byte. */
    uint32_t token[DEFLATE_BLOCK_TOKENS];
    size_t tokens;
    uint32_t literal_freq[DEFLATE_LITERALS];
    uint32_t distance_freq[DEFLATE_DISTANCES];
    uint8_t length_symbol[256];   /* by length - 3, counted from 257 */
    uint8_t distance_symbol[512]; /* by distance - 1 below 256, then by
                                     256 + (distance - 1) / 128 */
    struct code_table fixed_literal, fixed_distance, literal, distance;
    struct block_header header;
};

/* The most output that `size` bytes of source can give. All blocks stored is
 * the worst case: about 5 bytes for every DEFLATE_BLOCK_TOKENS of them, and 6
 * bytes of zlib around everything. */
#define DEFLATE_BOUND(size) ((size) + (size) / 1024 + 64)

/* Start on a zeroed block, for the source at src. `out` has DEFLATE_BOUND
 * bytes for it. */
void deflate_block_init(struct deflate_block *b, const uint8_t *src,
                        uint8_t *out);

/* Add the next token. A full block is written first. */
void deflate_block_literal(struct deflate_block *b, uint8_t byte);
void deflate_block_match(struct deflate_block *b, struct deflate_match m);

/* Write the tokens collected, as the last block if `final`, and start the
 * next block. */
void deflate_block_end(struct deflate_block *b, bool final);

/* Write at most 32 bits, the lowest first; fill up the last byte with 0. */
void deflate_put_bits(struct bit_writer *w, uint32_t value, unsigned count);
void deflate_put_align(struct bit_writer *w);

#endif
