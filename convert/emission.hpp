// SPDX-License-Identifier: MIT
//
// The second grid of an asset, its EMIT section: what the volume glows by.
#ifndef BRUME_CONVERT_EMISSION_HPP
#define BRUME_CONVERT_EMISSION_HPP

#include "volume.hpp"

namespace bake
{

// Bytes before the codes, and of a brick's codes, which have no apron.
constexpr size_t emission_head = 16;

struct emission_grid {
    bool on = false; // else the asset has no such section
    volume vol;      // in the index space of the density
    measures m;
    float max = 0; // what code 255 stands for; 0: all is 0
};

// As halve().
emission_grid halve(const emission_grid &in);

// The codes of `count` values in [0, max]. Zero stays exactly zero.
void encode_emission(const float *values, int count, float max, uint8_t *codes);

// Over the non-zero voxels of a brick, in units of a code: the sum of squared
// errors, and the worst.
struct emission_error {
    double squared = 0, worst = 0;
};
emission_error error_of_emission(const float *values, const uint8_t *codes,
                                 float max);

// The tight box around both grids' voxels.
box box_of_both(const measures &density, const emission_grid &glow);

} // namespace bake

#endif
