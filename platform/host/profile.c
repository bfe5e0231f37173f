/* SPDX-License-Identifier: MIT */
#include "profile.h"

#include <time.h>

static const char *const k_names[PASSES] = {
    "open",    "begin", "copy", "march",  "store",
    "resolve", "show",  "pack", "encode", "write"};

static double seconds(clockid_t clock)
{
    struct timespec t;
    if (clock_gettime(clock, &t) != 0)
        return 0;
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

double profile_now(void)
{
    return seconds(CLOCK_THREAD_CPUTIME_ID);
}

double profile_process(void)
{
    return seconds(CLOCK_PROCESS_CPUTIME_ID);
}

double profile_clock(void)
{
    return seconds(CLOCK_MONOTONIC);
}

double profile_add(struct profile *p, enum pass pass, double from)
{
    double now;
    if (p == NULL)
        return 0;
    now = profile_now();
    p->busy[pass] += now - from;
    return now;
}

void profile_sum(struct profile *to, const struct profile *from)
{
    for (int i = 0; i < PASSES; i++)
        to->busy[i] += from->busy[i];
    to->wall += from->wall;
    to->frames += from->frames;
}

void profile_print_head(FILE *to)
{
    fprintf(to, "%-12s", "ms");
    for (int i = 0; i < PASSES; i++)
        fprintf(to, " %8s", k_names[i]);
    fprintf(to, " %8s %8s %7s\n", "busy", "clock", "march");
}

void profile_print(FILE *to, const char *what, const struct profile *p)
{
    double busy = 0;
    for (int i = 0; i < PASSES; i++)
        busy += p->busy[i];
    fprintf(to, "%-12s", what);
    for (int i = 0; i < PASSES; i++)
        fprintf(to, " %8.2f", p->busy[i] * 1e3);
    fprintf(to, " %8.2f %8.2f %6.1f%%\n", busy * 1e3, p->wall * 1e3,
            busy > 0 ? 100 * p->busy[PASS_MARCH] / busy : 0);
}
