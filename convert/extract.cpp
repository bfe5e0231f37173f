// SPDX-License-Identifier: MIT
#include "extract.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>
#include <type_traits>

#include "stored_grid.hpp"

namespace bake
{

namespace
{

using openvdb::Coord;
using openvdb::CoordBBox;

// Leaves that one task reads: enough to amortise the task, few enough to
// share out small grids.
constexpr size_t batch_leaves = 256;

constexpr float largest = std::numeric_limits<float>::max();

// gcc's -O2 leaves these loops to the scalar unit, and so do floating-point
// exceptions, which nobody asks for.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC push_options
#pragma GCC optimize("O3", "no-trapping-math")
#endif

// A density as the asset can hold it, or 0.
template <class value> float clean(value v)
{
    const value positive = v > value(0) ? v : value(0); // NaN: 0

    if constexpr (std::is_floating_point_v<value>)
        return positive <= value(largest) ? float(positive) : 0;
    else
        return float(positive);
}

template <class value> bool is_bad(value v)
{
    if constexpr (std::is_floating_point_v<value>)
        return !(v >= 0 && v <= value(largest));
    else
        return v < value(0);
}

template <class value> void count_bad(bad_voxels &bad, value v, uint64_t n)
{
    if (!is_bad(v))
        return;
    if constexpr (std::is_floating_point_v<value>) {
        if (std::isnan(v)) {
            bad.nan += n;
            return;
        }
        if (std::fabs(v) > value(largest)) {
            bad.infinite += n;
            return;
        }
    }
    bad.negative += n;
}

struct tally {
    int bad = 0, used = 0;
};

// The voxels of a leaf, cleaned.
template <class value> tally clean_all(const value *v, float *kept)
{
    tally f;

    for (int i = 0; i < block_voxels; i++) {
        kept[i] = clean(v[i]);
        f.bad += is_bad(v[i]);
        f.used += kept[i] > 0;
    }
    return f;
}

// OpenVDB's leaves run z fastest, bricks x fastest.
void transpose(const float *from, float *to)
{
    for (int z = 0; z < block_side; z++)
        for (int y = 0; y < block_side; y++)
            for (int x = 0; x < block_side; x++)
                *to++ = from[64 * x + 8 * y + z];
}

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC pop_options
#endif

// A constant region of the tree.
struct tile {
    CoordBBox where;
    float value;
};

double cells_in(const CoordBBox &b)
{
    double cells = 1;

    for (int a = 0; a < 3; a++)
        cells *= double(floor8(b.max()[a])) - floor8(b.min()[a]) + 1;
    return cells;
}

uint64_t voxels_in(const CoordBBox &b)
{
    return uint64_t(b.volume());
}

template <class grid_type> class extractor
{
  public:
    extractor(grid_type &grid, progress &bar, extracted &out)
        : tree_(grid.tree()), stored_(dynamic_cast<const stored_grid *>(&grid)),
          bar_(bar), out_(out)
    {
    }

    void run()
    {
        box_ = tree_.root().beginChildAll() ? active_box() : CoordBBox();
        if (box_.empty())
            return;
        out_.active = tree_.activeVoxelCount();
        out_.background = double(tree_.background());
        find_tiles();
        find_background();
        tree_.getNodes(leaves_);
        check_size();
        read_leaves();
        for (const tile &t : tiles_)
            add_tile(t);
    }

  private:
    using tree_type = typename grid_type::TreeType;
    using leaf_type = typename tree_type::LeafNodeType;
    using value = typename tree_type::ValueType;

    CoordBBox active_box() const
    {
        CoordBBox b;

        return tree_.evalActiveVoxelBoundingBox(b) ? b : CoordBBox();
    }

    void note_tile(CoordBBox where, value v)
    {
        where.intersect(box_);
        if (where.empty())
            return;
        count_bad(out_.bad, v, voxels_in(where));
        if (clean(v) > 0)
            tiles_.push_back({where, clean(v)});
    }

    void find_tiles()
    {
        auto it = tree_.cbeginValueAll();

        it.setMaxDepth(it.getLeafDepth() - 1);
        for (; it; ++it) {
            CoordBBox where;
            it.getBoundingBox(where);
            note_tile(where, it.getValue());
        }
    }

    // What the root has no entry for, in boxes of the root's own grain.
    void find_background()
    {
        const value v = tree_.background();
        const int grain = int(tree_type::RootNodeType::ChildNodeType::DIM);

        if (clean(v) == 0 && !is_bad(v))
            return;
        require_memory(cells_in(box_) * sizeof(block),
                       "a volume full of its background");
        Coord c, lo = box_.min();
        for (int a = 0; a < 3; a++)
            lo[a] &= ~(grain - 1);
        for (c[2] = lo[2]; c[2] <= box_.max()[2]; c[2] += grain)
            for (c[1] = lo[1]; c[1] <= box_.max()[1]; c[1] += grain)
                for (c[0] = lo[0]; c[0] <= box_.max()[0]; c[0] += grain)
                    if (tree_.getValueDepth(c) < 0)
                        note_tile(CoordBBox::createCube(c, grain), v);
    }

    // Before anything grows: what will it take?
    void check_size() const
    {
        double tiles = 0;

        for (const tile &t : tiles_)
            tiles += cells_in(t.where);
        if (tiles + double(leaves_.size()) >= double(UINT32_MAX))
            throw failure(text("%.3g cells have voxels; the format indexes "
                               "2^31",
                               tiles + double(leaves_.size())));
        require_memory(tiles * sizeof(block) +
                           double(leaves_.size()) *
                               (sizeof(block) + 4 * block_voxels),
                       "the voxels of this grid");
    }

    // Leaves that one task reads. `in` stands before them when their voxels
    // are still in the file.
    struct batch {
        size_t first, count;
        std::shared_ptr<stored_grid::reader> in;
        std::vector<block> *found;
    };

    // One task at a time finds out where in the file the leaves of a batch
    // begin, the others read them.
    void read_leaves()
    {
        std::vector<std::vector<block>> found(
            (leaves_.size() + batch_leaves - 1) / batch_leaves);
        std::unique_ptr<stored_grid::reader> walk;
        size_t next = 0;

        if (stored_ != nullptr)
            walk = std::make_unique<stored_grid::reader>(*stored_);
        bar_.stage("read", leaves_.size());
        const auto share_out = [&](tbb::flow_control &flow) -> batch {
            const size_t first = next;
            if (first == leaves_.size()) {
                flow.stop();
                return {};
            }
            next = std::min(first + batch_leaves, leaves_.size());
            batch b = {first, next - first, nullptr,
                       &found[first / batch_leaves]};
            if (walk) {
                b.in =
                    std::make_shared<stored_grid::reader>(*stored_, walk->at());
                for (size_t i = first; i < next; i++)
                    skip(*walk, *leaves_[i]);
            }
            return b;
        };
        tbb::parallel_pipeline(
            2 * size_t(tbb::this_task_arena::max_concurrency()),
            tbb::make_filter<void, batch>(tbb::filter_mode::serial_in_order,
                                          share_out) &
                tbb::make_filter<batch, void>(
                    tbb::filter_mode::parallel,
                    [&](const batch &b) { read_batch(b); }));
        for (const auto &list : found)
            out_.vol.blocks.insert(out_.vol.blocks.end(), list.begin(),
                                   list.end());
    }

    void read_batch(const batch &b)
    {
        std::unique_ptr<float[]> voxels(new float[b.count * block_voxels]);
        float *to = voxels.get();
        bad_voxels bad;

        for (size_t i = b.first; i < b.first + b.count; i++) {
            if (!take(*leaves_[i], b.in.get(), to, bad))
                continue;
            const Coord c = leaves_[i]->origin();
            b.found->push_back(
                {{floor8(c[0]), floor8(c[1]), floor8(c[2])}, 0, to});
            to += block_voxels;
        }
        const std::lock_guard<std::mutex> hold(lock_);
        out_.bad.nan += bad.nan;
        out_.bad.infinite += bad.infinite;
        out_.bad.negative += bad.negative;
        if (to != voxels.get())
            out_.vol.chunks.push_back(std::move(voxels));
        bar_.advance(b.count);
    }

    // Move a leaf's voxels to `to`, in our order, and free its buffer.
    // Returns false when none of them has density.
    bool take(leaf_type &leaf, stored_grid::reader *in, float *to,
              bad_voxels &bad) const
    {
        const CoordBBox where = leaf.getNodeBoundingBox();
        const bool whole = box_.isInside(where);
        value copy[block_voxels];
        const value *v = load(leaf, in, copy);
        float kept[block_voxels];

        if (!whole)
            v = cut(where, v, copy);
        const tally f = clean_all(v, kept);
        for (int i = 0; f.bad > 0 && i < block_voxels; i++)
            count_bad(bad, v[i], 1);
        if (f.used > 0)
            transpose(kept, to);
        release(leaf); // v is gone
        return f.used > 0;
    }

    static void skip(stored_grid::reader &in, const leaf_type &leaf)
    {
        if constexpr (std::is_same_v<value, float>)
            in.skip(leaf);
    }

    static const value *load(leaf_type &leaf, stored_grid::reader *in,
                             value *copy)
    {
        if constexpr (std::is_same_v<value, bool>) {
            for (int i = 0; i < block_voxels; i++)
                copy[i] = leaf.getValue(openvdb::Index(i));
            return copy;
        } else if constexpr (std::is_same_v<value, float>) {
            if (in == nullptr)
                return leaf.buffer().data();
            in->read(leaf, copy);
            return copy;
        } else {
            return leaf.buffer().data(); // loads what was left in the file
        }
    }

    // The values of a leaf that straddles the box, 0 outside it.
    const value *cut(const CoordBBox &where, const value *v, value *copy) const
    {
        for (int i = 0; i < block_voxels; i++) {
            const Coord c = where.min().offsetBy(i >> 6, i >> 3 & 7, i & 7);
            copy[i] = box_.isInside(c) ? v[i] : value(0);
        }
        return copy;
    }

    static void release(leaf_type &leaf)
    {
        if constexpr (!std::is_same_v<value, bool>) {
            typename leaf_type::Buffer none(openvdb::PartialCreate(), value(0));
            leaf.buffer().swap(none);
        }
    }

    // Cells wholly inside stay one value; those on the edge get voxels.
    void add_tile(const tile &t)
    {
        const Coord lo = t.where.min(), hi = t.where.max();

        for (int z = floor8(lo[2]); z <= floor8(hi[2]); z++)
            for (int y = floor8(lo[1]); y <= floor8(hi[1]); y++)
                for (int x = floor8(lo[0]); x <= floor8(hi[0]); x++) {
                    block b = {{x, y, z}, t.value, nullptr};
                    const CoordBBox cell =
                        CoordBBox::createCube(Coord(8 * x, 8 * y, 8 * z), 8);
                    if (!t.where.isInside(cell))
                        b.voxels = part_of(t, cell.min());
                    out_.vol.blocks.push_back(b);
                }
    }

    const float *part_of(const tile &t, const Coord &first)
    {
        float *v = new_chunk(out_.vol, 1);

        for (int i = 0; i < block_voxels; i++) {
            const Coord c = first.offsetBy(i & 7, i >> 3 & 7, i >> 6);
            v[i] = t.where.isInside(c) ? t.value : 0;
        }
        return v;
    }

    tree_type &tree_;
    const stored_grid *stored_; // null: the voxels are in the tree
    progress &bar_;
    extracted &out_;
    CoordBBox box_;
    std::vector<tile> tiles_;
    std::vector<leaf_type *> leaves_;
    std::mutex lock_;
};

using scalar_grids = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid,
                                       openvdb::Int32Grid, openvdb::Int64Grid,
                                       openvdb::BoolGrid>;

void read_transform(const openvdb::GridBase &grid, volume &vol)
{
    if (!grid.transform().isLinear())
        throw failure("has a frustum transform; only linear ones can be "
                      "baked");
    // OpenVDB multiplies row vectors from the left.
    const openvdb::math::Mat4d m =
        grid.transform().baseMap()->getAffineMap()->getMat4();
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            vol.world[4 * i + j] = m(j, i);
}

} // namespace

bool is_scalar(const std::string &type)
{
    bool found = type == openvdb::MaskGrid::gridType();

    scalar_grids::foreach (
        [&](auto grid) { found |= type == decltype(grid)::gridType(); });
    return found || type == openvdb::FloatGrid::gridType() + "_HalfFloat" ||
           type == openvdb::DoubleGrid::gridType() + "_HalfFloat";
}

extracted extract(openvdb::GridBase &grid, progress &bar)
{
    extracted out;
    openvdb::BoolGrid::Ptr solid;

    read_transform(grid, out.vol);
    // A mask is a grid of ones where it is active.
    if (auto *mask = dynamic_cast<openvdb::MaskGrid *>(&grid))
        solid = openvdb::BoolGrid::create(std::make_shared<openvdb::BoolTree>(
            mask->tree(), false, true, openvdb::TopologyCopy()));
    openvdb::GridBase &any = solid ? *solid : grid;
    const bool known = any.apply<scalar_grids>([&](auto &typed) {
        using grid_type = std::decay_t<decltype(typed)>;
        extractor<grid_type>(typed, bar, out).run();
    });
    if (!known)
        throw failure("holds " + grid.valueType() + " values");
    return out;
}

} // namespace bake
