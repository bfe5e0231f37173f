// SPDX-License-Identifier: MIT

#include "phase_sampling.hpp"

#include <algorithm>
#include <cmath>

namespace reference
{

static const double pi = 3.14159265358979323846;

// The cumulative distribution inverted: Witt, "Multiple Scattering in
// Reflection Nebulae I", 1977.
static double sample_hg(double g, double u)
{
    if (std::fabs(g) < 1e-6)
        return 2 * u - 1;
    const double s = (1 - g * g) / (1 - g + 2 * g * u);
    return std::clamp((1 + g * g - s * s) / (2 * g), -1.0, 1.0);
}

// Its value ahead is (1 + k) / (1 - k): this finds k as phase_value has it.
static double sample_schlick(const phase_model &model, double u)
{
    const double ahead = phase_value(model, 1);
    const double k = (ahead - 1) / (ahead + 1);
    return (2 * u + k - 1) / (2 * k * u - k + 1);
}

// Draine by rejection from HG: the ratio of the two is largest at |x| = 1.
static double sample_draine(double alpha, double g, random_source &random)
{
    for (;;) {
        const double x = sample_hg(g, random.uniform());
        if (random.uniform() * (1 + alpha) < 1 + alpha * x * x)
            return x;
    }
}

double sample_cosine(const phase_model &model, random_source &random)
{
    if (model.kind == phase_kind::schlick)
        return sample_schlick(model, random.uniform());
    if (model.weight > 0 && random.uniform() < model.weight)
        return sample_draine(model.draine_alpha, model.draine_g, random);
    return sample_hg(model.g, random.uniform());
}

// At cosine x to `way`, turned about it by a share of the circle.
static vec3 turned(const vec3 &way, double x, double turn)
{
    const vec3 axis = std::fabs(way.x) < 0.5 ? vec3{1, 0, 0} : vec3{0, 1, 0};
    const vec3 side = normalise(cross(way, axis));
    const vec3 other = cross(way, side);
    const double s = std::sqrt(std::max(0.0, 1 - x * x));
    return normalise(way * x + side * (s * std::cos(2 * pi * turn)) +
                     other * (s * std::sin(2 * pi * turn)));
}

vec3 sample_way(const phase_model &model, const vec3 &way,
                random_source &random)
{
    const double x = sample_cosine(model, random);
    return turned(way, x, random.uniform());
}

vec3 sample_sphere(random_source &random)
{
    const double x = 2 * random.uniform() - 1;
    return turned({0, 0, 1}, x, random.uniform());
}

} // namespace reference
