/* SPDX-License-Identifier: MIT */
#include "surface.h"

#include <math.h>
#include <string.h>

/// Vectors ///

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void normalise(double v[3])
{
    double length = sqrt(dot(v, v));
    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

/// Scene ///

/* A scene that asks for rays alone: what has light is left out, and with it
 * all that light would need. */
static void keep_camera(struct surface *s, const struct brume_scene *scene)
{
    struct brume_scene *out = &s->scene;
    *out = *scene;
    out->light = BRUME_NO_LIGHT;
    out->filter = BRUME_NEAREST;
    out->output = BRUME_LINEAR;
    out->jitter = BRUME_JITTER_NONE;
    out->noise = BRUME_NOISE_NONE;
    out->temporal = BRUME_TEMPORAL_NONE;
    out->spatial = BRUME_SPATIAL_NONE;
    out->resolution = BRUME_FULL;
    out->update = BRUME_UPDATE_ALL;
    out->subpixel = false;
    if (scene->lighting == NULL)
        return;
    s->lighting = *scene->lighting;
    s->lighting.dither = false;
    s->lighting.ambient = BRUME_AMBIENT_NONE;
    s->lighting.fog = NULL;
    s->lighting.lamps = NULL;
    s->lighting.lamp_count = 0;
    s->lighting.surface = NULL;
    s->lighting.sun_map = NULL;
    s->lighting.emission_colour = NULL;
    out->lighting = &s->lighting;
}

/* That of the scene's ambient light from above. */
static void ambient_sky(const struct brume_lighting *l, double out[3])
{
    int from = 0;
    if (l != NULL && l->ambient == BRUME_AMBIENT_CUBE)
        from = 2;
    for (int c = 0; c < 3; c++)
        out[c] = l == NULL || l->ambient == BRUME_AMBIENT_NONE
                     ? 0.1
                     : l->ambient_colour[from][c] / 65536.0;
}

static void take_light(struct surface *s, const struct brume_lighting *l,
                       const double *sky)
{
    s->exposure = 1;
    if (l != NULL && l->exposure != 0)
        s->exposure = l->exposure / 65536.0;
    if (sky != NULL)
        memcpy(s->sky_light, sky, sizeof s->sky_light);
    else
        ambient_sky(l, s->sky_light);
    for (int c = 0; c < 3; c++)
        s->sun_light[c] = 4 * (l == NULL ? 1 : l->sun_colour[c] / 65536.0);
    s->lamps = l == NULL ? NULL : l->lamps;
    s->lamp_count = l == NULL ? 0 : l->lamp_count;
}

int surface_begin(struct surface *surface, const struct brume_scene *scene,
                  const double sky[3], char *err, size_t err_size)
{
    static const double k_up[3] = {0, 1, 0};
    struct surface *s = surface;
    const double *m = s->file->world_from_index;
    keep_camera(s, scene);
    take_light(s, scene->lighting, sky);
    int error = brume_begin_frame(&s->frame, &s->file->volume, &s->scene);
    if (error)
        return image_error(err, err_size, "%s", brume_error_text(error));
    for (int i = 0; i < 3; i++) {
        s->eye[i] = s->scene.eye[i] / 65536.0;
        s->sun[i] = s->frame.sun[i] / 1073741824.0;
    }
    normalise(s->sun);
    for (int i = 0; i < 3; i++)
        s->world_sun[i] = m[4 * i] * s->sun[0] + m[4 * i + 1] * s->sun[1] +
                          m[4 * i + 2] * s->sun[2];
    normalise(s->world_sun);
    volume_file_direction(s->file, k_up, s->zenith);
    normalise(s->zenith);
    return 0;
}

void surface_ray(const struct surface *surface, double u, double v,
                 double out[3])
{
    const struct brume_frame *f = &surface->frame;
    for (int i = 0; i < 3; i++)
        out[i] = f->ahead[i] + u * f->per_x[i] + v * f->per_y[i];
    normalise(out);
}

/// Depth ///

uint16_t surface_depth_code(double voxels)
{
    const uint32_t farthest = 0xffdfffffu; /* of code 65534 */
    double q16 = floor(voxels * 65536.0);
    uint32_t t = q16 >= farthest ? farthest : q16 > 0 ? (uint32_t)q16 : 0;
    unsigned high = 0;
    while (t >> high > 1)
        high++;
    uint32_t mantissa = high > 11 ? t >> (high - 11) : t << (11 - high);
    return (uint16_t)(high << 11 | (mantissa & 0x7ffu));
}

struct depth_job {
    const struct surface *surface;
    struct grey16 *out;
};

static void depth_row(void *arg, unsigned row, unsigned worker)
{
    struct depth_job *job = arg;
    const struct surface *s = job->surface;
    int w = job->out->width, h = job->out->height;
    uint16_t *out = job->out->values + (size_t)row * (size_t)w;
    (void)worker;
    for (int x = 0; x < w; x++) {
        double unit[3];
        struct ray_hit hit;
        surface_ray(s, 2 * x + 1 - w, h - 1 - 2 * (int)row, unit);
        out[x] = 65535;
        if (caster_nearest(s->caster, s->eye, unit, INFINITY, &hit))
            out[x] = surface_depth_code(hit.distance);
    }
}

int surface_depth(const struct surface *surface, struct pool *pool,
                  struct grey16 *out, char *err, size_t err_size)
{
    struct depth_job job = {surface, out};
    if (grey16_new(out, surface->scene.width, surface->scene.height, err,
                   err_size) != 0)
        return -1;
    pool_run(pool, depth_row, &job, (unsigned)out->height);
    return 0;
}

/// Sun map ///

/* Axes of the map, right and down of one who looks from the sun, pool space;
 * down is as far from the zenith as that lets. */
static void map_axes(const struct surface *s, double right[3], double down[3])
{
    const double *sun = s->sun, *up = s->zenith;
    const double x[3] = {1, 0, 0}, z[3] = {0, 0, 1};
    if (fabs(dot(up, sun)) > 0.999)
        up = fabs(sun[2]) < 0.9 ? z : x;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        right[i] = up[j] * sun[k] - up[k] * sun[j];
    }
    normalise(right);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        down[i] = right[j] * sun[k] - right[k] * sun[j];
    }
}

/* Along right, down and away from the sun. */
struct extent {
    const double *axis[3];
    double low[3], high[3];
};

static void include(struct extent *e, const double p[3])
{
    for (int i = 0; i < 3; i++) {
        double at = dot(p, e->axis[i]);
        e->low[i] = fmin(e->low[i], at);
        e->high[i] = fmax(e->high[i], at);
    }
}

static void cover_all(const struct surface *s, const double *cover,
                      struct extent *e)
{
    const struct brume_volume *v = &s->file->volume;
    for (int i = 0; i < 3; i++) {
        e->low[i] = INFINITY;
        e->high[i] = -INFINITY;
    }
    for (int n = 0; n < 8; n++) {
        double p[3], world[3];
        for (int i = 0; i < 3; i++) {
            world[i] = cover != NULL ? cover[i + 3 * (n >> i & 1)] : 0;
            p[i] = n >> i & 1 ? v->box_max[i] + 0.5 : v->box_min[i] - 0.5;
        }
        if (cover != NULL)
            volume_file_to_pool(s->file, world, p);
        include(e, p);
    }
    for (uint32_t i = 0; i < s->mesh->vertices && cover == NULL; i++)
        include(e, s->mesh->vertex[i]);
    /* What is above the cover shades it, and what is not above it need not be
     * seen: only the way along the sun has to hold all. */
    double low = e->low[2];
    for (uint32_t i = 0; i < s->mesh->vertices; i++)
        low = fmin(low, dot(s->mesh->vertex[i], e->axis[2]));
    e->low[2] = low;
}

struct map_job {
    const struct surface *surface;
    struct grey16 *texels;
    double corner[3], right[3], down[3], away[3];
    double side[2], range; /* of a texel, and from white to black; voxels */
};

static void map_row(void *arg, unsigned row, unsigned worker)
{
    struct map_job *job = arg;
    struct grey16 *t = job->texels;
    (void)worker;
    for (int x = 0; x < t->width; x++) {
        double from[3];
        struct ray_hit hit;
        uint16_t *out = &t->values[row * (size_t)t->width + (size_t)x];
        for (int i = 0; i < 3; i++)
            from[i] = job->corner[i] +
                      job->right[i] * (x + 0.5) * job->side[0] +
                      job->down[i] * (row + 0.5) * job->side[1];
        *out = 65535;
        if (caster_nearest(job->surface->caster, from, job->away, job->range,
                           &hit))
            *out = (uint16_t)fmin(
                floor(hit.distance / job->range * 65535 + 0.5), 65534);
    }
}

/* A direction of pool space in world units. */
static void direction_to_world(const struct surface *s, const double v[3],
                               double length, double out[3])
{
    const double *m = s->file->world_from_index;
    for (int i = 0; i < 3; i++)
        out[i] = (m[4 * i] * v[0] + m[4 * i + 1] * v[1] + m[4 * i + 2] * v[2]) *
                 length;
}

int surface_sun_map(const struct surface *surface, struct pool *pool,
                    const unsigned size[2], const double *cover, double bias,
                    struct sun_map_file *out, char *err, size_t err_size)
{
    const struct surface *s = surface;
    struct map_job job = {.surface = s, .texels = &out->texels};
    struct extent e = {{job.right, job.down, job.away}, {0}, {0}};
    memset(out, 0, sizeof *out);
    for (int i = 0; i < 3; i++)
        job.away[i] = -s->sun[i];
    map_axes(s, job.right, job.down);
    cover_all(s, cover, &e);
    /* A voxel of air around it; texels outside of the map are lit. */
    for (int i = 0; i < 3; i++) {
        e.low[i] -= 1;
        e.high[i] += 1;
    }
    job.range = e.high[2] - e.low[2];
    for (int k = 0; k < 2; k++)
        job.side[k] = (e.high[k] - e.low[k]) / size[k];
    for (int i = 0; i < 3; i++)
        job.corner[i] = job.right[i] * e.low[0] + job.down[i] * e.low[1] +
                        job.away[i] * e.low[2];
    if (grey16_new(&out->texels, (int)size[0], (int)size[1], err, err_size) !=
        0)
        return -1;
    pool_run(pool, map_row, &job, size[1]);
    volume_file_to_world(s->file, job.corner, out->origin);
    direction_to_world(s, job.right, job.side[0] * size[0], out->across);
    direction_to_world(s, job.down, job.side[1] * size[1], out->down);
    out->range = job.range * s->file->voxel_size;
    out->bias = bias;
    if (bias < 0)
        out->bias =
            (sqrt(job.side[0] * job.side[0] + job.side[1] * job.side[1]) +
             job.range / 65535) *
            s->file->voxel_size;
    return 0;
}
