// SPDX-License-Identifier: MIT

#include "air.hpp"

#include <algorithm>
#include <cmath>

#include "scene.hpp"
#include "scene_values.hpp"

namespace reference
{

// Coordinates at which rays end.
static const double edge = 32767;

static double voxels_per_unit(const volume &v)
{
    return length(v.pool_from_world({1, 0, 0}) - v.pool_from_world({0, 0, 0}));
}

air::air(const volume &v, const scene &s, const vec3 &sun, const vec3 &zenith)
    : scene_(s), sun_(sun), zenith_(zenith)
{
    const fog &f = s.lit.fog;
    const double scale = voxels_per_unit(v);
    base_ = dot(v.pool_from_world({0, f.base, 0}), zenith);
    falloff_ = f.falloff * scale;
    far_ = f.far > 0 ? f.far * scale : 32766;
    for (const fog_shape &shape : f.shapes)
        shapes_.push_back({shape.box, v.pool_from_world(shape.centre),
                           shape.half * scale, shape.density, shape.softness});
    const sun_map &m = s.lit.sun_map;
    if (m.texels.values.empty())
        return;
    // A way in the plane has a part along each edge, found by what lies across
    // the other one and the sun.
    const vec3 zero = v.pool_from_world({0, 0, 0});
    const vec3 across = v.pool_from_world(m.across) - zero;
    const vec3 down = v.pool_from_world(m.down) - zero;
    const vec3 off_down = cross(down, sun), off_across = cross(across, sun);
    origin_ = v.pool_from_world(m.origin);
    column_ = off_down * (m.texels.width / dot(across, off_down));
    row_ = off_across * (m.texels.height / dot(down, off_across));
    normal_ = normalise(cross(across, down));
    normal_ = normal_ * (1 / dot(normal_, sun));
    range_ = m.range * scale;
    bias_ = m.bias * scale;
}

bool air::has_fog() const
{
    return scene_.lit.fog.is_on();
}

/// Fog ///

double air::by_height(double height) const
{
    const double density = scene_.lit.fog.density;
    if (falloff_ <= 0 || height <= base_)
        return density;
    return density * std::exp(-(height - base_) / falloff_);
}

// What is left at a share of the way to the edge: falls with the square.
static double softened(double square, double softness)
{
    const double inner = 1 - softness;
    if (square >= 1)
        return 0;
    if (square <= inner * inner)
        return 1;
    return (1 - square) / (1 - inner * inner);
}

double air::of_shapes(const vec3 &p) const
{
    double sum = 0;
    for (const pool_shape &s : shapes_) {
        const vec3 d = p - s.centre;
        const auto square = [](double a, double half) {
            return a / half * (a / half);
        };
        if (s.box)
            sum += s.density * softened(square(d.x, s.half.x), s.softness) *
                   softened(square(d.y, s.half.y), s.softness) *
                   softened(square(d.z, s.half.z), s.softness);
        else
            sum += s.density *
                   softened(dot(d, d) / (s.half.x * s.half.x), s.softness);
    }
    return sum;
}

double air::fog_at(const vec3 &p) const
{
    if (!has_fog())
        return 0;
    return std::min(1.0, by_height(dot(p, zenith_)) + of_shapes(p));
}

// Of what gets thinner with height: to infinity, if the sun is above the
// horizon; never farther than rays go.
double air::height_depth(const vec3 &p) const
{
    const double height = dot(p, zenith_), rise = dot(sun_, zenith_);
    double way = far_;
    if (falloff_ > 0 && rise > 0)
        way = std::min(
            far_, (std::max(0.0, base_ - height) + falloff_) / rise);
    return by_height(height) * way;
}

static bool is_within(const vec3 &p)
{
    return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) <= edge;
}

double air::shapes_depth(const vec3 &p, double jitter) const
{
    const scene &s = scene_;
    const bool uniform = s.light == light_model::uniform;
    const bool middles =
        s.light == light_model::cone || s.light == light_model::cache;
    if (s.light == light_model::none)
        return 0;
    const double place = middles && !s.jitter_light ? 0.5 : jitter;
    double sum = middles ? of_shapes(p) * s.light_step : 0;
    for (int i = 0; i < s.light_samples; i++) {
        const double step = std::ldexp(s.light_step, uniform ? 0 : i);
        const double t = uniform ? (i + 0.5) * step : step * (1 + place);
        const vec3 q = p + sun_ * t;
        if (!is_within(q) || step > 32768)
            break;
        sum += of_shapes(q) * step;
    }
    return sum;
}

double air::fog_depth(const vec3 &p, double jitter) const
{
    if (!has_fog() || scene_.light == light_model::none)
        return 0;
    return height_depth(p) + shapes_depth(p, jitter);
}

/// Ends ///

static double time_of_edge(double from, double speed)
{
    if (speed == 0)
        return infinity;
    return ((speed > 0 ? edge : -edge) - from) / speed;
}

// A code is 2048 times the octave above 2^-16 voxels, plus how far in it.
static double distance_of(uint32_t code)
{
    if (code == 65535)
        return infinity;
    if (code == 0)
        return 0;
    const int octave = static_cast<int>(code / 2048);
    const double q16 = std::ldexp(1 + code % 2048 / 2048.0, octave);
    return std::floor(q16) / 65536;
}

double air::end(const vec3 &eye, const vec3 &direction, int x, int y) const
{
    double t = infinity;
    const grey_map &surface = scene_.lit.surface;
    if (!surface.values.empty())
        t = distance_of(
            surface.values[static_cast<size_t>(y) *
                               static_cast<size_t>(surface.width) +
                           static_cast<size_t>(x)]);
    if (has_fog())
        t = std::min({t, far_, time_of_edge(eye.x, direction.x),
                      time_of_edge(eye.y, direction.y),
                      time_of_edge(eye.z, direction.z)});
    return t;
}

/// Sun map ///

bool air::is_dark(int x, int y, double depth) const
{
    const grey_map &m = scene_.lit.sun_map.texels;
    if (x < 0 || y < 0 || x >= m.width || y >= m.height)
        return false;
    const uint16_t value =
        m.values[static_cast<size_t>(y) * static_cast<size_t>(m.width) +
                 static_cast<size_t>(x)];
    return value != 65535 && depth - bias_ >= value * range_ / 65535;
}

double air::lit(const vec3 &p) const
{
    if (scene_.lit.sun_map.texels.values.empty())
        return 1;
    const vec3 d = p - origin_;
    const double depth = -dot(d, normal_);
    const double u = dot(d, column_) - 0.5, v = dot(d, row_) - 0.5;
    const double x = std::floor(u), y = std::floor(v);
    if (std::fabs(u) > 1e6 || std::fabs(v) > 1e6)
        return 1;
    double light = 0;
    for (int n = 0; n < 4; n++) {
        const double right = n & 1 ? u - x : 1 - (u - x);
        const double low = n & 2 ? v - y : 1 - (v - y);
        if (!is_dark(static_cast<int>(x) + (n & 1),
                     static_cast<int>(y) + (n >> 1), depth))
            light += right * low;
    }
    return light;
}

} // namespace reference
