// SPDX-License-Identifier: MIT
//
// The volume as a participating medium: collisions and transmittance without
// bias, by null collisions under a majorant for each cube of voxels, and exact
// optical depths.
//
// Woodcock et al. 1965; Novak, Selle, Jarosz, "Residual Ratio Tracking for
// Estimating Attenuation in Participating Media", 2014.
#ifndef BRUME_REFERENCE_MEDIUM_HPP
#define BRUME_REFERENCE_MEDIUM_HPP

#include <vector>

#include "march.hpp"
#include "random.hpp"
#include "volume.hpp"

namespace reference
{

class medium
{
  public:
    // Keeps a reference to the volume.
    medium(const volume &v, lookup filter);

    // The way to the first collision in a medium of extinction `scale` per
    // voxel at density 1, or infinity.
    double collide(const ray &r, double scale, random_source &random) const;

    // An unbiased estimate of the transmittance to infinity, 0 .. 1.
    double ratio_track(const ray &r, double scale, random_source &random) const;

    // The integral of density along the ray: exact, as the field is constant
    // (nearest) or a cubic (trilinear) between the planes of its lattice.
    double depth(const ray &r) const;

    const volume &field() const
    {
        return volume_;
    }

    // Voxels on a side of the cubes that have a majorant.
    static constexpr int cube = 4;

  private:
    double majorant(const int cell[3]) const;
    double density(const vec3 &p) const
    {
        return volume_.density(p, filter_);
    }
    struct walk;

    const volume &volume_;
    const lookup filter_;
    int cubes_[3];
    std::vector<float> majorants_;
};

} // namespace reference

#endif
