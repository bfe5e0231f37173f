/* SPDX-License-Identifier: MIT */
/*
 * From light to the bytes of pixels: formats, tone curve, sky and dithering
 * against their definitions in double; and the same bytes however an image is
 * cut.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "brume_inner.h"
#include "brume_noise_tables.h"
#include "support/asset_builder.h"
#include "tap.h"

enum { FORMATS = 12 };
#define ONE 65536u
#define GUARD 64 /* bytes on either side of what may be written */
#define MARK 0xa5

static const struct format {
    const char *name;
    unsigned bits;   /* per pixel */
    unsigned top[3]; /* largest code of each channel */
} k_format[FORMATS] = {{"L8", 8, {255, 0, 0}},
                       {"RGB888", 24, {255, 255, 255}},
                       {"RGB565", 16, {31, 63, 31}},
                       {"RGB565 swapped", 16, {31, 63, 31}},
                       {"XRGB8888", 32, {255, 255, 255}},
                       {"L16", 16, {65535, 0, 0}},
                       {"RGB161616", 48, {65535, 65535, 65535}},
                       {"RGB332", 8, {7, 7, 3}},
                       {"L4", 4, {15, 0, 0}},
                       {"L2", 2, {3, 0, 0}},
                       {"L1", 1, {1, 0, 0}},
                       {"RGBA8888", 32, {255, 255, 255}}};

static struct brume_volume s_volume;

static uint32_t s_random = 1;

static uint32_t random_below(uint32_t n)
{
    s_random = s_random * 1664525u + 1013904223u;
    return (uint32_t)((uint64_t)s_random * n >> 32);
}

/* -1 .. 1 */
static double random_real(void)
{
    return random_below(0x80000000u) / (double)0x40000000 - 1;
}

static void *allocate(size_t size)
{
    void *p = malloc(size ? size : 1);
    if (p == NULL)
        abort();
    return p;
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

/// Definitions ///

static double to_srgb(double v)
{
    return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055;
}

static double from_srgb(double v)
{
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static double filmic(double x)
{
    double y = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
    return y < 1 ? y : 1;
}

/* A composed value as it is encoded: linear light up to 1. */
static double shown(int output, double x)
{
    return output == BRUME_FILMIC ? filmic(x) : x < 1 ? x : 1;
}

/* Code of 8 bits. */
static uint32_t code_of(int output, double x)
{
    double v = shown(output, x);
    return (uint32_t)floor(255 * (output == BRUME_LINEAR ? v : to_srgb(v)) +
                           0.5);
}

static uint32_t code16_of(int output, uint32_t x)
{
    if (output != BRUME_LINEAR)
        return 257 * code_of(output, x / 65536.0);
    return x < 65535 ? x : 65535;
}

/* Linear value of a level. */
static double level_of(int output, uint32_t code, uint32_t top)
{
    double v = code / (double)top;
    return output == BRUME_LINEAR ? v : from_srgb(v);
}

/* The codes of pixel i of a row. */
static void codes_at(const uint8_t *row, int format, unsigned i,
                     uint32_t code[3])
{
    const struct format *f = &k_format[format];
    uint16_t half[3] = {0};
    uint32_t word = 0;
    memset(code, 0, 3 * sizeof *code);
    switch (format) {
    case BRUME_RGB888:
    case BRUME_RGBA8888:
        for (unsigned c = 0; c < 3; c++)
            code[c] = row[i * f->bits / 8 + c];
        return;
    case BRUME_RGB161616:
        memcpy(half, row + 6 * i, 6);
        for (unsigned c = 0; c < 3; c++)
            code[c] = half[c];
        return;
    case BRUME_XRGB8888: memcpy(&word, row + 4 * i, 4); break;
    case BRUME_L16:
    case BRUME_RGB565:
        memcpy(half, row + 2 * i, 2);
        word = half[0];
        break;
    case BRUME_RGB565_SWAPPED:
        memcpy(half, row + 2 * i, 2);
        word = (uint32_t)half[0] >> 8 | (half[0] & 255u) << 8;
        break;
    default: /* from the byte's highest bits */
        word = row[i * f->bits / 8];
        word = word >> (8 - f->bits - i * f->bits % 8) & ((1u << f->bits) - 1);
        break;
    }
    for (unsigned c = 3; c-- > 0;) {
        code[c] = word & f->top[c];
        for (unsigned top = f->top[c]; top != 0; top >>= 1)
            word >>= 1;
    }
}

/// Frames ///

/* A lighting of coloured light, sky and dither, or less. */
static struct brume_lighting lighting_of(bool colour, bool sky, bool dither)
{
    struct brume_lighting l = {.sun_colour = {ONE, ONE, ONE},
                               .sky_zenith = {13000, 26000, 65000},
                               .sky_horizon = {90000, 70000, 50000},
                               .sky_ground = {9000, 8000, 7000},
                               .sun_disc = {700000, 600000, 500000},
                               .sun_size = 1u << 20,
                               .sky = sky,
                               .dither = dither};
    if (colour)
        l.sun_colour[2] = ONE / 2;
    return l;
}

static void scene_of(struct brume_scene *s, unsigned w, unsigned h, int output,
                     const struct brume_lighting *lighting)
{
    brume_scene_default(s, &s_volume);
    s->width = (uint16_t)w;
    s->height = (uint16_t)h;
    s->output = (uint8_t)output;
    s->lighting = lighting;
    s->noise = BRUME_NOISE_WHITE;
}

static void frame_of(struct brume_frame *f, const struct brume_scene *s)
{
    int error = brume_begin_frame(f, &s_volume, s);
    if (error) {
        printf("Bail out! %s\n", brume_error_text(error));
        exit(1);
    }
}

/* Light up to 2 and 8, a few runs of equal rays, some of them clear. */
static void random_rays(struct brume_radiance *ray, unsigned n, bool colour)
{
    for (unsigned i = 0; i < n; i++) {
        if (i > 0 && random_below(3) == 0) {
            ray[i] = ray[i - 1];
            if (colour && random_below(4) == 0)
                ray[i].blue ^= 1;
            continue;
        }
        uint32_t most = random_below(8) == 0 ? 8 * ONE : 2 * ONE;
        memset(&ray[i], 0, sizeof ray[i]);
        ray[i].light = random_below(most + 1);
        ray[i].transmittance =
            random_below(4) == 0 ? random_below(2) * ONE : random_below(ONE);
        if (colour) {
            ray[i].green = random_below(most + 1);
            ray[i].blue = random_below(most + 1);
        }
    }
}

/// Formats ///

static void test_sizes(void)
{
    unsigned wrong = 0;
    for (int f = 0; f < FORMATS; f++) {
        unsigned bits = k_format[f].bits;
        wrong += brume_pixel_bytes(f) != bits / 8;
        for (unsigned w = 0; w < 70; w++)
            wrong += brume_row_bytes(f, w) != (w * bits + 7) / 8;
        wrong += brume_row_bytes(f, 16384) != 2048 * bits;
    }
    for (int f = -1; f <= FORMATS; f += FORMATS + 1)
        wrong += brume_pixel_bytes(f) != 0 || brume_row_bytes(f, 9) != 0;
    tap_check(wrong == 0, "bytes of pixels and of rows, of all formats");
}

/* Errors of a rectangle by both functions, or -100 when they differ or dst
 * is touched for all that. */
static int error_of(const struct brume_frame *f, int format, unsigned x,
                    unsigned w, unsigned h, size_t stride)
{
    struct brume_radiance rays[64] = {{0}};
    uint32_t dst[256];
    memset(dst, MARK, sizeof dst);
    int error = brume_pack_rect(f, rays, 16, x, 0, w, h, format, dst, stride);
    if (error != BRUME_OK)
        for (size_t i = 0; i < sizeof dst; i++)
            if (((uint8_t *)dst)[i] != MARK)
                return -100;
    if (brume_render_rect(f, x, 0, w, h, format, dst, stride) != error)
        return -100;
    return error;
}

static void test_errors(void)
{
    struct brume_scene s;
    struct brume_frame f;
    unsigned wrong = 0;
    scene_of(&s, 32, 4, BRUME_SRGB, NULL);
    frame_of(&f, &s);
    for (int format = 0; format < FORMATS; format++) {
        bool few = k_format[format].bits < 8;
        size_t stride = brume_row_bytes(format, 9);
        for (unsigned x = 0; x <= 16; x++)
            wrong += error_of(&f, format, x, 9, 2, stride) !=
                     (few && x % 8 != 0 ? BRUME_ERR_RECT : BRUME_OK);
        wrong += error_of(&f, format, 0, 9, 2, stride - 1) != BRUME_ERR_RECT;
        wrong += error_of(&f, format, 0, 9, 1, 0) != BRUME_OK;
        wrong += error_of(&f, format, 24, 9, 1, stride) != BRUME_ERR_RECT;
        wrong += error_of(&f, format, 0, 9, 5, stride) != BRUME_ERR_RECT;
        wrong += error_of(&f, format, 32, 0, 4, stride) != BRUME_OK;
    }
    wrong += error_of(&f, -1, 0, 9, 2, 99) != BRUME_ERR_RECT;
    wrong += error_of(&f, FORMATS, 0, 9, 2, 99) != BRUME_ERR_RECT;
    tap_check(wrong == 0, "L4, L2 and L1 begin at multiples of 8; rectangles "
                          "and strides that do not fit are refused");
}

/// Cutting ///

enum { CUT_W = 67, CUT_H = 9 };

/* An image in pieces, each packed into a buffer of its own, whose bytes are
 * then put where they belong. */
static bool cut_agrees(const struct brume_frame *f,
                       const struct brume_radiance *rays, int format,
                       const uint8_t *whole, size_t stride)
{
    bool few = k_format[format].bits < 8, good = true;
    uint8_t *piece = allocate(2 * GUARD + stride * CUT_H);
    for (unsigned y = 0, h; y < CUT_H; y += h) {
        h = 1 + random_below(CUT_H - y);
        for (unsigned x = 0, w; x < CUT_W; x += w) {
            w = 1 + random_below(CUT_W - x);
            if (few && x + w < CUT_W)
                w = w / 8 * 8 + 8;
            w = w < CUT_W - x ? w : CUT_W - x;
            size_t bytes = brume_row_bytes(format, w);
            memset(piece, MARK, 2 * GUARD + stride * CUT_H);
            brume_pack_rect(f, rays + y * CUT_W + x, CUT_W, x, y, w, h, format,
                            piece + GUARD, bytes);
            for (unsigned j = 0; j < h; j++)
                good = good && memcmp(piece + GUARD + j * bytes,
                                      whole + (y + j) * stride +
                                          x * k_format[format].bits / 8,
                                      bytes) == 0;
            for (unsigned i = 0; i < GUARD; i++)
                good = good && piece[i] == MARK &&
                       piece[GUARD + h * bytes + i] == MARK;
        }
    }
    free(piece);
    return good;
}

/* A row in spans of a few pixels, as with any BRUME_SPAN. */
static bool spans_agree(const struct brume_frame *f,
                        const struct brume_radiance *rays, int format,
                        const uint8_t *whole, size_t stride, unsigned longest)
{
    uint64_t room[64] = {0};
    uint8_t *row = (uint8_t *)room;
    for (unsigned y = 0; y < CUT_H; y++) {
        for (unsigned x = 0, n; x < CUT_W; x += n) {
            n = 1 + random_below(longest);
            n = n < CUT_W - x ? n : CUT_W - x;
            brume_pack_span(f, x, y, rays + y * CUT_W + x, n, format,
                            row + brume_pixel_offset(format, x));
        }
        if (memcmp(row, whole + y * stride, stride) != 0)
            return false;
    }
    return true;
}

static void test_cuts_of(int output, const struct brume_lighting *lighting,
                         const char *name)
{
    static struct brume_radiance rays[CUT_W * CUT_H];
    static uint64_t room[CUT_W * CUT_H];
    uint8_t *whole = (uint8_t *)room;
    struct brume_scene s;
    struct brume_frame f;
    unsigned cuts = 0, spans = 0;
    scene_of(&s, CUT_W, CUT_H, output, lighting);
    frame_of(&f, &s);
    for (int format = 0; format < FORMATS; format++) {
        size_t stride = brume_row_bytes(format, CUT_W);
        for (int round = 0; round < 20; round++) {
            random_rays(rays, CUT_W * CUT_H, lighting != NULL);
            brume_pack_rect(&f, rays, CUT_W, 0, 0, CUT_W, CUT_H, format, whole,
                            stride);
            cuts += !cut_agrees(&f, rays, format, whole, stride);
            spans += !spans_agree(&f, rays, format, whole, stride,
                                  round < 5 ? 1 : 11);
        }
    }
    tap_check(cuts == 0,
              "%s: rectangles cut anywhere are the whole, and write "
              "nothing else",
              name);
    tap_check(spans == 0, "%s: spans of any length are the whole", name);
}

static void test_cuts(void)
{
    struct brume_lighting all = lighting_of(true, true, true);
    struct brume_lighting grey = lighting_of(false, true, false);
    struct brume_lighting plain = lighting_of(false, false, true);
    test_cuts_of(BRUME_SRGB, NULL, "plain");
    test_cuts_of(BRUME_FILMIC, NULL, "filmic");
    test_cuts_of(BRUME_SRGB, &all, "colour, sky and dither");
    test_cuts_of(BRUME_FILMIC, &grey, "sky, filmic");
    test_cuts_of(BRUME_LINEAR, &plain, "dither, linear");
}

/* The same through the march. */
static void test_render_cuts(void)
{
    static uint64_t room[2][CUT_W * CUT_H];
    uint8_t *whole = (uint8_t *)room[0], *cut = (uint8_t *)room[1];
    struct brume_lighting l = lighting_of(true, true, true);
    struct brume_scene s;
    struct brume_frame f;
    unsigned wrong = 0;
    scene_of(&s, CUT_W, CUT_H, BRUME_SRGB, &l);
    s.light_samples = 2;
    frame_of(&f, &s);
    for (int format = 0; format < FORMATS; format++) {
        size_t stride = brume_row_bytes(format, CUT_W);
        memset(room, 0, sizeof room);
        brume_render_rect(&f, 0, 0, CUT_W, CUT_H, format, whole, stride);
        for (unsigned x = 0; x < CUT_W; x += 24) {
            unsigned w = CUT_W - x < 24 ? CUT_W - x : 24;
            wrong += brume_render_rect(&f, x, 0, w, CUT_H, format,
                                       cut + brume_row_bytes(format, x),
                                       stride) != BRUME_OK;
        }
        wrong += memcmp(whole, cut, stride * CUT_H) != 0;
    }
    tap_check(wrong == 0, "marched in columns of 24 pixels: the same bytes");
}

/* The whole by one call of brume_show_rect, and in columns. */
static unsigned show_cuts_of(const struct brume_frame *f, int format,
                             uint8_t *whole, uint8_t *cut)
{
    size_t stride = brume_row_bytes(format, CUT_W);
    size_t size = brume_work_bytes(f, CUT_W);
    void *work = allocate(size);
    unsigned wrong = 0;
    memset(whole, 0, stride * CUT_H);
    memset(cut, 0, stride * CUT_H);
    wrong += brume_show_rect(f, NULL, 0, 0, CUT_W, CUT_H, format, whole, stride,
                             work, size) != BRUME_OK;
    for (unsigned x = 0; x < CUT_W; x += 24) {
        unsigned w = CUT_W - x < 24 ? CUT_W - x : 24;
        wrong += brume_show_rect(f, NULL, x, 0, w, CUT_H, format,
                                 cut + brume_row_bytes(format, x), stride, work,
                                 size) != BRUME_OK;
    }
    if (k_format[format].bits < 8)
        wrong += brume_show_rect(f, NULL, 4, 0, 8, CUT_H, format, cut, stride,
                                 work, size) != BRUME_ERR_RECT;
    free(work);
    return wrong + (memcmp(whole, cut, stride * CUT_H) != 0);
}

/* Through the last of the passes: as it is, filtered, upsampled. */
static void test_show_cuts(void)
{
    static uint64_t room[3][CUT_W * CUT_H];
    struct brume_lighting l = lighting_of(true, true, true);
    struct brume_scene s;
    struct brume_frame f;
    unsigned wrong = 0, differs = 0;
    scene_of(&s, CUT_W, CUT_H, BRUME_SRGB, &l);
    s.light_samples = 2;
    for (int kind = 0; kind < 3; kind++) {
        s.spatial = kind == 1 ? BRUME_BOX3 : BRUME_SPATIAL_NONE;
        s.resolution = kind == 2 ? BRUME_HALF : BRUME_FULL;
        frame_of(&f, &s);
        for (int format = 0; format < FORMATS; format++) {
            size_t stride = brume_row_bytes(format, CUT_W);
            wrong += show_cuts_of(&f, format, (uint8_t *)room[0],
                                  (uint8_t *)room[1]);
            if (kind != 0)
                continue;
            brume_render_rect(&f, 0, 0, CUT_W, CUT_H, format, room[2], stride);
            differs += memcmp(room[0], room[2], stride * CUT_H) != 0;
        }
    }
    tap_check(wrong == 0, "shown in columns of 24 pixels: the same bytes");
    tap_check(differs == 0, "shown without any pass: what render_rect gives");
}

/// Codes ///

/* One value as a pixel over nothing. */
static void pack_value(const struct brume_frame *f, uint32_t v, int format,
                       uint32_t code[3])
{
    struct brume_radiance in = {.light = v, .green = v, .blue = v};
    uint64_t bytes = 0;
    brume_pack_span(f, 0, 0, &in, 1, format, &bytes);
    codes_at((uint8_t *)&bytes, format, 0, code);
}

/* Every value that light may have. */
static void test_codes_of(int output, const struct brume_lighting *lighting,
                          const char *name)
{
    struct brume_scene s;
    struct brume_frame f;
    unsigned wrong[FORMATS] = {0}, sum = 0;
    scene_of(&s, 8, 8, output, lighting);
    frame_of(&f, &s);
    for (uint32_t v = 0; v <= BRUME_MAX_LIGHT; v++) {
        uint32_t want = code_of(output, v / 65536.0), code[3];
        for (int format = 0; format < FORMATS; format++) {
            /* all at some values, two at all */
            if (format != BRUME_L8 && format != BRUME_L16 && v % 61 != 0)
                continue;
            pack_value(&f, v, format, code);
            for (int c = 0; c < 3; c++) {
                unsigned top = k_format[format].top[c];
                uint32_t w = top == 65535 ? code16_of(output, v)
                                          : (want * top * 2 + 255) / 510;
                wrong[format] += top != 0 && code[c] != w;
            }
        }
    }
    for (int format = 0; format < FORMATS; format++)
        sum += wrong[format];
    tap_check(sum == 0,
              "%s: the nearest code of every light (%u wrong, %u of L8)", name,
              sum, wrong[BRUME_L8]);
}

static void test_codes(void)
{
    struct brume_lighting l = lighting_of(true, false, false);
    test_codes_of(BRUME_FILMIC, NULL, "filmic");
    test_codes_of(BRUME_FILMIC, &l, "filmic with lighting");
    test_codes_of(BRUME_SRGB, &l, "sRGB with lighting");
    test_codes_of(BRUME_LINEAR, &l, "linear with lighting");
}

static void test_filmic_curve(void)
{
    double worst = 0;
    for (uint32_t v = 0; v <= 2 * BRUME_MAX_LIGHT; v++)
        worst =
            larger(worst, fabs(brume_filmic(v) - 65536 * filmic(v / 65536.0)));
    tap_check(worst < 0.7, "the filmic curve within 0.7 of 2^-16 (%.3f)",
              worst);
    tap_check(brume_filmic(~0u) == ONE, "and 1 of anything larger");
}

/// Composition ///

static void test_composition(void)
{
    struct brume_lighting l = lighting_of(true, false, false);
    struct brume_scene s;
    struct brume_frame f;
    unsigned wrong = 0, luma = 0;
    double worst = 0;
    scene_of(&s, 8, 8, BRUME_LINEAR, &l);
    frame_of(&f, &s);
    for (int i = 0; i < 200000; i++) {
        struct brume_radiance in;
        uint16_t got[3];
        uint32_t want[3];
        random_rays(&in, 1, true);
        for (int c = 0; c < 3; c++)
            f.background[c] = random_below(4) ? random_below(ONE + 1) : ONE;
        const uint32_t light[3] = {in.light, in.green, in.blue};
        for (int c = 0; c < 3; c++)
            want[c] = light[c] +
                      (uint32_t)(((uint64_t)in.transmittance * f.background[c] +
                                  0x8000u) >>
                                 16);
        brume_pack_span(&f, 0, 0, &in, 1, BRUME_RGB161616, got);
        for (int c = 0; c < 3; c++)
            wrong += got[c] != (want[c] < 65535 ? want[c] : 65535);
        brume_pack_span(&f, 0, 0, &in, 1, BRUME_L16, got);
        double y = 0.2126 * want[0] + 0.7152 * want[1] + 0.0722 * want[2];
        if (y < 65534)
            worst = larger(worst, fabs(got[0] - y));
        else
            luma += got[0] < 65534;
    }
    tap_check(wrong == 0, "colour: L + T * background of each channel");
    tap_check(luma == 0 && worst < 0.502,
              "grey of colour is Rec. 709 luma, rounded (error %.4f)", worst);
}

/* Dst = rgb + dst * (255 - a) / 255 is what is packed over dst. */
static void test_rgba(void)
{
    struct brume_lighting l = lighting_of(true, true, false);
    struct brume_scene s;
    struct brume_frame f;
    unsigned wrong = 0, far = 0;
    for (int i = 0; i < 3 * 20000; i++) {
        struct brume_radiance in;
        uint8_t got[4], over[3];
        int output = i / 20000;
        if (i % 20000 == 0) {
            l.sky = output != BRUME_LINEAR;
            scene_of(&s, 8, 8, output, &l);
            frame_of(&f, &s);
        }
        random_rays(&in, 1, true);
        const uint32_t light[3] = {in.light, in.green, in.blue};
        brume_pack_span(&f, 0, 0, &in, 1, BRUME_RGBA8888, got);
        brume_pack_span(&f, 0, 0, &in, 1, BRUME_RGB888, over);
        wrong += got[3] != lround(255 * (1 - in.transmittance / 65536.0));
        for (int c = 0; c < 3; c++) {
            wrong += got[c] != code_of(output, light[c] / 65536.0);
            if (output != BRUME_LINEAR || light[c] > ONE / 2 ||
                in.transmittance > ONE / 2)
                continue;
            double there = 255 * (f.background[c] / 65536.0);
            far += fabs(got[c] + there * (255 - got[3]) / 255 - over[c]) > 1.5;
        }
    }
    tap_check(wrong == 0, "RGBA is light without background, and 255 (1 - T)");
    tap_check(far == 0, "and composes to the other formats' pixels");
}

/// Dithering ///

enum { PATCH = 64, PATCH_FRAMES = 16 };

struct noise {
    const char *name;
    int noise;
    const struct brume_noise_table *table;
    double thresholds; /* that it has in so many pixels and frames; 0: random */
};
static const struct noise k_noise[] = {
    {"white", BRUME_NOISE_WHITE, NULL, 0},
    {"bayer8", BRUME_NOISE_BAYER8, NULL, 64},
    {"stbn", BRUME_NOISE_TABLE, &brume_noise_stbn, 256},
    {"fast", BRUME_NOISE_TABLE, &brume_noise_fast, 256},
};
enum { NOISES = sizeof k_noise / sizeof *k_noise };

/* Mean of the linear levels of each channel over patch and frames. */
static void mean_of(const struct brume_scene *scene, uint32_t v, int format,
                    double mean[3])
{
    static struct brume_radiance rays[PATCH * PATCH];
    static uint64_t room[PATCH * PATCH];
    struct brume_scene s = *scene;
    struct brume_frame f;
    size_t stride = brume_row_bytes(format, PATCH);
    double level[3][64];
    for (int c = 0; c < 3; c++)
        for (uint32_t k = 0; k <= k_format[format].top[c]; k++)
            level[c][k] =
                k == 0 ? 0 : level_of(s.output, k, k_format[format].top[c]);
    for (int i = 0; i < PATCH * PATCH; i++)
        rays[i].light = v;
    mean[0] = mean[1] = mean[2] = 0;
    for (s.frame = 0; s.frame < PATCH_FRAMES; s.frame++) {
        frame_of(&f, &s);
        brume_pack_rect(&f, rays, PATCH, 0, 0, PATCH, PATCH, format, room,
                        stride);
        for (unsigned i = 0; i < PATCH * PATCH; i++) {
            uint32_t code[3];
            codes_at((uint8_t *)room + i / PATCH * stride, format, i % PATCH,
                     code);
            for (int c = 0; c < 3; c++)
                mean[c] += level[c][code[c]];
        }
    }
    for (int c = 0; c < 3; c++)
        mean[c] /= PATCH * PATCH * PATCH_FRAMES;
}

/* What a mean may be off: 0.2 of 255; or, where the steps between levels are
 * so wide that the noise's own resolution is coarser, that: half a threshold,
 * or five standard deviations of a random one. */
static double allowed(const struct noise *noise, int output, double want,
                      uint32_t top)
{
    uint32_t k = 0;
    while (k + 1 < top && level_of(output, k + 1, top) <= want)
        k++;
    double low = level_of(output, k, top);
    double gap = level_of(output, k + 1, top) - low, part = (want - low) / gap;
    double own = noise->thresholds > 0 ? gap / (2 * noise->thresholds)
                                       : 5 * gap * sqrt(part * (1 - part)) /
                                             (PATCH * sqrt(PATCH_FRAMES));
    return larger(0.2 / 255, own + 1.0 / ONE);
}

static void test_means_of(const struct noise *noise, int output,
                          const char *name)
{
    static const int k_few[] = {BRUME_RGB565, BRUME_RGB565_SWAPPED,
                                BRUME_RGB332, BRUME_L4,
                                BRUME_L2,     BRUME_L1};
    struct brume_lighting l = lighting_of(false, false, true);
    struct brume_scene s;
    unsigned wrong = 0;
    double worst = 0, worst_deep = 0;
    scene_of(&s, PATCH, PATCH, output, &l);
    s.noise = (uint8_t)noise->noise;
    s.noise_table = noise->table;
    for (int i = 0; i < 12; i++) {
        uint32_t v = i == 0   ? 0
                     : i == 1 ? ONE
                     : i < 6  ? random_below(ONE / 16)
                              : random_below(ONE);
        double want = shown(output, v / 65536.0), mean[3];
        for (size_t n = 0; n < sizeof k_few / sizeof *k_few; n++) {
            mean_of(&s, v, k_few[n], mean);
            for (int c = 0; c < 3; c++) {
                uint32_t top = k_format[k_few[n]].top[c];
                if (top == 0)
                    continue;
                double off = fabs(mean[c] - want);
                wrong += off > allowed(noise, output, want, top);
                worst = larger(worst, off);
                worst_deep = larger(worst_deep, top >= 15 ? off : 0);
            }
        }
    }
    tap_check(wrong == 0,
              "%s, %s: the mean of dithered light is the light (off by %.3f of "
              "255, %.3f with 16 levels and more)",
              noise->name, name, 255 * worst, 255 * worst_deep);
}

static void test_means(void)
{
    for (int n = 0; n < NOISES; n++) {
        test_means_of(&k_noise[n], BRUME_LINEAR, "linear");
        test_means_of(&k_noise[n], BRUME_SRGB, "sRGB");
        test_means_of(&k_noise[n], BRUME_FILMIC, "filmic");
    }
}

/* Without noise, the level whose light is nearest. */
static void test_no_noise(void)
{
    struct brume_lighting l = lighting_of(false, false, true);
    struct brume_scene s;
    struct brume_frame f;
    unsigned wrong = 0;
    for (int output = BRUME_LINEAR; output <= BRUME_FILMIC; output++) {
        scene_of(&s, 8, 8, output, &l);
        s.noise = BRUME_NOISE_NONE;
        frame_of(&f, &s);
        for (uint32_t v = 0; v <= 2 * ONE; v += 7) {
            double want = shown(output, v / 65536.0);
            for (int format = BRUME_RGB332; format <= BRUME_L1; format++) {
                uint32_t code[3], top = k_format[format].top[0];
                pack_value(&f, v, format, code);
                double off = fabs(level_of(output, code[0], top) - want);
                /* the tables' own rounding decides on ties */
                for (uint32_t k = 0; k <= top; k++)
                    wrong +=
                        fabs(level_of(output, k, top) - want) + 3.0 / ONE < off;
            }
        }
    }
    tap_check(wrong == 0, "dithered without noise: the nearest light");
}

/* Noise belongs to the image's pixel, moves by the frame, and differs between
 * channels. */
static void test_noise_place(void)
{
    struct brume_lighting l = lighting_of(false, false, true);
    struct brume_scene s;
    struct brume_frame f;
    unsigned wrong = 0;
    scene_of(&s, 64, 64, BRUME_LINEAR, &l);
    for (int i = 0; i < 4000; i++) {
        unsigned x = random_below(64), y = random_below(64);
        struct brume_radiance in = {.light = random_below(ONE)};
        uint16_t word;
        uint32_t code[3];
        s.frame = random_below(1000);
        frame_of(&f, &s);
        brume_pack_span(&f, x, y, &in, 1, BRUME_RGB565, &word);
        codes_at((uint8_t *)&word, BRUME_RGB565, 0, code);
        for (uint32_t c = 0; c < 3; c++) {
            uint32_t threshold = brume_noise_value(BRUME_NOISE_WHITE, NULL, x,
                                                   y, s.frame, 8 + c);
            uint32_t level = in.light * k_format[BRUME_RGB565].top[c];
            wrong += code[c] != (level >> 16) + ((level & 65535u) > threshold);
        }
    }
    tap_check(wrong == 0, "thresholds: of the pixel, the frame and channels "
                          "8 and on");
}

/// Sky ///

static void cross(double out[3], const double a[3], const double b[3])
{
    for (int i = 0; i < 3; i++)
        out[i] =
            a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void normalise(double v[3])
{
    double length = sqrt(dot(v, v));
    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

static void unit_of(double out[3], const int32_t v[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = v[i];
    normalise(out);
}

/* The ray through the middle of a pixel. */
static void ray_of(double out[3], const struct brume_scene *s, unsigned x,
                   unsigned y)
{
    double ahead[3], up[3], right[3];
    for (int i = 0; i < 3; i++)
        ahead[i] = (double)s->target[i] - s->eye[i];
    normalise(ahead);
    unit_of(up, s->up);
    cross(right, ahead, up);
    normalise(right);
    cross(up, right, ahead);
    double half = tan(s->fov / 65536.0 / 360 * acos(-1));
    double u = half * (2 * x + 1.0 - s->width) / s->height;
    double v = half * (s->height - (2 * y + 1.0)) / s->height;
    for (int i = 0; i < 3; i++)
        out[i] = ahead[i] + u * right[i] + v * up[i];
    normalise(out);
}

/* False near an edge, where a direction's rounding tells: of the disc by a
 * thousandth of its radius and 2^-18, of the ground by 2^-18. */
static bool sky_of(double out[3], const struct brume_scene *s,
                   const double ray[3])
{
    const struct brume_lighting *l = s->lighting;
    const int32_t *z = l->zenith;
    double zenith[3] = {0, 1, 0}, sun[3], off = 0;
    if (z[0] != 0 || z[1] != 0 || z[2] != 0)
        unit_of(zenith, z);
    unit_of(sun, s->sun);
    for (int i = 0; i < 3; i++)
        off += (ray[i] - sun[i]) * (ray[i] - sun[i]);
    double sine = dot(ray, zenith), power = pow(1 - sine, 4);
    double exposure = l->exposure ? l->exposure / 65536.0 : 1;
    double radius = sqrt(2.0 * l->sun_size / 0x1p30); /* as a chord */
    for (int c = 0; c < 3; c++) {
        double v = l->sky_ground[c];
        if (sine >= 0)
            v = l->sky_zenith[c] +
                ((double)l->sky_horizon[c] - l->sky_zenith[c]) * power;
        v = exposure * (v + (sqrt(off) < radius ? l->sun_disc[c] : 0)) / 65536;
        out[c] = v < 8 ? v : 8;
    }
    return fabs(sine) > 0x1p-18 &&
           fabs(sqrt(off) - radius) > 0.001 * radius + 0x1p-18;
}

static void random_vector(int32_t out[3], double size)
{
    for (int i = 0; i < 3; i++)
        out[i] = (int32_t)(size * random_real());
}

/* Any camera that is not nearly parallel to its `up`. */
static void random_view(struct brume_scene *s)
{
    double ahead[3], up[3];
    do {
        random_vector(s->eye, 1000 * 65536.0);
        random_vector(s->target, 1000 * 65536.0);
        random_vector(s->up, 0x1p30);
        for (int i = 0; i < 3; i++)
            ahead[i] = (double)s->target[i] - s->eye[i];
        normalise(ahead);
        unit_of(up, s->up);
    } while (fabs(dot(ahead, up)) > 0.95);
    random_vector(s->sun, 0x1p30);
    s->width = (uint16_t)(1 + random_below(4096));
    s->height = (uint16_t)(1 + random_below(4096));
    s->fov = BRUME_MIN_FOV + random_below(BRUME_MAX_FOV - BRUME_MIN_FOV);
}

static void random_sky(struct brume_lighting *l)
{
    uint32_t most = random_below(4) ? 2 * ONE : 16 * ONE;
    for (int c = 0; c < 3; c++) {
        l->sky_zenith[c] = random_below(most + 1);
        l->sky_horizon[c] = random_below(most + 1);
        l->sky_ground[c] = random_below(most + 1);
        l->sun_disc[c] = random_below(16 * ONE + 1);
    }
    random_vector(l->zenith, random_below(8) ? 0x1p30 : 0);
    l->exposure = random_below(3) ? 256 + random_below(2 * ONE) : 0;
    l->sun_size = random_below(3) ? 1u << random_below(32) : 0;
}

static void test_sky(void)
{
    struct brume_lighting l = lighting_of(false, true, false);
    struct brume_scene s;
    struct brume_frame f;
    unsigned wrong = 0, count = 0, discs = 0, edges = 0;
    double worst = 0;
    scene_of(&s, 8, 8, BRUME_LINEAR, &l);
    for (int n = 0; n < 2000; n++) {
        random_view(&s);
        random_sky(&l);
        frame_of(&f, &s);
        for (int i = 0; i < 50; i++, count++) {
            unsigned x = random_below(s.width), y = random_below(s.height);
            double ray[3], want[3];
            uint32_t got[3];
            ray_of(ray, &s, x, y);
            if (!sky_of(want, &s, ray)) {
                edges++;
                continue;
            }
            brume_sky_colour(&f, x, y, got);
            for (int c = 0; c < 3; c++) {
                double off = fabs(got[c] / 65536.0 - want[c]);
                double part = off / (want[c] * 0x1p-12 + 0x1p-14);
                worst = larger(worst, part);
                wrong += part > 1;
            }
            discs += l.sun_size != 0;
        }
    }
    tap_check(wrong == 0 && edges < count / 50,
              "sky: %u pixels, %u with a disc, within 2^-12 and 2^-14 (%.3f of "
              "that; %u at edges)",
              count, discs, worst, edges);
}

/* What is behind a clear ray is the sky, and nothing is behind a black one. */
static void test_behind(void)
{
    struct brume_lighting l = lighting_of(false, true, false);
    struct brume_scene s;
    struct brume_frame f;
    unsigned wrong = 0;
    scene_of(&s, 64, 48, BRUME_LINEAR, &l);
    frame_of(&f, &s);
    for (unsigned y = 0; y < 48; y++) {
        struct brume_radiance rays[64];
        uint16_t got[3 * 64];
        memset(rays, 0, sizeof rays);
        for (unsigned x = 0; x < 64; x++)
            rays[x].transmittance = x / 16 % 2 * ONE;
        brume_pack_span(&f, 0, y, rays, 64, BRUME_RGB161616, got);
        for (unsigned x = 0; x < 64; x++) {
            uint32_t sky[3];
            brume_sky_colour(&f, x, y, sky);
            for (unsigned c = 0; c < 3; c++) {
                uint32_t want = rays[x].transmittance == 0 ? 0 : sky[c];
                wrong += got[3 * x + c] != (want < 65535 ? want : 65535);
            }
        }
    }
    tap_check(wrong == 0, "the sky is behind the volume, pixel by pixel");
}

/* The disc is where the camera that looks at the sun has it, and as large. */
static void test_disc(void)
{
    struct brume_lighting l = lighting_of(false, true, false);
    struct brume_scene s;
    struct brume_frame f;
    unsigned inside = 0;
    for (int c = 0; c < 3; c++)
        l.sky_zenith[c] = l.sky_horizon[c] = l.sky_ground[c] = 0;
    l.sun_disc[0] = ONE;
    l.sun_size = 11486; /* of the real sun: 0.265 degrees */
    scene_of(&s, 400, 400, BRUME_LINEAR, &l);
    for (int i = 0; i < 3; i++) {
        s.eye[i] = 0;
        s.target[i] = s.sun[i] / 64;
    }
    s.fov = ONE;
    frame_of(&f, &s);
    for (unsigned y = 0; y < 400; y++)
        for (unsigned x = 0; x < 400; x++) {
            uint32_t got[3];
            brume_sky_colour(&f, x, y, got);
            inside += got[0] == ONE;
        }
    double pi = acos(-1), radius = acos(1 - 11486 / 0x1p30);
    double pixel = 2 * tan(pi / 360) / 400;
    double want = pi * radius * radius / (pixel * pixel);
    tap_check(fabs(inside / want - 1) < 0.01,
              "the sun's disc takes %u of %.0f pixels", inside, want);
}

/// Scenes ///

static int error_of_scene(int light, int filter, int output)
{
    struct brume_scene s;
    struct brume_frame f;
    scene_of(&s, 8, 8, output, NULL);
    s.light = (uint8_t)light;
    s.light_samples = 4;
    s.filter = (uint8_t)filter;
    return brume_begin_frame(&f, &s_volume, &s);
}

static void test_scene_kinds(void)
{
    tap_check(
        error_of_scene(BRUME_LOG, BRUME_NEAREST, BRUME_FILMIC) == BRUME_OK &&
            error_of_scene(BRUME_LOG, BRUME_NEAREST, 3) == BRUME_ERR_SCENE &&
            error_of_scene(BRUME_LOG, 3, BRUME_SRGB) == BRUME_ERR_SCENE &&
            error_of_scene(5, BRUME_NEAREST, BRUME_SRGB) == BRUME_ERR_SAMPLES,
        "kinds of light, lookup and output beyond the last are refused");
}

int main(void)
{
    struct density_cloud cloud = {32, 7};
    struct asset_spec spec =
        asset_spec_of(4, 4, 4, BRUME_U8, density_in_cloud, &cloud);
    size_t size;
    uint8_t *asset = asset_build(&spec, &size);
    if (!tap_check(brume_volume_open(&s_volume, asset, size, 0) == BRUME_OK,
                   "a cloud of 32 voxels"))
        return tap_done();
    test_sizes();
    test_errors();
    test_cuts();
    test_render_cuts();
    test_show_cuts();
    test_codes();
    test_filmic_curve();
    test_composition();
    test_rgba();
    test_means();
    test_no_noise();
    test_noise_place();
    test_sky();
    test_behind();
    test_disc();
    test_scene_kinds();
    free(asset);
    return tap_done();
}
