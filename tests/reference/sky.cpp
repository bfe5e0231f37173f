// SPDX-License-Identifier: MIT

#include "sky.hpp"

#include <algorithm>
#include <cmath>

namespace reference
{

static const double radians = 3.14159265358979323846 / 180;

vec3 sky_colour(const lighting &l, double zenith_cosine, double sun_cosine)
{
    vec3 c = l.sky_ground;
    if (zenith_cosine >= 0) {
        const double low = std::pow(1 - zenith_cosine, 4);
        c = l.sky_zenith + (l.sky_horizon - l.sky_zenith) * low;
    }
    if (sun_cosine > std::cos(l.sun_size * radians))
        c = c + l.sun_disc;
    c = c * l.exposure;
    return {std::min(c.x, max_light), std::min(c.y, max_light),
            std::min(c.z, max_light)};
}

double haze_share(const lighting &l, double mean_depth)
{
    return l.haze > 0 ? std::exp(-mean_depth / l.haze) : 1;
}

// Narkowicz, "ACES Filmic Tone Mapping Curve", 2016.
static double filmic(double x)
{
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

// IEC 61966-2-1.
static double srgb(double x)
{
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

double display_value(output_curve curve, double linear)
{
    const double x = curve == output_curve::filmic ? filmic(linear) : linear;
    const double bounded = std::clamp(x, 0.0, 1.0);
    return curve == output_curve::linear ? bounded : srgb(bounded);
}

} // namespace reference
