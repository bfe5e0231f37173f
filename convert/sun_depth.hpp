// SPDX-License-Identifier: MIT
//
// The SUNC section: optical depth towards a fixed sun.
#ifndef BRUME_CONVERT_SUN_DEPTH_HPP
#define BRUME_CONVERT_SUN_DEPTH_HPP

#include "density_field.hpp"

namespace bake
{

// The direction of azimuth and elevation, degrees in the world, in a pool with
// that transform.
direction sun_direction(const double angles[2], const double world[12]);

// `spacing` is 2, 4 or 8 voxels.
uint64_t sun_cache_bytes(ijk cells, int spacing);

std::vector<uint8_t> make_sun_cache(const density_field &field, ijk cells,
                                    int spacing, direction sun, progress &bar);

} // namespace bake

#endif
