// SPDX-License-Identifier: MIT
//
// The march: light scattered along a fixed lattice, in double.
#ifndef BRUME_REFERENCE_MARCH_HPP
#define BRUME_REFERENCE_MARCH_HPP

#include <limits>
#include <vector>

#include "air.hpp"
#include "emission.hpp"
#include "lamps.hpp"
#include "light.hpp"
#include "scene.hpp"
#include "vec3.hpp"
#include "volume.hpp"

namespace reference
{

// Pixels x_min <= x < x_max, y_min <= y < y_max; row 0 on top.
struct rectangle {
    int x_min, y_min, x_max, y_max;
};

// Linear radiance; row 0 on top, channels interleaved.
struct picture {
    int width, height, channels;
    std::vector<double> values;
};

struct ray {
    vec3 origin, direction; // pool space; the direction has length 1
};

// What a ray gathers before the background is added; haze is applied.
struct march_result {
    double radiance; // red: all there is to white light
    double transmittance;
    vec3 colour;
};

class renderer
{
  public:
    // Keeps a reference to the volume, a copy of the scene; `glow` must stay.
    renderer(const volume &v, const scene &s, const emission *glow = nullptr);
    renderer(const renderer &) = delete;

    // The ray through the centre of pixel (x, y) of the whole picture.
    ray camera_ray(int x, int y) const;
    // Pool-space unit vector towards the sun.
    vec3 sun() const
    {
        return sun_;
    }
    // Until t = end, in voxels.
    march_result
    march(const ray &r, double jitter, double light_jitter,
          double end = std::numeric_limits<double>::infinity()) const;
    march_result march_pixel(int x, int y) const;
    // What a ray that meets nothing sees.
    vec3 background(const ray &r) const;
    // Rows are shared out to the threads; each pixel is computed alone, so
    // that the number of threads does not show.
    picture render(const rectangle &area, int threads) const;

  private:
    struct lattice_range {
        double first, last; // k, whole numbers; empty when first > last
    };
    // Sums over the samples of a ray; lost = T * (1 - exp(-tau)) of each.
    struct ray_sums {
        double transmittance = 1;
        double sun[8] = {};  // A_i
        ambient_sums sky{};  // B_j
        vec3 lamps{0, 0, 0}; // C_c
        vec3 glow{0, 0, 0};  // E_c
        double moment = 0;   // of lost, over distance
    };
    lattice_range clip(const ray &r, double jitter, double end) const;
    void add_sun(double lost, const vec3 &p, double jitter,
                 ray_sums &sums) const;
    double in_scattering(const ray &r, const ray_sums &sums) const;
    bool add_sample(const vec3 &p, const vec3 &direction, double t,
                    double light_jitter, double lamp_jitter,
                    ray_sums &sums) const;
    march_result finish(const ray &r, const ray_sums &sums) const;
    double jitter_of(int x, int y, channel c) const;
    void render_row(int y, const rectangle &area, picture &out) const;

    const volume &volume_;
    const scene scene_;
    const emission *glow_;                           // or null
    vec3 eye_, forward_, right_, up_, sun_, zenith_; // pool space
    double pixel_;                                   // its side at distance 1
    sun_light sun_light_;
    sky_light sky_light_;
    air air_;
    lamp_light lamp_light_;
};

} // namespace reference

#endif
