/* SPDX-License-Identifier: MIT */
/* Options of `brume compare`. Private to compare*.c. */
#ifndef BRUME_HOST_COMPARE_OPTIONS_H
#define BRUME_HOST_COMPARE_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#define MESSAGE_SIZE 512

enum compare_metric {
    RMSE,
    MEAN,
    PSNR,
    MAX,
    WORST_TILE,
    SSIM,
    FLIP,
    FLIP_MAX,
    SHARPNESS,
    FRAME_METRICS, /* those from here on are of sequences */
    GHOSTING = FRAME_METRICS,
    FLICKER,
    DEVIATION,
    LAG,
    TPSNR,
    METRICS
};

/* As they are printed, and said to --metrics. */
extern const char *const compare_names[METRICS];

struct compare_options {
    const char *path[2];
    const char *heat, *flip, *csv;
    double max_rmse; /* negative: no limit */
    double heat_max; /* 0: the largest difference there is */
    double degree;
    bool linear, many, help;
    bool wanted[METRICS];
    uint32_t first, last;
};

extern const char compare_usage[];

#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
/* One line to stderr, with the command's name. Returns -1. */
int compare_complain(const char *fmt, ...);

/* Fills *options. Returns 0, or -1 after a complaint. */
int compare_parse(int argc, char **argv, struct compare_options *options);

#endif
