/* SPDX-License-Identifier: MIT */
/*
 * The PNG reader (PNG specification, second edition). Steps: walk the chunks
 * and join the IDATs, inflate, then per pass undo the row filters and expand
 * the samples to 8 bits, or grey ones to 16.
 */
#include "grey16.h"

#include "deflate.h"

#include <stdlib.h>
#include <string.h>

/* Deflate spends at least a bit and a half on 258 bytes. */
#define MAX_EXPANSION 1032u

enum colour_type { GREY = 0, RGB = 2, PALETTE = 3, GREY_ALPHA = 4, RGBA = 6 };

struct png {
    uint32_t width, height;
    unsigned depth, colour, interlace;
    unsigned samples; /* per pixel, alpha included */
    uint8_t palette[256][3];
    unsigned colours;
    uint8_t *idat; /* all IDAT chunks joined */
    size_t idat_size;
    struct grey16 *deep; /* where samples of 16 bits go; NULL: refused */
    char *err;
    size_t err_size;
};

/* The pixels of a pass: from (x0, y0) on, every dx-th and dy-th. */
struct pass {
    uint8_t x0, y0, dx, dy;
};

static const struct pass whole = {0, 0, 1, 1};
static const struct pass adam7[7] = {
    {0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
    {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2},
};

static uint32_t get_be32(const uint8_t *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 |
           p[3];
}

/// Chunks ///

static int check_format(struct png *png)
{
    static const uint8_t samples[7] = {1, 0, 3, 1, 2, 0, 4};
    unsigned depth = png->depth, colour = png->colour;

    if (png->width == 0 || png->height == 0 || png->width > IMAGE_MAX_SIDE ||
        png->height > IMAGE_MAX_SIDE)
        return image_error(png->err, png->err_size,
                           "PNG size %lu x %lu: each side must be 1 to %d",
                           (unsigned long)png->width,
                           (unsigned long)png->height, IMAGE_MAX_SIDE);
    if (colour > RGBA || samples[colour] == 0)
        return image_error(png->err, png->err_size, "PNG colour type %u",
                           colour);
    if (png->deep != NULL && colour != GREY)
        return image_error(png->err, png->err_size,
                           "PNG of colour type %u, not plain grey", colour);
    if (depth == 16 && png->deep == NULL)
        return image_error(png->err, png->err_size,
                           "PNG with 16 bits per sample: only up to 8 are "
                           "supported");
    if ((depth != 1 && depth != 2 && depth != 4 && depth != 8 && depth != 16) ||
        (depth < 8 && colour != GREY && colour != PALETTE))
        return image_error(png->err, png->err_size,
                           "PNG bit depth %u with colour type %u", depth,
                           colour);
    png->samples = samples[colour];
    return 0;
}

static int read_ihdr(struct png *png, const uint8_t *p, size_t size)
{
    if (size != 13)
        return image_error(png->err, png->err_size,
                           "PNG header of %lu bytes, not 13",
                           (unsigned long)size);
    if (png->width != 0)
        return image_error(png->err, png->err_size, "two PNG headers");
    png->width = get_be32(p);
    png->height = get_be32(p + 4);
    png->depth = p[8];
    png->colour = p[9];
    png->interlace = p[12];
    if (p[10] != 0 || p[11] != 0 || p[12] > 1)
        return image_error(png->err, png->err_size,
                           "PNG compression %u, filter %u, interlace %u", p[10],
                           p[11], p[12]);
    return check_format(png);
}

static int read_plte(struct png *png, const uint8_t *p, size_t size)
{
    if (size == 0 || size % 3 != 0 || size > sizeof png->palette)
        return image_error(png->err, png->err_size, "PNG palette of %lu bytes",
                           (unsigned long)size);
    memcpy(png->palette, p, size);
    png->colours = (unsigned)(size / 3);
    return 0;
}

/* One chunk whose bounds and CRC are good. */
static int read_chunk(struct png *png, const uint8_t *type, const uint8_t *p,
                      size_t size)
{
    if (memcmp(type, "IHDR", 4) == 0)
        return read_ihdr(png, p, size);
    if (png->width == 0)
        return image_error(png->err, png->err_size,
                           "PNG does not start with a header");
    if (memcmp(type, "PLTE", 4) == 0)
        return read_plte(png, p, size);
    if (memcmp(type, "IDAT", 4) == 0) {
        memcpy(png->idat + png->idat_size, p, size);
        png->idat_size += size;
        return 0;
    }
    /* Bit 5 of the first letter: the picture makes sense without it. */
    if ((type[0] & 32) == 0 && memcmp(type, "IEND", 4) != 0)
        return image_error(png->err, png->err_size,
                           "unknown critical PNG chunk %.4s",
                           (const char *)type);
    return 0;
}

static int read_chunks(struct png *png, const uint8_t *data, size_t size)
{
    static const uint8_t signature[8] = {
        0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n',
    };
    const uint8_t *p;
    size_t pos = sizeof signature, length;

    if (size < pos || memcmp(data, signature, pos) != 0)
        return image_error(png->err, png->err_size, "not a PNG file");
    do {
        p = data + pos;
        if (size - pos < 12 || get_be32(p) > size - pos - 12)
            return image_error(png->err, png->err_size,
                               "PNG truncated: chunk at byte %lu does not fit",
                               (unsigned long)pos);
        length = get_be32(p);
        if (get_be32(p + 8 + length) != deflate_crc32(0, p + 4, length + 4))
            return image_error(png->err, png->err_size,
                               "PNG chunk at byte %lu: CRC differs",
                               (unsigned long)pos);
        if (read_chunk(png, p + 4, p + 8, length))
            return -1;
        pos += 12 + length;
    } while (memcmp(p + 4, "IEND", 4) != 0);
    if (png->width == 0 || png->idat_size == 0)
        return image_error(png->err, png->err_size, "PNG without picture");
    if (png->colour == PALETTE && png->colours == 0)
        return image_error(png->err, png->err_size, "PNG without palette");
    return 0;
}

/// Rows ///

static uint8_t paeth(int a, int b, int c)
{
    int pa = abs(b - c), pb = abs(a - c), pc = abs(a + b - 2 * c);

    return (uint8_t)(pa <= pb && pa <= pc ? a : pb <= pc ? b : c);
}

/* Undo one row filter in place: `step` bytes a pixel, `prior` is the row
 * above. Returns -1 for an unknown filter. */
static int unfilter(unsigned filter, uint8_t *row, const uint8_t *prior,
                    size_t size, size_t step)
{
    for (size_t i = 0; i < size; i++) {
        unsigned left = i < step ? 0 : row[i - step], up = prior[i];
        unsigned corner = i < step ? 0 : prior[i - step], guess;
        switch (filter) {
        case 0: return 0;
        case 1: guess = left; break;
        case 2: guess = up; break;
        case 3: guess = (left + up) / 2; break;
        case 4: guess = paeth((int)left, (int)up, (int)corner); break;
        default: return -1;
        }
        row[i] = (uint8_t)((row[i] + guess) & 255u);
    }
    return 0;
}

/* Sample i of a row, not scaled. */
static unsigned get_sample(const struct png *png, const uint8_t *row, size_t i)
{
    size_t bit = i * png->depth;
    unsigned shift = 8u - png->depth - (unsigned)(bit % 8);

    return (unsigned)row[bit / 8] >> shift & ((1u << png->depth) - 1u);
}

/* Pixel x of a row to 8-bit grey or RGB. Returns -1 outside the palette. */
static int expand_pixel(const struct png *png, const uint8_t *row, size_t x,
                        uint8_t *out)
{
    unsigned v;

    if (png->colour == RGB || png->colour == RGBA) {
        memcpy(out, row + x * png->samples, 3);
        return 0;
    }
    v = get_sample(png, row, x * png->samples);
    if (png->colour != PALETTE) {
        *out = (uint8_t)(v * 255u / ((1u << png->depth) - 1u));
        return 0;
    }
    if (v >= png->colours)
        return -1;
    memcpy(out, png->palette[v], 3);
    return 0;
}

/* Pixel x of a grey row to 16 bits: every depth divides 65535. */
static uint16_t expand_grey(const struct png *png, const uint8_t *row, size_t x)
{
    if (png->depth == 16)
        return (uint16_t)(row[2 * x] << 8 | row[2 * x + 1]);
    return (uint16_t)(get_sample(png, row, x) *
                      (65535u / ((1u << png->depth) - 1u)));
}

static uint32_t pass_size(uint32_t size, unsigned start, unsigned step)
{
    return size <= start ? 0 : (size - start + step - 1) / step;
}

static size_t row_bytes(const struct png *png, uint32_t width)
{
    return ((size_t)width * png->samples * png->depth + 7) / 8;
}

/* Inflated bytes of a pass, the filter byte of each row included. */
static uint64_t pass_bytes(const struct png *png, const struct pass *pass)
{
    uint32_t w = pass_size(png->width, pass->x0, pass->dx);
    uint32_t h = pass_size(png->height, pass->y0, pass->dy);

    return w == 0 ? 0 : (uint64_t)h * (1 + row_bytes(png, w));
}

/* The w pixels of an unfiltered row of a pass, to row y of the picture. */
static int expand_row(const struct png *png, const struct pass *pass,
                      const uint8_t *row, uint32_t y, uint32_t w,
                      struct image *image)
{
    size_t n = (size_t)image->channels;
    size_t first = (size_t)y * png->width + pass->x0;

    for (uint32_t x = 0; x < w; x++) {
        size_t at = first + (size_t)x * pass->dx;
        if (png->deep != NULL)
            png->deep->values[at] = expand_grey(png, row, x);
        else if (expand_pixel(png, row, x, image->u8 + at * n))
            return image_error(png->err, png->err_size,
                               "PNG row %lu: colour outside the palette",
                               (unsigned long)y);
    }
    return 0;
}

/* `zeros` stands for the row above the first. */
static int decode_pass(struct png *png, const struct pass *pass, uint8_t *raw,
                       const uint8_t *zeros, struct image *image)
{
    uint32_t w = pass_size(png->width, pass->x0, pass->dx);
    size_t bytes = row_bytes(png, w);
    size_t step = (png->samples * png->depth + 7) / 8;
    const uint8_t *prior = zeros;

    if (w == 0)
        return 0;
    for (uint32_t y = pass->y0; y < png->height; y += pass->dy) {
        if (unfilter(raw[0], raw + 1, prior, bytes, step))
            return image_error(png->err, png->err_size,
                               "PNG row %lu: unknown filter %u",
                               (unsigned long)y, raw[0]);
        if (expand_row(png, pass, raw + 1, y, w, image))
            return -1;
        prior = raw + 1;
        raw += 1 + bytes;
    }
    return 0;
}

static int decode_passes(struct png *png, uint8_t *raw, struct image *image)
{
    uint8_t *zeros = calloc(row_bytes(png, png->width), 1);
    int status = 0;

    if (!zeros)
        return image_error(png->err, png->err_size, "no memory for a row");
    if (!png->interlace)
        status = decode_pass(png, &whole, raw, zeros, image);
    for (int i = 0; png->interlace && i < 7 && status == 0; i++) {
        status = decode_pass(png, &adam7[i], raw, zeros, image);
        raw += pass_bytes(png, &adam7[i]);
    }
    free(zeros);
    return status;
}

/* Inflate into `raw`, then decode into the image. */
static int decode_raw(struct png *png, uint8_t *raw, size_t raw_size,
                      struct image *image)
{
    int grey = png->colour == GREY || png->colour == GREY_ALPHA;
    int error = inflate_zlib(png->idat, png->idat_size, raw, raw_size);

    if (error)
        return image_error(png->err, png->err_size, "PNG picture: %s",
                           inflate_error_text(error));
    if (png->deep != NULL
            ? grey16_new(png->deep, (int)png->width, (int)png->height, png->err,
                         png->err_size)
            : image_new_u8(image, (int)png->width, (int)png->height,
                           grey ? 1 : 3, png->err, png->err_size))
        return -1;
    if (decode_passes(png, raw, image)) {
        image_free(image);
        if (png->deep != NULL)
            grey16_free(png->deep);
        return -1;
    }
    return 0;
}

static int decode_picture(struct png *png, struct image *image)
{
    uint64_t size = 0;
    uint8_t *raw;
    int status;

    for (int i = 0; i < (png->interlace ? 7 : 1); i++)
        size += pass_bytes(png, png->interlace ? &adam7[i] : &whole);
    /* Before a header of a few bytes makes us allocate gigabytes. */
    if (size / MAX_EXPANSION > png->idat_size || size > IMAGE_MAX_BYTES)
        return image_error(
            png->err, png->err_size, "PNG size %lu x %lu: too %s",
            (unsigned long)png->width, (unsigned long)png->height,
            size > IMAGE_MAX_BYTES ? "large" : "few compressed data");
    if (!(raw = malloc((size_t)size)))
        return image_error(png->err, png->err_size, "no memory for the PNG");
    status = decode_raw(png, raw, (size_t)size, image);
    free(raw);
    return status;
}

static int decode_file(const uint8_t *data, size_t size, struct image *image,
                       struct grey16 *deep, char *err, size_t err_size)
{
    struct png *png = calloc(1, sizeof *png);
    int status = -1;

    if (!png)
        return image_error(err, err_size, "no memory for the PNG");
    png->err = err;
    png->err_size = err_size;
    png->deep = deep;
    png->idat = malloc(size + 1);
    if (!png->idat)
        image_error(err, err_size, "no memory for the PNG");
    else if (read_chunks(png, data, size) == 0)
        status = decode_picture(png, image);
    free(png->idat);
    free(png);
    return status;
}

int image_png_decode(const uint8_t *data, size_t size, struct image *image,
                     char *err, size_t err_size)
{
    memset(image, 0, sizeof *image);
    return decode_file(data, size, image, NULL, err, err_size);
}

int grey16_png_decode(const uint8_t *data, size_t size, struct grey16 *picture,
                      char *err, size_t err_size)
{
    struct image none;

    memset(&none, 0, sizeof none);
    memset(picture, 0, sizeof *picture);
    return decode_file(data, size, &none, picture, err, err_size);
}
