// SPDX-License-Identifier: MIT
//
// The second reader's view of the sections for light: MIPS, SUNC, AMBI, EMIT.

#include <cmath>

#include "spec_reader.hpp"

namespace reference
{

/// MIPS ///

// Bytes of levels 1 and 2 of a brick.
static const size_t brick_mip_bytes = 64 + 8;

ijk asset::mip_size(int level) const
{
    const ijk n = size();
    const int width = 1 << level;
    return {(n.x + width - 1) / width, (n.y + width - 1) / width,
            (n.z + width - 1) / width};
}

void asset::read_mips()
{
    const section *s = find("MIPS");
    if (!s)
        return;
    uint64_t bytes = brick_mip_bytes * uint64_t{bricks};
    int level = 3;
    for (; volume_of(mip_size(level)) > 1; level++)
        bytes += volume_of(mip_size(level));
    must(s->bytes == bytes + 1, "MIPS: wrong number of bytes");
    mips_at_ = s->offset;
    mip_levels_ = level;
}

int asset::mip_code(int level, const ijk &cube) const
{
    if (!inside_of(cube, mip_size(level)))
        return 0;
    size_t at = mips_at_;
    if (level < 3) { // in the cell's brick
        const int shift = 3 - level, n = 1 << shift;
        const ijk cell = {cube.x >> shift, cube.y >> shift, cube.z >> shift};
        const ijk in = {cube.x & (n - 1), cube.y & (n - 1), cube.z & (n - 1)};
        if (!occupied(cell))
            return 0;
        at += brick_mip_bytes * brick(cell) + (level == 1 ? 0 : 64);
        return bytes_[at + index_of(in, {n, n, n})];
    }
    at += brick_mip_bytes * bricks;
    for (int finer = 3; finer < level; finer++)
        at += volume_of(mip_size(finer));
    return bytes_[at + index_of(cube, mip_size(level))];
}

double asset::mip_density(int level, const ijk &cube) const
{
    const int q = mip_code(level, cube);
    return q * (q + 1) * density_max / 65280;
}

/// SUNC ///

void asset::read_sun()
{
    const section *s = find("SUNC");
    if (!s)
        return;
    must(s->bytes >= 32, "SUNC: no head");
    const size_t head = s->offset;
    const int log2 = bytes_[head];
    must(log2 >= 1 && log2 <= 3, "SUNC: spacing is none of 1, 2, 3");
    must(bytes_[head + 1] == 0 && u16(head + 2) == 0 && u32(head + 24) == 0 &&
             u32(head + 28) == 0,
         "SUNC: a zero field is not");
    const int spacing = 1 << log2;
    sun_points points = {
        spacing, mip_size(log2), {}, number(head + 16), head + 32};
    for (size_t i = 0; i < 3; i++)
        points.direction[i] =
            static_cast<int32_t>(u32(head + 4 + 4 * i)) / 1073741824.0;
    must(s->bytes == 32 + uint64_t{volume_of(points.size)},
         "SUNC: wrong number of bytes");
    sun = points;
}

int asset::sun_code(const ijk &point) const
{
    return bytes_[sun->at + index_of(point, sun->size)];
}

double asset::sun_depth(double code) const
{
    return sun->unit * (std::exp2(code / 24) - 1);
}

/// AMBI ///

void asset::read_sky()
{
    const section *s = find("AMBI");
    if (!s)
        return;
    must(s->bytes == 16 + uint64_t{cell_count()},
         "AMBI: wrong number of bytes");
    must(u32(s->offset + 8) == 0 && u32(s->offset + 12) == 0,
         "AMBI: a zero field is not");
    sky = sky_cells{number(s->offset), s->offset + 16};
}

double asset::sky_visibility(const ijk &cell) const
{
    return bytes_[sky->at + index_of(cell, cells)] / 255.0;
}

/// EMIT ///

void asset::read_emission()
{
    const section *s = find("EMIT");
    if (!s)
        return;
    must(s->bytes == 16 + 512 * uint64_t{bricks},
         "EMIT: wrong number of bytes");
    must(u32(s->offset + 8) == 0 && u32(s->offset + 12) == 0,
         "EMIT: a zero field is not");
    emission = emission_codes{number(s->offset), s->offset + 16};
}

int asset::emission_code(uint32_t brick, const ijk &voxel) const
{
    return bytes_[emission->at + size_t{512} * brick +
                  index_of(voxel, {8, 8, 8})];
}

int asset::emission_at(const ijk &voxel) const
{
    const ijk cell = {voxel.x >> 3, voxel.y >> 3, voxel.z >> 3};
    if (!emission || !inside(cell) || !occupied(cell))
        return 0;
    return emission_code(brick(cell), {voxel.x & 7, voxel.y & 7, voxel.z & 7});
}

double asset::emission_value(const ijk &voxel) const
{
    return emission_at(voxel) * emission->value / 255;
}

} // namespace reference
