// SPDX-License-Identifier: MIT
//
// Reading: which grid of which file, and whether it can be a density.
#ifndef BRUME_CONVERT_SOURCE_HPP
#define BRUME_CONVERT_SOURCE_HPP

#include <openvdb/openvdb.h>

#include <string>
#include <vector>

#include "progress.hpp"
#include "volume.hpp"

namespace bake
{

struct source {
    std::string name, type, grid_class;
    std::string licence; // as the file has it, often not at all
    volume vol;
    bad_voxels bad;
    uint64_t active = 0;
    double background = 0;
    bool from_level_set = false;
    bool missing = false; // there is no such grid; then `name` is all there is
};

// There is no grid of that name.
class no_such_grid : public failure
{
  public:
    using failure::failure;
};

// What a grid may be for read_source() to succeed.
enum class grid_need {
    voxels, // it must be there, and have voxels
    nothing // it may have none, or be missing
};

// Read the density that `choice` names ("", a name, or "#index") from an
// OpenVDB or NanoVDB file. Throws `failure` with one line, or several with a
// list of grids when it is for the user to choose.
source read_source(const std::string &path, const std::string &choice,
                   bool level_set_to_fog, grid_need need, progress &bar);

// What the list of grids says of each.
struct grid_entry {
    std::string name, type, grid_class;
    uint64_t voxels;
};

// The index of the chosen grid.
size_t choose_grid(const std::vector<grid_entry> &grids,
                   const std::string &choice);

// source_nano.cpp: the same for a NanoVDB file, as an OpenVDB grid.
openvdb::GridBase::Ptr read_nano(const std::string &path,
                                 const std::string &choice);

} // namespace bake

#endif
