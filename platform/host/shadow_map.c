/* SPDX-License-Identifier: MIT */
#include "shadow_map.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

#include "pool.h"

#define MOST_TEXELS 1024 /* a side, when nobody says */

/// Place ///

/* The corners of the volume's box, from face to face, in the world. */
static void world_corners(const struct volume_file *file, double out[8][3])
{
    const struct brume_volume *v = &file->volume;
    for (int n = 0; n < 8; n++) {
        double p[3];
        for (int i = 0; i < 3; i++)
            p[i] = n >> i & 1 ? v->box_max[i] + 0.5 : v->box_min[i] - 0.5;
        volume_file_to_world(file, p, out[n]);
    }
}

/* The scene's direction towards the sun, any length. */
static void world_sun(const struct volume_file *file,
                      const struct brume_scene *scene, double out[3])
{
    const double *m = file->world_from_index;
    for (int i = 0; i < 3; i++) {
        out[i] = 0;
        for (int j = 0; j < 3; j++)
            out[i] += m[4 * i + j] * scene->sun[j] / 1073741824.0;
        out[i] /= file->voxel_size;
    }
}

static double default_plane(double corner[8][3])
{
    double low = corner[0][1], high = low;
    for (int n = 1; n < 8; n++) {
        low = fmin(low, corner[n][1]);
        high = fmax(high, corner[n][1]);
    }
    return low - (high - low);
}

/* The rectangle around the shadows of all corners, on the plane and at the
 * height that the map rises to. */
static int default_area(struct shadow_place *place, double corner[8][3],
                        const double sun[3], char *err, size_t err_size)
{
    double *a = place->area;
    bool any = false;
    if (fabs(sun[1]) < 1e-3) {
        snprintf(err, err_size,
                 "the sun is on the horizon: say which --area the map covers");
        return -1;
    }
    for (int n = 0; n < 16; n++) {
        const double *from = corner[n & 7];
        double height = place->plane + (n & 8 ? place->rise : 0);
        double way = (from[1] - height) / sun[1];
        double x = from[0] - way * sun[0], z = from[2] - way * sun[2];
        any = any || way > 0;
        a[0] = n == 0 ? x : fmin(a[0], x);
        a[1] = n == 0 ? z : fmin(a[1], z);
        a[2] = n == 0 ? x : fmax(a[2], x);
        a[3] = n == 0 ? z : fmax(a[3], z);
    }
    if (any)
        return 0;
    snprintf(err, err_size,
             "no shadow falls on a plane at y = %g: the sun is %s it; say "
             "which --area the map covers",
             place->plane, sun[1] > 0 ? "above" : "below");
    return -1;
}

static void default_size(struct shadow_place *place, double voxel_size)
{
    const double *a = place->area;
    double w = fabs(a[2] - a[0]) / voxel_size;
    double h = fabs(a[3] - a[1]) / voxel_size;
    double scale = fmin(1, MOST_TEXELS / fmax(fmax(w, h), 1));
    place->size[0] = (unsigned)fmax(1, ceil(w * scale - 1e-6));
    place->size[1] = (unsigned)fmax(1, ceil(h * scale - 1e-6));
}

/* A point or edge of the map into the core's units. */
static int put_vector(const char *what, const double v[3], int32_t out[3],
                      char *err, size_t err_size)
{
    for (int i = 0; i < 3; i++) {
        if (!(fabs(v[i]) <= BRUME_MAX_COORDINATE / 65536.0)) {
            snprintf(err, err_size,
                     "%s is %.0f voxels away, at most %d can be reached", what,
                     fabs(v[i]), BRUME_MAX_COORDINATE >> 16);
            return -1;
        }
        out[i] = (int32_t)floor(v[i] * 65536.0 + 0.5);
    }
    return 0;
}

static int put_map(const struct shadow_place *place,
                   struct brume_shadow_map *map, const struct volume_file *file,
                   char *err, size_t err_size)
{
    const double *a = place->area;
    const double corner[3] = {a[0], place->plane, a[1]};
    const double across[3] = {a[2] - a[0], 0, 0}, down[3] = {0, 0, a[3] - a[1]};
    const double rise[3] = {0, place->rise * 65536.0 / 65535.0, 0};
    double p[3];
    volume_file_to_pool(file, corner, p);
    if (put_vector("the map's corner", p, map->origin, err, err_size) != 0)
        return -1;
    volume_file_direction(file, across, p);
    if (put_vector("the map's right edge", p, map->across, err, err_size) != 0)
        return -1;
    volume_file_direction(file, down, p);
    if (put_vector("the map's last row", p, map->down, err, err_size) != 0)
        return -1;
    volume_file_direction(file, rise, p);
    return put_vector("the highest of the map", p, map->rise, err, err_size);
}

int shadow_map_place(struct shadow_place *place, struct brume_shadow_map *map,
                     const struct volume_file *file,
                     const struct brume_scene *scene, char *err,
                     size_t err_size)
{
    double corner[8][3], sun[3];
    world_corners(file, corner);
    world_sun(file, scene, sun);
    if (!place->has_plane)
        place->plane = default_plane(corner);
    if (!place->has_area &&
        default_area(place, corner, sun, err, err_size) != 0)
        return -1;
    if (!place->has_size)
        default_size(place, file->voxel_size);
    map->width = (uint16_t)place->size[0];
    map->height = (uint16_t)place->size[1];
    map->heights = place->heights;
    map->heights_stride = place->size[0];
    map->step = scene->step;
    return put_map(place, map, file, err, err_size);
}

/// Texels ///

#define TASK_ROWS 4u

struct job {
    struct brume_shadow shadow;
    uint8_t *transmittance;
    struct brume_shadow_depth *depth;
    unsigned tasks;
    bool progress;
    atomic_uint done;
};

/* Whose thread it is does not matter: each line is whole. */
static void show_bar(struct job *job)
{
    unsigned done = atomic_fetch_add(&job->done, 1) + 1;
    unsigned percent = done * 100 / job->tasks;
    if (!job->progress || (done - 1) * 100 / job->tasks == percent)
        return;
    if (done == job->tasks)
        fputs("\r\033[K", stderr);
    else
        fprintf(stderr, "\rshadow [%-25.*s] %3u %%", (int)percent / 4,
                "#########################", percent);
}

static void render_rows(void *arg, unsigned task, unsigned worker)
{
    struct job *job = arg;
    const struct brume_shadow_map *map = &job->shadow.map;
    unsigned y = task * TASK_ROWS, rows = map->height - y;
    size_t at = (size_t)y * map->width;
    (void)worker;
    brume_shadow_rect(&job->shadow, 0, y, map->width,
                      rows < TASK_ROWS ? rows : TASK_ROWS,
                      job->transmittance + at, map->width,
                      job->depth != NULL ? job->depth + at : NULL, map->width);
    show_bar(job);
}

int shadow_map_render(const struct brume_shadow_map *map,
                      const struct brume_volume *volume,
                      const struct brume_scene *scene, int threads,
                      bool progress, uint8_t *transmittance,
                      struct brume_shadow_depth *depth, char *err,
                      size_t err_size)
{
    struct job *job = calloc(1, sizeof *job);
    struct pool *pool = threads > 1 ? pool_new(threads) : NULL;
    int error = job == NULL
                    ? BRUME_OK
                    : brume_shadow_begin(&job->shadow, volume, scene, map);
    if (job == NULL) {
        snprintf(err, err_size, "not enough memory");
    } else if (error == BRUME_ERR_SCENE) {
        snprintf(err, err_size,
                 "a corner of the map is more than %d voxels away",
                 BRUME_MAX_COORDINATE >> 16);
    } else if (error) {
        snprintf(err, err_size, "%s", brume_error_text(error));
    } else {
        job->transmittance = transmittance;
        job->depth = depth;
        job->progress = progress;
        job->tasks = (map->height + TASK_ROWS - 1) / TASK_ROWS;
        atomic_init(&job->done, 0);
        pool_run(pool, render_rows, job, job->tasks);
    }
    int status = job == NULL || error ? -1 : 0;
    pool_free(pool);
    free(job);
    return status;
}
