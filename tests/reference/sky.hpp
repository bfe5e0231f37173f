// SPDX-License-Identifier: MIT
//
// What is behind the volume, and the curve from radiance to what is shown.
#ifndef BRUME_REFERENCE_SKY_HPP
#define BRUME_REFERENCE_SKY_HPP

#include "lighting.hpp"
#include "vec3.hpp"

namespace reference
{

// Brightest radiance of light, and of sky.
constexpr double max_light = 8;

// The sky in a direction whose cosines with the zenith and with the sun are
// given; exposure applied.
vec3 sky_colour(const lighting &l, double zenith_cosine, double sun_cosine);

// How much of the volume is left in front of the background.
double haze_share(const lighting &l, double mean_depth);

// A linear value as it is shown, 0..1.
double display_value(output_curve curve, double linear);

} // namespace reference

#endif
