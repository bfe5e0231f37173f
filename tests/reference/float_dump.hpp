// SPDX-License-Identifier: MIT
//
// The float dump of docs/SPEC.md: the voxels before quantisation.
#ifndef BRUME_REFERENCE_FLOAT_DUMP_HPP
#define BRUME_REFERENCE_FLOAT_DUMP_HPP

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace reference {

struct float_dump {
    std::array<int, 3> size{};    // voxels per axis
    std::array<int, 3> origin{};  // index-space position of voxel (0,0,0)
    std::array<double, 12> world_from_index{}; // rows of a 3x4 matrix
    std::vector<float> voxels;    // x fastest, then y, then z
};

inline size_t voxel_count(const std::array<int, 3> &size)
{
    return static_cast<size_t>(size[0]) * static_cast<size_t>(size[1]) *
           static_cast<size_t>(size[2]);
}

// Both throw std::runtime_error, naming the file and what is wrong with it.
// The reader refuses a file that is shorter or longer than its header says,
// and voxels that are not finite: the converter removes those.
float_dump read_float_dump(const std::string &path);
void write_float_dump(const std::string &path, const float_dump &dump);

} // namespace reference

#endif
