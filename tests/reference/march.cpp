// SPDX-License-Identifier: MIT

#include "march.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

namespace reference
{

static const double radians = 3.14159265358979323846 / 180;

static vec3 sun_direction(const scene &s)
{
    const double a = s.sun_azimuth * radians;
    const double e = s.sun_elevation * radians;
    return {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
}

// The frame is built in world space, where it is right-handed, and then
// taken to pool space.
renderer::renderer(const volume &v, const scene &s) : volume_(v), scene_(s)
{
    const vec3 forward = normalise(s.target - s.eye);
    const vec3 right = normalise(cross(forward, s.up));
    const vec3 up = cross(right, forward);
    eye_ = v.pool_from_world(s.eye);
    forward_ = v.pool_direction(forward);
    right_ = v.pool_direction(right);
    up_ = v.pool_direction(up);
    sun_ = v.pool_direction(sun_direction(s));
    pixel_ = 2 * std::tan(s.fov / 2 * radians) / s.height;
}

ray renderer::camera_ray(int x, int y) const
{
    const double across = (x + 0.5 - 0.5 * scene_.width) * pixel_;
    const double upward = (0.5 * scene_.height - y - 0.5) * pixel_;
    return {eye_, normalise(forward_ + right_ * across + up_ * upward)};
}

// Narrows [t_min, t_max] to where o + t·d is in [low, high].
static void clip_axis(double o, double d, double low, double high,
                      double &t_min, double &t_max)
{
    if (d == 0) {
        if (o < low || o > high)
            t_max = -std::numeric_limits<double>::infinity();
        return;
    }
    const double a = (low - o) / d, b = (high - o) / d;
    t_min = std::max(t_min, std::min(a, b));
    t_max = std::min(t_max, std::max(a, b));
}

// The lattice points that may have a density, with one to spare at either
// end for rounding: a point outside the box adds exactly nothing.
renderer::lattice_range renderer::clip(const ray &r, double jitter) const
{
    const vec3 low = volume_.box_min(), high = volume_.box_max();
    double t_min = 0, t_max = std::numeric_limits<double>::infinity();
    clip_axis(r.origin.x, r.direction.x, low.x, high.x, t_min, t_max);
    clip_axis(r.origin.y, r.direction.y, low.y, high.y, t_min, t_max);
    clip_axis(r.origin.z, r.direction.z, low.z, high.z, t_min, t_max);
    if (t_min > t_max)
        return {0, -1};
    return {std::max(0.0, std::floor(t_min / scene_.step - jitter) - 1),
            std::ceil(t_max / scene_.step - jitter) + 1};
}

// Samples at s_k = light_step·2^k, moved by the jitter; the weights are not.
double renderer::log_depth(const vec3 &p, double jitter) const
{
    double sum = 0, distance = scene_.light_step;
    for (int k = 0; k < scene_.light_samples; k++, distance *= 2) {
        const vec3 q = p + sun_ * (distance * (1 + jitter));
        if (!volume_.contains(q))
            break;
        sum += volume_.density(q, scene_.filter) * distance;
    }
    return scene_.light_density_scale * sum;
}

double renderer::uniform_depth(const vec3 &p) const
{
    double sum = 0;
    for (int i = 0; i < scene_.light_samples; i++) {
        const vec3 q = p + sun_ * ((i + 0.5) * scene_.light_step);
        if (!volume_.contains(q))
            break;
        sum += volume_.density(q, scene_.filter);
    }
    return scene_.light_density_scale * scene_.light_step * sum;
}

double renderer::sun_transmittance(const vec3 &p, double jitter) const
{
    switch (scene_.light) {
    case light_model::log: return std::exp(-log_depth(p, jitter));
    case light_model::uniform: return std::exp(-uniform_depth(p));
    case light_model::none: break;
    }
    return 1;
}

// t_k is computed from k, never accumulated: the lattice does not depend on
// where the ray enters the box.
march_result renderer::march(const ray &r, double jitter,
                             double light_jitter) const
{
    march_result out = {0, 1};
    const lattice_range range = clip(r, jitter);
    for (double k = range.first; k <= range.last; k++) {
        const double t = (k + jitter) * scene_.step;
        const vec3 p = r.origin + r.direction * t;
        const double density = volume_.density(p, scene_.filter);
        if (!(density > scene_.min_density))
            continue;
        const double a =
            std::exp(-scene_.density_scale * density * scene_.step);
        out.radiance += out.transmittance * (1 - a) * scene_.albedo *
                        sun_transmittance(p, light_jitter);
        out.transmittance *= a;
        if (out.transmittance < scene_.min_transmittance)
            break;
    }
    return out;
}

double renderer::jitter_of(int x, int y, channel c) const
{
    const bool on =
        c == primary_channel ? scene_.jitter_primary : scene_.jitter_light;
    if (!on)
        return 0;
    return noise_value(scene_.noise_kind, static_cast<uint32_t>(x),
                       static_cast<uint32_t>(y), scene_.frame, c,
                       scene_.noise_values) /
           65536.0;
}

march_result renderer::march_pixel(int x, int y) const
{
    return march(camera_ray(x, y), jitter_of(x, y, primary_channel),
                 jitter_of(x, y, light_channel));
}

void renderer::render_row(int y, const rectangle &area, picture &out) const
{
    const double background[3] = {scene_.background.x, scene_.background.y,
                                  scene_.background.z};
    size_t at = static_cast<size_t>(y - area.y_min) *
                static_cast<size_t>(out.width) *
                static_cast<size_t>(out.channels);
    for (int x = area.x_min; x < area.x_max; x++) {
        const march_result m = march_pixel(x, y);
        for (int c = 0; c < out.channels; c++)
            out.values[at++] = m.radiance + m.transmittance * background[c];
    }
}

picture renderer::render(const rectangle &area, int threads) const
{
    picture out{area.x_max - area.x_min,
                area.y_max - area.y_min,
                scene_.background_is_rgb ? 3 : 1,
                {}};
    out.values.resize(static_cast<size_t>(out.width) *
                      static_cast<size_t>(out.height) *
                      static_cast<size_t>(out.channels));
    std::atomic<int> next{area.y_min};
    const auto work = [&] {
        for (int y; (y = next++) < area.y_max;)
            render_row(y, area, out);
    };
    std::vector<std::thread> helpers;
    for (int i = 1; i < threads; i++)
        helpers.emplace_back(work);
    work();
    for (std::thread &helper : helpers)
        helper.join();
    return out;
}

} // namespace reference
