/* SPDX-License-Identifier: MIT */
/*
 * Checksums, and the LZ77 half of the compressor: matches found through hash
 * chains, taken lazily.
 */
#include "deflate.h"
#include "deflate_block.h"

#include <stdlib.h>
#include <string.h>

#define WINDOW DEFLATE_WINDOW
#define MIN_MATCH DEFLATE_MIN_MATCH
#define MAX_MATCH DEFLATE_MAX_MATCH
#define HASH_BITS 15

/* How hard to look: comparable with level 6 of zlib. */
#define MAX_CHAIN 48u   /* candidates tried per position */
#define GOOD_MATCH 16u  /* holding one this long, look a quarter as hard */
#define LAZY_MATCH 32u  /* holding one this long, do not look for better */
#define NICE_MATCH 128u /* stop looking at once */
/* A 3-byte match further off costs more bits than its literals. */
#define FAR_MATCH 4096u

struct encoder {
    const uint8_t *src;
    size_t size;
    unsigned min_match;
    uint32_t head[1u << HASH_BITS]; /* newest position + 1, 0 for none */
    uint32_t chain[WINDOW];         /* the one before, same convention */
    struct deflate_block block;
};

/// Checksums ///

/* Four bytes a step: table k advances the CRC of a byte by k more bytes. */
static void crc32_tables(uint32_t table[4][256])
{
    for (uint32_t i = 0; i < 256; i++) {
        uint32_t c = i;
        for (int k = 0; k < 8; k++)
            c = (c >> 1) ^ (0xEDB88320u & (0u - (c & 1u)));
        table[0][i] = c;
    }
    for (int k = 1; k < 4; k++)
        for (int i = 0; i < 256; i++) {
            uint32_t c = table[k - 1][i];
            table[k][i] = (c >> 8) ^ table[0][c & 255u];
        }
}

uint32_t deflate_crc32(uint32_t crc, const void *data, size_t size)
{
    const uint8_t *p = data;
    uint32_t table[4][256]; /* on the stack: no shared state to race on */

    crc32_tables(table);
    crc = ~crc;
    for (; size >= 4; size -= 4, p += 4) {
        crc ^= (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 |
               (uint32_t)p[3] << 24;
        crc = table[3][crc & 255u] ^ table[2][crc >> 8 & 255u] ^
              table[1][crc >> 16 & 255u] ^ table[0][crc >> 24];
    }
    for (; size > 0; size--)
        crc = (crc >> 8) ^ table[0][(crc ^ *p++) & 255u];
    return ~crc;
}

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
        a %= 65521u;
        b %= 65521u;
    }
    return b << 16 | a;
}

/// Matches ///

/* Of the shortest match worth taking, so that a chain holds few others. */
static unsigned hash_at(const struct encoder *e, size_t pos)
{
    const uint8_t *p = e->src + pos;
    uint32_t v = (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16;
    uint32_t h = v * 0x9E3779B1u;

    if (e->min_match == DEFLATE_FILTERED) {
        v = (uint32_t)p[3] | (uint32_t)p[4] << 8 | (uint32_t)p[5] << 16;
        h = (h ^ h >> 15 ^ v) * 0x85EBCA6Bu;
    }
    return h >> (32 - HASH_BITS);
}

static void insert(struct encoder *e, size_t pos)
{
    unsigned h;

    if (e->size - pos < e->min_match)
        return;
    h = hash_at(e, pos);
    e->chain[pos % WINDOW] = e->head[h];
    e->head[h] = (uint32_t)pos + 1;
}

static unsigned common_length(const uint8_t *a, const uint8_t *b,
                              unsigned limit)
{
    unsigned n = 0;

    while (n + 8 <= limit && memcmp(a + n, b + n, 8) == 0)
        n += 8;
    while (n < limit && a[n] == b[n])
        n++;
    return n;
}

/* The longest match at pos that beats `held` bytes; length 0 if none. The
 * chain holds no position from pos on, so an entry within the window has not
 * been overwritten by the one that shares its slot. */
static struct deflate_match find_match(const struct encoder *e, size_t pos,
                                       unsigned held)
{
    struct deflate_match best = {0, 0};
    const uint8_t *here = e->src + pos;
    size_t left = e->size - pos;
    unsigned limit = left < MAX_MATCH ? (unsigned)left : MAX_MATCH;
    unsigned length = held < e->min_match - 1 ? e->min_match - 1 : held;
    unsigned tries = held >= GOOD_MATCH ? MAX_CHAIN / 4 : MAX_CHAIN;
    uint32_t next;

    if (limit <= length)
        return best;
    for (next = e->head[hash_at(e, pos)]; next != 0 && tries > 0; tries--) {
        const uint8_t *there = e->src + (next - 1);
        size_t distance = pos - (next - 1);
        if (distance > WINDOW)
            break;
        if (there[length] == here[length]) {
            unsigned n = common_length(there, here, limit);
            if (n > length) {
                length = n;
                best.length = n;
                best.distance = (unsigned)distance;
                if (n >= NICE_MATCH || n == limit)
                    break;
            }
        }
        next = e->chain[(next - 1) % WINDOW];
    }
    if (best.length == MIN_MATCH && best.distance > FAR_MATCH)
        best.length = 0;
    return best;
}

/* Lazy matching: a match is held back one byte, in case the next position
 * has a longer one, and is then preceded by a literal. */
static void compress(struct encoder *e)
{
    struct deflate_match held = {0, 0};
    bool pending = false; /* the byte before pos has no token yet */
    size_t pos = 0;

    while (pos < e->size) {
        struct deflate_match m = {0, 0};
        if (held.length < LAZY_MATCH)
            m = find_match(e, pos, held.length);
        insert(e, pos);
        if (held.length > 0 && m.length <= held.length) {
            size_t end = pos - 1 + held.length;
            deflate_block_match(&e->block, held);
            for (pos++; pos < end; pos++)
                insert(e, pos);
            held.length = 0;
            pending = false;
            continue;
        }
        if (pending)
            deflate_block_literal(&e->block, e->src[pos - 1]);
        pending = true;
        held = m;
        pos++;
    }
    if (pending)
        deflate_block_literal(&e->block, e->src[pos - 1]);
    deflate_block_end(&e->block, true);
}

uint8_t *deflate_zlib(const uint8_t *src, size_t size, unsigned min_match,
                      size_t *out_size)
{
    struct encoder *e;
    struct bit_writer *bits;
    uint32_t adler;
    uint8_t *out;

    if (size >= UINT32_MAX || !(e = calloc(1, sizeof *e)))
        return NULL;
    if (!(out = malloc(DEFLATE_BOUND(size)))) {
        free(e);
        return NULL;
    }
    e->src = src;
    e->size = size;
    e->min_match = min_match <= MIN_MATCH ? DEFLATE_PLAIN : DEFLATE_FILTERED;
    bits = &e->block.bits;
    deflate_block_init(&e->block, src, out);
    deflate_put_bits(bits, 0x9C78, 16); /* 32 KiB window, default level */
    compress(e);
    deflate_put_align(bits);
    adler = deflate_adler32(1, src, size);
    for (unsigned shift = 32; shift > 0; shift -= 8)
        deflate_put_bits(bits, adler >> (shift - 8) & 255u, 8);
    *out_size = bits->size;
    free(e);
    return out;
}
