// SPDX-License-Identifier: MIT
//
// gcc's -O2 leaves most of these loops to the scalar unit, and so do
// floating-point exceptions, which nobody asks for.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("O3", "no-trapping-math")
#endif
#include "volume.hpp"

#include <algorithm>
#include <climits>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

namespace bake
{

namespace
{

struct block_measures {
    double sum = 0;
    float max = 0;
    uint16_t voxels = 0;
    uint8_t xs = 0, ys = 0, zs = 0; // bit i: a non-zero voxel at i
};

block_measures measure_uniform(float value)
{
    block_measures m;

    if (value > 0) {
        // Exact, hence equal to the sum of 512 stored voxels: every partial
        // sum needs at most 24 + 9 bits.
        m.sum = double(value) * block_voxels;
        m.max = value;
        m.voxels = block_voxels;
        m.xs = m.ys = m.zs = 0xff;
    }
    return m;
}

// Is any of a row of 8 above 0?
bool any(const float *row)
{
    float most = 0;

    for (int x = 0; x < block_side; x++)
        most = std::max(most, row[x]);
    return most > 0;
}

// By columns of equal x, which compilers turn into vectors: what goes along a
// row is left for the end.
block_measures measure_voxels(const float *v)
{
    block_measures m;
    double sum[block_side] = {};
    float max[block_side] = {};
    float of_y[block_side][block_side] = {}, of_z[block_side][block_side] = {};
    int used[block_side] = {};

    for (int row = 0; row < 64; row++, v += block_side) {
        float *my = of_y[row % 8], *mz = of_z[row / 8];
#pragma GCC unroll 1
        for (int x = 0; x < block_side; x++) {
            sum[x] += double(v[x]);
            used[x] += v[x] > 0;
            my[x] = v[x] > my[x] ? v[x] : my[x];
            mz[x] = v[x] > mz[x] ? v[x] : mz[x];
        }
    }
    for (int i = 0; i < block_side; i++) {
        m.ys |= uint8_t(any(of_y[i]) << i);
        m.zs |= uint8_t(any(of_z[i]) << i);
        for (int x = 0; x < block_side; x++)
            max[x] = std::max(max[x], of_y[i][x]);
    }
    for (int x = 0; x < block_side; x++) {
        m.sum += sum[x];
        m.max = std::max(m.max, max[x]);
        m.voxels = uint16_t(m.voxels + used[x]);
        m.xs |= uint8_t((used[x] > 0) << x);
    }
    return m;
}

bool before(const block &a, const block &b)
{
    if (a.cell.z != b.cell.z)
        return a.cell.z < b.cell.z;
    return a.cell.y != b.cell.y ? a.cell.y < b.cell.y : a.cell.x < b.cell.x;
}

// Widen lo..hi by the bits of one axis of a block at `cell`.
void widen(int32_t &lo, int32_t &hi, int32_t cell, unsigned bits)
{
    const int32_t first = cell * block_side + __builtin_ctz(bits);
    const int32_t last = cell * block_side + 31 - __builtin_clz(bits);

    lo = std::min(lo, first);
    hi = std::max(hi, last);
}

} // namespace

float *new_chunk(volume &vol, size_t count)
{
    vol.chunks.emplace_back(new float[count * block_voxels]);
    return vol.chunks.back().get();
}

const float *expand(const block &b, float *scratch)
{
    if (b.voxels != nullptr)
        return b.voxels;
    std::fill_n(scratch, block_voxels, b.value);
    return scratch;
}

measures measure(volume &vol)
{
    measures m;
    double sum = 0;
    size_t kept = 0;
    ijk lo = {INT_MAX, INT_MAX, INT_MAX}, hi = {INT_MIN, INT_MIN, INT_MIN};

    tbb::parallel_sort(vol.blocks.begin(), vol.blocks.end(), before);
    std::vector<block_measures> each(vol.blocks.size());
    tbb::parallel_for(size_t(0), each.size(), [&](size_t i) {
        const block &b = vol.blocks[i];
        if (i + 1 < each.size())
            prefetch(vol.blocks[i + 1]);
        each[i] =
            b.voxels ? measure_voxels(b.voxels) : measure_uniform(b.value);
    });
    for (size_t i = 0; i < each.size(); i++) {
        const block &b = vol.blocks[i];
        if (each[i].voxels == 0)
            continue;
        widen(lo.x, hi.x, b.cell.x, each[i].xs);
        widen(lo.y, hi.y, b.cell.y, each[i].ys);
        widen(lo.z, hi.z, b.cell.z, each[i].zs);
        sum += each[i].sum;
        m.max = std::max(m.max, each[i].max);
        m.voxels += each[i].voxels;
        vol.blocks[kept++] = b;
    }
    vol.blocks.resize(kept);
    if (m.voxels > 0)
        m.tight = {lo, hi};
    m.mean = m.voxels ? sum / double(m.voxels) : 0;
    return m;
}

void clamp(volume &vol, float top)
{
    tbb::parallel_for(size_t(0), vol.blocks.size(), [&](size_t i) {
        block &b = vol.blocks[i];
        // The chunks are ours: only readers are kept from writing.
        float *v = const_cast<float *>(b.voxels);
        b.value = std::min(b.value, top);
        for (int k = 0; v != nullptr && k < block_voxels; k++)
            v[k] = std::min(v[k], top);
    });
}

block_map::block_map(const volume &vol)
{
    if (vol.blocks.empty())
        return;
    ijk lo = vol.blocks[0].cell, hi = lo;
    for (const block &b : vol.blocks) {
        lo.x = std::min(lo.x, b.cell.x);
        lo.y = std::min(lo.y, b.cell.y);
        lo.z = std::min(lo.z, b.cell.z);
        hi.x = std::max(hi.x, b.cell.x);
        hi.y = std::max(hi.y, b.cell.y);
        hi.z = std::max(hi.z, b.cell.z);
    }
    lo_ = lo;
    nx_ = uint32_t(hi.x - lo.x) + 1;
    ny_ = uint32_t(hi.y - lo.y) + 1;
    nz_ = uint32_t(hi.z - lo.z) + 1;
    require_memory(4.0 * nx_ * ny_ * nz_, "the table of cells");
    table_.assign(size_t(nx_) * ny_ * nz_, uint32_t(none));
    for (size_t i = 0; i < vol.blocks.size(); i++) {
        const ijk c = vol.blocks[i].cell;
        table_[uint32_t(c.x - lo.x) +
               nx_ * (uint32_t(c.y - lo.y) +
                      size_t(ny_) * uint32_t(c.z - lo.z))] = uint32_t(i);
    }
}

} // namespace bake
