/* SPDX-License-Identifier: MIT */
/* Numbers of command line options: nothing but them, or nothing at all. */
#ifndef BRUME_HOST_NUMBERS_H
#define BRUME_HOST_NUMBERS_H

#include <stdbool.h>

/* `count` finite numbers with commas between, and nothing else. */
bool numbers_read(const char *text, int count, double *out);

/* A whole number from 1 to max that ends at `stop`; NULL or what is behind. */
const char *numbers_whole(const char *text, unsigned long max, char stop,
                          unsigned *out);

/* WxH, each from 1 to max. */
bool numbers_size(const char *text, unsigned long max, unsigned out[2]);

#endif
