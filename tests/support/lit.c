/* SPDX-License-Identifier: MIT */
#include "lit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes.h"

#define ONE 0x10000u
#define PI 3.14159265358979323846

static void must(int error, const char *what)
{
    if (error == BRUME_OK)
        return;
    fprintf(stderr, "%s: %s\n", what, brume_error_text(error));
    abort();
}

struct lit_volume lit_volume_of(const struct asset_spec *spec,
                                const struct asset_light *light)
{
    struct lit_volume v = {.name = "volume"};
    size_t size;
    v.asset = asset_build(spec, &size);
    if (light != NULL)
        v.asset = asset_add_light(v.asset, &size, light);
    must(brume_volume_open(&v.volume, v.asset, size, 0), "brume_volume_open");
    return v;
}

struct lit_volume lit_cloud(int number)
{
    static const char *const k_name[] = {"u8", "u8r", "u4r"};
    static const uint8_t k_format[] = {BRUME_U8, BRUME_U8R, BRUME_U4R};
    static const struct density_cloud k_cloud = {40, 5};
    static const struct asset_light k_light = {true, 1, true};
    struct asset_spec spec = asset_spec_of(5, 5, 5, k_format[number % 3],
                                           density_in_cloud, &k_cloud);
    spec.apron = number >= 3;
    struct lit_volume v = lit_volume_of(&spec, &k_light);
    snprintf(v.name, sizeof v.name, "%s%s", k_name[number % 3],
             spec.apron ? " apron" : "");
    return v;
}

struct lit_volume lit_middle_cell(void)
{
    static const struct density_box k_box = {{24, 24, 24}, {32, 32, 32}, 40000};
    static const struct asset_light k_light = {true, 1, true};
    struct asset_spec spec =
        asset_spec_of(7, 7, 7, BRUME_U8R, density_in_box, &k_box);
    struct lit_volume v = lit_volume_of(&spec, &k_light);
    snprintf(v.name, sizeof v.name, "one cell");
    return v;
}

struct lit_volume lit_block(const int cells[3], const int low[3],
                            const int high[3], uint32_t d)
{
    static const struct asset_light k_light = {true, 0, false};
    struct density_box box = {
        {low[0], low[1], low[2]}, {high[0], high[1], high[2]}, d};
    struct asset_spec spec = asset_spec_of(cells[0], cells[1], cells[2],
                                           BRUME_U8, density_in_box, &box);
    return lit_volume_of(&spec, &k_light);
}

void lit_volume_free(struct lit_volume *volume)
{
    free(volume->asset);
    volume->asset = NULL;
}

struct brume_scene lit_scene(const struct lit_volume *volume, int w, int h,
                             const struct brume_lighting *lighting)
{
    static const struct test_scene k_base = {.light_samples = 8, .step = ONE};
    struct brume_scene s;
    test_scene_fill(&s, &k_base, &volume->volume);
    s.width = (uint16_t)w;
    s.height = (uint16_t)h;
    s.albedo = ONE;
    s.min_transmittance = 0;
    s.min_density = 0;
    s.output = BRUME_LINEAR;
    s.spatial = BRUME_BOX3; /* has a use for depth */
    s.edge_falloff = ONE;
    s.lighting = lighting;
    return s;
}

struct brume_scene lit_one_sample(const struct lit_volume *volume, int w, int h,
                                  const struct brume_lighting *lighting)
{
    struct brume_scene s = lit_scene(volume, w, h, lighting);
    const double way[3] = {-0.48, 0.36, 0.8};
    for (int i = 0; i < 3; i++) {
        s.target[i] = (int32_t)volume->volume.cell_count[i] * 4 * (int32_t)ONE;
        s.eye[i] = s.target[i] + BRUME_Q16(256 * way[i]);
    }
    s.step = BRUME_MAX_STEP;
    s.fov = 5 * ONE;
    s.density_scale = BRUME_Q32(64);
    return s;
}

void lit_sample_position(const struct brume_scene *scene, int x, int y,
                         double out[3])
{
    double ray[3];
    lit_ray(scene, x, y, ray);
    for (int i = 0; i < 3; i++)
        out[i] = scene->eye[i] / 65536.0 + 256 * ray[i];
}

struct brume_lighting lit_white(void)
{
    struct brume_lighting l = {.sun_colour = {ONE, ONE, ONE}};
    return l;
}

void lit_march(struct brume_frame *frame, const struct lit_volume *volume,
               const struct brume_scene *scene, struct brume_radiance *out)
{
    must(brume_begin_frame(frame, &volume->volume, scene), "brume_begin_frame");
    memset(out, 0xa5, (size_t)scene->width * scene->height * sizeof *out);
    must(brume_march_rect(frame, 0, 0, scene->width, scene->height, out,
                          scene->width),
         "brume_march_rect");
}

struct lit_cache lit_cache_room(const struct lit_volume *volume,
                                unsigned spacing_log2)
{
    struct lit_cache c;
    c.size = brume_cache_bytes(&volume->volume, spacing_log2);
    c.codes = malloc(c.size);
    if (c.codes == NULL)
        abort();
    memset(c.codes, 0xa5, c.size);
    must(brume_cache_begin(&c.cache, &volume->volume, spacing_log2, c.codes),
         "brume_cache_begin");
    return c;
}

struct lit_cache lit_cache_made(struct brume_frame *frame,
                                const struct lit_volume *volume,
                                const struct brume_scene *scene,
                                unsigned spacing_log2)
{
    struct lit_cache c = lit_cache_room(volume, spacing_log2);
    must(brume_begin_frame(frame, &volume->volume, scene), "brume_begin_frame");
    must(brume_cache_rows(&c.cache, c.codes, frame, 0,
                          (uint32_t)c.cache.size[1] * c.cache.size[2]),
         "brume_cache_rows");
    return c;
}

int lit_differing(const struct brume_radiance *a,
                  const struct brume_radiance *b, int n)
{
    int count = 0;
    for (int i = 0; i < n; i++)
        count += memcmp(&a[i], &b[i], sizeof *a) != 0;
    return count;
}

void lit_ray(const struct brume_scene *scene, int x, int y, double out[3])
{
    const struct brume_scene *s = scene;
    double a[3], r[3], u[3], length = 0;
    for (int i = 0; i < 3; i++)
        a[i] = (double)s->target[i] - s->eye[i];
    length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    for (int i = 0; i < 3; i++)
        a[i] /= length;
    length = hypot(a[0], a[2]);
    r[0] = -a[2] / length;
    r[1] = 0;
    r[2] = a[0] / length;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        u[i] = r[j] * a[k] - r[k] * a[j];
    }
    double tangent = tan(s->fov / 65536.0 * PI / 360);
    double across = (2.0 * x + 1 - s->width) / s->height * tangent;
    double down = (s->height - 2.0 * y - 1) / s->height * tangent;
    length = sqrt(1 + across * across + down * down);
    for (int i = 0; i < 3; i++)
        out[i] = (a[i] + across * r[i] + down * u[i]) / length;
}

uint32_t lit_random(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

int lit_between(uint32_t *seed, int low, int high)
{
    return low + (int)(lit_random(seed) % (uint32_t)(high - low + 1));
}
