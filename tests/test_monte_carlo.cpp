// SPDX-License-Identifier: MIT
//
// The Monte Carlo reference against closed forms. Seeds are fixed; a bound is
// four standard errors of what is measured.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "reference/made.hpp"
#include "reference/measure.hpp"
#include "reference/medium.hpp"
#include "reference/monte_carlo.hpp"
#include "reference/phase_sampling.hpp"
#include "tap.h"

using namespace reference;

namespace
{

const double pi = 3.14159265358979323846;
const vec3 along_x = {1, 0, 0}, along_z = {0, 0, 1};

phase_model phase_of(const char *text)
{
    return make_scene({{"phase", text}}).lit.phase;
}

estimate radiance(const medium &m, const path_settings &s, const vec3 &sun,
                  const ray &r, int paths, uint64_t seed)
{
    const path_tracer tracer(m, s, sun);
    std::vector<double> light(1);
    return measure(paths, seed, [&](random_source &random) {
        light[0] = 0;
        tracer.trace(r, random, light);
        return light[0];
    });
}

/// Phase functions ///

const char *const phases[] = {"isotropic",   "hg:0.85",      "hg:-0.6",
                              "schlick:0.7", "schlick:0.99", "draine:8,0.5",
                              "droplet:10"};

// The mean cosine by the middles of many intervals, each of 1 - x a share of
// the last: the peak ahead is resolved.
double mean_cosine(const phase_model &p)
{
    double sum = 0, high = 2;
    for (int i = 0; i < 40000; i++) {
        const double low = i < 39999 ? high * 0.999 : 0;
        const double x = 1 - (low + high) / 2;
        sum += x * phase_value(p, x) / 2 * (high - low);
        high = low;
    }
    return sum;
}

// Samples against the values: the mean cosine, and the mean of 1 / (4 pi p),
// which is the share of the sphere it is taken over.
void test_phases()
{
    for (const char *text : phases) {
        const phase_model p = phase_of(text);
        const std::string name = text;
        check_mean(measure(100000, 1,
                           [&](random_source &random) {
                               return sample_cosine(p, random);
                           }),
                   mean_cosine(p), name + ": mean cosine", 1e-5);
        check_mean(measure(100000, 2,
                           [&](random_source &random) {
                               const double x = sample_cosine(p, random);
                               return x > 0 ? 0.0 : 1 / phase_value(p, x);
                           }),
                   0.5, name + ": half of the sphere is behind");
    }
    check_near(mean_cosine(phase_of("hg:0.85")), 0.85, 1e-6,
               "hg:0.85: mean cosine");
    const vec3 way = normalise({0.3, -0.5, 0.8});
    const phase_model hg = phase_of("hg:0.7");
    check_mean(measure(100000, 3,
                       [&](random_source &random) {
                           return dot(way, sample_way(hg, way, random));
                       }),
               0.7, "hg:0.7: mean cosine about a slanted way");
    check_mean(measure(100000, 3,
                       [&](random_source &random) {
                           return dot(way, sample_sphere(random));
                       }),
               0, "the sphere has no mean direction");
}

/// Transmittance ///

void test_optical_depth()
{
    const field slab(40, 9, 9, lookup::nearest, [](int i, int, int) {
        return i >= 8 && i < 28 ? 0.25 : 0.0;
    });
    const double d = slab.inside.depth({{-5, 4, 4}, along_x});
    tap_check(std::fabs(d - 5) < 1e-12, "slab: optical depth %.15g is 5", d);
    // Density i along x: the integral over 0 .. 19 is 19^2 / 2, and that of
    // the last half of the way down to nothing is 19 / 2.
    const field ramp(20, 9, 9, lookup::trilinear,
                     [](int i, int, int) { return double(i); });
    const double e = ramp.inside.depth({{-5, 4, 4}, along_x});
    tap_check(std::fabs(e - 190) < 1e-10, "ramp: optical depth %.15g is 190",
              e);
    for (lookup filter : {lookup::nearest, lookup::trilinear}) {
        const lump cloud(filter);
        const ray r = slanted_ray();
        double sum = 0;
        const int n = 400000;
        for (int i = 0; i < n; i++) {
            const vec3 p = r.origin + r.direction * ((i + 0.5) * 60 / n);
            sum += cloud.voxels.density(p, filter) * 60 / n;
        }
        const double got = cloud.inside.depth(r);
        tap_check(std::fabs(got - sum) < 1e-3 * sum,
                  "lump: optical depth %.6f is its sum %.6f", got, sum);
    }
}

void check_tracking(const medium &m, double scale, double want,
                    const std::function<ray(random_source &)> &pick,
                    const std::string &what, double slack)
{
    check_mean(measure(100000, 4,
                       [&](random_source &random) {
                           const ray r = pick(random);
                           return m.ratio_track(r, scale, random);
                       }),
               want, "ratio tracking, " + what, slack);
    check_mean(measure(100000, 5,
                       [&](random_source &random) {
                           const ray r = pick(random);
                           return std::isinf(m.collide(r, scale, random));
                       }),
               want, "without collision, " + what, slack);
}

void test_tracking()
{
    for (lookup filter : {lookup::nearest, lookup::trilinear}) {
        const lump cloud(filter);
        const std::string name =
            filter == lookup::nearest ? "nearest" : "trilinear";
        for (double scale : {0.02, 0.1, 0.4})
            check_tracking(
                cloud.inside, scale,
                std::exp(-scale * cloud.inside.depth(slanted_ray())),
                [](random_source &) { return slanted_ray(); },
                name + ", scale " + number(scale), 1e-9);
    }
}

// Homogeneous bodies; the mean over a ball's parallel rays is
// 2 (1 - (1 + t) exp(-t)) / t^2 for an optical depth t of its diameter.
void test_bodies()
{
    const field slab(30, 9, 9, lookup::nearest,
                     [](int, int, int) { return 0.5; });
    const ray r = {{0, -0.5, 4}, {0.8, 0.6, 0}};
    check_tracking(
        slab.inside, 0.3, std::exp(-0.3 * 0.5 * 9 / 0.6),
        [&](random_source &) { return r; }, "slab", 1e-9);
    const int radius = 32; // its rim is one voxel wide
    const int side = 2 * radius + 2;
    const field ball(side, side, side, lookup::trilinear,
                     [](int i, int j, int k) {
                         const vec3 p = {double(i - radius), double(j - radius),
                                         double(k - radius)};
                         return std::clamp(radius + 0.5 - length(p), 0.0, 1.0);
                     });
    const auto parallel = [](random_source &random) {
        const double s = radius * std::sqrt(random.uniform());
        const double turn = 2 * pi * random.uniform();
        const vec3 middle = {radius, radius, radius};
        const vec3 off = {0, s * std::cos(turn), s * std::sin(turn)};
        return ray{middle + off - along_x * (2 * radius), along_x};
    };
    for (double t : {0.5, 4.0})
        check_tracking(ball.inside, t / (2 * radius),
                       2 * (1 - (1 + t) * std::exp(-t)) / (t * t), parallel,
                       "ball of depth " + number(t), 1e-3);
}

/// Single scattering ///

void test_single(const char *filter, double elevation)
{
    const scene s = make_scene(lump_view(filter, elevation));
    const lump cloud(s.filter);
    const renderer camera(cloud.voxels, s);
    path_settings settings;
    settings.extinction = settings.light_extinction = s.density_scale;
    settings.order = 1;
    const path_tracer tracer(cloud.inside, settings, camera.sun());
    path_sums sums(s.width, s.height, 2);
    trace_passes(tracer, camera, 6, 4000, 2, sums);

    double got = 0, want = 0, variance = 0, outliers = 0;
    for (int y = 0; y < s.height; y++)
        for (int x = 0; x < s.width; x++) {
            const size_t i = static_cast<size_t>(2 * (y * s.width + x));
            const double light = camera.march_pixel(x, y).radiance;
            const double error = sums.standard_error(i);
            got += sums.mean(i);
            want += light;
            variance += error * error;
            outliers += std::fabs(sums.mean(i) - light) > 4 * error + 2e-3;
        }
    const double n = s.width * s.height;
    check_mean({got / n, std::sqrt(variance) / n}, want / n,
               std::string("single scattering is the march's, ") + filter,
               2e-4);
    tap_check(outliers <= 1, "%s: %g of %g pixels are beyond 4 errors", filter,
              outliers, n);
}

/// Energy ///

// Radiance 1 from everywhere stays 1 in a medium that absorbs nothing: by
// paths alone, whose weights it tests, and by suns, whose phase and shadows.
void test_furnace()
{
    const lump cloud(lookup::trilinear);
    for (const char *name : phases) {
        path_settings s;
        s.extinction = s.light_extinction = 0.15;
        s.phase = phase_of(name);
        const double through =
            std::exp(-s.extinction * cloud.inside.depth(slanted_ray()));
        s.source = light_source::environment;
        const path_tracer tracer(cloud.inside, s, along_z);
        std::vector<double> light(1);
        const estimate e = measure(2000, 7, [&](random_source &random) {
            light[0] = 0;
            return tracer.trace(slanted_ray(), random, light) + light[0];
        });
        tap_check(e.mean == 1 && e.error == 0,
                  "%s: each path leaves with the radiance 1", name);
        s.source = light_source::all_suns;
        check_mean(radiance(cloud.inside, s, along_z, slanted_ray(), 100000, 8),
                   1 - through, std::string(name) + ": white furnace by suns");
    }
}

// What a medium with albedo 1 takes from a beam it gives back: the mean over
// all ways of the radiance that leaves equals, by reciprocity, that of the
// furnace; here with less than all orders it must be less, and grow.
void test_orders_add_up()
{
    const lump cloud(lookup::trilinear);
    path_settings s;
    s.extinction = s.light_extinction = 0.15;
    s.source = light_source::all_suns;
    const double through =
        std::exp(-s.extinction * cloud.inside.depth(slanted_ray()));
    double before = 0;
    for (int order : {1, 2, 4, 8, 32}) {
        s.order = order;
        const estimate e =
            radiance(cloud.inside, s, along_z, slanted_ray(), 20000, 9);
        tap_check(e.mean > before && e.mean <= 1 - through + 4 * e.error,
                  "%d orders give %.4f, more than fewer, of %.4f", order,
                  e.mean, 1 - through);
        before = e.mean;
    }
}

/// The half-space ///

// Chandrasekhar's H function for isotropic scattering, by its integral:
// ln H = -mu / pi * integral over t from 0 of ln(1 - albedo atan(t) / t) /
// (1 + mu^2 t^2); t = tan x.
double h_function(double mu, double albedo)
{
    const int n = 200000;
    double sum = 0;
    for (int i = 0; i < n; i++) {
        const double x = (i + 0.5) * pi / 2 / n, t = std::tan(x);
        const double c = std::cos(x), s = mu * std::sin(x);
        sum += std::log(1 - albedo * x / t) / (c * c + s * s);
    }
    return std::exp(-mu / pi * sum * pi / 2 / n);
}

// A slab of optical thickness 30 in z, wide enough for its middle. The ray
// comes from below at cosine mu, the sun stands below.
struct half_space {
    field slab;
    static constexpr double thickness = 30;
    half_space()
        : slab(64, 64, 4, lookup::nearest,
               [](int, int, int) { return thickness / 4; })
    {
    }
    estimate reflected(double mu, double albedo, int order, int paths) const
    {
        path_settings s;
        s.albedos = {albedo};
        s.order = order;
        // The low face is at z = -1/2.
        const vec3 way = {std::sqrt(1 - mu * mu), 0, mu};
        const ray r = {vec3{31.5, 31.5, -0.5} - way * 0.25, way};
        return radiance(slab.inside, s, {0, 0, -1}, r, paths, 10);
    }
};

void test_half_space()
{
    const half_space half;
    const double h1 = h_function(1, 1);
    tap_check(std::fabs(h1 - 2.9078) < 1e-3, "H(1) is %.4f, tabled 2.9078", h1);
    for (double albedo : {0.5, 0.9, 1.0})
        for (double mu : {1.0, 0.4}) {
            const double a = h_function(mu, albedo);
            const double b = h_function(1, albedo);
            double want = albedo / (mu + 1) * a * b;
            // The slab's far side: van de Hulst's asymptotic formula, escape
            // functions sqrt(3)/4 H, extrapolation length 0.7104.
            if (albedo == 1)
                want -= 4 * 3.0 / 16 * a * b /
                        (0.75 * (half.thickness + 2 * 0.7104));
            char name[80];
            std::snprintf(name, sizeof name, "half-space, albedo %g, cosine %g",
                          albedo, mu);
            check_mean(half.reflected(mu, albedo, 0, 200000), want, name, 5e-4);
        }
    check_mean(half.reflected(1, 1, 1, 400000), 0.5, "its first order");
    estimate two = half.reflected(1, 1, 2, 400000);
    check_mean(two, 0.5 + std::log(2.0) / 2, "its first two orders");
}

/// Repetition ///

bool refuses(const std::string &path, path_sums &sums)
{
    try {
        read_sums(path, "another", sums);
    } catch (const std::runtime_error &) {
        return true;
    }
    return false;
}

bool same(const path_sums &a, const path_sums &b)
{
    return a.passes == b.passes && a.sum == b.sum && a.squares == b.squares;
}

void test_bytes()
{
    const scene s = make_scene(lump_view("trilinear", 40));
    const lump cloud(s.filter);
    const renderer camera(cloud.voxels, s);
    path_settings settings;
    settings.extinction = settings.light_extinction = 0.1;
    settings.phase = phase_of("hg:0.8");
    settings.albedos = {1, 0.5};
    const path_tracer tracer(cloud.inside, settings, camera.sun());
    path_sums one(s.width, s.height, 3), three = one, broken = one, read = one;
    trace_passes(tracer, camera, 1, 12, 1, one);
    trace_passes(tracer, camera, 1, 12, 3, three);
    tap_check(same(one, three), "three threads give the bytes of one");
    trace_passes(tracer, camera, 1, 5, 2, broken);
    const std::string path = "test_monte_carlo.sums";
    write_sums(path, "key", broken);
    tap_check(read_sums(path, "key", read) && same(read, broken),
              "sums come back from disk");
    path_sums other(s.width, s.height, 3);
    tap_check(!read_sums(path + ".none", "key", other) &&
                  refuses(path, other) && other.passes == 0,
              "sums of another picture are refused");
    std::remove(path.c_str());
    trace_passes(tracer, camera, 1, 12, 1, read);
    tap_check(same(one, read), "a break after five passes does not show");
}

} // namespace

int main()
{
    test_phases();
    test_optical_depth();
    test_tracking();
    test_bodies();
    test_single("nearest", 10);
    test_single("trilinear", 70);
    test_furnace();
    test_orders_add_up();
    test_half_space();
    test_bytes();
    return tap_done();
}
