// SPDX-License-Identifier: MIT
//
// From a volume to cells and bricks: which cells there are, in which order
// their bricks are numbered, and the sharing of identical bricks.
#ifndef BRUME_CONVERT_BRICKS_HPP
#define BRUME_CONVERT_BRICKS_HPP

#include <cmath>
#include <vector>

#include "emission.hpp"
#include "progress.hpp"
#include "quantise.hpp"
#include "volume.hpp"

namespace bake
{

// The format's blob is a u32 of bytes; half of that leaves readers free to
// use signed offsets.
constexpr uint64_t blob_limit = uint64_t(1) << 31;

// One brick to make. `block` and `glow`, of the density and of the emission,
// are block_map::none where a cell has none: it is all zero but for the other
// grid or an apron.
struct job {
    ijk cell; // pool cell, from 0
    uint32_t block, glow;
    uint64_t key; // bricks are numbered by it
};

enum class brick_order { morton, linear };

// The cells of the pool, and the bricks to make in the order of numbering.
struct layout {
    ijk origin = {0, 0, 0}; // index coordinates of the pool's first voxel
    ijk cells = {0, 0, 0};
    int side = block_side;
    std::vector<job> jobs;
    block_map map, glow_map;             // for the apron only
    const emission_grid *glow = nullptr; // must stay, if there is one

    size_t cell_count() const
    {
        return size_t(cells.x) * size_t(cells.y) * size_t(cells.z);
    }
    size_t cell_index(ijk c) const
    {
        return size_t(c.x) +
               size_t(cells.x) * (size_t(c.y) + size_t(cells.y) * size_t(c.z));
    }
};

// Cells are aligned to the 8^3 blocks of the volume; a layer of voxels around
// the tight box (of both grids) is kept zero. Without any voxel there is one
// cell. Throws `failure` with the figures when there are more cells than the
// format can index.
layout make_layout(const volume &vol, const emission_grid &glow,
                   const box &tight, int side, brick_order order);

// Quantisation error over the non-zero voxels, in the density's own unit.
struct quantisation_error {
    double rmse = 0, worst = 0;
};

struct brick_pool {
    brick_format format = {};
    std::vector<uint32_t> cells; // the CELL section
    std::vector<uint8_t> bytes;  // the POOL section
    std::vector<range> ranges;   // the RNGE section, empty in u8
    bool glows = false;          // is there a section EMIT?
    std::vector<uint8_t> codes;  // of it
    uint64_t bricks = 0;
    uint64_t occupied = 0; // cells that refer to a brick
    quantisation_error error;
    quantisation_error glow_error; // of the emission
};

// What a pool must keep to. `bytes` counts cells, bricks and ranges.
struct brick_limits {
    quantisation_error error = {INFINITY, INFINITY};
    uint64_t bytes = UINT64_MAX;
};

// Bytes of the sections that a pool makes so far.
uint64_t pool_bytes(const brick_pool &pool);

// Quantise all bricks, share identical ones, fill in the distances. Errors and
// bytes only add up: as soon as one passes its limit this returns false, with
// the figures so far in `pool` and nothing else of use.
bool make_bricks(const volume &vol, const measures &m, const layout &l,
                 const brick_format &f, const brick_limits &limit,
                 progress &bar, brick_pool &pool);

// Write the Chebyshev distance to the nearest occupied cell, up to 255, into
// each empty cell.
void fill_distances(std::vector<uint32_t> &cells, ijk size);

} // namespace bake

#endif
