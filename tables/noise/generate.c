/* SPDX-License-Identifier: MIT */
/* Every noise by name: formulas, void-and-cluster, and vectors. */
#include "generate.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formula.h"
#include "refine.h"

#define MAX_FRAMES 64

const struct noise_name noise_names[] = {
    {"white", "a hash of pixel and frame", MAX_FRAMES, false},
    {"white8", "a random permutation of 64 values per 8x8 pixels and frame",
     MAX_FRAMES, false},
    {"bayer4", "Bayer's ordered matrix 4x4", MAX_FRAMES, false},
    {"bayer8", "Bayer's ordered matrix 8x8", MAX_FRAMES, false},
    {"bayer8-golden", "the same, each frame a golden ratio further", MAX_FRAMES,
     false},
    {"bayer16", "Bayer's ordered matrix 16x16", MAX_FRAMES, false},
    {"ign", "interleaved gradient noise, both axes + 5.588238 per frame",
     MAX_FRAMES, false},
    {"ign-thesis", "interleaved gradient noise, + (2.083, 4.867) per frame",
     MAX_FRAMES, false},
    {"rank1", "a rank-1 lattice in x, y and time", MAX_FRAMES, false},
    {"blue", "blue noise, one frame (void-and-cluster)", 1, false},
    {"blue-slices", "blue noise, independent frames", MAX_FRAMES, false},
    {"stbn",
     "spatio-temporal blue noise: each frame and each pixel's history "
     "are blue",
     MAX_FRAMES, false},
    {"fast", "adapted to --filter, --time and --combine", MAX_FRAMES, true},
    {"golden", "blue noise, each frame a golden ratio further", MAX_FRAMES,
     false},
    {"r2", "blue noise, each frame moved by the R2 sequence", MAX_FRAMES,
     false},
    {"nrooks", "N-rooks sets of 1 to 16 points (C only)", MAX_FRAMES, false},
};
const uint32_t noise_name_count = sizeof noise_names / sizeof *noise_names;

const struct noise_name *noise_find(const char *name)
{
    for (uint32_t i = 0; i < noise_name_count; i++)
        if (!strcmp(noise_names[i].name, name))
            return &noise_names[i];
    return NULL;
}

bool noise_is_rooks(const struct noise_job *job)
{
    return !strcmp(job->name->name, "nrooks");
}

void noise_default_kernel(struct kernel_spec *spec)
{
    *spec = (struct kernel_spec){.plain = false};
    kernel_parse_space(NOISE_DEFAULT_FILTER, &spec->space);
    kernel_parse_time(NOISE_DEFAULT_TIME, &spec->time);
    kernel_parse_combine(NOISE_DEFAULT_COMBINE, spec);
}

/// Void-and-cluster ///

/* Fills `frames` frames of the texture, from `first` on. */
static bool cluster(struct noise_texture *t, uint32_t first, uint32_t frames,
                    const struct kernel_spec *spec, uint32_t seed,
                    cluster_progress *progress)
{
    struct kernel kernel;
    size_t area = (size_t)t->width * t->height;
    uint32_t *rank = malloc(area * frames * sizeof *rank);
    bool good = rank && kernel_make(&kernel, spec, t->width, t->height, frames);

    if (good) {
        good = cluster_rank(rank, &kernel, t->width, t->height, frames, seed,
                            progress);
        kernel_free(&kernel);
    }
    if (good)
        cluster_values(t->values + first * area, rank, (uint32_t)area, frames);
    free(rank);
    return good;
}

/* Ulichney's sigma. By every measure better than 1.9 (docs/noise.md). */
#define BLUE_SIGMA "gauss:1.5"

/* Wolfe et al. 2022 take 1.9 in space and time. */
#define STBN_SIGMA "gauss:1.9"

static void plain_kernel(struct kernel_spec *spec, const char *space)
{
    *spec = (struct kernel_spec){.plain = true};
    kernel_parse_space(space, &spec->space);
}

static bool blue(struct noise_texture *t, const struct noise_job *job)
{
    struct kernel_spec spec;

    plain_kernel(&spec, BLUE_SIGMA);
    return cluster(t, 0, 1, &spec, job->seed, NULL);
}

/* Wolfe, Morrical, Akenine-Moeller and Ramamoorthi, "Spatiotemporal Blue Noise
 * Masks", 2022: a Gaussian within a frame plus a Gaussian over time at the
 * same pixel. Theirs fills the largest void of all frames; here each frame in
 * turn, which makes every histogram exact. */
static bool stbn(struct noise_texture *t, const struct noise_job *job)
{
    struct kernel_spec spec;

    plain_kernel(&spec, STBN_SIGMA);
    kernel_parse_time(STBN_SIGMA, &spec.time);
    kernel_parse_combine("separate:1", &spec);
    return cluster(t, 0, t->frames, &spec, job->seed, job->progress);
}

/* Frames first, first + step, ... of blue-slices. */
struct slices {
    pthread_t thread;
    struct noise_texture *texture;
    uint32_t seed, first, step;
    bool good;
};

static void *slices_run(void *user)
{
    struct slices *s = user;
    struct kernel_spec spec;

    plain_kernel(&spec, BLUE_SIGMA);
    s->good = true;
    for (uint32_t z = s->first; z < s->texture->frames; z += s->step)
        s->good = s->good && cluster(s->texture, z, 1, &spec,
                                     s->seed + 0x10000u * z, NULL);
    return NULL;
}

static bool blue_slices(struct noise_texture *t, const struct noise_job *job)
{
    struct slices s[MAX_FRAMES];
    uint32_t count = job->threads < t->frames ? job->threads : t->frames;
    bool good = true;

    for (uint32_t i = 0; i < count; i++)
        s[i] = (struct slices){
            .texture = t, .seed = job->seed, .first = i, .step = count};
    uint32_t started = 1;
    while (started < count &&
           !pthread_create(&s[started].thread, NULL, slices_run, &s[started]))
        started++;
    for (uint32_t i = started; i < count; i++)
        slices_run(&s[i]);
    slices_run(&s[0]);
    for (uint32_t i = 1; i < started; i++)
        pthread_join(s[i].thread, NULL);
    for (uint32_t i = 0; i < count; i++)
        good = good && s[i].good;
    return good;
}

/* `fast`: void-and-cluster or the values of a file, and swaps. */
static int fast(struct noise_texture *t, const struct noise_job *job, char *err,
                size_t err_size)
{
    struct kernel kernel;
    bool good = true;

    if (job->from) {
        noise_texture_free(t);
        if (noise_texture_read(t, job->from, job->width, job->height,
                               job->frames, 1, err, err_size))
            return -1;
        good = refine_spread(t, job->seed);
    } else {
        good = cluster(t, 0, t->frames, &job->kernel, job->seed, job->progress);
    }
    good = good &&
           kernel_make(&kernel, &job->kernel, t->width, t->height, t->frames);
    if (!good) {
        snprintf(err, err_size, "not enough memory");
        return -1;
    }
    if (job->refine)
        refine_swap(t, &kernel, job->refine, job->seed, job->progress);
    kernel_free(&kernel);
    return 0;
}

/// Vectors ///

/* What space.h wants: a kernel that is not folded, its centre at most 2^16. */
static int space_kernel(struct kernel *k, struct noise_space_kernel *view,
                        const struct noise_job *job, char *err, size_t err_size)
{
    if (!kernel_make(k, &job->kernel, job->width, job->height, job->frames)) {
        snprintf(err, err_size, "not enough memory");
        return -1;
    }
    uint32_t radius = (uint32_t)-k->left, size = 2u * radius + 1u;
    if (k->cols != size || k->rows != size) {
        snprintf(err, err_size, "--size: the filter is wider than %ux%u",
                 job->width, job->height);
        kernel_free(k);
        return -1;
    }
    size_t count = (size_t)k->frames * size * size;
    while (k->weight[size * size / 2] > 1 << 16)
        for (size_t i = 0; i < count; i++)
            k->weight[i] = (k->weight[i] + 1) >> 1;
    *view = (struct noise_space_kernel){radius, k->frames, k->weight};
    return 0;
}

static void space_progress(void *user, uint32_t done, uint32_t all)
{
    const struct noise_job *job = user;

    if (job->progress)
        job->progress(done, all);
}

static int vectors(struct noise_texture *t, const struct noise_job *job,
                   char *err, size_t err_size)
{
    struct noise_job copy = *job;
    struct noise_space_kernel view;
    struct kernel kernel;

    if (space_kernel(&kernel, &view, job, err, err_size))
        return -1;
    bool good = noise_space_fill(t, job->space, &view, job->seed, 0,
                                 space_progress, &copy);
    kernel_free(&kernel);
    if (!good)
        snprintf(err, err_size, "not enough memory");
    return good ? 0 : -1;
}

int noise_space_measure(const struct noise_texture *t,
                        const struct noise_job *job, double *loss, char *err,
                        size_t err_size)
{
    struct noise_space_kernel view;
    struct kernel kernel;

    if (space_kernel(&kernel, &view, job, err, err_size))
        return -1;
    bool good = noise_space_loss(t, job->space, &view, loss);
    kernel_free(&kernel);
    if (!good)
        snprintf(err, err_size, "not enough memory");
    return good ? 0 : -1;
}

/// By name ///

static bool scalar(struct noise_texture *t, const struct noise_job *job)
{
    const char *name = job->name->name;

    if (!strcmp(name, "white"))
        noise_white(t, job->seed);
    else if (!strcmp(name, "white8"))
        noise_white8(t, job->seed);
    else if (!strncmp(name, "bayer", 5))
        noise_bayer(t, (uint32_t)atoi(name + 5));
    else if (!strcmp(name, "ign"))
        noise_ign(t, IGN_JIMENEZ);
    else if (!strcmp(name, "ign-thesis"))
        noise_ign(t, IGN_THESIS);
    else if (!strcmp(name, "rank1"))
        noise_rank1(t);
    else if (!strcmp(name, "blue-slices"))
        return blue_slices(t, job);
    else if (!strcmp(name, "stbn"))
        return stbn(t, job);
    else if (!blue(t, job))
        return false;
    if (strstr(name, "golden"))
        noise_golden(t);
    else if (!strcmp(name, "r2"))
        noise_r2(t);
    return true;
}

int noise_generate(struct noise_texture *t, const struct noise_job *job,
                   char *err, size_t err_size)
{
    if (!noise_texture_make(t, job->width, job->height, job->frames,
                            noise_space_channels(job->space))) {
        snprintf(err, err_size, "not enough memory");
        return -1;
    }
    if (job->space != NOISE_SCALAR) {
        if (!vectors(t, job, err, err_size))
            return 0;
    } else if (job->name->filters) {
        if (!fast(t, job, err, err_size))
            return 0;
    } else if (scalar(t, job)) {
        return 0;
    } else {
        snprintf(err, err_size, "not enough memory");
    }
    noise_texture_free(t);
    return -1;
}
