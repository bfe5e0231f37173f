// SPDX-License-Identifier: MIT
//
// Means of random samples and made media, for the tests of the Monte Carlo
// reference and of octaves. Seeds are fixed; a bound is four standard errors.
#ifndef BRUME_REFERENCE_MEASURE_HPP
#define BRUME_REFERENCE_MEASURE_HPP

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "made.hpp"
#include "medium.hpp"
#include "random.hpp"

namespace reference
{

struct estimate {
    double mean, error; // its standard error
};

inline estimate measure(int samples, uint64_t seed,
                        const std::function<double(random_source &)> &sample)
{
    random_source random({seed});
    double sum = 0, squares = 0;
    for (int i = 0; i < samples; i++) {
        const double v = sample(random);
        sum += v;
        squares += v * v;
    }
    const double mean = sum / samples;
    return {mean, std::sqrt(std::max(0.0, squares / samples - mean * mean) /
                            (samples - 1))};
}

// `slack` is what the comparison itself is not exact by.
inline void check_mean(const estimate &e, double want, const std::string &what,
                       double slack = 1e-9)
{
    tap_check(std::fabs(e.mean - want) <= 4 * e.error + slack,
              "%s: %.5f is %.5f within 4 x %.5f", what.c_str(), e.mean, want,
              e.error);
}

// A volume with its medium.
struct field {
    const volume voxels;
    const medium inside;

    field(int nx, int ny, int nz, lookup filter,
          const density_function &density)
        : voxels(make_volume(nx, ny, nz, density)), inside(voxels, filter)
    {
    }
    field(const field &) = delete;
};

// A soft lump with holes: nothing about it is symmetric.
inline double lump_density(int i, int j, int k)
{
    const double x = (i - 11.0) / 10, y = (j - 9.0) / 8, z = (k - 12.0) / 11;
    const double d = 1.2 - x * x - y * y - z * z + 0.4 * std::sin(i * 1.7) +
                     0.4 * std::cos(j * 1.1 + k * 0.9);
    return d > 0 ? d : 0;
}

struct lump : field {
    explicit lump(lookup filter) : field(24, 20, 26, filter, lump_density)
    {
    }
};

// Through the lump, aslant.
inline ray slanted_ray()
{
    return {{-3, 2.3, 4.1}, normalise({1, 0.42, 0.37})};
}

// The lump from outside, and a sun.
inline settings lump_view(const std::string &filter, double elevation)
{
    return {{"size", "12x10"},        {"eye", "60 30 50"},
            {"target", "12 9 12"},    {"fov", "26"},
            {"density_scale", "0.1"}, {"light_density_scale", "0.1"},
            {"step", "0.05"},         {"filter", filter},
            {"light", "uniform"},     {"light_samples", "600"},
            {"light_step", "0.08"},   {"sun", "50 " + number(elevation)}};
}

} // namespace reference

#endif
