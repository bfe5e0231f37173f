// SPDX-License-Identifier: MIT

#include "mips.hpp"

#include <cmath>

namespace reference
{

static size_t place(const std::array<int, 3> &size, int i, int j, int k)
{
    return static_cast<size_t>(i) +
           static_cast<size_t>(size[0]) *
               (static_cast<size_t>(j) +
                static_cast<size_t>(size[1]) * static_cast<size_t>(k));
}

// Cubes at the far faces may stick out of the pool, where the density is 0.
mips::grid mips::make_level(const volume &v, int level)
{
    const std::array<int, 3> n = v.size();
    grid out;
    for (size_t a = 0; a < 3; a++)
        out.size[a] = ((n[a] - 1) >> level) + 1;
    out.values.resize(voxel_count(out.size));
    for (int k = 0; k < n[2]; k++)
        for (int j = 0; j < n[1]; j++)
            for (int i = 0; i < n[0]; i++)
                out.values[place(out.size, i >> level, j >> level,
                                 k >> level)] += v.voxel(i, j, k);
    for (double &value : out.values)
        value = std::ldexp(value, -3 * level);
    return out;
}

mips::mips(const volume &v, int top)
{
    for (int level = 1; level <= top; level++)
        levels_.push_back(make_level(v, level));
}

double mips::mean(int level, const vec3 &p) const
{
    const grid &g = levels_[static_cast<size_t>(level - 1)];
    const double side = std::ldexp(1, level);
    const double cell[3] = {std::floor((p.x + 0.5) / side),
                            std::floor((p.y + 0.5) / side),
                            std::floor((p.z + 0.5) / side)};
    for (size_t a = 0; a < 3; a++)
        if (!(cell[a] >= 0 && cell[a] < g.size[a]))
            return 0;
    return g
        .values[place(g.size, static_cast<int>(cell[0]),
                      static_cast<int>(cell[1]), static_cast<int>(cell[2]))];
}

} // namespace reference
