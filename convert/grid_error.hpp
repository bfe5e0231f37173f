// SPDX-License-Identifier: MIT
//
// How far an asset is from the voxels that it was made of, at any level of
// detail.
//
// Sums go over all voxels of the input's grid, also those that are zero where
// the asset has density, and are divided by the number of non-zero ones: a
// fixed number, so that errors of one input can be compared.
#ifndef BRUME_CONVERT_GRID_ERROR_HPP
#define BRUME_CONVERT_GRID_ERROR_HPP

#include "bricks.hpp"

namespace bake
{

struct read_error {
    double rmse = 0, mean = 0, worst = 0; // mean: asset minus input
};

struct grid_error {
    read_error nearest, trilinear;
};

// Reads the asset at the centre of every voxel of `in`, which has `voxels`
// non-zero ones. An asset's voxel is 2^lod voxels of `in` wide.
grid_error measure_grid_error(const volume &in, uint64_t voxels,
                              const layout &l, const brick_pool &p, int lod,
                              progress &bar);

// The sum of (v - mean)^2 over the voxels v of `fine`, `mean` being the voxel
// of `coarse` = halve(fine) that holds v.
double halving_loss(const volume &fine, const volume &coarse);

} // namespace bake

#endif
