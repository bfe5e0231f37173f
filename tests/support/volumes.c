/* SPDX-License-Identifier: MIT */
#include "volumes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset_light.h"

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

/* The same with means, depths towards +y and what is seen of the sky. */
static int add_lit_cloud(struct test_volumes *v, const char *name, int format,
                         bool apron, int spacing_log2)
{
    static const struct density_cloud cloud = {72, 5};
    struct asset_light light = {true, spacing_log2, true};
    struct asset_spec spec =
        asset_spec_of(9, 9, 9, format, density_in_cloud, &cloud);
    size_t size;
    spec.apron = apron;
    uint8_t *asset = asset_build(&spec, &size);
    asset = asset_add_light(asset, &size, &light);
    return add_volume(v, name, asset, size);
}

/* Without sections for light, and with a second grid of values up to 1/2. */
static int add_glowing_cloud(struct test_volumes *v, const char *name,
                             int format, bool apron)
{
    static const struct density_cloud cloud = {72, 5};
    struct asset_spec spec =
        asset_spec_of(9, 9, 9, format, density_in_cloud, &cloud);
    size_t size;
    spec.apron = apron;
    uint8_t *asset = asset_build(&spec, &size);
    asset = asset_add_emission(asset, &size, 0x80000000u, -32);
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
    bad |= add_lit_cloud(v, "lit_u8", BRUME_U8, false, 2);
    bad |= add_lit_cloud(v, "lit_u4r_apron", BRUME_U4R, true, 1);
    bad |= add_glowing_cloud(v, "glow_u8", BRUME_U8, false);
    bad |= add_glowing_cloud(v, "glow_u4r_apron", BRUME_U4R, true);
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

/* The passes of one frame. */
static int draw(struct brume_frame *f, struct brume_state *state,
                int pixel_format, uint8_t *dst, bool plain)
{
    size_t stride = (size_t)f->width * brume_pixel_bytes(pixel_format);
    if (plain)
        return brume_render_rect(f, 0, 0, f->width, f->height, pixel_format,
                                 dst, stride);
#if BRUME_WITH_SEQUENCES
    size_t work_size = brume_work_bytes(f, f->width);
    void *work = malloc(work_size);
    int error = BRUME_OK;
    if (work == NULL)
        abort();
#if BRUME_WITH_TEMPORAL
    error = brume_begin_state(state, f);
    if (!error)
        error = brume_trace_rect(f, state, 0, 0, f->lattice[0], f->lattice[1]);
    if (!error)
        error = brume_resolve_rect(f, state, 0, 0, f->grid[0], f->grid[1]);
#endif
    if (!error)
        error = brume_show_rect(f, state, 0, 0, f->width, f->height,
                                pixel_format, dst, stride, work, work_size);
    free(work);
    return error;
#else
    (void)state;
    return BRUME_ERR_FEATURE;
#endif
}

uint8_t *test_scene_render(const struct test_scene *scene,
                           const struct brume_volume *volume, int pixel_format,
                           int *error)
{
    static struct brume_frame frame;
    const struct test_scene *t = scene;
    struct brume_scene s;
    struct brume_state *state = NULL;
    size_t size =
        (size_t)t->width * t->height * brume_pixel_bytes(pixel_format);
    uint8_t *pixels = malloc(size);
    if (pixels == NULL)
        abort();
    *error = test_scene_supported(t) ? BRUME_OK : BRUME_ERR_FEATURE;
#if BRUME_WITH_TEMPORAL
    test_scene_frame(&s, t, volume, 0);
    size_t bytes = brume_state_bytes(&s);
    state = malloc(bytes > sizeof *state ? bytes : sizeof *state);
    if (state == NULL)
        abort();
    if (bytes > 0 && *error == BRUME_OK)
        *error = brume_state_init(state, bytes);
#endif
    for (unsigned i = 0; i < test_scene_frames(t) && *error == BRUME_OK; i++) {
        test_scene_frame(&s, t, volume, i);
        *error = brume_begin_frame(&frame, volume, &s);
        if (*error == BRUME_OK)
            *error =
                draw(&frame, state, pixel_format, pixels, t->sequence == NULL);
    }
    free(state);
    if (*error == BRUME_OK)
        return pixels;
    free(pixels);
    return NULL;
}
