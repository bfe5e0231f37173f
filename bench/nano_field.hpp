// SPDX-License-Identifier: MIT
//
// NanoVDB's own samplers as fields. Included twice in the program, by files
// with different flags: each has its own name for the namespace `nanovdb`, or
// the linker would take one compilation of an inline function for both.
#ifndef BRUME_BENCH_NANO_FIELD_HPP
#define BRUME_BENCH_NANO_FIELD_HPP

#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/Ray.h>
#include <nanovdb/util/SampleFromVoxels.h>

#include "march.hpp"
#include "peers.hpp"

namespace BENCH_NAMESPACE
{

template <class access> struct build_of;
template <class build, int a, int b, int c>
struct build_of<nanovdb::ReadAccessor<build, a, b, c>> {
    using type = build;
};

// `access` says which levels of the tree are remembered: nanovdb::ReadAccessor.
template <class real, class access, int order> class nano_field
{
  public:
    using grid_type = nanovdb::NanoGrid<typename build_of<access>::type>;

    explicit nano_field(const void *grid)
        : accessor_(static_cast<const grid_type *>(grid)->tree().root()),
          sampler_(accessor_)
    {
    }

    real at(real x, real y, real z)
    {
        return static_cast<real>(sampler_(nanovdb::Vec3<real>(x, y, z)));
    }

    int dim(real x, real y, real z)
    {
        const real bias = order == 0 ? real(0.5) : real(0);
        const nanovdb::Coord ijk = floor(x + bias, y + bias, z + bias);
        const auto dim = accessor_.getDim(ijk, nanovdb::Ray<float>());
        // Active tiles are as large as empty ones.
        return dim > 1 && accessor_.getValue(ijk) == 0 ? static_cast<int>(dim)
                                                       : 1;
    }

  protected:
    static nanovdb::Coord floor(real x, real y, real z)
    {
        return {nanovdb::Floor(x), nanovdb::Floor(y), nanovdb::Floor(z)};
    }

    access accessor_;
    nanovdb::SampleFromVoxels<access, order, false> sampler_;
};

// A trilinear lookup that asks for its leaf once when all eight voxels are in
// it, which NanoVDB's sampler does not.
template <class real, class access>
class leaf_field : public nano_field<real, access, 1>
{
  public:
    using nano_field<real, access, 1>::nano_field;

    real at(real x, real y, real z)
    {
        const nanovdb::Coord c = this->floor(x, y, z);
        if ((c[0] & 7) == 7 || (c[1] & 7) == 7 || (c[2] & 7) == 7)
            return nano_field<real, access, 1>::at(x, y, z);
        const auto *leaf = this->accessor_.probeLeaf(c);
        if (!leaf)
            return static_cast<real>(this->accessor_.getValue(c));
        const uint32_t i = leaf->CoordToOffset(c);
        const real u = x - c[0], v = y - c[1], w = z - c[2];
        const auto row = [leaf, w](uint32_t n) {
            const real a = leaf->getValue(n), b = leaf->getValue(n + 1);
            return a + w * (b - a);
        };
        const auto plane = [row, v](uint32_t n) {
            const real a = row(n), b = row(n + 8);
            return a + v * (b - a);
        };
        const real a = plane(i), b = plane(i + 64);
        return a + u * (b - a);
    }
};

template <class field, class how>
void render(const void *grid, const view &v, strips rows, float *out)
{
    field f(grid);
    marcher<float, field, how>(v, f).render(rows, out);
}

template <class build, class how>
void nano_render(const void *grid, const view &v, strips rows, float *out)
{
    using access = nanovdb::DefaultReadAccessor<build>;
    if (v.trilinear)
        render<nano_field<float, access, 1>, how>(grid, v, rows, out);
    else
        render<nano_field<float, access, 0>, how>(grid, v, rows, out);
}

} // namespace BENCH_NAMESPACE

#endif
