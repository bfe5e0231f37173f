/* SPDX-License-Identifier: MIT */
/* Numbers as text, for programs without a C library. */
#ifndef BRUME_PRINT_H
#define BRUME_PRINT_H

#include <stdint.h>

/* Writes a number in decimal, or in hexadecimal with 8 digits, by
 * target_write. */
void print_number(uint64_t number);
void print_hex(uint32_t number);

#endif
