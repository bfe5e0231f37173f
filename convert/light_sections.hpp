// SPDX-License-Identifier: MIT
//
// The optional sections for light: what was asked for, what it takes, and
// what it became.
#ifndef BRUME_CONVERT_LIGHT_SECTIONS_HPP
#define BRUME_CONVERT_LIGHT_SECTIONS_HPP

#include "bricks.hpp"

namespace bake
{

struct light_request {
    bool mips = false;
    int sun_spacing = 0;       // voxels; 0: no sun cache
    double sun[2] = {0, 0};    // azimuth and elevation, degrees
    double sky_extinction = 0; // per unit of density and voxel; 0: no sky

    bool any() const
    {
        return mips || sun_spacing > 0 || sky_extinction > 0;
    }
};

// Bytes of each.
struct light_sizes {
    uint64_t mips = 0, sun = 0, sky = 0;

    uint64_t total() const
    {
        return mips + sun + sky;
    }
};

light_sizes sizes_of(const light_request &want, ijk cells, uint64_t bricks);

// As they are in the file; those not asked for are empty.
struct light_sections {
    std::vector<uint8_t> mips, sun, sky;

    light_sizes sizes() const
    {
        return {mips.size(), sun.size(), sky.size()};
    }
};

// `world` is the transform of the pool's level of detail.
light_sections make_light_sections(const light_request &want,
                                   const double world[12], const layout &l,
                                   const brick_pool &p, progress &bar);

} // namespace bake

#endif
