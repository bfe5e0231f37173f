// SPDX-License-Identifier: MIT
//
// The march: single scattering along a fixed lattice, in double.
#ifndef BRUME_REFERENCE_MARCH_HPP
#define BRUME_REFERENCE_MARCH_HPP

#include <vector>

#include "scene.hpp"
#include "vec3.hpp"
#include "volume.hpp"

namespace reference {

// Pixels x_min <= x < x_max, y_min <= y < y_max; row 0 on top.
struct rectangle {
    int x_min, y_min, x_max, y_max;
};

// Linear radiance, unclamped; row 0 on top, channels interleaved.
struct picture {
    int width, height, channels;
    std::vector<double> values;
};

struct ray {
    vec3 origin, direction; // pool space; the direction has length 1
};

// What a ray gathers before the background is added.
struct march_result {
    double radiance, transmittance;
};

class renderer {
public:
    // Keeps a reference to the volume, a copy of the scene.
    renderer(const volume &v, const scene &s);

    // The ray through the centre of pixel (x, y) of the whole picture.
    ray camera_ray(int x, int y) const;
    // Pool-space unit vector towards the sun.
    vec3 sun() const { return sun_; }
    march_result march(const ray &r, double jitter,
                       double light_jitter) const;
    march_result march_pixel(int x, int y) const;
    // Rows are shared out to the threads; each pixel is computed alone, so
    // that the number of threads does not show.
    picture render(const rectangle &area, int threads) const;

private:
    struct lattice_range {
        double first, last; // k, whole numbers; empty when first > last
    };
    lattice_range clip(const ray &r, double jitter) const;
    double sun_transmittance(const vec3 &p, double jitter) const;
    double log_depth(const vec3 &p, double jitter) const;
    double uniform_depth(const vec3 &p) const;
    double jitter_of(int x, int y, channel c) const;
    void render_row(int y, const rectangle &area, picture &out) const;

    const volume &volume_;
    const scene scene_;
    vec3 eye_, forward_, right_, up_, sun_; // pool space
    double pixel_;                          // its side at distance 1
};

} // namespace reference

#endif
