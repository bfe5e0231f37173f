// SPDX-License-Identifier: MIT
//
// Small OpenVDB files for tests/test_bake.sh: every value type, encoding and
// oddity that brume-bake must handle or refuse.
//
//     make_vdbs DIR
#include <fstream>
#include <limits>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>
#include <string>

using namespace openvdb;

namespace {

std::string folder;

template <class grid> void save(const char *name, const grid &g)
{
    io::File(folder + "/" + name).write(GridPtrVec{g});
}

template <class grid_type> typename grid_type::Ptr new_grid(const char *name)
{
    auto g = grid_type::create();

    g->setName(name);
    g->setGridClass(GRID_FOG_VOLUME);
    return g;
}

// A ball of radius r around (3,-5,20), densities 1..200: whole numbers, the
// same in every type.
template <class grid_type> typename grid_type::Ptr ball(int r)
{
    auto g = new_grid<grid_type>("density");
    auto a = g->getAccessor();

    for (int z = -r; z <= r; z++)
        for (int y = -r; y <= r; y++)
            for (int x = -r; x <= r; x++)
                if (x * x + y * y + z * z <= r * r) {
                    const int v = 1 + (x * 7 + y * 13 + z * 29 + 9999) % 200;
                    a.setValue(Coord(x + 3, y - 5, z + 20),
                               typename grid_type::ValueType(v));
                }
    return g;
}

void value_types()
{
    auto half = ball<FloatGrid>(12);

    save("float.vdb", ball<FloatGrid>(12));
    save("double.vdb", ball<DoubleGrid>(12));
    save("int32.vdb", ball<Int32Grid>(12));
    save("int64.vdb", ball<Int64Grid>(12));
    half->setSaveFloatAsHalf(true);
    save("half.vdb", half);
    save("bool.vdb", ball<BoolGrid>(12));
    auto mask = new_grid<MaskGrid>("density");
    mask->setTree(MaskTree::Ptr(
        new MaskTree(ball<BoolGrid>(12)->tree(), true, TopologyCopy())));
    save("mask.vdb", mask);
    // Streams have no table of offsets.
    std::ofstream out(folder + "/stream.vdb", std::ios::binary);
    io::Stream(out).write(GridPtrVec{ball<FloatGrid>(12)});
    io::File none(folder + "/none.vdb");
    none.setCompression(io::COMPRESS_NONE);
    none.write(GridPtrVec{ball<FloatGrid>(12)});
    save("points.vdb", new_grid<Vec3SGrid>("points"));
}

void encodings()
{
    auto g = ball<FloatGrid>(12);

    // The same voxels, inactive but for the corners of their box.
    const CoordBBox b = g->evalActiveVoxelBoundingBox();
    for (auto i = g->beginValueOn(); i; ++i)
        i.setValueOff();
    g->tree().setActiveState(b.min(), true);
    g->tree().setActiveState(b.max(), true);
    save("inactive.vdb", g);
    // A block of tiles, and the same as voxels.
    auto t = new_grid<FloatGrid>("density");
    t->sparseFill(CoordBBox(Coord(-16), Coord(300)), 0.5f, true);
    save("tiles.vdb", t);
    t->tree().voxelizeActiveTiles();
    save("filled.vdb", t);
}

void bad_values()
{
    auto g = ball<FloatGrid>(12);
    auto a = g->getAccessor();

    a.setValue(Coord(3, -5, 20), std::numeric_limits<float>::quiet_NaN());
    a.setValue(Coord(4, -5, 20), std::numeric_limits<float>::infinity());
    a.setValue(Coord(5, -5, 20), -1.0f);
    a.setValue(Coord(6, -5, 20), -2.0f);
    save("bad.vdb", g);
    auto n = new_grid<FloatGrid>("density");
    n->fill(CoordBBox(Coord(0), Coord(9)), -1.0f, true);
    save("negative.vdb", n);
    save("empty.vdb", new_grid<FloatGrid>("density"));
    // 2^48 voxels in 4096 tiles.
    auto h = new_grid<FloatGrid>("density");
    h->sparseFill(CoordBBox(Coord(0), Coord((1 << 16) - 1)), 1.0f, true);
    save("huge.vdb", h);
    // Two voxels, too far apart to index.
    auto w = new_grid<FloatGrid>("density");
    w->tree().setValue(Coord(0), 1.0f);
    w->tree().setValue(Coord(40000, 0, 0), 1.0f);
    save("wide.vdb", w);
}

void transforms()
{
    auto g = ball<FloatGrid>(12);

    g->setTransform(math::Transform::createLinearTransform(0.25));
    g->transform().postRotate(0.7, math::Y_AXIS);
    g->transform().postTranslate(Vec3d(1, 2, 3));
    save("rotated.vdb", g);
    auto stretched = ball<FloatGrid>(12);
    stretched->transform().preScale(Vec3d(1, 2, 1));
    save("stretched.vdb", stretched);
    auto sheared = ball<FloatGrid>(12);
    sheared->transform().postShear(0.5, math::X_AXIS, math::Y_AXIS);
    save("sheared.vdb", sheared);
    auto frustum = ball<FloatGrid>(12);
    frustum->setTransform(math::Transform::createFrustumTransform(
        BBoxd(Vec3d(0), Vec3d(100)), 0.5, 10));
    save("frustum.vdb", frustum);
}

void several()
{
    auto heat = ball<FloatGrid>(5), density = ball<FloatGrid>(12);

    heat->setName("heat");
    io::File(folder + "/two.vdb").write(GridPtrVec{heat, density});
    auto flame = ball<FloatGrid>(4);
    flame->setName("flame");
    io::File(folder + "/fire.vdb").write(GridPtrVec{heat, flame});
    auto named = ball<FloatGrid>(5);
    named->setName("a \"b\"\\\n");
    save("name.vdb", named);
}

// A second grid: of other voxels, in another place, of bad values, empty.
FloatGrid::Ptr heat_of(int r)
{
    auto heat = ball<FloatGrid>(r);

    heat->setName("heat");
    return heat;
}

void second_grids()
{
    const auto save_two = [](const char *name, const FloatGrid::Ptr &heat) {
        io::File(folder + "/" + name)
            .write(GridPtrVec{ball<FloatGrid>(12), heat});
    };
    auto moved = heat_of(5), finer = heat_of(9), bad = heat_of(5);

    moved->transform().postTranslate(Vec3d(20, 3, -40));
    save_two("heat_moved.vdb", moved);
    finer->transform().preScale(0.5);
    save_two("heat_finer.vdb", finer);
    bad->tree().setValue(Coord(3, -5, 20),
                         std::numeric_limits<float>::quiet_NaN());
    bad->tree().setValue(Coord(4, -5, 20), -1.0f);
    save_two("heat_bad.vdb", bad);
    save_two("heat_none.vdb", heat_of(-1));
    auto nothing = new_grid<FloatGrid>("density");
    io::File(folder + "/nothing.vdb").write(GridPtrVec{nothing, heat_of(-1)});
    io::File(folder + "/heat_only.vdb").write(GridPtrVec{heat_of(9)});
    auto frustum = heat_of(5);
    frustum->setTransform(math::Transform::createFrustumTransform(
        BBoxd(Vec3d(0), Vec3d(100)), 0.5, 10));
    save_two("heat_frustum.vdb", frustum);
}

void licences()
{
    auto g = ball<FloatGrid>(5);
    MetaMap meta;

    meta.insertMeta("Copyright", StringMetadata("CC0 of the file"));
    io::File(folder + "/licensed_file.vdb").write(GridPtrVec{g}, meta);
    g->insertMeta("license", StringMetadata("CC0 of the grid"));
    io::File(folder + "/licensed.vdb").write(GridPtrVec{g}, meta);
}

// Ones at even coordinates in zeros.
void lattice()
{
    auto g = new_grid<FloatGrid>("density");
    auto a = g->getAccessor();

    for (int i = 0; i < 16 * 16 * 16; i++)
        a.setValue(Coord(2 * (i % 16), 2 * (i / 16 % 16), 2 * (i / 256)), 1);
    save("lattice.vdb", g);
}

} // namespace

int main(int count, char **args)
{
    if (count != 2)
        return 2;
    folder = args[1];
    initialize();
    value_types();
    encodings();
    bad_values();
    transforms();
    several();
    second_grids();
    licences();
    lattice();
    return 0;
}
