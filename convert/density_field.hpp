// SPDX-License-Identifier: MIT
//
// The stored density between voxels, and its integral along rays.
#ifndef BRUME_CONVERT_DENSITY_FIELD_HPP
#define BRUME_CONVERT_DENSITY_FIELD_HPP

#include "bricks.hpp"

namespace bake
{

struct direction {
    double x, y, z; // unit length, pool space
};

class density_field
{
  public:
    // Throws `failure` when its voxels would not fit in memory.
    density_field(const layout &l, const brick_pool &p);

    // The integral of the density, trilinear between the stored voxels, from a
    // point in the pool to the pool's end, lengths in voxels. As exact as
    // doubles are.
    double depth(double x, double y, double z, direction d) const;

  private:
    // The cubes between 9^3 voxels: those of a cell, and the first ones of the
    // cells above it.
    struct corners {
        uint16_t units[9 * 9 * 9];
    };

    const corners *at(const int cell[3]) const
    {
        const uint32_t n =
            index_[size_t(cell[0]) +
                   size_t(cells_[0]) *
                       (size_t(cell[1]) + size_t(cells_[1]) * size_t(cell[2]))];

        return n == block_map::none ? nullptr : &corners_[n];
    }

    int cells_[3];
    double unit_; // density of a unit
    std::vector<uint32_t> index_;
    std::vector<corners> corners_;
};

} // namespace bake

#endif
