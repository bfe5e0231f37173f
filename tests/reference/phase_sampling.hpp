// SPDX-License-Identifier: MIT
//
// Directions drawn from phase functions, for the Monte Carlo reference.
#ifndef BRUME_REFERENCE_PHASE_SAMPLING_HPP
#define BRUME_REFERENCE_PHASE_SAMPLING_HPP

#include "phase.hpp"
#include "random.hpp"
#include "vec3.hpp"

namespace reference
{

// A cosine with density phase_value / 2.
double sample_cosine(const phase_model &model, random_source &random);

// The way after a scattering, given the way before; unit vectors.
vec3 sample_way(const phase_model &model, const vec3 &way,
                random_source &random);

// Uniform over the sphere.
vec3 sample_sphere(random_source &random);

} // namespace reference

#endif
