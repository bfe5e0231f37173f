/* SPDX-License-Identifier: MIT */
/*
 * Pixels of panels back to 8 bits a channel: every code of each format, the
 * order of bits in a byte, rows that end within one, and alpha.
 */
#include "tap.h"

#include "panel.h"

#include <math.h>
#include <string.h>

static char err[256];

static void test_names(void)
{
    char copy[128];
    int count = 0, good = 0;
    strcpy(copy, panel_names);
    for (char *name = strtok(copy, " "); name; name = strtok(NULL, " ")) {
        int format = panel_format(name), channels = panel_channels(format);
        good += format >= 0 && brume_row_bytes(format, 8) > 0 &&
                (channels == 1 || channels == 3 || channels == 4);
        count++;
    }
    tap_check(count == 8 && good == 8, "%d names, each a format of the core",
              count);
    tap_check(panel_format("") < 0 && panel_format("rgb") < 0 &&
                  panel_format("L1") < 0 && panel_format("l1 ") < 0 &&
                  panel_channels(-1) == 0,
              "and no other");
}

/* 0 .. top to 0 .. 255, by rounding. */
static int widened(unsigned code, unsigned top)
{
    return (int)floor(code * 255.0 / top + 0.5);
}

static int wrong_565(void)
{
    struct image image;
    int wrong = 0;
    if (image_new_u8(&image, 1, 1, 3, err, sizeof err) != 0)
        return -1;
    for (unsigned i = 0; i < 65536; i++) {
        uint16_t word = (uint16_t)i;
        panel_expand(BRUME_RGB565, &word, &image);
        wrong += image.u8[0] != widened(i >> 11, 31) ||
                 image.u8[1] != widened(i >> 5 & 63, 63) ||
                 image.u8[2] != widened(i & 31, 31);
    }
    image_free(&image);
    return wrong;
}

static int wrong_332(void)
{
    struct image image;
    int wrong = 0;
    if (image_new_u8(&image, 1, 1, 3, err, sizeof err) != 0)
        return -1;
    for (unsigned i = 0; i < 256; i++) {
        uint8_t byte = (uint8_t)i;
        panel_expand(BRUME_RGB332, &byte, &image);
        wrong += image.u8[0] != widened(i >> 5, 7) ||
                 image.u8[1] != widened(i >> 2 & 7, 7) ||
                 image.u8[2] != widened(i & 3, 3);
    }
    image_free(&image);
    return wrong;
}

static void test_colour(void)
{
    tap_check(wrong_565() == 0, "rgb565: every word");
    tap_check(wrong_332() == 0, "rgb332: every byte");
}

/* Two rows of 11 pixels, which end within a byte. */
static void test_grey(void)
{
    static const uint8_t k_bits[] = {0xb1, 0x5f, 0x00, 0xe0};
    static const uint8_t k_pairs[] = {0x1b, 0xe4, 0x1b, 0xff, 0x00, 0x2a};
    static const uint8_t k_nibbles[] = {0x01, 0x23, 0x45, 0x67, 0x89, 0xaf,
                                        0xfe, 0xdc, 0xba, 0x98, 0x76, 0x5f};
    static const char k_want[3][2][12] = {{"10110001010", "00000000111"},
                                          {"01233210012", "33330000022"},
                                          {"0123456789a", "fedcba98765"}};
    static const int k_format[] = {BRUME_L1, BRUME_L2, BRUME_L4};
    const uint8_t *const from[] = {k_bits, k_pairs, k_nibbles};
    struct image image;
    if (image_new_u8(&image, 11, 2, 1, err, sizeof err) != 0)
        return;
    for (int f = 0; f < 3; f++) {
        int wrong = 0;
        panel_expand(k_format[f], from[f], &image);
        for (int i = 0; i < 22; i++) {
            char c = k_want[f][i / 11][i % 11];
            unsigned code = (unsigned)(c <= '9' ? c - '0' : c - 'a' + 10);
            wrong += image.u8[i] != widened(code, (2u << ((1 << f) - 1)) - 1);
        }
        tap_check(wrong == 0, "l%d: the first pixel highest, rows in bytes",
                  1 << f);
    }
    image_free(&image);
}

/* Over any background a straight pixel gives what a premultiplied one does, to
 * the rounding of both. */
static void test_alpha(void)
{
    struct image image;
    double worst = 0;
    if (image_new_u8(&image, 1, 1, 4, err, sizeof err) != 0)
        return;
    for (unsigned a = 0; a < 256; a++)
        for (unsigned v = 0; v <= a; v++) {
            const uint8_t pixel[4] = {(uint8_t)v, 0, (uint8_t)a, (uint8_t)a};
            panel_expand(BRUME_RGBA8888, pixel, &image);
            double over = image.u8[0] * image.u8[3] / 255.0;
            worst = fmax(worst, fabs(over - v));
            if (image.u8[3] != a || image.u8[1] != 0 ||
                (a > 0 && image.u8[2] != 255))
                worst = 999;
        }
    tap_check(worst <= 0.5, "rgba8888: alpha times colour is what it was, %.3f",
              worst);
    const uint8_t glow[4] = {200, 10, 0, 100};
    panel_expand(BRUME_RGBA8888, glow, &image);
    tap_check(image.u8[0] == 255 && image.u8[1] == 26 && image.u8[3] == 100,
              "light beyond what its alpha can carry is cut off");
    image_free(&image);
}

int main(void)
{
    test_names();
    test_colour();
    test_grey();
    test_alpha();
    return tap_done();
}
