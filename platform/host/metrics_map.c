/* SPDX-License-Identifier: MIT */
/* Maps of a metric over the picture, and their colours. */
#include "metrics_inner.h"

#include <math.h>
#include <string.h>

int metrics_error_map(const struct image *a, const struct image *b,
                      struct image *map, char *err, size_t err_size)
{
    int one = metrics_channels(a), two = metrics_channels(b);
    int channels = one > two ? one : two;

    memset(map, 0, sizeof *map);
    if (metrics_check(a, b, err, err_size) ||
        image_new_f32(map, a->width, a->height, 1, err, err_size))
        return -1;
    for (size_t i = 0; i < metrics_pixels(a); i++) {
        double sum = 0;
        for (int c = 0; c < channels; c++)
            sum += fabs(metrics_sample(b, i, c) - metrics_sample(a, i, c));
        map->f32[i] = (float)(sum / channels / 255);
    }
    return 0;
}

/// Colours ///

/* Magma at k / 9, in sRGB codes; straight lines lie in between. */
#define KNOTS 10
static const uint8_t magma[KNOTS][3] = {
    {0, 0, 4},       {24, 15, 62},    {69, 16, 119}, {114, 31, 129},
    {159, 47, 127},  {205, 64, 113},  {241, 96, 93}, {253, 149, 103},
    {254, 201, 141}, {252, 253, 191},
};

static void colour_of(double share, uint8_t out[3])
{
    double at = (KNOTS - 1) * fmin(fmax(share, 0), 1);
    int knot = at >= KNOTS - 1 ? KNOTS - 2 : (int)at;

    for (int c = 0; c < 3; c++) {
        double low = magma[knot][c], high = magma[knot + 1][c];
        out[c] = (uint8_t)lround(low + (high - low) * (at - knot));
    }
}

int metrics_heat(const struct image *map, double white, struct image *picture,
                 char *err, size_t err_size)
{
    if (image_new_u8(picture, map->width, map->height, 3, err, err_size))
        return -1;
    for (size_t i = 0; i < metrics_pixels(map); i++)
        colour_of((double)map->f32[i] / white, picture->u8 + 3 * i);
    return 0;
}
