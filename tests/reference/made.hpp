// SPDX-License-Identifier: MIT
//
// Made volumes and scenes for the tests of the reference renderer, whose
// pictures can be worked out by hand.
#ifndef BRUME_REFERENCE_MADE_HPP
#define BRUME_REFERENCE_MADE_HPP

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "march.hpp"
#include "tap.h"

namespace reference
{

using settings = std::vector<std::pair<std::string, std::string>>;
using density_function = std::function<double(int, int, int)>;

inline settings with(settings list, const settings &more)
{
    list.insert(list.end(), more.begin(), more.end());
    return list;
}

inline float_dump make_dump(int nx, int ny, int nz,
                            const density_function &density)
{
    float_dump dump;
    dump.size = {nx, ny, nz};
    dump.world_from_index = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    for (int k = 0; k < nz; k++)
        for (int j = 0; j < ny; j++)
            for (int i = 0; i < nx; i++)
                dump.voxels.push_back(static_cast<float>(density(i, j, k)));
    return dump;
}

inline volume make_volume(int nx, int ny, int nz,
                          const density_function &density)
{
    return volume(make_dump(nx, ny, nz, density), 1e30);
}

// An unlit one-pixel view along +x from the origin, changed by `changes`.
inline scene make_scene(const settings &changes)
{
    scene_builder builder;
    const settings base = {{"size", "1x1"},
                           {"eye", "0 0 0"},
                           {"target", "1 0 0"},
                           {"fov", "40"},
                           {"density_scale", "1"},
                           {"step", "1"},
                           {"light", "none"},
                           {"sun", "0 0"},
                           {"light_density_scale", "1"},
                           {"light_samples", "1"},
                           {"light_step", "1"},
                           {"min_transmittance", "0"}};
    for (const settings &list : {base, changes})
        for (const auto &[key, value] : list)
            builder.set(key, value);
    return builder.finish();
}

inline std::string number(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}

inline std::string triple(const vec3 &v)
{
    return number(v.x) + "," + number(v.y) + "," + number(v.z);
}

inline picture render(const volume &v, const scene &s)
{
    return renderer(v, s).render({0, 0, s.width, s.height}, 2);
}

inline void check_near(double got, double want, double bound,
                       const std::string &what)
{
    tap_check(std::fabs(got - want) <= bound, "%s: %.9g is %.9g within %.1g",
              what.c_str(), got, want, bound);
}

/// Slab ///

// Density 0.5 in the 32 voxels whose low face is at x = 15.5, wide in y so
// that a slanted sun ray does not leave by the side.
constexpr double slab_length = 32;

inline volume make_slab()
{
    return make_volume(64, 128, 8, [](int i, int, int) {
        return i >= 16 && i < 48 ? 0.5 : 0.0;
    });
}

// Straight at the slab; a whole number of any step <= 16 from its face.
inline settings slab_view()
{
    return {
        {"eye", "-48.5 64 4"}, {"target", "0 64 4"}, {"density_scale", "0.1"}};
}

} // namespace reference

#endif
