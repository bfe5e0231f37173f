// SPDX-License-Identifier: MIT
//
// The MIPS section: means of the stored densities over cubes of 2^m voxels.
#ifndef BRUME_CONVERT_MIPS_HPP
#define BRUME_CONVERT_MIPS_HPP

#include "bricks.hpp"

namespace bake
{

uint64_t mip_bytes(ijk cells, uint64_t bricks);

std::vector<uint8_t> make_mips(const layout &l, const brick_pool &p);

} // namespace bake

#endif
