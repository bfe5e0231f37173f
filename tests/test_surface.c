/* SPDX-License-Identifier: MIT */
/*
 * Solid things as `brume surface` sees them, against closed forms and against
 * all triangles one by one.
 */
#include "tap.h"

#include "brume_inner.h"
#include "support/things.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint32_t seed = 1;
static double random_in(double low, double high)
{
    seed ^= seed << 13;
    seed ^= seed >> 17;
    seed ^= seed << 5;
    return low + (high - low) * seed / 4294967296.0;
}

/// Depth ///

/* Where a distance lies on the scale of codes, before it is rounded down. */
static double code_of(double distance)
{
    double q16 = distance * 65536, high = floor(log2(q16));
    return 2048 * (high + q16 / exp2(high) - 1);
}

static void test_codes(void)
{
    unsigned wrong = 0;
    for (uint32_t k = 0; k < 1000000; k++) {
        uint32_t t = (uint32_t)random_in(0, 4294967295.0) >> (k % 32);
        uint32_t want = brume_depth_code(t < 0xffefffffu ? t : 0xffefffffu);
        wrong += surface_depth_code(t / 65536.0) != want;
        wrong += surface_depth_code((t + 0.999) / 65536.0) != want;
    }
    tap_check(wrong == 0, "codes are the core's: %u are not", wrong);
    tap_check(surface_depth_code(0) == 0 && surface_depth_code(-1) == 0 &&
                  surface_depth_code(1e300) == 65534 &&
                  surface_depth_code(65519.99) == 65534,
              "nearest and farthest codes");
}

/* The camera of brume.h in doubles, on its own: the unit ray of a pixel. */
static void camera_ray(int x, int y, double out[3])
{
    const double degree = 3.14159265358979323846 / 180;
    double ahead[3], right[3], up[3], sum = 0;
    double tangent = tan(things_scene.fov / 65536.0 / 2 * degree);
    double u = (2 * x + 1 - things_scene.width) * tangent / things_scene.height;
    double v =
        (things_scene.height - 1 - 2 * y) * tangent / things_scene.height;
    for (int i = 0; i < 3; i++) {
        ahead[i] =
            (things_scene.target[i] - (double)things_scene.eye[i]) / 65536;
        sum += ahead[i] * ahead[i];
    }
    for (int i = 0; i < 3; i++)
        ahead[i] /= sqrt(sum);
    /* ahead x (0, 1, 0) */
    double flat = sqrt(ahead[0] * ahead[0] + ahead[2] * ahead[2]);
    right[0] = -ahead[2] / flat;
    right[1] = 0;
    right[2] = ahead[0] / flat;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        up[i] = right[j] * ahead[k] - right[k] * ahead[j];
    }
    sum = 0;
    for (int i = 0; i < 3; i++) {
        out[i] = ahead[i] + u * right[i] + v * up[i];
        sum += out[i] * out[i];
    }
    for (int i = 0; i < 3; i++)
        out[i] /= sqrt(sum);
}

/* A plane at y = 0. Directions of the core are off by less than 1e-7 radians,
 * which a plane seen at a sine of 0.05 or more turns into less than 2e-6 of the
 * distance, 0.01 of a code (4096 times that at most). */
static void test_plane(void)
{
    const struct mesh_ground ground = {0, {-1e5, -1e5, 1e5, 1e5}, 0, NULL};
    struct mesh mesh = {0};
    struct surface s;
    struct grey16 depth;
    double low = 0, high = 0;
    unsigned seen = 0, holes = 0, ghosts = 0;
    mesh_add_ground(&mesh, &ground, &things_volume, 0, things_err,
                    sizeof things_err);
    things_surface(&s, &mesh);
    surface_depth(&s, NULL, &depth, things_err, sizeof things_err);
    for (int k = 0; k < 160 * 120; k++) {
        double unit[3];
        uint16_t code = depth.values[k];
        camera_ray(k % 160, k / 160, unit);
        ghosts += unit[1] > 1e-6 && code != 65535;
        if (unit[1] > -0.05)
            continue;
        seen++;
        holes += code == 65535;
        double off = code_of(-10 / unit[1]) - code;
        low = fmin(low, off);
        high = fmax(high, off);
    }
    tap_check(
        seen > 9000 && holes == 0 && ghosts == 0 && low > -0.01 && high < 1.01,
        "a plane: %u pixels, codes %.4f below to %.4f above", seen, -low, high);
    grey16_free(&depth);
    things_end(&s, &mesh);
}

/* Its facets lie inside of the sphere by up to radius (pi / n)^2 / 2 along a
 * meridian and as much along a parallel, and a ray meets them by that over the
 * cosine later: with 4096 codes to e times the distance, and at least 20 from
 * the eye, the error has this bound. */
static void test_sphere(void)
{
    const double centre[3] = {2, 9, -5}, radius = 12, least = 0.2;
    const int n = 400;
    const double sagitta = radius * 9.87 / (n * n);
    const double bound = 0.01 + 4096 * sagitta / least / 20;
    struct mesh mesh = {0};
    struct surface s;
    struct grey16 depth;
    double low = 0, high = 0;
    unsigned seen = 0, holes = 0, ghosts = 0;
    things_sphere(&mesh, centre, radius, n);
    things_surface(&s, &mesh);
    surface_depth(&s, NULL, &depth, things_err, sizeof things_err);
    for (int k = 0; k < 160 * 120; k++) {
        double unit[3], b = 0, c = -radius * radius;
        uint16_t code = depth.values[k];
        camera_ray(k % 160, k / 160, unit);
        for (int i = 0; i < 3; i++) {
            double from = things_scene.eye[i] / 65536.0 - centre[i];
            b += from * unit[i];
            c += from * from;
        }
        ghosts += b * b - c < -1e-3 && code != 65535;
        if (b * b - c < least * least * radius * radius)
            continue;
        seen++;
        holes += code == 65535;
        double off = code_of(-b - sqrt(b * b - c)) - code;
        low = fmin(low, off);
        high = fmax(high, off);
    }
    tap_check(bound < 1 && seen > 1000 && holes == 0 && ghosts == 0 &&
                  low > -bound && high < 1.01,
              "a sphere: %u pixels, codes %.4f below (at most %.2f) to %.4f "
              "above",
              seen, -low, bound, high);
    grey16_free(&depth);
    things_end(&s, &mesh);
}

static void test_around(void)
{
    const double a[3] = {-50, -50, -90}, b[3] = {50, 50, 50};
    const double c[3] = {-50, -50, -90}, d[3] = {50, 50, -41};
    struct mesh mesh = {0};
    struct surface s;
    struct grey16 depth;
    struct image image;
    unsigned holes = 0, bad = 0;
    things_box(&mesh, a, b);
    things_surface(&s, &mesh);
    surface_depth(&s, NULL, &depth, things_err, sizeof things_err);
    surface_colour(&s, NULL, 2, &image, things_err, sizeof things_err);
    for (int k = 0; k < 160 * 120; k++) {
        holes += depth.values[k] == 65535;
        for (int i = 0; i < 3; i++)
            bad += !(image.f32[3 * k + i] >= 0 && image.f32[3 * k + i] < 0.03f);
    }
    tap_check(holes == 0 && bad == 0,
              "inside of a box: no pixel is free, no sun comes in");
    grey16_free(&depth);
    image_free(&image);
    things_end(&s, &mesh);
    things_box(&mesh, c, d);
    things_surface(&s, &mesh);
    surface_depth(&s, NULL, &depth, things_err, sizeof things_err);
    holes = 0;
    for (int k = 0; k < 160 * 120; k++)
        holes += depth.values[k] == 65535;
    tap_check(holes == 160 * 120, "what is behind the camera is not seen");
    grey16_free(&depth);
    things_end(&s, &mesh);
}

/// Rays ///

/* Every third one along an axis, every fourth from a vertex. */
static void random_ray(const struct mesh *m, int k, double from[3],
                       double unit[3])
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        from[i] = random_in(-10, 10);
        unit[i] = k % 3 == 0 ? i == k / 3 % 3 : random_in(-1, 1);
        sum += unit[i] * unit[i];
    }
    for (int i = 0; i < 3; i++)
        unit[i] *= (k & 1 ? -1 : 1) / sqrt(sum);
    if (k % 4 == 0)
        memcpy(from, m->vertex[(uint32_t)k % m->vertices], 3 * sizeof *from);
}

/* The tree leaves nothing out: against meshes of one triangle each. */
static void test_tree(void)
{
    enum { TRIANGLES = 300, RAYS = 3000 };
    struct mesh mesh = {0};
    static struct caster *one[TRIANGLES];
    static struct mesh single[TRIANGLES];
    unsigned wrong = 0, met = 0;
    for (int n = 0; n < TRIANGLES; n++) {
        char text[400];
        double v[9];
        for (int i = 0; i < 9; i++) /* some share planes and lines */
            v[i] = n % 2 ? random_in(-9, 9) : floor(random_in(-4, 5));
        snprintf(text, sizeof text,
                 "v %.17g %.17g %.17g\nv %.17g %.17g %.17g\n"
                 "v %.17g %.17g %.17g\nv 100 0 0\nv 101 0 0\nv 100 1 0\n"
                 "f 1 2 3\nf 4 5 6\n",
                 v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8]);
        things_obj(&mesh, text);
        things_obj(&single[n], text);
        one[n] = caster_new(&single[n]);
    }
    struct caster *all = caster_new(&mesh);
    for (int k = 0; k < RAYS; k++) {
        double from[3], unit[3], nearest = INFINITY;
        struct ray_hit hit;
        random_ray(&mesh, k, from, unit);
        for (int n = 0; n < TRIANGLES; n++)
            if (caster_nearest(one[n], from, unit, 1000, &hit))
                nearest = fmin(nearest, hit.distance);
        bool any = caster_nearest(all, from, unit, 1000, &hit);
        wrong += any != (nearest < INFINITY) ||
                 (any && hit.distance != nearest) ||
                 any != caster_meets(all, from, unit, 1000);
        met += any;
    }
    tap_check(wrong == 0 && met > RAYS / 4,
              "the tree finds what all triangles have: %u of %u rays wrong",
              wrong, met);
    caster_free(all);
    mesh_free(&mesh);
    for (int n = 0; n < TRIANGLES; n++) {
        caster_free(one[n]);
        mesh_free(&single[n]);
    }
}

/* No ray gets out of a closed mesh, through faces, edges or vertices. */
static void test_watertight(void)
{
    const double centre[3] = {0.3, -0.7, 1.1};
    struct mesh mesh = {0};
    unsigned lost = 0;
    things_sphere(&mesh, centre, 5, 24);
    struct caster *c = caster_new(&mesh);
    for (uint32_t k = 0; k < 200000; k++) {
        double from[3], unit[3], sum = 0;
        const double *a = mesh.vertex[k % mesh.vertices];
        const double *b = mesh.vertex[(k + 1) % mesh.vertices];
        double part = k % 3 == 0 ? 0 : random_in(0, 1);
        struct ray_hit hit;
        for (int i = 0; i < 3; i++) {
            from[i] = centre[i] + random_in(-1, 1);
            unit[i] = k % 5 == 0 ? random_in(-1, 1)
                                 : a[i] + part * (b[i] - a[i]) - from[i];
            sum += unit[i] * unit[i];
        }
        for (int i = 0; i < 3; i++)
            unit[i] /= sqrt(sum);
        lost += !caster_nearest(c, from, unit, INFINITY, &hit);
    }
    tap_check(lost == 0, "no ray gets out of a closed mesh: %u did", lost);
    caster_free(c);
    mesh_free(&mesh);
}

int main(void)
{
    things_begin();
    test_codes();
    test_plane();
    test_sphere();
    test_around();
    test_tree();
    test_watertight();
    free(things_volume.data);
    return tap_done();
}
