// SPDX-License-Identifier: MIT
//
// The sections for light against what SPEC.md says is in them. Integrals are
// sums of small steps through the voxels: slow, and with nothing in common
// with the converter's.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "findings.hpp"

namespace reference
{

namespace
{

using vec = std::array<double, 3>;

const double ray_step = 1.0 / 16; // voxels

// All voxels, in units of density_max / 65280.
class voxel_grid
{
  public:
    explicit voxel_grid(const asset &a) : size_(a.size())
    {
        units_.resize(volume_of(size_));
        for (size_t i = 0; i < units_.size(); i++)
            units_[i] = a.units_at(ijk_of(i, size_)).value;
    }

    const ijk &size() const
    {
        return size_;
    }

    double at(const ijk &v) const
    {
        return inside_of(v, size_) ? units_[index_of(v, size_)] : 0;
    }

    double trilinear(const vec &p) const
    {
        const ijk low = {static_cast<int>(std::floor(p[0])),
                         static_cast<int>(std::floor(p[1])),
                         static_cast<int>(std::floor(p[2]))};
        const vec f = {p[0] - low.x, p[1] - low.y, p[2] - low.z};
        double sum = 0;
        for (int n = 0; n < 8; n++) {
            const ijk up = {n & 1, n >> 1 & 1, n >> 2};
            sum += (up.x ? f[0] : 1 - f[0]) * (up.y ? f[1] : 1 - f[1]) *
                   (up.z ? f[2] : 1 - f[2]) * at(low + up);
        }
        return sum;
    }

    // The integral from p to where the voxels end, in units and voxels.
    double integral(const vec &p, const vec &d, double step) const
    {
        double length = 1e9, sum = 0;
        const std::array<int, 3> n = {size_.x, size_.y, size_.z};
        for (size_t a = 0; a < 3; a++)
            if (d[a] != 0)
                length =
                    std::min(length, ((d[a] > 0 ? n[a] : -1) - p[a]) / d[a]);
        for (double t = step / 2; t < length; t += step)
            sum +=
                trilinear({p[0] + t * d[0], p[1] + t * d[1], p[2] + t * d[2]});
        return sum * step;
    }

  private:
    ijk size_;
    std::vector<int> units_;
};

/// MIPS ///

double distance(int q, double mean)
{
    return q < 0 || q > 255 ? 1e9 : std::fabs(q * (q + 1.0) - mean);
}

void check_mean_code(int level, const ijk &cube, int q, double mean,
                     findings &found)
{
    const bool nearest = distance(q, mean) <= distance(q - 1, mean) &&
                         distance(q, mean) <= distance(q + 1, mean);
    // Of two that are as near, the lower one.
    const bool lower = distance(q, mean) < distance(q - 1, mean);
    if (!nearest || !(lower || q == 0))
        found.add("mips", "level " + std::to_string(level) + " cube " +
                              to_text(cube) + " has code " + std::to_string(q) +
                              " for a mean of " + std::to_string(mean) +
                              " units");
}

void check_mip_level(const asset &a, const voxel_grid &voxels, int level,
                     findings &found)
{
    const ijk size = a.mip_size(level);
    std::vector<double> sums(volume_of(size));
    for (size_t i = 0; i < volume_of(voxels.size()); i++) {
        const ijk v = ijk_of(i, voxels.size());
        const ijk cube = {v.x >> level, v.y >> level, v.z >> level};
        sums[index_of(cube, size)] += voxels.at(v);
    }
    for (size_t i = 0; i < sums.size(); i++) {
        const ijk cube = ijk_of(i, size);
        check_mean_code(level, cube, a.mip_code(level, cube),
                        std::ldexp(sums[i], -3 * level), found);
    }
}

/// SUNC ///

void check_sun_head(const asset &a, findings &found)
{
    const vec &d = a.sun->direction;
    const double length = std::hypot(d[0], d[1], d[2]);
    int most = 0;
    for (size_t i = 0; i < volume_of(a.sun->size); i++)
        most = std::max(most, a.sun_code(ijk_of(i, a.sun->size)));
    if (!(std::fabs(length - 1) < 1e-8))
        found.add("sun", "direction is no unit vector");
    if (most != (a.sun->unit > 0 ? 255 : 0))
        found.add("sun", "the largest code is " + std::to_string(most));
}

// Nearest, but for the error of the steps here and of a direction of 30 bits.
void check_sun(const asset &a, const voxel_grid &voxels, findings &found)
{
    const sun_points &s = *a.sun;
    const size_t count = volume_of(s.size);
    const size_t step = std::max<size_t>(count / 2000, 1) | 1;
    check_sun_head(a, found);
    for (size_t i = step / 2; i < count && s.unit > 0; i += step) {
        const ijk n = ijk_of(i, s.size);
        const vec p = {(n.x + 0.5) * s.spacing - 0.5,
                       (n.y + 0.5) * s.spacing - 0.5,
                       (n.z + 0.5) * s.spacing - 0.5};
        const double depth =
            voxels.integral(p, s.direction, ray_step) * a.density_max / 65280;
        const double want = 24 * std::log2(1 + depth / s.unit);
        if (!(std::fabs(a.sun_code(n) - want) <= 0.5 + 0.05))
            found.add("sun", "point " + to_text(n) + " has code " +
                                 std::to_string(a.sun_code(n)) + " for " +
                                 std::to_string(want));
    }
}

/// AMBI ///

std::vector<vec> sky_directions()
{
    const double turn = 2 * std::acos(-1.0);
    std::vector<vec> list;
    for (int n = 0; n < 128; n++) {
        const double z = 1 - (2 * n + 1) / 128.0, r = std::sqrt(1 - z * z);
        const double angle = turn * n * (std::sqrt(5.0) - 1) / 2;
        list.push_back({r * std::cos(angle), r * std::sin(angle), z});
    }
    return list;
}

void check_sky(const asset &a, const voxel_grid &voxels, findings &found)
{
    const std::vector<vec> directions = sky_directions();
    const double scale = a.sky->extinction * a.density_max / 65280;
    const size_t step = std::max<size_t>(a.cell_count() / 100, 1) | 1;
    for (size_t i = step / 2; i < a.cell_count(); i += step) {
        const ijk c = ijk_of(i, a.cells);
        const vec p = {8 * c.x + 3.5, 8 * c.y + 3.5, 8 * c.z + 3.5};
        double sum = 0;
        for (const vec &d : directions)
            sum += std::exp(-scale * voxels.integral(p, d, ray_step));
        const double want = 255 * sum / 128;
        if (!(std::fabs(255 * a.sky_visibility(c) - want) <= 0.5 + 0.05))
            found.add("sky", "cell " + to_text(c) + " has " +
                                 std::to_string(255 * a.sky_visibility(c)) +
                                 " for " + std::to_string(want));
    }
}

} // namespace

void check_light(const asset &a, findings &found)
{
    if (a.mip_levels() == 0 && !a.sun && !a.sky)
        return;
    const voxel_grid voxels(a);
    for (int level = 1; level <= a.mip_levels(); level++)
        check_mip_level(a, voxels, level, found);
    if (a.sun)
        check_sun(a, voxels, found);
    if (a.sky)
        check_sky(a, voxels, found);
}

} // namespace reference
