/* SPDX-License-Identifier: MIT */
/*
 * Measures of one frame in a region. All but psnr are on the scale where white
 * is 1. To add one, add its name and print its value, in the same place.
 */
#include <math.h>
#include <string.h>

#include "lab.h"
#include "metrics.h"

/* rmse, mean: of picture - truth. spread: sqrt(rmse^2 - mean^2), the error
 * that is left when a constant is taken off. flicker: the mean of
 * |change - change of the truth| since the frame before. */
/* flip, when asked for, comes behind them: the mean of LDR-FLIP. */
const char lab_measure_names[] = "rmse,mean,spread,psnr,max,worst_tile,flicker";

/* Pixels x0 <= x < x1, y0 <= y < y1; at least one. */
struct box {
    int x0, y0, x1, y1;
};

static int part_of(int side, double at)
{
    return (int)fmin(fmax(floor(at * side + 0.5), 0), side);
}

static int box_of(const struct image *image, const struct lab_region *r,
                  struct box *box, char *err, size_t err_size)
{
    box->x0 = part_of(image->width, r->x);
    box->y0 = part_of(image->height, r->y);
    box->x1 = part_of(image->width, r->x + r->w);
    box->y1 = part_of(image->height, r->y + r->h);
    if (box->x0 < box->x1 && box->y0 < box->y1)
        return 0;
    snprintf(err, err_size, "region %s: no pixel of %d x %d", r->name,
             image->width, image->height);
    return -1;
}

/* A sample where white is 1. */
static float sample_at(const struct image *image, size_t at)
{
    return image->u8 ? (float)(image->u8[at] / 255.0) : image->f32[at];
}

/* The box as a picture of its own, so that any measure of whole pictures is
 * one of regions. */
static int cut(const struct image *from, const struct box *b, struct image *to,
               char *err, size_t err_size)
{
    const int w = b->x1 - b->x0, h = b->y1 - b->y0, c = from->channels;
    const size_t row = (size_t)w * (size_t)c;
    if (image_new_f32(to, w, h, c, err, err_size) != 0)
        return -1;
    for (int y = 0; y < h; y++) {
        size_t at =
            ((size_t)(b->y0 + y) * (size_t)from->width + (size_t)b->x0) *
            (size_t)c;
        for (size_t i = 0; i < row; i++)
            to->f32[(size_t)y * row + i] = sample_at(from, at + i);
    }
    return 0;
}

static double flicker_of(const struct lab_pair *p, const struct box *b)
{
    const size_t c = (size_t)p->picture->channels;
    double sum = 0;
    for (int y = b->y0; y < b->y1; y++)
        for (size_t x = (size_t)b->x0 * c; x < (size_t)b->x1 * c; x++) {
            size_t at = (size_t)y * (size_t)p->picture->width * c + x;
            double change = (double)sample_at(p->picture, at) -
                            (double)sample_at(p->before, at);
            double truth = (double)sample_at(p->truth, at) -
                           (double)sample_at(p->truth_before, at);
            sum += fabs(change - truth);
        }
    return sum / ((double)(b->x1 - b->x0) * (b->y1 - b->y0) * (double)c);
}

/* Of linear light as it is shown, or of the codes that are shown. */
static int print_flip(FILE *to, const struct lab_pair *pair,
                      const struct image *picture, const struct image *truth,
                      char *err, size_t err_size)
{
    struct metrics_flip flip;
    if (metrics_flip(truth, picture, pair->picture->u8 == NULL,
                     METRICS_FLIP_DEGREE, &flip, NULL, err, err_size) != 0)
        return -1;
    fprintf(to, ",%.5g", flip.mean);
    return 0;
}

/* Those of whole pictures. */
static int compare(FILE *to, const struct image *picture,
                   const struct image *truth, char *err, size_t err_size)
{
    struct metrics_error r;
    if (metrics_error(truth, picture, &r, err, err_size) != 0)
        return -1;
    double rmse = r.rmse / 255, mean = r.mean / 255;
    double spread = sqrt(fmax(rmse * rmse - mean * mean, 0));
    fprintf(to, "%.5g,%.5g,%.5g,", rmse, mean, spread);
    fprintf(to, isinf(r.psnr) ? "inf," : "%.5g,", r.psnr);
    fprintf(to, "%.5g,%.5g,", r.max / 255, r.worst_tile / 255);
    return 0;
}

int lab_measure(FILE *to, const struct lab_pair *pair,
                const struct lab_region *region, char *err, size_t err_size)
{
    struct image picture = {0}, truth = {0};
    struct box box;
    if (box_of(pair->picture, region, &box, err, err_size) != 0)
        return -1;
    int bad = cut(pair->picture, &box, &picture, err, err_size) != 0 ||
              cut(pair->truth, &box, &truth, err, err_size) != 0 ||
              compare(to, &picture, &truth, err, err_size) != 0;
    if (!bad && pair->before != NULL)
        fprintf(to, "%.5g", flicker_of(pair, &box));
    if (!bad && pair->flip)
        bad = print_flip(to, pair, &picture, &truth, err, err_size) != 0;
    image_free(&picture);
    image_free(&truth);
    return bad ? -1 : 0;
}
