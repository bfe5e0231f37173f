/* SPDX-License-Identifier: MIT */
#include "scene_files.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define FAR 1e9            /* world coordinates; the core's limits come later */
#define MOST_DENSITY 0.999 /* per voxel: Q0.32 ends below 1 */

static struct scene_file_data *s_first;

/// Shapes ///

/* A shape in the units of its line. */
struct shape {
    uint8_t kind;
    double centre[3], half[3], density, softness;
};

static int read_shape(const struct list_item *item, struct shape *out,
                      char *err, size_t err_size)
{
    bool box = list_is_word(item, 0, "box");
    if (!box && !list_is_word(item, 0, "sphere"))
        return list_fail(item, 0, "a shape is sphere or box", err, err_size);
    memset(out, 0, sizeof *out);
    out->kind = box ? BRUME_FOG_BOX : BRUME_FOG_SPHERE;
    if (list_numbers(item, 1, "the centre", 3, -FAR, FAR, out->centre, err,
                     err_size) != 0 ||
        list_numbers(item, 2, box ? "half the sides" : "the radius",
                     box ? 3 : 1, 0, FAR, out->half, err, err_size) != 0 ||
        list_numbers(item, 3, "the density", 1, 0, MOST_DENSITY, &out->density,
                     err, err_size) != 0)
        return -1;
    if (item->count > 4 && list_numbers(item, 4, "the softness", 1, 0, 1,
                                        &out->softness, err, err_size) != 0)
        return -1;
    if (item->count > 5)
        return list_fail(item, 5, "the line ends after the softness", err,
                         err_size);
    return 0;
}

static int read_shapes(struct scene_file_data *data, char *err, size_t err_size)
{
    struct shape shape;
    if (list_read(&data->shapes, data->path, BRUME_MAX_FOG_SHAPES, "shapes",
                  err, err_size) != 0)
        return -1;
    for (size_t i = 0; i < data->shapes.count; i++)
        if (read_shape(&data->shapes.item[i], &shape, err, err_size) != 0) {
            list_free(&data->shapes);
            return -1;
        }
    return 0;
}

static int put_shape(const struct list_item *item,
                     const struct volume_file *file,
                     struct brume_fog_shape *out, char *err, size_t err_size)
{
    struct shape shape;
    double centre[3];
    if (read_shape(item, &shape, err, err_size) != 0)
        return -1;
    volume_file_to_pool(file, shape.centre, centre);
    memset(out, 0, sizeof *out);
    out->kind = shape.kind;
    for (int i = 0; i < 3; i++) {
        double half = shape.half[i] / file->voxel_size;
        bool used = i == 0 || shape.kind == BRUME_FOG_BOX;
        if (!(fabs(centre[i]) <= BRUME_MAX_COORDINATE / 65536.0)) {
            snprintf(err, err_size,
                     "%s: the centre is %.0f voxels from the volume's corner, "
                     "at most %d can be reached",
                     item->where, fabs(centre[i]), BRUME_MAX_COORDINATE >> 16);
            return -1;
        }
        if (used && !(half >= 1 && half <= 16384)) {
            snprintf(err, err_size,
                     "%s: half a side of %.3g voxels, outside 1 to 16384",
                     item->where, half);
            return -1;
        }
        out->centre[i] = (int32_t)floor(centre[i] * 65536.0 + 0.5);
        out->half[i] = used ? (uint32_t)floor(half * 65536.0 + 0.5) : 0;
    }
    out->softness = (uint32_t)floor(shape.softness * 65536.0 + 0.5);
    out->density = (uint32_t)floor(shape.density * 4294967296.0 + 0.5);
    return 0;
}

int scene_file_shapes(const struct scene_file_data *data,
                      const struct volume_file *file,
                      struct brume_fog_shape *out, char *err, size_t err_size)
{
    for (size_t i = 0; i < data->shapes.count; i++)
        if (put_shape(&data->shapes.item[i], file, &out[i], err, err_size) != 0)
            return -1;
    return 0;
}

/// Files ///

static int read_data(struct scene_file_data *data, char *err, size_t err_size)
{
    switch (data->key) {
    case SCENE_FOG_SHAPES: return read_shapes(data, err, err_size);
    case SCENE_SURFACE:
        return grey16_read(data->path, &data->surface, err, err_size);
    default:
        return sun_map_file_read(data->path, &data->sun_map, err, err_size);
    }
}

static struct scene_file_data *find(int key, const char *path)
{
    struct scene_file_data *data = s_first;
    while (data != NULL && (data->key != key || strcmp(data->path, path) != 0))
        data = data->next;
    return data;
}

int scene_file_load(int key, const char *text,
                    const struct scene_file_data **out, const char *where,
                    char *err, size_t err_size)
{
    char reason[SCENE_LINE_SIZE] = "not enough memory";
    struct scene_file_data *data = find(key, text);
    *out = data;
    if (data != NULL || strcmp(text, "none") == 0)
        return 0;
    data = calloc(1, sizeof *data);
    if (data != NULL) {
        data->key = key;
        snprintf(data->path, sizeof data->path, "%s", text);
    }
    if (data == NULL || read_data(data, reason, sizeof reason) != 0) {
        snprintf(err, err_size, "%s: %s: %s", where, scene_keys[key].name,
                 reason);
        free(data);
        return -1;
    }
    data->next = s_first;
    s_first = data;
    *out = data;
    return 0;
}
