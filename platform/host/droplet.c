/* SPDX-License-Identifier: MIT */
/* Equations 4 to 7 of the paper: four ranges of the diameter. */
#include "droplet.h"

#include <math.h>

/* d <= 0.1: close to Rayleigh's. */
static struct droplet fit_smallest(double d)
{
    struct droplet fit = {
        .g_hg = 13.8 * d * d,
        .g_draine = 1.1456 * d * sin(9.29044 * d),
        .alpha = 250,
        .weight = 0.252977 - 312.983 * pow(d, 4.3),
    };
    return fit;
}

/* 0.1 < d <= 1.5 */
static struct droplet fit_small(double d)
{
    const double l = log(d);
    const double inner =
        (l - 0.238604) * (l + 1.00667) / (0.507522 - 0.15677 * l);
    struct droplet fit = {
        .g_hg = 0.862 - 0.143 * l * l,
        .g_draine =
            0.379685 * cos(1.19692 * cos(inner) + 1.37932 * l + 0.0625835) +
            0.344213,
        .alpha = 250,
        .weight =
            0.146209 * cos(3.38707 * l + 2.11193) + 0.316072 + 0.0778917 * l,
    };
    return fit;
}

/* 1.5 < d < 5 */
static struct droplet fit_middle(double d)
{
    const double l = log(d), ll = log(l);
    struct droplet fit = {
        .g_hg = 0.0604931 * ll + 0.940256,
        .g_draine = 0.500411 - 0.081287 / (-2 * l + tan(l) + 1.27551),
        .alpha = 7.30354 * l + 6.31675,
        .weight = 0.026914 * (l - cos(5.68947 * (ll - 0.0292149))) + 0.376475,
    };
    return fit;
}

/* 5 <= d <= 50 */
static struct droplet fit_large(double d)
{
    struct droplet fit = {
        .g_hg = exp(-0.0990567 / (d - 1.67154)),
        .g_draine = exp(-2.20679 / (d + 3.91029) - 0.428934),
        .alpha = exp(3.62489 - 8.29288 / (d + 5.52825)),
        .weight = exp(-0.599085 / (d - 0.641583) - 0.665888),
    };
    return fit;
}

struct droplet droplet_fit(double diameter)
{
    if (diameter <= 0.1)
        return fit_smallest(diameter);
    if (diameter <= 1.5)
        return fit_small(diameter);
    return diameter < 5 ? fit_middle(diameter) : fit_large(diameter);
}
