// SPDX-License-Identifier: MIT

#include "volume.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace reference {

// Exact for |x| < 2^31, which the caller ensures. std::floor is a function
// call on machines whose baseline has no rounding instruction.
static inline int floor_int(double x)
{
    const int i = static_cast<int>(x);
    return i - (x < i);
}

static inline double lerp(double a, double b, double f)
{
    return a + f * (b - a);
}

// Rows of one length, at right angles. The tolerance, relative to squares,
// lets matrices pass that were made in single precision.
static void check_similarity(const std::array<double, 12> &m)
{
    const vec3 row[3] = {
        {m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}};
    const double scale2 = dot(row[0], row[0]);
    bool good = scale2 > 0;
    for (double value : m)
        good = good && std::isfinite(value);
    for (int a = 0; a < 3; a++)
        for (int b = a; b < 3; b++) {
            const double want = a == b ? scale2 : 0;
            good = good && std::fabs(dot(row[a], row[b]) - want) <=
                               1e-6 * scale2;
        }
    if (!good)
        throw std::runtime_error(
            "world_from_index is not a uniform scale times a rotation");
}

volume::volume(float_dump dump, double max_density)
    : dump_(std::move(dump)), row_(static_cast<size_t>(dump_.size[0])),
      slice_(row_ * static_cast<size_t>(dump_.size[1]))
{
    check_similarity(dump_.world_from_index);
    const double largest = std::numeric_limits<float>::max();
    const float limit = static_cast<float>(std::min(max_density, largest));
    for (float &value : dump_.voxels)
        value = std::clamp(value, 0.0F, limit);
}

double volume::density(const vec3 &p, lookup filter) const
{
    if (!contains(p))
        return 0;
    return filter == lookup::nearest ? nearest(p) : trilinear(p);
}

bool volume::contains(const vec3 &p) const
{
    return p.x >= -1 && p.x <= dump_.size[0] && p.y >= -1 &&
           p.y <= dump_.size[1] && p.z >= -1 && p.z <= dump_.size[2];
}

vec3 volume::box_min() const
{
    return {-1, -1, -1};
}

vec3 volume::box_max() const
{
    return {static_cast<double>(dump_.size[0]),
            static_cast<double>(dump_.size[1]),
            static_cast<double>(dump_.size[2])};
}

std::array<vec3, 2> volume::occupied_box() const
{
    vec3 low = box_max(), high = box_min();
    const std::array<int, 3> &n = dump_.size;
    for (int k = 0; k < n[2]; k++)
        for (int j = 0; j < n[1]; j++)
            for (int i = 0; i < n[0]; i++)
                if (voxel(i, j, k) > 0) {
                    low = {std::min(low.x, i - 0.5), std::min(low.y, j - 0.5),
                           std::min(low.z, k - 0.5)};
                    high = {std::max(high.x, i + 0.5),
                            std::max(high.y, j + 0.5),
                            std::max(high.z, k + 0.5)};
                }
    return {low, high};
}

double volume::voxel(int i, int j, int k) const
{
    if (i < 0 || j < 0 || k < 0 || i >= dump_.size[0] || j >= dump_.size[1] ||
        k >= dump_.size[2])
        return 0;
    return static_cast<double>(
        dump_.voxels[static_cast<size_t>(i) + static_cast<size_t>(j) * row_ +
                     static_cast<size_t>(k) * slice_]);
}

double volume::nearest(const vec3 &p) const
{
    return voxel(floor_int(p.x + 0.5), floor_int(p.y + 0.5),
                 floor_int(p.z + 0.5));
}

// The eight voxels of the unit cube whose low corner is (i,j,k), x fastest.
void volume::gather(int i, int j, int k, double corner[8]) const
{
    if (i < 0 || j < 0 || k < 0 || i + 1 >= dump_.size[0] ||
        j + 1 >= dump_.size[1] || k + 1 >= dump_.size[2]) {
        for (int n = 0; n < 8; n++)
            corner[n] = voxel(i + (n & 1), j + (n >> 1 & 1), k + (n >> 2));
        return;
    }
    const float *low = &dump_.voxels[static_cast<size_t>(i) +
                                     static_cast<size_t>(j) * row_ +
                                     static_cast<size_t>(k) * slice_];
    const float *high = low + slice_;
    corner[0] = static_cast<double>(low[0]);
    corner[1] = static_cast<double>(low[1]);
    corner[2] = static_cast<double>(low[row_]);
    corner[3] = static_cast<double>(low[row_ + 1]);
    corner[4] = static_cast<double>(high[0]);
    corner[5] = static_cast<double>(high[1]);
    corner[6] = static_cast<double>(high[row_]);
    corner[7] = static_cast<double>(high[row_ + 1]);
}

double volume::trilinear(const vec3 &p) const
{
    const int i = floor_int(p.x), j = floor_int(p.y), k = floor_int(p.z);
    const double fx = p.x - i, fy = p.y - j, fz = p.z - k;
    double c[8];
    gather(i, j, k, c);
    const double near_z =
        lerp(lerp(c[0], c[1], fx), lerp(c[2], c[3], fx), fy);
    const double far_z =
        lerp(lerp(c[4], c[5], fx), lerp(c[6], c[7], fx), fy);
    return lerp(near_z, far_z, fz);
}

// The 3x3 part M of world_from_index is s·R, so its inverse is M^T / s^2.
vec3 volume::index_from_world_vector(const vec3 &v) const
{
    const std::array<double, 12> &m = dump_.world_from_index;
    const double scale2 = m[0] * m[0] + m[1] * m[1] + m[2] * m[2];
    const vec3 transposed = {m[0] * v.x + m[4] * v.y + m[8] * v.z,
                             m[1] * v.x + m[5] * v.y + m[9] * v.z,
                             m[2] * v.x + m[6] * v.y + m[10] * v.z};
    return transposed * (1 / scale2);
}

vec3 volume::pool_from_world(const vec3 &p) const
{
    const std::array<double, 12> &m = dump_.world_from_index;
    const vec3 translation = {m[3], m[7], m[11]};
    const vec3 origin = {static_cast<double>(dump_.origin[0]),
                         static_cast<double>(dump_.origin[1]),
                         static_cast<double>(dump_.origin[2])};
    return index_from_world_vector(p - translation) - origin;
}

vec3 volume::pool_direction(const vec3 &d) const
{
    return normalise(index_from_world_vector(d));
}

} // namespace reference
