/* SPDX-License-Identifier: MIT */
#include "panel.h"

#include <string.h>

/* The rest of the core's formats is one of these with its bytes elsewhere, or
 * finer than a PNG here. */
const char panel_names[] = "rgb888 rgb565 rgb332 l8 l4 l2 l1 rgba8888";

static const struct {
    const char *name;
    int format, channels;
} k_panel[] = {
    {"rgb888", BRUME_RGB888, 3}, {"rgb565", BRUME_RGB565, 3},
    {"rgb332", BRUME_RGB332, 3}, {"l8", BRUME_L8, 1},
    {"l4", BRUME_L4, 1},         {"l2", BRUME_L2, 1},
    {"l1", BRUME_L1, 1},         {"rgba8888", BRUME_RGBA8888, 4},
};
#define PANELS (sizeof k_panel / sizeof k_panel[0])

int panel_format(const char *name)
{
    for (size_t i = 0; i < PANELS; i++)
        if (strcmp(k_panel[i].name, name) == 0)
            return k_panel[i].format;
    return -1;
}

int panel_channels(int pixel_format)
{
    for (size_t i = 0; i < PANELS; i++)
        if (k_panel[i].format == pixel_format)
            return k_panel[i].channels;
    return 0;
}

/* A code of 0 .. top as 0 .. 255, rounded. */
static uint8_t widen(unsigned code, unsigned top)
{
    return (uint8_t)((code * 510 + top) / (2 * top));
}

static void expand_565(const uint8_t *from, uint8_t *to)
{
    uint16_t word;
    memcpy(&word, from, sizeof word);
    to[0] = widen(word >> 11, 31);
    to[1] = widen(word >> 5 & 63u, 63);
    to[2] = widen(word & 31u, 31);
}

static void expand_332(const uint8_t *from, uint8_t *to)
{
    to[0] = widen(from[0] >> 5, 7);
    to[1] = widen(from[0] >> 2 & 7u, 7);
    to[2] = widen(from[0] & 3u, 3);
}

/* Premultiplied to straight. */
static void expand_rgba(const uint8_t *from, uint8_t *to)
{
    unsigned alpha = from[3];
    for (int c = 0; c < 3; c++) {
        unsigned v = alpha > 0 ? (from[c] * 255u + alpha / 2) / alpha : 0;
        to[c] = (uint8_t)(v < 255 ? v : 255);
    }
    to[3] = from[3];
}

/* Pixel x of a row of greys of 1, 2 or 4 bits, the first one highest. */
static uint8_t grey_at(const uint8_t *row, size_t x, unsigned bits)
{
    size_t bit = x * bits;
    unsigned top = (1u << bits) - 1u;
    return widen(row[bit / 8] >> (8 - bits - bit % 8) & top, top);
}

static void expand_pixel(int format, const uint8_t *row, size_t x, uint8_t *to)
{
    switch (format) {
    case BRUME_RGB888: memcpy(to, row + 3 * x, 3); break;
    case BRUME_RGB565: expand_565(row + 2 * x, to); break;
    case BRUME_RGB332: expand_332(row + x, to); break;
    case BRUME_RGBA8888: expand_rgba(row + 4 * x, to); break;
    case BRUME_L4: *to = grey_at(row, x, 4); break;
    case BRUME_L2: *to = grey_at(row, x, 2); break;
    case BRUME_L1: *to = grey_at(row, x, 1); break;
    default: *to = row[x]; break;
    }
}

void panel_expand(int pixel_format, const void *from, struct image *to)
{
    size_t width = (size_t)to->width, channels = (size_t)to->channels;
    size_t stride = brume_row_bytes(pixel_format, (unsigned)to->width);
    const uint8_t *row = from;
    uint8_t *out = to->u8;
    for (int y = 0; y < to->height; y++, row += stride)
        for (size_t x = 0; x < width; x++, out += channels)
            expand_pixel(pixel_format, row, x, out);
}
