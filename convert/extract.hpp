// SPDX-License-Identifier: MIT
//
// From an OpenVDB grid to a volume.
#ifndef BRUME_CONVERT_EXTRACT_HPP
#define BRUME_CONVERT_EXTRACT_HPP

#include <openvdb/openvdb.h>

#include "progress.hpp"
#include "volume.hpp"

namespace bake
{

struct extracted {
    volume vol;
    bad_voxels bad;
    uint64_t active = 0; // active voxels; without any there is no volume
    double background = 0;
};

// Is it one of the types that extract() takes? If not, a word for what it is.
bool is_scalar(const std::string &grid_type);

// The volume is the box of the grid's active voxels. In it, every voxel has
// the value that the grid gives for it, active or not: leaves, tiles and
// background alike. Outside it there is nothing. Leaves are taken out of the
// grid as they are read, so that memory holds about one copy of the voxels.
extracted extract(openvdb::GridBase &grid, progress &bar);

} // namespace bake

#endif
