// SPDX-License-Identifier: MIT
#include "cloud_shapes.hpp"

#include <algorithm>
#include <cmath>

namespace cloud
{

float box_window(vec3 p, box_size size)
{
    const float x = std::min(p.x, float(size.x - 1) - p.x);
    const float y = std::min(p.y, float(size.y - 1) - p.y);
    const float z = std::min(p.z, float(size.z - 1) - p.z);
    const float shortest = float(std::min({size.x, size.y, size.z}));
    const float width = std::min(3.0f, 0.06f * shortest);
    return clamp01((std::min({x, y, z}) + 0.25f) / width);
}

namespace
{

class sphere : public shape
{
  public:
    sphere(box_size size, uint32_t)
        : centre_{0.5f * float(size.x - 1), 0.5f * float(size.y - 1),
                  0.5f * float(size.z - 1)},
          radius_(0.4f * float(std::min({size.x, size.y, size.z})))
    {
    }

    bool fill_leaf(vec3 corner, float *density) const override
    {
        const vec3 to = leaf_centre(corner) - centre_;
        const float far = radius_ + leaf_radius;
        if (dot(to, to) > far * far)
            return false;
        for_leaf(corner, density, [this](vec3 p) {
            const vec3 v = p - centre_;
            return dot(v, v) <= radius_ * radius_ ? 1.0f : 0.0f;
        });
        return true;
    }

  private:
    const vec3 centre_;
    const float radius_;
};

class block : public shape
{
  public:
    block(box_size, uint32_t)
    {
    }

    bool fill_leaf(vec3, float *density) const override
    {
        std::fill(density, density + leaf_voxels, 1.0f);
        return true;
    }
};

class ramp : public shape
{
  public:
    ramp(box_size size, uint32_t) : last_(float(size.x - 1))
    {
    }

    bool fill_leaf(vec3 corner, float *density) const override
    {
        for_leaf(corner, density, [this](vec3 p) { return p.x / last_; });
        return true;
    }

  private:
    const float last_;
};

class voxel : public shape
{
  public:
    voxel(box_size size, uint32_t)
        : at_{float(size.x / 2), float(size.y / 2), float(size.z / 2)}
    {
    }

    bool fill_leaf(vec3 corner, float *density) const override
    {
        const vec3 v = at_ - corner;
        const float end = leaf_side;
        if (v.x < 0 || v.y < 0 || v.z < 0 || v.x >= end || v.y >= end ||
            v.z >= end)
            return false;
        std::fill(density, density + leaf_voxels, 0.0f);
        density[int(v.x) << 6 | int(v.y) << 3 | int(v.z)] = 1;
        return true;
    }

  private:
    const vec3 at_;
};

template <typename form>
std::unique_ptr<shape> make(box_size size, uint32_t seed)
{
    return std::make_unique<form>(size, seed);
}

} // namespace

const std::vector<shape_type> &shape_types()
{
    static const std::vector<shape_type> types = {
        {"cumulus",
         "a heaped cloud: flat base, cauliflower tops (default)",
         {1, 0.7f, 1},
         0.35f,
         make_cumulus},
        {"stratus",
         "a flat sheet, broken towards its rim",
         {1, 0.16f, 1},
         0.5f,
         make_stratus},
        {"cirrus",
         "thin wind-swept streaks",
         {1, 0.25f, 0.7f},
         0.5f,
         make_cirrus},
        {"plume",
         "a rising turbulent smoke column: dense core, thin veils",
         {0.5f, 1, 0.5f},
         0.45f,
         make_plume},
        {"fog",
         "a low smooth bank, densest at the ground",
         {1, 0.15f, 1},
         0.7f,
         make_fog},
        {"sphere",
         "density 1 within 0.4 of the shortest side of the centre",
         {1, 1, 1},
         0.05f,
         make<sphere>},
        {"block", "density 1 in the whole box", {1, 1, 1}, 0.02f, make<block>},
        {"ramp",
         "density 0 to 1 along x, from the first voxel to the last",
         {1, 1, 1},
         1,
         make<ramp>},
        {"voxel",
         "one voxel of density 1 in the middle",
         {1, 1, 1},
         0,
         make<voxel>},
    };
    return types;
}

} // namespace cloud
