/* SPDX-License-Identifier: MIT */
/*
 * brume-layouts: trilinear lookups per second from several layouts of one
 * volume, at the positions that a frame looks up; see layouts.h. All kinds in
 * turns, A B C A B C, after one round that is not timed; a kind whose densities
 * are not the core's is an error.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "layouts.h"
#include "ours.h"

#define BATCH 256u /* positions of 16 lanes; of 8, two */
#define RUNS_MAX 99

const struct layout_kind layout_kinds[LAYOUT_KINDS] = {
    {"positions", "", LAYOUT_NONE, PRODUCTS_NONE},
    {"asset", "16", LAYOUT_ASSET, PRODUCTS_16},
    {"bricks", "32", LAYOUT_BRICKS, PRODUCTS_32},
    {"bricks", "16", LAYOUT_BRICKS, PRODUCTS_16},
    {"apron", "32", LAYOUT_APRON, PRODUCTS_32},
    {"apron", "16", LAYOUT_APRON, PRODUCTS_16},
    {"quads", "32", LAYOUT_QUADS, PRODUCTS_32},
    {"quads", "16", LAYOUT_QUADS, PRODUCTS_16},
    {"octets", "32", LAYOUT_OCTETS, PRODUCTS_32},
    {"octets", "16", LAYOUT_OCTETS, PRODUCTS_OCTETS},
    {"apron_pages", "32", LAYOUT_APRON_PAGES, PRODUCTS_32},
    {"apron_pages", "16", LAYOUT_APRON_PAGES, PRODUCTS_16},
    {"quad_pages", "32", LAYOUT_QUAD_PAGES, PRODUCTS_32},
    {"quad_pages", "16", LAYOUT_QUAD_PAGES, PRODUCTS_16},
    {"copy", "16", LAYOUT_COPY, PRODUCTS_16}};

struct width {
    enum wide_kernel kernel;
    unsigned lanes;
    layouts_run *run;
};

static const struct width k_widths[2] = {{WIDE_AVX2, 8, layouts_run_avx2},
                                         {WIDE_AVX512, 16, layouts_run_avx512}};

struct job {
    struct volume_file file;
    struct brume_frame frame;
    struct wide_copy copy;
    struct layouts layouts;
    size_t bytes[LAYOUTS], bricks;
    double ns[2][LAYOUT_KINDS][RUNS_MAX];
    uint32_t expected[2]; /* hashes */
    unsigned part;
    int runs;
};

/// Positions ///

/* Positions of the frame, as many as fill batches. */
static int record(struct job *job)
{
    struct ours_job march = {.frame = &job->frame, .part = job->part};
    struct lookup_count n;
    struct ours_places places = {.volume = &job->file.volume};
    ours_count(&march, &n);
    for (int i = 0; i < 3; i++) {
        places.axis[i] = malloc((n.view + n.light + 1) * sizeof(uint32_t));
        job->layouts.axis[i] = places.axis[i];
        if (places.axis[i] == NULL)
            return -1;
    }
    ours_record(&march, &places);
    job->layouts.count = places.count / BATCH * BATCH;
    return 0;
}

/* The core's densities, hashed as so many lanes do. */
static uint32_t hash_of_core(const struct job *job, unsigned lanes)
{
    const struct kernel k = KERNEL_OF(BRUME_U8, 0, true, false, false);
    const struct layouts *l = &job->layouts;
    uint32_t hash[16] = {0}, sum = 0;
    for (size_t i = 0; i < l->count; i++) {
        uint32_t d, *h = &hash[i % lanes];
        if (!density_at(&job->frame, l->axis[0][i], l->axis[1][i],
                        l->axis[2][i], &d, k))
            d = 0;
        *h = (*h << 1 | *h >> 31) ^ d;
    }
    for (unsigned i = 0; i < lanes; i++)
        sum = sum * 31u + hash[i];
    return sum;
}

/// Measuring ///

static double nanoseconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static int ascending(const void *a, const void *b)
{
    double d = *(const double *)a - *(const double *)b;
    return (d > 0) - (d < 0);
}

/* One kind once, as run number n; -1 is not timed. */
static int measure(struct job *job, int w, int kind, int n)
{
    const struct layouts *l = &job->layouts;
    double from = nanoseconds();
    uint32_t hash = k_widths[w].run(l, kind);
    if (n >= 0)
        job->ns[w][kind][n] = (nanoseconds() - from) / (double)l->count;
    if (layout_kinds[kind].layout == LAYOUT_NONE || hash == job->expected[w])
        return 0;
    fprintf(stderr,
            "brume-layouts: %s, %s: %u lanes find other densities than the "
            "core\n",
            layout_kinds[kind].name, layout_kinds[kind].products_name,
            k_widths[w].lanes);
    return -1;
}

static int measure_all(struct job *job)
{
    for (int n = -1; n < job->runs; n++)
        for (int w = 0; w < 2; w++)
            for (int kind = 0; kind < LAYOUT_KINDS; kind++)
                if (wide_has(k_widths[w].kernel) &&
                    measure(job, w, kind, n) != 0)
                    return -1;
    return 0;
}

static void print(struct job *job)
{
    puts("layout,products,lanes,ns,ns_least,ns_most,bytes,bytes_per_voxel,"
         "lookups");
    for (int w = 0; w < 2; w++)
        for (int kind = 0; kind < LAYOUT_KINDS; kind++) {
            const struct layout_kind *k = &layout_kinds[kind];
            double *ns = job->ns[w][kind];
            size_t bytes = job->bytes[k->layout];
            if (!wide_has(k_widths[w].kernel))
                continue;
            qsort(ns, (size_t)job->runs, sizeof ns[0], ascending);
            printf("%s,%s,%u,%.3f,%.3f,%.3f,%zu,%.2f,%zu\n", k->name,
                   k->products_name, k_widths[w].lanes, ns[job->runs / 2],
                   ns[0], ns[job->runs - 1], bytes,
                   (double)bytes / 512.0 / (double)job->bricks,
                   job->layouts.count);
        }
}

/// Program ///

static int prepare(struct job *job, const char *path,
                   const char *const *settings, size_t n)
{
    char err[400];
    const struct brume_volume *v = &job->file.volume;
    if (volume_file_open(&job->file, path, err, sizeof err) != 0 ||
        ours_frame(&job->frame, &job->file, settings, n, err, sizeof err) !=
            0) {
        fprintf(stderr, "brume-layouts: %s\n", err);
        return -1;
    }
    if (job->frame.kernel != KERNEL_ID(BRUME_U8, 0, 1, 0, 0) &&
        job->frame.kernel != KERNEL_ID(BRUME_U8, 0, 1, 1, 0)) {
        fputs("brume-layouts: not trilinear, or not u8 without an apron\n",
              stderr);
        return -1;
    }
    job->layouts.frame = &job->frame;
    job->layouts.copy = &job->copy;
    job->bricks = v->bricks;
    wide_copy_init(&job->copy, v, WIDE_COPY_MOST);
    wide_copy_prepare(&job->copy, &job->frame, NULL);
    if (job->copy.aprons == NULL || record(job) != 0 ||
        !layouts_make(&job->layouts, job->bytes)) {
        fputs("brume-layouts: not enough memory\n", stderr);
        return -1;
    }
    for (int w = 0; w < 2; w++)
        job->expected[w] = hash_of_core(job, k_widths[w].lanes);
    return 0;
}

static const char k_usage[] =
    "usage: brume-layouts RUNS PART VOLUME.brume KEY=VALUE...\n\n"
    "Prints nanoseconds per trilinear lookup (median, least and most of RUNS, "
    "up to\n99) from layouts of a u8 volume, at the positions that every "
    "PARTth strip of the\nscene's frame looks up; and the memory of each.";

int main(int argc, char **argv)
{
    static struct job job;
    job.runs = argc > 3 ? atoi(argv[1]) : 0;
    job.part = argc > 3 ? (unsigned)atoi(argv[2]) : 0;
    if (job.runs < 1 || job.runs > RUNS_MAX || job.part < 1 || job.part > 64) {
        puts(k_usage);
        return 2;
    }
    int status =
        prepare(&job, argv[3], (const char *const *)argv + 4, (size_t)argc - 4);
    if (status == 0)
        status = measure_all(&job);
    if (status == 0)
        print(&job);
    layouts_free(&job.layouts);
    for (int i = 0; i < 3; i++)
        free((void *)(uintptr_t)job.layouts.axis[i]);
    wide_copy_free(&job.copy);
    volume_file_close(&job.file);
    return status == 0 ? 0 : 1;
}
