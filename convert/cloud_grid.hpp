// SPDX-License-Identifier: MIT
#ifndef BRUME_CONVERT_CLOUD_GRID_HPP
#define BRUME_CONVERT_CLOUD_GRID_HPP

#include "cloud_shapes.hpp"

#include <openvdb/openvdb.h>

#include <functional>
#include <string>

namespace cloud
{

// Evaluates a shape on `threads` threads. Voxels of density 0 are inactive
// background, leaves of one density become tiles. `progress` gets the part
// done, in [0, 1], from the calling thread. Values do not depend on
// `threads`.
openvdb::FloatGrid::Ptr make_grid(const shape &form, box_size size, int threads,
                                  const std::function<void(double)> &progress);

// Writes one grid as a seekable .vdb; throws std::runtime_error when not
// every byte reached the file.
void write_grid(const openvdb::FloatGrid::ConstPtr &grid,
                const std::string &path);

} // namespace cloud

#endif
