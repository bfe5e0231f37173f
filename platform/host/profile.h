/* SPDX-License-Identifier: MIT */
/*
 * Where the time goes: processor seconds by pass, of all threads together, and
 * the time on the clock. Reading a thread's time takes as long as packing some
 * hundred pixels, twice a tile: what is printed is less that.
 */
#ifndef BRUME_HOST_PROFILE_H
#define BRUME_HOST_PROFILE_H

#include <stdio.h>

enum pass {
    PASS_OPEN,    /* mapping and checking volumes */
    PASS_BEGIN,   /* tables of the frame */
    PASS_CACHE,   /* depths towards the sun, of light = cache */
    PASS_COPY,    /* the volume in another order, for wide kernels */
    PASS_MARCH,   /* rays */
    PASS_STORE,   /* rays into the state */
    PASS_RESOLVE, /* reprojection */
    PASS_SHOW,    /* filters, upsampling, and packing with them */
    PASS_PACK,    /* rays straight to pixels */
    PASS_ENCODE,  /* PNG, APNG, Y4M */
    PASS_WRITE,   /* the file */
    PASSES
};

struct profile {
    double busy[PASSES];    /* processor seconds */
    unsigned reads[PASSES]; /* of the thread's time, that these include */
    double wall;            /* seconds on the clock */
    unsigned frames;
};

/* Processor time of this thread so far, in seconds. */
double profile_now(void);
/* That of all threads. */
double profile_process(void);
/* The clock, from any start. */
double profile_clock(void);

/* Adds the time since `from`, and returns now. NULL: nothing is measured. */
double profile_add(struct profile *p, enum pass pass, double from);
/* The same of profile_process, for what all threads do together. */
double profile_add_process(struct profile *p, enum pass pass, double from);

void profile_sum(struct profile *to, const struct profile *from);

/* Lines of a table: the heads; a row `what`, in milliseconds, and the march's
 * share of the busy time. */
void profile_print_head(FILE *to);
void profile_print(FILE *to, const char *what, const struct profile *p);

#endif
