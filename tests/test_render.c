/* SPDX-License-Identifier: MIT */
/*
 * One image: the same bytes however a frame is cut, threaded or copied; and
 * leaping over empty cells is invisible. Pixel formats against each other;
 * rectangles and scenes at their limits.
 */
#include <stdlib.h>
#include <string.h>

#include "brume_inner.h"
#include "render.h"
#include "support/volumes.h"
#include "tap.h"

/// Cuts ///

static void render_tiles(const struct brume_frame *f, int format, uint8_t *to,
                         unsigned tile_w, unsigned tile_h)
{
    unsigned bytes = brume_pixel_bytes(format);
    size_t stride = (size_t)f->width * bytes;
    for (unsigned y = 0; y < f->height; y += tile_h)
        for (unsigned x = 0; x < f->width; x += tile_w) {
            unsigned w = f->width - x, h = f->height - y;
            if (brume_render_rect(f, x, y, w < tile_w ? w : tile_w,
                                  h < tile_h ? h : tile_h, format,
                                  to + y * stride + (size_t)x * bytes,
                                  stride) != BRUME_OK)
                abort();
        }
}

/* Backwards, so that nothing can hang on the order of tiles either. */
static void render_columns_backwards(const struct brume_frame *f, uint8_t *to)
{
    size_t stride = (size_t)f->width * 3;
    for (unsigned x = f->width; x-- > 0;)
        if (brume_render_rect(f, x, 0, 1, f->height, BRUME_RGB888,
                              to + 3 * (size_t)x, stride) != BRUME_OK)
            abort();
}

static void check_cuts(const char *name, const struct brume_frame *f)
{
    size_t stride = (size_t)f->width * 3, size = stride * f->height;
    uint8_t *whole = malloc(size), *cut = malloc(size);
    struct brume_frame copy;
    if (whole == NULL || cut == NULL)
        abort();
    render_tiles(f, BRUME_RGB888, whole, f->width, f->height);

    memset(cut, 0xa5, size);
    render_tiles(f, BRUME_RGB888, cut, f->width, 1);
    tap_check(memcmp(whole, cut, size) == 0, "%s: strips of 1 line", name);

    memset(cut, 0xa5, size);
    memcpy(&copy, f, sizeof copy);
    render_tiles(&copy, BRUME_RGB888, cut, 7, 5);
    tap_check(memcmp(whole, cut, size) == 0, "%s: 7x5 tiles of a copy", name);

    memset(cut, 0xa5, size);
    render_columns_backwards(f, cut);
    tap_check(memcmp(whole, cut, size) == 0, "%s: columns backwards", name);

    for (int threads = 2; threads <= 5; threads += 3) {
        memset(cut, 0xa5, size);
        render_frame(f, BRUME_RGB888, cut, stride, threads, false);
        tap_check(memcmp(whole, cut, size) == 0, "%s: %d threads", name,
                  threads);
    }
    free(whole);
    free(cut);
}

/// Leaping ///

static void check_skip(const char *name, const struct brume_volume *v,
                       struct brume_scene *scene)
{
    size_t size = (size_t)scene->width * scene->height * 2;
    uint8_t *on = malloc(size), *off = malloc(size);
    struct brume_frame f;
    if (on == NULL || off == NULL)
        abort();
    for (int skip = 0; skip < 2; skip++) {
        scene->skip = skip;
        if (brume_begin_frame(&f, v, scene) != BRUME_OK)
            abort();
        if (!skip)
            f.outlines = 0;
        render_frame(&f, BRUME_L16, skip ? on : off, (size_t)scene->width * 2,
                     2, false);
    }
    tap_check(memcmp(on, off, size) == 0, "%s: skip and outline on == both off",
              name);
    free(on);
    free(off);
}

static void check_scenes(const struct test_volumes *volumes)
{
    for (int i = 0; i < test_scene_count; i++) {
        const struct test_scene *t = &test_scenes[i];
        const struct brume_volume *v = test_volume_of(volumes, t);
        struct brume_scene scene;
        struct brume_frame f;
        if (v == NULL) {
            tap_skip("%s: volume %s not given", t->name, t->volume);
            continue;
        }
        test_scene_fill(&scene, t, v);
        if (brume_begin_frame(&f, v, &scene) != BRUME_OK)
            abort();
        check_cuts(t->name, &f);
        scene.output = BRUME_LINEAR; /* 16 bits show more */
        check_skip(t->name, v, &scene);
    }
}

/* Many small scenes with the camera, sun, step and light anywhere. */
static void check_random_skips(const struct test_volumes *volumes)
{
    uint32_t seed = 1;
    int different = 0, lit = 0;
    for (int n = 0; n < 3000; n++) {
        const struct test_scene *t = &test_scenes[n % 22];
        const struct brume_volume *v = test_volume_of(volumes, t);
        struct brume_scene s;
        struct brume_frame f;
        uint16_t pixel[2][24 * 18];
        test_scene_fill(&s, t, v);
        for (int i = 0; i < 3; i++) {
            seed = seed * 1664525u + 1013904223u;
            s.eye[i] += (int32_t)(seed >> 8) - (1 << 23);
            seed = seed * 1664525u + 1013904223u;
            s.sun[i] = (int32_t)(seed >> 4) - (1 << 27);
        }
        s.step = BRUME_MIN_STEP + (seed >> 13);
        s.width = 24;
        s.height = 18;
        s.output = BRUME_LINEAR;
        for (int skip = 0; skip < 2; skip++) {
            s.skip = skip;
            if (brume_begin_frame(&f, v, &s) != BRUME_OK)
                abort();
            if (!skip)
                f.outlines = 0;
            if (brume_render_rect(&f, 0, 0, 24, 18, BRUME_L16, pixel[skip],
                                  48) != BRUME_OK)
                abort();
        }
        different += memcmp(pixel[0], pixel[1], sizeof pixel[0]) != 0;
        for (int i = 0; i < 24 * 18; i++)
            lit += pixel[0][i] != pixel[0][0];
    }
    tap_check(different == 0 && lit > 100000,
              "3000 random scenes: skip on == skip off (%d differ, %d pixels "
              "show something)",
              different, lit);
}

static uint32_t next(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

/* A camera anywhere, from inside the pool to as far as one can be, with any
 * field of view and frame size. */
static void random_camera(struct brume_scene *s, uint32_t *seed)
{
    static const uint16_t k_size[] = {1, 7, 40, 333, 16384};
    uint32_t far = next(seed) % 17;
    for (int i = 0; i < 3; i++) {
        int32_t away = (int32_t)(next(seed) & 0xffffu) - 0x8000;
        s->eye[i] = s->target[i] + away * (1 << far) / 2;
        if (s->eye[i] > BRUME_MAX_COORDINATE || s->eye[i] < 0)
            s->eye[i] = next(seed) % 8 == 0 ? 0 : s->target[i] - away;
        s->target[i] += (int32_t)(next(seed) % 0x200000u) - 0x100000;
    }
    s->fov = BRUME_MIN_FOV + next(seed) % (BRUME_MAX_FOV - BRUME_MIN_FOV);
    s->width = k_size[next(seed) % 5];
    s->height = k_size[next(seed) % 5];
    s->step = BRUME_MIN_STEP + next(seed) % 0x40000u;
}

/* Rays that are told to pass the pool by never have a sample in it; and most
 * of those that have none are told. */
static void check_misses(const struct test_volumes *volumes)
{
    uint32_t seed = 7;
    int told = 0, wrong = 0, missed = 0;
    for (int n = 0; n < 20000; n++) {
        const struct test_scene *t = &test_scenes[n % 22];
        struct brume_scene s;
        struct brume_frame f;
        test_scene_fill(&s, t, test_volume_of(volumes, t));
        random_camera(&s, &seed);
        if (brume_begin_frame(&f, test_volume_of(volumes, t), &s) != BRUME_OK)
            continue; /* the eye on the target */
        for (int k = 0; k < 40; k++) {
            struct brume_ray ray;
            uint32_t count = 1 + next(&seed) % 8;
            if (count > s.width)
                count = s.width;
            uint32_t x = next(&seed) % (s.width - count + 1u);
            uint32_t y = next(&seed) % s.height, hits = 0;
            bool miss = brume_rays_miss(&f, x, y, count);
            for (uint32_t i = 0; i < count; i++)
                hits += brume_ray_begin(&ray, &f, x + i, y);
            wrong += miss && hits > 0;
            told += miss;
            missed += hits == 0;
        }
    }
    tap_check(wrong == 0 && told > 100000 && told * 10 > missed * 9,
              "rays told to miss have no sample (%d told of %d, %d wrong)",
              told, missed, wrong);
}

/// Formats ///

static unsigned to_bits(unsigned code, unsigned top)
{
    return (2 * code * top + 255) / 510;
}

static void check_formats(const struct test_volumes *volumes)
{
    enum { W = 40, H = 30 };
    static uint8_t rgb[W * H * 3];
    static uint16_t five[W * H], swapped[W * H], grey16[W * H];
    static uint16_t rgb16[W * H * 3];
    static uint32_t x8[W * H];
    static uint8_t grey[W * H];
    struct brume_scene s;
    struct brume_frame f;
    int bad[6] = {0};
    const struct brume_volume *v = test_volume_of(volumes, &test_scenes[1]);
    test_scene_fill(&s, &test_scenes[1], v);
    s.width = W;
    s.height = H;
    for (int output = 0; output < 2; output++) {
        s.output = (uint8_t)output;
        brume_begin_frame(&f, v, &s);
        brume_render_rect(&f, 0, 0, W, H, BRUME_RGB888, rgb, W * 3);
        brume_render_rect(&f, 0, 0, W, H, BRUME_RGB565, five, W * 2);
        brume_render_rect(&f, 0, 0, W, H, BRUME_RGB565_SWAPPED, swapped, W * 2);
        brume_render_rect(&f, 0, 0, W, H, BRUME_XRGB8888, x8, W * 4);
        brume_render_rect(&f, 0, 0, W, H, BRUME_L8, grey, W);
        brume_render_rect(&f, 0, 0, W, H, BRUME_L16, grey16, W * 2);
        brume_render_rect(&f, 0, 0, W, H, BRUME_RGB161616, rgb16, W * 6);
        for (int i = 0; i < W * H; i++) {
            const uint8_t *p = rgb + 3 * i;
            bad[0] += x8[i] != ((uint32_t)p[0] << 16 | p[1] << 8 | p[2]);
            bad[1] += five[i] != (to_bits(p[0], 31) << 11 |
                                  to_bits(p[1], 63) << 5 | to_bits(p[2], 31));
            bad[2] += swapped[i] != (five[i] >> 8 | (five[i] & 255) << 8);
            bad[3] += grey[i] != p[0] || grey16[i] != rgb16[3 * i];
            for (int c = 0; c < 3; c++)
                bad[4] += abs(rgb16[3 * i + c] - 257 * p[c]) > 129;
        }
    }
    tap_check(bad[0] == 0, "XRGB8888 holds the bytes of RGB888");
    tap_check(bad[1] == 0, "RGB565 is RGB888 rounded");
    tap_check(bad[2] == 0, "RGB565 swapped is RGB565 with bytes swapped");
    tap_check(bad[3] == 0, "L8 and L16 are the red channel");
    tap_check(bad[4] == 0, "8-bit channels are the 16-bit ones to half a code");
    tap_check(brume_pixel_bytes(-1) == 0 && brume_pixel_bytes(12) == 0,
              "no pixel format before and after the last");
}

/// Limits ///

static void check_rectangles(const struct test_volumes *volumes)
{
    struct brume_scene s;
    struct brume_frame f;
    uint8_t dst[4] = {1, 2, 3, 4}, same[4] = {1, 2, 3, 4};
    const struct brume_volume *v = test_volume_of(volumes, &test_scenes[0]);
    test_scene_fill(&s, &test_scenes[0], v);
    brume_begin_frame(&f, v, &s);
    tap_check(brume_render_rect(&f, 0, 0, 321, 1, BRUME_L8, dst, 321) ==
                      BRUME_ERR_RECT &&
                  brume_render_rect(&f, 321, 0, 0, 0, BRUME_L8, dst, 0) ==
                      BRUME_ERR_RECT &&
                  brume_render_rect(&f, 0, 240, 1, 1, BRUME_L8, dst, 1) ==
                      BRUME_ERR_RECT &&
                  brume_render_rect(&f, 1, 1, ~0u, 1, BRUME_L8, dst, 1) ==
                      BRUME_ERR_RECT,
              "rectangles outside the frame are refused");
    tap_check(
        brume_render_rect(&f, 0, 0, 2, 2, BRUME_L8, dst, 1) == BRUME_ERR_RECT &&
            brume_render_rect(&f, 0, 0, 1, 1, 99, dst, 1) == BRUME_ERR_RECT,
        "a short stride and an unknown format are refused");
    tap_check(
        brume_render_rect(NULL, 0, 0, 1, 1, 0, dst, 1) == BRUME_ERR_NULL &&
            brume_render_rect(&f, 0, 0, 1, 1, 0, NULL, 1) == BRUME_ERR_NULL,
        "NULL is refused");
    tap_check(brume_render_rect(&f, 320, 240, 0, 0, BRUME_L8, dst, 0) ==
                      BRUME_OK &&
                  memcmp(dst, same, 4) == 0,
              "an empty rectangle draws nothing");
    brume_render_rect(&f, 319, 239, 1, 1, BRUME_L8, dst + 1, 0);
    tap_check(dst[0] == 1 && dst[2] == 3, "one pixel writes one byte");
}

/* Changes one field of a good scene at a time. */
static void check_scene_limits(const struct test_volumes *volumes)
{
    struct brume_scene good, s;
    struct brume_frame f;
    const struct brume_volume *v = test_volume_of(volumes, &test_scenes[0]);
    test_scene_fill(&good, &test_scenes[0], v);
#define EXPECT(change, error) \
    s = good; \
    change; \
    tap_check(brume_begin_frame(&f, v, &s) == (error), "%s gives " #error, \
              #change)
    EXPECT(s.width = 0, BRUME_ERR_SIZE);
    EXPECT(s.height = BRUME_MAX_SIZE + 1, BRUME_ERR_SIZE);
    EXPECT(s.width = s.height = BRUME_MAX_SIZE, BRUME_OK);
    EXPECT(s.step = BRUME_MIN_STEP - 1, BRUME_ERR_STEP);
    EXPECT(s.step = BRUME_MAX_STEP + 1, BRUME_ERR_STEP);
    EXPECT(s.light_step = 0, BRUME_ERR_STEP);
    EXPECT(s.light_samples = BRUME_MAX_LOG_SAMPLES, BRUME_OK);
    EXPECT(s.light_samples = BRUME_MAX_LOG_SAMPLES + 1, BRUME_ERR_SAMPLES);
    EXPECT((s.light = 1, s.light_samples = 4096), BRUME_OK);
    EXPECT((s.light = 1, s.light_samples = 4097), BRUME_ERR_SAMPLES);
    EXPECT(s.light = 5, BRUME_ERR_SAMPLES);
    EXPECT(s.fov = BRUME_MIN_FOV - 1, BRUME_ERR_CAMERA);
    EXPECT(s.fov = BRUME_MAX_FOV + 1, BRUME_ERR_CAMERA);
    EXPECT(s.eye[1] = BRUME_MAX_COORDINATE + 1, BRUME_ERR_CAMERA);
    EXPECT(s.eye[2] = -BRUME_MAX_COORDINATE, BRUME_OK);
    EXPECT(s.target[0] = INT32_MIN, BRUME_ERR_CAMERA);
    EXPECT(memcpy(s.eye, s.target, sizeof s.eye), BRUME_ERR_CAMERA);
    EXPECT(s.sun[0] = s.sun[1] = s.sun[2] = 0, BRUME_ERR_SUN);
    EXPECT(s.sun[0] = INT32_MIN, BRUME_OK);
    EXPECT(s.up[0] = s.up[1] = s.up[2] = 0, BRUME_OK);
    EXPECT(s.albedo = 0x10001, BRUME_ERR_SCENE);
    EXPECT(s.min_transmittance = 0x10001, BRUME_ERR_SCENE);
    EXPECT(s.background[2] = 0x10001, BRUME_ERR_SCENE);
    /* density_max is 1: one code of 65280, and just below it */
    EXPECT(s.max_density = 65794, BRUME_OK);
    EXPECT(s.max_density = 65700, BRUME_ERR_SCENE);
    EXPECT(s.max_density = 1, BRUME_ERR_SCENE);
    EXPECT(s.filter = 3, BRUME_ERR_SCENE);
    EXPECT(s.jitter = 4, BRUME_ERR_SCENE);
    EXPECT(s.noise = 11, BRUME_ERR_SCENE);
    EXPECT(s.output = 3, BRUME_ERR_SCENE);
#undef EXPECT
    tap_check(brume_begin_frame(NULL, v, &good) == BRUME_ERR_NULL &&
                  brume_begin_frame(&f, NULL, &good) == BRUME_ERR_NULL &&
                  brume_begin_frame(&f, v, NULL) == BRUME_ERR_NULL,
              "begin_frame refuses NULL");
}

/* The same of a scene's lighting. */
static void check_lighting_limits(const struct test_volumes *volumes)
{
    static const int8_t k_up[3 * 64] = {0, 0, 127};
    static const uint8_t k_codes[1] = {0};
    const struct brume_direction_table good_table = {k_up, 3, 3, 0};
    struct brume_direction_table t = good_table;
    struct brume_cache c;
    struct brume_lighting good = {.octaves = 8,
                                  .octave_a = 0x10000,
                                  .octave_b = 0x10000,
                                  .sun_colour = {16 << 16, 0, 1},
                                  .exposure = 16 << 16,
                                  .ambient = BRUME_AMBIENT_CUBE,
                                  .visibility = BRUME_SKY_SAMPLED,
                                  .visibility_samples = 16,
                                  .visibility_step = BRUME_MAX_STEP,
                                  .directions = &t};
    struct brume_lighting l;
    struct brume_scene s;
    struct brume_frame f;
    const struct brume_volume *v = test_volume_of(volumes, &test_scenes[0]);
    test_scene_fill(&s, &test_scenes[0], v);
    s.lighting = &l;
#define EXPECT(change, error) \
    l = good; \
    t = good_table; \
    change; \
    tap_check(brume_begin_frame(&f, v, &s) == (error), "%s gives " #error, \
              #change)
    EXPECT(l.octaves = 8, BRUME_OK);
    EXPECT(l.octaves = 0, BRUME_OK);
    EXPECT(l.octaves = 9, BRUME_ERR_SCENE);
    EXPECT(l.octave_a = 0x10001, BRUME_ERR_SCENE);
    EXPECT(l.octave_b = 0x10001, BRUME_ERR_SCENE);
    EXPECT(l.sun_colour[1] = (16 << 16) + 1, BRUME_ERR_SCENE);
    EXPECT(l.exposure = (16 << 16) + 1, BRUME_ERR_SCENE);
    EXPECT(l.exposure = 255, BRUME_ERR_SCENE);
    EXPECT(l.exposure = 0, BRUME_OK);
    EXPECT(l.ambient = 4, BRUME_ERR_SCENE);
    EXPECT(l.visibility = 3, BRUME_ERR_SCENE);
    EXPECT(l.visibility = BRUME_SKY_BAKED, BRUME_ERR_SECTION);
    EXPECT(l.visibility_samples = 17, BRUME_ERR_SCENE);
    EXPECT(l.visibility_step = 0, BRUME_ERR_SCENE);
    EXPECT(l.visibility_step = BRUME_MAX_STEP + 1, BRUME_ERR_SCENE);
    EXPECT(l.directions = NULL, BRUME_ERR_SCENE);
    EXPECT(t.values = NULL, BRUME_ERR_SCENE);
    EXPECT(t.width_log2 = 2, BRUME_ERR_SCENE);
    EXPECT(t.height_log2 = 9, BRUME_ERR_SCENE);
    EXPECT(t.frames_log2 = 7, BRUME_ERR_SCENE);
    EXPECT(l.ambient_colour[5][2] = (16 << 16) + 1, BRUME_ERR_SCENE);
    EXPECT((l.ambient = BRUME_AMBIENT_NONE, l.directions = NULL), BRUME_OK);
    EXPECT((l.sky = true, l.sky_zenith[0] = (16 << 16) + 1), BRUME_ERR_SCENE);
    EXPECT((l.sky = true, l.sky_horizon[1] = (16 << 16) + 1), BRUME_ERR_SCENE);
    EXPECT((l.sky = true, l.sky_ground[2] = (16 << 16) + 1), BRUME_ERR_SCENE);
    EXPECT((l.sky = true, l.sun_disc[0] = (16 << 16) + 1), BRUME_ERR_SCENE);
    EXPECT((l.sky = true, l.sun_disc[0] = 16 << 16), BRUME_OK);
    s.light = BRUME_CONE;
    EXPECT(s.light_samples = 16, BRUME_ERR_SECTION);
    EXPECT(s.light_samples = 17, BRUME_ERR_SAMPLES);
    s.light = BRUME_CACHE;
    const struct brume_cache good_cache = {k_codes, NULL, {1, 1, 1},
                                           1,       0,    {0x80000000u, -31}};
#undef EXPECT
#define EXPECT(change, error) \
    l = good; \
    c = good_cache; \
    l.cache = &c; \
    t = good_table; \
    change; \
    tap_check(brume_begin_frame(&f, v, &s) == (error), "%s gives " #error, \
              #change)
    EXPECT(l.cache = NULL, BRUME_ERR_SCENE);
    EXPECT(c.from = NULL, BRUME_ERR_SCENE);
    EXPECT(c.spacing_log2 = 0, BRUME_ERR_SCENE);
    EXPECT(c.spacing_log2 = 4, BRUME_ERR_SCENE);
    EXPECT(c.blend = 1, BRUME_ERR_SCENE);
#undef EXPECT
}

int main(int argc, char **argv)
{
    struct test_volumes volumes;
    if (test_volumes_make(&volumes, argc, argv) != 0)
        return 1;
    check_formats(&volumes);
    check_rectangles(&volumes);
    check_scene_limits(&volumes);
    check_lighting_limits(&volumes);
    check_random_skips(&volumes);
    check_misses(&volumes);
    check_scenes(&volumes);
    test_volumes_free(&volumes);
    return tap_done();
}
