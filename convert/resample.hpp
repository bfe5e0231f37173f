// SPDX-License-Identifier: MIT
//
// Changes of resolution: level of detail, and the resampling of grids whose
// voxels are not cubes.
#ifndef BRUME_CONVERT_RESAMPLE_HPP
#define BRUME_CONVERT_RESAMPLE_HPP

#include "volume.hpp"

namespace bake
{

// Half the resolution: new voxel i is the mean of the old 2i and 2i + 1 on
// each axis, so that the transform gains a factor of 2 and half an old voxel.
volume halve(const volume &in);

// Is the transform a rotation times one voxel size?
bool is_uniform(const volume &vol);

// Trilinear resampling to the index space of another transform, `world`.
volume resample_to(const volume &in, const double world[12]);

// Do two transforms put each voxel at the same place, to 1 part in 10^4 of a
// voxel at index 0 and in 10^6 of its axes?
bool same_transform(const double a[12], const double b[12]);

// Trilinear resampling to cubes as wide as the smallest voxel. The axes stay
// when they are at right angles (then only stretched axes are interpolated),
// else those of the world are taken. Index 0 stays where it is.
volume make_uniform(const volume &in);

} // namespace bake

#endif
