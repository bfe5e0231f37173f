// SPDX-License-Identifier: MIT
#include "puffs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cloud
{

namespace
{

// Width of the rounded crease around a puff, of its radius: enough to join
// it to its parent, little enough to keep the cauliflower's creases.
const float blend_of_radius = 0.22f;

// A child half sunk in a puff that is not its parent would not be seen.
const float buried_depth = 0.55f;

float length(vec3 a)
{
    return std::sqrt(dot(a, a));
}

bool buried(const std::vector<puff> &puffs, size_t count, size_t parent,
            const puff &child)
{
    for (size_t i = 0; i < count; i++) {
        const vec3 d = child.centre - puffs[i].centre;
        const float r = puffs[i].radius - buried_depth * child.radius;
        if (i != parent && r > 0 && dot(d, d) < r * r)
            return true;
    }
    return false;
}

} // namespace

box3 puff_bounds(const std::vector<puff> &puffs)
{
    const float far = 1e30f;
    box3 b = {{far, far, far}, {-far, -far, -far}};
    for (const puff &q : puffs) {
        b.low.x = std::min(b.low.x, q.centre.x - q.radius);
        b.low.y = std::min(b.low.y, q.centre.y - q.radius);
        b.low.z = std::min(b.low.z, q.centre.z - q.radius);
        b.high.x = std::max(b.high.x, q.centre.x + q.radius);
        b.high.y = std::max(b.high.y, q.centre.y + q.radius);
        b.high.z = std::max(b.high.z, q.centre.z + q.radius);
    }
    return b;
}

size_t sprout(std::vector<puff> &puffs, size_t first, const sprout_rules &rules,
              uint32_t seed)
{
    const size_t count = puffs.size();
    for (size_t parent = first; parent < count; parent++) {
        hash_stream random(hash3(int32_t(parent), 1, 0, seed));
        const puff from = puffs[parent];
        // Some parents stay nearly bare: a real cloud is smooth in places.
        const float bare = random.unit();
        const int tries = int(float(rules.tries) * mix(0.35f, 1, bare));
        for (int i = 0; i < tries; i++) {
            vec3 up = random.direction() + vec3{0, rules.lift, 0};
            up = up * (1 / std::max(length(up), 1e-3f));
            const float shrink = random.range(rules.shrink[0], rules.shrink[1]);
            const float out = from.radius * random.range(0.78f, 0.96f);
            const puff child = {from.centre + up * out, from.radius * shrink};
            if (child.radius >= rules.min_radius &&
                !buried(puffs, count, parent, child))
                puffs.push_back(child);
        }
    }
    return count;
}

// The quadratic blend, whose slope stays within 1.
float smooth_min(float a, float b, float k)
{
    const float h = k - std::fabs(a - b);
    const float least = a < b ? a : b;
    return h > 0 ? least - h * h / (4 * k) : least;
}

puff_field::puff_field(std::vector<puff> puffs, const box3 &domain, float reach)
    : puffs_(std::move(puffs)), reach_(reach)
{
    const float low[3] = {domain.low.x, domain.low.y, domain.low.z};
    const float high[3] = {domain.high.x, domain.high.y, domain.high.z};
    float longest = 0;
    for (int a = 0; a < 3; a++)
        longest = std::max(longest, high[a] - low[a]);
    pitch_ = std::max(pitch_, longest / 80); // keeps the lists small
    for (int a = 0; a < 3; a++) {
        origin_[a] = low[a];
        count_[a] = 1 + int((high[a] - low[a]) / pitch_);
    }
    float max_blend = 0;
    for (const puff &q : puffs_)
        max_blend = std::max(max_blend, blend_of_radius * q.radius);
    reach_ += max_blend;

    // Count, then place: one array, no list per bin.
    const size_t bins = bin_number(0, 0, count_[2]);
    std::vector<uint32_t> fill(bins + 1, 0);
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < puffs_.size(); i++) {
            const range3 r = bins_near(puffs_[i]);
            for (int z = r.low[2]; z <= r.high[2]; z++)
                for (int y = r.low[1]; y <= r.high[1]; y++)
                    for (int x = r.low[0]; x <= r.high[0]; x++) {
                        uint32_t &at = fill[bin_number(x, y, z)];
                        if (pass)
                            members_[at] = uint32_t(i);
                        at++;
                    }
        }
        if (pass)
            break;
        uint32_t total = 0;
        for (uint32_t &n : fill)
            n = std::exchange(total, total + n);
        bin_start_ = fill;
        members_.resize(total);
    }
}

size_t puff_field::bin_number(int x, int y, int z) const
{
    return (size_t(z) * size_t(count_[1]) + size_t(y)) * size_t(count_[0]) +
           size_t(x);
}

int puff_field::bin_along(float p, int axis) const
{
    const float b = (p - origin_[axis]) / pitch_;
    return b <= 0 ? 0 : std::min(int(b), count_[axis] - 1);
}

float puff_field::range_of(const puff &q) const
{
    return std::min(reach_, 3 * q.radius);
}

puff_field::range3 puff_field::bins_near(const puff &q) const
{
    const float c[3] = {q.centre.x, q.centre.y, q.centre.z};
    const float r = q.radius + range_of(q);
    range3 out;
    for (int a = 0; a < 3; a++) {
        out.low[a] = bin_along(c[a] - r, a);
        out.high[a] = bin_along(c[a] + r, a);
    }
    return out;
}

float puff_field::distance(vec3 p) const
{
    const size_t bin =
        bin_number(bin_along(p.x, 0), bin_along(p.y, 1), bin_along(p.z, 2));
    float d = reach_;
    for (uint32_t i = bin_start_[bin]; i < bin_start_[bin + 1]; i++) {
        const puff &q = puffs_[members_[i]];
        const float k = blend_of_radius * q.radius;
        const vec3 v = p - q.centre;
        // No root for what is too far to change d.
        const float near = d + k + q.radius;
        const float squared = dot(v, v);
        if (near <= 0 || squared >= near * near)
            continue;
        float to = std::sqrt(squared) - q.radius;
        if (to > q.radius && 3 * q.radius < reach_) {
            const float t = (to - q.radius) / (2 * q.radius);
            to += (reach_ + k) * t * t; // no influence from 3 radii on
        }
        d = smooth_min(d, to, k);
    }
    return d;
}

} // namespace cloud
