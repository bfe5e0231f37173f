// SPDX-License-Identifier: MIT

#include "light.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace reference
{

/// Sums along a ray ///

// Where p + direction * t is in the pool's box; none when far < near. What is
// outside of it adds nothing, so sums need not go there.
struct reach {
    double near, far;
};

static reach reach_of(const volume &v, const vec3 &p, const vec3 &direction)
{
    const double from[3] = {p.x, p.y, p.z};
    const double speed[3] = {direction.x, direction.y, direction.z};
    const vec3 low = v.box_min(), high = v.box_max();
    const double face[2][3] = {{low.x, low.y, low.z}, {high.x, high.y, high.z}};
    reach r{0, std::numeric_limits<double>::infinity()};
    for (int i = 0; i < 3; i++) {
        if (speed[i] == 0) {
            if (from[i] < face[0][i] || from[i] > face[1][i])
                return {0, -1};
            continue;
        }
        const double a = (face[0][i] - from[i]) / speed[i];
        const double b = (face[1][i] - from[i]) / speed[i];
        r.near = std::max(r.near, std::min(a, b));
        r.far = std::min(r.far, std::max(a, b));
    }
    return r;
}

// Of density times distance, at s_k = step * 2^k, moved by the jitter; the
// weights are not.
static double doubling_sum(const volume &v, lookup filter, const vec3 &p,
                           const vec3 &direction, int samples, double step,
                           double jitter)
{
    double sum = 0, distance = step;
    for (int k = 0; k < samples; k++, distance *= 2)
        sum += v.density(p + direction * (distance * (1 + jitter)), filter) *
               distance;
    return sum;
}

// The same in the middles of equal steps.
static double uniform_sum(const volume &v, lookup filter, const vec3 &p,
                          const vec3 &direction, int samples, double step)
{
    const reach r = reach_of(v, p, direction);
    double sum = 0;
    for (double i = std::max(0.0, std::floor(r.near / step) - 1);
         i < samples && (i - 1) * step <= r.far; i++)
        sum += v.density(p + direction * ((i + 0.5) * step), filter);
    return sum * step;
}

// As good as the integral: two samples a voxel, to the end of the pool.
static double exact_sum(const volume &v, lookup filter, const vec3 &p,
                        const vec3 &direction)
{
    const int forever = std::numeric_limits<int>::max();
    return uniform_sum(v, filter, p, direction, forever, 0.5);
}

/// Sun ///

// The level whose one cube holds the whole pool.
static int top_level(const volume &v, const scene &s)
{
    if (s.light != light_model::cone)
        return 0;
    const std::array<int, 3> n = v.size();
    int top = 0;
    while (std::max({n[0], n[1], n[2]}) > 1 << top)
        top++;
    return top;
}

sun_light::sun_light(const volume &v, const scene &s, const vec3 &sun)
    : volume_(v), scene_(s), sun_(sun), top_(top_level(v, s)), mips_(v, top_)
{
}

// Sample i's segment: from where to where, in light steps. Two for each octave
// from eight steps on; the last one is twice as long.
sun_light::segment sun_light::segment_of(int i) const
{
    if (i < 2)
        return i == 0 ? segment{1, 4} : segment{4, 8};
    const double octave = std::ldexp(8, (i - 2) / 2);
    const double half = octave / 2;
    const double start = octave + (i % 2) * half;
    const bool last = i == scene_.light_samples - 1;
    return {start, start + (last ? 2 : 1) * half};
}

// The mean over cubes half as long as the segment, both rounded down to powers
// of two.
double sun_light::cone_density(double length, const vec3 &p) const
{
    const int step_log2 = std::ilogb(scene_.light_step);
    const int level = std::min(std::ilogb(length) + step_log2 - 1, top_);
    return level > 0 ? mips_.mean(level, p) : volume_.density(p, scene_.filter);
}

// Samples are in the middles of their segments, or where the jitter says.
double sun_light::cone_depth(const vec3 &p, double jitter) const
{
    const double place = scene_.jitter_light ? jitter : 0.5;
    double sum = volume_.density(p, scene_.filter);
    for (int i = 0; i < scene_.light_samples; i++) {
        const segment s = segment_of(i);
        const double length = s.end - s.start;
        const vec3 q =
            p + sun_ * (scene_.light_step * (s.start + length * place));
        if (volume_.contains(q))
            sum += length * cone_density(length, q);
    }
    return sum * scene_.light_step;
}

double sun_light::depth(const vec3 &p, double jitter) const
{
    const scene &s = scene_;
    double sum = 0;
    switch (s.light) {
    case light_model::none: break;
    case light_model::log:
        sum = doubling_sum(volume_, s.filter, p, sun_, s.light_samples,
                           s.light_step, jitter);
        break;
    case light_model::uniform:
        sum = uniform_sum(volume_, s.filter, p, sun_, s.light_samples,
                          s.light_step);
        break;
    case light_model::cone: sum = cone_depth(p, jitter); break;
    case light_model::cache: sum = exact_sum(volume_, s.filter, p, sun_); break;
    }
    return s.light_density_scale * sum;
}

/// Sky ///

// Fibonacci's spiral: n directions, each for the same solid angle.
static std::vector<vec3> sphere_directions(int n)
{
    const double golden_angle = 3.14159265358979323846 * (3 - std::sqrt(5.0));
    std::vector<vec3> out;
    for (int i = 0; i < n; i++) {
        const double y = 1 - (2 * i + 1.0) / n, r = std::sqrt(1 - y * y);
        const double angle = i * golden_angle;
        out.push_back({r * std::sin(angle), y, r * std::cos(angle)});
    }
    return out;
}

sky_light::sky_light(const volume &v, const scene &s, const vec3 &zenith)
    : volume_(v), scene_(s), zenith_(zenith), low_(0), high_(0)
{
    if (s.lit.ambient == ambient_kind::none)
        return;
    const std::array<vec3, 2> box = v.occupied_box();
    for (int corner = 0; corner < 8; corner++) {
        const vec3 p = {box[corner & 1].x, box[corner >> 1 & 1].y,
                        box[corner >> 2].z};
        const double at = dot(p, zenith);
        low_ = corner == 0 ? at : std::min(low_, at);
        high_ = corner == 0 ? at : std::max(high_, at);
    }
    if (s.lit.visibility != visibility_kind::open)
        directions_ = sphere_directions(s.lit.sky_directions);
}

double sky_light::height(const vec3 &p) const
{
    if (!(high_ > low_))
        return 0;
    return std::clamp((dot(p, zenith_) - low_) / (high_ - low_), 0.0, 1.0);
}

double sky_light::visibility(const vec3 &p, const vec3 &u) const
{
    const lighting &l = scene_.lit;
    const double sum =
        l.visibility == visibility_kind::baked
            ? exact_sum(volume_, scene_.filter, p, u)
            : doubling_sum(volume_, scene_.filter, p, u, l.visibility_samples,
                           l.visibility_step, 0);
    return std::exp(-scene_.light_density_scale * sum);
}

static void add_cube(const vec3 &u, double light, ambient_sums &sums)
{
    sums[u.x < 0 ? 1 : 0] += light * u.x * u.x;
    sums[u.y < 0 ? 3 : 2] += light * u.y * u.y;
    sums[u.z < 0 ? 5 : 4] += light * u.z * u.z;
}

// Light that comes from no direction in particular.
static void add_undirected(ambient_kind kind, double light, double height,
                           ambient_sums &sums)
{
    if (kind == ambient_kind::constant)
        sums[0] += light;
    else if (kind == ambient_kind::gradient) {
        sums[0] += light * height;
        sums[1] += light * (1 - height);
    } else
        for (double &sum : sums)
            sum += light / 6;
}

void sky_light::add(const vec3 &p, double lost, ambient_sums &sums) const
{
    const lighting &l = scene_.lit;
    if (l.ambient == ambient_kind::none)
        return;
    const bool by_direction = l.ambient == ambient_kind::cube &&
                              l.visibility == visibility_kind::sampled;
    const double share =
        lost / std::max(1.0, static_cast<double>(directions_.size()));
    double seen = directions_.empty() ? lost : 0;
    for (const vec3 &u : directions_) {
        const double light = share * visibility(p, u);
        seen += light;
        if (by_direction)
            add_cube(u, light, sums);
    }
    if (!by_direction)
        add_undirected(l.ambient, seen, height(p), sums);
}

vec3 sky_light::colour_of(const ambient_sums &sums) const
{
    const lighting &l = scene_.lit;
    switch (l.ambient) {
    case ambient_kind::none: break;
    case ambient_kind::constant: return l.ambient_colour * sums[0];
    case ambient_kind::gradient:
        return l.ambient_top * sums[0] + l.ambient_bottom * sums[1];
    case ambient_kind::cube: {
        vec3 sum = {0, 0, 0};
        for (size_t j = 0; j < 6; j++)
            sum = sum + l.ambient_cube[j] * sums[j];
        return sum;
    }
    }
    return {0, 0, 0};
}

} // namespace reference
