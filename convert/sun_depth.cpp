// SPDX-License-Identifier: MIT
#include "sun_depth.hpp"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

#include "bytes.hpp"

namespace bake
{

namespace
{

constexpr size_t head_bytes = 32;
constexpr double codes_per_octave = 24;

int log2_of(int spacing)
{
    return spacing == 2 ? 1 : spacing == 4 ? 2 : 3;
}

struct points {
    size_t nx, ny, nz;

    points(ijk cells, int spacing)
        : nx(size_t(cells.x * block_side / spacing)),
          ny(size_t(cells.y * block_side / spacing)),
          nz(size_t(cells.z * block_side / spacing))
    {
    }
    size_t count() const
    {
        return nx * ny * nz;
    }
};

// Rows of points along x share the work.
std::vector<float> depths_at(const density_field &field, const points &n,
                             int spacing, direction sun, progress &bar)
{
    std::vector<float> depth(n.count());
    const auto place = [spacing](size_t i) {
        return (double(i) + 0.5) * spacing - 0.5;
    };

    bar.stage("sun", n.ny * n.nz);
    tbb::parallel_for(size_t(0), n.ny * n.nz, [&](size_t row) {
        const double y = place(row % n.ny), z = place(row / n.ny);
        for (size_t i = 0; i < n.nx; i++)
            depth[row * n.nx + i] = float(field.depth(place(i), y, z, sun));
        bar.advance(1);
    });
    return depth;
}

uint8_t code_of(double depth, double unit)
{
    const double q = codes_per_octave * std::log2(1 + depth / unit);

    return uint8_t(std::min(255.0, std::floor(q + 0.5)));
}

void put_head(uint8_t *p, int spacing, direction sun, double unit)
{
    const double d[3] = {sun.x, sun.y, sun.z};

    p[0] = uint8_t(log2_of(spacing));
    for (int a = 0; a < 3; a++)
        put32(p + 4 + 4 * a,
              uint32_t(int32_t(std::floor(d[a] * 1073741824.0 + 0.5))));
    put_number(p + 16, unit);
}

} // namespace

// The inverse of a rotation times a scale is its transpose over the scale
// squared.
direction sun_direction(const double angles[2], const double world[12])
{
    const double degree = std::acos(-1.0) / 180;
    const double a = angles[0] * degree, e = angles[1] * degree;
    const double s[3] = {std::cos(e) * std::sin(a), std::sin(e),
                         std::cos(e) * std::cos(a)};
    double d[3];

    for (int i = 0; i < 3; i++)
        d[i] = world[i] * s[0] + world[4 + i] * s[1] + world[8 + i] * s[2];
    const double length = std::hypot(d[0], d[1], d[2]);
    return {d[0] / length, d[1] / length, d[2] / length};
}

uint64_t sun_cache_bytes(ijk cells, int spacing)
{
    return head_bytes + points(cells, spacing).count();
}

std::vector<uint8_t> make_sun_cache(const density_field &field, ijk cells,
                                    int spacing, direction sun, progress &bar)
{
    const points n(cells, spacing);
    std::vector<uint8_t> out(head_bytes + n.count());

    require_memory(double(n.count()) * sizeof(float), "the depths of the sun");
    const std::vector<float> depth = depths_at(field, n, spacing, sun, bar);
    const double most = double(*std::max_element(depth.begin(), depth.end()));
    const double unit = most / (std::exp2(255 / codes_per_octave) - 1);
    put_head(out.data(), spacing, sun, unit);
    if (most > 0)
        tbb::parallel_for(size_t(0), depth.size(), [&](size_t i) {
            out[head_bytes + i] = code_of(double(depth[i]), unit);
        });
    return out;
}

} // namespace bake
