// SPDX-License-Identifier: MIT

#include "scene.hpp"

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <vector>

namespace reference
{

static const double infinity = std::numeric_limits<double>::infinity();

/// Values ///

static double parse_number(const std::string &text)
{
    char *end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !std::isfinite(value))
        throw std::runtime_error("'" + text + "' is not a number");
    return value;
}

static double parse_in(const std::string &text, double low, double high)
{
    const double value = parse_number(text);
    if (value < low || value > high)
        throw std::runtime_error(text + " is out of range");
    return value;
}

static double parse_positive(const std::string &text)
{
    return parse_in(text, std::numeric_limits<double>::min(), infinity);
}

static uint32_t parse_integer(const std::string &text, double low, double high)
{
    const double value = parse_in(text, low, high);
    if (value != std::floor(value))
        throw std::runtime_error(text + " is not an integer");
    return static_cast<uint32_t>(value);
}

// Numbers separated by commas, by blanks, or by both.
static std::vector<double> parse_list(const std::string &text)
{
    static const char separators[] = ", \t";
    std::vector<double> values;
    size_t at = text.find_first_not_of(separators);
    while (at != std::string::npos) {
        const size_t end = text.find_first_of(separators, at);
        values.push_back(parse_number(text.substr(at, end - at)));
        at = text.find_first_not_of(separators, end);
    }
    return values;
}

static vec3 parse_vec3(const std::string &text)
{
    const std::vector<double> v = parse_list(text);
    if (v.size() != 3)
        throw std::runtime_error("expected three numbers");
    return {v[0], v[1], v[2]};
}

// The position of `text` among `words`.
static size_t parse_word(const std::string &text,
                         const std::vector<std::string> &words)
{
    std::string all;
    for (size_t i = 0; i < words.size(); i++) {
        if (words[i] == text)
            return i;
        all += (i ? ", " : "") + words[i];
    }
    throw std::runtime_error("'" + text + "' is not one of " + all);
}

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

// Which scenes must set a key: if_lit is every light but `none`.
enum class need { always, if_lit, never };

struct scene_key {
    const char *name;
    const char *fallback; // the default as it would be written, or null
    need required;
    const char *meaning;
    void (*set)(scene &, const std::string &);
};

using text = const std::string &;

static const scene_key keys[] = {
    {"size", nullptr, need::always, "WIDTHxHEIGHT, pixels", set_size},
    {"eye", nullptr, need::always, "x,y,z, world space",
     [](scene &s, text v) { s.eye = parse_vec3(v); }},
    {"target", nullptr, need::always, "x,y,z, world space",
     [](scene &s, text v) { s.target = parse_vec3(v); }},
    {"up", "0,1,0", need::never, "x,y,z, world axes",
     [](scene &s, text v) { s.up = parse_vec3(v); }},
    {"fov", nullptr, need::always, "vertical, degrees",
     [](scene &s, text v) { s.fov = parse_in(v, 1e-3, 179); }},
    {"sun", nullptr, need::if_lit, "azimuth elevation, degrees", set_sun},
    {"density_scale", nullptr, need::always, "extinction per voxel",
     [](scene &s, text v) { s.density_scale = parse_in(v, 0, infinity); }},
    {"light_density_scale", nullptr, need::if_lit, "along light rays",
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
    {"filter", "nearest", need::never, "nearest | trilinear",
     [](scene &s, text v) {
         s.filter =
             static_cast<lookup>(parse_word(v, {"nearest", "trilinear"}));
     }},
    {"light", nullptr, need::always, "none | log | uniform",
     [](scene &s, text v) {
         s.light = static_cast<light_model>(
             parse_word(v, {"none", "log", "uniform"}));
     }},
    {"light_samples", nullptr, need::if_lit, "1..65535",
     [](scene &s, text v) {
         s.light_samples = static_cast<int>(parse_integer(v, 1, 65535));
     }},
    {"light_step", nullptr, need::if_lit, "voxels",
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
    {"output", nullptr, need::never, "ignored: the output is linear",
     [](scene &, text) {}},
    {"skip", nullptr, need::never, "ignored: nothing is skipped",
     [](scene &, text) {}},
};

void print_scene_keys(std::ostream &out)
{
    for (const scene_key &key : keys) {
        std::string line = std::string("  ") + key.name;
        line.resize(23, ' ');
        if (key.fallback)
            line += key.fallback;
        else if (key.required == need::always)
            line += "required";
        else if (key.required == need::if_lit)
            line += "if lit";
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
    for (const scene_key &key : keys)
        if (key.fallback)
            key.set(scene_, key.fallback);
}

void scene_builder::set(const std::string &name, const std::string &value)
{
    for (const scene_key &key : keys) {
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

scene scene_builder::finish() const
{
    const bool lit = scene_.light != light_model::none;
    for (const scene_key &key : keys) {
        const bool required = key.required == need::always ||
                              (key.required == need::if_lit && lit);
        if (required && !given_.count(key.name))
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
