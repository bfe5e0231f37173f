// SPDX-License-Identifier: MIT
//
// What a peer is asked to draw: the scene in the grid's index space, where a
// voxel's centre has whole coordinates and a length counts voxels.
#ifndef BRUME_BENCH_VIEW_HPP
#define BRUME_BENCH_VIEW_HPP

#include <cstddef>
#include <vector>

namespace bench
{

struct view {
    int width, height;
    double eye[3], ahead[3]; // ahead has length 1
    double right[3], up[3];  // as long as a pixel's side at distance 1
    double sun[3];           // unit, towards the sun
    double low[3], high[3];  // beyond this box every lookup is 0
    double step, light_step;
    double density_scale, light_density_scale;
    double albedo, min_density, min_transmittance;
    int light_samples;
    bool trilinear, uniform;
    // Of every pixel, 0 .. 1: the very values that the core uses.
    std::vector<float> jitter, light_jitter;
};

// Rows of a picture: strip after strip of strip_rows, of which every `part`th
// is drawn. A slow march then sees the same rays side by side as a whole frame
// has, but fewer.
struct strips {
    static const int strip_rows = 16;
    int part;
    bool has(int strip) const
    {
        return strip % part == part / 2;
    }

    // The rows that are drawn, of a picture.
    template <class pixel>
    std::vector<pixel> cut(const std::vector<pixel> &all, int width) const
    {
        std::vector<pixel> out;
        for (size_t i = 0; i < all.size(); i++)
            if (has(static_cast<int>(i) / width / strip_rows))
                out.push_back(all[i]);
        return out;
    }
};

} // namespace bench

#endif
