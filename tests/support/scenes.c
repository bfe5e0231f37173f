/* SPDX-License-Identifier: MIT */
#include "scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset_builder.h"

#define ONE 0x10000u
#define NEAR BRUME_NEAREST
#define TRI BRUME_TRILINEAR
#define J_NONE BRUME_JITTER_NONE
#define J_PRIM BRUME_JITTER_PRIMARY
#define J_LIGHT BRUME_JITTER_LIGHT
#define J_BOTH BRUME_JITTER_BOTH

const struct test_scene test_scenes[] = {
    /* name, volume, size, lookup, light, n, jitter, noise, step, frame, view,
     * clamp, small */
    {"block_u8", "block_u8", 320, 240, NEAR, BRUME_LOG, 6, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, false},
    {"cloud_u8", "cloud_u8", 640, 480, NEAR, BRUME_LOG, 10, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, false},
    {"white", "cloud_u8", 320, 240, NEAR, BRUME_LOG, 8, J_BOTH,
     BRUME_NOISE_WHITE, 2 * ONE, 7, VIEW_FRONT, false, false},
    {"ign", "cloud_u8", 320, 240, NEAR, BRUME_LOG, 8, J_PRIM, BRUME_NOISE_IGN,
     3 * ONE, 65, VIEW_FRONT, false, false},
    {"bayer8", "cloud_u8", 320, 240, NEAR, BRUME_LOG, 8, J_LIGHT,
     BRUME_NOISE_BAYER8, ONE + ONE / 3, 1, VIEW_SUN, false, false},
    {"trilinear_u8", "cloud_u8", 320, 240, TRI, BRUME_LOG, 8, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, false},
    {"trilinear_u8_apron", "cloud_u8_apron", 320, 240, TRI, BRUME_LOG, 8,
     J_NONE, 0, ONE, 0, VIEW_FRONT, false, false},
    {"cloud_u8r", "cloud_u8r", 320, 240, NEAR, BRUME_LOG, 8, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, false},
    {"uniform_u8r", "cloud_u8r", 200, 150, TRI, BRUME_UNIFORM, 40, J_PRIM,
     BRUME_NOISE_IGN, ONE, 3, VIEW_FRONT, false, false},
    {"cloud_u4r", "cloud_u4r", 320, 240, NEAR, BRUME_LOG, 8, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, false},
    {"clamp_u4r_apron", "cloud_u4r_apron", 160, 120, TRI, BRUME_LOG, 8, J_NONE,
     0, ONE, 0, VIEW_FRONT, true, false},
    {"clamp_u8", "cloud_u8", 320, 240, NEAR, BRUME_UNIFORM, 40, J_NONE, 0, ONE,
     0, VIEW_FRONT, true, false},
    {"inside", "cloud_u8r_apron", 320, 240, TRI, BRUME_LOG, 8, J_BOTH,
     BRUME_NOISE_WHITE, ONE / 2, 0, VIEW_INSIDE, false, false},
    {"grazing", "cloud_u8", 320, 240, NEAR, BRUME_LOG, 8, J_NONE, 0, ONE, 0,
     VIEW_GRAZING, false, false},
    {"far", "cloud_u8", 161, 97, NEAR, BRUME_LOG, 16, J_PRIM, BRUME_NOISE_IGN,
     16 * ONE, 0, VIEW_FAR, false, false},
    {"top", "cloud_u4r", 97, 161, NEAR, BRUME_NO_LIGHT, 0, J_PRIM,
     BRUME_NOISE_BAYER8, 4 * ONE, 0, VIEW_TOP, false, false},
    {"hd_nearest", "cloud_u8", 1920, 1080, NEAR, BRUME_LOG, 8, J_PRIM,
     BRUME_NOISE_IGN, 2 * ONE, 0, VIEW_FRONT, false, false},
    {"hd_trilinear", "cloud_u8r_apron", 1920, 1080, TRI, BRUME_LOG, 6, J_BOTH,
     BRUME_NOISE_BAYER8, 3 * ONE, 0, VIEW_FRONT, false, false},
    {"small_cloud", "cloud_u8", 128, 96, NEAR, BRUME_LOG, 8, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, true},
    {"small_trilinear", "cloud_u8r", 128, 96, TRI, BRUME_UNIFORM, 40, J_NONE, 0,
     ONE, 0, VIEW_FRONT, false, true},
    {"small_jitter", "cloud_u8", 128, 96, NEAR, BRUME_LOG, 8, J_BOTH,
     BRUME_NOISE_IGN, 4 * ONE, 0, VIEW_FRONT, false, true},
    {"small_u4r", "cloud_u4r_apron", 128, 96, TRI, BRUME_LOG, 8, J_NONE, 0, ONE,
     0, VIEW_SUN, false, true},
    {"disney", "wdas_u8", 960, 540, NEAR, BRUME_LOG, 10, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, false},
    {"disney_hd", "wdas_u8", 1920, 1080, TRI, BRUME_LOG, 10, J_BOTH,
     BRUME_NOISE_IGN, 2 * ONE, 0, VIEW_FRONT, false, false},
    {"smoke", "smoke_u8r", 960, 540, NEAR, BRUME_LOG, 10, J_PRIM,
     BRUME_NOISE_WHITE, ONE, 0, VIEW_FRONT, false, false},
    {"smoke_u4r", "smoke_u4r", 320, 240, NEAR, BRUME_LOG, 10, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, false},
};

const int test_scene_count = sizeof test_scenes / sizeof test_scenes[0];

/// Volumes ///

static int add_volume(struct test_volumes *v, const char *name, uint8_t *asset,
                      size_t size)
{
    struct test_volume *item = &v->item[v->count];
    if (v->count == TEST_VOLUMES || strlen(name) >= sizeof item->name) {
        fprintf(stderr, "too many volumes, or a long name: %s\n", name);
        free(asset);
        return -1;
    }
    v->count++;
    item->asset = asset;
    strcpy(item->name, name);
    int error = brume_volume_open(&item->volume, asset, size, 0);
    if (error)
        fprintf(stderr, "%s: %s\n", name, brume_error_text(error));
    return error ? -1 : 0;
}

static int add_cloud(struct test_volumes *v, const char *name, int format,
                     bool apron)
{
    static const struct density_cloud cloud = {72, 5};
    struct asset_spec spec =
        asset_spec_of(9, 9, 9, format, density_in_cloud, &cloud);
    size_t size;
    spec.apron = apron;
    uint8_t *asset = asset_build(&spec, &size);
    return add_volume(v, name, asset, size);
}

static int add_block(struct test_volumes *v)
{
    static const struct density_box box = {{4, 4, 4}, {28, 20, 36}, 32768};
    struct asset_spec spec =
        asset_spec_of(4, 3, 5, BRUME_U8, density_in_box, &box);
    size_t size;
    uint8_t *asset = asset_build(&spec, &size);
    return add_volume(v, "block_u8", asset, size);
}

static int add_file(struct test_volumes *v, const char *argument)
{
    char name[24] = "";
    const char *path = strchr(argument, '=');
    if (path != NULL && (size_t)(path - argument) < sizeof name)
        memcpy(name, argument, (size_t)(path - argument));
    FILE *f = path ? fopen(path + 1, "rb") : NULL;
    long size = -1;
    if (f != NULL && fseek(f, 0, SEEK_END) == 0)
        size = ftell(f);
    uint8_t *asset = size > 0 ? malloc((size_t)size) : NULL;
    if (asset == NULL || fseek(f, 0, SEEK_SET) != 0 ||
        fread(asset, 1, (size_t)size, f) != (size_t)size) {
        fprintf(stderr, "cannot read name=path %s\n", argument);
        free(asset);
        if (f != NULL)
            fclose(f);
        return -1;
    }
    fclose(f);
    return add_volume(v, name, asset, (size_t)size);
}

int test_volumes_make(struct test_volumes *volumes, int argc, char **argv)
{
    struct test_volumes *v = volumes;
    memset(v, 0, sizeof *v);
    int bad = add_block(v);
    bad |= add_cloud(v, "cloud_u8", BRUME_U8, false);
    bad |= add_cloud(v, "cloud_u8_apron", BRUME_U8, true);
    bad |= add_cloud(v, "cloud_u8r", BRUME_U8R, false);
    bad |= add_cloud(v, "cloud_u8r_apron", BRUME_U8R, true);
    bad |= add_cloud(v, "cloud_u4r", BRUME_U4R, false);
    bad |= add_cloud(v, "cloud_u4r_apron", BRUME_U4R, true);
    for (int i = 1; i < argc; i++)
        bad |= add_file(v, argv[i]);
    return bad;
}

void test_volumes_free(struct test_volumes *volumes)
{
    for (int i = 0; i < volumes->count; i++)
        free(volumes->item[i].asset);
}

const struct brume_volume *test_volume_of(const struct test_volumes *volumes,
                                          const struct test_scene *scene)
{
    for (int i = 0; i < volumes->count; i++)
        if (strcmp(volumes->item[i].name, scene->volume) == 0)
            return &volumes->item[i].volume;
    return NULL;
}

/// Scenes ///

/* Eye and target from the box; in the box's own size. */
static void place_camera(struct brume_scene *s, int view,
                         const struct brume_volume *v)
{
    int32_t size[3], most = 0;
    for (int i = 0; i < 3; i++) {
        size[i] = v->box_max[i] - v->box_min[i] + 1;
        most = size[i] > most ? size[i] : most;
        s->target[i] = (v->box_min[i] + v->box_max[i]) * 32768;
        s->eye[i] = s->target[i];
    }
    switch (view) {
    case VIEW_INSIDE:
        s->target[0] -= 3 * 65536;
        s->target[2] += 65536;
        break;
    case VIEW_GRAZING:
        s->eye[1] = s->target[1] = v->box_max[1] * 65536;
        s->eye[2] += most * 90000;
        break;
    case VIEW_FAR:
        s->eye[0] += 20000 * 65536;
        s->eye[1] -= 3000 * 65536;
        s->fov = BRUME_MIN_FOV;
        break;
    case VIEW_TOP: s->eye[1] += most * 110000; break;
    default:
        s->eye[0] += most * 45000;
        s->eye[1] += most * 20000;
        s->eye[2] += most * 90000;
        break;
    }
}

void test_scene_fill(struct brume_scene *out, const struct test_scene *scene,
                     const struct brume_volume *volume)
{
    static const struct brume_scene k_zero;
    struct brume_scene *s = out;
    uint64_t scale = BRUME_Q32(0.25); /* at the largest density, per voxel */
    *s = k_zero;
    s->width = scene->width;
    s->height = scene->height;
    s->frame = scene->frame;
    s->fov = 45u << 16;
    s->up[1] = 1;
    place_camera(s, scene->view, volume);
    s->sun[0] = scene->view == VIEW_SUN ? -5 : -4;
    s->sun[1] = scene->view == VIEW_SUN ? 1 : 3;
    s->sun[2] = scene->view == VIEW_SUN ? -10 : 2;
    s->density_scale = scale;
    s->light_density_scale = scale / 4;
    s->albedo = 62000;
    s->step = scene->step;
    s->light_step = scene->light == BRUME_UNIFORM ? 5 * ONE / 2 : ONE;
    s->min_transmittance = 655;
    s->min_density = BRUME_Q32(0.01);
    s->max_density = scene->clamp ? BRUME_Q32(0.5) : 0;
    s->background[0] = 6000;
    s->background[1] = 14000;
    s->background[2] = 30000;
    s->light_samples = scene->light_samples;
    s->filter = scene->filter;
    s->light = scene->light;
    s->jitter = scene->jitter;
    s->noise = scene->noise;
    s->output = BRUME_SRGB;
    s->skip = true;
}

uint32_t test_crc32(const void *data, size_t size)
{
    const uint8_t *p = data;
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < size; i++) {
        crc ^= p[i];
        for (int k = 0; k < 8; k++)
            crc = crc >> 1 ^ (0xedb88320u & (0u - (crc & 1u)));
    }
    return ~crc;
}
