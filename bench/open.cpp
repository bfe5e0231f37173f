// SPDX-License-Identifier: MIT
//
// OpenVDB itself: ConstAccessor and BoxSampler; and the conversion of a file
// into everything that peers read.
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include <nanovdb/util/OpenToNanoVDB.h>

#include <stdexcept>

#define BENCH_NAMESPACE opened
#include "march.hpp"
#include "peers.hpp"

namespace opened
{

template <class sampler> class field
{
  public:
    explicit field(const openvdb::FloatGrid &grid)
        : accessor_(grid.getConstAccessor())
    {
    }

    float at(float x, float y, float z)
    {
        return sampler::sample(accessor_, openvdb::Vec3R(x, y, z));
    }

    // The side of the tile around it; 1 where there are leaves.
    int dim(float x, float y, float z)
    {
        const double bias = sampler::radius() == 0 ? 0.5 : 0;
        const openvdb::Coord c =
            openvdb::Coord::floor(openvdb::Vec3R(x + bias, y + bias, z + bias));
        if (accessor_.getValue(c) != 0)
            return 1;
        switch (accessor_.getValueDepth(c)) {
        case -1: return 4096;
        case 1: return 128;
        case 2: return 8;
        default: return 1;
        }
    }

  private:
    openvdb::FloatGrid::ConstAccessor accessor_;
};

} // namespace opened

namespace bench
{

template <class sampler>
static void render(const grids &g, const view &v, strips rows, float *out)
{
    using field = opened::field<sampler>;
    field f(*static_cast<const openvdb::FloatGrid *>(g.open));
    opened::marcher<float, field, opened::tuned>(v, f).render(rows, out);
}

void open_tuned(const grids &g, const view &v, strips rows, float *out)
{
    if (v.trilinear)
        render<openvdb::tools::BoxSampler>(g, v, rows, out);
    else
        render<openvdb::tools::PointSampler>(g, v, rows, out);
}

/// Reading ///

struct owned {
    openvdb::FloatGrid::Ptr open;
    nanovdb::GridHandle<> nano, fp8;
};

static openvdb::FloatGrid::Ptr read_open(const std::string &path)
{
    openvdb::initialize();
    openvdb::io::File file(path);
    file.open(false); // no delayed loading
    const openvdb::GridPtrVecPtr all = file.getGrids();
    openvdb::FloatGrid::Ptr found;
    for (const openvdb::GridBase::Ptr &base : *all) {
        auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(base);
        if (grid && (!found || grid->getName() == "density"))
            found = grid;
    }
    if (!found)
        throw std::runtime_error(path + ": no grid of floats");
    return found;
}

static void set_transform(grids &g, const openvdb::FloatGrid &grid)
{
    const openvdb::Mat4R m =
        grid.transform().baseMap()->getAffineMap()->getMat4();
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) // vectors are rows there
            g.world_from_index[4 * row + column] = m(column, row);
}

grids read_grids(const std::string &path)
{
    auto own = std::make_shared<owned>();
    own->open = read_open(path);
    grids g{};
    set_transform(g, *own->open);
    const openvdb::CoordBBox box = own->open->evalActiveVoxelBoundingBox();
    for (int i = 0; i < 3; i++) {
        g.low[i] = box.min()[i];
        g.high[i] = box.max()[i];
    }
    own->nano = nanovdb::openToNanoVDB(*own->open);
    g.nano = own->nano.grid<float>();
    g.nano_bytes = own->nano.size();
    own->fp8 = nanovdb::openToNanoVDB<nanovdb::HostBuffer, openvdb::FloatTree,
                                      nanovdb::Fp8>(*own->open);
    g.nano_fp8 = own->fp8.grid<nanovdb::Fp8>();
    g.nano_fp8_bytes = own->fp8.size();
    g.open = own->open.get();
    g.open_bytes = own->open->memUsage();
    g.owner = own;
    return g;
}

} // namespace bench
