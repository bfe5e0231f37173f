/* SPDX-License-Identifier: MIT */
/* What start-up code of all boards shares. */
#ifndef BRUME_START_H
#define BRUME_START_H

#include <stdint.h>

/* Fills .data and .bss. Static variables do not exist before. */
void start_memory(void);

/* One line about a fault at an address, and the end. */
void start_fault(const char *what, uint32_t cause, uint32_t address)
    __attribute__((noreturn));

#endif
