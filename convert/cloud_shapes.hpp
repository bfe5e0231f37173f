// SPDX-License-Identifier: MIT
//
// The shapes that brume-cloud can make, as densities in [0, 1] at voxel
// centres. Index space: voxel centres at integers, Y up; the box holds the
// voxels [0, x) x [0, y) x [0, z).
#ifndef BRUME_CONVERT_CLOUD_SHAPES_HPP
#define BRUME_CONVERT_CLOUD_SHAPES_HPP

#include "noise3d.hpp"

#include <memory>
#include <vector>

namespace cloud
{

const int leaf_side = 8; // OpenVDB's leaf
const int leaf_voxels = leaf_side * leaf_side * leaf_side;

struct box_size {
    int x, y, z;
};

class shape
{
  public:
    virtual ~shape() = default;

    // Writes the densities of the leaf with the given low corner, z fastest,
    // as OpenVDB does. Returns false, and writes nothing, where a bound shows
    // that all are 0. Threads call this at once.
    virtual bool fill_leaf(vec3 corner, float *density) const = 0;
};

struct shape_type {
    const char *name;
    const char *help;
    float proportions[3];  // of the longest side, for --size N
    float stored_fraction; // of the box's voxels in leaves, at most
    std::unique_ptr<shape> (*make)(box_size size, uint32_t seed);
};

const std::vector<shape_type> &shape_types();

// Calls value(p) at each voxel centre of a leaf.
template <typename function>
void for_leaf(vec3 corner, float *density, function value)
{
    for (int i = 0; i < leaf_voxels; i++)
        density[i] = value(
            corner + vec3{float(i >> 6), float(i >> 3 & 7), float(i & 7)});
}

inline vec3 leaf_centre(vec3 corner)
{
    return corner + vec3{3.5f, 3.5f, 3.5f};
}

// Distance from a leaf's centre to its corner voxels, rounded up.
const float leaf_radius = 6.07f;

// To multiples of 2^-12: exact in float, far below what 8 bits can show, and
// with the low mantissa bytes 0, which Blosc stores in half the space.
inline float quantise(float density)
{
    return float(int(clamp01(density) * 4096 + 0.5f)) * (1.0f / 4096);
}

// 1 inside the box, falling to 0 just outside its outermost voxels over three
// voxels, less in small boxes: no shape is ever cut by its box.
float box_window(vec3 p, box_size size);

std::unique_ptr<shape> make_cumulus(box_size size, uint32_t seed);
std::unique_ptr<shape> make_plume(box_size size, uint32_t seed);
std::unique_ptr<shape> make_stratus(box_size size, uint32_t seed);
std::unique_ptr<shape> make_cirrus(box_size size, uint32_t seed);
std::unique_ptr<shape> make_fog(box_size size, uint32_t seed);

} // namespace cloud

#endif
