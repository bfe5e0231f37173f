// SPDX-License-Identifier: MIT
#include "grid_error.hpp"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

#include "decoder.hpp"

namespace bake
{

namespace
{

// Asset voxels that the trilinear reads of 8 input voxels touch on one axis,
// at most: 9 at level 0.
constexpr int patch_side = 9;

struct sums {
    double squared = 0, signed_sum = 0, worst = 0;

    void add(double e)
    {
        squared += e * e;
        signed_sum += e;
        worst = std::max(worst, std::fabs(e));
    }
    void add(const sums &s)
    {
        squared += s.squared;
        signed_sum += s.signed_sum;
        worst = std::max(worst, s.worst);
    }
    read_error over(uint64_t voxels) const
    {
        const double n = double(voxels);

        return {std::sqrt(squared / n), signed_sum / n, worst};
    }
};

struct both_sums {
    sums nearest, trilinear;
};

// Where 8 input voxels in a row lie among the asset's: `first` and `count` of
// the asset voxels around them, and for each of the 8 the nearest one and the
// lower of two with the weight of the upper, counted from `first`.
struct axis_reads {
    int first, count;
    int nearest[8], lower[8];
    double weight[8];
};

axis_reads reads_along(int at, int lod)
{
    axis_reads r;
    const double width = std::ldexp(1.0, lod), shift = (width - 1) / 2;

    r.first = int(std::floor((at - shift) / width));
    for (int i = 0; i < 8; i++) {
        const double p = (at + i - shift) / width, lower = std::floor(p);
        r.lower[i] = int(lower) - r.first;
        r.weight[i] = p - lower;
        r.nearest[i] = ((at + i) >> lod) - r.first;
    }
    r.count = r.lower[7] + 1 + (r.weight[7] > 0);
    r.count = std::max(r.count, r.nearest[7] + 1);
    return r;
}

// The asset's voxels around one 8^3 block of the input.
struct patch {
    axis_reads x, y, z;
    double density[patch_side][patch_side][patch_side];

    // Returns false when all are 0.
    bool fetch(const decoder &asset, ijk origin)
    {
        const double unit = asset.unit();
        bool used = false;

        for (int k = 0; k < z.count; k++)
            for (int j = 0; j < y.count; j++)
                for (int i = 0; i < x.count; i++) {
                    density[k][j][i] = unit * asset.at(x.first + i - origin.x,
                                                       y.first + j - origin.y,
                                                       z.first + k - origin.z);
                    used = used || density[k][j][i] > 0;
                }
        return used;
    }

    double nearest(int i, int j, int k) const
    {
        return density[z.nearest[k]][y.nearest[j]][x.nearest[i]];
    }

    // Weights of 0 keep the upper voxel from being read: it may be outside.
    double along_x(int k, int j, int i) const
    {
        const double *row = &density[k][j][x.lower[i]];
        const double w = x.weight[i];

        return w > 0 ? row[0] + w * (row[1] - row[0]) : row[0];
    }
    double along_xy(int k, int j, int i) const
    {
        const double w = y.weight[j], a = along_x(k, y.lower[j], i);

        return w > 0 ? a + w * (along_x(k, y.lower[j] + 1, i) - a) : a;
    }
    double trilinear(int i, int j, int k) const
    {
        const double w = z.weight[k], a = along_xy(z.lower[k], j, i);

        return w > 0 ? a + w * (along_xy(z.lower[k] + 1, j, i) - a) : a;
    }
};

// Adds one block of the input, `voxels` being null where it has none.
void add_block(const patch &p, const float *voxels, both_sums &s)
{
    for (int k = 0; k < 8; k++)
        for (int j = 0; j < 8; j++)
            for (int i = 0; i < 8; i++) {
                const int n = i + 8 * j + 64 * k;
                const double v = voxels ? double(voxels[n]) : 0;
                s.nearest.add(p.nearest(i, j, k) - v);
                s.trilinear.add(p.trilinear(i, j, k) - v);
            }
}

// A row of the input's blocks along x, the row `n` of the asset's pool.
both_sums add_row(const volume &in, const block_map &map, const layout &l,
                  const decoder &asset, int lod, size_t n)
{
    const int y_blocks = l.cells.y << lod;
    const int first = (l.origin.x >> 3) * (1 << lod);
    const ijk c = {first, (l.origin.y >> 3) * (1 << lod) + int(n) % y_blocks,
                   (l.origin.z >> 3) * (1 << lod) + int(n) / y_blocks};
    float scratch[block_voxels];
    both_sums s;
    patch p;

    p.y = reads_along(8 * c.y, lod);
    p.z = reads_along(8 * c.z, lod);
    for (int x = first; x < first + (l.cells.x << lod); x++) {
        const uint32_t b = map.at({x, c.y, c.z});
        p.x = reads_along(8 * x, lod);
        if (!p.fetch(asset, l.origin) && b == block_map::none)
            continue;
        add_block(
            p, b == block_map::none ? nullptr : expand(in.blocks[b], scratch),
            s);
    }
    return s;
}

// The part of the loss in one block of `coarse`.
double loss_in(const volume &fine, const block_map &map, const block &coarse)
{
    float own[block_voxels], scratch[block_voxels];
    const float *mean = expand(coarse, own);
    double sum = 0;

    for (int child = 0; child < 8; child++) {
        const ijk at = {child & 1, child >> 1 & 1, child >> 2};
        const uint32_t b =
            map.at({2 * coarse.cell.x + at.x, 2 * coarse.cell.y + at.y,
                    2 * coarse.cell.z + at.z});
        const float *v =
            b == block_map::none ? nullptr : expand(fine.blocks[b], scratch);
        for (int i = 0; i < block_voxels; i++) {
            const int parent = (4 * at.x + (i & 7) / 2) +
                               8 * (4 * at.y + (i >> 3 & 7) / 2) +
                               64 * (4 * at.z + (i >> 6) / 2);
            const double e = (v ? double(v[i]) : 0) - double(mean[parent]);
            sum += e * e;
        }
    }
    return sum;
}

} // namespace

// Every row has sums of its own, added up in order: the same for any number
// of threads.
grid_error measure_grid_error(const volume &in, uint64_t voxels,
                              const layout &l, const brick_pool &p, int lod,
                              progress &bar)
{
    const block_map map(in);
    const decoder asset(l, p);
    const size_t rows = (size_t(l.cells.y) << lod) * (size_t(l.cells.z) << lod);
    std::vector<both_sums> each(rows);
    both_sums all;

    bar.stage("compare", rows);
    tbb::parallel_for(size_t(0), rows, [&](size_t n) {
        each[n] = add_row(in, map, l, asset, lod, n);
        bar.advance(1);
    });
    for (const both_sums &s : each) {
        all.nearest.add(s.nearest);
        all.trilinear.add(s.trilinear);
    }
    return {all.nearest.over(voxels), all.trilinear.over(voxels)};
}

double halving_loss(const volume &fine, const volume &coarse)
{
    const block_map map(fine);
    std::vector<double> each(coarse.blocks.size());
    double sum = 0;

    tbb::parallel_for(size_t(0), each.size(), [&](size_t i) {
        each[i] = loss_in(fine, map, coarse.blocks[i]);
    });
    for (const double e : each)
        sum += e;
    return sum;
}

} // namespace bake
