// SPDX-License-Identifier: MIT
//
// The AMBI section: how much of the sky each cell's middle sees.
#ifndef BRUME_CONVERT_SKY_VISIBILITY_HPP
#define BRUME_CONVERT_SKY_VISIBILITY_HPP

#include "density_field.hpp"

namespace bake
{

uint64_t sky_visibility_bytes(ijk cells);

// `extinction` is that of a density of 1 per voxel.
std::vector<uint8_t> make_sky_visibility(const density_field &field, ijk cells,
                                         double extinction, progress &bar);

} // namespace bake

#endif
