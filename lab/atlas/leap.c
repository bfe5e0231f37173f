/* SPDX-License-Identifier: MIT */
/*
 * The published way over empty space, which brume does not have: long steps
 * until one of them lands in density, then back by one and on in short ones,
 * until so many in a row are empty (Ford 2024, section on adaptive steps, with
 * large = 2 small; others take larger ones). In double, unlit, nearest lookup,
 * orthographic along z: so that what is missed is the method's doing alone.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "atlas.h"
#include "image.h"

struct march {
    size_t volume;
    double large, small, sigma_t, depth;
};

static double opacity(const struct march *m, double x, double y)
{
    double t = 0, transmittance = 1;
    int fine = m->large <= m->small, empty = 0;
    while (t < m->depth) {
        const double p[3] = {x, y, t};
        double d = atlas_density(m->volume, p);
        if (!fine && d > 0) {
            fine = 1;
            empty = 0;
            t = fmax(0, t - m->large + m->small);
            continue;
        }
        if (fine) {
            transmittance *= exp(-m->sigma_t * d * m->small);
            empty = d > 0 ? 0 : empty + 1;
            fine = m->large <= m->small || empty < 2 * m->large / m->small;
        }
        t += fine ? m->small : m->large;
    }
    return 1 - transmittance;
}

static int number(const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    if (end != text && *end == '\0' && *value > 0 && isfinite(*value))
        return 0;
    fprintf(stderr, "brume-atlas: leap: not a positive number: %s\n", text);
    return 2;
}

int atlas_leap(int argc, char **argv)
{
    struct march m;
    struct image image;
    char err[300];
    double size;
    if (argc != 8) {
        fprintf(stderr, "brume-atlas: leap NAME OUT.pfm PIXELS LARGE SMALL "
                        "SIGMA_T DEPTH\n");
        return 2;
    }
    if (atlas_find(argv[1], &m.volume) || number(argv[3], &size) ||
        number(argv[4], &m.large) || number(argv[5], &m.small) ||
        number(argv[6], &m.sigma_t) || number(argv[7], &m.depth))
        return 2;
    int n = (int)size, bad = image_new_f32(&image, n, n, 1, err, sizeof err);
    if (!bad) {
        for (int i = 0; i < n * n; i++)
            image.f32[i] = (float)opacity(&m, (i % n + 0.5) * 64 / n - 0.5,
                                          (i / n + 0.5) * 64 / n - 0.5);
        bad = image_write(argv[2], &image, err, sizeof err);
        image_free(&image);
    }
    if (bad)
        fprintf(stderr, "brume-atlas: %s\n", err);
    return bad != 0;
}
