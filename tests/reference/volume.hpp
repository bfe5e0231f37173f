// SPDX-License-Identifier: MIT
//
// Density at a position, and the way from world space to pool space.
//
// Pool space is in voxels; the centre of the first voxel is (0,0,0). Outside
// the pool the density is 0.
#ifndef BRUME_REFERENCE_VOLUME_HPP
#define BRUME_REFERENCE_VOLUME_HPP

#include "float_dump.hpp"
#include "vec3.hpp"

namespace reference {

enum class lookup { nearest, trilinear };

class volume {
public:
    // Clamps every voxel to [0, max_density]. Throws std::runtime_error when
    // the transform is not a uniform scale times a rotation.
    volume(float_dump dump, double max_density);

    double density(const vec3 &p, lookup filter) const;

    // Whether p is in the box beyond which both lookups give 0. It is convex:
    // a ray that has left it does not come back.
    bool contains(const vec3 &p) const;
    vec3 box_min() const;
    vec3 box_max() const;
    // Low and high corner of the voxels, from face to face, that are not 0.
    std::array<vec3, 2> occupied_box() const;

    const std::array<int, 3> &size() const { return dump_.size; }
    double voxel(int i, int j, int k) const; // 0 outside the pool

    vec3 pool_from_world(const vec3 &p) const;
    // The pool-space unit vector along a world-space direction.
    vec3 pool_direction(const vec3 &d) const;

private:
    double nearest(const vec3 &p) const;
    double trilinear(const vec3 &p) const;
    void gather(int i, int j, int k, double corner[8]) const;
    vec3 index_from_world_vector(const vec3 &v) const;

    float_dump dump_;
    size_t row_, slice_; // distance between voxels one apart in y, in z
};

} // namespace reference

#endif
