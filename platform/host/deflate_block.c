/* SPDX-License-Identifier: MIT */
/*
 * Huffman codes and blocks of the compressor. Section numbers are those of
 * RFC 1951.
 */
#include "deflate_block.h"

#include <string.h>

#define LITERALS DEFLATE_LITERALS
#define DISTANCES DEFLATE_DISTANCES
#define LENGTH_CODES DEFLATE_LENGTH_CODES
#define STORED_MAX 65535u
#define END_OF_BLOCK 256

static const uint16_t length_base[29] = {
    3,  4,  5,  6,  7,  8,  9,  10, 11,  13,  15,  17,  19,  23,  27,
    31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258,
};
static const uint8_t length_extra[29] = {
    0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
    2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0,
};
static const uint16_t distance_base[DISTANCES] = {
    1,    2,    3,    4,    5,    7,    9,    13,    17,    25,
    33,   49,   65,   97,   129,  193,  257,  385,   513,   769,
    1025, 1537, 2049, 3073, 4097, 6145, 8193, 12289, 16385, 24577,
};
static const uint8_t distance_extra[DISTANCES] = {
    0, 0, 0, 0, 1, 1, 2, 2,  3,  3,  4,  4,  5,  5,  6,
    6, 7, 7, 8, 8, 9, 9, 10, 10, 11, 11, 12, 12, 13, 13,
};
static const uint8_t length_code_order[LENGTH_CODES] = {
    16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15,
};

/// Bits ///

void deflate_put_bits(struct bit_writer *w, uint32_t value, unsigned count)
{
    w->acc |= (uint64_t)value << w->bits;
    w->bits += count;
    while (w->bits >= 8) {
        w->out[w->size++] = (uint8_t)(w->acc & 255u);
        w->acc >>= 8;
        w->bits -= 8;
    }
}

void deflate_put_align(struct bit_writer *w)
{
    if (w->bits > 0)
        deflate_put_bits(w, 0, 8 - w->bits);
}

static void put_symbol(struct bit_writer *w, const struct code_table *t,
                       unsigned symbol)
{
    deflate_put_bits(w, t->code[symbol], t->length[symbol]);
}

/// Huffman codes ///

/* The symbols in use, by rising frequency, ties by symbol. */
static int sort_symbols(const uint32_t *freq, int count, uint16_t *order)
{
    int used = 0;

    for (int s = 0; s < count; s++) {
        int i = used;
        if (freq[s] == 0)
            continue;
        for (; i > 0 && freq[order[i - 1]] > freq[s]; i--)
            order[i] = order[i - 1];
        order[i] = (uint16_t)s;
        used++;
    }
    return used;
}

/* One level of package-merge: `items` of the level below, paired into
 * packages, merged with the leaves. Weights go back into `weight`, and
 * is_package says which is which. Returns the new number of items. */
static int merge_level(uint32_t *weight, int items, const uint32_t *freq,
                       const uint16_t *order, int used, bool *is_package)
{
    uint32_t merged[2 * LITERALS];
    int leaf = 0, pair = 0, n = 0;

    while (leaf < used || pair + 1 < items) {
        uint32_t w = 0;
        bool package = pair + 1 < items;
        if (package) {
            w = weight[pair] + weight[pair + 1];
            package = leaf >= used || w < freq[order[leaf]];
        }
        is_package[n] = package;
        merged[n++] = package ? w : freq[order[leaf]];
        pair += package ? 2 : 0;
        leaf += package ? 0 : 1;
    }
    memcpy(weight, merged, (size_t)n * sizeof *merged);
    return n;
}

/* Optimal code lengths of at most `limit` bits (Larmore and Hirschberg's
 * package-merge). Fewer than two symbols in use would make an incomplete
 * code, which some decoders refuse, so unused ones are added. */
static void build_lengths(uint32_t *freq, int count, int limit,
                          uint16_t *length)
{
    bool is_package[15][2 * LITERALS];
    uint32_t weight[2 * LITERALS];
    uint16_t order[LITERALS];
    int used, items = 0, take;

    memset(length, 0, (size_t)count * sizeof *length);
    used = sort_symbols(freq, count, order);
    for (int s = 0; used < 2; s++)
        if (freq[s] == 0) {
            freq[s] = 1;
            used = sort_symbols(freq, count, order);
        }
    for (int level = 0; level < limit; level++)
        items =
            merge_level(weight, items, freq, order, used, is_package[level]);
    take = 2 * used - 2;
    for (int level = limit - 1; level >= 0; level--) {
        int leaves = 0;
        for (int i = 0; i < take; i++)
            if (!is_package[level][i])
                length[order[leaves++]]++;
        take = 2 * (take - leaves);
    }
}

static uint16_t reverse_bits(unsigned code, unsigned length)
{
    unsigned r = 0;

    for (; length > 0; length--, code >>= 1)
        r = r << 1 | (code & 1u);
    return (uint16_t)r;
}

/* The canonical code of the lengths already in the table (3.2.2). */
static void assign_codes(struct code_table *t, int count)
{
    unsigned per_length[16] = {0}, next[16] = {0};

    for (int s = 0; s < count; s++)
        per_length[t->length[s]]++;
    per_length[0] = 0;
    for (int l = 1; l < 16; l++)
        next[l] = (next[l - 1] + per_length[l - 1]) << 1;
    for (int s = 0; s < count; s++) {
        unsigned l = t->length[s];
        t->code[s] = l ? reverse_bits(next[l]++, l) : 0;
    }
}

/// Blocks ///

static unsigned distance_symbol(const struct deflate_block *b,
                                unsigned distance)
{
    unsigned x = distance - 1;

    return b->distance_symbol[x < 256 ? x : 256 + (x >> 7)];
}

static unsigned last_used(const uint16_t *length, unsigned count,
                          unsigned least)
{
    while (count > least && length[count - 1] == 0)
        count--;
    return count;
}

static void add_run(struct block_header *h, uint32_t *freq, unsigned symbol,
                    unsigned extra)
{
    h->run[h->runs].symbol = (uint8_t)symbol;
    h->run[h->runs++].extra = (uint8_t)extra;
    freq[symbol]++;
}

/* `run` equal code lengths as symbols 0-15, 16 (repeat), 17 and 18 (zeros). */
static void add_runs(struct block_header *h, uint32_t *freq, unsigned value,
                     unsigned run)
{
    while (value == 0 && run >= 3) {
        unsigned n = run < 138 ? run : 138;
        add_run(h, freq, n < 11 ? 17 : 18, n < 11 ? n - 3 : n - 11);
        run -= n;
    }
    if (run > 0) {
        add_run(h, freq, value, 0);
        run--;
    }
    while (run >= 3) {
        unsigned n = run < 6 ? run : 6;
        add_run(h, freq, 16, n - 3);
        run -= n;
    }
    for (; run > 0; run--)
        add_run(h, freq, value, 0);
}

static unsigned run_extra_bits(unsigned symbol)
{
    return symbol == 16 ? 2 : symbol == 17 ? 3 : symbol == 18 ? 7 : 0;
}

/* Lay out the header of a dynamic block for b->literal and b->distance. */
static void build_header(struct deflate_block *b)
{
    struct block_header *h = &b->header;
    uint32_t freq[LENGTH_CODES] = {0};
    uint16_t all[LITERALS + DISTANCES];
    unsigned total;

    h->runs = 0;
    h->literals = last_used(b->literal.length, LITERALS, 257);
    h->distances = last_used(b->distance.length, DISTANCES, 1);
    total = h->literals + h->distances;
    memcpy(all, b->literal.length, h->literals * sizeof *all);
    memcpy(all + h->literals, b->distance.length, h->distances * sizeof *all);
    for (unsigned i = 0, n; i < total; i += n) {
        for (n = 1; i + n < total && all[i + n] == all[i];)
            n++;
        add_runs(h, freq, all[i], n);
    }
    build_lengths(freq, LENGTH_CODES, 7, h->lengths.length);
    assign_codes(&h->lengths, LENGTH_CODES);
    h->codes = LENGTH_CODES;
    while (h->codes > 4 &&
           h->lengths.length[length_code_order[h->codes - 1]] == 0)
        h->codes--;
    h->cost = 14 + 3 * h->codes;
    for (size_t i = 0; i < h->runs; i++)
        h->cost += h->lengths.length[h->run[i].symbol] +
                   run_extra_bits(h->run[i].symbol);
}

static void put_header(struct bit_writer *w, const struct block_header *h)
{
    deflate_put_bits(w, h->literals - 257, 5);
    deflate_put_bits(w, h->distances - 1, 5);
    deflate_put_bits(w, h->codes - 4, 4);
    for (unsigned i = 0; i < h->codes; i++)
        deflate_put_bits(w, h->lengths.length[length_code_order[i]], 3);
    for (size_t i = 0; i < h->runs; i++) {
        unsigned symbol = h->run[i].symbol;
        put_symbol(w, &h->lengths, symbol);
        deflate_put_bits(w, h->run[i].extra, run_extra_bits(symbol));
    }
}

static void put_tokens(struct deflate_block *b,
                       const struct code_table *literal,
                       const struct code_table *distance)
{
    struct bit_writer *w = &b->bits;

    for (size_t i = 0; i < b->tokens; i++) {
        unsigned length = b->token[i] >> 16;
        unsigned dist = (b->token[i] & 0xFFFFu) + 1, l, d;
        if (length == 0) {
            put_symbol(w, literal, b->token[i]);
            continue;
        }
        l = b->length_symbol[length - DEFLATE_MIN_MATCH];
        d = distance_symbol(b, dist);
        put_symbol(w, literal, 257 + l);
        deflate_put_bits(w, length - length_base[l], length_extra[l]);
        put_symbol(w, distance, d);
        deflate_put_bits(w, dist - distance_base[d], distance_extra[d]);
    }
    put_symbol(w, literal, END_OF_BLOCK);
}

static void put_stored(struct deflate_block *b, bool final)
{
    const uint8_t *p = b->src;
    size_t left = b->span;

    do {
        unsigned n = (unsigned)(left < STORED_MAX ? left : STORED_MAX);
        left -= n;
        deflate_put_bits(&b->bits, final && left == 0, 3);
        deflate_put_align(&b->bits);
        deflate_put_bits(&b->bits, n | (~n & 0xFFFFu) << 16, 32);
        memcpy(b->bits.out + b->bits.size, p, n);
        b->bits.size += n;
        p += n;
    } while (left > 0);
}

/* Bits that the tokens take in the given codes. */
static size_t token_cost(const struct deflate_block *b,
                         const struct code_table *literal,
                         const struct code_table *distance)
{
    size_t cost = 0;

    for (int s = 0; s < LITERALS; s++)
        cost += (size_t)b->literal_freq[s] *
                (literal->length[s] + (s > 256 ? length_extra[s - 257] : 0u));
    for (int s = 0; s < DISTANCES; s++)
        cost += (size_t)b->distance_freq[s] *
                ((unsigned)distance->length[s] + distance_extra[s]);
    return cost;
}

static void reset_block(struct deflate_block *b)
{
    b->tokens = 0;
    b->src += b->span;
    b->span = 0;
    memset(b->literal_freq, 0, sizeof b->literal_freq);
    memset(b->distance_freq, 0, sizeof b->distance_freq);
}

void deflate_block_end(struct deflate_block *b, bool final)
{
    size_t stored, fixed, dynamic;

    b->literal_freq[END_OF_BLOCK] = 1;
    fixed = token_cost(b, &b->fixed_literal, &b->fixed_distance);
    build_lengths(b->literal_freq, LITERALS, 15, b->literal.length);
    build_lengths(b->distance_freq, DISTANCES, 15, b->distance.length);
    assign_codes(&b->literal, LITERALS);
    assign_codes(&b->distance, DISTANCES);
    build_header(b);
    dynamic = b->header.cost + token_cost(b, &b->literal, &b->distance);
    stored = 8 * (b->span + 5 * (b->span / STORED_MAX + 1));
    if (stored <= fixed && stored <= dynamic) {
        put_stored(b, final);
    } else if (fixed <= dynamic) {
        deflate_put_bits(&b->bits, 1u << 1 | final, 3);
        put_tokens(b, &b->fixed_literal, &b->fixed_distance);
    } else {
        deflate_put_bits(&b->bits, 2u << 1 | final, 3);
        put_header(&b->bits, &b->header);
        put_tokens(b, &b->literal, &b->distance);
    }
    reset_block(b);
}

/// Tokens ///

static void add_token(struct deflate_block *b, uint32_t token, unsigned span)
{
    if (b->tokens == DEFLATE_BLOCK_TOKENS)
        deflate_block_end(b, false);
    b->token[b->tokens++] = token;
    b->span += span;
}

void deflate_block_literal(struct deflate_block *b, uint8_t byte)
{
    add_token(b, byte, 1);
    b->literal_freq[byte]++;
}

void deflate_block_match(struct deflate_block *b, struct deflate_match m)
{
    add_token(b, m.length << 16 | (m.distance - 1), m.length);
    b->literal_freq[257u + b->length_symbol[m.length - DEFLATE_MIN_MATCH]]++;
    b->distance_freq[distance_symbol(b, m.distance)]++;
}

void deflate_block_init(struct deflate_block *b, const uint8_t *src,
                        uint8_t *out)
{
    struct code_table *t = &b->fixed_literal;

    b->src = src;
    b->bits.out = out;
    for (unsigned s = 0; s < 29; s++)
        for (unsigned i = 0; i < 1u << length_extra[s]; i++)
            b->length_symbol[length_base[s] - DEFLATE_MIN_MATCH + i] =
                (uint8_t)s;
    for (unsigned s = 0; s < DISTANCES; s++)
        for (unsigned i = 0; i < 1u << distance_extra[s]; i++) {
            unsigned x = distance_base[s] - 1u + i;
            b->distance_symbol[x < 256 ? x : 256 + (x >> 7)] = (uint8_t)s;
        }
    for (int s = 0; s < LITERALS + 2; s++)
        t->length[s] = s < 144 ? 8 : s < 256 ? 9 : s < 280 ? 7 : 8;
    for (int s = 0; s < DISTANCES; s++)
        b->fixed_distance.length[s] = 5;
    assign_codes(t, LITERALS + 2);
    assign_codes(&b->fixed_distance, DISTANCES);
}
