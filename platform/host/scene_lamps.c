/* SPDX-License-Identifier: MIT */
/* Lamps: text, and the core's. */
#include "scene_lamps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "list_file.h"
#include "scene_keys.h"

#define FAR 1e9 /* world units */
#define MAX_COLOUR 256
#define MAX_SHADOW_SAMPLES 64
#define MAX_ANGLE 179 /* 180 degrees are the core's word for a point light */

const char scene_lamps_words[] = "none FILE";

/* A line of the file, in its own units. */
struct lamp {
    double position[3], radius, size, colour[3];
    bool spot;
    double direction[3], inner, outer;
    double shadow_samples;
    char where[SCENE_WHERE_SIZE];
};

/* Files that were read, the last one first; number 1 is the first. */
static struct kept {
    struct kept *next;
    unsigned number;
    char *path;
    size_t count;
    struct lamp lamp[BRUME_MAX_LAMPS];
} * s_kept;

static const struct kept *kept_of(const double value[SCENE_VALUES])
{
    const struct kept *k = s_kept;
    while (k != NULL && k->number != (unsigned)value[0])
        k = k->next;
    return k;
}

/// Text ///

static int read_colour(const struct list_item *item, size_t i, double out[3],
                       char *err, size_t err_size)
{
    bool grey = i >= item->count || strchr(item->field[i], ',') == NULL;
    if (list_numbers(item, i, "colour", grey ? 1 : 3, 0, MAX_COLOUR, out, err,
                     err_size) != 0)
        return -1;
    if (grey)
        out[1] = out[2] = out[0];
    return 0;
}

static int read_spot(const struct list_item *item, size_t i, struct lamp *l,
                     char *err, size_t err_size)
{
    if (l->spot)
        return list_fail(item, i - 1, "spot is said once", err, err_size);
    l->spot = true;
    if (list_numbers(item, i, "direction", 3, -FAR, FAR, l->direction, err,
                     err_size) != 0 ||
        list_numbers(item, i + 1, "inner angle", 1, 0, MAX_ANGLE, &l->inner,
                     err, err_size) != 0 ||
        list_numbers(item, i + 2, "outer angle", 1, 0, MAX_ANGLE, &l->outer,
                     err, err_size) != 0)
        return -1;
    if (l->outer < l->inner)
        return list_fail(item, i + 2, "outer angle is not below the inner one",
                         err, err_size);
    if (l->direction[0] == 0 && l->direction[1] == 0 && l->direction[2] == 0)
        return list_fail(item, i, "direction has a length", err, err_size);
    return 0;
}

static int read_shadow(const struct list_item *item, size_t i, struct lamp *l,
                       char *err, size_t err_size)
{
    if (list_numbers(item, i, "shadow", 1, 0, MAX_SHADOW_SAMPLES,
                     &l->shadow_samples, err, err_size) != 0)
        return -1;
    if (l->shadow_samples != floor(l->shadow_samples))
        return list_fail(item, i, "shadow is a whole number", err, err_size);
    return 0;
}

static int read_lamp(const struct list_item *item, struct lamp *l, char *err,
                     size_t err_size)
{
    memset(l, 0, sizeof *l);
    memcpy(l->where, item->where, sizeof l->where);
    if (list_numbers(item, 0, "position", 3, -FAR, FAR, l->position, err,
                     err_size) != 0 ||
        list_numbers(item, 1, "radius", 1, 0, FAR, &l->radius, err, err_size) !=
            0 ||
        list_numbers(item, 2, "size", 1, 0, FAR, &l->size, err, err_size) !=
            0 ||
        read_colour(item, 3, l->colour, err, err_size) != 0)
        return -1;
    for (size_t i = 4; i < item->count;) {
        bool spot = list_is_word(item, i, "spot");
        if (!spot && !list_is_word(item, i, "shadow"))
            return list_fail(item, i, "after the colour is spot or shadow", err,
                             err_size);
        if ((spot ? read_spot : read_shadow)(item, i + 1, l, err, err_size) !=
            0)
            return -1;
        i += spot ? 4 : 2;
    }
    return 0;
}

static int read_lamps(const struct list *list, const char *path,
                      double out[SCENE_VALUES], char *err, size_t err_size)
{
    struct kept *k = calloc(1, sizeof *k);
    char *name = strdup(path);
    if (k == NULL || name == NULL) {
        snprintf(err, err_size, "%s: no memory", path);
        goto fail;
    }
    for (; k->count < list->count; k->count++)
        if (read_lamp(&list->item[k->count], &k->lamp[k->count], err,
                      err_size) != 0)
            goto fail;
    k->path = name;
    k->number = s_kept != NULL ? s_kept->number + 1 : 1;
    k->next = s_kept;
    s_kept = k;
    out[0] = k->number;
    return 0;
fail:
    free(name);
    free(k);
    return -1;
}

int scene_lamps_read(const char *text, double out[SCENE_VALUES],
                     const char *where, char *err, size_t err_size)
{
    struct list list;
    char reason[SCENE_LINE_SIZE];
    if (strcmp(text, "none") == 0) {
        out[0] = 0;
        return 0;
    }
    int result =
        list_read(&list, text, BRUME_MAX_LAMPS, "lamps", reason, sizeof reason);
    if (result == 0)
        result = read_lamps(&list, text, out, reason, sizeof reason);
    if (result != 0)
        snprintf(err, err_size, "%s: lamps: %s", where, reason);
    list_free(&list);
    return result;
}

void scene_lamps_print(FILE *to, const double value[SCENE_VALUES])
{
    const struct kept *k = kept_of(value);
    fputs(k != NULL ? k->path : "none", to);
}

/// Lamps ///

static uint32_t q16(double v)
{
    return (uint32_t)floor(v * 65536.0 + 0.5);
}

static int length_of(const struct lamp *l, const char *name, double world,
                     const struct volume_file *file, double min, double max,
                     uint32_t *out, char *err, size_t err_size)
{
    double voxels = world / file->voxel_size;
    if (!(voxels >= min && voxels <= max)) {
        snprintf(err, err_size, "%s: %s is %g voxels, outside %g to %g",
                 l->where, name, voxels, min, max);
        return -1;
    }
    *out = q16(voxels);
    return 0;
}

static int position_of(const struct lamp *l, const struct volume_file *file,
                       int32_t out[3], char *err, size_t err_size)
{
    double pool[3];
    volume_file_to_pool(file, l->position, pool);
    for (int i = 0; i < 3; i++) {
        if (!(fabs(pool[i]) <= BRUME_MAX_COORDINATE / 65536.0)) {
            snprintf(err, err_size,
                     "%s: position is %.0f voxels from the volume's corner, at "
                     "most %d can be reached",
                     l->where, fabs(pool[i]), BRUME_MAX_COORDINATE >> 16);
            return -1;
        }
        out[i] = (int32_t)floor(pool[i] * 65536.0 + 0.5);
    }
    return 0;
}

static int32_t cosine_of(double degrees)
{
    double c = cos(degrees * 3.14159265358979323846 / 180);
    return (int32_t)floor(c * 1073741824.0 + 0.5);
}

static int make_lamp(const struct lamp *l, const struct volume_file *file,
                     struct brume_lamp *out, char *err, size_t err_size)
{
    memset(out, 0, sizeof *out);
    if (position_of(l, file, out->position, err, err_size) != 0 ||
        length_of(l, "radius", l->radius, file, 1, 16384, &out->radius, err,
                  err_size) != 0 ||
        length_of(l, "size", l->size, file, 1.0 / 16,
                  l->radius / file->voxel_size, &out->size, err, err_size) != 0)
        return -1;
    for (int c = 0; c < 3; c++)
        out->colour[c] = q16(l->colour[c]);
    out->cos_outer = -(1 << 30);
    out->shadow_samples = (uint8_t)l->shadow_samples;
    if (!l->spot)
        return 0;
    out->cos_outer = cosine_of(l->outer);
    out->cos_inner = cosine_of(l->inner);
    if (scene_direction(file, l->direction, out->direction) == 0)
        return 0;
    snprintf(err, err_size, "%s: direction has no length", l->where);
    return -1;
}

int scene_lamps_make(const double value[SCENE_VALUES],
                     const struct volume_file *file,
                     struct brume_lamp out[BRUME_MAX_LAMPS], char *err,
                     size_t err_size)
{
    const struct kept *k = kept_of(value);
    size_t count = k != NULL ? k->count : 0;
    for (size_t i = 0; i < count; i++)
        if (make_lamp(&k->lamp[i], file, &out[i], err, err_size) != 0)
            return -1;
    return (int)count;
}
