// SPDX-License-Identifier: MIT
//
// The reference renderer against closed forms: nothing vouches for it but
// arithmetic that can be checked by hand.

#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "reference/float_dump.hpp"
#include "reference/made.hpp"
#include "reference/march.hpp"
#include "reference/noise.hpp"
#include "reference/pfm.hpp"
#include "reference/scene.hpp"
#include "reference/volume.hpp"
#include "tap.h"

using namespace reference;

namespace {

const double pi = 3.14159265358979323846;

bool throws(const std::function<void()> &action, const std::string &part)
{
    try {
        action();
    } catch (const std::runtime_error &e) {
        const bool as_expected =
            std::string(e.what()).find(part) != std::string::npos;
        if (!as_expected)
            std::printf("# got: %s\n", e.what());
        return as_expected;
    }
    return false;
}

/// Slab ///

void test_slab_transmittance()
{
    const volume slab = make_slab();
    const double want = std::exp(-0.1 * 0.5 * slab_length);
    for (double step : {0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0}) {
        const scene s = make_scene(with(slab_view(), {{"step", number(step)}}));
        const march_result m = renderer(slab, s).march_pixel(0, 0);
        tap_check(std::fabs(m.transmittance - want) < 1e-12 &&
                      std::fabs(m.radiance - (1 - want)) < 1e-12,
                  "slab: T = exp(-sigma L), L = 1 - T at step %g", step);
    }
}

void test_pixel_value()
{
    const volume slab = make_slab();
    const double t = std::exp(-0.1 * 0.5 * slab_length);
    const scene grey = make_scene(
        with(slab_view(), {{"albedo", "0.5"}, {"background", "0.75"}}));
    check_near(render(slab, grey).values[0], 0.5 * (1 - t) + 0.75 * t, 1e-12,
               "albedo and grey background");
    const scene rgb =
        make_scene(with(slab_view(), {{"background", "0.25,0.5,2"}}));
    const picture image = render(slab, rgb);
    tap_check(image.channels == 3 && image.values.size() == 3,
              "a background of r,g,b makes three channels");
    check_near(image.values[2], 1 - t + 2 * t, 1e-12, "blue, unclamped");
}

void test_thresholds()
{
    const volume slab = make_slab();
    const auto march = [&](const char *key, const char *value) {
        const scene s = make_scene(with(slab_view(), {{key, value}}));
        return renderer(slab, s).march_pixel(0, 0).transmittance;
    };
    tap_check(march("min_density", "0.5") == 1,
              "a density equal to min_density does not contribute");
    tap_check(march("min_density", "0.49") < 1,
              "a density above min_density does");
    // T after n steps is exp(-0.05 n): first below 0.5 at n = 14.
    check_near(march("min_transmittance", "0.5"), std::exp(-0.05 * 14), 1e-12,
               "the ray stops at the first T below min_transmittance");
    volume thin(make_dump(64, 128, 8, [](int, int, int) { return 0.5; }),
                0.125);
    tap_check(thin.density({8, 8, 4}, lookup::nearest) == 0.125,
              "voxels are clamped to max_density");
}

/// Light ///

// Sun behind the camera: the light path from depth x is x long, and
// L = int_0^L sigma exp(-sigma x) exp(-sigma_l x / mu) dx, mu = cos(slant).
double slab_scattering(double sigma, double sigma_light, double mu)
{
    const double sum = sigma + sigma_light / mu;
    return sigma / sum * (1 - std::exp(-sum * slab_length));
}

scene lit_slab(const char *sun, double step)
{
    return make_scene(with(slab_view(), {{"light", "uniform"},
                                         {"light_density_scale", "0.16"},
                                         {"light_samples", "60000"},
                                         {"light_step", number(step)},
                                         {"step", number(step)},
                                         {"sun", sun}}));
}

// With the sun along the axis both marches are geometric series.
void test_uniform_light_series()
{
    const volume slab = make_slab();
    const double sigma = 0.05, sigma_light = 0.08;
    for (double step : {0.25, 1.0, 4.0}) {
        const double q = std::exp(-(sigma + sigma_light) * step);
        const double n = slab_length / step;
        const double want =
            (1 - std::exp(-sigma * step)) * (1 - std::pow(q, n)) / (1 - q);
        const scene s = lit_slab("-90 0", step);
        check_near(renderer(slab, s).march_pixel(0, 0).radiance, want, 1e-12,
                   "slab, uniform light: the geometric series");
    }
}

void test_uniform_light_limit()
{
    const volume slab = make_slab();
    const double slant = 30; // degrees from the slab's normal
    const double want =
        slab_scattering(0.05, 0.08, std::cos(slant * pi / 180));
    double error[3];
    for (int i = 0; i < 3; i++) {
        const scene s = lit_slab("-90 30", std::ldexp(0.25, -2 * i));
        error[i] = renderer(slab, s).march_pixel(0, 0).radiance - want;
    }
    tap_check(error[0] > error[1] && error[1] > error[2] && error[2] > 0 &&
                  error[0] / error[1] > 3.5 && error[1] / error[2] > 3.5,
              "slab, slanted sun: a quarter of the step, a quarter of the"
              " error (%.2g %.2g %.2g)",
              error[0], error[1], error[2]);
    check_near(error[2], 0, 5e-4, "slab, slanted sun: the analytic integral");
}

// A single opaque enough step at depth x: L / (1 - T) is S itself.
double slab_sun(const volume &slab, double depth, double jitter)
{
    const scene s =
        make_scene(with(slab_view(), {{"light", "log"},
                                      {"light_density_scale", "0.1"},
                                      {"light_samples", "5"},
                                      {"light_step", "1"},
                                      {"min_transmittance", "1"},
                                      {"sun", "-90 0"}}));
    // min_transmittance 1 stops the march after its first sample.
    const ray r = {{15.5 + depth, 64, 4}, {1, 0, 0}};
    const march_result m = renderer(slab, s).march(r, 0, jitter);
    return m.radiance / (1 - m.transmittance);
}

void test_log_light()
{
    const volume slab = make_slab();
    const double sigma_light = 0.05;
    check_near(slab_sun(slab, 0.5, 0), 1, 1e-12,
               "log light: nothing before the first sample");
    check_near(slab_sun(slab, 10, 0), std::exp(-sigma_light * (1 + 2 + 4 + 8)),
               1e-12, "log light: samples at 1, 2, 4, 8 reach, 16 does not");
    // Moved to 1.5, 3, 6, 12, 24: three reach, with the weights 1, 2, 4.
    check_near(slab_sun(slab, 10, 0.5), std::exp(-sigma_light * (1 + 2 + 4)),
               1e-12, "log light: jitter moves samples, not weights");
}

void test_light_ignores_min_density()
{
    // The sample has density 1; the light crosses density 0.25.
    const volume v = make_volume(24, 8, 8, [](int i, int, int) {
        return i == 12 ? 1.0 : 0.25;
    });
    const scene s = make_scene({{"eye", "12 4 4"},
                                {"target", "13 4 4"},
                                {"light", "uniform"},
                                {"light_samples", "4"},
                                {"min_density", "0.5"},
                                {"sun", "90 0"}});
    // Samples at 0.5, which rounds up to the next voxel, 1.5, 2.5 and 3.5.
    check_near(renderer(v, s).march_pixel(0, 0).radiance,
               (1 - std::exp(-1)) * std::exp(-4 * 0.25), 1e-12,
               "light samples are not subject to min_density");
}

void test_sun_direction()
{
    const volume v = make_volume(8, 8, 8, [](int, int, int) { return 0; });
    const struct {
        const char *sun;
        vec3 want;
    } cases[] = {{"0 0", {0, 0, 1}},
                 {"90 0", {1, 0, 0}},
                 {"-90 0", {-1, 0, 0}},
                 {"17 90", {0, 1, 0}},
                 {"180 -30", {0, -0.5, -std::sqrt(0.75)}}};
    for (const auto &c : cases) {
        const vec3 sun = renderer(v, make_scene({{"sun", c.sun}})).sun();
        tap_check(length(sun - c.want) < 1e-15, "sun = %s", c.sun);
    }
}

/// Shapes ///

const double sphere_radius = 24;

// One voxel of linear fall-off, so that trilinear lookup follows the surface.
volume make_sphere(int size)
{
    const double centre = (size - 1) / 2.0;
    return make_volume(size, size, size, [=](int i, int j, int k) {
        const vec3 d = {i - centre, j - centre, k - centre};
        return std::fmin(1, std::fmax(0, sphere_radius - length(d) + 0.5));
    });
}

// The length of a ray within the sphere at `centre`.
double chord(const ray &r, const vec3 &centre)
{
    const vec3 to_centre = centre - r.origin;
    const double along = dot(to_centre, r.direction);
    const double off2 = dot(to_centre, to_centre) - along * along;
    const double half2 = sphere_radius * sphere_radius - off2;
    return half2 > 0 ? 2 * std::sqrt(half2) : 0;
}

void test_sphere()
{
    const volume sphere = make_sphere(64);
    const vec3 centre = {31.5, 31.5, 31.5};
    const scene s = make_scene({{"size", "64x48"},
                                {"eye", "100 60 90"},
                                {"target", triple(centre)},
                                {"density_scale", "0.05"},
                                {"step", "0.25"},
                                {"filter", "trilinear"}});
    const renderer r(sphere, s);
    double worst = 0, worst_edge = 0, sum = 0;
    for (int y = 0; y < s.height; y++)
        for (int x = 0; x < s.width; x++) {
            const double within = chord(r.camera_ray(x, y), centre);
            const double d = r.march_pixel(x, y).transmittance -
                             std::exp(-0.05 * within);
            // A chord of 19.2 lies two voxels below the surface.
            double &bound = within > 19.2 ? worst : worst_edge;
            bound = std::fmax(bound, std::fabs(d));
            sum += d;
        }
    check_near(worst, 0, 8e-3, "sphere: worst pixel within it");
    // Where the ball ends the fall-off has an optical depth of 0.05·3.3 and
    // the ball none; exp is convex, so the blur also lowers the mean.
    check_near(worst_edge, 0, 0.2, "sphere: worst pixel at its edge");
    check_near(sum / (s.width * s.height), 0, 2e-3, "sphere: mean");
    const ray through = {{-20, 31.5, 31.5}, {1, 0, 0}};
    check_near(r.march(through, 0, 0).transmittance, std::exp(-0.05 * 48),
               1e-4, "sphere: the diameter");
}

// Coefficients are powers of two: every voxel is exact as a float.
double ramp(double x, double y, double z)
{
    return 0.5 + x / 8 + y / 16 + z / 64;
}

void test_trilinear_ramp()
{
    const volume v = make_volume(16, 24, 8, ramp);
    double worst = 0;
    for (int n = 0; n < 1000; n++) {
        const vec3 p = {std::fmod(n * 0.7548776662, 15),
                        std::fmod(n * 0.5698402910, 23),
                        std::fmod(n * 0.3819660113, 7)};
        worst = std::fmax(worst, std::fabs(v.density(p, lookup::trilinear) -
                                           ramp(p.x, p.y, p.z)));
    }
    check_near(worst, 0, 1e-14, "ramp: trilinear is linear");
    // Samples at x = 0, 1/4 .. 15: the sum of an arithmetic series.
    const scene s = make_scene({{"eye", "0 11.5 3.25"},
                                {"target", "1 11.5 3.25"},
                                {"density_scale", "0.03"},
                                {"step", "0.25"},
                                {"filter", "trilinear"}});
    const double sum = 61 * (ramp(0, 11.5, 3.25) + ramp(15, 11.5, 3.25)) / 2;
    // Beyond x = 15 the last voxel fades out: 3/4, 1/2, 1/4.
    const double fade = 1.5 * ramp(15, 11.5, 3.25);
    check_near(renderer(v, s).march_pixel(0, 0).transmittance,
               std::exp(-0.03 * 0.25 * (sum + fade)), 1e-12,
               "ramp: transmittance along x");
}

// The light march alone: min_transmittance 1 stops the view ray after its
// first sample. On a ramp, midpoints sum to the middle's value times n.
void test_uniform_light_ramp()
{
    const volume v = make_volume(16, 24, 8, ramp);
    const scene s = make_scene({{"eye", "3.125 11.5 3.25"},
                                {"target", "4 11.5 3.25"},
                                {"filter", "trilinear"},
                                {"light", "uniform"},
                                {"light_density_scale", "0.1"},
                                {"light_samples", "6"},
                                {"light_step", "1.5"},
                                {"min_transmittance", "1"},
                                {"sun", "90 0"}});
    const march_result m = renderer(v, s).march_pixel(0, 0);
    const double depth = 0.1 * 6 * 1.5 * ramp(3.125 + 4.5, 11.5, 3.25);
    check_near(m.radiance / (1 - m.transmittance), std::exp(-depth), 1e-12,
               "ramp: uniform light samples midpoints");
}

// The march as it is defined, on every lattice point up to a far one.
double unclipped_transmittance(const volume &v, const scene &s, const ray &r,
                               double jitter)
{
    double sum = 0;
    for (int k = 0; k < 400; k++) {
        const double t = (k + jitter) * s.step;
        sum += v.density(r.origin + r.direction * t, s.filter);
    }
    return std::exp(-s.density_scale * s.step * sum);
}

// Rays from around and inside the volume, some along an axis or a face.
void test_clipping()
{
    const volume v = make_volume(16, 24, 8, ramp);
    double worst = 0;
    int seen = 0;
    for (int n = 0; n < 2000; n++) {
        const scene s = make_scene({{"step", n % 2 ? "0.3" : "0.25"},
                                    {"density_scale", "0.01"},
                                    {"filter", n % 3 ? "trilinear" :
                                                       "nearest"}});
        const vec3 origin = {n % 11 * 3.5 - 10, n % 13 * 4.0 - 12,
                             n % 7 * 2.5 - 4};
        const vec3 towards = {n % 5 * 4.0, n % 17 * 1.5, n % 4 * 2.5};
        if (length(towards - origin) == 0)
            continue;
        const ray r = {origin, normalise(towards - origin)};
        const double jitter = n % 6 / 6.0;
        const double want = unclipped_transmittance(v, s, r, jitter);
        const double got = renderer(v, s).march(r, jitter, 0).transmittance;
        worst = std::fmax(worst, std::fabs(got - want));
        seen += want < 1;
    }
    tap_check(seen > 1000, "most of the rays meet the volume (%d)", seen);
    check_near(worst, 0, 1e-12, "clipping to the box loses no sample");
}

void test_lookup_edges()
{
    const volume v = make_volume(8, 8, 8, ramp);
    const auto nearest = [&](double x) {
        return v.density({x, 3, 3}, lookup::nearest);
    };
    tap_check(nearest(2.49) == ramp(2, 3, 3) && nearest(2.5) == ramp(3, 3, 3),
              "nearest: voxel floor(p + 1/2)");
    tap_check(nearest(-0.5) == ramp(0, 3, 3) && nearest(-0.51) == 0 &&
                  nearest(7.49) == ramp(7, 3, 3) && nearest(7.5) == 0,
              "nearest: the pool is 0 - 1/2 to n - 1/2");
    const auto trilinear = [&](double z) {
        return v.density({3, 3, z}, lookup::trilinear);
    };
    tap_check(trilinear(-0.25) == 0.75 * ramp(3, 3, 0) &&
                  trilinear(-1) == 0 && trilinear(7.5) ==
                      0.5 * ramp(3, 3, 7) && trilinear(8) == 0,
              "trilinear: fades to 0 within one voxel of the pool");
    tap_check(v.density({1e300, -1e300, 0}, lookup::trilinear) == 0,
              "density far outside is 0");
}

void test_empty_and_inside()
{
    const volume empty = make_volume(8, 8, 8, [](int, int, int) { return 0; });
    const scene sky = make_scene({{"background", "0.3"}});
    tap_check(render(empty, sky).values[0] == 0.3,
              "an empty volume shows the background");
    // From the middle of the slab, t = 0 counts: samples at 31.5 .. 46.5.
    const scene s = make_scene({{"eye", "31.5 64 4"},
                                {"target", "0 64 4"},
                                {"density_scale", "0.1"}});
    const volume slab = make_slab();
    check_near(renderer(slab, s).march_pixel(0, 0).transmittance,
               std::exp(-0.05 * 17), 1e-12, "camera inside: starts at t = 0");
    const ray away = {{-1.5, 64, 4}, {-1, 0, 0}};
    tap_check(renderer(slab, s).march(away, 0, 0).transmittance == 1,
              "nothing behind the eye is seen");
}

/// Camera ///

// The pixel that sees most of a picture's radiance.
std::pair<int, int> brightest(const picture &image)
{
    size_t best = 0;
    for (size_t i = 0; i < image.values.size(); i++)
        if (image.values[i] > image.values[best])
            best = i;
    const size_t width = static_cast<size_t>(image.width);
    return {static_cast<int>(best % width), static_cast<int>(best / width)};
}

// One voxel at a corner of a cube of voxels -12 .. 12. By similar triangles
// it is `right` and `above` the centre of the picture by offset / distance
// times the focal length, (height / 2) / tan(fov / 2) pixels.
void test_projection(const char *what, const char *eye, const char *up,
                     const vec3 &voxel, double right, double above)
{
    float_dump dump = make_dump(25, 25, 25, [&](int i, int j, int k) {
        return i - 12 == voxel.x && j - 12 == voxel.y && k - 12 == voxel.z;
    });
    dump.origin = {-12, -12, -12};
    const scene s = make_scene({{"size", "160x90"},
                                {"eye", eye},
                                {"target", "0 0 0"},
                                {"up", up},
                                {"fov", "30"},
                                {"step", "0.125"},
                                {"filter", "trilinear"}});
    const auto [x, y] = brightest(render(volume(std::move(dump), 1), s));
    const double focal = 45 / std::tan(15 * pi / 180);
    const double want_x = 80 + right * focal, want_y = 45 - above * focal;
    tap_check(std::fabs(x + 0.5 - want_x) < 0.75 &&
                  std::fabs(y + 0.5 - want_y) < 0.75,
              "%s: pixel %d,%d sees it, want %.2f,%.2f", what, x, y,
              want_x - 0.5, want_y - 0.5);
}

void test_camera()
{
    test_projection("from +z, +x is right, +y is up", "0 0 80", "0 1 0",
                    {10, 4, 8}, 10.0 / 72, 4.0 / 72);
    test_projection("from +z, -y is down", "0 0 80", "0 1 0", {10, -8, 0},
                    10.0 / 80, -8.0 / 80);
    test_projection("from +x, -z is right", "80 0 0", "0 1 0", {0, 5, -11},
                    11.0 / 80, 5.0 / 80);
    test_projection("from -y with z up, +x is right", "0 -80 0", "0 0 1",
                    {9, 0, 7}, 9.0 / 80, 7.0 / 80);
    test_projection("up need not be square to the view", "0 0 80", "0 3 50",
                    {-10, 6, 0}, -10.0 / 80, 6.0 / 80);
}

// Front-lit, the side that the sun is on is the bright one.
void test_lit_side()
{
    const volume sphere = make_sphere(64);
    const scene s = make_scene({{"size", "40x40"},
                                {"eye", "31.5 31.5 160"},
                                {"target", "31.5 31.5 31.5"},
                                {"density_scale", "0.2"},
                                {"light_density_scale", "0.2"},
                                {"light", "uniform"},
                                {"light_samples", "64"},
                                {"sun", "70 40"}});
    const picture image = render(sphere, s);
    double left = 0, right = 0, top = 0, bottom = 0;
    for (size_t i = 0; i < image.values.size(); i++) {
        (i % 40 < 20 ? left : right) += image.values[i];
        (i / 40 < 20 ? top : bottom) += image.values[i];
    }
    tap_check(right > 1.2 * left && top > 1.2 * bottom,
              "seen from +z, a sun at +x +y lights the right and the top");
}

/// World transform ///

struct similarity {
    vec3 row[3]; // a rotation
    double scale;
    vec3 move;
};

vec3 rotate(const similarity &m, const vec3 &v)
{
    return {dot(m.row[0], v), dot(m.row[1], v), dot(m.row[2], v)};
}

// 0.03 units a voxel, turned by 111 degrees about no axis in particular.
similarity make_similarity()
{
    const vec3 x = normalise({2, 3, -6}), y = normalise({6, 2, 3});
    return {{x, y, cross(x, y)}, 0.03, {5, -7, 11}};
}

std::array<double, 12> matrix(const similarity &m)
{
    std::array<double, 12> out{};
    const double move[3] = {m.move.x, m.move.y, m.move.z};
    for (size_t i = 0; i < 3; i++) {
        out[4 * i] = m.scale * m.row[i].x;
        out[4 * i + 1] = m.scale * m.row[i].y;
        out[4 * i + 2] = m.scale * m.row[i].z;
        out[4 * i + 3] = move[i];
    }
    return out;
}

settings world_view(const vec3 &eye, const vec3 &target, const vec3 &up,
                    const vec3 &sun)
{
    return {{"size", "48x32"},
            {"eye", triple(eye)},
            {"target", triple(target)},
            {"up", triple(up)},
            {"sun", number(std::atan2(sun.x, sun.z) * 180 / pi) + " " +
                        number(std::asin(sun.y) * 180 / pi)},
            {"density_scale", "0.1"},
            {"light", "uniform"},
            {"light_samples", "32"},
            {"light_density_scale", "0.1"},
            {"jitter", "primary"},
            {"noise", "ign"},
            {"filter", "trilinear"}};
}

// The same volume and view, once in voxels and once moved through the world.
void test_world_transform()
{
    const auto density = [](int i, int j, int k) {
        return (i * 7 + j * 11 + k * 13) % 17 / 17.0;
    };
    const similarity m = make_similarity();
    const vec3 eye = {60, 40, 70}, target = {14, 11, 9}, up = {0.1, 1, 0.2};
    const vec3 sun = normalise({0.3, 0.5, -0.8});
    const vec3 origin = {-20, 30, 4};
    const auto move = [&](const vec3 &pool) {
        return rotate(m, pool + origin) * m.scale + m.move;
    };
    float_dump moved = make_dump(32, 24, 16, density);
    moved.origin = {-20, 30, 4};
    moved.world_from_index = matrix(m);
    const picture a = render(make_volume(32, 24, 16, density),
                             make_scene(world_view(eye, target, up, sun)));
    const picture b =
        render(volume(std::move(moved), 1),
               make_scene(world_view(move(eye), move(target), rotate(m, up),
                                     rotate(m, sun))));
    double worst = 0, sum = 0;
    for (size_t i = 0; i < a.values.size(); i++) {
        worst = std::fmax(worst, std::fabs(a.values[i] - b.values[i]));
        sum += a.values[i];
    }
    tap_check(sum > 50, "the volume is in view (%.1f)", sum);
    check_near(worst, 0, 1e-9, "scale, rotation, translation: same picture");
}

void test_transform_refused()
{
    float_dump sheared = make_dump(8, 8, 8, ramp);
    sheared.world_from_index[1] = 0.25;
    tap_check(throws([&] { volume(sheared, 1); }, "uniform scale"),
              "a shear is refused");
    float_dump flat = make_dump(8, 8, 8, ramp);
    flat.world_from_index = {};
    tap_check(throws([&] { volume(flat, 1); }, "uniform scale"),
              "a singular transform is refused");
}

/// Noise ///

uint32_t bayer(uint32_t x, uint32_t y, channel c)
{
    return noise_value(noise::bayer8, x, y, 7, c);
}

void test_bayer()
{
    // 1024·v + 512 with v = 0, 32, 48, 16, 8, 2 by the bits of x and y.
    tap_check(bayer(0, 0, primary_channel) == 512 &&
                  bayer(1, 0, primary_channel) == 33280 &&
                  bayer(0, 1, primary_channel) == 49664 &&
                  bayer(1, 1, primary_channel) == 16896 &&
                  bayer(2, 0, primary_channel) == 8704 &&
                  bayer(4, 0, primary_channel) == 2560,
              "bayer8: hand-computed values");
    // (6,4): bits 1 of x and y differ (8), bit 2 of y is set (1); v = 9.
    tap_check(bayer(0, 0, light_channel) == 9728,
              "bayer8: the light channel is moved by (6,4)");
    std::vector<int> seen(64, 0);
    for (uint32_t n = 0; n < 64; n++)
        seen[bayer(n % 8 + 80, n / 8 + 16, primary_channel) >> 10]++;
    bool once = true;
    for (int count : seen)
        once = once && count == 1;
    tap_check(once, "bayer8: each of 64 levels once in a tile");
}

double frac(double x)
{
    return x - std::floor(x);
}

// Against Jimenez's formula, frame f being a shift by 5.588238·f pixels; the
// frame's step is applied modulo 64. Distances are on the unit circle.
void test_ign()
{
    double worst = 0;
    for (uint32_t n = 0; n < 4000; n++) {
        const uint32_t x = n * 37 % 1920, y = n * 101 % 1080, f = n % 64;
        const uint32_t c = n & 1;
        const double shift = 5.588238 * f;
        const double want = frac(
            52.9829189 * frac(0.06711056 * (x + 96 * c + shift) +
                              0.00583715 * (y + 72 * c + shift)));
        const double got =
            noise_value(noise::ign, x, y, f, static_cast<channel>(c)) /
            65536.0;
        const double d = std::fabs(got - want);
        worst = std::fmax(worst, std::fmin(d, 1 - d));
    }
    // 2^-16 of truncation, and 53·1920·2^-33 of rounded constants.
    check_near(worst, 0, 3e-5, "ign: the published formula");
    // u = 288237660: 52·u = 2103456432 mod 2^32, and the fraction adds
    // floor(0.9829189·u) = 283314243; the sum's high half is 36419.
    tap_check(noise_value(noise::ign, 0, 0, 0, primary_channel) == 0 &&
                  noise_value(noise::ign, 1, 0, 0, primary_channel) == 36419,
              "ign: hand-computed values");
    tap_check(noise_value(noise::ign, 9, 5, 67, primary_channel) ==
                  noise_value(noise::ign, 9, 5, 3, primary_channel),
              "ign: frames repeat after 64");
}

void test_white()
{
    // Worked out from the definition with integers of unlimited size.
    const struct {
        uint32_t x, y, frame;
        channel c;
        uint32_t want;
    } cases[] = {{0, 0, 0, primary_channel, 37967},
                 {0, 0, 0, light_channel, 54881},
                 {1, 0, 0, primary_channel, 7886},
                 {0, 1, 0, primary_channel, 50812},
                 {0, 0, 1, primary_channel, 8859},
                 {1919, 1079, 4294967295U, light_channel, 9215}};
    for (const auto &w : cases)
        tap_check(noise_value(noise::white, w.x, w.y, w.frame, w.c) == w.want,
                  "white: pixel %u,%u frame %u channel %d is %u", w.x, w.y,
                  w.frame, static_cast<int>(w.c), w.want);
    double sum = 0;
    for (uint32_t n = 0; n < 65536; n++)
        sum += noise_value(noise::white, n % 256, n / 256, 3, light_channel);
    // The mean of 2^16 uniform values has a deviation of 65536/sqrt(12)/256.
    check_near(sum / 65536, 32767.5, 4 * 74, "white: mean");
}

// The jitter moves the lattice by J/65536 of a step, and only where asked.
void test_jitter()
{
    const volume v = make_volume(32, 8, 8, ramp);
    const auto result = [&](const char *jitter, const char *kind) {
        const scene s = make_scene({{"size", "5x4"},
                                    {"eye", "-9.25 3 4"},
                                    {"target", "0 3 4"},
                                    {"density_scale", "0.02"},
                                    {"light_density_scale", "0.05"},
                                    {"light", "log"},
                                    {"light_samples", "4"},
                                    {"sun", "90 10"},
                                    {"filter", "trilinear"},
                                    {"frame", "3"},
                                    {"jitter", jitter},
                                    {"noise", kind}});
        const renderer r(v, s);
        const double j = noise_value(noise::ign, 2, 1, 3, primary_channel);
        const double l = noise_value(noise::ign, 2, 1, 3, light_channel);
        const ray pixel = r.camera_ray(2, 1);
        const double got = r.march_pixel(2, 1).radiance;
        return std::vector<double>{got, r.march(pixel, 0, 0).radiance,
                                   r.march(pixel, j / 65536, 0).radiance,
                                   r.march(pixel, 0, l / 65536).radiance,
                                   r.march(pixel, j / 65536, l / 65536)
                                       .radiance};
    };
    const char *names[] = {"none", "primary", "light", "both"};
    for (size_t i = 0; i < 4; i++) {
        const std::vector<double> m = result(names[i], "ign");
        bool only = true;
        for (size_t k = 0; k < 4; k++)
            only = only && (m[0] == m[k + 1]) == (k == i);
        tap_check(only, "jitter = %s", names[i]);
    }
    const std::vector<double> still = result("both", "none");
    tap_check(still[0] == still[1], "noise = none: J is 0");
}

/// Pictures and files ///

void test_rendering_order()
{
    const volume sphere = make_sphere(64);
    const scene s = make_scene({{"size", "33x21"},
                                {"eye", "100 60 90"},
                                {"target", "31.5 31.5 31.5"},
                                {"density_scale", "0.05"},
                                {"jitter", "primary"},
                                {"noise", "white"}});
    const renderer r(sphere, s);
    const picture whole = r.render({0, 0, 33, 21}, 1);
    tap_check(whole.values == r.render({0, 0, 33, 21}, 5).values,
              "the number of threads does not show");
    const picture part = r.render({7, 4, 19, 11}, 2);
    bool equal = part.width == 12 && part.height == 7;
    for (size_t y = 0; equal && y < 7; y++)
        for (size_t x = 0; x < 12; x++)
            equal = equal && part.values[12 * y + x] ==
                                 whole.values[33 * (y + 4) + x + 7];
    tap_check(equal, "a part is cut from the whole picture");
}

std::string refusal(const std::string &key, const std::string &value)
{
    try {
        make_scene({{key, value}});
    } catch (const std::runtime_error &e) {
        return e.what();
    }
    return "";
}

void test_scene_errors()
{
    const char *bad[][2] = {
        {"size", "10"},      {"size", "0x4"},       {"size", "4x5x6"},
        {"eye", "1 2"},      {"eye", "1,2,x"},      {"fov", "180"},
        {"step", "0"},       {"step", "nan"},       {"sun", "1 2 3"},
        {"filter", "cubic"}, {"light_samples", "2.5"}, {"albedo", "1.5"},
        {"frame", "-1"},     {"background", "1,2"}, {"max_density", "0"},
        {"up", "1 0 0"},     {"target", "0 0 0"},   {"step", ""}};
    for (const auto &pair : bad)
        tap_check(!refusal(pair[0], pair[1]).empty(), "refused: %s = %s",
                  pair[0], pair[1]);
    tap_check(refusal("fog", "1") == "unknown key 'fog'",
              "an unknown key is named");
    tap_check(throws([] { scene_builder().finish(); }, "lacks 'size'"),
              "a required key that is missing is named");
}

void write_text(const std::string &path, const std::string &text)
{
    std::ofstream(path, std::ios::binary) << text;
}

std::string read_text(const std::string &path)
{
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in),
            std::istreambuf_iterator<char>()};
}

void test_scene_file(const std::string &path)
{
    write_text(path, "# a comment\n\n eye = 1, 2 ,3 # here too\r\n"
                     "size=8x6\ntarget = 0\t0 0\nfov= 20\nstep = 2\n"
                     "density_scale = 1e-1\nlight = none\nskip = off\n");
    scene_builder builder;
    builder.read_file(path);
    const scene s = builder.finish();
    tap_check(s.width == 8 && s.height == 6 && s.eye.y == 2 &&
                  s.eye.z == 3 && s.density_scale == 0.1 && s.step == 2 &&
                  s.min_transmittance == 0.01 && s.up.y == 1,
              "a scene file is read, defaults fill the rest");
    write_text(path, "size = 8x6\n\nstep = fast\n");
    tap_check(throws([&] { scene_builder().read_file(path); },
                     path + ":3: step"),
              "a bad value is refused with file and line");
}

void test_dump_file(const std::string &path)
{
    float_dump dump = make_dump(8, 16, 24, ramp);
    dump.origin = {-5, 6, 7};
    dump.world_from_index = matrix(make_similarity());
    write_float_dump(path, dump);
    const float_dump back = read_float_dump(path);
    tap_check(back.size == dump.size && back.origin == dump.origin &&
                  back.world_from_index == dump.world_from_index &&
                  back.voxels == dump.voxels,
              "a float dump comes back as it was");
    const std::string bytes = read_text(path);
    write_text(path, bytes.substr(0, bytes.size() - 1));
    tap_check(throws([&] { read_float_dump(path); }, "bytes of voxels"),
              "a truncated dump is refused");
    // 0x7fc00000, little-endian: a NaN as the last voxel.
    write_text(path, bytes.substr(0, bytes.size() - 4) +
                         std::string("\0\0\xc0\x7f", 4));
    tap_check(throws([&] { read_float_dump(path); }, "not finite"),
              "a NaN in a dump is refused");
}

void test_pfm(const std::string &path)
{
    write_pfm(path, {2, 2, 1, {1, 0.5, 0, 2}});
    // Bottom row first: 0, 2, then 1, 0.5.
    const std::string want = std::string("Pf\n2 2\n-1.0\n") +
                             std::string("\0\0\0\0\0\0\0\x40", 8) +
                             std::string("\0\0\x80\x3f\0\0\0\x3f", 8);
    tap_check(read_text(path) == want, "pfm: bytes of a 2x2 picture");
}

void test_files()
{
    const std::string path = "test_reference.tmp";
    test_scene_file(path);
    test_dump_file(path);
    test_pfm(path);
    std::remove(path.c_str());
}

} // namespace

int main()
{
    test_slab_transmittance();
    test_pixel_value();
    test_thresholds();
    test_uniform_light_series();
    test_uniform_light_limit();
    test_log_light();
    test_light_ignores_min_density();
    test_sun_direction();
    test_sphere();
    test_trilinear_ramp();
    test_uniform_light_ramp();
    test_clipping();
    test_lookup_edges();
    test_empty_and_inside();
    test_camera();
    test_lit_side();
    test_world_transform();
    test_transform_refused();
    test_bayer();
    test_ign();
    test_white();
    test_jitter();
    test_rendering_order();
    test_scene_errors();
    test_files();
    return tap_done();
}
