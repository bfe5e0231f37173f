/* SPDX-License-Identifier: MIT */
/*
 * brume-atlas: what the units of the stability atlas need besides the other
 * programs: volumes, a published march that brume does not have, pictures side
 * by side, and two measures. lab/atlas/run.sh calls it.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "atlas.h"
#include "image.h"
#include "metrics.h"
#include "pattern.h"

static const char k_usage[] =
    "usage: brume-atlas volume NAME u8|u8r|u4r OUT.brume [OUT.float]\n"
    "       brume-atlas leap NAME OUT.pfm PIXELS LARGE SMALL SIGMA_T DEPTH\n"
    "       brume-atlas panels GAIN A B C OUT.png\n"
    "       brume-atlas average A_%d.pfm FIRST LAST OUT.pfm\n"
    "       brume-atlas repeats A B DX\n"
    "       brume-atlas mean A [X0 Y0 X1 Y1]\n"
    "\n"
    "  volume   a volume of the atlas, as asset and as float dump\n"
    "  leap     it by long steps with a step back, straight down z\n"
    "  panels   three pictures side by side: linear light times GAIN, in sRGB\n"
    "  average  the mean of grey frames FIRST to LAST\n"
    "  repeats  how alike the error B - A is to itself DX pixels aside: its\n"
    "           correlation, 1 for a tile that repeats\n"
    "  mean     of all samples, or of a rectangle's, in 1/255\n";

static int fail(const char *what)
{
    fprintf(stderr, "brume-atlas: %s\n", what);
    return 2;
}

static int load(const char *path, struct image *image)
{
    char err[400];
    if (image_read(path, image, err, sizeof err) == 0)
        return 0;
    return fail(err);
}

/* Linear, 0 to 1 in 8 bits. */
static double value(const struct image *image, int x, int y, int c)
{
    int n = image->channels;
    size_t i = ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)n +
               (size_t)(c < n ? c : 0);
    return image->u8 ? image->u8[i] / 255.0 : (double)image->f32[i];
}

/// Panels ///

#define GAP 4 /* pixels between pictures, white */

static uint8_t display(double v)
{
    v = fmin(fmax(v, 0), 1);
    v = v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055;
    return (uint8_t)lround(255 * v);
}

/* Pictures of 8 bits are shown as they are: heat maps are. */
static void put_panel(struct image *to, const struct image *from, int x0,
                      double gain)
{
    for (int y = 0; y < from->height; y++)
        for (int x = 0; x < from->width; x++)
            for (int c = 0; c < 3; c++) {
                double v = value(from, x, y, c);
                to->u8[((size_t)y * (size_t)to->width + (size_t)(x0 + x)) * 3 +
                       (size_t)c] =
                    from->u8 ? (uint8_t)lround(255 * v) : display(gain * v);
            }
}

static int panels(char **argv)
{
    struct image p[3] = {{0}, {0}, {0}}, all = {0};
    double gain = strtod(argv[1], NULL);
    char err[400] = "";
    int status = 0, width = -GAP, height = 0, x = 0;
    for (int i = 0; i < 3 && status == 0; i++) {
        status = load(argv[2 + i], &p[i]);
        width += p[i].width + GAP;
        height = p[i].height > height ? p[i].height : height;
    }
    if (status == 0 &&
        image_new_u8(&all, width, height, 3, err, sizeof err) == 0) {
        memset(all.u8, 255, 3 * (size_t)width * (size_t)height);
        for (int i = 0; i < 3; x += p[i].width + GAP, i++)
            put_panel(&all, &p[i], x, gain);
        status = image_write(argv[5], &all, err, sizeof err);
    }
    if (*err)
        status = fail(err);
    for (int i = 0; i < 3; i++)
        image_free(&p[i]);
    image_free(&all);
    return status;
}

/// Measures ///

/* Adds a frame to the sums, which the first one makes. */
static int add_frame(const char *path, double **sum, struct image *frame)
{
    image_free(frame);
    if (load(path, frame))
        return 2;
    if (frame->f32 == NULL || frame->channels != 1)
        return fail("average: frames must be grey .pfm");
    if (*sum == NULL)
        *sum = calloc(image_samples(frame), sizeof **sum);
    if (*sum == NULL)
        return fail("average: no memory");
    for (size_t i = 0; i < image_samples(frame); i++)
        (*sum)[i] += (double)frame->f32[i];
    return 0;
}

static int average(char **argv)
{
    struct image frame = {0};
    double *sum = NULL;
    char err[400], name[PATTERN_SIZE];
    int first = atoi(argv[2]), last = atoi(argv[3]), status = 0;
    if (pattern_check(argv[1], err, sizeof err))
        return fail(err);
    if (first < 0 || last < first)
        return fail("average: FIRST to LAST");
    for (int k = first; k <= last && status == 0; k++) {
        pattern_name(argv[1], (uint32_t)k, name);
        status = add_frame(name, &sum, &frame);
    }
    for (size_t i = 0; status == 0 && i < image_samples(&frame); i++)
        frame.f32[i] = (float)(sum[i] / (last - first + 1));
    if (status == 0 && image_write(argv[4], &frame, err, sizeof err))
        status = fail(err);
    image_free(&frame);
    free(sum);
    return status;
}

/* Correlation of e(x) and e(x + dx), about the mean error. */
static int repeats(char **argv)
{
    struct image a = {0}, b = {0};
    struct metrics_error e;
    char err[400];
    int dx = atoi(argv[3]);
    double both = 0, square = 0, pairs = 0, samples = 0;
    if (load(argv[1], &a) || load(argv[2], &b))
        return 2;
    if (metrics_error(&a, &b, &e, err, sizeof err))
        return fail(err);
    if (dx < 1 || dx >= a.width)
        return fail("repeats: DX must be 1 to the width - 1");
    for (int y = 0; y < a.height; y++)
        for (int x = 0; x < a.width; x++) {
            double d = value(&b, x, y, 0) - value(&a, x, y, 0) - e.mean / 255;
            square += d * d;
            samples++;
            if (x + dx < a.width) {
                both += d * (value(&b, x + dx, y, 0) - value(&a, x + dx, y, 0) -
                             e.mean / 255);
                pairs++;
            }
        }
    printf("%.6f\n", square > 0 ? both / pairs / (square / samples) : 0);
    image_free(&a);
    image_free(&b);
    return 0;
}

static int mean(int argc, char **argv)
{
    struct image a = {0};
    double sum = 0;
    if (load(argv[1], &a))
        return 2;
    int r[4] = {0, 0, a.width, a.height};
    for (int i = 0; argc == 6 && i < 4; i++)
        r[i] = atoi(argv[2 + i]);
    if (r[0] < 0 || r[1] < 0 || r[2] > a.width || r[3] > a.height ||
        r[0] >= r[2] || r[1] >= r[3])
        return fail("mean: the rectangle is not inside");
    for (int y = r[1]; y < r[3]; y++)
        for (int x = r[0]; x < r[2]; x++)
            for (int c = 0; c < a.channels; c++)
                sum += value(&a, x, y, c);
    printf("%.6f\n", 255 * sum / a.channels / (r[2] - r[0]) / (r[3] - r[1]));
    image_free(&a);
    return 0;
}

int main(int argc, char **argv)
{
    const char *name = argc > 1 ? argv[1] : "";
    if (strcmp(name, "--help") == 0)
        return fputs(k_usage, stdout) < 0;
    if (strcmp(name, "volume") == 0)
        return atlas_volume(argc - 1, argv + 1);
    if (strcmp(name, "leap") == 0)
        return atlas_leap(argc - 1, argv + 1);
    if (strcmp(name, "panels") == 0 && argc == 7)
        return panels(argv + 1);
    if (strcmp(name, "average") == 0 && argc == 6)
        return average(argv + 1);
    if (strcmp(name, "repeats") == 0 && argc == 5)
        return repeats(argv + 1);
    if (strcmp(name, "mean") == 0 && (argc == 3 || argc == 7))
        return mean(argc - 1, argv + 1);
    fputs(k_usage, stderr);
    return 2;
}
