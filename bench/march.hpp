// SPDX-License-Identifier: MIT
//
// The march of docs/DESIGN.md as somebody would write it over a peer's lookup,
// in floating point: the same lattice, jitter and ends as the core's. `style`
// holds what a user may or may not do for speed; none of it moves a sample.
//
// A field has
//     real at(real x, real y, real z)        density at an index position
//     int dim(real x, real y, real z)        side of the node around it, in
//                                            which density is 0; 1: unknown
#ifndef BRUME_BENCH_MARCH_HPP
#define BRUME_BENCH_MARCH_HPP

#include <cmath>

#include "view.hpp"

namespace BENCH_NAMESPACE
{

using bench::strips;
using bench::view;

// Styles: all that a user does; and what is written down first.
struct plain {
    static constexpr bool one_exp = false;     // per light march, not sample
    static constexpr bool box_ends = false;    // of light rays
    static constexpr bool leaps = false;       // view rays, over empty nodes
    static constexpr bool light_leaps = false; // uniform light rays
};

struct tuned : plain {
    static constexpr bool one_exp = true, box_ends = true, leaps = true;
};

struct leaping : tuned {
    static constexpr bool light_leaps = true;
};

template <class real> struct vector3 {
    real x, y, z;
};

template <class real> vector3<real> of(const double v[3])
{
    return {static_cast<real>(v[0]), static_cast<real>(v[1]),
            static_cast<real>(v[2])};
}

template <class real>
vector3<real> along(const vector3<real> &p, const vector3<real> &d, real t)
{
    return {p.x + d.x * t, p.y + d.y * t, p.z + d.z * t};
}

template <class real, class field, class how> class marcher
{
  public:
    using vec = vector3<real>;

    marcher(const view &v, field &f)
        : view_(v), field_(f), eye_(of<real>(v.eye)), sun_(of<real>(v.sun)),
          low_(of<real>(v.low)), high_(of<real>(v.high)),
          step_(static_cast<real>(v.step)),
          scale_(static_cast<real>(-v.density_scale * v.step)),
          light_scale_(static_cast<real>(-v.light_density_scale)),
          bias_(v.trilinear ? real(0) : real(0.5))
    {
    }

    void render(strips rows, float *out)
    {
        for (int y = 0; y < view_.height; y++)
            if (rows.has(y / strips::strip_rows))
                for (int x = 0; x < view_.width; x++)
                    out[y * view_.width + x] = pixel(x, y);
    }

  private:
    float pixel(int x, int y)
    {
        const real u = x + real(0.5) - view_.width * real(0.5);
        const real v = view_.height * real(0.5) - y - real(0.5);
        const size_t i = static_cast<size_t>(y) * view_.width + x;
        vec d = along(along(of<real>(view_.ahead), of<real>(view_.right), u),
                      of<real>(view_.up), v);
        const real scale = 1 / std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
        d = {d.x * scale, d.y * scale, d.z * scale};
        return static_cast<float>(
            march(d, static_cast<real>(view_.jitter[i]),
                  static_cast<real>(view_.light_jitter[i])));
    }

    static void clip_axis(real o, real d, real low, real high, real &in,
                          real &out)
    {
        if (d == 0) {
            if (o < low || o > high)
                out = -1;
            return;
        }
        const real a = (low - o) / d, b = (high - o) / d;
        in = std::fmax(in, std::fmin(a, b));
        out = std::fmin(out, std::fmax(a, b));
    }

    real march(const vec &d, real jitter, real light_jitter)
    {
        real in = 0, out = real(1e9);
        clip_axis(eye_.x, d.x, low_.x, high_.x, in, out);
        clip_axis(eye_.y, d.y, low_.y, high_.y, in, out);
        clip_axis(eye_.z, d.z, low_.z, high_.z, in, out);
        if (in > out)
            return 0;
        real light = 0, transmittance = 1;
        const real min_density = static_cast<real>(view_.min_density);
        const int last = static_cast<int>(std::ceil(out / step_ - jitter));
        int k = static_cast<int>(std::floor(in / step_ - jitter));
        for (k = k < 0 ? 0 : k; k <= last; k++) {
            const vec p = along(eye_, d, (k + jitter) * step_);
            const real density = field_.at(p.x, p.y, p.z);
            if (!(density > min_density)) {
                if (how::leaps && density == 0)
                    k += leap(p, d, step_);
                continue;
            }
            const real kept = std::exp(scale_ * density);
            light += transmittance * (1 - kept) * sunlight(p, light_jitter);
            transmittance *= kept;
            if (transmittance < view_.min_transmittance)
                break;
        }
        return light * static_cast<real>(view_.albedo);
    }

    // Samples to leave out after one at p that found nothing: those that are
    // in the same empty node for certain, by a margin for rounding.
    int leap(const vec &p, const vec &d, real step)
    {
        const int dim = field_.dim(p.x, p.y, p.z);
        if (dim <= 1)
            return 0;
        const real side = static_cast<real>(dim), far = real(1e9);
        real way = far;
        const real at[3] = {p.x + bias_, p.y + bias_, p.z + bias_};
        const real to[3] = {d.x, d.y, d.z};
        for (int i = 0; i < 3; i++) {
            // A trilinear lookup also reads the voxels after its own.
            const real in = at[i] - std::floor(at[i] / side) * side;
            const real room =
                to[i] > 0 ? side - (view_.trilinear ? 1 : 0) - in : in;
            const real most = to[i] == 0 ? far : room / std::fabs(to[i]);
            if (view_.trilinear && in > side - 1)
                return 0;
            way = most < way ? most : way;
        }
        way = (way - real(0.001)) / step;
        return way > 0 ? static_cast<int>(way) : 0;
    }

    bool outside(const vec &p) const
    {
        return p.x < low_.x || p.y < low_.y || p.z < low_.z || p.x > high_.x ||
               p.y > high_.y || p.z > high_.z;
    }

    real sunlight(const vec &p, real jitter)
    {
        return view_.uniform ? uniform(p) : doubling(p, jitter);
    }

    real doubling(const vec &p, real jitter)
    {
        real sum = 0, product = 1, s = static_cast<real>(view_.light_step);
        for (int i = 0; i < view_.light_samples; i++, s *= 2) {
            const vec q = along(p, sun_, s * (1 + jitter));
            if (how::box_ends && outside(q))
                break;
            const real density = field_.at(q.x, q.y, q.z);
            if (how::one_exp)
                sum += density * s;
            else
                product *= std::exp(light_scale_ * density * s);
        }
        return how::one_exp ? std::exp(light_scale_ * sum) : product;
    }

    real uniform(const vec &p)
    {
        const real s = static_cast<real>(view_.light_step);
        const real scale = light_scale_ * s;
        real sum = 0, product = 1;
        for (int i = 0; i < view_.light_samples; i++) {
            const vec q = along(p, sun_, (i + real(0.5)) * s);
            if (how::box_ends && outside(q))
                break;
            const real density = field_.at(q.x, q.y, q.z);
            if (how::light_leaps && density == 0)
                i += leap(q, sun_, s);
            else if (how::one_exp)
                sum += density;
            else
                product *= std::exp(scale * density);
        }
        return how::one_exp ? std::exp(scale * sum) : product;
    }

    const view &view_;
    field &field_;
    const vec eye_, sun_, low_, high_;
    const real step_, scale_, light_scale_, bias_;
};

} // namespace BENCH_NAMESPACE

#endif
