// SPDX-License-Identifier: MIT

#include "octave_targets.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "monte_carlo.hpp"

namespace reference
{

static const double radians = 3.14159265358979323846 / 180;

/// Subjects ///

subject open_subject(const std::string &text)
{
    subject s{};
    s.probe = text[0] == '+';
    const std::string spec = text.substr(s.probe ? 1 : 0);
    const size_t equals = spec.find('='), comma = spec.rfind(',');
    char *end = nullptr;
    if (equals != std::string::npos && comma != std::string::npos &&
        comma > equals)
        s.extinction = std::strtod(spec.c_str() + comma + 1, &end);
    if (!end || *end != '\0' || !(s.extinction > 0) || std::isinf(s.extinction))
        throw std::runtime_error("expected NAME=FILE.float,EXTINCTION: '" +
                                 spec + "'");
    s.name = spec.substr(0, equals);
    float_dump dump =
        read_float_dump(spec.substr(equals + 1, comma - equals - 1));
    s.hash = hash_of(dump);
    s.voxels = std::make_unique<volume>(std::move(dump), 1e30);
    s.inside = std::make_unique<medium>(*s.voxels, lookup::trilinear);
    const std::array<vec3, 2> box = s.voxels->occupied_box();
    if (box[0].x > box[1].x)
        throw std::runtime_error(s.name + ": is empty");
    return s;
}

/// Views ///

// Where the eye is, seen from the volume; degrees.
static const double view_azimuth[view_count] = {20, 130, 250};
static const double view_elevation[view_count] = {8, 25, -5};
static const double sun_azimuth = 60;
static const double sun_elevation[sun_count] = {10, 35, 80};

static std::string text_of(const vec3 &v)
{
    char text[100];
    std::snprintf(text, sizeof text, "%.9g,%.9g,%.9g", v.x, v.y, v.z);
    return text;
}

// The other way is a scale times a rotation, whose columns these are.
static vec3 world_from_pool(const volume &v, const vec3 &p)
{
    const vec3 origin = v.pool_from_world({0, 0, 0});
    const vec3 x = v.pool_from_world({1, 0, 0}) - origin;
    const vec3 y = v.pool_from_world({0, 1, 0}) - origin;
    const vec3 z = v.pool_from_world({0, 0, 1}) - origin;
    const vec3 q = (p - origin) * (1 / dot(x, x));
    return {dot(x, q), dot(y, q), dot(z, q)};
}

// The eye sees the sphere about the box of what is not empty.
scene view_scene(const subject &s, int view, int sun, int side,
                 const std::string &phase)
{
    const std::array<vec3, 2> box = s.voxels->occupied_box();
    const vec3 a = world_from_pool(*s.voxels, box[0]);
    const vec3 b = world_from_pool(*s.voxels, box[1]);
    const double azimuth = view_azimuth[view] * radians;
    const double elevation = view_elevation[view] * radians;
    const double fov = 28;
    const double far = length(b - a) / 2 / std::sin(fov / 2 * radians);
    const vec3 middle = (a + b) * 0.5;
    const vec3 eye = middle + vec3{std::cos(elevation) * std::sin(azimuth),
                                   std::sin(elevation),
                                   std::cos(elevation) * std::cos(azimuth)} *
                                  far;
    const std::string size = std::to_string(side);
    const std::string scale = std::to_string(s.extinction);
    scene_builder builder;
    const std::vector<std::pair<std::string, std::string>> settings = {
        {"size", size + "x" + size},
        {"eye", text_of(eye)},
        {"target", text_of(middle)},
        {"fov", std::to_string(fov)},
        {"sun", std::to_string(sun_azimuth) + " " +
                    std::to_string(sun_elevation[sun])},
        {"phase", phase},
        {"density_scale", scale},
        {"light_density_scale", scale},
        {"filter", "trilinear"},
        {"step", "0.5"},
        {"light", "uniform"},
        {"light_samples", "256"},
        {"light_step", "1"},
        {"min_transmittance", "0"},
    };
    for (const auto &[key, value] : settings)
        builder.set(key, value);
    return builder.finish();
}

/// Targets ///

static std::string key_of(const subject &s, const std::string &phase,
                          const scene &c)
{
    char text[300];
    std::snprintf(text, sizeof text,
                  "octaves %016llx extinction %.9g phase %s side %d eye %s"
                  " sun %.9g",
                  static_cast<unsigned long long>(s.hash), s.extinction,
                  phase.c_str(), c.width, text_of(c.eye).c_str(),
                  c.sun_elevation);
    return text;
}

static path_sums trace_picture(const subject &s, const scene &c,
                               const std::string &phase,
                               const target_options &o, const std::string &file)
{
    path_settings settings;
    settings.extinction = settings.light_extinction = s.extinction;
    settings.phase = c.lit.phase;
    settings.albedos = fit_albedos;
    const renderer camera(*s.voxels, c);
    const path_tracer tracer(*s.inside, settings, camera.sun());
    const std::string key = key_of(s, phase, c);
    path_sums sums(c.width, c.height, static_cast<int>(fit_albedos.size()) + 1);
    if (!file.empty())
        read_sums(file, key, sums);
    if (sums.passes > o.passes)
        throw std::runtime_error(file + ": has more passes than asked for");
    const bool more = sums.passes < o.passes;
    trace_passes(tracer, camera, 1, o.passes, o.threads, sums);
    if (!file.empty() && more)
        write_sums(file, key, sums);
    return sums;
}

static void take_truth(const path_sums &sums, octave_target &t)
{
    const double n = static_cast<double>(t.pixels.size());
    for (size_t w = 0; w < fit_albedos.size(); w++) {
        t.mean[w] = t.noise[w] = 0;
        for (const marched_pixel &p : t.pixels) {
            const size_t i = static_cast<size_t>(p.y * sums.width + p.x) *
                                 static_cast<size_t>(sums.values) +
                             w;
            const double error = sums.standard_error(i);
            t.truth[w].push_back(sums.mean(i));
            t.mean[w] += sums.mean(i) / n;
            t.noise[w] += error * error / n;
        }
    }
}

static std::string file_name(const std::string &subject_name,
                             const std::string &phase, int view, int sun)
{
    std::string name = subject_name + "-" + phase + "-" + std::to_string(view) +
                       std::to_string(sun) + ".sums";
    for (char &c : name)
        if (c == ':' || c == ',' || c == '/' || c == ' ')
            c = '_';
    return name;
}

void add_targets(const subject &s, int group, const std::string &phase,
                 const target_options &o, std::vector<octave_target> &out)
{
    for (int view = 0; view < view_count; view++)
        for (int sun = 0; sun < sun_count; sun++) {
            const scene c = view_scene(s, view, sun, o.side, phase);
            const std::string file =
                o.cache.empty()
                    ? ""
                    : o.cache + "/" + file_name(s.name, phase, view, sun);
            octave_target t{};
            t.group = group;
            t.probe = s.probe;
            t.view = view;
            t.pixels = march_picture(*s.voxels, c);
            take_truth(trace_picture(s, c, phase, o, file), t);
            out.push_back(std::move(t));
        }
}

} // namespace reference
