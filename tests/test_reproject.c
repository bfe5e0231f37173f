/* SPDX-License-Identifier: MIT */
/*
 * Reprojection against a pinhole camera in doubles: history is a ramp, so its
 * value at a place tells the place; rays have a depth that is chosen here.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "brume_inner.h"
#include "support/asset_builder.h"
#include "support/passes.h"
#include "tap.h"

enum { W = 64, H = 48, RAYS = W * H };
#define PI 3.14159265358979323846
static struct brume_volume s_volume;

/// A camera ///

struct camera {
    double eye[3], ahead[3], right[3], up[3], focal;
};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void unit_cross(double out[3], const double a[3], const double b[3])
{
    for (int i = 0; i < 3; i++)
        out[i] =
            a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    double length = sqrt(dot(out, out));
    for (int i = 0; i < 3; i++)
        out[i] /= length;
}

static struct camera camera_of(const struct brume_scene *s)
{
    struct camera c;
    double up[3], length;
    for (int i = 0; i < 3; i++) {
        c.eye[i] = s->eye[i] / 65536.0;
        c.ahead[i] = s->target[i] / 65536.0 - c.eye[i];
        up[i] = s->up[i];
    }
    length = sqrt(dot(c.ahead, c.ahead));
    for (int i = 0; i < 3; i++)
        c.ahead[i] /= length;
    unit_cross(c.right, c.ahead, up);
    unit_cross(c.up, c.right, c.ahead);
    c.focal = s->height / 2.0 / tan(s->fov / 65536.0 * PI / 360);
    return c;
}

/* Where `before` saw what `now` sees on ray (x, y) at a distance: in rays. */
static void place_of(const struct camera *now, const struct camera *before,
                     int x, int y, int resolution, double distance,
                     double at[2])
{
    double size = 1 << resolution, d[3], p[3];
    double u = ((x + 0.5) * size - W / 2.0) / now->focal;
    double v = (H / 2.0 - (y + 0.5) * size) / now->focal;
    for (int i = 0; i < 3; i++)
        d[i] = now->ahead[i] + u * now->right[i] + v * now->up[i];
    double length = sqrt(dot(d, d));
    for (int i = 0; i < 3; i++)
        p[i] = now->eye[i] + distance / length * d[i] - before->eye[i];
    double scale = before->focal / dot(p, before->ahead);
    at[0] = (W / 2.0 + scale * dot(p, before->right)) / size - 0.5;
    at[1] = (H / 2.0 - scale * dot(p, before->up)) / size - 0.5;
}

/// Motion ///

#define DEPTH_CODE 0xbc00u /* 1.5 * 2^23, Q16.16 */
#define DISTANCE 192.0

struct motion {
    const char *name;
    double eye[3], target[3]; /* of the second frame, less the first one's */
    double roll;              /* of `up`, radians */
    double zoom;              /* of fov, degrees */
};

static struct brume_scene scene_of(const struct motion *m, int resolution,
                                   int fetch, uint32_t frame)
{
    struct brume_scene s;
    brume_scene_default(&s, &s_volume);
    s.width = W;
    s.height = H;
    s.frame = frame;
    s.fov = 40 << 16;
    s.temporal = BRUME_TAA;
    s.clamp = BRUME_CLAMP_NONE;
    s.fetch = (uint8_t)fetch;
    s.resolution = (uint8_t)resolution;
    s.alpha = 0x400;
    const double eye[3] = {100, 40, 150}, target[3] = {20, 10, -30};
    for (int i = 0; i < 3; i++) {
        double k = frame;
        s.eye[i] = (int32_t)lround((eye[i] + k * m->eye[i]) * 65536);
        s.target[i] = (int32_t)lround((target[i] + k * m->target[i]) * 65536);
    }
    s.up[0] = (int32_t)lround(frame * sin(m->roll) * (1 << 30));
    s.up[1] = (int32_t)lround((frame ? cos(m->roll) : 1) * (1 << 30));
    s.up[2] = 0;
    s.fov += (uint32_t)lround(frame * m->zoom * 65536);
    return s;
}

static double ramp(double x, double y)
{
    return 12000 + 500 * x + 400 * y;
}

/* The largest difference, in rays: history of places at least a ray and a half
 * inside the image, which a ramp is flat enough for; and how many. */
static double worst_place(const struct motion *m, int resolution, int fetch,
                          int *count)
{
    static struct brume_radiance in[RAYS];
    static struct brume_sample out[W];
    struct passes p = {0};
    struct brume_scene before = scene_of(m, resolution, fetch, 0);
    struct brume_scene now = scene_of(m, resolution, fetch, 1);
    const struct camera a = camera_of(&before), b = camera_of(&now);
    const int w = W >> resolution, h = H >> resolution;
    double worst = 0;
    *count = 0;
    for (int i = 0; i < w * h; i++) {
        in[i].light = (uint32_t)lround(ramp(i % w, i / w));
        in[i].transmittance = 30000;
        in[i].depth = DEPTH_CODE;
    }
    passes_begin(&p, &s_volume, &before);
    passes_store(&p, in);
    for (int i = 0; i < w * h; i++)
        in[i].light = 30000;
    passes_begin(&p, &s_volume, &now);
    passes_store(&p, in);
    for (int y = 0; y < h; y++) {
        brume_history_row(&p.frame, p.state, 0, (uint32_t)y, (uint32_t)w, out);
        for (int x = 0; x < w; x++) {
            double at[2];
            place_of(&b, &a, x, y, resolution, DISTANCE, at);
            if (at[0] < 1.5 || at[0] > w - 2.5 || at[1] < 1.5 ||
                at[1] > h - 2.5)
                continue;
            double history = (out[x].light - 30000 / 64.0) / (63 / 64.0);
            worst =
                fmax(worst, fabs(history - ramp(at[0], at[1])) / (500 + 400));
            ++*count;
        }
    }
    passes_free(&p);
    return worst;
}

/* A place is kept in 1/256 of a ray. On either axis it is rounded, and the
 * depth's code adds 1/2048 of what the eye's motion shifts it by. */
static void test_places(void)
{
    static const struct motion motions[] = {
        {"sideways", {4, 0, 1}, {4, 0, 1}, 0, 0},
        {"up", {0, 5, 0}, {0, 5, 0}, 0, 0},
        {"ahead", {-2, -1, -5}, {-2, -1, -5}, 0, 0},
        {"back", {2, 1, 6}, {2, 1, 6}, 0, 0},
        {"turning", {0, 0, 0}, {9, -7, 3}, 0, 0},
        {"rolling", {0, 0, 0}, {0, 0, 0}, 0.15, 0},
        {"zooming", {0, 0, 0}, {0, 0, 0}, 0, -6},
        {"all at once", {3, -2, -3}, {-4, 6, 5}, -0.1, 4},
    };
    for (size_t i = 0; i < sizeof motions / sizeof motions[0]; i++) {
        double worst = 0;
        int rays = 0, least = RAYS;
        for (int resolution = 0; resolution < 3; resolution++)
            for (int fetch = 0; fetch < 2; fetch++) {
                int n;
                worst = fmax(worst,
                             worst_place(&motions[i], resolution, fetch, &n));
                rays += n;
                n <<= 2 * resolution;
                least = n < least ? n : least;
            }
        tap_check(worst < 1 / 128.0 && least > RAYS / 4,
                  "%s: %d rays are found again to %.5f of a ray",
                  motions[i].name, rays, worst);
    }
}

/// Rejection ///

/* The first ray's history after a second frame whose depths are others. */
static uint32_t light_after(uint32_t first_depth, uint32_t second_depth)
{
    static const struct motion sideways = {
        "sideways", {1, 0, 0.5}, {1, 0, 0.5}, 0, 0};
    static struct brume_radiance in[RAYS];
    static struct brume_sample out[W];
    struct passes p = {0};
    for (uint32_t f = 0; f < 2; f++) {
        struct brume_scene s = scene_of(&sideways, 0, 0, f);
        uint32_t depth = f ? second_depth : first_depth;
        for (int i = 0; i < RAYS; i++) {
            in[i].light = f ? 10000 : 50000;
            in[i].transmittance = depth == BRUME_NO_DEPTH ? 65536 : 30000;
            in[i].depth = depth;
        }
        passes_begin(&p, &s_volume, &s);
        passes_store(&p, in);
    }
    brume_history_row(&p.frame, p.state, W / 2, H / 2, 1, out);
    passes_free(&p);
    return out[0].light;
}

static void test_rejection(void)
{
    tap_check(light_after(DEPTH_CODE, DEPTH_CODE) > 49000,
              "the same depth: history");
    tap_check(light_after(DEPTH_CODE + 400, DEPTH_CODE) == 10000 &&
                  light_after(DEPTH_CODE - 400, DEPTH_CODE) == 10000,
              "a depth a fifth of an octave nearer or farther: none");
    tap_check(light_after(DEPTH_CODE, BRUME_NO_DEPTH) == 10000,
              "clear where something was: none");
    tap_check(light_after(BRUME_NO_DEPTH, DEPTH_CODE) > 49000,
              "something where it was clear: history, for edges");
}

int main(void)
{
    static const struct density_box box = {{4, 4, 4}, {28, 20, 36}, 32768};
    struct asset_spec spec =
        asset_spec_of(4, 3, 5, BRUME_U8, density_in_box, &box);
    size_t size;
    uint8_t *asset = asset_build(&spec, &size);
    if (brume_volume_open(&s_volume, asset, size, 0) != BRUME_OK)
        abort();
    test_places();
    test_rejection();
    free(asset);
    return tap_done();
}
