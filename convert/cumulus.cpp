// SPDX-License-Identifier: MIT
//
// A heaped cumulus: towers of spheres on a flat base, three or four
// generations of puffs on them, domain warping so that nothing stays a ball,
// and octaves of Worley bumps down to a few voxels.
#include "cloud_shapes.hpp"
#include "puffs.hpp"

#include <algorithm>
#include <cmath>

namespace cloud
{

namespace
{

const int max_octaves = 8;

// A generation of puffs or an octave of bumps is left out when it is finer
// than this, in voxels: it would only be noise.
const float finest_puff = 2.2f;
const float finest_cell = 2.8f;

// What varies slowly is sampled at the corners of leaves, 8 voxels apart,
// and interpolated: bumps of cells from this size on among it.
const float coarse_cell = 48;

// By how much d can differ between a voxel and the nearest sample: slope 2
// for the warped bulk and for each coarse octave, distance below 4.5.
const float sample_slack = 24;

class cumulus : public shape
{
  public:
    cumulus(box_size size, uint32_t seed);
    bool fill_leaf(vec3 corner, float *density) const override;

  private:
    std::vector<puff> heap(uint32_t seed) const;
    void fit(std::vector<puff> &puffs) const;
    std::vector<puff> grow(uint32_t seed) const;
    float domain_reach() const
    {
        return erosion_[0].left + 0.04f * unit_;
    }
    vec3 warped(vec3 p) const;
    float bulk(vec3 p, vec3 q) const;
    float bump(int i, vec3 p, vec3 q) const;
    float inside(float depth) const;
    float shreds(vec3 q) const;
    struct sample;
    sample sample_at(vec3 p) const;
    sample blend(const sample corner[8], vec3 t) const;
    float density_at(vec3 p, const sample &s) const;

    // An octave of bumps: d += height * (worley(q / cell) - mean).
    struct octave {
        float cell, height;
        float left; // how far this and the later ones can move the surface
    };

    const box_size size_;
    const uint32_t seed_;
    const float unit_; // the cloud's scale in voxels
    const float base_; // y of its flat base
    octave erosion_[max_octaves];
    int octaves_ = 0;
    int coarse_ = 0; // so many octaves are in the samples
    puff_field field_;
};

// Worley's mean is near 0.35; a little more keeps thin parts alive.
const float worley_mean = 0.4f;

float unit_of(box_size size)
{
    return std::min({float(size.x), float(size.y) / 0.7f, float(size.z)});
}

box3 padded_box(box_size size, float pad)
{
    return {{-pad, -pad, -pad},
            {float(size.x) + pad, float(size.y) + pad, float(size.z) + pad}};
}

cumulus::cumulus(box_size size, uint32_t seed)
    : size_(size), seed_(seed), unit_(unit_of(size)),
      base_(0.035f * unit_ + std::min(1.0f, 0.01f * unit_)), erosion_(),
      field_({}, padded_box(size, 0), 0)
{
    float cell = 0.12f * unit_;
    for (; octaves_ < max_octaves && cell >= finest_cell; octaves_++) {
        erosion_[octaves_].cell = cell;
        erosion_[octaves_].height = (0.43f + 0.04f * float(octaves_)) * cell;
        coarse_ += cell >= coarse_cell;
        cell *= 0.48f;
    }
    float left = 0;
    for (int i = octaves_ - 1; i >= 0; i--)
        erosion_[i].left = left += erosion_[i].height * (1 - worley_mean);
    const float pad = 0.06f * unit_; // warped() goes no farther
    field_ = puff_field(grow(hash3(0, 0, 0, seed)), padded_box(size, pad),
                        domain_reach());
}

// Towers stand in the base's ellipse, tall in the middle, and lean with the
// wind; each is a stack of spheres.
std::vector<puff> cumulus::heap(uint32_t seed) const
{
    hash_stream random(seed);
    const float wide = 0.5f * float(size_.x), deep = 0.5f * float(size_.z);
    const float area = wide * deep / (0.25f * unit_ * unit_);
    const int towers = std::clamp(int(13 * area), 13, 80);
    const vec3 lean = {random.range(-0.2f, 0.2f), 0, random.range(-0.2f, 0.2f)};
    std::vector<puff> puffs;
    // A spiral of golden angles, shaken: even, and seldom alike.
    const float turn_cos = -0.7373688f, turn_sin = 0.6754903f;
    float c = 1, s = 0;
    for (int i = 0; i < towers; i++) {
        const float q = std::sqrt((float(i) + 0.3f) / float(towers));
        const float before = c;
        c = before * turn_cos - s * turn_sin;
        s = before * turn_sin + s * turn_cos;
        const float radius =
            unit_ * mix(0.19f, 0.10f, q) * random.range(0.8f, 1.15f);
        const float high =
            unit_ * mix(0.66f, 0.16f, q) * random.range(0.7f, 1.0f);
        const float shake_x = radius * random.range(-0.3f, 0.3f);
        const float shake_z = radius * random.range(-0.3f, 0.3f);
        const float x = (wide - radius) * q * c + shake_x;
        const float z = (deep - radius) * q * s + shake_z;
        float r = radius;
        for (float y = 0.35f * r; y + r < high || y < r; y += 0.75f * r) {
            const vec3 jitter = random.direction() * (0.28f * r);
            puffs.push_back({vec3{x, base_ + y, z} + lean * y + jitter, r});
            r *= random.range(0.84f, 1.0f);
        }
    }
    return puffs;
}

// Scales and moves the heap so that it fills the box, less a margin for
// what grows on it.
void cumulus::fit(std::vector<puff> &puffs) const
{
    const box3 b = puff_bounds(puffs);
    const float margin = 0.045f * unit_ + std::min(2.0f, 0.02f * unit_);
    const float room = float(size_.y) - margin - base_;
    const float scale =
        std::min({(float(size_.x) - 2 * margin) / (b.high.x - b.low.x),
                  room / (b.high.y - base_),
                  (float(size_.z) - 2 * margin) / (b.high.z - b.low.z)});
    const vec3 from = {0.5f * (b.low.x + b.high.x), base_,
                       0.5f * (b.low.z + b.high.z)};
    const vec3 to = {0.5f * float(size_.x), base_, 0.5f * float(size_.z)};
    // A heap that is limited by its width is drawn up, its spheres left round.
    const float lift =
        std::clamp(room / (scale * (b.high.y - base_)), 1.0f, 1.3f);
    for (puff &q : puffs) {
        q = {(q.centre - from) * scale + to, q.radius * scale};
        q.centre.y = mix(base_, q.centre.y, lift);
    }
}

std::vector<puff> cumulus::grow(uint32_t seed) const
{
    std::vector<puff> puffs = heap(seed);
    size_t first = 0;
    for (int generation = 0; generation < 4; generation++) {
        static const int tries[4] = {18, 18, 16, 14};
        const sprout_rules rules = {tries[generation],
                                    {0.26f, 0.52f},
                                    0.35f,
                                    generation ? finest_puff : 0};
        first = sprout(puffs, first, rules, seed + uint32_t(generation) + 1);
        if (generation == 0)
            fit(puffs);
    }
    return puffs;
}

vec3 cumulus::warped(vec3 p) const
{
    const vec3 coarse = perlin_vector(p * (1 / (0.24f * unit_)), seed_ + 1000);
    const vec3 fine = perlin_vector(p * (1 / (0.09f * unit_)), seed_ + 2000);
    return p + coarse * (0.035f * unit_) + fine * (0.014f * unit_);
}

// Signed distance to the cloud before erosion. q is p, warped.
float cumulus::bulk(vec3 p, vec3 q) const
{
    const float floor = base_ + 0.02f * (q.y - p.y);
    return -smooth_min(-field_.distance(q), p.y - floor, 0.03f * unit_);
}

// From the skin inwards: what a ray sees first is thinner than the core.
float cumulus::inside(float depth) const
{
    return mix(0.6f, 1.0f, smoothstep(0, 0.09f * unit_, depth));
}

float cumulus::shreds(vec3 q) const
{
    const float cell = std::max(0.03f * unit_, 2 * finest_cell);
    return perlin_worley(q * (1 / cell), 2, seed_ + 5000);
}

// Fainter at the base, which stays flat.
float cumulus::bump(int i, vec3 p, vec3 q) const
{
    const octave &o = erosion_[i];
    const float rise = (p.y - base_) / (0.1f * unit_);
    const float w = worley(q * (1 / o.cell), seed_ + 4000 + uint32_t(i));
    return o.height * mix(0.3f, 1, clamp01(rise)) * (w - worley_mean);
}

// What density_at() needs that varies slowly.
struct cumulus::sample {
    vec3 q; // the warped position
    float bulk;
    float bumps; // sum of the coarse octaves
    float width; // of the edge: crisp, or frayed in places and at the base
};

cumulus::sample cumulus::sample_at(vec3 p) const
{
    sample s;
    s.q = warped(p);
    s.bulk = bulk(p, s.q);
    s.bumps = 0;
    for (int i = 0; i < coarse_; i++)
        s.bumps += bump(i, p, s.q);
    const float fray = 0.5f + perlin(p * (1 / (0.2f * unit_)), seed_ + 3000);
    const float crisp = std::min(1.2f, 0.02f * unit_);
    s.width =
        crisp + unit_ * mix(0.001f, 0.03f,
                            smoothstep(0.5f, 1.0f,
                                       fray + 0.3f * (base_ - p.y) / unit_));
    return s;
}

cumulus::sample cumulus::blend(const sample corner[8], vec3 t) const
{
    sample out = {};
    for (int i = 0; i < 8; i++) {
        const float w = (i & 1 ? t.x : 1 - t.x) * (i & 2 ? t.y : 1 - t.y) *
                        (i & 4 ? t.z : 1 - t.z);
        out.q = out.q + corner[i].q * w;
        out.bulk += corner[i].bulk * w;
        out.bumps += corner[i].bumps * w;
        out.width += corner[i].width * w;
    }
    return out;
}

float cumulus::density_at(vec3 p, const sample &s) const
{
    const float start = bulk(p, s.q);
    float d = start + s.bumps;
    for (int i = coarse_; i < octaves_; i++) {
        if (d > erosion_[i].left)
            return 0;
        if (d < -erosion_[i].left - s.width)
            break;
        d += bump(i, p, s.q);
    }
    float edge = smoothstep(0, s.width, -d);
    if (edge > 0 && edge < 1) { // Schneider's remap: noise eats thin parts
        const float fray = smoothstep(0.005f, 0.02f, s.width / unit_);
        edge = clamp01(edge - 1.2f * fray * (1 - edge) * shreds(s.q));
    }
    return quantise(inside(-start) * edge * box_window(p, size_));
}

bool cumulus::fill_leaf(vec3 corner, float *density) const
{
    const float side = leaf_side;
    sample s[9];
    float least = 1e30f, most = -1e30f, width = 0;
    for (int i = 0; i < 9; i++) {
        const vec3 at =
            i == 8 ? vec3{0.5f, 0.5f, 0.5f}
                   : vec3{float(i & 1), float(i >> 1 & 1), float(i >> 2)};
        s[i] = sample_at(corner + at * side);
        const float d = s[i].bulk + s[i].bumps;
        least = std::min(least, d);
        most = std::max(most, d);
        width = std::max(width, s[i].width);
    }
    const float left = coarse_ < octaves_ ? erosion_[coarse_].left : 0;
    if (least > left + sample_slack)
        return false;
    const bool deep = most < -left - width - sample_slack;
    for_leaf(corner, density, [&](vec3 p) {
        const sample here = blend(s, (p - corner) * (1 / side));
        if (deep)
            return quantise(inside(-here.bulk) * box_window(p, size_));
        return density_at(p, here);
    });
    return true;
}

} // namespace

std::unique_ptr<shape> make_cumulus(box_size size, uint32_t seed)
{
    return std::make_unique<cumulus>(size, seed);
}

} // namespace cloud
