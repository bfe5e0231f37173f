/* SPDX-License-Identifier: MIT */
/*
 * Matches: found through hash chains, taken lazily.
 */
#include "deflate_match.h"

#include "deflate.h"

#include <string.h>

#define WINDOW DEFLATE_WINDOW
#define MIN_MATCH DEFLATE_MIN_MATCH
#define MAX_MATCH DEFLATE_MAX_MATCH

/* How hard to look: up to MAX_CHAIN candidates per position, but no more than
 * TRIES per byte, of which SAVED can be kept for later. Rows that repeat have
 * long matches, few searches, and so deep ones; noise, in which there is
 * little to be found (a twentieth of the size), is passed quickly. */
#define MAX_CHAIN 48u
#define TRIES 1u
#define SAVED 256u
#define GOOD_MATCH 16u  /* holding one this long, look a quarter as hard */
#define LAZY_MATCH 32u  /* holding one this long, do not look for better */
#define NICE_MATCH 128u /* stop looking at once */
#define RUN_END 8u      /* of a run of one byte, positions that are entered */
/* A 3-byte match further off costs more bits than its literals. */
#define FAR_MATCH 4096u

/* Little-endian, which compilers make a single load where they can. */
static uint32_t get32(const uint8_t *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 |
           (uint32_t)p[3] << 24;
}

/* Of the shortest match worth taking, so that a chain holds few others. */
static unsigned hash_at(const struct deflate_encoder *e, size_t pos)
{
    const uint8_t *p = e->src + pos;
    uint32_t h;

    if (e->min_match == DEFLATE_FILTERED) {
        h = get32(p) * 0x9E3779B1u;
        h = (h ^ h >> 15 ^ get32(p + 2)) * 0x85EBCA6Bu;
    } else {
        h = (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16;
        h *= 0x9E3779B1u;
    }
    return h >> (32 - DEFLATE_HASH_BITS);
}

static void insert(struct deflate_encoder *e, size_t pos)
{
    unsigned h;

    if (e->end - pos < e->min_match)
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

/* Makes *best the match of pos with the bytes `distance` before it when that
 * is longer than `length`. Returns the longer length. */
static unsigned try_match(const struct deflate_encoder *e, size_t pos,
                          size_t distance, unsigned limit, unsigned length,
                          struct deflate_match *best)
{
    const uint8_t *here = e->src + pos, *there = here - distance;
    unsigned n;

    if (there[length] != here[length])
        return length;
    n = common_length(there, here, limit);
    if (n <= length)
        return length;
    best->length = n;
    best->distance = (unsigned)distance;
    return n;
}

/* The longest match at pos that beats `held` bytes; length 0 if none. The
 * chain holds no position from pos on, so an entry within the window has not
 * been overwritten by the one that shares its slot. */
static struct deflate_match find_match(struct deflate_encoder *e, size_t pos,
                                       unsigned held)
{
    struct deflate_match best = {0, 0};
    size_t left = e->end - pos;
    unsigned limit = left < MAX_MATCH ? (unsigned)left : MAX_MATCH;
    unsigned length = held < e->min_match - 1 ? e->min_match - 1 : held;
    unsigned tries = held >= GOOD_MATCH ? MAX_CHAIN / 4 : MAX_CHAIN;
    uint32_t next;

    if (limit <= length)
        return best;
    for (next = e->head[hash_at(e, pos)];
         next != 0 && tries > 0 && e->tries > 0; tries--, e->tries--) {
        size_t distance = pos - (next - 1);
        if (distance > WINDOW)
            break;
        length = try_match(e, pos, distance, limit, length, &best);
        if (length >= NICE_MATCH || length == limit)
            break;
        next = e->chain[(next - 1) % WINDOW];
    }
    if (best.length == MIN_MATCH && best.distance > FAR_MATCH)
        best.length = 0;
    return best;
}

static void earn(struct deflate_encoder *e, size_t bytes)
{
    e->tries += TRIES * (unsigned)bytes;
    if (e->tries > SAVED)
        e->tries = SAVED;
}

/* Writes a match that starts at pos - 1; returns its end. */
static size_t take_match(struct deflate_encoder *e, size_t pos,
                         struct deflate_match m)
{
    size_t end = pos - 1 + m.length;

    deflate_block_match(&e->block, m);
    earn(e, m.length);
    pos++;
    if (m.distance == 1 && pos + RUN_END < end)
        pos = end - RUN_END; /* a run: one place in it is like another */
    for (; pos < end; pos++)
        insert(e, pos);
    return end;
}

/* Lazy matching: a match is held back one byte, in case the next position
 * has a longer one, and is then preceded by a literal. */
static void compress(struct deflate_encoder *e, size_t pos, bool last)
{
    struct deflate_match held = {0, 0};
    bool pending = false; /* the byte before pos has no token yet */

    while (pos < e->end) {
        struct deflate_match m = {0, 0};
        if (held.length < LAZY_MATCH)
            m = find_match(e, pos, held.length);
        insert(e, pos);
        if (held.length > 0 && m.length <= held.length) {
            pos = take_match(e, pos, held);
            held.length = 0;
            pending = false;
            continue;
        }
        if (pending)
            deflate_block_literal(&e->block, e->src[pos - 1]);
        pending = true;
        held = m;
        pos++;
        earn(e, 1);
    }
    if (pending)
        deflate_block_literal(&e->block, e->src[pos - 1]);
    deflate_block_end(&e->block, last);
}

size_t deflate_piece(struct deflate_encoder *e, const uint8_t *src,
                     size_t start, size_t end, bool last, unsigned min_match,
                     uint8_t *out)
{
    struct bit_writer *bits = &e->block.bits;

    e->src = src;
    e->end = end;
    e->min_match = min_match;
    e->tries = SAVED;
    memset(e->head, 0, sizeof e->head);
    memset(&e->block, 0, sizeof e->block);
    deflate_block_init(&e->block, src + start, out);
    for (size_t i = start > WINDOW ? start - WINDOW : 0; i < start; i++)
        insert(e, i);
    compress(e, start, last);
    if (!last) {
        deflate_put_bits(bits, 0, 3);
        deflate_put_align(bits);
        deflate_put_bits(bits, 0xFFFF0000u, 32);
    }
    deflate_put_align(bits);
    return bits->size;
}
