/* SPDX-License-Identifier: MIT */
/* From radiance to the bytes of a pixel. */
#include "brume_inner.h"

unsigned brume_pixel_bytes(int pixel_format)
{
    switch (pixel_format) {
    case BRUME_L8: return 1;
    case BRUME_RGB888: return 3;
    case BRUME_RGB565: return 2;
    case BRUME_RGB565_SWAPPED: return 2;
    case BRUME_XRGB8888: return 4;
    case BRUME_L16: return 2;
    case BRUME_RGB161616: return 6;
    default: return 0;
    }
}

int brume_pixels_check(int pixel_format, unsigned w, unsigned h, size_t stride)
{
    unsigned bytes = brume_pixel_bytes(pixel_format);
    if (bytes == 0 || (h > 1 && stride < (size_t)w * bytes))
        return BRUME_ERR_RECT;
    return BRUME_WITH_RGB || pixel_format == BRUME_L8 ||
                   pixel_format == BRUME_L16
               ? BRUME_OK
               : BRUME_ERR_FEATURE;
}

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

/* Code of a linear value by binary search of the 255 thresholds: exact
 * rounding, eight comparisons. */
static uint32_t srgb8(uint32_t linear)
{
    uint32_t code = 0;
    for (uint32_t bit = 128; bit != 0; bit >>= 1)
        if (linear >= brume_srgb_threshold[code + bit - 1u])
            code += bit;
    return code;
}

static uint32_t code8(const struct brume_frame *f, uint32_t linear)
{
    if (f->output == BRUME_SRGB)
        return srgb8(linear);
    return (linear * 255u + 0x8000u) >> 16;
}

static uint32_t code16(const struct brume_frame *f, uint32_t linear)
{
    if (f->output == BRUME_SRGB)
        return srgb8(linear) * 257u;
    return linear - (linear >> 16); /* 65536 -> 65535 */
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
                     uint32_t code[3], int channels)
{
    if (repeats(in, i))
        return;
    for (int c = 0; c < channels; c++)
        code[c] = code8(f, composed(f, &in[i], c));
}

static void pack_l8(const struct brume_frame *f,
                    const struct brume_radiance *in, uint32_t n, uint8_t *dst)
{
    uint32_t code[3] = {0, 0, 0};
    for (uint32_t i = 0; i < n; i++) {
        codes_of(f, in, i, code, 1);
        dst[i] = (uint8_t)code[0];
    }
}

static void pack_rgb888(const struct brume_frame *f,
                        const struct brume_radiance *in, uint32_t n,
                        uint8_t *dst)
{
    uint32_t code[3] = {0, 0, 0};
    for (uint32_t i = 0; i < n; i++, dst += 3) {
        codes_of(f, in, i, code, 3);
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
        codes_of(f, in, i, code, 3);
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
        codes_of(f, in, i, code, 3);
        dst[i] = code[0] << 16 | code[1] << 8 | code[2];
    }
}

static void pack_16(const struct brume_frame *f,
                    const struct brume_radiance *in, uint32_t n, uint16_t *dst,
                    int channels)
{
    for (uint32_t i = 0; i < n; i++)
        for (int c = 0; c < channels; c++)
            *dst++ = (uint16_t)code16(f, composed(f, &in[i], c));
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

void brume_pack_span(const struct brume_frame *frame,
                     const struct brume_radiance *in, uint32_t n,
                     int pixel_format, void *dst)
{
    if (pixel_format == BRUME_L8)
        pack_l8(frame, in, n, dst);
    else if (pixel_format == BRUME_L16)
        pack_16(frame, in, n, dst, 1);
    else if (BRUME_WITH_RGB)
        pack_rgb(frame, in, n, pixel_format, dst);
}
