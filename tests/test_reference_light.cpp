// SPDX-License-Identifier: MIT
//
// What docs/light.md adds to the reference renderer, against closed forms.

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "reference/made.hpp"
#include "reference/mips.hpp"
#include "reference/sky.hpp"
#include "tap.h"

using namespace reference;

namespace
{

const double pi = 3.14159265358979323846;

double largest(const vec3 &v)
{
    return std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z)));
}

void check_colour(const vec3 &got, const vec3 &want, double bound,
                  const char *what)
{
    tap_check(largest(got - want) <= bound,
              "%s: %.9g %.9g %.9g is %.9g %.9g %.9g within %.1g", what, got.x,
              got.y, got.z, want.x, want.y, want.z, bound);
}

/// Sun ///

// A homogeneous slab with the sun behind the camera: for each octave a
// geometric series; the phase function is seen at cos = -1.
void test_octaves(int octaves, double a, double b, double c)
{
    const double sigma = 0.05, sigma_light = 0.08, g = 0.6;
    double want = 0;
    for (int i = 0; i < octaves; i++) {
        const double q = std::exp(-(sigma + std::pow(a, i) * sigma_light));
        const double sum =
            (1 - std::exp(-sigma)) * (1 - std::pow(q, slab_length)) / (1 - q);
        const double gi = g * std::pow(c, i);
        want += std::pow(b, i) * sum * (1 - gi) / ((1 + gi) * (1 + gi));
    }
    const scene s =
        make_scene(with(slab_view(), {{"light", "uniform"},
                                      {"light_density_scale", "0.16"},
                                      {"light_samples", "64"},
                                      {"sun", "-90 0"},
                                      {"phase", "hg:0.6"},
                                      {"octaves", std::to_string(octaves)},
                                      {"octave_a", number(a)},
                                      {"octave_b", number(b)},
                                      {"octave_c", number(c)}}));
    check_near(renderer(make_slab(), s).march_pixel(0, 0).radiance, want, 1e-12,
               "slab, " + std::to_string(octaves) + " octaves");
}

// L of a ray straight into the slab along +x.
march_result slab_pixel(const settings &changes)
{
    const volume slab = make_slab();
    return renderer(slab, make_scene(with(slab_view(), changes)))
        .march_pixel(0, 0);
}

const double slab_lost = 1 - std::exp(-0.1 * 0.5 * slab_length);

void test_phase_angle()
{
    // The sun ahead, so that the light goes straight on; then 60 degrees off.
    check_near(slab_pixel({{"sun", "90 0"}, {"phase", "hg:0.5"}}).radiance,
               slab_lost * 6, 1e-12, "looking at the sun: cos = 1");
    check_near(slab_pixel({{"sun", "150 0"}, {"phase", "hg:0.5"}}).radiance,
               slab_lost * 0.75 / std::pow(0.75, 1.5), 1e-12,
               "60 degrees off: cos = 1/2");
    check_near(slab_pixel({{"sun", "90 0"}, {"phase", "mix:0.25,0,0.5,-0.5"}})
                   .radiance,
               slab_lost * (0.25 * 6 + 0.75 * 0.5 / 2.25), 1e-12,
               "a mix of a forward and a backward lobe");
}

void test_colours()
{
    const march_result m = slab_pixel(
        {{"sun_colour", "1,0.5,0.25"}, {"exposure", "2"}, {"albedo", "0.5"}});
    check_colour(m.colour, vec3{1, 0.5, 0.25} * slab_lost, 1e-12,
                 "exposure, albedo and the sun's colour");
    check_colour(
        slab_pixel({{"sun_colour", "16,4,16"}, {"exposure", "4"}}).colour,
        {8, 8, 8}, 0, "at most 8");
    check_colour(slab_pixel({{"sun_colour", "0,0,0"}}).colour, {0, 0, 0}, 0,
                 "a black sun");
    check_near(slab_pixel({{"sun_colour", "0,0,0"}}).transmittance,
               1 - slab_lost, 1e-12, "a black sun: transmittance");
    const volume slab = make_slab();
    const auto channels = [&](const settings &changes) {
        return render(slab, make_scene(with(slab_view(), changes))).channels;
    };
    tap_check(channels({{"sun_colour", "2,2,2"}}) == 1 &&
                  channels({{"sun_colour", "2,2,1"}}) == 3 &&
                  channels({{"ambient", "constant"},
                            {"ambient_colour", "0,0,1"}}) == 3 &&
                  channels({{"ambient_colour", "0,0,1"}}) == 1 &&
                  channels({{"sky", "on"}}) == 3,
              "three channels when what is in use has colour");
}

// One sample at depth x in the slab: S = L / (1 - T), as the march stops.
double slab_sun(double depth, const settings &changes)
{
    const volume slab = make_slab();
    const scene s = make_scene(
        with(slab_view(),
             with({{"min_transmittance", "1"}, {"sun", "-90 0"}}, changes)));
    const ray r = {{15.5 + depth, 64, 4}, {1, 0, 0}};
    const march_result m = renderer(slab, s).march(r, 0, 0);
    return m.radiance / (1 - m.transmittance);
}

void test_cache_and_cone()
{
    // 20 midpoints of half voxels reach 10 voxels.
    check_near(slab_sun(10, {{"light", "cache"}, {"light_density_scale", "1"}}),
               std::exp(-5.0), 1e-12, "cache: the exact optical depth");
    const volume even =
        make_volume(512, 64, 64, [](int, int, int) { return 0.5; });
    const scene s = make_scene({{"eye", "448 32 32"},
                                {"target", "512 32 32"},
                                {"light", "cone"},
                                {"light_samples", "8"},
                                {"light_step", "2"},
                                {"light_density_scale", "0.01"},
                                {"min_transmittance", "1"},
                                {"sun", "-90 0"}});
    const march_result m = renderer(even, s).march_pixel(0, 0);
    check_near(m.radiance / (1 - m.transmittance),
               std::exp(-0.01 * 2 * 0.5 * (1 + 47 + 32)), 1e-12,
               "cone in a homogeneous medium: what eight segments add up to");
}

// Means of a linear function are its values at the cubes' middles.
void test_mips()
{
    const auto ramp = [](double x, double y, double z) {
        return 0.5 + x / 8 + y / 16 + z / 64;
    };
    const volume v = make_volume(16, 24, 8, ramp);
    const mips m(v, 3);
    double worst = 0;
    for (int level = 1; level <= 3; level++)
        for (int n = 0; n < 300; n++) {
            const double side = 1 << level;
            const vec3 p = {std::fmod(n * 0.7548776662, 16) - 0.5,
                            std::fmod(n * 0.5698402910, 24) - 0.5,
                            std::fmod(n * 0.3819660113, 8) - 0.5};
            const auto middle = [&](double x) {
                return std::floor((x + 0.5) / side) * side + (side - 1) / 2;
            };
            const double want = ramp(middle(p.x), middle(p.y), middle(p.z));
            worst = std::fmax(worst, std::fabs(m.mean(level, p) - want));
        }
    check_near(worst, 0, 1e-14, "mips: means of a ramp");
    tap_check(m.mean(2, {-0.51, 3, 3}) == 0 && m.mean(2, {3, 23.5, 3}) == 0,
              "mips: 0 outside the pool");
}

// Directions that share the sphere out evenly, as azimuth and elevation.
std::vector<std::string> suns(int n)
{
    std::vector<std::string> out;
    for (int i = 0; i < n; i++) {
        const double elevation = std::asin(1 - (2 * i + 1.0) / n);
        out.push_back(number(std::fmod(i * 137.50776405003785, 360)) + " " +
                      number(elevation * 180 / pi));
    }
    return out;
}

// Light from everywhere, scattered once without loss: what a ray brings is at
// most what it would see without the cloud, and just that without shadows.
void test_white_furnace(const char *phase, const char *scale, bool shadowed)
{
    const volume ball = make_volume(24, 24, 24, [](int i, int j, int k) {
        const vec3 d = {i - 11.5, j - 11.5, k - 11.5};
        return std::fmin(1, std::fmax(0, 10 - length(d)));
    });
    const int n = 2000;
    double sum = 0;
    for (const std::string &sun : suns(n)) {
        const scene s = make_scene({{"eye", "30 20 -9"},
                                    {"target", "11 12 11"},
                                    {"density_scale", "0.2"},
                                    {"light_density_scale", scale},
                                    {"light", "uniform"},
                                    {"light_samples", "24"},
                                    {"phase", phase},
                                    {"sun", sun}});
        const march_result m = renderer(ball, s).march_pixel(0, 0);
        sum += (m.radiance + m.transmittance) / n;
    }
    if (shadowed)
        tap_check(sum < 0.999, "white furnace, %s: %.6f is less than 1", phase,
                  sum);
    else
        check_near(sum, 1, 1e-4,
                   std::string("white furnace without shadows, ") + phase);
}

/// Ambient ///

void test_open_sky()
{
    const march_result m = slab_pixel({{"sun_colour", "0,0,0"},
                                       {"ambient", "constant"},
                                       {"ambient_colour", "1,1,1"}});
    check_near(m.radiance + m.transmittance, 1, 1e-12,
               "constant light from everywhere: L + T = 1");
    check_colour(slab_pixel({{"sun_colour", "0,0,0"},
                             {"albedo", "0.5"},
                             {"exposure", "2"},
                             {"ambient", "cube"},
                             {"ambient_px", "6,0,0"},
                             {"ambient_nx", "0,3,0"},
                             {"ambient_py", "0,0,1"},
                             {"ambient_ny", "0,3,0"},
                             {"ambient_pz", "0,0,4"},
                             {"ambient_nz", "0,0,1"}})
                     .colour,
                 vec3{1, 1, 1} * slab_lost, 1e-12,
                 "a cube without a direction: the mean of its sides");
    check_colour(slab_pixel({{"sun_colour", "0.5,0,0"},
                             {"ambient", "constant"},
                             {"ambient_colour", "0.25,0.5,1"}})
                     .colour,
                 vec3{0.75, 0.5, 1} * slab_lost, 1e-12, "sun and sky add up");
}

// The box of the non-zero voxels is 1/2 .. 65/2 high; a level ray keeps its
// height, from the world's +Y.
void test_gradient()
{
    const volume wall = make_volume(24, 48, 24, [](int i, int j, int) {
        return i >= 8 && i < 16 && j >= 1 && j < 33 ? 1.0 : 0.0;
    });
    for (double y : {0.75, 8.5, 32.25}) {
        const std::string at = number(y) + " 12";
        const scene s = make_scene({{"eye", "0 " + at},
                                    {"target", "1 " + at},
                                    {"sun_colour", "0,0,0"},
                                    {"ambient", "gradient"},
                                    {"ambient_top", "0.5,0,1"},
                                    {"ambient_bottom", "0,1,1"}});
        const march_result m = renderer(wall, s).march_pixel(0, 0);
        const double h = (y - 0.5) / 32, lost = 1 - std::exp(-8.0);
        check_colour(m.colour, vec3{0.5 * h, 1 - h, 1} * lost, 1e-12,
                     "gradient by height");
    }
}

// From the middle of a ball the same way is to go in every direction.
void test_visibility()
{
    const volume ball = make_volume(64, 64, 64, [](int i, int j, int k) {
        const vec3 d = {i - 31.5, j - 31.5, k - 31.5};
        return std::fmin(1, std::fmax(0, 24.5 - length(d)));
    });
    const auto seen = [&](const settings &changes) {
        const scene s = make_scene(with({{"eye", "31.5 31.5 31.5"},
                                         {"target", "40 31.5 31.5"},
                                         {"filter", "trilinear"},
                                         {"light_density_scale", "0.05"},
                                         {"min_transmittance", "1"},
                                         {"sun_colour", "0,0,0"},
                                         {"visibility_samples", "5"}},
                                        changes));
        const march_result m = renderer(ball, s).march_pixel(0, 0);
        return m.colour * (1 / (1 - m.transmittance));
    };
    // 1, 2, 4, 8 and 16 lie within.
    const double want = std::exp(-0.05 * 31);
    check_colour(seen({{"ambient", "constant"}, {"visibility", "sampled"}}),
                 vec3{1, 1, 1} * want, 1e-12, "visibility sampled: a ball");
    check_colour(seen({{"ambient", "constant"},
                       {"visibility", "sampled"},
                       {"visibility_step", "4"}}),
                 vec3{1, 1, 1} * std::exp(-0.05 * 4 * 7), 1e-12,
                 "visibility sampled: steps of 4, of which 3 meet it");
    check_colour(seen({{"ambient", "constant"}, {"visibility", "baked"}}),
                 vec3{1, 1, 1} * std::exp(-0.05 * 24), 1e-3,
                 "visibility baked: the exact mean");
    check_colour(seen({{"ambient", "cube"},
                       {"visibility", "sampled"},
                       {"ambient_px", "6,0,0"},
                       {"ambient_ny", "0,6,0"},
                       {"ambient_nz", "0,0,6"}}),
                 vec3{1, 1, 1} * want, 2e-3,
                 "each side of the cube has a sixth of the sphere");
}

// Below a wide roof only the lower half of the sky is seen.
void test_roof()
{
    const volume v = make_volume(128, 64, 128, [](int i, int j, int k) {
        return j > 40 || (i == 64 && j == 32 && k == 64) ? 1.0 : 0.0;
    });
    const scene s = make_scene({{"eye", "64 32 64"},
                                {"target", "64 31 64.5"},
                                {"light_density_scale", "1000"},
                                {"min_transmittance", "1"},
                                {"sun_colour", "0,0,0"},
                                {"ambient", "cube"},
                                {"ambient_px", "0,0,1"},
                                {"ambient_py", "1,0,0"},
                                {"ambient_ny", "0,1,0"},
                                {"visibility", "sampled"},
                                {"visibility_step", "12"},
                                {"visibility_samples", "2"}});
    const march_result m = renderer(v, s).march_pixel(0, 0);
    const vec3 colour = m.colour * (1 / (1 - m.transmittance));
    // Samples at 12 and 24 meet the roof, j >= 41, from a height of 8.5: where
    // sin e > 8.5 / 24 = 0.354. Below that the weights are sin^2 e.
    const double low = 8.5 / 24;
    check_near(colour.y, 1 / 6.0, 2e-3, "a roof: from below");
    check_near(colour.x, low * low * low / 6, 2e-3, "a roof: from above");
    check_near(colour.z, 1 / 12.0 + (low - low * low * low / 3) / 8, 4e-3,
               "a roof: from the side");
}

/// Behind the volume ///

lighting sky_of()
{
    lighting l = make_scene({}).lit;
    l.sky = true;
    l.sky_zenith = {0, 0.25, 1};
    l.sky_horizon = {1, 0.75, 0.5};
    l.sky_ground = {0.125, 0.25, 0.375};
    l.sun_disc = {3, 2, 1};
    l.sun_size = 10;
    return l;
}

void test_sky()
{
    lighting l = sky_of();
    check_colour(sky_colour(l, 1, 0), {0, 0.25, 1}, 0, "sky: zenith");
    check_colour(sky_colour(l, 0, 0), {1, 0.75, 0.5}, 0, "sky: horizon");
    check_colour(sky_colour(l, 0.5, 0), {0.0625, 0.28125, 0.96875}, 1e-15,
                 "sky: 30 degrees up, 1/16 of the horizon");
    check_colour(sky_colour(l, -1e-9, 0), {0.125, 0.25, 0.375}, 0,
                 "sky: ground");
    const double inside = std::cos(9.99 * pi / 180);
    const double outside = std::cos(10.01 * pi / 180);
    check_colour(sky_colour(l, 1, inside), {3, 2.25, 2}, 0, "sky: sun disc");
    check_colour(sky_colour(l, 1, outside), {0, 0.25, 1}, 0,
                 "sky: beside the sun disc");
    l.exposure = 4;
    check_colour(sky_colour(l, 1, inside), {8, 8, 8}, 0,
                 "sky: exposure, at most 8");
    l.sun_size = 0;
    check_colour(sky_colour(l, 1, 1), {0, 1, 4}, 0, "sky: no sun disc");
}

// By the picture's own rays, in a world that is turned.
void test_sky_picture()
{
    float_dump dump = make_dump(8, 8, 8, [](int, int, int) { return 0; });
    dump.world_from_index = {0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0};
    const volume v(std::move(dump), 1);
    const settings sky = {{"sky", "on"},
                          {"sky_zenith", "0,0,1"},
                          {"sky_horizon", "1,0,0"},
                          {"sky_ground", "0,1,0"},
                          {"sun_disc", "0,4,0"},
                          {"sun_size", "5"},
                          {"sun", "90 30"},
                          {"exposure", "0.5"}};
    const auto pixel = [&](const char *target) {
        const picture p =
            render(v, make_scene(with(sky, {{"target", target}})));
        return vec3{p.values[0], p.values[1], p.values[2]};
    };
    check_colour(pixel("0.001 1 0"), {0, 0, 0.5}, 1e-2, "upwards: the zenith");
    check_colour(pixel("1 -0.01 0"), {0, 0.5, 0}, 0, "downwards: the ground");
    check_colour(pixel("1.7320508 1 0"), {0.03125, 2, 0.46875}, 1e-6,
                 "towards the sun: its disc before the sky");
}

// A sheet one voxel thick: one lit sample, whose distance is the mean depth.
void test_haze()
{
    const volume sheet = make_volume(
        32, 8, 8, [](int i, int, int) { return i == 20 ? 0.5 : 0.0; });
    const settings view = {{"eye", "-10 4 4"},
                           {"target", "0 4 4"},
                           {"haze", "60"},
                           {"sun_colour", "1,0.5,0.25"},
                           {"background", "0.5"}};
    const scene s = make_scene(view);
    const march_result m = renderer(sheet, s).march_pixel(0, 0);
    const double left = std::exp(-30.0 / 60) * (1 - std::exp(-0.5));
    check_colour(m.colour, vec3{1, 0.5, 0.25} * left, 1e-12,
                 "haze: light at the depth of a sheet");
    check_near(m.transmittance, 1 - left, 1e-12, "haze: transmittance");
    check_near(render(sheet, s).values[2], 0.25 * left + 0.5 * (1 - left),
               1e-12, "haze: a sheet over a background");
    // Two sheets as thick as that: losses 1 - q and q (1 - q), at 30 and 50.
    const volume two = make_volume(48, 8, 8, [](int i, int, int) {
        return i == 20 || i == 40 ? 0.5 : 0.0;
    });
    const double q = std::exp(-0.5), mean = (30 + 50 * q) / (1 + q);
    check_near(renderer(two, s).march_pixel(0, 0).transmittance,
               1 - std::exp(-mean / 60) * (1 - q * q), 1e-12,
               "haze: the mean depth of two sheets");
    check_near(renderer(sheet, make_scene(with(view, {{"haze", "0"}})))
                   .march_pixel(0, 0)
                   .transmittance,
               q, 1e-12, "haze = 0: none");
}

void test_curves()
{
    const auto linear = output_curve::linear, filmic = output_curve::filmic;
    const auto srgb = output_curve::srgb;
    tap_check(display_value(linear, 0.3) == 0.3 &&
                  display_value(linear, 8) == 1 &&
                  display_value(srgb, 2) == display_value(srgb, 1) &&
                  display_value(filmic, 0) == 0,
              "shown values are 0 to 1");
    check_near(display_value(srgb, 0.5), 0.735357, 1e-6, "sRGB of 1/2");
    check_near(display_value(srgb, 0.002), 0.02584, 1e-12, "sRGB near black");
    check_near(display_value(filmic, 1), display_value(srgb, 2.54 / 3.16),
               1e-15, "filmic of 1");
    check_near(display_value(filmic, 0.1), display_value(srgb, 0.0281 / 0.2233),
               1e-12, "filmic of 1/10");
    check_near(display_value(filmic, 7.3), 1, 1e-15, "filmic reaches 1");
}

/// Scenes ///

void test_refused()
{
    const char *bad[][2] = {{"phase", "hg"},          {"phase", "hg:1"},
                            {"phase", "hg:0.1,0.2"},  {"phase", "mie:1"},
                            {"phase", "isotropic:1"}, {"phase", "droplet:51"},
                            {"phase", "droplet:0"},   {"phase", "draine:-1,0"},
                            {"phase", "mix:2,0,0,0"}, {"phase", ""},
                            {"octaves", "0"},         {"octaves", "9"},
                            {"octave_a", "1.1"},      {"exposure", "0"},
                            {"sun_colour", "1"},      {"sun_colour", "1,1,17"},
                            {"ambient", "sky"},       {"visibility", "half"},
                            {"visibility_step", "0"}, {"sky", "blue"},
                            {"haze", "-1"},           {"output", "aces"},
                            {"dither", "1"},          {"light", "cones"}};
    for (const auto &pair : bad) {
        bool refused = false;
        try {
            make_scene({{pair[0], pair[1]}});
        } catch (const std::runtime_error &) {
            refused = true;
        }
        tap_check(refused, "refused: %s = %s", pair[0], pair[1]);
    }
}

} // namespace

int main()
{
    test_octaves(1, 0.5, 0.5, 0.5);
    test_octaves(3, 0.25, 0.5, 0.75);
    test_octaves(8, 0.5, 0.75, 0.5);
    test_octaves(4, 0, 1, 0);
    test_phase_angle();
    test_colours();
    test_cache_and_cone();
    test_mips();
    test_white_furnace("isotropic", "0.2", true);
    test_white_furnace("hg:0.5", "0.2", true);
    test_white_furnace("hg:0.5", "0", false);
    test_white_furnace("schlick:-0.4", "0", false);
    test_open_sky();
    test_gradient();
    test_visibility();
    test_roof();
    test_sky();
    test_sky_picture();
    test_haze();
    test_curves();
    test_refused();
    return tap_done();
}
