// SPDX-License-Identifier: MIT
#include "sky_visibility.hpp"

#include <cmath>
#include <tbb/parallel_for.h>

#include "bytes.hpp"

namespace bake
{

namespace
{

constexpr size_t head_bytes = 16;
constexpr int direction_count = 128;

// A Fibonacci lattice on the sphere: bands of equal area along z, a golden
// section of a turn apart.
std::vector<direction> spread_directions()
{
    const double turn = 2 * std::acos(-1.0);
    const double golden = (std::sqrt(5.0) - 1) / 2;
    std::vector<direction> list;

    for (int i = 0; i < direction_count; i++) {
        const double z = 1 - (2 * i + 1.0) / direction_count;
        const double r = std::sqrt(1 - z * z), a = turn * golden * i;
        list.push_back({r * std::cos(a), r * std::sin(a), z});
    }
    return list;
}

} // namespace

uint64_t sky_visibility_bytes(ijk cells)
{
    return head_bytes +
           uint64_t(cells.x) * uint64_t(cells.y) * uint64_t(cells.z);
}

std::vector<uint8_t> make_sky_visibility(const density_field &field, ijk cells,
                                         double extinction, progress &bar)
{
    const std::vector<direction> sky = spread_directions();
    const size_t nx = size_t(cells.x), ny = size_t(cells.y);
    std::vector<uint8_t> out(size_t(sky_visibility_bytes(cells)));
    const auto middle = [](size_t i) { return 8 * double(i) + 3.5; };

    put_number(&out[0], extinction);
    bar.stage("sky", ny * size_t(cells.z));
    tbb::parallel_for(size_t(0), ny * size_t(cells.z), [&](size_t row) {
        const double y = middle(row % ny), z = middle(row / ny);
        for (size_t i = 0; i < nx; i++) {
            double sum = 0;
            for (const direction &d : sky)
                sum += std::exp(-extinction * field.depth(middle(i), y, z, d));
            out[head_bytes + row * nx + i] =
                uint8_t(std::floor(255 * sum / direction_count + 0.5));
        }
        bar.advance(1);
    });
    return out;
}

} // namespace bake
