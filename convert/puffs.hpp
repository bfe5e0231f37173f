// SPDX-License-Identifier: MIT
//
// A cloud's bulk as a union of spheres with smaller spheres on their
// surfaces, and so on down: the hierarchy of Bouthors & Neyret 2004,
// "Modeling Clouds Shape". Lengths are in voxels.
#ifndef BRUME_CONVERT_PUFFS_HPP
#define BRUME_CONVERT_PUFFS_HPP

#include "noise3d.hpp"

#include <cstddef>
#include <vector>

namespace cloud
{

struct puff {
    vec3 centre;
    float radius;
};

struct box3 {
    vec3 low, high;
};

box3 puff_bounds(const std::vector<puff> &puffs);

struct sprout_rules {
    int tries;        // children tried per parent
    float shrink[2];  // child radius / parent radius, least and most
    float lift;       // 0 sprouts all around, 1 mostly upwards
    float min_radius; // children smaller than this are left out
};

// Adds one generation: children of puffs[first...] on the surface of the
// union. Each parent's children depend on (seed, its number) alone, so a
// finer grid only adds generations to the same cloud. Returns the number of
// the first child, which is the next generation's `first`.
size_t sprout(std::vector<puff> &puffs, size_t first, const sprout_rules &rules,
              uint32_t seed);

// Smooth minimum of distances a and b, rounded within k of the crease and
// exact elsewhere: culling what is farther than k changes nothing.
float smooth_min(float a, float b, float k);

// Signed distance to a smooth union of puffs, from lists per bin.
class puff_field
{
  public:
    // Distances are of use up to `reach`, and at least that beyond.
    puff_field(std::vector<puff> puffs, const box3 &domain, float reach);

    // A small puff fades out of the union one to three radii from its
    // surface, where its parent has taken over: this keeps the lists short.
    float distance(vec3 p) const;

  private:
    struct range3 {
        int low[3], high[3];
    };
    size_t bin_number(int x, int y, int z) const;
    int bin_along(float p, int axis) const;
    float range_of(const puff &q) const;
    range3 bins_near(const puff &q) const;

    std::vector<puff> puffs_;
    std::vector<uint32_t> bin_start_; // of each bin in members_, and the end
    std::vector<uint32_t> members_;   // puff numbers, rising in each bin
    float origin_[3];
    float pitch_ = 16;
    int count_[3];
    float reach_;
};

} // namespace cloud

#endif
