/* SPDX-License-Identifier: MIT */
/*
 * Compresses two texts, one for the fixed codes and one for codes of its own,
 * expands them again, and prints size and CRC-32 of each stream: the same line
 * wherever it runs. Status 1 if a text does not come back.
 */
#include "deflate.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SIZE 70000u

/* Bytes of uneven frequency, some of them repeats. */
static void fill(uint8_t *text, size_t size)
{
    uint32_t r = 1;

    for (size_t i = 0; i < size; i++) {
        r = r * 1664525u + 1013904223u;
        text[i] = i % 7 == 0 && i > 100 ? text[i - 99]
                                        : (uint8_t)(r >> 24 & r >> 16 & 63);
    }
}

static int round_trip(const uint8_t *text, size_t size)
{
    static uint8_t back[SIZE];
    size_t packed;
    uint8_t *z = deflate_zlib(text, size, DEFLATE_PLAIN, &packed);
    int error;

    if (!z)
        return 1;
    memset(back, 0, size);
    error = inflate_zlib(z, packed, back, size);
    printf("%zu bytes, %zu packed, CRC %08lx: %s\n", size, packed,
           (unsigned long)deflate_crc32(0, z, packed),
           error                      ? inflate_error_text(error)
           : memcmp(text, back, size) ? "other bytes"
                                      : "comes back");
    free(z);
    return error || memcmp(text, back, size) != 0;
}

int main(void)
{
    static uint8_t text[SIZE];

    fill(text, SIZE);
    return round_trip(text, 40) | round_trip(text, SIZE);
}
