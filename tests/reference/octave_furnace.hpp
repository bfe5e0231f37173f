// SPDX-License-Identifier: MIT
//
// The white furnace of octaves: radiance 1 comes from everywhere, which is the
// mean over all directions of the sun. A medium of albedo 1 must show 1, one
// that absorbs less; more is energy from nowhere.
#ifndef BRUME_REFERENCE_OCTAVE_FURNACE_HPP
#define BRUME_REFERENCE_OCTAVE_FURNACE_HPP

#include "medium.hpp"
#include "octaves.hpp"
#include "random.hpp"
#include "scene.hpp"

namespace reference
{

// One sample of a ray's radiance; their mean is without bias.
double octave_furnace(const medium &m, double scale, double albedo,
                      const phase_model &phase, const octave_model &model,
                      const ray &r, random_source &random);

// Over the pixels of the scene's picture that the medium covers: the mean, and
// the brightest.
struct furnace {
    double mean, top;
};
furnace furnace_of(const medium &m, const scene &s, const phase_model &phase,
                   double albedo, const octave_model &model);

// The brightest ray through the middle of homogeneous cubes of optical depth
// 1/8, 1/4, .. 64.
struct furnace_peak {
    double value, depth;
};
furnace_peak furnace_of_cubes(const phase_model &phase, double albedo,
                              const octave_model &model);

} // namespace reference

#endif
