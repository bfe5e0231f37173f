/* SPDX-License-Identifier: MIT */
#include "srgb.h"

#include <math.h>

double srgb_linear(double code)
{
    double v = code / 255;
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

/* By comparison with the values half way between codes: pow is then asked only
 * for 255 fixed numbers, and the last bit of these, in which libraries differ,
 * decides nothing that a float can hold. */
void srgb_encode(const float *linear, uint8_t *out, size_t n)
{
    double half[255];
    for (int i = 0; i < 255; i++)
        half[i] = srgb_linear(i + 0.5);
    for (size_t k = 0; k < n; k++) {
        unsigned code = 0;
        for (unsigned bit = 128; bit != 0; bit >>= 1)
            if ((double)linear[k] >= half[code + bit - 1])
                code += bit;
        out[k] = (uint8_t)code;
    }
}
