// SPDX-License-Identifier: MIT
//
// What docs/light.md adds to one white sun that is scattered once.
#ifndef BRUME_REFERENCE_LIGHTING_HPP
#define BRUME_REFERENCE_LIGHTING_HPP

#include <array>
#include <vector>

#include "air.hpp"
#include "phase.hpp"
#include "vec3.hpp"

namespace reference
{

enum class ambient_kind { none, constant, gradient, cube };
enum class visibility_kind { open, sampled, baked };
enum class output_curve { linear, srgb, filmic };

// In world space; angles in degrees.
struct lamp {
    vec3 position;
    double radius, size;
    vec3 colour;
    bool spot = false;
    vec3 direction = {0, 0, 0};
    double inner = 0, outer = 0;
    int shadow_samples = 0;
};

using emission_colours = std::vector<vec3>; // of codes 0 .. 255, or none

struct lighting {
    phase_model phase;
    int octaves;
    double octave_a, octave_b, octave_c;
    vec3 sun_colour;
    double exposure;

    ambient_kind ambient;
    vec3 ambient_colour;              // constant
    vec3 ambient_top, ambient_bottom; // gradient
    std::array<vec3, 6> ambient_cube; // +x -x +y -y +z -z
    visibility_kind visibility;
    int visibility_samples;
    double visibility_step;   // voxels
    int sky_directions = 256; // over which sampled visibility is averaged

    emission_colours glow;
    double emission_scale; // extinction per voxel at a value of 1

    bool sky;
    vec3 sky_zenith, sky_horizon, sky_ground, sun_disc;
    double sun_size; // the radius of its disc, degrees
    double haze;     // voxels; 0: none

    reference::fog fog;
    grey_map surface;
    reference::sun_map sun_map;
    output_curve output;
    std::vector<lamp> lamps;
};

} // namespace reference

#endif
