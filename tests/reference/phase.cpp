// SPDX-License-Identifier: MIT

#include "phase.hpp"

#include <algorithm>
#include <cmath>

namespace reference
{

// The denominator 1 + g^2 - 2 g x is written so that nothing cancels where
// the lobe is narrowest: at x = 1 or, for negative g, at x = -1.
double henyey_greenstein(double g, double cosine)
{
    const double away = g < 0 ? 1 + cosine : 1 - cosine, size = std::fabs(g);
    const double square = (1 - size) * (1 - size) + 2 * size * away;
    return (1 - g * g) / (square * std::sqrt(square));
}

double draine(double alpha, double g, double cosine)
{
    return henyey_greenstein(g, cosine) * (1 + alpha * cosine * cosine) /
           (1 + alpha * (1 + 2 * g * g) / 3);
}

// The formula's k exceeds 1 from |g| = 0.938 on, which is no phase function.
static const double largest_k = 0.999;

double schlick(double g, double cosine)
{
    const double formula = 1.55 * g - 0.55 * g * g * g;
    const double k = std::clamp(formula, -largest_k, largest_k);
    const double root = 1 - k * cosine;
    return (1 - k * k) / (root * root);
}

double phase_value(const phase_model &m, double cosine)
{
    if (m.kind == phase_kind::schlick)
        return schlick(m.g, cosine);
    return m.weight * draine(m.draine_alpha, m.draine_g, cosine) +
           (1 - m.weight) * henyey_greenstein(m.g, cosine);
}

phase_model widened(const phase_model &model, double factor)
{
    phase_model out = model;
    out.g *= factor;
    out.draine_g *= factor;
    out.draine_alpha *= factor;
    return out;
}

/// Droplets: four fits by diameter ///

static phase_model mix(double g, double draine_g, double alpha, double weight)
{
    return {phase_kind::mix, g, draine_g, alpha, weight};
}

static phase_model large_droplet(double d)
{
    return mix(std::exp(-0.0990567 / (d - 1.67154)),
               std::exp(-2.20679 / (d + 3.91029) - 0.428934),
               std::exp(3.62489 - 8.29288 / (d + 5.52825)),
               std::exp(-0.599085 / (d - 0.641583) - 0.665888));
}

static phase_model middle_droplet(double d)
{
    const double l = std::log(d);
    return mix(0.0604931 * std::log(l) + 0.940256,
               0.500411 - 0.081287 / (-2 * l + std::tan(l) + 1.27551),
               7.30354 * l + 6.31675,
               0.026914 * (l - std::cos(5.68947 * (std::log(l) - 0.0292149))) +
                   0.376475);
}

static phase_model small_droplet(double d)
{
    const double l = std::log(d);
    const double inner =
        (l - 0.238604) * (l + 1.00667) / (0.507522 - 0.15677 * l);
    const double outer = 1.19692 * std::cos(inner) + 1.37932 * l + 0.0625835;
    return mix(
        0.862 - 0.143 * l * l, 0.379685 * std::cos(outer) + 0.344213, 250,
        0.146209 * std::cos(3.38707 * l + 2.11193) + 0.316072 + 0.0778917 * l);
}

static phase_model tiny_droplet(double d)
{
    return mix(13.8 * d * d, 1.1456 * d * std::sin(9.29044 * d), 250,
               0.252977 - 312.983 * std::pow(d, 4.3));
}

phase_model droplet_phase(double diameter)
{
    if (diameter >= 5)
        return large_droplet(diameter);
    if (diameter > 1.5)
        return middle_droplet(diameter);
    return diameter > 0.1 ? small_droplet(diameter) : tiny_droplet(diameter);
}

} // namespace reference
