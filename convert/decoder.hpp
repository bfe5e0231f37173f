// SPDX-License-Identifier: MIT
//
// The densities of a finished pool, as docs/SPEC.md defines them: in units of
// density_max / 65280, 0 .. 65280.
#ifndef BRUME_CONVERT_DECODER_HPP
#define BRUME_CONVERT_DECODER_HPP

#include "bricks.hpp"
#include "brume.h"

namespace bake
{

class decoder
{
  public:
    decoder(const layout &l, const brick_pool &p)
        : l_(l), p_(p), bytes_(p.format.bytes())
    {
    }

    // Density of a unit.
    double unit() const
    {
        return double(p_.format.density_max) / BRUME_RANGE_TOP;
    }

    // The brick of a cell, or block_map::none: empty, or not in the pool.
    uint32_t brick_at(ijk cell) const
    {
        if (cell.x < 0 || cell.y < 0 || cell.z < 0 || cell.x >= l_.cells.x ||
            cell.y >= l_.cells.y || cell.z >= l_.cells.z)
            return block_map::none;
        const uint32_t word = p_.cells[l_.cell_index(cell)];
        return word & BRUME_CELL_EMPTY ? block_map::none : word;
    }

    // A voxel of a brick, 0 <= x, y, z < side.
    uint16_t voxel(uint32_t brick, int x, int y, int z) const
    {
        const uint8_t *b = &p_.bytes[brick * bytes_];
        const int side = p_.format.side;
        const int i = x + side * (y + side * z);

        if (p_.format.format == BRUME_U8)
            return uint16_t(256 * b[i]);
        const range r = p_.ranges[brick];
        const int q =
            p_.format.format == BRUME_U8R ? b[i] : b[i / 2] >> i % 2 * 4 & 15;
        return uint16_t(r.base + q * r.scale);
    }

    // A voxel of the pool, from its own cell: an apron repeats it, but for the
    // rounding of its own range. Outside there is nothing.
    uint16_t at(int x, int y, int z) const
    {
        const uint32_t brick = brick_at({floor8(x), floor8(y), floor8(z)});

        return brick == block_map::none ? uint16_t(0)
                                        : voxel(brick, x & 7, y & 7, z & 7);
    }

  private:
    const layout &l_;
    const brick_pool &p_;
    size_t bytes_;
};

} // namespace bake

#endif
