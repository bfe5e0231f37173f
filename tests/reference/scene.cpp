// SPDX-License-Identifier: MIT

#include "scene_values.hpp"

#include <cmath>
#include <fstream>
#include <ostream>
#include <stdexcept>
#include <vector>

namespace reference
{

/// Values ///

static void set_size(scene &s, const std::string &text)
{
    const size_t x = text.find('x');
    if (x == std::string::npos)
        throw std::runtime_error("expected WIDTHxHEIGHT");
    s.width = static_cast<int>(parse_integer(text.substr(0, x), 1, 65535));
    s.height = static_cast<int>(parse_integer(text.substr(x + 1), 1, 65535));
}

static void set_sun(scene &s, const std::string &text)
{
    const std::vector<double> v = parse_list(text);
    if (v.size() != 2)
        throw std::runtime_error("expected azimuth and elevation");
    s.sun_azimuth = v[0];
    s.sun_elevation = v[1];
}

static void set_jitter(scene &s, const std::string &text)
{
    const size_t n = parse_word(text, {"none", "primary", "light", "both"});
    s.jitter_primary = n == 1 || n == 3;
    s.jitter_light = n == 2 || n == 3;
}

static void set_background(scene &s, const std::string &text)
{
    const std::vector<double> v = parse_list(text);
    if (v.size() != 1 && v.size() != 3)
        throw std::runtime_error("expected one number or three");
    s.background_is_rgb = v.size() == 3;
    s.background = {v[0], v[v.size() / 2], v[v.size() - 1]};
}

/// Keys ///

static void set_noise(scene &s, const std::string &v)
{
    if (v.size() > 4 && v.substr(v.size() - 4) == ".raw") {
        s.noise_kind = noise::table;
        s.noise_values = read_noise_table(v);
        return;
    }
    s.noise_kind = static_cast<noise>(
        parse_word(v, {"none", "white", "ign", "bayer8", "bayer4", "bayer16",
                       "ign-thesis", "rank1"}));
}

using text = const std::string &;

static const std::vector<scene_key> march_keys = {
    {"size", nullptr, need::always, "WIDTHxHEIGHT, pixels", set_size},
    {"eye", nullptr, need::always, "x,y,z, world space",
     [](scene &s, text v) { s.eye = parse_vec3(v); }},
    {"target", nullptr, need::always, "x,y,z, world space",
     [](scene &s, text v) { s.target = parse_vec3(v); }},
    {"up", "0,1,0", need::never, "x,y,z, world axes",
     [](scene &s, text v) { s.up = parse_vec3(v); }},
    {"fov", nullptr, need::always, "vertical, degrees",
     [](scene &s, text v) { s.fov = parse_in(v, 1e-3, 179); }},
    {"sun", nullptr, need::sun, "azimuth elevation, degrees", set_sun},
    {"density_scale", nullptr, need::always, "extinction per voxel",
     [](scene &s, text v) { s.density_scale = parse_in(v, 0, infinity); }},
    {"light_density_scale", nullptr, need::light_scale, "along light rays",
     [](scene &s, text v) {
         s.light_density_scale = parse_in(v, 0, infinity);
     }},
    {"albedo", "1", need::never, "0..1",
     [](scene &s, text v) { s.albedo = parse_in(v, 0, 1); }},
    {"step", nullptr, need::always, "voxels",
     [](scene &s, text v) { s.step = parse_positive(v); }},
    {"min_density", "0", need::never, "samples above it contribute",
     [](scene &s, text v) { s.min_density = parse_in(v, 0, infinity); }},
    {"min_transmittance", "0.01", need::never, "a ray stops below it",
     [](scene &s, text v) { s.min_transmittance = parse_in(v, 0, 1); }},
    {"max_density", nullptr, need::never, "voxels are clamped to it",
     [](scene &s, text v) { s.max_density = parse_positive(v); }},
    {"filter", "nearest", need::never,
     "nearest | trilinear | stochastic: its mean, trilinear",
     [](scene &s, text v) {
         const size_t n = parse_word(v, {"nearest", "trilinear", "stochastic"});
         s.filter = n == 0 ? lookup::nearest : lookup::trilinear;
     }},
    {"light", nullptr, need::always,
     "none | log | uniform | cone | cache: the exact optical depth",
     [](scene &s, text v) {
         s.light = static_cast<light_model>(
             parse_word(v, {"none", "log", "uniform", "cone", "cache"}));
     }},
    {"light_samples", nullptr, need::light_rays, "1..65535",
     [](scene &s, text v) {
         s.light_samples = static_cast<int>(parse_integer(v, 1, 65535));
     }},
    {"light_step", nullptr, need::light_rays, "voxels",
     [](scene &s, text v) { s.light_step = parse_positive(v); }},
    {"jitter", "none", need::never, "none | primary | light | both",
     set_jitter},
    {"noise", "none", need::never,
     "none | white | ign | bayer8 | bayer4 | bayer16 | ign-thesis | rank1 | "
     "FILE",
     set_noise},
    {"frame", "0", need::never, "0..4294967295",
     [](scene &s, text v) { s.frame = parse_integer(v, 0, 4294967295.0); }},
    {"background", "0", need::never, "grey, or r,g,b; linear", set_background},
    {"skip", nullptr, need::never, "ignored: nothing is skipped",
     [](scene &, text) {}},
};

static std::vector<scene_key> all_keys()
{
    std::vector<scene_key> all = march_keys;
    all.insert(all.end(), light_keys().begin(), light_keys().end());
    return all;
}

void print_scene_keys(std::ostream &out)
{
    for (const scene_key &key : all_keys()) {
        std::string line = std::string("  ") + key.name;
        line.resize(23, ' ');
        if (key.fallback)
            line += key.fallback;
        else if (key.required == need::always)
            line += "required";
        else if (key.required != need::never)
            line += "if used";
        else
            line += "-";
        line.resize(34, ' ');
        out << line << key.meaning << '\n';
    }
}

/// Reading ///

static std::string trim(const std::string &s)
{
    static const char blanks[] = " \t\r\n";
    const size_t first = s.find_first_not_of(blanks);
    if (first == std::string::npos)
        return "";
    return s.substr(first, s.find_last_not_of(blanks) - first + 1);
}

scene_builder::scene_builder()
{
    scene_.max_density = infinity;
    for (const scene_key &key : all_keys())
        if (key.fallback)
            key.set(scene_, key.fallback);
}

void scene_builder::set(const std::string &name, const std::string &value)
{
    for (const scene_key &key : all_keys()) {
        if (name != key.name)
            continue;
        try {
            key.set(scene_, value);
        } catch (const std::runtime_error &e) {
            throw std::runtime_error(name + ": " + e.what());
        }
        given_.insert(name);
        return;
    }
    throw std::runtime_error("unknown key '" + name + "'");
}

void scene_builder::set_pair(const std::string &pair)
{
    const size_t equals = pair.find('=');
    if (equals == std::string::npos)
        throw std::runtime_error("expected key = value: '" + pair + "'");
    set(trim(pair.substr(0, equals)), trim(pair.substr(equals + 1)));
}

void scene_builder::read_file(const std::string &path)
{
    std::ifstream in(path);
    if (!in)
        throw std::runtime_error(path + ": cannot open");
    std::string line;
    for (int number = 1; std::getline(in, line); number++) {
        line = trim(line.substr(0, line.find('#')));
        if (line.empty())
            continue;
        try {
            set_pair(line);
        } catch (const std::runtime_error &e) {
            throw std::runtime_error(path + ":" + std::to_string(number) +
                                     ": " + e.what());
        }
    }
    if (in.bad())
        throw std::runtime_error(path + ": cannot read");
}

static bool is_needed(need what, const scene &s)
{
    const bool dark = s.light == light_model::none;
    const bool phased = s.lit.phase.kind == phase_kind::schlick ||
                        s.lit.phase.g != 0 || s.lit.phase.weight != 0;
    switch (what) {
    case need::always: return true;
    case need::sun: return !dark || phased || s.lit.sun_size > 0;
    case need::light_scale:
        return !dark || (s.lit.ambient != ambient_kind::none &&
                         s.lit.visibility != visibility_kind::open);
    case need::light_rays: return !dark && s.light != light_model::cache;
    case need::never: break;
    }
    return false;
}

scene scene_builder::finish() const
{
    for (const scene_key &key : all_keys()) {
        if (is_needed(key.required, scene_) && !given_.count(key.name))
            throw std::runtime_error("the scene lacks '" +
                                     std::string(key.name) + "'");
    }
    const vec3 forward = scene_.target - scene_.eye;
    if (length(forward) == 0)
        throw std::runtime_error("eye and target are the same point");
    if (length(cross(forward, scene_.up)) <=
        1e-9 * length(forward) * length(scene_.up))
        throw std::runtime_error("up is parallel to the view direction");
    return scene_;
}

} // namespace reference
