/* SPDX-License-Identifier: MIT */
/*
 * brume_fixed.h with BRUME_MUL64 = 0, to be compared with the other form.
 */
#ifndef BRUME_TESTS_MUL32_H
#define BRUME_TESTS_MUL32_H

#include <stdbool.h>
#include <stdint.h>

uint32_t mul32_hi_floor(uint32_t a, uint32_t b);
int32_t mul32_signed_round(int32_t a, uint32_t b, unsigned up);
bool mul32_product_less(int32_t a, int32_t b, int32_t c, int32_t d);

#endif
