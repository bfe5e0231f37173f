/* SPDX-License-Identifier: MIT */
/*
 * The test harness shared by every test program: TAP-like lines on stdout.
 *
 *     #include "tap.h"
 *     int main(void)
 *     {
 *         tap_check(1 + 1 == 2, "one and one is %d", 2);
 *         tap_skip("needs a tool that is not installed");
 *         return tap_done();
 *     }
 *
 * prints
 *
 *     ok 1 - one and one is 2
 *     ok 2 # SKIP needs a tool that is not installed
 *     1 passed, 0 failed, 1 skipped
 *
 * A failure adds ` (file:line)` to its line. Usable from C99 and C++17; the
 * counters are per program, so include it from one source file.
 */
#ifndef BRUME_TESTS_TAP_H
#define BRUME_TESTS_TAP_H

#include <stdarg.h>
#include <stdio.h>

#if defined(__GNUC__)
#define TAP_PRINTF(f, a) __attribute__((format(printf, f, a)))
#else
#define TAP_PRINTF(f, a)
#endif

static int tap_passed, tap_failed, tap_skipped;

/* The number of the line about to be printed, from 1. */
static inline int tap_number(void)
{
    return tap_passed + tap_failed + tap_skipped;
}

/* Lines are flushed one by one: a crash must not swallow what came before. */
TAP_PRINTF(4, 5)
static inline int tap_check_at(int good, const char *file, int line,
                               const char *fmt, ...)
{
    va_list ap;

    if (good)
        tap_passed++;
    else
        tap_failed++;
    printf("%s %d - ", good ? "ok" : "not ok", tap_number());
    va_start(ap, fmt);
    vprintf(fmt, ap);
    va_end(ap);
    if (!good)
        printf(" (%s:%d)", file, line);
    putchar('\n');
    fflush(stdout);
    return good;
}

/* Count a check that cannot run here; the text says which and why. */
TAP_PRINTF(1, 2)
static inline void tap_skip(const char *fmt, ...)
{
    va_list ap;

    tap_skipped++;
    printf("ok %d # SKIP ", tap_number());
    va_start(ap, fmt);
    vprintf(fmt, ap);
    va_end(ap);
    putchar('\n');
    fflush(stdout);
}

/* Print the totals. Returns the exit status of the program: 0 when nothing
 * failed, else 1. */
static inline int tap_done(void)
{
    printf("%d passed, %d failed, %d skipped\n", tap_passed, tap_failed,
           tap_skipped);
    fflush(stdout);
    return tap_failed != 0;
}

/* tap_check(condition, format, ...): one named check. Its value is the
 * condition as 0 or 1, so that a test can stop at the first failure. */
#define tap_check(cond, ...) \
    tap_check_at((cond) ? 1 : 0, __FILE__, __LINE__, __VA_ARGS__)

#endif
