// SPDX-License-Identifier: MIT
//
// What reaches a sample: optical depth towards the sun, and the sky's light.
#ifndef BRUME_REFERENCE_LIGHT_HPP
#define BRUME_REFERENCE_LIGHT_HPP

#include <array>
#include <vector>

#include "mips.hpp"
#include "scene.hpp"
#include "vec3.hpp"
#include "volume.hpp"

namespace reference
{

class sun_light
{
  public:
    // Keeps references. `sun` points to it, in pool space.
    sun_light(const volume &v, const scene &s, const vec3 &sun);
    // By the scene's kind of light.
    double depth(const vec3 &p, double jitter) const;

  private:
    double log_depth(const vec3 &p, double jitter) const;
    double uniform_depth(const vec3 &p) const;
    double cone_depth(const vec3 &p, double jitter) const;
    struct segment {
        double start, end;
    };
    segment segment_of(int i) const;
    double cone_density(double length, const vec3 &p) const;

    const volume &volume_;
    const scene &scene_;
    vec3 sun_;
    int top_; // level of mips
    mips mips_;
};

// One for each ambient colour.
using ambient_sums = std::array<double, 6>;

class sky_light
{
  public:
    sky_light(const volume &v, const scene &s, const vec3 &zenith);
    // Adds lost * w_j * V of the sample at p.
    void add(const vec3 &p, double lost, ambient_sums &sums) const;
    // The sum of colours times sums.
    vec3 colour_of(const ambient_sums &sums) const;

  private:
    double height(const vec3 &p) const;
    double visibility(const vec3 &p, const vec3 &u) const;

    const volume &volume_;
    const scene &scene_;
    vec3 zenith_;
    double low_, high_; // ends of the volume's box along zenith
    std::vector<vec3> directions_;
};

} // namespace reference

#endif
