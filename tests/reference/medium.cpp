// SPDX-License-Identifier: MIT

#include "medium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace reference
{

static const double infinity = std::numeric_limits<double>::infinity();

// The cells of a grid along a ray, after Amanatides and Woo 1987: cubes of
// `side`, a corner of one at (shift, shift, shift), from where the ray enters
// the volume's box to where it leaves it.
struct medium::walk {
    int cell[3];
    double t, t_next, t_end; // the ray is in `cell` for t .. t_next

    walk(const ray &r, const volume &v, double side, double shift);
    bool done() const
    {
        return t >= t_end;
    }
    void advance();

  private:
    void enter(int axis, double o, double d, double side);
    void find_next();

    int turn_[3];
    double crossing_[3], between_[3];
    int axis_;
};

// Narrows t .. t_end to where o + t * d is in low .. high.
static void clip(double o, double d, double low, double high, double &t,
                 double &t_end)
{
    if (d == 0) {
        if (o < low || o > high)
            t_end = -infinity;
        return;
    }
    const double a = (low - o) / d, b = (high - o) / d;
    t = std::max(t, std::min(a, b));
    t_end = std::min(t_end, std::max(a, b));
}

medium::walk::walk(const ray &r, const volume &v, double side, double shift)
    : t(0), t_next(0), t_end(infinity)
{
    const vec3 low = v.box_min(), high = v.box_max();
    const vec3 &o = r.origin, &d = r.direction;
    clip(o.x, d.x, low.x, high.x, t, t_end);
    clip(o.y, d.y, low.y, high.y, t, t_end);
    clip(o.z, d.z, low.z, high.z, t, t_end);
    if (done())
        return;
    enter(0, o.x - shift, d.x, side);
    enter(1, o.y - shift, d.y, side);
    enter(2, o.z - shift, d.z, side);
    find_next();
}

void medium::walk::enter(int axis, double o, double d, double side)
{
    const double at = (o + d * t) / side;
    double low = std::floor(at);
    if (d < 0 && at == low)
        low--;
    cell[axis] = static_cast<int>(low);
    turn_[axis] = d < 0 ? -1 : 1;
    between_[axis] = d == 0 ? infinity : side / std::fabs(d);
    crossing_[axis] =
        d == 0 ? infinity : ((d < 0 ? low : low + 1) * side - o) / d;
}

void medium::walk::find_next()
{
    axis_ = crossing_[0] < crossing_[1] ? 0 : 1;
    if (crossing_[2] < crossing_[axis_])
        axis_ = 2;
    // Rounding may put the first crossing a trifle before t.
    t_next = std::max(t, std::min(crossing_[axis_], t_end));
}

void medium::walk::advance()
{
    t = crossing_[axis_];
    cell[axis_] += turn_[axis_];
    crossing_[axis_] += between_[axis_];
    find_next();
}

/// Majorants ///

// Cell c holds the points cube * c <= p < cube * (c + 1), per axis; c from -1.
// Both lookups read voxels from floor(p) to floor(p) + 1 only.
medium::medium(const volume &v, lookup filter) : volume_(v), filter_(filter)
{
    size_t count = 1;
    for (size_t a = 0; a < 3; a++) {
        cubes_[a] = v.size()[a] / cube + 2;
        count *= static_cast<size_t>(cubes_[a]);
    }
    majorants_.assign(count, 0);
    for (size_t n = 0; n < count; n++) {
        const int at = static_cast<int>(n);
        const int low[3] = {
            (at % cubes_[0] - 1) * cube,
            (at / cubes_[0] % cubes_[1] - 1) * cube,
            (at / (cubes_[0] * cubes_[1]) - 1) * cube,
        };
        const int side = cube + 1;
        for (int i = 0; i < side * side * side; i++) {
            const double d =
                v.voxel(low[0] + i % side, low[1] + i / side % side,
                        low[2] + i / (side * side));
            majorants_[n] = std::max(majorants_[n], static_cast<float>(d));
        }
    }
}

double medium::majorant(const int cell[3]) const
{
    size_t at = 0;
    for (int a = 2; a >= 0; a--) {
        if (cell[a] < -1 || cell[a] >= cubes_[a] - 1)
            return 0;
        at = at * static_cast<size_t>(cubes_[a]) +
             static_cast<size_t>(cell[a] + 1);
    }
    return static_cast<double>(majorants_[at]);
}

/// Tracking ///

// One exponential variate is spent across cells, at the rate of each one's
// majorant, until it runs out at a tentative collision.
double medium::collide(const ray &r, double scale, random_source &random) const
{
    double budget = random.exponential();
    for (walk w(r, volume_, cube, 0); !w.done(); w.advance()) {
        const double largest = majorant(w.cell), rate = scale * largest;
        double t = w.t;
        while (rate * (w.t_next - t) > budget) {
            t += budget / rate;
            const double d = density(r.origin + r.direction * t);
            if (random.uniform() * largest < d)
                return t;
            budget = random.exponential();
        }
        budget -= rate * (w.t_next - t);
    }
    return infinity;
}

// Below a tenth the estimate is rounded at random to nothing or a tenth.
double medium::ratio_track(const ray &r, double scale,
                           random_source &random) const
{
    const double small = 0.1;
    double estimate = 1, budget = random.exponential();
    for (walk w(r, volume_, cube, 0); !w.done(); w.advance()) {
        const double largest = majorant(w.cell), rate = scale * largest;
        double t = w.t;
        while (rate * (w.t_next - t) > budget) {
            t += budget / rate;
            estimate *= 1 - density(r.origin + r.direction * t) / largest;
            if (estimate < small) {
                if (random.uniform() * small >= estimate)
                    return 0;
                estimate = small;
            }
            budget = random.exponential();
        }
        budget -= rate * (w.t_next - t);
    }
    return estimate;
}

// Gauss's two points are exact for cubics; for constants, too.
double medium::depth(const ray &r) const
{
    const double shift = filter_ == lookup::nearest ? 0.5 : 0;
    const double off = 0.28867513459481288225; // 1 / (2 sqrt 3)
    double sum = 0;
    int cell[3];
    for (walk w(r, volume_, 1, shift); !w.done(); w.advance()) {
        for (int a = 0; a < 3; a++)
            cell[a] = (w.cell[a] + (w.cell[a] < 0) * (1 - cube)) / cube;
        if (filter_ == lookup::trilinear && majorant(cell) == 0)
            continue;
        const double length = w.t_next - w.t, middle = w.t + length / 2;
        for (double sign : {-1.0, 1.0}) {
            const double t = middle + sign * off * length;
            sum += length / 2 * density(r.origin + r.direction * t);
        }
    }
    return sum;
}

} // namespace reference
