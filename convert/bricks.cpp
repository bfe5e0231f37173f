// SPDX-License-Identifier: MIT
#include "bricks.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <memory>
#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>
#include <unordered_map>

#include "brume.h"

namespace bake
{

namespace
{

// Bricks that one task quantises: their codes fit a core's own cache.
constexpr size_t batch_bricks = 512;

// A format that will not do should be found out soon: how many bricks to try
// first, and how often to look from then on. A multiple of the batch.
constexpr size_t check_bricks = 2048;

// The densities of a brick with its apron. Neighbours that do not exist are
// zero.
void gather_apron(const volume &vol, const block_map &map, const layout &l,
                  const job &j, float *out)
{
    const float *near[8] = {};
    float scratch[8][block_voxels];

    for (int n = 0; n < 8; n++) {
        const ijk c = {j.cell.x + floor8(l.origin.x) + (n & 1),
                       j.cell.y + floor8(l.origin.y) + (n >> 1 & 1),
                       j.cell.z + floor8(l.origin.z) + (n >> 2)};
        const uint32_t b = map.at(c);
        if (b != block_map::none)
            near[n] = expand(vol.blocks[b], scratch[n]);
    }
    for (int z = 0; z < apron_side; z++)
        for (int y = 0; y < apron_side; y++)
            for (int x = 0; x < apron_side; x++) {
                const int n = x / 8 + y / 8 * 2 + z / 8 * 4;
                const int i = x % 8 + y % 8 * 8 + z % 8 * 64;
                *out++ = near[n] ? near[n][i] : 0;
            }
}

// Multiply and fold, a word at a time: collisions are compared, so a hash
// need only be fast and even.
uint64_t hash_bytes(const uint8_t *p, size_t bytes, uint64_t h)
{
    h += 0x9e3779b97f4a7c15u;

    for (size_t i = 0; i < bytes; i += 4) {
        uint32_t w;
        std::memcpy(&w, p + i, 4);
        h = (h ^ w) * 0xd6e8feb86659fd93u;
        h ^= h >> 32;
    }
    return h;
}

brick_result quantise_job(const volume &vol, const layout &l,
                          const brick_format &f, const job &j, uint8_t *codes)
{
    float scratch[max_brick_voxels];

    if (l.side == apron_side) {
        gather_apron(vol, l.map, l, j, scratch);
        return quantise(f, scratch, codes);
    }
    if (j.block != block_map::none)
        return quantise(f, expand(vol.blocks[j.block], scratch), codes);
    std::fill_n(scratch, block_voxels, 0.0f);
    return quantise(f, scratch, codes);
}

struct glow_result {
    bool empty = true; // every code is 0, also those that an apron would have
    emission_error error;
};

// The codes of the emission, without an apron. With one of the density a cell
// is occupied, too, where it would have any.
glow_result encode_job(const layout &l, const job &j, uint8_t *codes)
{
    const emission_grid &glow = *l.glow;
    float scratch[max_brick_voxels] = {};
    uint8_t around[max_brick_voxels];
    const float *values = scratch;
    glow_result r;

    if (j.glow != block_map::none)
        values = expand(glow.vol.blocks[j.glow], scratch);
    encode_emission(values, block_voxels, glow.max, codes);
    r.error = error_of_emission(values, codes, glow.max);
    r.empty = std::all_of(codes, codes + block_voxels,
                          [](uint8_t q) { return q == 0; });
    if (!r.empty || l.side == block_side)
        return r;
    gather_apron(glow.vol, l.glow_map, l, j, scratch);
    encode_emission(scratch, max_brick_voxels, glow.max, around);
    r.empty = std::all_of(around, around + max_brick_voxels,
                          [](uint8_t q) { return q == 0; });
    return r;
}

// The bricks of `count` jobs from `first` on.
struct batch {
    size_t first, count;
    std::vector<brick_result> results;
    std::vector<uint8_t> codes;
    std::vector<glow_result> glow_results; // when there is emission
    std::vector<uint8_t> glow_codes;
    std::vector<uint64_t> hashes;
};

using batch_ptr = std::shared_ptr<batch>;

void quantise_batch(const volume &vol, const layout &l, const brick_format &f,
                    batch &b)
{
    const size_t bytes = f.bytes();

    b.results.resize(b.count);
    b.codes.resize(b.count * bytes);
    b.hashes.resize(b.count);
    if (l.glow != nullptr) {
        b.glow_results.resize(b.count);
        b.glow_codes.resize(b.count * block_voxels);
    }
    for (size_t i = 0; i < b.count; i++) {
        const job *j = &l.jobs[b.first + i];
        uint8_t *codes = &b.codes[i * bytes];
        if (i + 1 < b.count && j[1].block != block_map::none)
            prefetch(vol.blocks[j[1].block]);
        b.results[i] = quantise_job(vol, l, f, *j, codes);
        const range r = b.results[i].r;
        b.hashes[i] =
            hash_bytes(codes, bytes, uint64_t(r.base) << 16 | r.scale);
        if (l.glow == nullptr)
            continue;
        uint8_t *glow = &b.glow_codes[i * block_voxels];
        b.glow_results[i] = encode_job(l, *j, glow);
        b.hashes[i] = hash_bytes(glow, block_voxels, b.hashes[i]);
    }
}

// The bricks stored so far, by hash. Bricks with one hash form a chain.
class brick_store
{
  public:
    explicit brick_store(brick_pool &pool) : pool_(pool)
    {
    }

    // The number of the brick with these codes and range, and these codes of
    // emission (or null), stored if new.
    uint32_t number(const uint8_t *codes, range r, const uint8_t *glow,
                    uint64_t hash)
    {
        const size_t bytes = pool_.format.bytes();
        const auto found = first_.emplace(hash, uint32_t(pool_.bricks));

        if (!found.second) {
            uint32_t n = found.first->second;
            for (; n != block_map::none; n = next_[n])
                if (ranges_[n] == r &&
                    !std::memcmp(&pool_.bytes[n * bytes], codes, bytes) &&
                    (glow == nullptr ||
                     !std::memcmp(&pool_.codes[size_t(n) * block_voxels], glow,
                                  block_voxels)))
                    return n;
            next_.push_back(found.first->second);
            found.first->second = uint32_t(pool_.bricks);
        } else {
            next_.push_back(block_map::none);
        }
        pool_.bytes.insert(pool_.bytes.end(), codes, codes + bytes);
        if (glow != nullptr)
            pool_.codes.insert(pool_.codes.end(), glow, glow + block_voxels);
        ranges_.push_back(r);
        return uint32_t(pool_.bricks++);
    }

    std::vector<range> take_ranges()
    {
        return std::move(ranges_);
    }

  private:
    brick_pool &pool_;
    std::unordered_map<uint64_t, uint32_t> first_;
    std::vector<uint32_t> next_;
    std::vector<range> ranges_;
};

void check_blob(const brick_pool &p)
{
    const uint64_t bytes = pool_bytes(p) + 4096;

    if (bytes >= blob_limit)
        throw failure(text("more than %llu bricks of %zu bytes with %zu cells "
                           "pass the 2 GiB a file may have (try --lod or "
                           "--format u4r)",
                           (unsigned long long)p.bricks, p.format.bytes(),
                           p.cells.size()));
}

// Running totals, from units to density at the end.
struct error_sum {
    double squared = 0, worst = 0;

    void add(const brick_result &r)
    {
        squared += r.squared_error;
        worst = std::max(worst, r.worst_error);
    }
    quantisation_error in_density(const measures &m,
                                  const brick_format &f) const
    {
        const double unit = double(f.density_max) / BRUME_RANGE_TOP;
        if (m.voxels == 0)
            return {};
        return {std::sqrt(squared / double(m.voxels)) * unit, worst * unit};
    }
};

bool within(const quantisation_error &e, const quantisation_error &limit)
{
    return e.rmse <= limit.rmse && e.worst <= limit.worst;
}

// The error of some bricks from all over: one that is far off is enough to
// refuse a format.
quantisation_error probe(const volume &vol, const measures &m, const layout &l,
                         const brick_format &f)
{
    const size_t some = std::min(check_bricks, l.jobs.size());
    const size_t step = some > 0 ? l.jobs.size() / some : 1;
    std::vector<brick_result> results(some);
    error_sum sum;

    tbb::parallel_for(size_t(0), some, [&](size_t i) {
        uint8_t codes[max_brick_bytes];
        results[i] = quantise_job(vol, l, f, l.jobs[i * step], codes);
    });
    for (const brick_result &r : results)
        sum.add(r);
    return sum.in_density(m, f);
}

// Quantised batches, in order, become the pool.
class pool_maker
{
  public:
    pool_maker(const measures &m, const layout &l, const brick_limits &limit,
               brick_pool &pool)
        : m_(m), l_(l), limit_(limit), pool_(pool), store_(pool)
    {
        pool.cells.assign(l.cell_count(), BRUME_CELL_EMPTY | 255);
        pool.bytes.reserve(std::min<uint64_t>(
            l.jobs.size() * pool.format.bytes(), blob_limit));
        pool.glows = l.glow != nullptr;
    }

    // Returns false when the error or the size passes its limit.
    bool add(const batch &b)
    {
        const size_t bytes = pool_.format.bytes(), end = b.first + b.count;

        for (size_t i = 0; i < b.count; i++) {
            const brick_result &r = b.results[i];
            sum_.add(r);
            const uint8_t *glow =
                pool_.glows ? &b.glow_codes[i * block_voxels] : nullptr;
            if (pool_.glows)
                add_glow(b.glow_results[i].error);
            if (r.empty && (!pool_.glows || b.glow_results[i].empty))
                continue;
            pool_.cells[l_.cell_index(l_.jobs[b.first + i].cell)] =
                store_.number(&b.codes[i * bytes], r.r, glow, b.hashes[i]);
            pool_.occupied++;
        }
        if (pool_bytes(pool_) > limit_.bytes)
            return false;
        check_blob(pool_);
        if (end % check_bricks != 0 && end != l_.jobs.size())
            return true;
        pool_.error = sum_.in_density(m_, pool_.format);
        return within(pool_.error, limit_.error);
    }

    void finish()
    {
        if (pool_.format.has_ranges())
            pool_.ranges = store_.take_ranges();
        if (pool_.glows && l_.glow->m.voxels > 0) {
            const double unit = double(l_.glow->max) / 255;
            const double n = double(l_.glow->m.voxels);
            pool_.glow_error = {std::sqrt(glow_.squared / n) * unit,
                                glow_.worst * unit};
        }
        fill_distances(pool_.cells, l_.cells);
    }

  private:
    void add_glow(const emission_error &e)
    {
        glow_.squared += e.squared;
        glow_.worst = std::max(glow_.worst, e.worst);
    }

    const measures &m_;
    const layout &l_;
    const brick_limits limit_;
    brick_pool &pool_;
    brick_store store_;
    error_sum sum_;
    emission_error glow_;
};

} // namespace

uint64_t pool_bytes(const brick_pool &p)
{
    return p.bytes.size() + p.codes.size() + 4 * p.cells.size() +
           (p.format.has_ranges() ? 4 * p.bricks : 0);
}

bool make_bricks(const volume &vol, const measures &m, const layout &l,
                 const brick_format &f, const brick_limits &limit,
                 progress &bar, brick_pool &pool)
{
    const size_t all = l.jobs.size();
    size_t next = 0;
    std::atomic<bool> good{true};

    pool = {};
    pool.format = f;
    if (std::isfinite(limit.error.worst)) {
        pool.error = probe(vol, m, l, f);
        if (!within(pool.error, limit.error))
            return false;
    }
    pool_maker maker(m, l, limit, pool);
    bar.stage("quantise", all);
    const auto share_out = [&](tbb::flow_control &flow) -> batch_ptr {
        if (next == all || !good) {
            flow.stop();
            return nullptr;
        }
        const auto b = std::make_shared<batch>();
        b->first = next;
        b->count = std::min(batch_bricks, all - next);
        next += b->count;
        return b;
    };
    const auto work = [&](const batch_ptr &b) {
        quantise_batch(vol, l, f, *b);
        return b;
    };
    const auto store = [&](const batch_ptr &b) {
        good = good && maker.add(*b);
        bar.advance(b->count);
    };
    tbb::parallel_pipeline(4 * size_t(tbb::this_task_arena::max_concurrency()),
                           tbb::make_filter<void, batch_ptr>(
                               tbb::filter_mode::serial_in_order, share_out) &
                               tbb::make_filter<batch_ptr, batch_ptr>(
                                   tbb::filter_mode::parallel, work) &
                               tbb::make_filter<batch_ptr, void>(
                                   tbb::filter_mode::serial_in_order, store));
    if (good)
        maker.finish();
    return good;
}

} // namespace bake
