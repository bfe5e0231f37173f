// SPDX-License-Identifier: MIT
//
// A sparse volume of clean float densities: what every source becomes, and
// all that the stages after it know of the input.
#ifndef BRUME_CONVERT_VOLUME_HPP
#define BRUME_CONVERT_VOLUME_HPP

#include <cstddef>
#include <memory>
#include <vector>

#include "bake.hpp"

namespace bake
{

constexpr int block_side = 8;
constexpr int block_voxels = 512;

// 8x8x8 voxels, x fastest, then y, then z. `cell` is the index coordinate of
// the first voxel divided by 8. A null `voxels` means that all are `value`.
struct block {
    ijk cell;
    float value;
    const float *voxels;
};

// Voxels that were set to 0 because no density can be that.
struct bad_voxels {
    uint64_t nan = 0, infinite = 0, negative = 0;

    uint64_t total() const
    {
        return nan + infinite + negative;
    }
};

struct volume {
    // Rows of the 3x4 matrix from index space to world space.
    double world[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    // Each cell at most once, in any order; what is not there is 0.
    std::vector<block> blocks;
    // Owns what the blocks point to.
    std::vector<std::unique_ptr<float[]>> chunks;

    // Keeps the transform.
    void drop_voxels()
    {
        blocks.clear();
        chunks.clear();
    }
};

// Figures over the non-zero voxels.
struct measures {
    box tight = {{0, 0, 0}, {0, 0, 0}}; // smallest around them, index space
    float max = 0;                      // 0: there are none
    double mean = 0;
    uint64_t voxels = 0;
};

// Room for `count` blocks of voxels, owned by the volume, not initialised:
// pages that stay unused cost no memory.
float *new_chunk(volume &vol, size_t count);

// Sort the blocks by z, y, x and drop those without a positive voxel. Sums
// are taken in that order, so equal voxels give equal figures however they
// were stored.
measures measure(volume &vol);

// Limit every voxel to `top`.
void clamp(volume &vol, float top);

// The voxels of a block: its own, or `scratch` (512 floats) filled.
const float *expand(const block &b, float *scratch);

// Ask for a block's voxels ahead of their use: in any order but that of the
// file, blocks lie too scattered for the processor to foresee.
inline void prefetch(const block &b)
{
    constexpr int line = 64 / int(sizeof(float));

    for (int i = 0; b.voxels != nullptr && i < block_voxels; i += line)
        __builtin_prefetch(b.voxels + i);
}

// From a cell to its block: a dense table over the box of all cells.
class block_map
{
  public:
    static constexpr uint32_t none = UINT32_MAX;

    block_map() = default;
    // Throws `failure` when the table would not fit in memory.
    explicit block_map(const volume &vol);

    uint32_t at(ijk cell) const
    {
        const uint32_t x = uint32_t(cell.x) - uint32_t(lo_.x);
        const uint32_t y = uint32_t(cell.y) - uint32_t(lo_.y);
        const uint32_t z = uint32_t(cell.z) - uint32_t(lo_.z);

        if (x >= nx_ || y >= ny_ || z >= nz_)
            return none;
        return table_[x + nx_ * (y + size_t(ny_) * z)];
    }

  private:
    ijk lo_ = {0, 0, 0};
    uint32_t nx_ = 0, ny_ = 0, nz_ = 0;
    std::vector<uint32_t> table_;
};

} // namespace bake

#endif
