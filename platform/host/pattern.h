/* SPDX-License-Identifier: MIT */
/*
 * File names with a frame number in them: one %d, or %0Nd for at least N
 * digits. Nothing else of printf is known.
 *
 * Errors: as in image.h.
 */
#ifndef BRUME_HOST_PATTERN_H
#define BRUME_HOST_PATTERN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PATTERN_SIZE 4096 /* of a name, with its end */

/* Is there a '%' at all? */
bool pattern_is(const char *pattern);

int pattern_check(const char *pattern, char *err, size_t err_size);

/* The name of a frame, of a pattern that was checked. */
void pattern_name(const char *pattern, uint32_t frame, char name[PATTERN_SIZE]);

#endif
