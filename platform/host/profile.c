/* SPDX-License-Identifier: MIT */
#include "profile.h"

#include <time.h>

static const char *const k_names[PASSES] = {
    "open",    "begin", "cache", "copy",   "march", "store",
    "resolve", "show",  "pack",  "encode", "write"};

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

static double add_until(struct profile *p, enum pass pass, double from,
                        double now)
{
    p->busy[pass] += now - from;
    return now;
}

double profile_add(struct profile *p, enum pass pass, double from)
{
    if (p == NULL)
        return 0;
    p->reads[pass]++;
    return add_until(p, pass, from, profile_now());
}

double profile_add_process(struct profile *p, enum pass pass, double from)
{
    return p != NULL ? add_until(p, pass, from, profile_process()) : 0;
}

void profile_sum(struct profile *to, const struct profile *from)
{
    for (int i = 0; i < PASSES; i++) {
        to->busy[i] += from->busy[i];
        to->reads[i] += from->reads[i];
    }
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

/* What one reading takes, the least of many. */
static double cost_of_reading(void)
{
    double least = 1, from = profile_now();
    for (int i = 0; i < 200; i++) {
        double now = profile_now();
        least = now - from < least ? now - from : least;
        from = now;
    }
    return least;
}

void profile_print(FILE *to, const char *what, const struct profile *p)
{
    double cost = cost_of_reading(), ms[PASSES], busy = 0;
    for (int i = 0; i < PASSES; i++) {
        ms[i] = (p->busy[i] - p->reads[i] * cost) * 1e3;
        ms[i] = ms[i] > 0 ? ms[i] : 0;
        busy += ms[i];
    }
    fprintf(to, "%-12s", what);
    for (int i = 0; i < PASSES; i++)
        fprintf(to, " %8.2f", ms[i]);
    fprintf(to, " %8.2f %8.2f %6.1f%%\n", busy, p->wall * 1e3,
            busy > 0 ? 100 * ms[PASS_MARCH] / busy : 0);
}
