/* SPDX-License-Identifier: MIT */
/* The OLED of the LM3S6965 board on a host: a picture file, oled.pgm. */
#include <stdio.h>
#include <stdlib.h>

#include "lm3s6965evb/oled.h"

static FILE *s_file;

static void fail(void)
{
    fputs("cannot write oled.pgm\n", stderr);
    exit(EXIT_FAILURE);
}

void oled_begin(void)
{
    s_file = fopen("oled.pgm", "wb");
    if (s_file == NULL ||
        fprintf(s_file, "P5\n%d %d\n15\n", OLED_WIDTH, OLED_HEIGHT) < 0)
        fail();
}

void oled_rows(unsigned y, unsigned rows, const uint8_t *pixels)
{
    for (unsigned i = 0; i < rows * (OLED_WIDTH / 2); i++) {
        putc(pixels[i] >> 4, s_file);
        putc(pixels[i] & 15, s_file);
    }
    if (ferror(s_file) || (y + rows == OLED_HEIGHT && fclose(s_file) != 0))
        fail();
}
