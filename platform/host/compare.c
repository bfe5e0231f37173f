/* SPDX-License-Identifier: MIT */
/*
 * Image metrics and `brume compare`. Sums run tile by tile in a fixed order,
 * so the same files give the same digits on any IEEE host.
 */
#include "compare.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MESSAGE_SIZE 512

struct sums {
    double square, difference, max;
    double samples;
};

struct options {
    const char *path[2];
    double max_rmse; /* negative: no limit */
    int help;
};

static const char usage[] =
    "usage: brume compare A B [--max-rmse X]\n"
    "\n"
    "Compares two pictures (.png .ppm .pgm .pfm) of the same size and prints\n"
    "  rmse        root mean square difference\n"
    "  mean        mean of B - A\n"
    "  psnr        in dB, inf when identical\n"
    "  max         largest absolute difference\n"
    "  worst_tile  largest rmse of an 8x8 tile\n"
    "one name=value a line, in 1/255 of full scale except psnr.\n"
    "\n"
    "  --max-rmse X  exit with status 1 when rmse is above X\n"
    "  --help        print this\n"
    "\n"
    "Exit status: 0, 1 above --max-rmse, 2 on bad usage or files.\n";

/// Metrics ///

/* Channel c of pixel i in 1/255. */
static double sample_at(const struct image *image, size_t i, int c)
{
    size_t at = i * (size_t)image->channels;

    if (c < image->channels)
        at += (size_t)c;
    return image->u8 ? image->u8[at] : 255.0 * (double)image->f32[at];
}

static int min_int(int a, int b)
{
    return a < b ? a : b;
}

/* The tile whose top left pixel is (x0, y0). */
static struct sums tile_sums(const struct image *a, const struct image *b,
                             int x0, int y0)
{
    int x1 = min_int(x0 + COMPARE_TILE, a->width);
    int y1 = min_int(y0 + COMPARE_TILE, a->height);
    int channels = a->channels > b->channels ? a->channels : b->channels;
    struct sums s = {0, 0, 0, 0};

    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++)
            for (int c = 0; c < channels; c++) {
                size_t i = (size_t)y * (size_t)a->width + (size_t)x;
                double d = sample_at(b, i, c) - sample_at(a, i, c);
                s.square += d * d;
                s.difference += d;
                s.max = fabs(d) > s.max ? fabs(d) : s.max;
            }
    s.samples = (double)(x1 - x0) * (y1 - y0) * channels;
    return s;
}

static int size_error(const struct image *a, const struct image *b, char *err,
                      size_t err_size)
{
    snprintf(err, err_size, "sizes differ: %d x %d and %d x %d", a->width,
             a->height, b->width, b->height);
    return -1;
}

int image_compare(const struct image *a, const struct image *b,
                  struct compare_result *result, char *err, size_t err_size)
{
    struct sums all = {0, 0, 0, 0};
    double worst = 0; /* mean square */

    if (a->width != b->width || a->height != b->height)
        return size_error(a, b, err, err_size);
    for (int y = 0; y < a->height; y += COMPARE_TILE)
        for (int x = 0; x < a->width; x += COMPARE_TILE) {
            struct sums s = tile_sums(a, b, x, y);
            all.square += s.square;
            all.difference += s.difference;
            all.samples += s.samples;
            all.max = s.max > all.max ? s.max : all.max;
            worst = fmax(worst, s.square / s.samples);
        }
    result->rmse = sqrt(all.square / all.samples);
    result->mean = all.difference / all.samples;
    result->max = all.max;
    result->worst_tile = sqrt(worst);
    result->psnr =
        result->rmse > 0 ? 20 * log10(255 / result->rmse) : (double)INFINITY;
    return 0;
}

/// The command ///

#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
static int
complain(const char *fmt, ...)
{
    va_list ap;

    fputs("brume compare: ", stderr);
    va_start(ap, fmt);
    vfprintf(stderr, fmt, ap);
    va_end(ap);
    fputc('\n', stderr);
    return -1;
}

static int parse_limit(const char *text, double *limit)
{
    char *end;

    if (!text)
        return complain("--max-rmse needs a number");
    *limit = strtod(text, &end);
    if (end == text || *end || !isfinite(*limit) || *limit < 0)
        return complain("--max-rmse %s: must be a number from 0 up", text);
    return 0;
}

static int parse_options(int argc, char **argv, struct options *o)
{
    int paths = 0, literal = 0;

    for (int i = 1; i < argc; i++) {
        if (!literal && strcmp(argv[i], "--help") == 0) {
            o->help = 1;
            return 0;
        }
        if (!literal && strcmp(argv[i], "--") == 0) {
            literal = 1;
        } else if (!literal && strcmp(argv[i], "--max-rmse") == 0) {
            i++;
            if (parse_limit(i < argc ? argv[i] : NULL, &o->max_rmse))
                return -1;
        } else if (!literal && argv[i][0] == '-') {
            return complain("unknown option %s; see --help", argv[i]);
        } else if (paths == 2) {
            return complain("more than two pictures: %s", argv[i]);
        } else {
            o->path[paths++] = argv[i];
        }
    }
    if (paths < 2)
        return complain("needs two pictures; see --help");
    return 0;
}

static int compare_files(const char *const path[2],
                         struct compare_result *result)
{
    struct image a, b = {0, 0, 0, NULL, NULL};
    char err[MESSAGE_SIZE];
    int status = image_read(path[0], &a, err, sizeof err);

    if (status == 0)
        status = image_read(path[1], &b, err, sizeof err);
    if (status)
        complain("%s", err);
    else if ((status = image_compare(&a, &b, result, err, sizeof err)) != 0)
        complain("%s and %s: %s", path[0], path[1], err);
    image_free(&a);
    image_free(&b);
    return status;
}

static int print_result(const struct compare_result *r)
{
    /* No "-0.000000". */
    printf("rmse=%.6f\nmean=%.6f\n", r->rmse,
           fabs(r->mean) < 5e-7 ? 0.0 : r->mean);
    if (isinf(r->psnr))
        printf("psnr=inf\n");
    else
        printf("psnr=%.6f\n", r->psnr);
    printf("max=%.6f\nworst_tile=%.6f\n", r->max, r->worst_tile);
    if (fflush(stdout) != 0 || ferror(stdout))
        return complain("cannot write the result");
    return 0;
}

int compare_main(int argc, char **argv)
{
    struct options o = {{NULL, NULL}, -1, 0};
    struct compare_result result;

    if (parse_options(argc, argv, &o))
        return 2;
    if (o.help)
        return fputs(usage, stdout) < 0 || fflush(stdout) != 0 ? 2 : 0;
    if (compare_files(o.path, &result) || print_result(&result))
        return 2;
    if (o.max_rmse >= 0 && result.rmse > o.max_rmse) {
        complain("rmse %.6f is above --max-rmse %g", result.rmse, o.max_rmse);
        return 1;
    }
    return 0;
}
