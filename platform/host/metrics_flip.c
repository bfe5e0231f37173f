/* SPDX-License-Identifier: MIT */
/*
 * LDR-FLIP, from the paper (see metrics.h; sections and formulas are its):
 *
 *   colour    each image as an eye at that distance sees it: low-passed in an
 *             opponent space by the contrast sensitivity of each channel (4.1);
 *             then a distance in Hunt-adjusted L*a*b*, mapped to 0 .. 1
 *   features  edges and points of the unfiltered lightness: where one image has
 *             them and the other has not, differences are seen more (4.2)
 *   both      colour ^ (1 - feature) (4.3)
 *
 * All kernels are sums of separable Gaussians and their derivatives. Edges of
 * the image are repeated.
 */
#include "metrics_inner.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define MOST_RADIUS 64 /* of a kernel, at 200 pixels per degree: 28 */

struct vec {
    double v[3];
};

/* One dimension of a kernel, from -radius to radius. */
struct kernel {
    int radius;
    double w[2 * MOST_RADIUS + 1];
};

struct size {
    int width, height;
};

/// Colour spaces ///

/* Linear sRGB to XYZ, D65; rows sum to the white point. */
static const double xyz_from_rgb[3][3] = {
    {10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
static const double rgb_from_xyz[3][3] = {
    {3.241003275, -1.537398934, -0.498615861},
    {-0.969224334, 1.875930071, 0.041554224},
    {0.055639423, -0.204011202, 1.057148933}};

static struct vec times(const double m[3][3], struct vec a)
{
    struct vec r;

    for (int i = 0; i < 3; i++)
        r.v[i] = m[i][0] * a.v[0] + m[i][1] * a.v[1] + m[i][2] * a.v[2];
    return r;
}

static double white(int i)
{
    return xyz_from_rgb[i][0] + xyz_from_rgb[i][1] + xyz_from_rgb[i][2];
}

/* Linear light, 0 .. 1. */
static struct vec light_at(const struct image *image, size_t i, bool linear)
{
    struct vec r;

    for (int c = 0; c < 3; c++) {
        double s = fmin(fmax(metrics_sample(image, i, c) / 255, 0), 1);
        r.v[c] = linear         ? s
                 : s <= 0.04045 ? s / 12.92
                                : pow((s + 0.055) / 1.055, 2.4);
    }
    return r;
}

/* Linear L*a*b*, in which the eye's filters are linear: Y, Cx, Cz. */
static struct vec opponent(struct vec rgb)
{
    struct vec x = times(xyz_from_rgb, rgb);
    double n[3] = {x.v[0] / white(0), x.v[1] / white(1), x.v[2] / white(2)};
    const struct vec r = {
        {116 * n[1] - 16, 500 * (n[0] - n[1]), 200 * (n[1] - n[2])}};

    return r;
}

/* And back to linear light, clamped to what the display can show. */
static struct vec from_opponent(struct vec o)
{
    double y = (o.v[0] + 16) / 116;
    const struct vec x = {{(y + o.v[1] / 500) * white(0), y * white(1),
                           (y - o.v[2] / 200) * white(2)}};
    struct vec r = times(rgb_from_xyz, x);

    for (int c = 0; c < 3; c++)
        r.v[c] = fmin(fmax(r.v[c], 0), 1);
    return r;
}

static double lab_curve(double t)
{
    const double d = 6.0 / 29;

    return t > d * d * d ? cbrt(t) : t / (3 * d * d) + 4.0 / 29;
}

/* L*a*b* with a and b shrunk in the dark, where the eye sees less colour. */
static struct vec hunt_lab(struct vec rgb)
{
    struct vec x = times(xyz_from_rgb, rgb);
    double f[3], l;

    for (int i = 0; i < 3; i++)
        f[i] = lab_curve(x.v[i] / white(i));
    l = 116 * f[1] - 16;
    const struct vec r = {
        {l, 0.01 * l * 500 * (f[0] - f[1]), 0.01 * l * 200 * (f[1] - f[2])}};
    return r;
}

/* HyAB (Abasi et al. 2020): for large distances of colours. */
static double hyab(struct vec a, struct vec b)
{
    return fabs(a.v[0] - b.v[0]) + hypot(a.v[1] - b.v[1], a.v[2] - b.v[2]);
}

/// Kernels ///

/* Columns of rows, then rows of columns: `from` is left as it is. */
static void convolve(const double *from, double *between, double *to,
                     struct size size, const struct kernel *kx,
                     const struct kernel *ky)
{
    const int w = size.width, h = size.height;

    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            double sum = 0;
            for (int i = -kx->radius; i <= kx->radius; i++) {
                int at = x + i < 0 ? 0 : x + i >= w ? w - 1 : x + i;
                sum += kx->w[kx->radius + i] *
                       from[(size_t)y * (size_t)w + (size_t)at];
            }
            between[(size_t)y * (size_t)w + (size_t)x] = sum;
        }
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            double sum = 0;
            for (int j = -ky->radius; j <= ky->radius; j++) {
                int at = y + j < 0 ? 0 : y + j >= h ? h - 1 : y + j;
                sum += ky->w[ky->radius + j] *
                       between[(size_t)at * (size_t)w + (size_t)x];
            }
            to[(size_t)y * (size_t)w + (size_t)x] = sum;
        }
}

/* Contrast sensitivity (table 1) in space: a sum of a sqrt(pi / b) exp(-pi^2
 * x^2 / b), x in degrees; Y, Cx, Cz. */
static const double csf[3][2][2] = {{{1, 0.0047}, {0, 1e-5}},
                                    {{1, 0.0053}, {0, 1e-5}},
                                    {{34.1, 0.04}, {13.5, 0.025}}};

/* One of the terms, as a kernel of sum 1. Returns its share of the sum over
 * the plane, not yet divided by that of the other. */
static double csf_kernel(const double ab[2], double degree, struct kernel *k)
{
    double sum = 0;

    k->radius = (int)ceil(3 * sqrt(0.04 / (2 * PI * PI)) * degree);
    for (int i = -k->radius; i <= k->radius; i++) {
        double x = i / degree;
        k->w[k->radius + i] = exp(-PI * PI * x * x / ab[1]);
        sum += k->w[k->radius + i];
    }
    for (int i = 0; i <= 2 * k->radius; i++)
        k->w[i] /= sum;
    return ab[0] * sqrt(PI / ab[1]) * sum * sum;
}

/* Planes: the opponent channels of an image, in, and as the eye sees them. */
static void see(double *const channel[3], double *const work[2],
                struct size size, double degree)
{
    const size_t n = (size_t)size.width * (size_t)size.height;
    struct kernel k[2];

    for (int c = 0; c < 3; c++) {
        double one = csf_kernel(csf[c][0], degree, &k[0]);
        double two = csf_kernel(csf[c][1], degree, &k[1]);
        double share = one / (one + two);
        double *first = work[1], *between = work[0];
        convolve(channel[c], between, first, size, &k[0], &k[0]);
        if (csf[c][1][0] == 0) {
            memcpy(channel[c], first, n * sizeof *first);
            continue;
        }
        convolve(channel[c], between, channel[c], size, &k[1], &k[1]);
        for (size_t i = 0; i < n; i++)
            channel[c][i] = share * first[i] + (1 - share) * channel[c][i];
    }
}

/* Positive weights to a sum of 1, negative ones to -1. */
static void balance(struct kernel *k)
{
    double up = 0, down = 0;

    for (int i = 0; i <= 2 * k->radius; i++) {
        up += fmax(k->w[i], 0);
        down -= fmin(k->w[i], 0);
    }
    for (int i = 0; i <= 2 * k->radius; i++)
        k->w[i] /= k->w[i] > 0 ? up : down;
}

/* Detectors as wide as the eye's, 0.082 degrees: a Gaussian, its first and its
 * second derivative. */
static void feature_kernels(double degree, struct kernel *smooth,
                            struct kernel *edge, struct kernel *point)
{
    double sigma = 0.5 * 0.082 * degree, sum = 0;
    int radius = (int)ceil(3 * sigma);

    smooth->radius = edge->radius = point->radius = radius;
    for (int i = -radius; i <= radius; i++) {
        double g = exp(-i * i / (2 * sigma * sigma));
        smooth->w[radius + i] = g;
        edge->w[radius + i] = -i * g;
        point->w[radius + i] = (i * i / (sigma * sigma) - 1) * g;
        sum += g;
    }
    for (int i = 0; i <= 2 * radius; i++)
        smooth->w[i] /= sum;
    balance(edge);
    balance(point);
}

/* Strength of edges and of points: out[0], out[1]. `lightness` is 0 .. 1. */
static void find_features(const double *lightness, double *const work[2],
                          double *const out[2], struct size size, double degree)
{
    const size_t n = (size_t)size.width * (size_t)size.height;
    struct kernel smooth, detect[2];

    feature_kernels(degree, &smooth, &detect[0], &detect[1]);
    for (int k = 0; k < 2; k++) {
        convolve(lightness, work[0], out[k], size, &detect[k], &smooth);
        convolve(lightness, work[0], work[1], size, &smooth, &detect[k]);
        for (size_t i = 0; i < n; i++)
            out[k][i] = hypot(out[k][i], work[1][i]);
    }
}

/// The difference ///

/* Constants of section 4: distances are raised to 0.7, and what is below 0.4 of
 * the largest, from green to blue, fills 0.95 of the range. */
static double colour_difference(struct vec a, struct vec b, double largest)
{
    double d = pow(hyab(hunt_lab(a), hunt_lab(b)), 0.7), knee = 0.4 * largest;

    if (d < knee)
        return 0.95 / knee * d;
    return 0.95 + (d - knee) / (largest - knee) * 0.05;
}

static double largest_difference(void)
{
    const struct vec green = {{0, 1, 0}}, blue = {{0, 0, 1}};

    return pow(hyab(hunt_lab(green), hunt_lab(blue)), 0.7);
}

/* Planes of one image. */
struct seen {
    double *channel[3], *feature[2];
};
#define PLANES 12 /* of two images, and two for work */

static void prepare(const struct image *image, bool linear, double degree,
                    const struct seen *s, double *const work[2])
{
    const struct size size = {image->width, image->height};

    for (size_t i = 0; i < metrics_pixels(image); i++) {
        struct vec o = opponent(light_at(image, i, linear));
        for (int c = 0; c < 3; c++)
            s->channel[c][i] = o.v[c];
    }
    find_features(s->channel[0], work, s->feature, size, degree);
    see(s->channel, work, size, degree);
}

static struct vec colour_at(const struct seen *s, size_t i)
{
    const struct vec o = {
        {s->channel[0][i], s->channel[1][i], s->channel[2][i]}};

    return from_opponent(o);
}

/* Features were found in Y, 116 times lightness plus what they do not see. */
static double flip_at(const struct seen *a, const struct seen *b, size_t i,
                      double largest)
{
    double colour =
        colour_difference(colour_at(a, i), colour_at(b, i), largest);
    double edge = fabs(a->feature[0][i] - b->feature[0][i]) / 116;
    double point = fabs(a->feature[1][i] - b->feature[1][i]) / 116;

    return pow(colour, 1 - sqrt(fmax(edge, point) / sqrt(2)));
}

/* Also into the map, if there is one. */
static void sum_up(const struct seen seen[2], size_t pixels,
                   struct metrics_flip *result, struct image *map)
{
    const double largest = largest_difference();
    double sum = 0, max = 0;

    for (size_t i = 0; i < pixels; i++) {
        double flip = flip_at(&seen[0], &seen[1], i, largest);
        sum += flip;
        max = fmax(max, flip);
        if (map)
            map->f32[i] = (float)flip;
    }
    result->mean = sum / (double)pixels;
    result->max = max;
}

int metrics_flip(const struct image *a, const struct image *b, bool linear,
                 double degree, struct metrics_flip *result, struct image *map,
                 char *err, size_t err_size)
{
    const size_t n = metrics_pixels(a);
    double *planes, *p[PLANES];

    if (map)
        memset(map, 0, sizeof *map);
    if (metrics_check(a, b, err, err_size))
        return -1;
    if (!(degree >= 1 && degree <= 200)) {
        snprintf(err, err_size, "%g pixels per degree: must be 1 to 200",
                 degree);
        return -1;
    }
    planes = metrics_plane(PLANES * n, err, err_size);
    if (!planes ||
        (map && image_new_f32(map, a->width, a->height, 1, err, err_size))) {
        free(planes);
        return -1;
    }
    for (int i = 0; i < PLANES; i++)
        p[i] = planes + (size_t)i * n;
    const struct seen seen[2] = {{{p[0], p[1], p[2]}, {p[3], p[4]}},
                                 {{p[5], p[6], p[7]}, {p[8], p[9]}}};
    prepare(a, linear, degree, &seen[0], p + 10);
    prepare(b, linear, degree, &seen[1], p + 10);
    sum_up(seen, n, result, map);
    free(planes);
    return 0;
}
