// SPDX-License-Identifier: MIT

#include "monte_carlo.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <thread>

namespace reference
{

/// Paths ///

struct path_tracer::path {
    ray at;      // its origin is the vertex
    vec3 before; // the way one vertex earlier
    vec3 sun;
    int order; // scatterings up to the vertex
    std::vector<double> weight;
    random_source &random;
};

// A sharp forward peak makes the sun's contribution at a vertex rare and
// large; see lit_by_lobe.
path_tracer::path_tracer(const medium &m, const path_settings &s,
                         const vec3 &sun)
    : medium_(m), settings_(s), sun_(sun),
      use_lobe_(s.source != light_source::environment &&
                phase_value(s.phase, 1) > 4)
{
}

// The sun's light at the vertex. From the second on, when light that has been
// scattered twice also comes by lit_by_lobe, both count by the balance
// heuristic (Veach and Guibas 1995) of their densities for the same way.
double path_tracer::lit(const path &p) const
{
    const ray to_sun = {p.at.origin, p.sun};
    const double value =
        phase_value(settings_.phase, dot(p.at.direction, p.sun));
    double share = 1;
    if (use_lobe_ && p.order > 1) {
        const double a =
            phase_value(settings_.phase, dot(p.before, p.at.direction));
        share = a / (a + value);
    }
    return share * value *
           medium_.ratio_track(to_sun, settings_.light_extinction, p.random);
}

// Light that is scattered at the vertex and at one more, the way between drawn
// from the phase function about the sun instead of about the path. Of a and b,
// the phase functions at the two, the product's estimate is a b / (a + b) in
// either case: never more than the smaller of them.
double path_tracer::lit_by_lobe(const path &p) const
{
    const vec3 way = sample_way(settings_.phase, p.sun, p.random);
    const ray between = {p.at.origin, way};
    const double t = medium_.collide(between, settings_.extinction, p.random);
    if (std::isinf(t))
        return 0;
    const double a = phase_value(settings_.phase, dot(p.at.direction, way));
    const double b = phase_value(settings_.phase, dot(way, p.sun));
    const ray to_sun = {p.at.origin + way * t, p.sun};
    return a * b / (a + b) *
           medium_.ratio_track(to_sun, settings_.light_extinction, p.random);
}

// All that happens at a vertex but the choice of the next way.
void path_tracer::scatter(path &p, std::vector<double> &light) const
{
    const size_t n = settings_.albedos.size();
    p.order++;
    for (size_t i = 0; i < n; i++)
        p.weight[i] *= settings_.albedos[i];
    if (settings_.source == light_source::environment)
        return;
    const double once = lit(p);
    for (size_t i = 0; i < n; i++)
        light[i] += p.weight[i] * once;
    if (!use_lobe_ || p.order == settings_.order)
        return;
    const double twice = lit_by_lobe(p);
    for (size_t i = 0; i < n; i++)
        light[i] += p.weight[i] * settings_.albedos[i] * twice;
}

// Russian roulette by the largest of the weights.
bool path_tracer::survives(path &p) const
{
    if (p.order == settings_.order)
        return false;
    const double chance = *std::max_element(p.weight.begin(), p.weight.end());
    if (chance >= 1)
        return true;
    if (p.random.uniform() >= chance)
        return false;
    for (double &w : p.weight)
        w /= chance;
    return true;
}

bool path_tracer::trace(const ray &r, random_source &random,
                        std::vector<double> &light) const
{
    const bool all = settings_.source == light_source::all_suns;
    path p = {r,
              r.direction,
              all ? sample_sphere(random) : sun_,
              0,
              std::vector<double>(settings_.albedos.size(), 1.0),
              random};
    for (;;) {
        const double t = medium_.collide(p.at, settings_.extinction, random);
        if (std::isinf(t))
            break;
        p.at.origin = p.at.origin + p.at.direction * t;
        scatter(p, light);
        if (!survives(p))
            return false;
        p.before = p.at.direction;
        p.at.direction = sample_way(settings_.phase, p.before, random);
    }
    if (p.order > 0 && settings_.source == light_source::environment)
        for (size_t i = 0; i < light.size(); i++)
            light[i] += p.weight[i];
    return p.order == 0;
}

/// Pictures ///

path_sums::path_sums(int w, int h, int n) : width(w), height(h), values(n)
{
    const size_t count = static_cast<size_t>(w) * static_cast<size_t>(h) *
                         static_cast<size_t>(n);
    sum.assign(count, 0);
    squares.assign(count, 0);
}

double path_sums::standard_error(size_t i) const
{
    const double n = static_cast<double>(passes), m = sum[i] / n;
    return std::sqrt(std::max(0.0, squares[i] / n - m * m) /
                     std::max(1.0, n - 1));
}

static void trace_pixel(const path_tracer &tracer, const ray &r, int x, int y,
                        uint64_t seed, uint64_t passes, path_sums &sums)
{
    const size_t n = static_cast<size_t>(sums.values);
    const size_t at =
        (static_cast<size_t>(y) * static_cast<size_t>(sums.width) +
         static_cast<size_t>(x)) *
        n;
    std::vector<double> value(n - 1);
    for (uint64_t pass = sums.passes; pass < passes; pass++) {
        random_source random(
            {seed, static_cast<uint64_t>(x), static_cast<uint64_t>(y), pass});
        std::fill(value.begin(), value.end(), 0.0);
        const bool through = tracer.trace(r, random, value);
        for (size_t i = 0; i < n; i++) {
            const double v = i < n - 1 ? value[i] : through;
            sums.sum[at + i] += v;
            sums.squares[at + i] += v * v;
        }
    }
}

void trace_passes(const path_tracer &tracer, const renderer &camera,
                  uint64_t seed, uint64_t passes, int threads, path_sums &sums)
{
    std::atomic<int> next{0};
    const auto work = [&] {
        for (int y; (y = next++) < sums.height;)
            for (int x = 0; x < sums.width; x++)
                trace_pixel(tracer, camera.camera_ray(x, y), x, y, seed, passes,
                            sums);
    };
    std::vector<std::thread> helpers;
    for (int i = 1; i < threads; i++)
        helpers.emplace_back(work);
    work();
    for (std::thread &helper : helpers)
        helper.join();
    sums.passes = std::max(sums.passes, passes);
}

/// Sums on disk ///

uint64_t hash_of(const float_dump &dump)
{
    uint64_t h = 0xcbf29ce484222325u; // FNV-1a over values
    for (float v : dump.voxels)
        h = (h ^ static_cast<uint64_t>(
                     std::lround(static_cast<double>(v) * 65536))) *
            0x100000001b3u;
    return h;
}

static std::string header(const std::string &key, const path_sums &sums)
{
    return "brume-monte-carlo 1\n" + key + "\n" + std::to_string(sums.width) +
           " " + std::to_string(sums.height) + " " +
           std::to_string(sums.values) + "\n";
}

static std::streamsize bytes_of(const std::vector<double> &v)
{
    return static_cast<std::streamsize>(v.size() * sizeof v[0]);
}

bool read_sums(const std::string &path, const std::string &key, path_sums &sums)
{
    std::ifstream in(path, std::ios::binary);
    if (!in)
        return false;
    std::string got, line;
    for (int i = 0; i < 3 && std::getline(in, line); i++)
        got += line + "\n";
    if (got != header(key, sums))
        throw std::runtime_error(path + ": holds sums of another picture");
    in.read(reinterpret_cast<char *>(&sums.passes), sizeof sums.passes);
    in.read(reinterpret_cast<char *>(sums.sum.data()), bytes_of(sums.sum));
    in.read(reinterpret_cast<char *>(sums.squares.data()),
            bytes_of(sums.squares));
    if (!in || in.get() != EOF)
        throw std::runtime_error(path + ": damaged; remove it");
    return true;
}

// To another name first: a break leaves the old file or the new one.
void write_sums(const std::string &path, const std::string &key,
                const path_sums &sums)
{
    const std::string part = path + ".part";
    std::ofstream out(part, std::ios::binary);
    out << header(key, sums);
    out.write(reinterpret_cast<const char *>(&sums.passes), sizeof sums.passes);
    out.write(reinterpret_cast<const char *>(sums.sum.data()),
              bytes_of(sums.sum));
    out.write(reinterpret_cast<const char *>(sums.squares.data()),
              bytes_of(sums.squares));
    out.close();
    if (!out || std::rename(part.c_str(), path.c_str()) != 0)
        throw std::runtime_error(path + ": cannot write");
}

} // namespace reference
