// SPDX-License-Identifier: MIT

#include "lamps.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "scene_values.hpp"

namespace reference
{

/// Text ///

static std::string word_of(std::istream &in)
{
    std::string word;
    if (!(in >> word))
        throw std::runtime_error("the line ends too early");
    return word;
}

static lamp lamp_of(std::istream &in)
{
    lamp l;
    l.position = parse_vec3(word_of(in));
    l.radius = parse_positive(word_of(in));
    l.size = parse_positive(word_of(in));
    const std::vector<double> c = parse_list(word_of(in));
    if (c.size() != 1 && c.size() != 3)
        throw std::runtime_error("expected a grey or r,g,b");
    l.colour = {c[0], c[c.size() / 2], c[c.size() - 1]};
    for (std::string option; in >> option;) {
        if (parse_word(option, {"spot", "shadow"}) == 1) {
            l.shadow_samples =
                static_cast<int>(parse_integer(word_of(in), 0, 64));
            continue;
        }
        l.spot = true;
        l.direction = parse_vec3(word_of(in));
        l.inner = parse_in(word_of(in), 0, 179);
        l.outer = parse_in(word_of(in), l.inner, 179);
    }
    return l;
}

std::vector<lamp> read_lamps(const std::string &path)
{
    std::ifstream in(path);
    if (!in)
        throw std::runtime_error(path + ": cannot read");
    std::vector<lamp> lamps;
    std::string line;
    while (std::getline(in, line)) {
        std::istringstream item(line.substr(0, line.find('#')));
        if ((item >> std::ws).eof())
            continue;
        lamps.push_back(lamp_of(item));
    }
    return lamps;
}

/// Light ///

lamp_light::lamp_light(const volume &v, const scene &s, const air &a)
    : volume_(v), scene_(s), air_(a)
{
    // The volume knows points; lengths are those of a unit step in the world.
    const double scale =
        length(v.pool_from_world({1, 0, 0}) - v.pool_from_world({0, 0, 0}));
    for (const lamp &l : s.lit.lamps) {
        placed p{l,
                 v.pool_from_world(l.position),
                 {0, 0, 0},
                 l.radius * scale,
                 l.size * scale};
        if (l.spot)
            p.direction = v.pool_direction(normalise(l.direction));
        lamps_.push_back(p);
    }
}

static double smoothstep(double from, double to, double x)
{
    if (x <= from)
        return 0;
    if (x >= to)
        return 1;
    const double u = (x - from) / (to - from);
    return u * u * (3 - 2 * u);
}

// Samples go from p to the lamp.
double lamp_light::through(const placed &l, const vec3 &p, double jitter) const
{
    const int n = l.said.shadow_samples;
    const vec3 way = l.position - p;
    double sum = 0;
    for (int i = 0; i < n; i++) {
        const vec3 q = p + way * ((i + jitter) / n);
        if (volume_.contains(q))
            sum +=
                scene_.light_density_scale * volume_.density(q, scene_.filter);
        sum += air_.fog_at(q);
    }
    return n == 0 ? 1 : std::exp(-sum * length(way) / n);
}

double lamp_light::share(const placed &l, const vec3 &p, const vec3 &ray,
                         double jitter) const
{
    const double degree = 3.14159265358979323846 / 180;
    const vec3 way = l.position - p;
    const double r = length(way);
    if (r >= l.radius)
        return 0;
    const double near = l.size / std::max(r, l.size), far = r / l.radius;
    const double window = 1 - std::pow(far, 4);
    double light = near * near * window * window;
    if (r == 0) // of all directions, none
        return light;
    const vec3 towards = way * (1 / r);
    if (l.said.spot)
        light *= smoothstep(std::cos(l.said.outer * degree),
                            std::cos(l.said.inner * degree),
                            -dot(towards, l.direction));
    if (light == 0)
        return 0;
    return light * phase_value(scene_.lit.phase, dot(ray, towards)) *
           through(l, p, jitter);
}

vec3 lamp_light::at(const vec3 &p, const vec3 &ray, double jitter) const
{
    vec3 sum = {0, 0, 0};
    for (const placed &l : lamps_)
        sum = sum + l.said.colour * share(l, p, ray, jitter);
    return sum;
}

} // namespace reference
