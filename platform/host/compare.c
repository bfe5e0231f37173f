/* SPDX-License-Identifier: MIT */
/*
 * `brume compare`: files, and what is printed. A pair of pictures is a
 * sequence of one frame.
 */
#include "compare.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compare_options.h"
#include "image_codec.h"
#include "metrics.h"
#include "out_file.h"
#include "pattern.h"

/* What all frames together gave. */
struct run {
    const struct compare_options *options;
    double total[METRICS];
    struct metrics_sequence sequence;
    struct image map, flip_map;
    char *table; /* of --csv */
    size_t table_size;
    FILE *table_file;
};

/// Measuring ///

static int measure_pair(struct run *r, const struct image *a,
                        const struct image *b, double v[METRICS], char *err)
{
    const struct compare_options *o = r->options;
    struct metrics_error e;
    struct metrics_flip f = {0, 0};

    if (metrics_error(a, b, &e, err, MESSAGE_SIZE))
        return -1;
    v[RMSE] = e.rmse;
    v[MEAN] = e.mean;
    v[PSNR] = e.psnr;
    v[MAX] = e.max;
    v[WORST_TILE] = e.worst_tile;
    if (o->wanted[SSIM] && metrics_ssim(a, b, &v[SSIM], err, MESSAGE_SIZE))
        return -1;
    if ((o->wanted[FLIP] || o->wanted[FLIP_MAX] || o->flip) &&
        metrics_flip(a, b, o->linear, o->degree, &f,
                     o->flip ? &r->flip_map : NULL, err, MESSAGE_SIZE))
        return -1;
    v[FLIP] = f.mean;
    v[FLIP_MAX] = f.max;
    if (metrics_sharpness(a, b, &v[SHARPNESS], err, MESSAGE_SIZE))
        return -1;
    if (o->heat && metrics_error_map(a, b, &r->map, err, MESSAGE_SIZE))
        return -1;
    return o->many ? metrics_add(&r->sequence, a, b, err, MESSAGE_SIZE) : 0;
}

/* Into what is of all frames: sums of squares, sums, or the largest. */
static void add_frame(struct run *r, const double v[METRICS])
{
    for (int m = 0; m < FRAME_METRICS; m++)
        switch (m) {
        case RMSE: r->total[m] += v[m] * v[m]; break;
        case MAX:
        case WORST_TILE:
        case FLIP_MAX: r->total[m] = fmax(r->total[m], v[m]); break;
        default: r->total[m] += v[m]; break;
        }
}

static void end_totals(struct run *r)
{
    const struct compare_options *o = r->options;
    double n = (double)(o->last - o->first) + 1;
    struct metrics_time t;

    r->total[RMSE] = sqrt(r->total[RMSE] / n);
    r->total[PSNR] = metrics_psnr(r->total[RMSE]);
    r->total[MEAN] /= n;
    r->total[SSIM] /= n;
    r->total[FLIP] /= n;
    r->total[SHARPNESS] /= n;
    metrics_finish(&r->sequence, &t);
    r->total[GHOSTING] = t.ghosting;
    r->total[FLICKER] = t.flicker;
    r->total[DEVIATION] = t.deviation;
    r->total[LAG] = t.lag;
    r->total[TPSNR] = t.psnr;
}

static void print_value(FILE *to, double v)
{
    if (isfinite(v))
        fprintf(to, "%.6f", fabs(v) < 5e-7 ? 0.0 : v); /* no "-0.000000" */
    else
        fputs(isnan(v) ? "nan" : v < 0 ? "-inf" : "inf", to);
}

/* The head, for v = NULL, or a line of --csv. */
static void add_line(struct run *r, uint32_t frame, const double *v)
{
    if (!r->table_file)
        return;
    if (v)
        fprintf(r->table_file, "%lu", (unsigned long)frame);
    else
        fputs("frame", r->table_file);
    for (int m = 0; m < FRAME_METRICS; m++) {
        if (!r->options->wanted[m])
            continue;
        fputc(',', r->table_file);
        if (v)
            print_value(r->table_file, v[m]);
        else
            fputs(compare_names[m], r->table_file);
    }
    fputc('\n', r->table_file);
}

static int measure_frame(struct run *r, uint32_t frame)
{
    const struct compare_options *o = r->options;
    struct image image[2] = {{0, 0, 0, NULL, NULL}, {0, 0, 0, NULL, NULL}};
    const char *path[2] = {o->path[0], o->path[1]};
    char name[2][PATTERN_SIZE], err[MESSAGE_SIZE];
    double v[METRICS] = {0};
    int status = 0;

    for (int i = 0; i < 2 && status == 0; i++) {
        if (o->many && pattern_is(path[i])) {
            pattern_name(path[i], frame, name[i]);
            path[i] = name[i];
        }
        status = image_read(path[i], &image[i], err, sizeof err);
    }
    if (status)
        compare_complain("%s", err);
    else if ((status = measure_pair(r, &image[0], &image[1], v, err)) != 0)
        compare_complain("%s and %s: %s", path[0], path[1], err);
    if (status == 0) {
        add_frame(r, v);
        add_line(r, frame, v);
    }
    image_free(&image[0]);
    image_free(&image[1]);
    return status;
}

/// Output ///

static int write_heat(const char *path, const struct image *map, double white)
{
    struct image picture;
    char err[MESSAGE_SIZE];
    int status = metrics_heat(map, white, &picture, err, sizeof err);

    if (status)
        return compare_complain("%s: %s", path, err);
    status = image_write(path, &picture, err, sizeof err);
    image_free(&picture);
    return status ? compare_complain("%s", err) : 0;
}

static double largest_of(const struct image *map)
{
    double most = 0;

    for (size_t i = 0; i < image_samples(map); i++)
        most = fmax(most, (double)map->f32[i]);
    return most;
}

static int write_table(const struct run *r)
{
    struct out_file out;
    const char *path = r->options->csv;
    char err[MESSAGE_SIZE];

    if (out_open(&out, path, err, sizeof err))
        return compare_complain("%s: %s", path, err);
    if (out_write(&out, r->table, r->table_size, err, sizeof err)) {
        out_abandon(&out);
        return compare_complain("%s: %s", path, err);
    }
    if (out_close(&out, err, sizeof err))
        return compare_complain("%s: %s", path, err);
    return 0;
}

static int print_totals(const struct run *r)
{
    for (int m = 0; m < (r->options->many ? METRICS : FRAME_METRICS); m++) {
        if (!r->options->wanted[m])
            continue;
        printf("%s=", compare_names[m]);
        print_value(stdout, r->total[m]);
        putchar('\n');
    }
    if (fflush(stdout) != 0 || ferror(stdout))
        return compare_complain("cannot write the result");
    return 0;
}

/* Files first, each whole or not at all: what is printed is of a run that went
 * well. */
static int write_all(struct run *r)
{
    const struct compare_options *o = r->options;

    if (o->heat) {
        double most = o->heat_max > 0 ? o->heat_max / 255 : largest_of(&r->map);
        if (write_heat(o->heat, &r->map, most > 0 ? most : 1))
            return -1;
    }
    if (o->flip && write_heat(o->flip, &r->flip_map, 1))
        return -1;
    if (o->csv && write_table(r))
        return -1;
    return print_totals(r);
}

static int measure_all(struct run *r)
{
    const struct compare_options *o = r->options;

    if (o->csv) {
        r->table_file = open_memstream(&r->table, &r->table_size);
        if (!r->table_file)
            return compare_complain("no memory for the table");
    }
    add_line(r, 0, NULL);
    for (uint32_t frame = o->first;; frame++) {
        if (measure_frame(r, frame))
            return -1;
        if (frame == o->last)
            break;
    }
    end_totals(r);
    if (r->table_file && fflush(r->table_file) != 0)
        return compare_complain("no memory for the table");
    return 0;
}

static void free_run(struct run *r)
{
    if (r->table_file)
        fclose(r->table_file);
    free(r->table);
    image_free(&r->map);
    image_free(&r->flip_map);
    metrics_free(&r->sequence);
}

int compare_main(int argc, char **argv)
{
    struct compare_options o;
    struct run r = {.options = &o};
    int status;

    if (compare_parse(argc, argv, &o))
        return 2;
    if (o.help)
        return fputs(compare_usage, stdout) < 0 || fflush(stdout) != 0 ? 2 : 0;
    status = measure_all(&r) || write_all(&r) ? 2 : 0;
    free_run(&r);
    if (status == 0 && o.max_rmse >= 0 && r.total[RMSE] > o.max_rmse) {
        compare_complain("rmse %.6f is above --max-rmse %g", r.total[RMSE],
                         o.max_rmse);
        return 1;
    }
    return status;
}
