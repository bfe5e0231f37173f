/* SPDX-License-Identifier: MIT */
/* Every noise by name. */
#ifndef BRUME_TABLES_GENERATE_H
#define BRUME_TABLES_GENERATE_H

#include "cluster.h"
#include "kernel.h"
#include "noise.h"
#include "space.h"

struct noise_name {
    const char *name;
    const char *text;    /* one line of what it is */
    uint32_t max_frames; /* 1: a single frame */
    bool filters;        /* takes a filter, and a space */
};

extern const struct noise_name noise_names[];
extern const uint32_t noise_name_count;

/* NULL when there is no such noise. */
const struct noise_name *noise_find(const char *name);

/* Whether it is nrooks, which is no texture: see nrooks.h. */
struct noise_job;
bool noise_is_rooks(const struct noise_job *job);

struct noise_job {
    const struct noise_name *name;
    uint32_t width, height, frames, seed, threads;
    enum noise_space space;
    struct kernel_spec kernel;
    const char *from; /* a .raw file that swaps begin with, or NULL */
    uint32_t refine;  /* swaps to try per pixel */
    cluster_progress *progress;
};

/* The filters of `fast` when none are given: one texture for an unknown
 * filter. docs/noise.md says how they were found. */
#define NOISE_DEFAULT_FILTER "gauss:0.8"
#define NOISE_DEFAULT_TIME "ema:0.15"
#define NOISE_DEFAULT_COMBINE "hybrid:0.6,0.5"
void noise_default_kernel(struct kernel_spec *spec);

/* Makes the texture. Returns 0, or -1 with one line of text in err. */
int noise_generate(struct noise_texture *t, const struct noise_job *job,
                   char *err, size_t err_size);

/* noise_space_loss with the job's kernel. Returns 0, or -1 as above. */
int noise_space_measure(const struct noise_texture *t,
                        const struct noise_job *job, double *loss, char *err,
                        size_t err_size);

#endif
