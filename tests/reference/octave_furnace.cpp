// SPDX-License-Identifier: MIT

#include "octave_furnace.hpp"

#include <algorithm>
#include <cmath>

#include "phase_sampling.hpp"

namespace reference
{

// Directions drawn from P_i stand for the mean over directions of P_i.
double octave_furnace(const medium &m, double scale, double albedo,
                      const phase_model &phase, const octave_model &model,
                      const ray &r, random_source &random)
{
    const double t = m.collide(r, scale, random);
    if (std::isinf(t))
        return 1;
    const vec3 p = r.origin + r.direction * t;
    double sum = 0;
    for (int i = 0; i < model.count; i++) {
        const phase_model wider = widened(phase, std::pow(model.c, i));
        const vec3 sun = sample_way(wider, r.direction, random);
        sum += std::pow(model.b, i) *
               m.ratio_track({p, sun}, scale * std::pow(model.a, i), random);
    }
    return albedo * sum;
}

static double mean_of(int samples, const medium &m, double scale, double albedo,
                      const phase_model &phase, const octave_model &model,
                      const ray &r, uint64_t seed)
{
    random_source random({seed});
    double sum = 0;
    for (int n = 0; n < samples; n++)
        sum += octave_furnace(m, scale, albedo, phase, model, r, random);
    return sum / samples;
}

furnace furnace_of(const medium &m, const scene &s, const phase_model &phase,
                   double albedo, const octave_model &model)
{
    const int samples = 1000;
    const renderer camera(m.field(), s);
    furnace out = {0, 0};
    int covered = 0;
    for (int i = 0; i < s.width * s.height; i++) {
        const ray r = camera.camera_ray(i % s.width, i / s.width);
        if (s.density_scale * m.depth(r) < 0.01)
            continue;
        const double value = mean_of(samples, m, s.density_scale, albedo, phase,
                                     model, r, static_cast<uint64_t>(i));
        out.mean += value;
        out.top = std::max(out.top, value);
        covered++;
    }
    out.mean /= std::max(1, covered);
    return out;
}

furnace_peak furnace_of_cubes(const phase_model &phase, double albedo,
                              const octave_model &model)
{
    const int side = 8, samples = 20000;
    float_dump dump;
    dump.size = {side, side, side};
    dump.world_from_index = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    dump.voxels.assign(side * side * side, 1.0F);
    const volume v(std::move(dump), 1);
    const medium inside(v, lookup::nearest);
    const double middle = side / 2.0 - 0.5;
    const ray r = {{-2, middle, middle}, {1, 0, 0}};
    furnace_peak out = {0, 0};
    for (double depth = 0.125; depth <= 64; depth *= 2) {
        const double value =
            mean_of(samples, inside, depth / side, albedo, phase, model, r, 3);
        if (value > out.value)
            out = {value, depth};
    }
    return out;
}

} // namespace reference
