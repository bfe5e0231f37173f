/* SPDX-License-Identifier: MIT */
/*
 * The zlib expander. Every read of the input goes through need_bits or
 * decode_symbol, every write of the output through put_literal, copy_match or
 * stored_block: those five hold all the bounds checks. Section numbers are
 * those of RFC 1951.
 */
#include "deflate.h"

#include <string.h>

#define FAST_BITS 10 /* codes up to here take one table lookup */
#define MAX_BITS 15
#define LITERALS 288 /* the fixed code has two symbols that are never used */
#define DISTANCES 30
#define LENGTH_CODES 19
#define END_OF_BLOCK 256

struct inflater {
    const uint8_t *src;
    size_t src_size, src_pos;
    uint64_t acc;  /* bits read ahead, the next one lowest */
    unsigned bits; /* how many are real; those above are 0 */
    uint8_t *dst;
    size_t dst_size, dst_pos;
};

/* A canonical code: symbols sorted by code, and how many of each length. */
struct decoder {
    uint16_t fast[1 << FAST_BITS]; /* symbol << 4 | length, 0: a longer code */
    uint16_t count[MAX_BITS + 1];
    uint16_t symbol[LITERALS];
};

const char *inflate_error_text(int error)
{
    switch (error) {
    case INFLATE_OK: return "no error";
    case INFLATE_ERR_HEADER: return "not a zlib stream";
    case INFLATE_ERR_TRUNCATED: return "compressed data end too early";
    case INFLATE_ERR_BLOCK: return "bad block in compressed data";
    case INFLATE_ERR_CODE: return "bad Huffman code in compressed data";
    case INFLATE_ERR_DISTANCE: return "bad distance in compressed data";
    case INFLATE_ERR_TOO_LONG: return "compressed data hold too many bytes";
    case INFLATE_ERR_TOO_SHORT: return "compressed data hold too few bytes";
    case INFLATE_ERR_CHECKSUM: return "Adler-32 of compressed data differs";
    default: return "unknown error";
    }
}

/// Bits ///

/* Read ahead to more than 48 bits, or to the end of the input. */
static void refill(struct inflater *s)
{
    while (s->bits <= 48 && s->src_pos < s->src_size) {
        s->acc |= (uint64_t)s->src[s->src_pos++] << s->bits;
        s->bits += 8;
    }
}

static unsigned take_bits(struct inflater *s, unsigned count)
{
    unsigned value = (unsigned)(s->acc & ((1u << count) - 1u));

    s->acc >>= count;
    s->bits -= count;
    return value;
}

/* At most 16 bits into *value. */
static int need_bits(struct inflater *s, unsigned count, unsigned *value)
{
    if (s->bits < count)
        refill(s);
    if (s->bits < count)
        return INFLATE_ERR_TRUNCATED;
    *value = take_bits(s, count);
    return 0;
}

/// Huffman codes ///

static unsigned reverse_bits(unsigned code, unsigned length)
{
    unsigned r = 0;

    for (; length > 0; length--, code >>= 1)
        r = r << 1 | (code & 1u);
    return r;
}

static void fill_fast(struct decoder *d, unsigned code, unsigned length,
                      unsigned symbol)
{
    unsigned i = reverse_bits(code, length);

    for (; i < 1u << FAST_BITS; i += 1u << length)
        d->fast[i] = (uint16_t)(symbol << 4 | length);
}

/* Over-subscribed codes are refused. So are incomplete ones, except for a
 * lone code of one bit and for no code at all, which 3.2.7 allows for
 * distances; decode_symbol refuses what such a code leaves undefined. */
static int check_counts(const struct decoder *d)
{
    int left = 1; /* codes of the current length still free */
    unsigned used = 0;

    for (int l = 1; l <= MAX_BITS; l++) {
        left = 2 * left - d->count[l];
        used += d->count[l];
        if (left < 0)
            return INFLATE_ERR_CODE;
    }
    if (left > 0 && (used > 1 || used != d->count[1]))
        return INFLATE_ERR_CODE;
    return 0;
}

static int build_decoder(struct decoder *d, const uint8_t *length,
                         unsigned count)
{
    unsigned offset[MAX_BITS + 2] = {0}, code[MAX_BITS + 2] = {0};
    int error;

    memset(d, 0, sizeof *d);
    for (unsigned s = 0; s < count; s++)
        d->count[length[s]]++;
    d->count[0] = 0;
    if ((error = check_counts(d)) != 0)
        return error;
    for (int l = 1; l <= MAX_BITS; l++) {
        offset[l + 1] = offset[l] + d->count[l];
        code[l + 1] = (code[l] + d->count[l]) << 1;
    }
    for (unsigned s = 0; s < count; s++) {
        unsigned l = length[s];
        if (l == 0)
            continue;
        d->symbol[offset[l]++] = (uint16_t)s;
        if (l <= FAST_BITS)
            fill_fast(d, code[l], l, s);
        code[l]++;
    }
    return 0;
}

/* Codes longer than FAST_BITS, bit by bit: `first` is the first code of the
 * current length, `index` its place among the sorted symbols. */
static int decode_slow(struct inflater *s, const struct decoder *d)
{
    int code = 0, first = 0, index = 0;

    for (unsigned l = 1; l <= MAX_BITS; l++) {
        int count = d->count[l];
        code |= (int)(s->acc >> (l - 1) & 1u);
        if (code - first < count) {
            if (s->bits < l)
                return INFLATE_ERR_TRUNCATED;
            take_bits(s, l);
            return d->symbol[index + code - first];
        }
        index += count;
        first = (first + count) << 1;
        code <<= 1;
    }
    return s->bits < MAX_BITS ? INFLATE_ERR_TRUNCATED : INFLATE_ERR_CODE;
}

/* The next symbol, or a negative error. */
static int decode_symbol(struct inflater *s, const struct decoder *d)
{
    unsigned entry;

    if (s->bits < MAX_BITS)
        refill(s);
    entry = d->fast[s->acc & ((1u << FAST_BITS) - 1u)];
    if (entry == 0)
        return decode_slow(s, d);
    if (s->bits < (entry & 15u))
        return INFLATE_ERR_TRUNCATED;
    take_bits(s, entry & 15u);
    return (int)(entry >> 4);
}

/// Blocks ///

static int put_literal(struct inflater *s, int byte)
{
    if (s->dst_pos == s->dst_size)
        return INFLATE_ERR_TOO_LONG;
    s->dst[s->dst_pos++] = (uint8_t)byte;
    return 0;
}

static int copy_match(struct inflater *s, unsigned length, unsigned distance)
{
    uint8_t *to;

    if (distance > s->dst_pos)
        return INFLATE_ERR_DISTANCE;
    if (length > s->dst_size - s->dst_pos)
        return INFLATE_ERR_TOO_LONG;
    to = s->dst + s->dst_pos;
    s->dst_pos += length;
    /* Bytewise and forwards: the match may overlap its own output. */
    for (; length > 0; length--, to++)
        *to = *(to - distance);
    return 0;
}

/* The rest of a match whose length symbol is 257 + symbol (3.2.5). */
static int read_match(struct inflater *s, const struct decoder *distances,
                      int symbol)
{
    unsigned length, distance, extra, more;
    int d, error;

    if (symbol > 28)
        return INFLATE_ERR_CODE;
    extra = symbol < 8 || symbol == 28 ? 0 : (unsigned)symbol / 4 - 1;
    if ((error = need_bits(s, extra, &more)) != 0)
        return error;
    length = symbol == 28 ? 258
             : symbol < 8 ? (unsigned)symbol + 3
                          : 3 + ((4 + (unsigned)symbol % 4) << extra) + more;
    if ((d = decode_symbol(s, distances)) < 0)
        return d;
    if (d >= DISTANCES)
        return INFLATE_ERR_CODE;
    extra = d < 4 ? 0 : (unsigned)d / 2 - 1;
    if ((error = need_bits(s, extra, &more)) != 0)
        return error;
    distance =
        d < 4 ? (unsigned)d + 1 : 1 + ((2 + (unsigned)d % 2) << extra) + more;
    return copy_match(s, length, distance);
}

static int read_symbols(struct inflater *s, const struct decoder *literals,
                        const struct decoder *distances)
{
    for (;;) {
        int error, symbol = decode_symbol(s, literals);
        if (symbol < 0)
            return symbol;
        if (symbol == END_OF_BLOCK)
            return 0;
        if (symbol < END_OF_BLOCK)
            error = put_literal(s, symbol);
        else
            error = read_match(s, distances, symbol - 257);
        if (error)
            return error;
    }
}

/* Drop the bits up to the next byte of the input and give back the bytes
 * that were read ahead. */
static void align_input(struct inflater *s)
{
    s->src_pos -= s->bits / 8;
    s->acc = 0;
    s->bits = 0;
}

static int stored_block(struct inflater *s)
{
    const uint8_t *p;
    size_t length;

    align_input(s);
    if (s->src_size - s->src_pos < 4)
        return INFLATE_ERR_TRUNCATED;
    p = s->src + s->src_pos;
    length = p[0] | (size_t)p[1] << 8;
    if ((length ^ 0xFFFFu) != (p[2] | (size_t)p[3] << 8))
        return INFLATE_ERR_BLOCK;
    s->src_pos += 4;
    if (length > s->src_size - s->src_pos)
        return INFLATE_ERR_TRUNCATED;
    if (length > s->dst_size - s->dst_pos)
        return INFLATE_ERR_TOO_LONG;
    if (length > 0)
        memcpy(s->dst + s->dst_pos, p + 4, length);
    s->src_pos += length;
    s->dst_pos += length;
    return 0;
}

static int fixed_block(struct inflater *s)
{
    struct decoder literals, distances;
    uint8_t length[LITERALS];
    int error;

    for (int i = 0; i < LITERALS; i++)
        length[i] = i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8;
    if ((error = build_decoder(&literals, length, LITERALS)) != 0)
        return error;
    memset(length, 5, 32); /* 30 and 31 complete the code; never valid */
    if ((error = build_decoder(&distances, length, 32)) != 0)
        return error;
    return read_symbols(s, &literals, &distances);
}

/* `total` code lengths, run-length coded in `d` (3.2.7). */
static int read_lengths(struct inflater *s, const struct decoder *d,
                        uint8_t *length, unsigned total)
{
    static const uint8_t extra[3] = {2, 3, 7}, least[3] = {3, 3, 11};

    for (unsigned i = 0; i < total;) {
        unsigned run;
        uint8_t value = 0;
        int error, symbol = decode_symbol(s, d);
        if (symbol < 0)
            return symbol;
        if (symbol < 16) {
            length[i++] = (uint8_t)symbol;
            continue;
        }
        if ((error = need_bits(s, extra[symbol - 16], &run)) != 0)
            return error;
        run += least[symbol - 16];
        if ((symbol == 16 && i == 0) || run > total - i)
            return INFLATE_ERR_CODE;
        if (symbol == 16)
            value = length[i - 1];
        memset(length + i, value, run);
        i += run;
    }
    return 0;
}

static int read_header(struct inflater *s, uint8_t *length, unsigned *literals,
                       unsigned *distances)
{
    static const uint8_t order[LENGTH_CODES] = {
        16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15,
    };
    uint8_t code_length[LENGTH_CODES] = {0};
    struct decoder codes;
    unsigned head, value;
    int error;

    if ((error = need_bits(s, 14, &head)) != 0)
        return error;
    *literals = (head & 31u) + 257;
    *distances = (head >> 5 & 31u) + 1;
    if (*literals > 286 || *distances > DISTANCES)
        return INFLATE_ERR_CODE;
    for (unsigned i = 0; i < (head >> 10) + 4; i++) {
        if ((error = need_bits(s, 3, &value)) != 0)
            return error;
        code_length[order[i]] = (uint8_t)value;
    }
    if ((error = build_decoder(&codes, code_length, LENGTH_CODES)) != 0)
        return error;
    return read_lengths(s, &codes, length, *literals + *distances);
}

static int dynamic_block(struct inflater *s)
{
    struct decoder literals, distances;
    uint8_t length[286 + DISTANCES];
    unsigned n, m;
    int error;

    if ((error = read_header(s, length, &n, &m)) != 0)
        return error;
    if (length[END_OF_BLOCK] == 0)
        return INFLATE_ERR_CODE;
    if ((error = build_decoder(&literals, length, n)) != 0)
        return error;
    if ((error = build_decoder(&distances, length + n, m)) != 0)
        return error;
    return read_symbols(s, &literals, &distances);
}

static int read_block(struct inflater *s, unsigned type)
{
    switch (type) {
    case 0: return stored_block(s);
    case 1: return fixed_block(s);
    case 2: return dynamic_block(s);
    default: return INFLATE_ERR_BLOCK;
    }
}

int inflate_zlib(const uint8_t *src, size_t src_size, uint8_t *dst,
                 size_t dst_size)
{
    struct inflater s = {src, src_size, 2, 0, 0, dst, dst_size, 0};
    const uint8_t *p;
    unsigned head;
    int error;

    if (src_size < 2)
        return INFLATE_ERR_TRUNCATED;
    if ((src[0] & 15) != 8 || src[0] >> 4 > 7 || (src[1] & 32) != 0 ||
        (src[0] * 256 + src[1]) % 31 != 0)
        return INFLATE_ERR_HEADER;
    do {
        if ((error = need_bits(&s, 3, &head)) != 0)
            return error;
        if ((error = read_block(&s, head >> 1)) != 0)
            return error;
    } while ((head & 1u) == 0);
    if (s.dst_pos != dst_size)
        return INFLATE_ERR_TOO_SHORT;
    align_input(&s);
    if (src_size - s.src_pos < 4)
        return INFLATE_ERR_TRUNCATED;
    p = src + s.src_pos;
    if (((uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 |
         p[3]) != deflate_adler32(1, dst, dst_size))
        return INFLATE_ERR_CHECKSUM;
    return 0;
}
