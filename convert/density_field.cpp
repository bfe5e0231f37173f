// SPDX-License-Identifier: MIT
//
// Within a cube between eight voxels, trilinear density along a ray is a cubic
// polynomial of the distance: two points of Gauss and Legendre integrate it
// exactly. Rays are followed from cell to cell, and from cube to cube where a
// cell has any density (Amanatides and Woo, "A Fast Voxel Traversal Algorithm
// for Ray Tracing", 1987).
#include "density_field.hpp"

#include <cmath>
#include <limits>
#include <tbb/parallel_for.h>

#include "decoder.hpp"

namespace bake
{

namespace
{

constexpr int corner_side = 9;

// A ray through cubes of a grid, `scale` of them to a voxel.
class walk
{
  public:
    // From `p`, in cubes of the grid, which must be in a grid of `size`.
    walk(const double p[3], const double d[3], double scale, const int size[3])
    {
        for (int a = 0; a < 3; a++) {
            const double v = d[a] * scale;
            const int last = size[a] - 1;
            const int i = int(std::floor(p[a]));
            size_[a] = size[a];
            cube[a] = i < 0 ? 0 : i > last ? last : i;
            step_[a] = v > 0 ? 1 : -1;
            per_[a] = v != 0 ? std::fabs(1 / v) : never;
            next_[a] = v != 0 ? (cube[a] + (v > 0) - p[a]) / v : never;
        }
    }

    // Where the ray leaves the cube, in voxels from its start.
    double end() const
    {
        return next_[axis()];
    }

    // Goes to the next cube. False when there is none.
    bool go()
    {
        const int a = axis();

        next_[a] += per_[a];
        cube[a] += step_[a];
        return cube[a] >= 0 && cube[a] < size_[a];
    }

    int cube[3];

  private:
    static constexpr double never = std::numeric_limits<double>::infinity();

    int axis() const
    {
        const int a = next_[1] < next_[0];

        return next_[2] < next_[a] ? 2 : a;
    }

    int size_[3], step_[3];
    double next_[3], per_[3];
};

double mix(double a, double b, double w)
{
    return a + w * (b - a);
}

// Between the eight voxels from `v` on.
double trilinear(const uint16_t *v, double x, double y, double z)
{
    const uint16_t *u = v + corner_side * corner_side;
    const int row = corner_side;

    return mix(mix(mix(v[0], v[1], x), mix(v[row], v[row + 1], x), y),
               mix(mix(u[0], u[1], x), mix(u[row], u[row + 1], x), y), z);
}

// The integral of t in [0, length] over the cubes of a cell, from `p` in it.
double through_cell(const uint16_t *units, const double p[3], const double d[3],
                    double length)
{
    static const double gauss = 0.5 / std::sqrt(3.0);
    static const int size[3] = {block_side, block_side, block_side};
    walk w(p, d, 1, size);
    double sum = 0, from = 0;

    do {
        const double to = std::min(w.end(), length);
        const int *c = w.cube;
        const uint16_t *v =
            units + c[0] + corner_side * (c[1] + corner_side * c[2]);
        for (const double side : {-gauss, gauss}) {
            const double t = (from + to) / 2 + side * (to - from);
            sum += (to - from) / 2 *
                   trilinear(v, p[0] + t * d[0] - c[0], p[1] + t * d[1] - c[1],
                             p[2] + t * d[2] - c[2]);
        }
        from = to;
    } while (from < length && w.go());
    return sum;
}

} // namespace

density_field::density_field(const layout &l, const brick_pool &p)
    : cells_{l.cells.x, l.cells.y, l.cells.z}, index_(l.cell_count())
{
    const decoder pool(l, p);
    std::vector<ijk> used;

    unit_ = pool.unit();
    for (size_t i = 0; i < index_.size(); i++) {
        const size_t nx = size_t(l.cells.x), ny = size_t(l.cells.y);
        const ijk c = {int(i % nx), int(i / nx % ny), int(i / nx / ny)};
        bool any = false;
        for (int n = 0; n < 8; n++)
            any = any || pool.brick_at({c.x + (n & 1), c.y + (n >> 1 & 1),
                                        c.z + (n >> 2)}) != block_map::none;
        index_[i] = any ? uint32_t(used.size()) : block_map::none;
        if (any)
            used.push_back(c);
    }
    require_memory(double(used.size()) * sizeof(corners),
                   "the voxels that light passes");
    corners_.resize(used.size());
    tbb::parallel_for(size_t(0), used.size(), [&](size_t i) {
        uint16_t *to = corners_[i].units;
        for (int z = 0; z < corner_side; z++)
            for (int y = 0; y < corner_side; y++)
                for (int x = 0; x < corner_side; x++)
                    *to++ = pool.at(8 * used[i].x + x, 8 * used[i].y + y,
                                    8 * used[i].z + z);
    });
}

double density_field::depth(double x, double y, double z, direction way) const
{
    const double p[3] = {x, y, z}, in_cells[3] = {x / 8, y / 8, z / 8};
    const double d[3] = {way.x, way.y, way.z};
    walk w(in_cells, d, 1.0 / block_side, cells_);
    double sum = 0, from = 0;

    do {
        const double to = w.end();
        if (const corners *c = at(w.cube)) {
            double start[3];
            for (int a = 0; a < 3; a++)
                start[a] = p[a] + from * d[a] - block_side * w.cube[a];
            sum += through_cell(c->units, start, d, to - from);
        }
        from = to;
    } while (w.go());
    return sum * unit_;
}

} // namespace bake
