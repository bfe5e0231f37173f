/* SPDX-License-Identifier: MIT */
/* The picture of things: see surface.h. */
#include "surface.h"

#include <math.h>
#include <stdlib.h>

/// Facets ///

/* Where a ray met the things. */
struct spot {
    double point[3], normal[3]; /* towards the eye, unit */
    uint8_t thing;
};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void find_spot(const struct surface *s, const double unit[3],
                      const struct ray_hit *hit, struct spot *out)
{
    const uint32_t *t = s->mesh->triangle[hit->triangle];
    const double *a = s->mesh->vertex[t[0]];
    double b[3], c[3], reach = 1;
    for (int i = 0; i < 3; i++) {
        b[i] = s->mesh->vertex[t[1]][i] - a[i];
        c[i] = s->mesh->vertex[t[2]][i] - a[i];
        out->point[i] = s->eye[i] + unit[i] * hit->distance;
        reach = fmax(reach, fabs(out->point[i]));
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out->normal[i] = b[j] * c[k] - b[k] * c[j];
    }
    double length = sqrt(dot(out->normal, out->normal));
    if (dot(out->normal, unit) > 0)
        length = -length;
    /* Off the facet by more than rounding may have put the point behind it. */
    for (int i = 0; i < 3; i++) {
        out->normal[i] /= length;
        out->point[i] += out->normal[i] * reach * 1e-9;
    }
    out->thing = s->mesh->thing[hit->triangle];
}

/// Light ///

/* The volume's shadow: of the point's place on the map's plane along the sun,
 * between the middles of four texels. */
static double through_volume(const struct surface *s, const double point[3])
{
    const struct surface_shade *h = &s->shade;
    const double *sun = s->world_sun, *a = h->area;
    double p[3], at[2], part[2], sum = 0;
    if (h->map == NULL || fabs(sun[1]) < 1e-6)
        return 1;
    volume_file_to_world(s->file, point, p);
    double way = (p[1] - h->plane) / sun[1];
    at[0] = (p[0] - way * sun[0] - a[0]) / (a[2] - a[0]) * h->map->width;
    at[1] = (p[2] - way * sun[2] - a[1]) / (a[3] - a[1]) * h->map->height;
    if (!(at[0] >= 0 && at[0] <= h->map->width && at[1] >= 0 &&
          at[1] <= h->map->height))
        return 1;
    for (int k = 0; k < 2; k++) {
        double low = floor(at[k] - 0.5);
        part[k] = at[k] - 0.5 - low;
        at[k] = low;
    }
    for (int n = 0; n < 4; n++) {
        int x = (int)at[0] + (n & 1), y = (int)at[1] + (n >> 1);
        x = x < 0 ? 0 : x >= h->map->width ? h->map->width - 1 : x;
        y = y < 0 ? 0 : y >= h->map->height ? h->map->height - 1 : y;
        sum += (n & 1 ? part[0] : 1 - part[0]) *
               (n >> 1 ? part[1] : 1 - part[1]) *
               h->map->u8[(size_t)y * (size_t)h->map->width + (size_t)x];
    }
    return sum / 255;
}

/* 4 cos times what comes of the lamp's light: struct brume_lamp. */
static double lamp_at(const struct surface *s, const struct brume_lamp *lamp,
                      const struct spot *spot)
{
    double to[3], axis[3], square = 0;
    double radius = lamp->radius / 65536.0, size = lamp->size / 65536.0;
    for (int i = 0; i < 3; i++) {
        to[i] = lamp->position[i] / 65536.0 - spot->point[i];
        axis[i] = lamp->direction[i];
        square += to[i] * to[i];
    }
    double r = sqrt(square), facing = dot(to, spot->normal);
    if (!(r < radius) || !(facing > 0))
        return 0;
    for (int i = 0; i < 3; i++)
        to[i] /= r;
    double part = square * square / (radius * radius * radius * radius);
    double fall = size / fmax(r, size) * (1 - part);
    double light = 4 * facing / r * fall * fall;
    if (lamp->cos_outer > -(1 << 30)) {
        double outer = lamp->cos_outer / 1073741824.0;
        double inner = lamp->cos_inner / 1073741824.0;
        double x = -dot(to, axis) / sqrt(dot(axis, axis));
        x = x >= inner ? 1 : x <= outer ? 0 : (x - outer) / (inner - outer);
        light *= x * x * (3 - 2 * x);
    }
    if (light > 0 && caster_meets(s->caster, spot->point, to, r))
        return 0;
    return light;
}

/* Linear radiance towards the eye. */
static void shade(const struct surface *s, const struct spot *spot,
                  double out[3])
{
    double facing = dot(spot->normal, s->sun);
    double open = (1 + dot(spot->normal, s->zenith)) / 2;
    if (facing > 0 && !caster_meets(s->caster, spot->point, s->sun, INFINITY))
        facing *= through_volume(s, spot->point);
    else
        facing = 0;
    for (int c = 0; c < 3; c++)
        out[c] = s->sun_light[c] * facing + s->sky_light[c] * open;
    for (uint32_t n = 0; n < s->lamp_count; n++) {
        double light = lamp_at(s, &s->lamps[n], spot);
        for (int c = 0; c < 3; c++)
            out[c] += light * s->lamps[n].colour[c] / 65536.0;
    }
    for (int c = 0; c < 3; c++)
        out[c] *= s->albedo[spot->thing][c] * s->exposure;
}

/// Picture ///

struct colour_job {
    const struct surface *surface;
    unsigned samples;
    struct image *out;
};

/* What is behind, 1 where it is that or more: the core's, linear. */
static void background_at(const struct surface *s, unsigned x, unsigned y,
                          double out[3])
{
    const struct brume_radiance clear = {.transmittance = 0x10000u};
    uint16_t code[3] = {0, 0, 0};
    brume_pack_rect(&s->frame, &clear, 1, x, y, 1, 1, BRUME_RGB161616, code,
                    sizeof code);
    for (int c = 0; c < 3; c++)
        out[c] = code[c] / 65535.0;
}

static void colour_pixel(const struct colour_job *job, unsigned x, unsigned y,
                         float *out)
{
    const struct surface *s = job->surface;
    unsigned n = job->samples, free_ones = 0;
    double sum[3] = {0, 0, 0}, one[3];
    for (unsigned k = 0; k < n * n; k++) {
        double u = 2 * (x + (k % n + 0.5) / n) - s->scene.width;
        double v = s->scene.height - 2 * (y + (k / n + 0.5) / n);
        double unit[3];
        struct ray_hit hit;
        struct spot spot;
        surface_ray(s, u, v, unit);
        if (!caster_nearest(s->caster, s->eye, unit, INFINITY, &hit)) {
            free_ones++;
            continue;
        }
        find_spot(s, unit, &hit, &spot);
        shade(s, &spot, one);
        for (int c = 0; c < 3; c++)
            sum[c] += one[c];
    }
    if (free_ones > 0)
        background_at(s, x, y, one);
    for (int c = 0; c < 3; c++)
        out[c] = (float)((sum[c] + (free_ones > 0 ? free_ones * one[c] : 0)) /
                         (n * n));
}

static void colour_row(void *arg, unsigned row, unsigned worker)
{
    struct colour_job *job = arg;
    size_t w = (size_t)job->out->width;
    (void)worker;
    for (unsigned x = 0; x < w; x++)
        colour_pixel(job, x, row, job->out->f32 + (row * w + x) * 3);
}

int surface_colour(const struct surface *surface, struct pool *pool,
                   unsigned samples, struct image *out, char *err,
                   size_t err_size)
{
    struct colour_job job = {surface, samples, out};
    if (image_new_f32(out, surface->scene.width, surface->scene.height, 3, err,
                      err_size) != 0)
        return -1;
    pool_run(pool, colour_row, &job, (unsigned)out->height);
    return 0;
}
