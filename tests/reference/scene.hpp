// SPDX-License-Identifier: MIT
//
// What to render: the scene file, `key = value` a line, # comments.
//
// Unlike the renderer under test this one takes no value from the volume: a
// picture follows from the scene and the voxels alone.
#ifndef BRUME_REFERENCE_SCENE_HPP
#define BRUME_REFERENCE_SCENE_HPP

#include <cstdint>
#include <iosfwd>
#include <set>
#include <string>

#include "lighting.hpp"
#include "noise.hpp"
#include "vec3.hpp"
#include "volume.hpp"

namespace reference
{

enum class light_model { none, log, uniform, cone, cache };

struct scene {
    int width, height;
    vec3 eye, target, up;              // world space
    double fov;                        // vertical, degrees
    double sun_azimuth, sun_elevation; // degrees, towards the sun
    double density_scale;              // extinction per voxel at density 1
    double light_density_scale;
    double albedo;
    double step; // voxels
    double min_density;
    double min_transmittance;
    double max_density;
    lookup filter;
    light_model light;
    int light_samples;
    double light_step; // voxels
    bool jitter_primary, jitter_light;
    noise noise_kind;
    noise_table noise_values; // when it is a table
    uint32_t frame;
    vec3 background;        // linear
    bool background_is_rgb; // written r,g,b: the picture has three channels
    lighting lit;
};

// Collects settings, the later of two winning, and hands out the scene once
// it is complete. Every member throws std::runtime_error: an unknown key, a
// value that does not parse or is out of range, a required key left out.
class scene_builder
{
  public:
    scene_builder();
    void set(const std::string &key, const std::string &value);
    // `key=value`, the argument of --set.
    void set_pair(const std::string &pair);
    // Errors name the file and the line.
    void read_file(const std::string &path);
    scene finish() const;

  private:
    scene scene_{};
    std::set<std::string> given_;
};

// One line a key: its default, or that it is required, and its meaning.
void print_scene_keys(std::ostream &out);

} // namespace reference

#endif
