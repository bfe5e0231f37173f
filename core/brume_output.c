/* SPDX-License-Identifier: MIT */
/* From radiance to the bytes of a pixel. */
#include "brume_inner.h"

/// Formats ///

unsigned brume_pixel_bytes(int pixel_format)
{
    /* By enum brume_pixel_format. */
    static const uint8_t k_bytes[] = {
        1,
        3,
        2,
        2,
        4,
        2,
        6,
#if BRUME_WITH_LIGHTING
        1,
        0,
        0,
        0,
        4
#endif
    };
    return (unsigned)pixel_format < sizeof k_bytes ? k_bytes[pixel_format] : 0;
}

#if BRUME_WITH_LIGHTING
unsigned brume_pixel_bits(int pixel_format)
{
    switch (pixel_format) {
    case BRUME_L4: return 4;
    case BRUME_L2: return 2;
    case BRUME_L1: return 1;
    default: return brume_pixel_bytes(pixel_format) * 8u;
    }
}
#endif

size_t brume_row_bytes(int pixel_format, unsigned w)
{
#if BRUME_WITH_LIGHTING
    /* In two parts, as w * bits might not fit. */
    unsigned bits = brume_pixel_bits(pixel_format);
    return (size_t)(w >> 3) * bits + (((w & 7u) * bits + 7u) >> 3);
#else
    return (size_t)w * brume_pixel_bytes(pixel_format);
#endif
}

static bool is_grey(int pixel_format)
{
#if BRUME_WITH_LIGHTING
    if (pixel_format >= BRUME_L4 && pixel_format <= BRUME_L1)
        return true;
#endif
    return pixel_format == BRUME_L8 || pixel_format == BRUME_L16;
}

int brume_room_check(int pixel_format, unsigned w, unsigned h, size_t stride)
{
    size_t row = brume_row_bytes(pixel_format, w);
    if (brume_row_bytes(pixel_format, 1) == 0 || (h > 1 && stride < row))
        return BRUME_ERR_RECT;
#if BRUME_WITH_LIGHTING && !BRUME_WITH_DITHER
    if (pixel_format >= BRUME_RGB332 && pixel_format <= BRUME_L1)
        return BRUME_ERR_FEATURE;
#endif
    return BRUME_WITH_RGB || is_grey(pixel_format) ? BRUME_OK
                                                   : BRUME_ERR_FEATURE;
}

/// Codes ///

/* Over the background's channel c: Q0.16, at most 65536. */
static uint32_t composed(const struct brume_frame *f,
                         const struct brume_radiance *in, int c)
{
    /* 16 + 17 bits: the product of two ones is 2^32 */
    uint32_t behind =
        mul_hi_floor(in->transmittance << 15, f->background[c] << 2);
    uint32_t sum = in->light + ((behind + 1u) >> 1);
    return sum < 0x10000u ? sum : 0x10000u;
}

/* Code of a linear value, at most 65536, exactly rounded: the line between two
 * entries of brume_srgb_start is below the curve by less than a code, so that
 * one of the 255 thresholds decides. */
static uint32_t srgb8(uint32_t linear)
{
    const uint8_t *at = brume_srgb_start;
    uint32_t shift = 8;
    linear -= linear >> 16; /* 65536 has the code of 65535 */
    for (; linear >> shift >= 16u; shift += 2)
        at += 12;
    at += linear >> shift;
    uint32_t part = linear & ((1u << shift) - 1u);
    uint32_t code = at[0] + (((uint32_t)at[1] - at[0]) * part >> shift);
    return code + (linear >= brume_srgb_threshold[code]); /* code < 255 */
}

/* The code of a linear value in 8 bits. `deep`: in 16, or what deep_code makes
 * of it. */
static uint32_t code_of(const struct brume_frame *f, uint32_t linear, bool deep)
{
    if (f->output == BRUME_SRGB)
        return srgb8(linear);
    return deep ? linear - (linear >> 16) /* 65536 -> 65535 */
                : (linear * 255u + 0x8000u) >> 16;
}

/* 16 bits of a code: those of a curve have but eight. */
static uint32_t deep_code(const struct brume_frame *f, uint32_t code)
{
    return f->output == BRUME_LINEAR ? code : code * 257u;
}

/* Is pixel i what the one before it was? Most of a sky is. */
static bool repeats(const struct brume_radiance *in, uint32_t i)
{
    return i > 0 && in[i].light == in[i - 1].light &&
           in[i].transmittance == in[i - 1].transmittance;
}

/* The codes of pixel i; `code` holds those of the one before it. */
static void codes_of(const struct brume_frame *f,
                     const struct brume_radiance *in, uint32_t i,
                     uint32_t code[3], int channels, bool deep)
{
    uint32_t before = 0;
    if (repeats(in, i))
        return;
    for (int c = 0; c < channels; c++) {
        uint32_t linear = composed(f, &in[i], c);
        /* Over a grey background all three are one. */
        code[c] =
            c > 0 && linear == before ? code[c - 1] : code_of(f, linear, deep);
        before = linear;
    }
}

static void pack_l8(const struct brume_frame *f,
                    const struct brume_radiance *in, uint32_t n, uint8_t *dst)
{
    uint32_t code[3] = {0, 0, 0};
    for (uint32_t i = 0; i < n; i++) {
        codes_of(f, in, i, code, 1, false);
        dst[i] = (uint8_t)code[0];
    }
}

static void pack_rgb888(const struct brume_frame *f,
                        const struct brume_radiance *in, uint32_t n,
                        uint8_t *dst)
{
    uint32_t code[3] = {0, 0, 0};
    for (uint32_t i = 0; i < n; i++, dst += 3) {
        codes_of(f, in, i, code, 3, false);
        for (int c = 0; c < 3; c++)
            dst[c] = (uint8_t)code[c];
    }
}

/* An 8-bit code in `top` + 1 levels: round(code * top / 255). */
static uint32_t level(uint32_t code, uint32_t top)
{
    uint32_t n = code * top + 127u;
    return (n + 1u + (n >> 8)) >> 8; /* n / 255, exact below 65536 */
}

static void pack_rgb565(const struct brume_frame *f,
                        const struct brume_radiance *in, uint32_t n,
                        uint16_t *dst, bool swapped)
{
    uint32_t code[3] = {0, 0, 0};
    for (uint32_t i = 0; i < n; i++) {
        codes_of(f, in, i, code, 3, false);
        uint32_t word = level(code[0], 31) << 11 | level(code[1], 63) << 5 |
                        level(code[2], 31);
        if (swapped)
            word = word >> 8 | (word & 0xffu) << 8;
        dst[i] = (uint16_t)word;
    }
}

static void pack_xrgb8888(const struct brume_frame *f,
                          const struct brume_radiance *in, uint32_t n,
                          uint32_t *dst)
{
    uint32_t code[3] = {0, 0, 0};
    for (uint32_t i = 0; i < n; i++) {
        codes_of(f, in, i, code, 3, false);
        dst[i] = code[0] << 16 | code[1] << 8 | code[2];
    }
}

static void pack_16(const struct brume_frame *f,
                    const struct brume_radiance *in, uint32_t n, uint16_t *dst,
                    int channels)
{
    uint32_t code[3] = {0, 0, 0};
    for (uint32_t i = 0; i < n; i++) {
        codes_of(f, in, i, code, channels, true);
        for (int c = 0; c < channels; c++)
            *dst++ = (uint16_t)deep_code(f, code[c]);
    }
}

static void pack_rgb(const struct brume_frame *f,
                     const struct brume_radiance *in, uint32_t n,
                     int pixel_format, void *dst)
{
    switch (pixel_format) {
    case BRUME_RGB888: pack_rgb888(f, in, n, dst); break;
    case BRUME_RGB565: pack_rgb565(f, in, n, dst, false); break;
    case BRUME_RGB565_SWAPPED: pack_rgb565(f, in, n, dst, true); break;
    case BRUME_XRGB8888: pack_xrgb8888(f, in, n, dst); break;
    default: pack_16(f, in, n, dst, 3); break;
    }
}

/// With lighting ///

#if BRUME_WITH_LIGHTING
/* Bits of each channel, by enum brume_pixel_format. */
static const uint8_t k_bits[][3] = {
    {8, 0, 0},    {8, 8, 8}, {5, 6, 5}, {5, 6, 5}, {8, 8, 8}, {16, 0, 0},
    {16, 16, 16}, {3, 3, 2}, {4, 0, 0}, {2, 0, 0}, {1, 0, 0}, {8, 8, 8}};

static bool has_sky(const struct brume_frame *f)
{
#if BRUME_WITH_SKY
    return f->lit.on && f->lit.sky;
#else
    (void)f;
    return false;
#endif
}

static bool has_colour(const struct brume_frame *f)
{
#if BRUME_WITH_COLOUR
    return f->lit.on && f->lit.colour;
#else
    (void)f;
    return false;
#endif
}

static bool has_dither(const struct brume_frame *f)
{
#if BRUME_WITH_DITHER
    return f->lit.on && f->lit.dither;
#else
    (void)f;
    return false;
#endif
}

static uint32_t light_of(const struct brume_frame *f,
                         const struct brume_radiance *in, int c)
{
#if BRUME_WITH_COLOUR
    if (c > 0 && has_colour(f))
        return c == 1 ? in->green : in->blue;
#endif
    (void)f, (void)c;
    return in->light;
}

/* What is behind pixel (x, y), as far as that is to be seen. Q16.16. */
static void behind_of(const struct brume_frame *f,
                      const struct brume_radiance *in, uint32_t x, uint32_t y,
                      int pixel_format, uint32_t out[3])
{
    bool hidden = pixel_format == BRUME_RGBA8888 || in->transmittance == 0;
    for (int c = 0; c < 3; c++)
        out[c] = hidden ? 0 : f->background[c];
#if BRUME_WITH_SKY
    if (!hidden && has_sky(f))
        brume_sky_colour(f, x, y, out);
#else
    (void)x, (void)y;
#endif
}

/* Rec. 709: 0.2126, 0.7152 and 0.0722, together 1, in Q0.32. Grey stays what
 * it is: less than three units of 2^-11 are cut off. */
static uint32_t luma_of(const uint32_t rgb[3])
{
    uint32_t sum = mul_hi_floor(rgb[0] << 11, 913110047u) +
                   mul_hi_floor(rgb[1] << 11, 3071760610u) +
                   mul_hi_floor(rgb[2] << 11, 310096639u);
    return (sum + (1u << 10)) >> 11;
}

/* Light over what is behind: Q16.16, at most 16. */
static void linear_of(const struct brume_frame *f,
                      const struct brume_radiance *in, uint32_t x, uint32_t y,
                      int pixel_format, uint32_t out[3])
{
    behind_of(f, in, x, y, pixel_format, out);
    for (int c = 0; c < 3; c++) {
        /* 17 + 20 bits, of which the first go up to 2^31 */
        uint32_t sum = mul_hi_floor(in->transmittance << 15, out[c] << 12);
        out[c] = light_of(f, in, c) + ((sum + (1u << 10)) >> 11);
    }
    if (has_colour(f) && is_grey(pixel_format))
        out[0] = luma_of(out);
}

#if BRUME_WITH_TONE
static uint32_t filmic8(uint32_t linear)
{
    uint32_t code = 0;
    for (uint32_t bit = 128; bit != 0; bit >>= 1)
        if (linear >= brume_filmic_threshold[code + bit - 1u])
            code += bit;
    return code;
}

/* The curve itself, Q16.16 -> Q0.16: error below 0.7 of 2^-16. With x in
 * hundredths, (251 x^2 + 3 x) / (243 x^2 + 59 x + 14). */
uint32_t brume_filmic(uint32_t x)
{
    x = x < BRUME_MAX_LIGHT ? x : BRUME_MAX_LIGHT;
    /* Q16.16: x * 2^12 <= 2^31, factors < 2^27, sums < 2^30 */
    uint32_t n = mul_hi_floor(x << 12, (251u * x + (3u << 16)) << 4);
    uint32_t d =
        mul_hi_floor(x << 12, (243u * x + (59u << 16)) << 4) + (14u << 16);
    unsigned up = leading_zeros(d);
    n = n < d ? n : d;
    /* Q(16 + up) * 2^63 / Q(16 + up) / 2^32 */
    uint32_t y = mul_hi_floor(n << up, brume_reciprocal(d << up));
    return (y + (1u << 14)) >> 15;
}
#endif

/* Code of a linear value of any size, as code_of. */
static uint32_t tone_of(const struct brume_frame *f, uint32_t linear, bool deep)
{
#if BRUME_WITH_TONE
    if (f->output == BRUME_FILMIC)
        return filmic8(linear);
#endif
    return code_of(f, linear < 0x10000u ? linear : 0x10000u, deep);
}

#if BRUME_WITH_DITHER
/* Linear value of level k of 0 .. top, equally far apart in sRGB; Q0.16. */
static uint32_t level_value(uint32_t k, uint32_t top)
{
    uint32_t v = top == 31   ? brume_srgb_level31[k]
                 : top == 15 ? brume_srgb_level15[k]
                             : brume_srgb_level63[k * (63u / top)];
    return of_sample(v);
}

/* Level of a linear value, Q0.16, so that the mean over all thresholds is the
 * value. */
static uint32_t dithered(const struct brume_frame *f, uint32_t v, uint32_t top,
                         uint32_t threshold)
{
    uint32_t k = 0;
    if (f->output == BRUME_LINEAR) {
        v *= top;
        return (v >> 16) + ((v & 0xffffu) > threshold);
    }
    for (uint32_t bit = (top + 1u) / 2u; bit != 0; bit >>= 1)
        if (v >= level_value(k + bit, top))
            k += bit;
    if (k == top)
        return top;
    uint32_t low = level_value(k, top);
    /* < 2^32: a gap is at most 2^16 */
    uint32_t part = (level_value(k + 1u, top) - low) * threshold >> 16;
    return k + (v - low > part);
}

/* Channels from 8 on are those of dithering. */
static uint32_t dithered_at(const struct brume_frame *f, uint32_t linear,
                            uint32_t top, uint32_t x, uint32_t y, uint32_t c)
{
    uint32_t threshold = 0x8000u;
    if (f->noise != BRUME_NOISE_NONE)
        threshold = brume_noise_value(f->noise, &f->noise_table, x, y, f->frame,
                                      8u + c);
#if BRUME_WITH_TONE
    if (f->output == BRUME_FILMIC)
        return dithered(f, brume_filmic(linear), top, threshold);
#endif
    return dithered(f, linear < 0x10000u ? linear : 0x10000u, top, threshold);
}
#endif

/* The codes of a pixel of these linear values. */
static void quantise(const struct brume_frame *f, const uint32_t linear[3],
                     uint32_t x, uint32_t y, int pixel_format, uint32_t code[3])
{
    for (uint32_t c = 0; c < 3; c++) {
        uint32_t bits = k_bits[pixel_format][c], top = (1u << bits) - 1u;
        if (bits == 0)
            return;
#if BRUME_WITH_DITHER
        if (bits < 8 && has_dither(f)) {
            code[c] = dithered_at(f, linear[c], top, x, y, c);
            continue;
        }
#endif
        code[c] = tone_of(f, linear[c], bits == 16);
        code[c] = bits == 16 ? deep_code(f, code[c]) : level(code[c], top);
    }
    (void)x, (void)y;
}

/* Pixel `x` into its bits; `dst` is the byte of pixel `first`. What is to the
 * right in the byte becomes 0. */
static void put_bits(uint8_t *dst, uint32_t first, uint32_t x, uint32_t bits,
                     uint32_t code)
{
    uint32_t at = (first * bits & 7u) + (x - first) * bits;
    uint32_t byte = code << (8u - bits - (at & 7u));
    if ((at & 7u) != 0)
        byte |= dst[at >> 3];
    dst[at >> 3] = (uint8_t)byte;
}

/* Pixel i of those whose first is in column `first`. RGBA8888 has the
 * light by itself, premultiplied and encoded as the output says: over a linear
 * destination it composes exactly. */
static void put(uint8_t *dst, uint32_t first, uint32_t i, int pixel_format,
                const uint32_t code[3], uint32_t transmittance)
{
    const uint8_t *bits = k_bits[pixel_format];
    uint32_t word = (code[0] << bits[1] | code[1]) << bits[2] | code[2];
    uint8_t *to = dst + i * brume_pixel_bytes(pixel_format);
    switch (pixel_format) {
    case BRUME_RGBA8888:
        to[3] = (uint8_t)(((0x10000u - transmittance) * 255u + 0x8000u) >> 16);
        BRUME_FALLTHROUGH;
    case BRUME_RGB888:
        for (int c = 0; c < 3; c++)
            to[c] = (uint8_t)code[c];
        break;
    case BRUME_RGB565_SWAPPED:
        word = word >> 8 | (word & 0xffu) << 8;
        BRUME_FALLTHROUGH;
    case BRUME_RGB565:
    case BRUME_L16: *(uint16_t *)(void *)to = (uint16_t)word; break;
    case BRUME_RGB161616:
        for (int c = 0; c < 3; c++)
            ((uint16_t *)(void *)to)[c] = (uint16_t)code[c];
        break;
    case BRUME_XRGB8888: *(uint32_t *)(void *)to = word; break;
    case BRUME_L8:
    case BRUME_RGB332: *to = (uint8_t)word; break;
    default: put_bits(dst, first, first + i, bits[0], word); break;
    }
}

/* Has pixel i the linear values of the one before it? */
static bool repeats_all(const struct brume_frame *f,
                        const struct brume_radiance *in, uint32_t i)
{
    if (!repeats(in, i) || (has_sky(f) && in[i].transmittance != 0))
        return false;
#if BRUME_WITH_COLOUR
    if (has_colour(f))
        return in[i].green == in[i - 1].green && in[i].blue == in[i - 1].blue;
#endif
    return true;
}

/* Every format of every scene. With lighting the march takes far longer. */
static void pack_any(const struct brume_frame *f, uint32_t x, uint32_t y,
                     const struct brume_radiance *in, uint32_t n,
                     int pixel_format, void *dst)
{
    uint32_t linear[3] = {0, 0, 0}, code[3] = {0, 0, 0};
    for (uint32_t i = 0; i < n; i++) {
        bool same = repeats_all(f, in, i);
        if (!same)
            linear_of(f, &in[i], x + i, y, pixel_format, linear);
        if (!same || has_dither(f))
            quantise(f, linear, x + i, y, pixel_format, code);
        put(dst, x, i, pixel_format, code, in[i].transmittance);
    }
}
#endif

void brume_pack_span(const struct brume_frame *frame, uint32_t x, uint32_t y,
                     const struct brume_radiance *in, uint32_t n,
                     int pixel_format, void *dst)
{
#if BRUME_WITH_LIGHTING
    if (frame->lit.on || frame->output > BRUME_SRGB ||
        pixel_format > BRUME_RGB161616) {
        pack_any(frame, x, y, in, n, pixel_format, dst);
        return;
    }
#else
    (void)x, (void)y;
#endif
    if (pixel_format == BRUME_L8)
        pack_l8(frame, in, n, dst);
    else if (pixel_format == BRUME_L16)
        pack_16(frame, in, n, dst, 1);
    else if (BRUME_WITH_RGB)
        pack_rgb(frame, in, n, pixel_format, dst);
}
