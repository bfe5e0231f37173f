/* SPDX-License-Identifier: MIT */
#include "pattern.h"

#include <stdio.h>
#include <string.h>

#include "image_codec.h"

#define MAX_DIGITS 20 /* N of %0Nd */

/* The digits of %d or %0Nd at `from`, and what follows it; NULL when it is
 * neither. */
static const char *read_field(const char *from, int *digits)
{
    *digits = 1;
    if (*from++ != '%')
        return NULL;
    if (*from == '0') {
        int n = 0;
        for (from++; *from >= '0' && *from <= '9' && n <= MAX_DIGITS; from++)
            n = 10 * n + (*from - '0');
        if (n < 1 || n > MAX_DIGITS)
            return NULL;
        *digits = n;
    }
    return *from == 'd' ? from + 1 : NULL;
}

bool pattern_is(const char *pattern)
{
    return strchr(pattern, '%') != NULL;
}

int pattern_check(const char *pattern, char *err, size_t err_size)
{
    int digits;
    const char *field = strchr(pattern, '%');
    const char *rest = field ? read_field(field, &digits) : NULL;
    if (rest == NULL || strchr(rest, '%') != NULL)
        return image_error(err, err_size,
                           "%.200s: a name for frames has one %%d or %%04d "
                           "in it, and no other %%",
                           pattern);
    if (strlen(pattern) + MAX_DIGITS >= PATTERN_SIZE)
        return image_error(err, err_size, "%.60s...: name too long", pattern);
    return 0;
}

void pattern_name(const char *pattern, uint32_t frame, char name[PATTERN_SIZE])
{
    int digits = 1;
    const char *field = strchr(pattern, '%');
    const char *rest = read_field(field, &digits);
    snprintf(name, PATTERN_SIZE, "%.*s%0*lu%s", (int)(field - pattern), pattern,
             digits, (unsigned long)frame, rest);
}
