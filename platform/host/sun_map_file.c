/* SPDX-License-Identifier: MIT */
#include "sun_map_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAGIC "brume-sun-map 1"

/* The numbers of a file in the order of its lines. */
struct field {
    const char *name;
    int count;
    double *values;
};
enum { FIELDS = 5 };

static void fields_of(struct sun_map_file *map, struct field out[FIELDS])
{
    const struct field fields[FIELDS] = {{"origin", 3, map->origin},
                                         {"across", 3, map->across},
                                         {"down", 3, map->down},
                                         {"range", 1, &map->range},
                                         {"bias", 1, &map->bias}};
    memcpy(out, fields, sizeof fields);
}

/// Reading ///

/* The text behind `name` of the line that starts with it; NULL: none. */
static const char *line_of(const char *note, const char *name)
{
    size_t length = strlen(name);
    while (*note != '\0') {
        const char *text = note + strspn(note, " \t");
        if (strncmp(text, name, length) == 0 &&
            strchr(" \t\r\n", text[length]) != NULL)
            return text + length;
        note += strcspn(note, "\n");
        note += *note == '\n';
    }
    return NULL;
}

/* `count` finite numbers and the end of the line. */
static bool take_numbers(const char *text, const struct field *field)
{
    for (int i = 0; i < field->count; i++) {
        char *end;
        text += strspn(text, " \t");
        if (strchr("+-.0123456789", *text) == NULL || *text == '\0')
            return false;
        field->values[i] = strtod(text, &end);
        if (end == text || !isfinite(field->values[i]))
            return false;
        text = end;
    }
    text += strspn(text, " \t\r");
    return *text == '\n';
}

static bool has_length(const double v[3])
{
    return v[0] != 0 || v[1] != 0 || v[2] != 0;
}

static int take_fields(struct sun_map_file *map, char *err, size_t err_size)
{
    struct field field[FIELDS];
    fields_of(map, field);
    if (line_of(map->texels.note, MAGIC) == NULL)
        return image_error(err, err_size,
                           "not a sun map: no line `# " MAGIC "'");
    for (int i = 0; i < FIELDS; i++) {
        const char *text = line_of(map->texels.note, field[i].name);
        if (text == NULL)
            return image_error(err, err_size, "sun map without a line `# %s'",
                               field[i].name);
        if (!take_numbers(text, &field[i]))
            return image_error(
                err, err_size, "`# %s' of a sun map takes %d finite number%s",
                field[i].name, field[i].count, field[i].count > 1 ? "s" : "");
    }
    if (!has_length(map->across) || !has_length(map->down))
        return image_error(err, err_size, "sun map with an edge of length 0");
    if (!(map->range > 0) || !(map->bias >= 0))
        return image_error(err, err_size,
                           "sun map with range %g and bias %g: range must be "
                           "above 0, bias not below",
                           map->range, map->bias);
    return 0;
}

int sun_map_file_read(const char *path, struct sun_map_file *map, char *err,
                      size_t err_size)
{
    char what[256];
    memset(map, 0, sizeof *map);
    if (grey16_read(path, &map->texels, err, err_size) != 0)
        return -1;
    if (take_fields(map, what, sizeof what) == 0)
        return 0;
    sun_map_file_free(map);
    return image_error(err, err_size, "%s: %s", path, what);
}

void sun_map_file_free(struct sun_map_file *map)
{
    grey16_free(&map->texels);
    memset(map, 0, sizeof *map);
}

/// Writing ///

int sun_map_file_encode(const struct sun_map_file *map, struct image_file *file,
                        char *err, size_t err_size)
{
    struct sun_map_file copy = *map; /* its texels are still those of *map */
    struct field field[FIELDS];
    char *note = copy.texels.note;
    size_t n = (size_t)snprintf(note, GREY16_NOTE_SIZE, " " MAGIC "\n");
    fields_of(&copy, field);
    for (int i = 0; i < FIELDS; i++) { /* at most 5 * 3 * 25 characters */
        n += (size_t)snprintf(note + n, GREY16_NOTE_SIZE - n, " %s",
                              field[i].name);
        for (int k = 0; k < field[i].count; k++)
            n += (size_t)snprintf(note + n, GREY16_NOTE_SIZE - n, " %.17g",
                                  field[i].values[k]);
        n += (size_t)snprintf(note + n, GREY16_NOTE_SIZE - n, "\n");
    }
    return grey16_encode(IMAGE_PGM, &copy.texels, file, err, err_size);
}

/// Pool space ///

static int put_vector(const char *what, const double v[3], int32_t out[3],
                      char *err, size_t err_size)
{
    for (int i = 0; i < 3; i++) {
        if (!(fabs(v[i]) <= BRUME_MAX_COORDINATE / 65536.0))
            return image_error(err, err_size,
                               "the sun map's %s is %.0f voxels away, at most "
                               "%d can be reached",
                               what, fabs(v[i]), BRUME_MAX_COORDINATE >> 16);
        out[i] = (int32_t)floor(v[i] * 65536.0 + 0.5);
    }
    return 0;
}

static int put_length(const char *what, double v, double least, uint32_t *out,
                      char *err, size_t err_size)
{
    if (!(v >= least && v <= 65535))
        return image_error(err, err_size,
                           "the sun map's %s is %g voxels: must be %g to 65535",
                           what, v, least);
    *out = (uint32_t)floor(v * 65536.0 + 0.5);
    return 0;
}

int sun_map_file_apply(const struct sun_map_file *map,
                       const struct volume_file *file,
                       struct brume_sun_map *out, char *err, size_t err_size)
{
    double origin[3], across[3], down[3], scale = 1 / file->voxel_size;
    const struct grey16 *texels = &map->texels;
    memset(out, 0, sizeof *out);
    if (texels->width > BRUME_MAX_SIZE || texels->height > BRUME_MAX_SIZE)
        return image_error(err, err_size,
                           "a sun map of %d x %d: each side is 1 to %d",
                           texels->width, texels->height, BRUME_MAX_SIZE);
    volume_file_to_pool(file, map->origin, origin);
    volume_file_direction(file, map->across, across);
    volume_file_direction(file, map->down, down);
    if (put_vector("corner", origin, out->origin, err, err_size) != 0 ||
        put_vector("row", across, out->across, err, err_size) != 0 ||
        put_vector("column", down, out->down, err, err_size) != 0 ||
        put_length("range", map->range * scale, 1, &out->range, err,
                   err_size) != 0 ||
        put_length("bias", map->bias * scale, 0, &out->bias, err, err_size) !=
            0)
        return -1;
    out->width = (uint16_t)texels->width;
    out->height = (uint16_t)texels->height;
    out->depth = texels->values;
    out->stride = (size_t)texels->width;
    return 0;
}
