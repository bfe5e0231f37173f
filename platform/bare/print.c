/* SPDX-License-Identifier: MIT */
/* Numbers as text, without division: one of 64 bits would be the largest
 * function of the smallest program. */
#include "print.h"

#include "target.h"

static uint64_t power_of_ten(int exponent)
{
    uint64_t power = 1;
    while (exponent-- > 0)
        power *= 10u;
    return power;
}

void print_number(uint64_t number)
{
    char text[21], *to = text;
    for (int place = 19; place >= 0; place--) {
        uint64_t power = power_of_ten(place);
        char digit = '0';
        while (number >= power) {
            number -= power;
            digit++;
        }
        if (digit != '0' || to != text || place == 0)
            *to++ = digit;
    }
    *to = '\0';
    target_write(text);
}

void print_hex(uint32_t number)
{
    static const char k_digits[] = "0123456789abcdef";
    char text[11] = "0x";
    for (int i = 0; i < 8; i++)
        text[2 + i] = k_digits[number >> (28 - 4 * i) & 15u];
    text[10] = '\0';
    target_write(text);
}
