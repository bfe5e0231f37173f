// SPDX-License-Identifier: MIT

#include "march.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include "sky.hpp"

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
renderer::renderer(const volume &v, const scene &s, const emission *glow)
    : volume_(v), scene_(s), glow_(s.lit.glow.empty() ? nullptr : glow),
      sun_(v.pool_direction(sun_direction(s))),
      zenith_(v.pool_direction({0, 1, 0})), sun_light_(v, scene_, sun_),
      sky_light_(v, scene_, zenith_), air_(v, scene_, sun_, zenith_),
      lamp_light_(v, scene_, air_)
{
    const vec3 forward = normalise(s.target - s.eye);
    const vec3 right = normalise(cross(forward, s.up));
    const vec3 up = cross(right, forward);
    eye_ = v.pool_from_world(s.eye);
    forward_ = v.pool_direction(forward);
    right_ = v.pool_direction(right);
    up_ = v.pool_direction(up);
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
// end for rounding: a point outside the box adds exactly nothing. With fog all
// up to the ray's end.
renderer::lattice_range renderer::clip(const ray &r, double jitter,
                                       double end) const
{
    if (air_.has_fog())
        return {0, std::ceil(end / scene_.step - jitter) + 1};
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

// The octaves' sums from the one optical depth.
void renderer::add_sun(double lost, const vec3 &p, double jitter,
                       ray_sums &sums) const
{
    const double lit = air_.lit(p);
    if (lit == 0)
        return;
    const double tau = sun_light_.depth(p, jitter) + air_.fog_depth(p, jitter);
    double extinction = 1;
    for (int i = 0; i < scene_.lit.octaves; i++) {
        sums.sun[i] += lost * lit * std::exp(-extinction * tau);
        extinction *= scene_.lit.octave_a;
    }
}

// The sum of b^i P_i A_i.
double renderer::in_scattering(const ray &r, const ray_sums &sums) const
{
    const lighting &l = scene_.lit;
    const double cosine = dot(r.direction, sun_);
    double sum = 0, share = 1, width = 1;
    for (int i = 0; i < l.octaves; i++) {
        sum +=
            share * phase_value(widened(l.phase, width), cosine) * sums.sun[i];
        share *= l.octave_b;
        width *= l.octave_c;
    }
    return sum;
}

static vec3 at_most(const vec3 &c, double limit)
{
    return {std::min(c.x, limit), std::min(c.y, limit), std::min(c.z, limit)};
}

march_result renderer::finish(const ray &r, const ray_sums &sums) const
{
    const lighting &l = scene_.lit;
    const vec3 light = l.sun_colour * in_scattering(r, sums) +
                       sky_light_.colour_of(sums.sky) + sums.lamps;
    const vec3 seen =
        at_most(light * (l.exposure * scene_.albedo) + sums.glow * l.exposure,
                max_light);
    const double lost = 1 - sums.transmittance;
    const double left = lost > 0 ? haze_share(l, sums.moment / lost) : 1;
    const vec3 colour = seen * left;
    return {colour.x, 1 - left * lost, colour};
}

// What scatters and what glows at a sample, neither in front of the other: each
// has what it would lose alone, less half of what both would. False when
// there is nothing left of the ray.
bool renderer::add_sample(const vec3 &p, const vec3 &direction, double t,
                          double light_jitter, double lamp_jitter,
                          ray_sums &sums) const
{
    const scene &s = scene_;
    const double d = volume_.density(p, s.filter), fog = air_.fog_at(p);
    const double m = glow_ != nullptr ? glow_->value(p, s.filter) : 0;
    const bool dense = d > s.min_density, scatters = dense || fog > 0;
    const double a =
        std::exp(-(s.density_scale * (dense ? d : 0) + fog) * s.step);
    const double b = std::exp(-s.lit.emission_scale * m * s.step);
    const double lost = sums.transmittance * (1 - a) * (1 + b) / 2;
    const double glowing = sums.transmittance * (1 - b) * (1 + a) / 2;
    if (!scatters && !(glowing > 0))
        return true;
    if (scatters) {
        add_sun(lost, p, light_jitter, sums);
        sky_light_.add(p, lost, sums.sky);
        sums.lamps =
            sums.lamps + lamp_light_.at(p, direction, lamp_jitter) * lost;
    }
    if (glowing > 0)
        sums.glow = sums.glow + glow_->colour(m, s.lit.glow) * glowing;
    sums.moment += (lost + glowing) * t;
    sums.transmittance *= a * b;
    return sums.transmittance >= s.min_transmittance;
}

// t_k is computed from k, never accumulated: the lattice does not depend on
// where the ray enters the box.
march_result renderer::march(const ray &r, double jitter, double light_jitter,
                             double end) const
{
    ray_sums sums;
    const lattice_range range = clip(r, jitter, end);
    const bool noisy = scene_.jitter_light && scene_.noise_kind != noise::none;
    const double lamp_jitter = noisy ? light_jitter : 0.5;
    for (double k = range.first; k <= range.last; k++) {
        const double t = (k + jitter) * scene_.step;
        if (t >= end)
            break;
        if (!add_sample(r.origin + r.direction * t, r.direction, t,
                        light_jitter, lamp_jitter, sums))
            break;
    }
    return finish(r, sums);
}

vec3 renderer::background(const ray &r) const
{
    if (!scene_.lit.sky)
        return scene_.background;
    return sky_colour(scene_.lit, dot(r.direction, zenith_),
                      dot(r.direction, sun_));
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
    const ray r = camera_ray(x, y);
    return march(r, jitter_of(x, y, primary_channel),
                 jitter_of(x, y, light_channel),
                 air_.end(r.origin, r.direction, x, y));
}

void renderer::render_row(int y, const rectangle &area, picture &out) const
{
    size_t at = static_cast<size_t>(y - area.y_min) *
                static_cast<size_t>(out.width) *
                static_cast<size_t>(out.channels);
    for (int x = area.x_min; x < area.x_max; x++) {
        const march_result m = march_pixel(x, y);
        const vec3 sum =
            m.colour + background(camera_ray(x, y)) * m.transmittance;
        const double channels[3] = {sum.x, sum.y, sum.z};
        for (int c = 0; c < out.channels; c++)
            out.values[at++] = channels[c];
    }
}

static bool is_grey(const vec3 &c)
{
    return c.x == c.y && c.y == c.z;
}

// Does anything that is in use have a colour?
static bool is_coloured(const scene &s)
{
    const lighting &l = s.lit;
    bool grey = is_grey(l.sun_colour) && !s.background_is_rgb && !l.sky;
    if (l.ambient == ambient_kind::constant)
        grey = grey && is_grey(l.ambient_colour);
    if (l.ambient == ambient_kind::gradient)
        grey = grey && is_grey(l.ambient_top) && is_grey(l.ambient_bottom);
    if (l.ambient == ambient_kind::cube)
        for (const vec3 &side : l.ambient_cube)
            grey = grey && is_grey(side);
    for (const lamp &lamp : l.lamps)
        grey = grey && is_grey(lamp.colour);
    for (const vec3 &colour : l.glow)
        grey = grey && is_grey(colour);
    return !grey;
}

picture renderer::render(const rectangle &area, int threads) const
{
    picture out{area.x_max - area.x_min,
                area.y_max - area.y_min,
                is_coloured(scene_) ? 3 : 1,
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
