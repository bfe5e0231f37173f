// SPDX-License-Identifier: MIT
#include "cloud_grid.hpp"

#include <openvdb/io/Archive.h>
#include <openvdb/io/Compression.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <exception>
#include <fstream>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace cloud
{

namespace
{

using tree_type = openvdb::FloatTree;
using leaf_type = tree_type::LeafNodeType;

static_assert(leaf_type::DIM == leaf_side, "leaves are 8 voxels wide");

// A unit of work: 4^3 leaves, so that small boxes keep all threads busy and
// large ones seldom wait for the tree.
const int job_side = 4 * leaf_side;

struct made_leaf {
    openvdb::Coord corner;
    float tile; // the density, if there is no leaf
    std::unique_ptr<leaf_type> leaf;
};

class builder
{
  public:
    builder(const shape &form, box_size size, tree_type &tree)
        : form_(form), size_(size),
          tree_(tree), jobs_{jobs_along(size.x), jobs_along(size.y),
                             jobs_along(size.z)}
    {
    }

    void run(int threads, const std::function<void(double)> &progress)
    {
        std::vector<std::thread> pool;
        try {
            for (int i = 0; i < threads; i++)
                pool.emplace_back([this] { work(); });
        } catch (const std::system_error &) {
            // Fewer threads give the same grid; none does not.
            if (pool.empty())
                throw;
        }
        watch(progress);
        for (std::thread &t : pool)
            t.join();
        if (error_)
            std::rethrow_exception(error_);
    }

  private:
    static int64_t jobs_along(int voxels)
    {
        return (voxels + job_side - 1) / job_side;
    }

    int64_t job_count() const
    {
        return jobs_[0] * jobs_[1] * jobs_[2];
    }

    // An exception in one thread makes the others stop at their next job.
    void work()
    {
        try {
            for (;;) {
                const int64_t job = next_++;
                if (job >= job_count())
                    return;
                do_job(job);
                done_++;
            }
        } catch (...) {
            const std::lock_guard<std::mutex> lock(mutex_);
            error_ = std::current_exception();
            next_ = job_count();
            failed_ = true;
        }
    }

    void watch(const std::function<void(double)> &progress)
    {
        while (done_ < job_count() && !failed_) {
            progress(double(done_) / double(job_count()));
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        if (!failed_)
            progress(1);
    }

    void do_job(int64_t job)
    {
        const int x = int(job % jobs_[0]) * job_side;
        const int y = int(job / jobs_[0] % jobs_[1]) * job_side;
        const int z = int(job / jobs_[0] / jobs_[1]) * job_side;
        std::vector<made_leaf> made;
        for (int i = 0; i < job_side; i += leaf_side)
            for (int j = 0; j < job_side; j += leaf_side)
                for (int k = 0; k < job_side; k += leaf_side)
                    make_leaf({x + i, y + j, z + k}, made);
        if (made.empty())
            return;
        const std::lock_guard<std::mutex> lock(mutex_);
        for (made_leaf &m : made) {
            if (m.leaf)
                tree_.addLeaf(m.leaf.release());
            else
                tree_.addTile(1, m.corner, m.tile, true);
        }
    }

    void make_leaf(const openvdb::Coord &corner, std::vector<made_leaf> &made)
    {
        float density[leaf_voxels];
        if (corner.x() >= size_.x || corner.y() >= size_.y ||
            corner.z() >= size_.z)
            return;
        if (!form_.fill_leaf(
                {float(corner.x()), float(corner.y()), float(corner.z())},
                density))
            return;
        clip(corner, density);
        bool same = true;
        for (int i = 1; same && i < leaf_voxels; i++)
            same = density[i] == density[0];
        if (same && density[0] <= 0)
            return;
        made_leaf m = {corner, density[0], nullptr};
        if (!same) {
            m.leaf = std::make_unique<leaf_type>(corner, 0.0f, false);
            for (int i = 0; i < leaf_voxels; i++)
                if (density[i] > 0)
                    m.leaf->setValueOn(openvdb::Index(i), density[i]);
        }
        made.push_back(std::move(m));
    }

    // The box need not be a whole number of leaves.
    void clip(const openvdb::Coord &corner, float *density) const
    {
        const int x = size_.x - corner.x(), y = size_.y - corner.y();
        const int z = size_.z - corner.z();
        if (x >= leaf_side && y >= leaf_side && z >= leaf_side)
            return;
        for (int i = 0; i < leaf_voxels; i++)
            if (i >> 6 >= x || (i >> 3 & 7) >= y || (i & 7) >= z)
                density[i] = 0;
    }

    const shape &form_;
    const box_size size_;
    tree_type &tree_;
    const int64_t jobs_[3];
    std::atomic<int64_t> next_{0}, done_{0};
    std::atomic<bool> failed_{false};
    std::mutex mutex_; // guards tree_ and error_
    std::exception_ptr error_;
};

// io::File does not look whether its writes succeed, so a full disk would
// pass for a finished file. This one writes to a stream of ours.
class stream_archive : public openvdb::io::Archive
{
  public:
    void write_seekable(std::ostream &os, const openvdb::GridCPtrVec &grids)
    {
        Archive::write(os, grids, true, openvdb::MetaMap());
    }
};

} // namespace

openvdb::FloatGrid::Ptr make_grid(const shape &form, box_size size, int threads,
                                  const std::function<void(double)> &progress)
{
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    builder(form, size, grid->tree()).run(threads, progress);
    return grid;
}

void write_grid(const openvdb::FloatGrid::ConstPtr &grid,
                const std::string &path)
{
    namespace io = openvdb::io;
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    if (!file)
        throw std::runtime_error(std::strerror(errno));
    stream_archive archive;
    archive.setCompression(io::COMPRESS_ACTIVE_MASK |
                           (io::Archive::hasBloscCompression()
                                ? io::COMPRESS_BLOSC
                                : io::COMPRESS_ZIP));
    errno = 0;
    archive.write_seekable(file, {grid});
    file.close();
    if (!file)
        throw std::runtime_error(errno ? std::strerror(errno)
                                       : "the disk may be full");
}

} // namespace cloud
