// SPDX-License-Identifier: MIT

#include "octaves.hpp"

#include <algorithm>
#include <cmath>

namespace reference
{

double octave_model::weight_sum() const
{
    double sum = 0;
    for (int i = 0; i < count; i++)
        sum += std::pow(b, i);
    return sum;
}

/// Light tables ///

static const double node_ratio = 0.84089641525371454; // 2^(-1/4)

void light_table::add(double lost, double tau)
{
    double s = 1;
    for (double &value : value_) {
        value += lost * std::exp(-s * tau);
        s *= node_ratio;
    }
}

// Below the last node the sum does not change any more.
light_table::place light_table::find(double s)
{
    const double last = nodes - 1;
    const double at = s > 0 ? std::clamp(-4 * std::log2(s), 0.0, last) : last;
    place p;
    p.first = std::clamp(static_cast<int>(at) - 1, 0, nodes - 4);
    for (size_t i = 0; i < 4; i++) {
        p.weight[i] = 1;
        for (size_t j = 0; j < 4; j++)
            if (i != j)
                p.weight[i] *=
                    (at - p.first - static_cast<double>(j)) /
                    (static_cast<double>(i) - static_cast<double>(j));
    }
    return p;
}

double light_table::at(const place &p) const
{
    double sum = 0;
    for (size_t i = 0; i < 4; i++)
        sum += p.weight[i] * value_[static_cast<size_t>(p.first) + i];
    return sum;
}

/// March ///

static double uniform_depth(const volume &v, const scene &s, const vec3 &p,
                            const vec3 &sun)
{
    double sum = 0;
    for (int i = 0; i < s.light_samples; i++) {
        const vec3 q = p + sun * ((i + 0.5) * s.light_step);
        if (!v.contains(q))
            break;
        sum += v.density(q, s.filter);
    }
    return s.density_scale * s.light_step * sum;
}

// No part of the box is farther from the eye.
static double reach(const volume &v, const vec3 &eye)
{
    return length(v.box_min() - eye) + length(v.box_max() - v.box_min());
}

static marched_pixel march_ray(const volume &v, const scene &s, const ray &r,
                               const vec3 &sun)
{
    marched_pixel out{};
    out.transmittance = 1;
    out.cosine = dot(r.direction, sun);
    const double far = reach(v, r.origin);
    for (double k = 0; k * s.step < far; k++) {
        const vec3 p = r.origin + r.direction * (k * s.step);
        const double d = v.density(p, s.filter);
        if (!(d > s.min_density))
            continue;
        const double lost =
            out.transmittance * -std::expm1(-s.density_scale * d * s.step);
        out.transmittance -= lost;
        out.light.add(lost, uniform_depth(v, s, p, sun));
        if (out.transmittance < 1e-5)
            break;
    }
    return out;
}

std::vector<marched_pixel> march_picture(const volume &v, const scene &s)
{
    const renderer camera(v, s);
    std::vector<marched_pixel> out;
    for (int y = 0; y < s.height; y++)
        for (int x = 0; x < s.width; x++) {
            marched_pixel p =
                march_ray(v, s, camera.camera_ray(x, y), camera.sun());
            p.x = x;
            p.y = y;
            if (p.transmittance <= 0.99)
                out.push_back(p);
        }
    return out;
}

double octave_term(const marched_pixel &p, const phase_model &phase,
                   const light_table::place &place)
{
    return phase_value(phase, p.cosine) * p.light.at(place);
}

} // namespace reference
