// SPDX-License-Identifier: MIT
#include "emission.hpp"

#include <algorithm>
#include <cmath>

#include "resample.hpp"

namespace bake
{

namespace
{

constexpr double top_code = 255;

} // namespace

emission_grid halve(const emission_grid &in)
{
    emission_grid out;

    out.on = in.on;
    if (!in.on)
        return out;
    out.vol = halve(in.vol);
    out.m = measure(out.vol);
    out.max = in.max;
    return out;
}

void encode_emission(const float *values, int count, float max, uint8_t *codes)
{
    const double scale = max > 0 ? top_code / double(max) : 0;

    for (int i = 0; i < count; i++) {
        const double q = std::floor(double(values[i]) * scale + 0.5);
        codes[i] = uint8_t(std::min(q, top_code));
    }
}

emission_error error_of_emission(const float *values, const uint8_t *codes,
                                 float max)
{
    const double scale = max > 0 ? top_code / double(max) : 0;
    emission_error e;

    for (int i = 0; i < block_voxels; i++) {
        if (values[i] == 0)
            continue;
        const double d = codes[i] - double(values[i]) * scale;
        e.squared += d * d;
        e.worst = std::max(e.worst, std::fabs(d));
    }
    return e;
}

box box_of_both(const measures &density, const emission_grid &glow)
{
    if (density.voxels == 0)
        return glow.m.voxels == 0 ? box{{0, 0, 0}, {0, 0, 0}} : glow.m.tight;
    if (glow.m.voxels == 0)
        return density.tight;
    const box a = density.tight, b = glow.m.tight;
    return {{std::min(a.lo.x, b.lo.x), std::min(a.lo.y, b.lo.y),
             std::min(a.lo.z, b.lo.z)},
            {std::max(a.hi.x, b.hi.x), std::max(a.hi.y, b.hi.y),
             std::max(a.hi.z, b.hi.z)}};
}

} // namespace bake
