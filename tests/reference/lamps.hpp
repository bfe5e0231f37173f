// SPDX-License-Identifier: MIT
//
// Point and spot lights: docs/light.md, "All that a ray may meet" and "Lamps".
#ifndef BRUME_REFERENCE_LAMPS_HPP
#define BRUME_REFERENCE_LAMPS_HPP

#include <string>
#include <vector>

#include "air.hpp"
#include "scene.hpp"
#include "vec3.hpp"
#include "volume.hpp"

namespace reference
{

// A line `X,Y,Z RADIUS SIZE COLOUR [spot X,Y,Z INNER OUTER] [shadow N]` each.
// Throws std::runtime_error.
std::vector<lamp> read_lamps(const std::string &path);

class lamp_light
{
  public:
    // Keeps references.
    lamp_light(const volume &v, const scene &s, const air &a);
    // The sum over lamps of what a sample at p receives per channel, seen along
    // `ray`.
    vec3 at(const vec3 &p, const vec3 &ray, double jitter) const;

  private:
    struct placed { // in pool space
        lamp said;
        vec3 position, direction;
        double radius, size;
    };
    double through(const placed &l, const vec3 &p, double jitter) const;
    double share(const placed &l, const vec3 &p, const vec3 &ray,
                 double jitter) const;

    const volume &volume_;
    const scene &scene_;
    const air &air_;
    std::vector<placed> lamps_;
};

} // namespace reference

#endif
