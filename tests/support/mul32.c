/* SPDX-License-Identifier: MIT */
/*
 * The fixed-point operations as a core without a 32x32 -> 64 bit product
 * compiles them, whatever this machine has.
 */
#undef BRUME_MUL64
#define BRUME_MUL64 0
#include "brume_fixed.h"

#include "mul32.h"

uint32_t mul32_hi_floor(uint32_t a, uint32_t b)
{
    return mul_hi_floor(a, b);
}

int32_t mul32_signed_round(int32_t a, uint32_t b, unsigned up)
{
    return mul_signed_round(a, b, up);
}

bool mul32_product_less(int32_t a, int32_t b, int32_t c, int32_t d)
{
    return product_less(a, b, c, d);
}
