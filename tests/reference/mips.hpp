// SPDX-License-Identifier: MIT
//
// Means of the voxels over cubes of 2^m voxels, what `light = cone` reads.
#ifndef BRUME_REFERENCE_MIPS_HPP
#define BRUME_REFERENCE_MIPS_HPP

#include <array>
#include <vector>

#include "volume.hpp"

namespace reference
{

class mips
{
  public:
    // Levels 1 .. top, from the voxels at once, not from one another.
    mips(const volume &v, int top);

    // Of the cube of level 1 .. top that holds the voxel nearest to p; 0
    // outside the pool.
    double mean(int level, const vec3 &p) const;

  private:
    struct grid {
        std::array<int, 3> size;
        std::vector<double> values; // x fastest
    };
    static grid make_level(const volume &v, int level);
    std::vector<grid> levels_;
};

} // namespace reference

#endif
