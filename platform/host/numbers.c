/* SPDX-License-Identifier: MIT */
#include "numbers.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>

bool numbers_read(const char *text, int count, double *out)
{
    for (int i = 0; i < count; i++) {
        char *end;
        out[i] = strtod(text, &end);
        if (end == text || !isfinite(out[i]) ||
            *end != (i + 1 < count ? ',' : '\0'))
            return false;
        text = end + 1;
    }
    return true;
}

const char *numbers_whole(const char *text, unsigned long max, char stop,
                          unsigned *out)
{
    char *end;
    errno = 0;
    unsigned long n = strtoul(text, &end, 10);
    if (*text < '0' || *text > '9' || *end != stop || errno != 0 || n < 1 ||
        n > max)
        return NULL;
    *out = (unsigned)n;
    return end + 1;
}

bool numbers_size(const char *text, unsigned long max, unsigned out[2])
{
    const char *second = numbers_whole(text, max, 'x', &out[0]);
    return second != NULL && numbers_whole(second, max, '\0', &out[1]) != NULL;
}
