/* SPDX-License-Identifier: MIT */
/*
 * Scenes as text for the tests of scenes: a file in a folder of its own, the
 * settings read from it, the core's scene of them on small volumes; and checks
 * of what is taken and refused. The variables are per program, so include it
 * from one source file, after tap.h.
 */
#ifndef BRUME_TESTS_SCENE_TEXT_H
#define BRUME_TESTS_SCENE_TEXT_H

#include "scene_light.h"
#include "support/asset_builder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))

static char dir[64];   /* of this run, removed at the end */
static char path[256]; /* of the scene file in it */
static char err[512];
static struct scene_settings settings; /* of the last text read */
static struct scene_light light;       /* of the last text applied */

/// Texts ///

static inline void put_text(const char *text, size_t size)
{
    FILE *f = fopen(path, "wb");
    if (f == NULL || fwrite(text, 1, size, f) != size || fclose(f) != 0) {
        perror(path);
        exit(1);
    }
}

static inline int read_bytes(const char *text, size_t size)
{
    put_text(text, size);
    memset(&settings, 0, sizeof settings);
    memset(err, 0, sizeof err);
    return scene_read(&settings, path, err, sizeof err);
}

static inline int read_text(const char *text)
{
    return read_bytes(text, strlen(text));
}

/* Refused in one line that starts with the file and line, and says so. */
static inline bool is_refusal(int result, int line, const char *says)
{
    char start[300];
    snprintf(start, sizeof start, "%s:%d: ", path, line);
    bool good = result != 0 && strncmp(err, start, strlen(start)) == 0 &&
                strstr(err, says) != NULL && strchr(err, '\n') == NULL;
    if (!good)
        printf("# result %d, '%s'\n", result, err);
    return good;
}

static inline bool refuses(const char *text, int line, const char *says)
{
    return is_refusal(read_text(text), line, says);
}

static inline bool takes(const char *text, int key, double a, double b,
                         double c)
{
    const double want[3] = {a, b, c};
    bool good = read_text(text) == 0;
    for (int i = 0; i < SCENE_KEYS; i++)
        good = good && settings.set[i] == (i == key);
    for (int i = 0; i < 3; i++)
        good = good && settings.value[key][i] == want[i];
    if (!good)
        printf("# '%s': '%s'\n", text, err);
    return good;
}

static inline void texts_begin(void)
{
    const char *tmp = getenv("TMPDIR");
    snprintf(dir, sizeof dir, "%.40s/brumeXXXXXX", tmp ? tmp : "/tmp");
    if (mkdtemp(dir) == NULL) {
        perror(dir);
        exit(1);
    }
    snprintf(path, sizeof path, "%s/test.scene", dir);
}

static inline void texts_end(void)
{
    remove(path);
    rmdir(dir);
}

/// Volumes ///

struct world {
    double matrix[12];
    double voxel_size;
    int32_t origin[3];
};

static const struct world k_plain = {
    {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, 1, {0, 0, 0}};

/* Turned about z by the 3-4-5 triangle, then about x by 5-12-13; voxels of a
 * quarter. */
static const struct world k_turned = {
    {0.25 * 3 / 5, -0.25 * 4 / 5, 0, 10,                         /* row of x */
     0.25 * 4 * 5 / 65, 0.25 * 3 * 5 / 65, -0.25 * 12 / 13, -20, /* y */
     0.25 * 4 * 12 / 65, 0.25 * 3 * 12 / 65, 0.25 * 5 / 13, 30}, /* z */
    0.25,
    {-7, 11, 5}};

/* Only as large as it must be: the box is in the header. */
static inline struct volume_file make_volume(const struct world *world,
                                             const int low[3],
                                             const int high[3],
                                             uint32_t density)
{
    struct density_box box = {
        {low[0], low[1], low[2]}, {high[0], high[1], high[2]}, density};
    struct asset_spec spec =
        asset_spec_of((high[0] + 7) / 8, (high[1] + 7) / 8, (high[2] + 7) / 8,
                      BRUME_U8R, density_in_box, &box);
    struct volume_file file = {0};
    file.data = asset_build(&spec, &file.size);
    if (brume_volume_open(&file.volume, file.data, file.size, 0) != BRUME_OK)
        abort();
    memcpy(file.world_from_index, world->matrix, sizeof world->matrix);
    memcpy(file.origin, world->origin, sizeof world->origin);
    file.voxel_size = world->voxel_size;
    return file;
}

static inline struct volume_file make_block(const struct world *world)
{
    static const int k_low[3] = {2, 4, 6}, k_high[3] = {40, 30, 20};
    return make_volume(world, k_low, k_high, 20000);
}

static inline int apply_text(const char *text, const struct volume_file *file,
                             struct brume_scene *scene)
{
    if (read_text(text) != 0)
        return -2;
    return scene_apply(&settings, file, scene, &light, err, sizeof err);
}

/* SPEC.md: index = pool + origin, world = matrix * index. */
static inline void world_of(const struct world *w, const double pool[3],
                            double out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = w->matrix[4 * i + 3];
        for (int j = 0; j < 3; j++)
            out[i] += w->matrix[4 * i + j] * (pool[j] + w->origin[j]);
    }
}

/* A direction of the pool in world axes, as a unit vector. */
static inline void world_way(const struct world *w, const int32_t pool[3],
                             double out[3])
{
    double length = 0;
    for (int i = 0; i < 3; i++) {
        out[i] = 0;
        for (int j = 0; j < 3; j++)
            out[i] += w->matrix[4 * i + j] * pool[j];
        length += out[i] * out[i];
    }
    for (int i = 0; i < 3; i++)
        out[i] /= sqrt(length);
}

static inline bool is_near(const double a[3], const double b[3], double bound)
{
    for (int i = 0; i < 3; i++)
        if (!(fabs(a[i] - b[i]) <= bound)) {
            printf("# axis %d: %.12g and %.12g\n", i, a[i], b[i]);
            return false;
        }
    return true;
}

#endif
