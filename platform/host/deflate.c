/* SPDX-License-Identifier: MIT */
/*
 * zlib streams, of pieces that are compressed one by one: where they are cut
 * depends on the source alone, so the bytes do not depend on the threads.
 */
#include "deflate.h"
#include "deflate_match.h"

#include <stdlib.h>
#include <string.h>

#define PIECE ((size_t)1 << 18)
#define ADLER 65521u

/// Checksum ///

uint32_t deflate_adler32(uint32_t adler, const void *data, size_t size)
{
    const uint8_t *p = data;
    uint32_t a = adler & 0xFFFFu, b = adler >> 16;

    while (size > 0) {
        size_t run = size < 5552 ? size : 5552; /* b < 2^32 up to here */
        size -= run;
        for (; run > 0; run--) {
            a += *p++;
            b += a;
        }
        a %= ADLER;
        b %= ADLER;
    }
    return b << 16 | a;
}

/* Of a text and of the `size` bytes behind it: that of both. */
static uint32_t adler_of_both(uint32_t first, uint32_t second, size_t size)
{
    uint32_t n = (uint32_t)(size % ADLER), a = first & 0xFFFFu;
    uint32_t sum = a + (second & 0xFFFFu) + ADLER - 1;
    uint64_t sums =
        (first >> 16) + (second >> 16) + (uint64_t)n * a + (uint64_t)ADLER - n;

    return (uint32_t)(sums % ADLER) << 16 | sum % ADLER;
}

/// Pieces ///

struct piece {
    uint8_t *data;
    size_t size;
    uint32_t adler;
};

struct job {
    const uint8_t *src;
    size_t size;
    unsigned min_match;
    struct piece *piece;
    unsigned pieces;
    struct deflate_encoder **encoder; /* of each thread, made when needed */
};

/* A piece without data is one for which there was no memory. */
static void compress_piece(void *arg, unsigned task, unsigned worker)
{
    struct job *job = arg;
    struct piece *piece = &job->piece[task];
    bool last = task + 1 == job->pieces;
    size_t start = task * PIECE, end = last ? job->size : start + PIECE;
    struct deflate_encoder **e = &job->encoder[worker];

    if (!*e)
        *e = malloc(sizeof **e);
    piece->data = malloc(DEFLATE_BOUND(end - start));
    if (!*e || !piece->data) {
        free(piece->data);
        piece->data = NULL;
        return;
    }
    piece->size = deflate_piece(*e, job->src, start, end, last, job->min_match,
                                piece->data);
    piece->adler = deflate_adler32(1, job->src + start, end - start);
}

/* The pieces with zlib's header and checksum; NULL without memory. */
static uint8_t *join(const struct job *job, size_t *out_size)
{
    size_t size = 2 + 4, at = 2;
    uint32_t adler = 1;
    uint8_t *out;

    for (unsigned i = 0; i < job->pieces; i++) {
        if (!job->piece[i].data)
            return NULL;
        size += job->piece[i].size;
    }
    if (!(out = malloc(size)))
        return NULL;
    out[0] = 0x78; /* 32 KiB window */
    out[1] = 0x9C; /* default level, multiple of 31 */
    for (unsigned i = 0; i < job->pieces; i++) {
        const struct piece *p = &job->piece[i];
        size_t start = i * PIECE, left = job->size - start;
        memcpy(out + at, p->data, p->size);
        at += p->size;
        adler = adler_of_both(adler, p->adler, left < PIECE ? left : PIECE);
    }
    for (unsigned shift = 32; shift > 0; shift -= 8)
        out[at++] = (uint8_t)(adler >> (shift - 8) & 255u);
    *out_size = size;
    return out;
}

uint8_t *deflate_zlib_with(struct pool *pool, const uint8_t *src, size_t size,
                           unsigned min_match, size_t *out_size)
{
    struct job job = {src, size, DEFLATE_FILTERED, NULL, 1, NULL};
    unsigned threads = pool_threads(pool);
    uint8_t *out = NULL;

    if (size >= UINT32_MAX)
        return NULL;
    if (min_match <= DEFLATE_MIN_MATCH)
        job.min_match = DEFLATE_PLAIN;
    if (size > PIECE)
        job.pieces = (unsigned)((size + PIECE - 1) / PIECE);
    job.piece = calloc(job.pieces, sizeof *job.piece);
    job.encoder = calloc(threads, sizeof *job.encoder);
    if (job.piece && job.encoder) {
        pool_run(pool, compress_piece, &job, job.pieces);
        out = join(&job, out_size);
    }
    for (unsigned i = 0; job.piece && i < job.pieces; i++)
        free(job.piece[i].data);
    for (unsigned i = 0; job.encoder && i < threads; i++)
        free(job.encoder[i]);
    free(job.piece);
    free(job.encoder);
    return out;
}

uint8_t *deflate_zlib(const uint8_t *src, size_t size, unsigned min_match,
                      size_t *out_size)
{
    return deflate_zlib_with(NULL, src, size, min_match, out_size);
}
