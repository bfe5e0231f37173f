// SPDX-License-Identifier: MIT
//
// What is there besides the volume, as docs/light.md defines it: fog by height
// and of shapes, a surface, what shades the sun.
#ifndef BRUME_REFERENCE_AIR_HPP
#define BRUME_REFERENCE_AIR_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "vec3.hpp"

namespace reference
{

class volume;
struct scene;

// In world space; extinction per voxel.
struct fog_shape {
    bool box;
    vec3 centre, half; // a sphere's radius is half.x
    double density, softness;
};

struct fog {
    double density; // per voxel
    double base, falloff, far; // world; 0: no falloff, no end
    std::vector<fog_shape> shapes;

    bool is_on() const
    {
        return density > 0 || !shapes.empty();
    }
};

// Grey values of 16 bits; row 0 on top. Empty: there is none.
struct grey_map {
    int width = 0, height = 0;
    std::vector<uint16_t> values;
    std::vector<std::string> comments;
};

struct sun_map {
    grey_map texels;
    vec3 origin, across, down; // world
    double range, bias;
};

// All throw std::runtime_error with the path.
std::vector<fog_shape> read_fog_shapes(const std::string &path);
grey_map read_grey_map(const std::string &path);
sun_map read_sun_map(const std::string &path);

// The scene's, in pool space.
class air
{
  public:
    // Keeps references. `sun` and `zenith` are unit vectors in pool space.
    air(const volume &v, const scene &s, const vec3 &sun, const vec3 &zenith);

    bool has_fog() const;
    // Extinction per voxel.
    double fog_at(const vec3 &p) const;
    // Optical depth of fog towards the sun.
    double fog_depth(const vec3 &p, double jitter) const;
    // Where the ray through a pixel ends, in voxels from the eye, or infinity;
    // samples there are not seen any more.
    double end(const vec3 &eye, const vec3 &direction, int x, int y) const;
    // The share of the sun that the map lets through.
    double lit(const vec3 &p) const;

  private:
    struct pool_shape {
        bool box;
        vec3 centre, half;
        double density, softness;
    };
    double by_height(double height) const;
    double of_shapes(const vec3 &p) const;
    double height_depth(const vec3 &p) const;
    double shapes_depth(const vec3 &p, double jitter) const;
    bool is_dark(int x, int y, double depth) const;

    const scene &scene_;
    vec3 sun_, zenith_;
    double base_, falloff_, far_; // voxels
    std::vector<pool_shape> shapes_;
    vec3 origin_, normal_;     // of the sun map's plane
    vec3 column_, row_;        // texels per voxel along the plane
    double range_, bias_;      // voxels
};

} // namespace reference

#endif
