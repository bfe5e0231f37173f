/* SPDX-License-Identifier: MIT */
/*
 * The host's frames after one another: pools that move, sizes that change,
 * states that come and go, and times that are taken or not.
 */
#include "tap.h"

#include "render.h"
#include "support/asset_builder.h"

#include <stdlib.h>
#include <string.h>

#define SIDE 40 /* voxels of the cloud */
#define MOVE 16 /* it is moved by so many in the larger pool */
#define WIDTH 72
#define HEIGHT 40
#define FRAMES 6

static char err[256];

/// Volumes ///

static const struct density_cloud k_cloud = {SIDE, 5};

static uint32_t moved_cloud(int x, int y, int z, const void *context)
{
    int p[3] = {x - MOVE, y - MOVE, z - MOVE};
    for (int i = 0; i < 3; i++)
        if (p[i] < 0 || p[i] >= SIDE)
            return 0;
    return density_in_cloud(p[0], p[1], p[2], context);
}

static uint8_t *make(struct brume_volume *volume, int cells,
                     density_fn *density)
{
    struct asset_spec spec =
        asset_spec_of(cells, cells, cells, BRUME_U8R, density, &k_cloud);
    size_t size;
    uint8_t *asset = asset_build(&spec, &size);
    if (brume_volume_open(volume, asset, size, 0) != BRUME_OK)
        abort();
    return asset;
}

/// Frames ///

/* A camera on its way past the cloud, whose pool begins at `at`. */
static struct brume_scene scene_at(const struct brume_volume *volume,
                                   uint32_t frame, int at)
{
    struct brume_scene s;
    brume_scene_default(&s, volume);
    for (int i = 0; i < 3; i++) {
        s.eye[i] = (at - 10) * 65536 + (int32_t)frame * 20000 * (i + 1);
        s.target[i] = (at + SIDE / 2) * 65536;
    }
    s.width = WIDTH;
    s.height = HEIGHT;
    s.frame = frame;
    s.density_scale = BRUME_Q32(0.3);
    s.light_density_scale = BRUME_Q32(0.1);
    s.step = 65536;
    s.light_samples = 8;
    s.light_step = 2 * 65536;
    s.temporal = BRUME_TAA;
    s.subpixel = true;
    return s;
}

static void draw(struct renderer *r, const struct brume_volume *volume,
                 const struct brume_scene *scene, uint8_t *pixels)
{
    const struct render_target target = {BRUME_RGB888, pixels,
                                         scene->width * 3u, NULL};
    renderer_volume(r, volume);
    if (renderer_draw(r, scene, &target, err, sizeof err) != 0) {
        printf("# %s\n", err);
        abort();
    }
}

static struct renderer *new_renderer(int threads)
{
    struct renderer *r = renderer_new(threads, WIDE_SCALAR);
    if (r == NULL)
        abort();
    return r;
}

static double mean_difference(const uint8_t *a, const uint8_t *b, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += abs(a[i] - b[i]);
    return sum / (double)n;
}

/// Tests ///

/* Every other frame from the larger pool, whose corner lies MOVE voxels
 * before the cloud's. The largest mean difference of a frame to those of the
 * small pool alone. */
static double anchored_difference(bool anchored, uint8_t temporal)
{
    static uint8_t want[WIDTH * HEIGHT * 3], got[WIDTH * HEIGHT * 3];
    static const int32_t k_here[3] = {0, 0, 0};
    static const int32_t k_there[3] = {-MOVE, -MOVE, -MOVE};
    struct brume_volume small, large;
    uint8_t *a = make(&small, SIDE / 8, density_in_cloud);
    uint8_t *b = make(&large, SIDE / 8 + 2 * MOVE / 8, moved_cloud);
    struct renderer *one = new_renderer(1), *both = new_renderer(2);
    double most = 0;
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        bool odd = frame & 1u;
        struct brume_scene s = scene_at(&small, frame, 0);
        s.temporal = temporal;
        draw(one, &small, &s, want);
        s = scene_at(odd ? &large : &small, frame, odd ? MOVE : 0);
        s.temporal = temporal;
        if (anchored)
            renderer_anchor(both, odd ? k_there : k_here);
        draw(both, odd ? &large : &small, &s, got);
        double difference = mean_difference(want, got, sizeof want);
        most = difference > most ? difference : most;
    }
    renderer_free(one);
    renderer_free(both);
    free(a);
    free(b);
    return most;
}

/* Rays are rounded relative to their pool, so a few pixels differ by a code,
 * with any method. Without the anchor the camera would seem to jump. */
static void test_anchor(void)
{
    double plain = anchored_difference(true, BRUME_TEMPORAL_NONE);
    double with = anchored_difference(true, BRUME_TAA);
    double without = anchored_difference(false, BRUME_TAA);
    tap_check(plain < 0.02, "a pool that moves: the same rays but for %.4f/255",
              plain);
    tap_check(with < 0.02, "and the same history but for %.4f/255", with);
    tap_check(without > 20 * with, "which without its anchor is lost: %.4f/255",
              without);
}

/* Each change of shape begins anew, like a renderer of its own. */
static void test_changes(void)
{
    static uint8_t want[WIDTH * HEIGHT * 3], got[WIDTH * HEIGHT * 3];
    struct brume_volume volume;
    uint8_t *asset = make(&volume, SIDE / 8, density_in_cloud);
    struct renderer *r = new_renderer(2);
    static const uint8_t k_temporal[] = {BRUME_EMA, BRUME_TAA, BRUME_WINDOW,
                                         BRUME_TAA};
    static const int k_width[] = {WIDTH, 31, 1, WIDTH};
    bool good = true;
    for (uint32_t i = 0; i < 4; i++) {
        struct brume_scene s = scene_at(&volume, 2 * i, 0);
        struct renderer *fresh = new_renderer(1);
        s.temporal = k_temporal[i];
        s.width = (uint16_t)k_width[i];
        for (uint32_t k = 0; k < 2; k++, s.frame++) {
            draw(fresh, &volume, &s, want);
            draw(r, &volume, &s, got);
            good =
                good && memcmp(want, got, (size_t)s.width * s.height * 3) == 0;
        }
        renderer_free(fresh);
    }
    tap_check(good, "another size or kind of history begins anew");
    renderer_free(r);
    free(asset);
}

static void test_profile(void)
{
    static uint8_t want[WIDTH * HEIGHT * 3], got[WIDTH * HEIGHT * 3];
    struct brume_volume volume;
    struct profile times;
    uint8_t *asset = make(&volume, SIDE / 8, density_in_cloud);
    struct renderer *plain = new_renderer(3), *timed = new_renderer(3);
    memset(&times, 0, sizeof times);
    renderer_profile(timed, &times);
    for (uint32_t frame = 0; frame < 2; frame++) {
        struct brume_scene s = scene_at(&volume, frame, 0);
        draw(plain, &volume, &s, want);
        draw(timed, &volume, &s, got);
    }
    tap_check(memcmp(want, got, sizeof want) == 0,
              "taking times changes no pixel");
    tap_check(times.busy[PASS_MARCH] > 0 && times.busy[PASS_STORE] > 0 &&
                  times.busy[PASS_RESOLVE] > 0 && times.busy[PASS_SHOW] > 0 &&
                  times.busy[PASS_PACK] == 0 && times.busy[PASS_BEGIN] > 0,
              "every pass of taa has its time, and no other has");
    renderer_free(plain);
    renderer_free(timed);
    free(asset);
}

static void test_errors(void)
{
    static uint8_t pixels[WIDTH * HEIGHT * 3];
    struct brume_volume volume;
    uint8_t *asset = make(&volume, SIDE / 8, density_in_cloud);
    struct renderer *r = new_renderer(2);
    struct brume_scene s = scene_at(&volume, 0, 0);
    renderer_volume(r, &volume);
    const struct render_target narrow = {BRUME_RGB888, pixels, WIDTH, NULL};
    tap_check(renderer_draw(r, &s, &narrow, err, sizeof err) != 0 &&
                  strstr(err, "rectangle"),
              "rows that are too short are an error");
    const struct render_target target = {BRUME_RGB888, pixels, WIDTH * 3, NULL};
    s.alpha = 1;
    tap_check(renderer_draw(r, &s, &target, err, sizeof err) != 0 &&
                  strstr(err, "scene field"),
              "and so is a scene out of range");
    renderer_free(r);
    free(asset);
}

int main(void)
{
    test_anchor();
    test_changes();
    test_profile();
    test_errors();
    return tap_done();
}
