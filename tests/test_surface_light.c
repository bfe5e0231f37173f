/* SPDX-License-Identifier: MIT */
/*
 * How `brume surface` shades things and what its sun maps hold, against closed
 * forms.
 */
#include "tap.h"

#include "support/things.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Light ///

/* White: 4 cos of the sun, and a sky of 0.1; a quarter of it comes back. */
static void test_colour(void)
{
    const struct mesh_ground ground = {0, {-1e5, -1e5, 1e5, 1e5}, 0, NULL};
    const double a[3] = {-30, 20, -30}, b[3] = {30, 21, 30};
    static const double k_elevation[] = {90, 30, 5, 0, -20};
    struct mesh mesh = {0};
    struct surface s;
    struct image image;
    const size_t low = (size_t)(110 * 160 + 80) * 3; /* near the camera */
    const size_t sky = (size_t)50 * 160 * 3;         /* above the horizon */
    mesh_add_ground(&mesh, &ground, &things_volume, 0, things_err,
                    sizeof things_err);
    for (int k = 0; k < 5; k++) {
        double sine = sin(k_elevation[k] * 3.14159265358979323846 / 180);
        brume_direction(things_scene.sun, 40 << 16,
                        (int32_t)(k_elevation[k] * 65536));
        things_surface(&s, &mesh);
        surface_colour(&s, NULL, 1, &image, things_err, sizeof things_err);
        double want = 0.25 * (4 * fmax(sine, 0) + 0.1);
        tap_check(fabs(image.f32[low] - want) < 1e-6,
                  "ground under a sun at %g degrees: %.7f, not %.7f",
                  k_elevation[k], (double)image.f32[low], want);
        image_free(&image);
        caster_free((struct caster *)(uintptr_t)s.caster);
    }
    things_point(things_scene.sun, 0, 1, 0);
    things_box(&mesh, a, b);
    things_surface(&s, &mesh);
    surface_colour(&s, NULL, 3, &image, things_err, sizeof things_err);
    tap_check(fabsf(image.f32[low] - 0.025f) < 1e-6f,
              "in the shadow of a roof it is the sky's: %.7f",
              (double)image.f32[low]);
    tap_check(image.f32[sky] > 0.119f && image.f32[sky] < 0.121f &&
                  image.f32[sky + 2] > 0.499f,
              "what is free is the scene's background");
    image_free(&image);
    things_end(&s, &mesh);
}

/* One lamp, 10 above the ground straight ahead; the sun is below. */
static void test_lamp(void)
{
    const struct mesh_ground ground = {0, {-1e5, -1e5, 1e5, 1e5}, 0, NULL};
    const double a[3] = {-1, 4, -1}, b[3] = {1, 5, 1};
    static struct brume_lighting lighting;
    static struct brume_lamp lamp;
    struct brume_scene before = things_scene;
    struct mesh mesh = {0};
    struct surface s;
    struct image image;
    const size_t at = (size_t)(60 * 160 + 80) * 3;
    things_point(lamp.position, 0, 10, 0);
    lamp.radius = 40 << 16;
    lamp.size = 2 << 16;
    lamp.colour[0] = 3 << 16;
    lamp.cos_outer = -(1 << 30);
    lighting.lamps = &lamp;
    lighting.lamp_count = 1;
    for (int c = 0; c < 3; c++)
        lighting.sun_colour[c] = 1 << 16;
    things_scene.lighting = &lighting;
    things_point(things_scene.sun, 0, -1, 0);
    things_point(things_scene.target, 0, 0, 0);
    mesh_add_ground(&mesh, &ground, &things_volume, 0, things_err,
                    sizeof things_err);
    things_surface(&s, &mesh);
    double unit[3], p[3], r = 0;
    surface_ray(&s, 1, -1, unit);
    for (int i = 0; i < 3; i++) {
        p[i] = s.eye[i] - s.eye[1] / unit[1] * unit[i];
        r += (p[i] - (i == 1 ? 10 : 0)) * (p[i] - (i == 1 ? 10 : 0));
    }
    r = sqrt(r);
    double window = 1 - pow(r / 40, 4);
    double want = 0.25 * (4 * 10 / r * 3 * 4 / (r * r) * window * window + 0.1);
    surface_colour(&s, NULL, 1, &image, things_err, sizeof things_err);
    tap_check(fabs(image.f32[at] - want) < 1e-6 &&
                  fabs(image.f32[at + 1] - 0.025) < 1e-6,
              "the ground %.3f from a lamp: %.7f, not %.7f", r,
              (double)image.f32[at], want);
    image_free(&image);
    caster_free((struct caster *)(uintptr_t)s.caster);
    things_box(&mesh, a, b);
    things_surface(&s, &mesh);
    surface_colour(&s, NULL, 1, &image, things_err, sizeof things_err);
    tap_check(fabs(image.f32[at] - 0.025) < 1e-6,
              "and a thing before that lamp shades it");
    image_free(&image);
    things_end(&s, &mesh);
    things_scene = before;
}

/// Over a picture ///

static uint32_t next_random(void)
{
    static uint32_t seed = 1;
    seed ^= seed << 13;
    seed ^= seed >> 17;
    seed ^= seed << 5;
    return seed;
}

/* dst = rgb + dst * (255 - a) / 255 of a linear picture against the core over
 * the same background: rgb and a are rounded, by half a code each at most, so
 * the codes are at most one apart. */
static void test_rgba(void)
{
    struct brume_scene linear = things_scene;
    struct brume_frame frame;
    int most = 0;
    linear.output = BRUME_LINEAR;
    brume_begin_frame(&frame, &things_volume.volume, &linear);
    for (int k = 0; k < 200000; k++) {
        struct brume_radiance ray = {.transmittance = next_random() % 65537};
        uint32_t code = next_random() % 256;
        uint8_t rgba[4], want[3];
        ray.light = next_random() % (65537 - ray.transmittance);
        for (int c = 0; c < 3; c++)
            frame.background[c] = (code * 65536 + 127) / 255;
        brume_pack_rect(&frame, &ray, 1, 0, 0, 1, 1, BRUME_RGBA8888, rgba, 4);
        brume_pack_rect(&frame, &ray, 1, 0, 0, 1, 1, BRUME_RGB888, want, 3);
        int got = (int)(rgba[0] + (code * (255u - rgba[3]) + 127) / 255);
        most = abs(got - want[0]) > most ? abs(got - want[0]) : most;
    }
    tap_check(most == 1, "RGBA over a linear picture is off by %d code", most);
}

/// Sun maps ///

/* What the texel nearest to p holds, as a distance from the map's plane. */
static double depth_at(const struct sun_map_file *m, const double p[3],
                       double *below)
{
    double x = 0, y = 0, xx = 0, yy = 0, normal[3], length = 0;
    *below = 0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        normal[i] = m->across[j] * m->down[k] - m->across[k] * m->down[j];
        length += normal[i] * normal[i];
        x += (p[i] - m->origin[i]) * m->across[i];
        y += (p[i] - m->origin[i]) * m->down[i];
        xx += m->across[i] * m->across[i];
        yy += m->down[i] * m->down[i];
    }
    for (int i = 0; i < 3; i++)
        *below += (p[i] - m->origin[i]) * normal[i] / sqrt(length);
    size_t column = (size_t)(x / xx * m->texels.width);
    size_t row = (size_t)(y / yy * m->texels.height);
    uint16_t value = m->texels.values[row * (size_t)m->texels.width + column];
    return value == 65535 ? INFINITY : value / 65535.0 * m->range;
}

/* Where a ray enters a box; infinity when it misses. *sure: it does not pass
 * within 1e-6 of an edge, where rounding may decide. */
static double enter(const double from[3], const double unit[3],
                    const double a[3], const double b[3], bool *sure)
{
    double in = 0, out = INFINITY;
    *sure = true;
    for (int i = 0; i < 3; i++) {
        if (unit[i] == 0) {
            *sure = *sure && fabs(from[i] - a[i]) > 1e-6 &&
                    fabs(from[i] - b[i]) > 1e-6;
            if (from[i] < a[i] || from[i] > b[i])
                out = -INFINITY;
            continue;
        }
        double s = (a[i] - from[i]) / unit[i], t = (b[i] - from[i]) / unit[i];
        in = fmax(in, fmin(s, t));
        out = fmin(out, fmax(s, t));
    }
    *sure = *sure && fabs(out - in) > 1e-6;
    return in < out ? in : INFINITY;
}

/* Every texel of a map of a box, for suns from everywhere, along its faces too:
 * the distance along the sun, rounded to a code; its edges across the sun. The
 * core's direction of the sun is off by 2^-30. */
static void test_sun_map(void)
{
    const double a[3] = {-9, -6, -3}, b[3] = {11, 6, 3};
    static const double k_suns[][3] = {{0, 1, 0},    {1, 0, 0},    {0, 0, -1},
                                       {1, 2, 3},    {-3, -1, 2},  {0, -1, 0},
                                       {1e-3, 1, 0}, {0, 1e-4, 1}, {1, 1, 0}};
    const unsigned size[2] = {64, 48};
    struct mesh mesh = {0};
    things_box(&mesh, a, b);
    for (size_t k = 0; k < sizeof k_suns / sizeof *k_suns; k++) {
        const double *sun = k_suns[k];
        double away[3], lean = 0, most = 0;
        unsigned wrong = 0, dark = 0;
        struct surface s;
        struct sun_map_file map;
        struct brume_sun_map core;
        things_point(things_scene.sun, sun[0], sun[1], sun[2]);
        things_surface(&s, &mesh);
        int status = surface_sun_map(&s, NULL, size, NULL, -1, &map, things_err,
                                     sizeof things_err);
        for (int i = 0; i < 3; i++) {
            away[i] = -things_scene.sun[i] / 65536.0;
            lean += map.across[i] * map.down[i];
        }
        double length =
            sqrt(away[0] * away[0] + away[1] * away[1] + away[2] * away[2]);
        for (int i = 0; i < 3; i++)
            away[i] /= length;
        for (int n = 0; n < 64 * 48; n++) {
            double from[3], value = map.texels.values[n] / 65535.0 * map.range;
            bool sure;
            for (int i = 0; i < 3; i++)
                from[i] = map.origin[i] + map.across[i] * (n % 64 + 0.5) / 64 +
                          map.down[i] * (n / 64 + 0.5) / 48;
            double want = enter(from, away, a, b, &sure);
            if (!sure)
                continue;
            dark += want < INFINITY;
            if ((want < INFINITY) != (map.texels.values[n] != 65535))
                wrong++;
            else if (want < INFINITY)
                most = fmax(most, fabs(value - want) * 65535 / map.range);
        }
        tap_check(status == 0 && wrong == 0 && dark > 100 && most < 0.51 &&
                      fabs(lean) < 1e-9 && map.bias > 0 &&
                      sun_map_file_apply(&map, &things_volume, &core,
                                         things_err, sizeof things_err) == 0,
                  "sun at %g,%g,%g: %u dark texels, off by %.3f codes", sun[0],
                  sun[1], sun[2], dark, most);
        sun_map_file_free(&map);
        caster_free((struct caster *)(uintptr_t)s.caster);
    }
    things_point(things_scene.sun, 0, 1, 0);
    mesh_free(&mesh);
}

/* A level ground and a sun on the horizon: nothing is shaded. A small cover
 * around what a box shades has the same depths, as a share of its range. */
static void test_cover(void)
{
    const struct mesh_ground ground = {0, {-300, -300, 300, 300}, 0, NULL};
    const double cover[6] = {-10, 0, -10, 10, 20, 10};
    const unsigned size[2] = {32, 32};
    struct mesh mesh = {0};
    struct surface s;
    struct sun_map_file map;
    unsigned dark = 0;
    double p[3] = {3, 0, 4}, below;
    mesh_add_ground(&mesh, &ground, &things_volume, 0, things_err,
                    sizeof things_err);
    things_point(things_scene.sun, 0, 1, 0);
    things_surface(&s, &mesh);
    surface_sun_map(&s, NULL, size, cover, 0.5, &map, things_err,
                    sizeof things_err);
    double depth = depth_at(&map, p, &below);
    tap_check(fabs(depth - below) < map.range / 65535 && map.bias == 0.5 &&
                  fabs(map.range - 22) < 1e-9 && fabs(map.across[0]) < 23,
              "a map of a box of the world: range %g, %g across", map.range,
              map.across[0]);
    sun_map_file_free(&map);
    caster_free((struct caster *)(uintptr_t)s.caster);
    things_point(things_scene.sun, 1, 0, 0);
    things_surface(&s, &mesh);
    surface_sun_map(&s, NULL, size, NULL, -1, &map, things_err,
                    sizeof things_err);
    for (int i = 0; i < 32 * 32; i++)
        dark += map.texels.values[i] != 65535;
    tap_check(dark == 0, "a ground seen edge on shades nothing: %u texels",
              dark);
    sun_map_file_free(&map);
    things_end(&s, &mesh);
    things_point(things_scene.sun, 0, 1, 0);
}

int main(void)
{
    things_begin();
    test_colour();
    test_lamp();
    test_rgba();
    test_sun_map();
    test_cover();
    free(things_volume.data);
    return tap_done();
}
