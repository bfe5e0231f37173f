/* SPDX-License-Identifier: MIT */
/* The command line of brume-noise. */
#ifndef BRUME_TABLES_OPTIONS_H
#define BRUME_TABLES_OPTIONS_H

#include "generate.h"

enum action { ACTION_MAKE, ACTION_MEASURE, ACTION_LIST, ACTION_HELP };

struct options {
    enum action action;
    struct noise_job job;
    const char *input;    /* of measure */
    const char *output;   /* or NULL */
    const char *spectrum; /* or NULL */
    uint32_t bits;        /* 4 or 8 */
    bool measure, steady, bands;
    char command[256]; /* that makes this texture, all choices spelled out */
};

extern const char options_help[];

/* Returns 0, or -1 with one line of text in err. */
int options_parse(struct options *o, int argc, char **argv, char *err,
                  size_t err_size);

#endif
