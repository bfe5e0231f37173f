// SPDX-License-Identifier: MIT
//
// What the fit of octaves rests on: the table of light against the renderer,
// the furnace against a sum over directions, the search against pictures whose
// octaves are known. docs/octaves.md has what it finds.

#include <cmath>
#include <string>
#include <vector>

#include "reference/made.hpp"
#include "reference/march.hpp"
#include "reference/measure.hpp"
#include "reference/octave_furnace.hpp"
#include "reference/octave_search.hpp"
#include "reference/octaves.hpp"
#include "tap.h"

using namespace reference;

namespace
{

const double pi = 3.14159265358979323846;

settings octave_view(const octave_model &m, const std::string &phase)
{
    return with(lump_view("trilinear", 35), {{"step", "0.5"},
                                             {"light_samples", "200"},
                                             {"light_step", "0.25"},
                                             {"phase", phase},
                                             {"octaves", number(m.count)},
                                             {"octave_a", number(m.a)},
                                             {"octave_b", number(m.b)},
                                             {"octave_c", number(m.c)}});
}

double octave_sum(const marched_pixel &p, const phase_model &phase,
                  const octave_model &m)
{
    double sum = 0;
    for (int i = 0; i < m.count; i++)
        sum +=
            std::pow(m.b, i) * octave_term(p, widened(phase, std::pow(m.c, i)),
                                           light_table::find(std::pow(m.a, i)));
    return sum;
}

void test_table()
{
    for (double s : {1.0, 0.73, 0.31, 0.02, 1e-3, 1e-7, 0.0}) {
        light_table t;
        double want = 0;
        for (double tau : {0.0, 0.3, 2.0, 9.0, 40.0}) {
            t.add(0.2, tau);
            want += 0.2 * std::exp(-s * tau);
        }
        check_near(t.at(light_table::find(s)), want, s < 1e-4 ? 2e-3 : 1e-4,
                   "table of light at " + number(s));
    }
}

void test_march()
{
    for (const octave_model &m :
         {octave_model{0.5, 0.5, 0.5, 1}, octave_model{0.5, 0.5, 0.5, 8},
          octave_model{0.06, 0.8, 0.65, 3}, octave_model{0, 1, 0, 2}})
        for (const char *phase : {"isotropic", "hg:0.85", "droplet:10"}) {
            const lump cloud(lookup::trilinear);
            const scene s = make_scene(octave_view(m, phase));
            const renderer camera(cloud.voxels, s);
            double worst = 0, brightest = 0;
            const std::vector<marched_pixel> pixels =
                march_picture(cloud.voxels, s);
            for (const marched_pixel &p : pixels) {
                const double want = camera.march_pixel(p.x, p.y).radiance;
                brightest = std::max(brightest, want);
                worst = std::max(
                    worst, std::fabs(octave_sum(p, s.lit.phase, m) - want));
            }
            tap_check(worst <= 2e-4 * brightest && pixels.size() > 20,
                      "%d octaves, %s: %zu pixels are the renderer's within "
                      "%.1g of %.3g",
                      m.count, phase, pixels.size(), worst, brightest);
        }
}

/// Furnace ///

// Directions that share the sphere out equally.
vec3 spiral(int i, int n)
{
    const double z = 1 - (2 * i + 1.0) / n,
                 turn = i * pi * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(turn), r * std::sin(turn), z};
}

// The same along a lattice, with exact depths, over 256 suns.
double furnace_sum(const medium &m, const ray &r, double scale,
                   const octave_model &o, const phase_model &phase)
{
    const int suns = 256;
    const double step = 0.25;
    double through = 1, sum = 0;
    for (int k = 0; k < 160; k++) {
        const vec3 p = r.origin + r.direction * ((k + 0.5) * step);
        const double lost =
            through * -std::expm1(-scale * step *
                                  m.field().density(p, lookup::trilinear));
        if (lost == 0)
            continue;
        through -= lost;
        for (int n = 0; n < suns; n++) {
            const vec3 sun = spiral(n, suns);
            const double tau = scale * m.depth({p, sun});
            for (int i = 0; i < o.count; i++)
                sum += lost / suns * std::pow(o.b, i) *
                       phase_value(widened(phase, std::pow(o.c, i)),
                                   dot(r.direction, sun)) *
                       std::exp(-std::pow(o.a, i) * tau);
        }
    }
    return sum + through;
}

void test_furnace()
{
    const lump cloud(lookup::trilinear);
    for (const char *name : {"isotropic", "hg:0.5"}) {
        const phase_model phase =
            make_scene(with(lump_view("trilinear", 0), {{"phase", name}}))
                .lit.phase;
        for (const octave_model &m :
             {octave_model{0.5, 0.5, 0.5, 1}, octave_model{0.5, 0.5, 0.5, 4}}) {
            const double want =
                furnace_sum(cloud.inside, slanted_ray(), 0.1, m, phase);
            check_mean(measure(40000, 1,
                               [&](random_source &random) {
                                   return octave_furnace(cloud.inside, 0.1, 1,
                                                         phase, m,
                                                         slanted_ray(), random);
                               }),
                       want, std::string(name) + ": furnace of octaves", 2e-3);
        }
    }
}

// A ray shows at most T + (1 - T) * albedo * sum b^i, and comes near it where
// the medium is thin: energy is kept exactly if albedo * sum b^i <= 1.
void test_bound()
{
    const lump cloud(lookup::trilinear);
    const phase_model isotropic;
    for (double b : {0.3, 0.5, 0.9})
        for (double scale : {1e-3, 0.01, 0.1, 1.0}) {
            const octave_model m = {0.3, b, 0.5, 8};
            const double sum = m.weight_sum();
            const double lost =
                -std::expm1(-scale * cloud.inside.depth(slanted_ray()));
            for (double albedo : {1.0, 1 / sum}) {
                const estimate e =
                    measure(20000, 2, [&](random_source &random) {
                        return octave_furnace(cloud.inside, scale, albedo,
                                              isotropic, m, slanted_ray(),
                                              random);
                    });
                tap_check(e.mean <= 1 + lost * (albedo * sum - 1) +
                                        4 * e.error + 1e-12,
                          "sum b^i %.2f, albedo %.3f, depth %.3g: %.4f is at "
                          "most %.4f",
                          sum, albedo, -std::log1p(-lost), e.mean,
                          1 + lost * (albedo * sum - 1));
            }
        }
}

/// Search ///

// Pictures made of known octaves, with noise of known variance.
octave_target target_of(const octave_model &m, const phase_model &phase,
                        double elevation, double albedo, double noise)
{
    const lump cloud(lookup::trilinear);
    const scene s = make_scene(
        with(octave_view(m, "hg:0.85"), {{"sun", "50 " + number(elevation)}}));
    octave_target t{};
    t.pixels = march_picture(cloud.voxels, s);
    random_source random({4});
    const double n = static_cast<double>(t.pixels.size());
    for (const marched_pixel &p : t.pixels) {
        // Uniform noise of variance noise^2.
        const double error = noise * std::sqrt(12.0) * (random.uniform() - 0.5);
        const double value = albedo * octave_sum(p, phase, m);
        t.truth[0].push_back(value + error);
        t.mean[0] += value / n;
    }
    t.noise[0] = noise * noise;
    return t;
}

void test_search()
{
    const octave_model m = {0.24, 0.62, 0.7, 8};
    const double albedo = 0.9;
    const phase_model phase = make_scene(octave_view(m, "hg:0.85")).lit.phase;
    const auto all = [](const octave_target &) { return true; };
    std::vector<octave_target> targets = {target_of(m, phase, 10, albedo, 0),
                                          target_of(m, phase, 80, albedo, 0)};
    const octave_search exact(phase, {albedo}, targets);
    const octave_model found = exact.fit(8, 0, all);
    tap_check(std::fabs(found.a - m.a) < 1e-9 &&
                  std::fabs(found.b - m.b) < 1e-9 &&
                  std::fabs(found.c - m.c) < 1e-9,
              "the search finds %.2f, %.2f, %.2f of 0.24, 0.62, 0.70", found.a,
              found.b, found.c);
    const octave_error e = exact.error(m, 0, all);
    tap_check(e.rmse < 1e-6 && std::fabs(e.mean) < 1e-9,
              "and no error: %.2g, mean %.2g", e.rmse, e.mean);
    octave_model dark = m;
    dark.count = 1;
    dark.b = 0;
    const octave_error d = exact.error(dark, 0, all);
    tap_check(d.mean < -0.1 && d.rmse >= -d.mean,
              "one octave is darker: rmse %.3f, mean %.3f", d.rmse, d.mean);
    const octave_error same = exact.softened(1, 0, all);
    octave_model one;
    check_near(same.rmse, exact.error(one, 0, all).rmse, 1e-12,
               "no softening is one octave");
    const octave_error half = exact.error(m, 0, all, 0.5);
    check_near(half.mean, -0.5, 1e-9, "half the light is half the mean");

    targets = {target_of(m, phase, 10, albedo, 0.01),
               target_of(m, phase, 80, albedo, 0.01)};
    const octave_search noisy(phase, {albedo}, targets);
    const double with_noise = noisy.error(dark, 0, all).rmse;
    tap_check(std::fabs(with_noise - d.rmse) < 0.02 * d.rmse,
              "noise does not count as error: %.3f, without it %.3f",
              with_noise, d.rmse);
}

} // namespace

int main()
{
    test_table();
    test_march();
    test_furnace();
    test_bound();
    test_search();
    return tap_done();
}
