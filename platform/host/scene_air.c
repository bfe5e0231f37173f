/* SPDX-License-Identifier: MIT */
#include "scene_air.h"

#include <math.h>
#include <string.h>

#include "scene_files.h"
#include "scene_keys.h"

static const double *value_of(const struct scene_light *l, int key)
{
    return l->value[key - SCENE_LIGHT_FIRST];
}

static const struct scene_file_data *data_of(const struct scene_light *l,
                                             int key)
{
    return l->file[key - SCENE_FILE_FIRST];
}

static bool has_fog(const struct scene_light *l)
{
    return value_of(l, SCENE_FOG_DENSITY)[0] > 0 ||
           data_of(l, SCENE_FOG_SHAPES) != NULL;
}

bool scene_air_says_something(const struct scene_light *light)
{
    return has_fog(light) || data_of(light, SCENE_SURFACE) != NULL ||
           data_of(light, SCENE_SUN_MAP) != NULL;
}

/// Fog ///

static const char *where_of(const struct scene_settings *s, int key)
{
    return s->set[key] ? s->where[key] : "default";
}

/* A length of the world in voxels, Q16.16. */
static int put_length(const struct scene_settings *s, int key, double voxels,
                      double max, uint32_t *out, char *err, size_t err_size)
{
    if (!(voxels >= 1 && voxels <= max)) {
        snprintf(err, err_size, "%s: %s is %.4g voxels, outside 1 to %g",
                 where_of(s, key), scene_keys[key].name, voxels, max);
        return -1;
    }
    *out = (uint32_t)floor(voxels * 65536.0 + 0.5);
    return 0;
}

/* The height of a level of the world along zenith, in voxels. */
static double height_of(const struct volume_file *file, double y)
{
    const double up[3] = {0, 1, 0}, at[3] = {0, y, 0};
    double zenith[3], pool[3], dot = 0;
    volume_file_to_pool(file, at, pool);
    volume_file_direction(file, up, zenith);
    for (int i = 0; i < 3; i++)
        dot += pool[i] * zenith[i] * file->voxel_size;
    return dot;
}

static int make_fog(const struct scene_settings *s,
                    const struct volume_file *file, struct scene_light *l,
                    char *err, size_t err_size)
{
    const double most = 32766;
    const struct scene_file_data *shapes = data_of(l, SCENE_FOG_SHAPES);
    double falloff = value_of(l, SCENE_FOG_FALLOFF)[0] / file->voxel_size;
    double far = value_of(l, SCENE_FOG_FAR)[0] / file->voxel_size;
    double base = height_of(file, value_of(l, SCENE_FOG_BASE)[0]);
    struct brume_fog *fog = &l->fog;
    memset(fog, 0, sizeof *fog);
    fog->density =
        (uint32_t)floor(value_of(l, SCENE_FOG_DENSITY)[0] * 4294967296.0 + 0.5);
    if (!(fabs(base) <= most)) {
        snprintf(err, err_size,
                 "%s: fog_base is %.0f voxels from the volume's corner, at "
                 "most %g can be reached",
                 where_of(s, SCENE_FOG_BASE), fabs(base), most);
        return -1;
    }
    fog->base = (int32_t)floor(base * 65536.0 + 0.5);
    if (put_length(s, SCENE_FOG_FAR, far > 0 ? far : most, most, &fog->far, err,
                   err_size) != 0 ||
        (falloff > 0 && put_length(s, SCENE_FOG_FALLOFF, falloff, 65535,
                                   &fog->falloff, err, err_size) != 0))
        return -1;
    if (shapes != NULL) {
        fog->shapes = l->fog_shapes;
        fog->shape_count = (uint32_t)shapes->shapes.count;
        if (scene_file_shapes(shapes, file, l->fog_shapes, err, err_size) != 0)
            return -1;
    }
    l->lighting.fog = fog;
    return 0;
}

/// Surface, sun map ///

static int make_surface(const struct scene_settings *s,
                        const struct brume_scene *scene, struct scene_light *l,
                        char *err, size_t err_size)
{
    const struct scene_file_data *data = data_of(l, SCENE_SURFACE);
    const struct grey16 *depth = &data->surface;
    if (depth->width != scene->width || depth->height != scene->height) {
        snprintf(err, err_size,
                 "%s: surface: %.200s is %dx%d, the picture is %dx%d",
                 s->where[SCENE_SURFACE], data->path, depth->width,
                 depth->height, scene->width, scene->height);
        return -1;
    }
    l->surface.depth = depth->values;
    l->surface.stride = (size_t)depth->width;
    l->lighting.surface = &l->surface;
    return 0;
}

/* Sine of the angle between an edge of the map and the plane across the sun. */
static double tilt_of(const int32_t edge[3], const int32_t sun[3])
{
    double dot = 0, a = 0, b = 0;
    for (int i = 0; i < 3; i++) {
        dot += (double)edge[i] * sun[i];
        a += (double)edge[i] * edge[i];
        b += (double)sun[i] * sun[i];
    }
    return fabs(dot) / sqrt(a * b);
}

static int make_sun_map(const struct scene_settings *s,
                        const struct volume_file *file,
                        const struct brume_scene *scene, struct scene_light *l,
                        char *err, size_t err_size)
{
    const struct scene_file_data *data = data_of(l, SCENE_SUN_MAP);
    struct brume_sun_map *map = &l->sun_map;
    const char *where = s->where[SCENE_SUN_MAP];
    char reason[SCENE_LINE_SIZE];
    if (sun_map_file_apply(&data->sun_map, file, map, reason, sizeof reason) !=
        0) {
        snprintf(err, err_size, "%s: sun_map: %.200s: %s", where, data->path,
                 reason);
        return -1;
    }
    double tilt =
        fmax(tilt_of(map->across, scene->sun), tilt_of(map->down, scene->sun));
    if (tilt > 1.0 / 256) {
        snprintf(err, err_size,
                 "%s: sun_map: %.200s was made for another sun: its plane is "
                 "%.2f degrees off",
                 where, data->path, asin(fmin(tilt, 1)) * 57.29577951308232);
        return -1;
    }
    l->lighting.sun_map = map;
    return 0;
}

int scene_air_apply(const struct scene_settings *settings,
                    const struct volume_file *file,
                    const struct brume_scene *scene, struct scene_light *light,
                    char *err, size_t err_size)
{
    if (has_fog(light) && make_fog(settings, file, light, err, err_size) != 0)
        return -1;
    if (data_of(light, SCENE_SURFACE) != NULL &&
        make_surface(settings, scene, light, err, err_size) != 0)
        return -1;
    if (data_of(light, SCENE_SUN_MAP) != NULL &&
        make_sun_map(settings, file, scene, light, err, err_size) != 0)
        return -1;
    return 0;
}
