// SPDX-License-Identifier: MIT
//
// The clouds that are an envelope and noise which eats into it: stratus,
// cirrus, fog and plume. The envelope alone says which leaves are empty.
#include "cloud_shapes.hpp"

#include <algorithm>
#include <cmath>

namespace cloud
{

namespace
{

class enveloped : public shape
{
  public:
    enveloped(box_size size, uint32_t seed)
        : size_(size),
          seed_(seed), mid_{0.5f * float(size.x - 1), 0.5f * float(size.y - 1),
                            0.5f * float(size.z - 1)}
    {
    }

    bool fill_leaf(vec3 corner, float *density) const override
    {
        if (envelope(leaf_centre(corner)) + slope_ * leaf_radius <= 0)
            return false;
        for_leaf(corner, density, [this](vec3 p) {
            const float e = envelope(p);
            if (e <= 0)
                return 0.0f;
            return quantise(eroded(p, e) * box_window(p, size_));
        });
        return true;
    }

  protected:
    // Positive wherever there may be density; changes by at most slope_ per
    // voxel.
    virtual float envelope(vec3 p) const = 0;
    virtual float eroded(vec3 p, float envelope) const = 0;

    // 1 in the middle, 0 from the ellipse that touches the sides: so a sheet
    // ends in the box without showing the box.
    float ellipse(vec3 p, float inner) const
    {
        const float x = (p.x - mid_.x) / mid_.x, z = (p.z - mid_.z) / mid_.z;
        return 1 - smoothstep(inner, 1, x * x + z * z);
    }

    const box_size size_;
    const uint32_t seed_;
    const vec3 mid_;
    float slope_ = 0;
};

// Octaves of Worley bumps, 0..1, from cells of `cell` voxels down to the
// grid's resolution.
float bumps(vec3 p, float cell, uint32_t seed)
{
    float sum = 0, weight = 1, total = 0;
    for (int i = 0; i < 6 && cell >= 3; i++) {
        sum += weight * worley(p * (1 / cell), seed + uint32_t(i));
        total += weight;
        weight *= 0.55f;
        cell *= 0.47f;
    }
    return total > 0 ? sum / total : 0.5f;
}

// Octaves of a Perlin fBm that the grid can resolve.
int octaves_for(float cell)
{
    int n = 1;
    for (; n < 7 && cell >= 6; n++)
        cell *= 0.5f;
    return n;
}

float fbm(vec3 p, float cell, uint32_t seed)
{
    return perlin_fbm(p * (1 / cell), octaves_for(cell), seed);
}

// A flat sheet that breaks up towards its rim.
class stratus : public enveloped
{
  public:
    stratus(box_size size, uint32_t seed) : enveloped(size, seed)
    {
        unit_ = float(std::max(size.x, size.z));
        half_ = 0.42f * float(size.y);
        slope_ = 2.4f / half_; // |y - mid| <= 1.2 half_ in the box
    }

  private:
    float envelope(vec3 p) const override
    {
        const float y = (p.y - mid_.y) / half_;
        return 1 - y * y;
    }

    float eroded(vec3 p, float e) const override
    {
        const vec3 q =
            p + perlin_vector(p * (9 / unit_), seed_) * (0.025f * unit_);
        const vec3 flat = {q.x, 0.35f * q.y, q.z};
        const float cover = 0.9f * ellipse(p, 0.1f) - 0.5f +
                            1.7f * fbm(flat, 0.2f * unit_, seed_ + 10);
        // Thin cover is also thin in height.
        const float body = std::min(cover, 0.6f) - 0.55f * (1 - e);
        if (body <= -0.05f)
            return 0;
        const float d =
            body + 0.1f - 0.55f * bumps(q, 0.08f * unit_, seed_ + 20);
        return 0.8f * smoothstep(0, 0.3f, d);
    }

    float unit_, half_;
};

// Fibres along x that sink and trail behind (mares' tails), in patches.
class cirrus : public enveloped
{
  public:
    cirrus(box_size size, uint32_t seed) : enveloped(size, seed)
    {
        unit_ = float(size.x);
        half_ = 0.48f * float(size.y);
        slope_ = 2.1f / half_;
    }

  private:
    float envelope(vec3 p) const override
    {
        const float y = (p.y - mid_.y) / half_;
        return 1 - y * y;
    }

    float eroded(vec3 p, float e) const override
    {
        // Ice that fell farther has been left farther behind by the wind.
        const float fallen = 1 - p.y / float(size_.y);
        const vec3 sway = perlin_vector(p * (3.5f / unit_), seed_);
        vec3 q = p + sway * (0.07f * unit_);
        q.x += 0.5f * unit_ * fallen * fallen;
        q.z += 0.12f * unit_ * fallen + 0.15f * (p.x - mid_.x);
        const vec3 broad = {0.35f * q.x, q.y, q.z};
        const float patch = fbm(broad, 0.2f * unit_, seed_ + 10) +
                            0.75f * ellipse(p, 0) - 0.42f;
        if (patch <= 0)
            return 0;
        const float fine =
            fbm({0.09f * q.x, q.y, q.z}, 0.035f * unit_, seed_ + 20);
        const float fibre = 0.45f + 1.3f * fine;
        const float d =
            fibre * smoothstep(0, 0.5f, patch) * smoothstep(0, 0.7f, e) - 0.08f;
        return d <= 0 ? 0 : 0.9f * d * clamp01(d * 3);
    }

    float unit_, half_;
};

// Densest at the ground, with a soft rolling top.
class fog : public enveloped
{
  public:
    fog(box_size size, uint32_t seed) : enveloped(size, seed)
    {
        unit_ = float(std::max(size.x, size.z));
        top_ = 0.95f * float(size.y);
        slope_ = 1 / top_;
    }

  private:
    float envelope(vec3 p) const override
    {
        return 1 - p.y / top_;
    }

    float eroded(vec3 p, float e) const override
    {
        const vec3 q =
            p + perlin_vector(p * (5 / unit_), seed_) * (0.04f * unit_);
        const float roll = fbm({q.x, 2 * q.y, q.z}, 0.3f * unit_, seed_ + 10);
        const float d =
            e - 0.45f + 0.9f * roll - 0.8f * (1 - ellipse(p, 0.25f));
        return d <= 0 ? 0
                      : smoothstep(0, 0.8f, d) *
                            (0.75f + 0.5f * fbm(q, 0.1f * unit_, seed_ + 20));
    }

    float unit_, top_;
};

// A rising column of smoke that widens as it takes in air: a dense core at
// the source, rolling edges, veils of a hundredth of the core's density.
class plume : public enveloped
{
  public:
    plume(box_size size, uint32_t seed) : enveloped(size, seed)
    {
        tall_ = float(size.y);
        wide_ = 0.5f * float(std::min(size.x, size.z));
        unit_ = std::min(tall_, 4 * wide_);
        // Across, 1 / radius(0). Upwards, u / radius() * 0.6 wide_ / tall_
        // with u <= 1.9 and less than 0.5 beyond it in reach of a leaf.
        slope_ = 6.7f / wide_ + 10 / tall_;
    }

  private:
    // Entrainment makes a plume's radius linear in height (Morton, Taylor &
    // Turner 1956).
    float radius(float y) const
    {
        return wide_ * (0.15f + 0.6f * y / tall_);
    }

    static float square(float x)
    {
        return x * x;
    }

    float envelope(vec3 p) const override
    {
        const float x = p.x - mid_.x, z = p.z - mid_.z;
        return 1.9f - std::sqrt(x * x + z * z) / radius(std::max(0.0f, p.y));
    }

    float eroded(vec3 p, float) const override
    {
        const float h = p.y / tall_;
        const float r = radius(p.y);
        // Large swings of the axis, growing with height, then eddies.
        const vec3 swing =
            perlin_vector({0, p.y * (2.2f / tall_), 0.5f}, seed_);
        const vec3 eddy = perlin_vector(p * (9 / unit_), seed_ + 10);
        const vec3 curl = perlin_vector(p * (22 / unit_), seed_ + 20);
        const vec3 q = p + swing * (1.1f * r * clamp01(2 * h)) +
                       eddy * (0.4f * r) + curl * (0.1f * r);
        const float x = q.x - mid_.x, z = q.z - mid_.z;
        const float u = std::sqrt(x * x + z * z) / r;
        float body = 1 - 1.1f * u - 0.6f * smoothstep(0.75f, 1, h + 0.15f * u);
        if (body <= -0.9f)
            return 0;
        const float cell = 0.11f * unit_;
        body += 0.5f - 1.5f * bumps(q, cell, seed_ + 30) +
                0.5f * fbm(q, cell, seed_ + 40);
        if (body <= 0)
            return 0;
        // Mixing thins the smoke with height and towards the edge.
        const float core = square(clamp01(1.3f * body));
        const float thinned = 1 / (1 + 2.5f * h);
        return 0.012f * smoothstep(0, 0.12f, body) +
               1.2f * thinned * core * smoothstep(0, 0.3f, body);
    }

    float tall_, wide_, unit_;
};

} // namespace

std::unique_ptr<shape> make_stratus(box_size size, uint32_t seed)
{
    return std::make_unique<stratus>(size, seed);
}

std::unique_ptr<shape> make_cirrus(box_size size, uint32_t seed)
{
    return std::make_unique<cirrus>(size, seed);
}

std::unique_ptr<shape> make_fog(box_size size, uint32_t seed)
{
    return std::make_unique<fog>(size, seed);
}

std::unique_ptr<shape> make_plume(box_size size, uint32_t seed)
{
    return std::make_unique<plume>(size, seed);
}

} // namespace cloud
