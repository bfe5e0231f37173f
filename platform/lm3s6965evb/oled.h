/* SPDX-License-Identifier: MIT */
/* The 128x64 OLED with 16 greys of the LM3S6965 evaluation board. */
#ifndef BRUME_OLED_H
#define BRUME_OLED_H

#include <stdint.h>

#define OLED_WIDTH 128
#define OLED_HEIGHT 64

void oled_begin(void);

/* Shows whole rows from y on: two pixels a byte, the left in the high half. */
void oled_rows(unsigned y, unsigned rows, const uint8_t *pixels);

#endif
