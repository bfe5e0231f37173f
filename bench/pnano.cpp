// SPDX-License-Identifier: MIT
//
// PNanoVDB.h, the C99 form of NanoVDB, with its read accessor. Its functions
// are inline and the same in C and C++. Flags are those of nano_tuned.cpp.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#define PNANOVDB_C
#include <nanovdb/PNanoVDB.h>

#define BENCH_NAMESPACE portable
#include "march.hpp"
#include "peers.hpp"

namespace portable
{

using bench::grids;

template <bool trilinear> class field
{
  public:
    explicit field(const grids &g)
        : buffer_(pnanovdb_make_buf(
              static_cast<uint32_t *>(const_cast<void *>(g.nano)),
              g.nano_bytes / 4))
    {
        const pnanovdb_grid_handle_t grid = {pnanovdb_address_null()};
        const pnanovdb_tree_handle_t tree =
            pnanovdb_grid_get_tree(buffer_, grid);
        pnanovdb_readaccessor_init(&accessor_,
                                   pnanovdb_tree_get_root(buffer_, tree));
    }

    float at(float x, float y, float z)
    {
        if (!trilinear)
            return voxel({floor(x + 0.5F), floor(y + 0.5F), floor(z + 0.5F)});
        const pnanovdb_coord_t c = {floor(x), floor(y), floor(z)};
        const float u = x - c.x, v = y - c.y, w = z - c.z;
        return mix(mix(row(c, 0, 0, w), row(c, 0, 1, w), v),
                   mix(row(c, 1, 0, w), row(c, 1, 1, w), v), u);
    }

    int dim(float x, float y, float z)
    {
        const float bias = trilinear ? 0.0F : 0.5F;
        const pnanovdb_coord_t c = {floor(x + bias), floor(y + bias),
                                    floor(z + bias)};
        const uint32_t dim = pnanovdb_readaccessor_get_dim(
            PNANOVDB_GRID_TYPE_FLOAT, buffer_, &accessor_, &c);
        return dim > 1 && voxel(c) == 0 ? static_cast<int>(dim) : 1;
    }

  private:
    static int floor(float x)
    {
        return static_cast<int>(std::floor(x));
    }
    static float mix(float a, float b, float w)
    {
        return a + w * (b - a);
    }

    float row(const pnanovdb_coord_t &c, int dx, int dy, float w)
    {
        return mix(voxel({c.x + dx, c.y + dy, c.z}),
                   voxel({c.x + dx, c.y + dy, c.z + 1}), w);
    }

    float voxel(const pnanovdb_coord_t &c)
    {
        const pnanovdb_address_t address =
            pnanovdb_readaccessor_get_value_address(PNANOVDB_GRID_TYPE_FLOAT,
                                                    buffer_, &accessor_, &c);
        return pnanovdb_read_float(buffer_, address);
    }

    pnanovdb_buf_t buffer_;
    pnanovdb_readaccessor_t accessor_;
};

} // namespace portable

namespace bench
{

template <bool trilinear>
static void render(const grids &g, const view &v, strips rows, float *out)
{
    using field = portable::field<trilinear>;
    field f(g);
    portable::marcher<float, field, portable::tuned>(v, f).render(rows, out);
}

void pnano(const grids &g, const view &v, strips rows, float *out)
{
    v.trilinear ? render<true>(g, v, rows, out)
                : render<false>(g, v, rows, out);
}

} // namespace bench
