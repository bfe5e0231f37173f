// SPDX-License-Identifier: MIT
#include "resample.hpp"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace bake
{

namespace
{

// How far from equal lengths and right angles, relative, counts as uniform:
// transforms stored as float have errors around 1e-7.
constexpr double shape_tolerance = 1e-5;

struct vec {
    double v[3];
};

// Columns are where the index axes point to in the world.
struct matrix {
    double m[3][3];

    vec operator*(const vec &p) const
    {
        vec r = {};
        for (int i = 0; i < 3; i++)
            r.v[i] = m[i][0] * p.v[0] + m[i][1] * p.v[1] + m[i][2] * p.v[2];
        return r;
    }
    vec column(int c) const
    {
        return {{m[0][c], m[1][c], m[2][c]}};
    }
};

double dot(const vec &a, const vec &b)
{
    return a.v[0] * b.v[0] + a.v[1] * b.v[1] + a.v[2] * b.v[2];
}

double length(const vec &a)
{
    return std::sqrt(dot(a, a));
}

matrix linear_part(const volume &vol)
{
    matrix r;

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            r.m[i][j] = vol.world[4 * i + j];
    return r;
}

double cofactor(const matrix &a, int r, int c)
{
    const int r1 = (r + 1) % 3, r2 = (r + 2) % 3;
    const int c1 = (c + 1) % 3, c2 = (c + 2) % 3;

    return a.m[r1][c1] * a.m[r2][c2] - a.m[r1][c2] * a.m[r2][c1];
}

double determinant(const matrix &a)
{
    return a.m[0][0] * cofactor(a, 0, 0) + a.m[0][1] * cofactor(a, 0, 1) +
           a.m[0][2] * cofactor(a, 0, 2);
}

matrix inverse(const matrix &a)
{
    const double det = determinant(a);
    matrix r;

    if (!std::isfinite(1 / det))
        throw failure("its transform cannot be inverted");
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            r.m[i][j] = cofactor(a, j, i) / det;
    return r;
}

bool at_right_angles(const matrix &a)
{
    for (int i = 0; i < 3; i++) {
        const vec p = a.column(i), q = a.column((i + 1) % 3);
        if (std::fabs(dot(p, q)) > shape_tolerance * length(p) * length(q))
            return false;
    }
    return true;
}

double smallest_voxel(const matrix &a)
{
    return std::min(
        {length(a.column(0)), length(a.column(1)), length(a.column(2))});
}

// The new linear part: `size` times a rotation.
matrix uniform_axes(const matrix &a, double size)
{
    matrix r = {{{size, 0, 0}, {0, size, 0}, {0, 0, size}}};

    if (!at_right_angles(a))
        return r;
    for (int j = 0; j < 3; j++) {
        // A mirrored grid is turned round along x: a rotation has none.
        const double turn = j == 0 && determinant(a) < 0 ? -1 : 1;
        const double scale = turn * size / length(a.column(j));
        for (int i = 0; i < 3; i++)
            r.m[i][j] = a.m[i][j] * scale;
    }
    return r;
}

// Trilinear lookup between voxel centres; what is not stored is 0.
class sampler
{
  public:
    explicit sampler(const volume &vol) : vol_(vol), map_(vol)
    {
    }

    float at(const vec &p) const
    {
        int32_t i[3];
        double f[3], sum = 0;

        for (int a = 0; a < 3; a++) {
            const double lower = std::floor(p.v[a]);
            i[a] = int32_t(lower);
            f[a] = p.v[a] - lower;
        }
        for (int c = 0; c < 8; c++) {
            const int x = c & 1, y = c >> 1 & 1, z = c >> 2;
            const double w = (x ? f[0] : 1 - f[0]) * (y ? f[1] : 1 - f[1]) *
                             (z ? f[2] : 1 - f[2]);
            if (w > 0)
                sum += w * double(voxel({i[0] + x, i[1] + y, i[2] + z}));
        }
        return float(sum);
    }

    // Is a block stored in any of these cells?
    bool any_block(ijk lo, ijk hi) const
    {
        for (int z = lo.z; z <= hi.z; z++)
            for (int y = lo.y; y <= hi.y; y++)
                for (int x = lo.x; x <= hi.x; x++)
                    if (map_.at({x, y, z}) != block_map::none)
                        return true;
        return false;
    }

  private:
    float voxel(ijk p) const
    {
        const uint32_t b = map_.at({floor8(p.x), floor8(p.y), floor8(p.z)});
        if (b == block_map::none)
            return 0;
        const block &k = vol_.blocks[b];
        return k.voxels ? k.voxels[(p.x & 7) + 8 * (p.y & 7) + 64 * (p.z & 7)]
                        : k.value;
    }

    const volume &vol_;
    block_map map_;
};

// The box of corners lo and hi under a linear map, in doubles.
struct extent {
    double lo[3], hi[3];
};

extent transformed(const matrix &m, const vec &lo, const vec &hi,
                   const vec &shift)
{
    extent e = {{INFINITY, INFINITY, INFINITY},
                {-INFINITY, -INFINITY, -INFINITY}};

    for (int c = 0; c < 8; c++) {
        const vec p =
            m * vec{{c & 1 ? hi.v[0] : lo.v[0], c & 2 ? hi.v[1] : lo.v[1],
                     c & 4 ? hi.v[2] : lo.v[2]}};
        for (int a = 0; a < 3; a++) {
            e.lo[a] = std::min(e.lo[a], p.v[a] + shift.v[a]);
            e.hi[a] = std::max(e.hi[a], p.v[a] + shift.v[a]);
        }
    }
    return e;
}

// The cells that an extent of voxels touches, with a voxel of margin.
box cells_of(const extent &e)
{
    int32_t lo[3], hi[3];

    for (int a = 0; a < 3; a++) {
        if (!(e.lo[a] > -1e9 && e.hi[a] < 1e9))
            throw failure("resampled to cubes it would span more than 2^30 "
                          "voxels");
        lo[a] = floor8(int32_t(std::floor(e.lo[a])) - 1);
        hi[a] = floor8(int32_t(std::ceil(e.hi[a])) + 1);
    }
    return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
}

box cells_of(const volume &vol)
{
    box b = {vol.blocks[0].cell, vol.blocks[0].cell};

    for (const block &k : vol.blocks) {
        b.lo = {std::min(b.lo.x, k.cell.x), std::min(b.lo.y, k.cell.y),
                std::min(b.lo.z, k.cell.z)};
        b.hi = {std::max(b.hi.x, k.cell.x), std::max(b.hi.y, k.cell.y),
                std::max(b.hi.z, k.cell.z)};
    }
    return b;
}

// The new cells that may hold something.
std::vector<block> find_cells(const sampler &source, const matrix &to_source,
                              const vec &shift, const box &range)
{
    std::vector<block> list;

    for (int z = range.lo.z; z <= range.hi.z; z++)
        for (int y = range.lo.y; y <= range.hi.y; y++)
            for (int x = range.lo.x; x <= range.hi.x; x++) {
                const vec lo = {{8.0 * x, 8.0 * y, 8.0 * z}};
                const vec hi = {{lo.v[0] + 7, lo.v[1] + 7, lo.v[2] + 7}};
                const box b = cells_of(transformed(to_source, lo, hi, shift));
                if (source.any_block(b.lo, b.hi))
                    list.push_back({{x, y, z}, 0, nullptr});
            }
    return list;
}

// One octant: `child` averaged to 4x4x4 voxels.
void average(const block &child, float *out)
{
    float scratch[block_voxels];
    const float *v = expand(child, scratch);

    for (int z = 0; z < 4; z++)
        for (int y = 0; y < 4; y++)
            for (int x = 0; x < 4; x++) {
                const float *p = v + 2 * x + 16 * y + 128 * z;
                double sum = 0;
                for (int k : {0, 1, 8, 9, 64, 65, 72, 73})
                    sum += double(p[k]);
                out[x + 8 * y + 64 * z] = float(sum / 8);
            }
}

ijk parent(const block &b)
{
    return {b.cell.x >> 1, b.cell.y >> 1, b.cell.z >> 1};
}

bool by_parent(const block &a, const block &b)
{
    const ijk p = parent(a), q = parent(b);

    if (p.z != q.z)
        return p.z < q.z;
    return p.y != q.y ? p.y < q.y : p.x < q.x;
}

// children[0 .. count) share a parent.
void average_family(const block *children, size_t count, block &out,
                    float *voxels)
{
    const auto same = [&](const block &b) {
        return !b.voxels && b.value == children[0].value;
    };

    out.cell = parent(children[0]);
    out.value = children[0].value;
    out.voxels = nullptr;
    if (count == 8 && std::all_of(children, children + 8, same))
        return;
    std::fill_n(voxels, block_voxels, 0.0f);
    for (size_t i = 0; i < count; i++) {
        const ijk c = children[i].cell;
        average(children[i],
                voxels + 4 * (c.x & 1) + 32 * (c.y & 1) + 256 * (c.z & 1));
    }
    out.voxels = voxels;
}

} // namespace

volume halve(const volume &in)
{
    volume out;
    std::vector<block> children = in.blocks;
    std::vector<size_t> first;

    for (int i = 0; i < 12; i++)
        out.world[i] = in.world[i] * (i % 4 < 3 ? 2 : 1);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out.world[4 * i + 3] += in.world[4 * i + j] / 2;
    std::sort(children.begin(), children.end(), by_parent);
    for (size_t i = 0; i < children.size(); i++)
        if (i == 0 || !(parent(children[i]) == parent(children[i - 1])))
            first.push_back(i);
    out.blocks.resize(first.size());
    float *chunk = new_chunk(out, first.size());
    first.push_back(children.size());
    tbb::parallel_for(size_t(0), out.blocks.size(), [&](size_t i) {
        average_family(&children[first[i]], first[i + 1] - first[i],
                       out.blocks[i], chunk + i * block_voxels);
    });
    return out;
}

bool is_uniform(const volume &vol)
{
    const matrix m = linear_part(vol);
    const double size = smallest_voxel(m);

    for (int a = 0; a < 3; a++)
        if (length(m.column(a)) > size * (1 + shape_tolerance))
            return false;
    return at_right_angles(m) && determinant(m) > 0;
}

volume resample_to(const volume &in, const double world[12])
{
    volume out;

    std::copy_n(world, 12, out.world);
    if (in.blocks.empty())
        return out;
    const matrix old = linear_part(in), now = linear_part(out);
    const matrix from_old = inverse(now), to_old = inverse(old);
    matrix source, target; // new index to old index, and back
    vec way;               // of index 0

    for (int j = 0; j < 3; j++) {
        const vec s = to_old * now.column(j), t = from_old * old.column(j);
        for (int i = 0; i < 3; i++) {
            source.m[i][j] = s.v[i];
            target.m[i][j] = t.v[i];
        }
        way.v[j] = world[4 * j + 3] - in.world[4 * j + 3];
    }
    const vec shift = to_old * way;
    const vec back = from_old * vec{{-way.v[0], -way.v[1], -way.v[2]}};
    const box b = cells_of(in);
    const box range = cells_of(transformed(
        target, {{8.0 * b.lo.x - 1, 8.0 * b.lo.y - 1, 8.0 * b.lo.z - 1}},
        {{8.0 * b.hi.x + 8, 8.0 * b.hi.y + 8, 8.0 * b.hi.z + 8}}, back));
    require_memory((range.hi.x - range.lo.x + 1.0) *
                       (range.hi.y - range.lo.y + 1.0) *
                       (range.hi.z - range.lo.z + 1.0) * 8,
                   "the grid resampled to cubes");
    const sampler from(in);
    out.blocks = find_cells(from, source, shift, range);
    require_memory(2100.0 * double(out.blocks.size()),
                   "the grid resampled to cubes");
    float *chunk = new_chunk(out, out.blocks.size());
    tbb::parallel_for(size_t(0), out.blocks.size(), [&](size_t i) {
        const ijk c = out.blocks[i].cell;
        float *v = chunk + i * block_voxels;
        for (int k = 0; k < block_voxels; k++) {
            vec p = source * vec{{8.0 * c.x + k % 8, 8.0 * c.y + k / 8 % 8,
                                  8.0 * c.z + k / 64}};
            for (int a = 0; a < 3; a++)
                p.v[a] += shift.v[a];
            v[k] = from.at(p);
        }
        out.blocks[i].voxels = v;
    });
    return out;
}

bool same_transform(const double a[12], const double b[12])
{
    const double size = std::hypot(a[0], a[4], a[8]);

    for (int i = 0; i < 12; i++)
        if (!(std::fabs(a[i] - b[i]) <= size * (i % 4 < 3 ? 1e-6 : 1e-4)))
            return false;
    return true;
}

volume make_uniform(const volume &in)
{
    const matrix old = linear_part(in);
    const matrix now = uniform_axes(old, smallest_voxel(old));
    double world[12];

    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            world[4 * i + j] = now.m[i][j];
        world[4 * i + 3] = in.world[4 * i + 3];
    }
    return resample_to(in, world);
}

} // namespace bake
