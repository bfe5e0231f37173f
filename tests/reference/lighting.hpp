// SPDX-License-Identifier: MIT
//
// What docs/light.md adds to one white sun that is scattered once.
#ifndef BRUME_REFERENCE_LIGHTING_HPP
#define BRUME_REFERENCE_LIGHTING_HPP

#include <array>
#include <vector>

#include "phase.hpp"
#include "vec3.hpp"

namespace reference
{

enum class ambient_kind { none, constant, gradient, cube };
enum class visibility_kind { open, sampled, baked };
enum class output_curve { linear, srgb, filmic };

// How `light = cone` reads its segments; see sun_light::cone_depth.
struct cone_rule {
    double first = 1;   // weight of the density at the sample itself
    double place = 0.5; // of a sample in its segment
    int level = -2;     // log2 of its cube to that of its segment
    int pairs_from = 4; // this sample is the first of two for a doubling;
    int pairs = 2;      // so many doublings have two
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

    cone_rule cone;

    emission_colours glow;
    double emission_scale; // extinction per voxel at a value of 1

    bool sky;
    vec3 sky_zenith, sky_horizon, sky_ground, sun_disc;
    double sun_size; // the radius of its disc, degrees
    double haze;     // voxels; 0: none
    output_curve output;
};

} // namespace reference

#endif
