// SPDX-License-Identifier: MIT
//
// Which cells a pool has, which bricks are to be made of them, and in which
// order.
#include <algorithm>
#include <tbb/parallel_sort.h>

#include "bricks.hpp"
#include "brume.h"

namespace bake
{

namespace
{

// The low 12 bits of x, three apart. Cells per axis: < 2^12.
uint64_t spread(uint32_t x)
{
    uint64_t v = x & 0xfffu;

    v = (v | v << 16) & 0x0000ff0000ffu;
    v = (v | v << 8) & 0x00f00f00f00fu;
    v = (v | v << 4) & 0x0c30c30c30c3u;
    v = (v | v << 2) & 0x249249249249u;
    return v;
}

uint64_t order_key(const layout &l, brick_order order, ijk c)
{
    if (order == brick_order::linear)
        return l.cell_index(c);
    return spread(uint32_t(c.x)) | spread(uint32_t(c.y)) << 1 |
           spread(uint32_t(c.z)) << 2;
}

void check_limits(const box &tight, ijk cells)
{
    const int most = std::max({cells.x, cells.y, cells.z});
    const double bytes = 4.0 * cells.x * cells.y * cells.z;

    if (most > int(BRUME_MAX_CELLS))
        throw failure(text(
            "%lld x %lld x %lld voxels need %d x %d x %d cells; the format "
            "has at most %u per axis (try --lod)",
            (long long)tight.hi.x - tight.lo.x + 1,
            (long long)tight.hi.y - tight.lo.y + 1,
            (long long)tight.hi.z - tight.lo.z + 1, cells.x, cells.y, cells.z,
            BRUME_MAX_CELLS));
    if (bytes >= double(blob_limit))
        throw failure(text(
            "the grid of %d x %d x %d cells takes %.2f GiB; the format holds "
            "2 GiB (try --lod)",
            cells.x, cells.y, cells.z, bytes / 1073741824));
}

// The cells whose apron reaches into a block: the block's own, and those one
// below on any axes. The pool's lowest cells have none below: blocks there are
// zero where an apron could reach, and keys of cells outside would be those of
// others.
void add_apron_jobs(const volume &vol, const block_map &map,
                    uint32_t job::*which, layout &l)
{
    const ijk first = {floor8(l.origin.x), floor8(l.origin.y),
                       floor8(l.origin.z)};
    const size_t blocks = vol.blocks.size();

    for (size_t i = 0; i < 8 * blocks; i++) {
        const ijk b = vol.blocks[i / 8].cell;
        const ijk c = {b.x - int(i & 1), b.y - int(i >> 1 & 1),
                       b.z - int(i >> 2 & 1)};
        if (i % 8 != 0 && (map.at(c) != block_map::none || c.x < first.x ||
                           c.y < first.y || c.z < first.z))
            continue;
        job j = {{c.x - first.x, c.y - first.y, c.z - first.z},
                 block_map::none,
                 block_map::none,
                 0};
        j.*which = map.at(c);
        l.jobs.push_back(j);
    }
}

// A job for each block of a grid.
void add_jobs(const volume &vol, uint32_t job::*which, layout &l)
{
    for (size_t i = 0; i < vol.blocks.size(); i++) {
        const ijk c = vol.blocks[i].cell;
        job j = {{c.x - floor8(l.origin.x), c.y - floor8(l.origin.y),
                  c.z - floor8(l.origin.z)},
                 block_map::none,
                 block_map::none,
                 0};
        j.*which = uint32_t(i);
        l.jobs.push_back(j);
    }
}

// Sorts jobs by key and makes one of those of a cell, which know different
// blocks of it, or none.
void merge_jobs(std::vector<job> &jobs)
{
    size_t kept = 0;

    tbb::parallel_sort(
        jobs.begin(), jobs.end(),
        [](const job &a, const job &b) { return a.key < b.key; });
    for (const job &j : jobs) {
        if (kept == 0 || jobs[kept - 1].key != j.key) {
            jobs[kept++] = j;
            continue;
        }
        // `none` is the largest number
        job &last = jobs[kept - 1];
        last.block = std::min(last.block, j.block);
        last.glow = std::min(last.glow, j.glow);
    }
    jobs.resize(kept);
}

} // namespace

layout make_layout(const volume &vol, const emission_grid &glow,
                   const box &tight, int side, brick_order order)
{
    layout l;
    const ijk lo = tight.lo, hi = tight.hi;

    l.glow = glow.on ? &glow : nullptr;
    l.side = side;
    l.cells = {1, 1, 1};
    if (vol.blocks.empty() && (!glow.on || glow.vol.blocks.empty()))
        return l;

    // One voxel of zeros below and above: floor8(lo - 1) .. ceil8(hi + 2).
    const ijk first = {floor8(lo.x - 1), floor8(lo.y - 1), floor8(lo.z - 1)};
    l.origin = {first.x * 8, first.y * 8, first.z * 8};
    l.cells = {floor8(hi.x + 1) + 1 - first.x, floor8(hi.y + 1) + 1 - first.y,
               floor8(hi.z + 1) + 1 - first.z};
    check_limits(tight, l.cells);
    if (side == apron_side) {
        l.map = block_map(vol);
        l.glow_map = block_map(glow.vol);
        add_apron_jobs(vol, l.map, &job::block, l);
        add_apron_jobs(glow.vol, l.glow_map, &job::glow, l);
    } else {
        add_jobs(vol, &job::block, l);
        add_jobs(glow.vol, &job::glow, l);
    }
    for (job &j : l.jobs)
        j.key = order_key(l, order, j.cell);
    merge_jobs(l.jobs);
    return l;
}

} // namespace bake
