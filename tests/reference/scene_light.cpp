// SPDX-License-Identifier: MIT
//
// The scene's keys of docs/light.md.

#include <stdexcept>

#include "emission.hpp"
#include "lamps.hpp"
#include "scene_values.hpp"

namespace reference
{

using text = const std::string &;

/// Values ///

// As far as the core goes: a lobe narrower than that is no cloud's.
static const double largest_g = 0.999;

static double checked(double value, double low, double high)
{
    if (value < low || value > high)
        throw std::runtime_error(std::to_string(value) + " is out of range");
    return value;
}

static phase_model make_mix(const std::vector<double> &v)
{
    phase_model m;
    m.weight = checked(v[0], 0, 1);
    m.draine_alpha = checked(v[1], 0, 1024);
    m.draine_g = checked(v[2], -largest_g, largest_g);
    m.g = checked(v[3], -largest_g, largest_g);
    return m;
}

static phase_model make_phase(text kind, const std::vector<double> &v)
{
    const auto is = [&](const char *name, size_t numbers) {
        if (kind == name && v.size() != numbers)
            throw std::runtime_error("expected " + std::to_string(numbers) +
                                     " numbers after " + name);
        return kind == name;
    };
    if (is("isotropic", 0))
        return {};
    if (is("hg", 1))
        return make_mix({0, 0, 0, v[0]});
    if (is("schlick", 1))
        return {phase_kind::schlick, checked(v[0], -largest_g, largest_g), 0, 0,
                0};
    if (is("draine", 2))
        return make_mix({1, v[0], v[1], 0});
    if (is("droplet", 1))
        return droplet_phase(checked(v[0], 1e-3, 50));
    if (is("mix", 4))
        return make_mix(v);
    throw std::runtime_error("'" + kind +
                             "' is not one of isotropic, hg, schlick, draine,"
                             " droplet, mix");
}

static void set_phase(scene &s, text v)
{
    const size_t colon = v.find(':');
    std::vector<double> numbers;
    if (colon != std::string::npos)
        numbers = parse_list(v.substr(colon + 1));
    s.lit.phase = make_phase(v.substr(0, colon), numbers);
}

static bool parse_switch(text v)
{
    return parse_word(v, {"off", "on"}) == 1;
}

static int parse_count(text v, int low, int high)
{
    return static_cast<int>(parse_integer(v, low, high));
}

/// Keys ///

template <vec3 lighting::*colour> static void set_colour(scene &s, text v)
{
    s.lit.*colour = parse_colour(v);
}

template <size_t side> static void set_side(scene &s, text v)
{
    s.lit.ambient_cube[side] = parse_colour(v);
}

template <double lighting::*factor> static void set_factor(scene &s, text v)
{
    s.lit.*factor = parse_in(v, 0, 1);
}

const std::vector<scene_key> &light_keys()
{
    const need no = need::never;
    static const std::vector<scene_key> keys = {
        {"phase", "isotropic", no,
         "isotropic | hg:G | schlick:G | draine:ALPHA,G | droplet:MICROMETRES "
         "| mix:WEIGHT,ALPHA,G_DRAINE,G",
         set_phase},
        {"octaves", "1", no, "of multiple scattering, 1..8",
         [](scene &s, text v) { s.lit.octaves = parse_count(v, 1, 8); }},
        {"octave_a", "0.5", no, "extinction of each to the one before",
         set_factor<&lighting::octave_a>},
        {"octave_b", "0.5", no, "the same of its light",
         set_factor<&lighting::octave_b>},
        {"octave_c", "0.5", no, "the same of its phase function's g",
         set_factor<&lighting::octave_c>},
        {"sun_colour", "1,1,1", no, "r,g,b, 0..16",
         set_colour<&lighting::sun_colour>},
        {"exposure", "1", no, "times light and sky",
         [](scene &s, text v) { s.lit.exposure = parse_in(v, 1.0 / 256, 16); }},
        {"ambient", "none", no, "none | constant | gradient | cube",
         [](scene &s, text v) {
             s.lit.ambient = static_cast<ambient_kind>(
                 parse_word(v, {"none", "constant", "gradient", "cube"}));
         }},
        {"ambient_colour", "1,1,1", no, "of constant",
         set_colour<&lighting::ambient_colour>},
        {"ambient_top", "1,1,1", no, "of gradient",
         set_colour<&lighting::ambient_top>},
        {"ambient_bottom", "0,0,0", no, "of gradient",
         set_colour<&lighting::ambient_bottom>},
        {"ambient_px", "0,0,0", no, "of cube: from +x", set_side<0>},
        {"ambient_nx", "0,0,0", no, "-x", set_side<1>},
        {"ambient_py", "0,0,0", no, "+y", set_side<2>},
        {"ambient_ny", "0,0,0", no, "-y", set_side<3>},
        {"ambient_pz", "0,0,0", no, "+z", set_side<4>},
        {"ambient_nz", "0,0,0", no, "-z", set_side<5>},
        {"visibility", "open", no,
         "open | sampled | baked: exact, whatever the bake found",
         [](scene &s, text v) {
             s.lit.visibility = static_cast<visibility_kind>(
                 parse_word(v, {"open", "sampled", "baked"}));
         }},
        {"visibility_samples", "6", no, "of sampled, 0..16",
         [](scene &s, text v) {
             s.lit.visibility_samples = parse_count(v, 0, 16);
         }},
        {"visibility_step", "1", no, "voxels",
         [](scene &s, text v) { s.lit.visibility_step = parse_positive(v); }},
        {"sky", "off", no, "off | on: behind the volume",
         [](scene &s, text v) { s.lit.sky = parse_switch(v); }},
        {"sky_zenith", "0,0,0", no, "r,g,b, 0..16",
         set_colour<&lighting::sky_zenith>},
        {"sky_horizon", "0,0,0", no, "r,g,b",
         set_colour<&lighting::sky_horizon>},
        {"sky_ground", "0,0,0", no, "r,g,b", set_colour<&lighting::sky_ground>},
        {"sun_disc", "0,0,0", no, "r,g,b", set_colour<&lighting::sun_disc>},
        {"sun_size", "0", no, "radius of its disc, degrees",
         [](scene &s, text v) { s.lit.sun_size = parse_in(v, 0, 90); }},
        {"haze", "0", no, "voxels to 1/e of the volume; 0: none",
         [](scene &s, text v) { s.lit.haze = parse_in(v, 0, infinity); }},
        {"fog_density", "0", no, "extinction per voxel below fog_base",
         [](scene &s, text v) { s.lit.fog.density = parse_in(v, 0, 1); }},
        {"fog_base", "0", no, "world height",
         [](scene &s, text v) {
             s.lit.fog.base = parse_in(v, -infinity, infinity);
         }},
        {"fog_falloff", "0", no, "world height to 1/e; 0: none",
         [](scene &s, text v) { s.lit.fog.falloff = parse_in(v, 0, infinity); }},
        {"fog_far", "0", no, "world distance; 0: 32766 voxels",
         [](scene &s, text v) { s.lit.fog.far = parse_in(v, 0, infinity); }},
        {"fog_shapes", "none", no, "none | FILE: spheres and boxes",
         [](scene &s, text v) {
             if (v != "none")
                 s.lit.fog.shapes = read_fog_shapes(v);
         }},
        {"surface", "none", no, "none | FILE.pgm: depth codes",
         [](scene &s, text v) {
             if (v != "none")
                 s.lit.surface = read_grey_map(v);
         }},
        {"sun_map", "none", no, "none | FILE.pgm: what shades the sun",
         [](scene &s, text v) {
             if (v != "none")
                 s.lit.sun_map = read_sun_map(v);
         }},
        {"output", "linear", no, "linear | srgb | filmic, for --display",
         [](scene &s, text v) {
             s.lit.output = static_cast<output_curve>(
                 parse_word(v, {"linear", "srgb", "filmic"}));
         }},
        {"emission", "none", no,
         "none | blackbody:LOW,HIGH,BRIGHTNESS | FILE of 256 colours",
         [](scene &s, text v) { s.lit.glow = read_emission(v); }},
        {"emission_scale", "1", no, "extinction per voxel at a value of 1",
         [](scene &s, text v) {
             s.lit.emission_scale = parse_in(v, 0, infinity);
         }},
        {"lamps", "none", no, "none, or a file of one lamp per line",
         [](scene &s, text v) {
             s.lit.lamps = v == "none" ? std::vector<lamp>() : read_lamps(v);
         }},
        {"dither", nullptr, no, "ignored: values are not quantised",
         [](scene &, text v) { parse_switch(v); }},
    };
    return keys;
}

} // namespace reference
