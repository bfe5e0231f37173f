// SPDX-License-Identifier: MIT
//
// Averaging n levels down is the orthogonal projection of the input onto what
// is constant over cubes of 2^n voxels. Two things follow for nearest reads.
// The squared errors of all halvings and of quantisation add up, so each
// candidate's error is known without looking at the input again. And a level
// loses at least what the ones before it lost: once averaging alone costs more
// than the best candidate, the search is over.
#include "budget.hpp"

#include <cmath>

#include "asset_writer.hpp"
#include "resample.hpp"

namespace bake
{

namespace
{

// Input voxels in a voxel of a level.
double volume_of_voxel(int lod)
{
    return std::ldexp(1.0, 3 * lod);
}

const char *format_name(int format)
{
    return brick_format{format, block_side, 1}.name();
}

} // namespace

budget_search::budget_search(const budget_request &want, volume input,
                             emission_grid glow, progress &bar)
    : want_(want), bar_(bar)
{
    levels_.push_back({std::move(input), {}, std::move(glow), 0});
    levels_[0].m = measure(levels_[0].vol);
}

void budget_search::add_level()
{
    const level &fine = levels_.back();
    level next = {halve(fine.vol), {}, halve(fine.glow), 0};

    next.loss = fine.loss + volume_of_voxel(int(levels_.size()) - 1) *
                                halving_loss(fine.vol, next.vol);
    next.m = measure(next.vol);
    levels_.push_back(std::move(next));
}

// `bytes` is what the asset may have. It is given up as soon as it has more.
candidate budget_search::try_format(const layout &l, int lod, int format,
                                    uint64_t bytes)
{
    const level &at = levels_[size_t(lod)];
    const brick_format f = {format, l.side, at.m.max};
    // What sections for light take however many bricks there are.
    const uint64_t light = sizes_of(want_.light, l.cells, 0).total();
    candidate c = {lod, format, 4 * l.cell_count() + light, false, false, 0};
    brick_limits limits;
    brick_pool pool;

    if (c.bytes > bytes)
        return c;
    limits.bytes = bytes - light;
    c.complete = make_bricks(at.vol, at.m, l, f, limits, bar_, pool);
    if (!c.complete) {
        c.bytes = pool_bytes(pool) + light;
        return c;
    }
    c.bytes = size_of_asset(pool, want_.name,
                            sizes_of(want_.light, l.cells, pool.bricks))
                  .total;
    c.fits = c.bytes <= want_.bytes;
    const double squared =
        pool.error.rmse * pool.error.rmse * double(at.m.voxels);
    c.rmse = std::sqrt((at.loss + volume_of_voxel(lod) * squared) /
                       double(levels_[0].m.voxels));
    return c;
}

void budget_search::consider(const candidate &c)
{
    tried_.push_back(c);
    if (!c.fits)
        return;
    if (best_ >= 0) {
        const candidate &best = tried_[size_t(best_)];
        if (c.rmse > best.rmse ||
            (c.rmse == best.rmse && c.bytes >= best.bytes))
            return;
    }
    best_ = int(tried_.size()) - 1;
}

// Returns false when there are more cells than the format can index, which a
// coarser level may mend; without one, throws what make_layout() does.
bool budget_search::lay_out(int lod, layout &l)
{
    const level &at = levels_[size_t(lod)];

    try {
        l = make_layout(at.vol, at.glow, box_of_both(at.m, at.glow), want_.side,
                        want_.order);
        return true;
    } catch (const failure &) {
        if (lod == want_.last_lod)
            throw;
        return false;
    }
}

// Returns false when this level, and so the next ones, cannot be the best.
bool budget_search::try_level(int lod)
{
    const level &at = levels_[size_t(lod)];
    const double least = std::sqrt(at.loss / double(levels_[0].m.voxels));
    layout l;

    if (at.m.voxels == 0 || (best_ >= 0 && least > tried_[size_t(best_)].rmse))
        return false;
    if (!lay_out(lod, l))
        return true;
    for (const int format : want_.formats)
        consider(try_format(l, lod, format, want_.bytes));
    return true;
}

// Levels from the coarsest on: the first ones are the smallest, and what
// grows beyond them is soon given up.
void budget_search::give_up()
{
    candidate least = {0, 0, UINT64_MAX, false, false, 0};

    for (int lod = int(levels_.size()) - 1; lod >= want_.first_lod; lod--) {
        layout l;
        if (levels_[size_t(lod)].m.voxels == 0 || !lay_out(lod, l))
            continue;
        for (const int format : want_.formats) {
            const candidate c = try_format(l, lod, format, least.bytes);
            if (c.complete && c.bytes < least.bytes)
                least = c;
        }
    }
    throw failure(text("nothing fits into %llu bytes: the smallest asset has "
                       "%llu (--format %s --lod %d)",
                       (unsigned long long)want_.bytes,
                       (unsigned long long)least.bytes,
                       format_name(least.format), least.lod));
}

const candidate &budget_search::choose()
{
    for (int lod = 0; lod <= want_.last_lod; lod++) {
        if (lod > 0)
            add_level();
        if (lod >= want_.first_lod && !try_level(lod))
            break;
    }
    if (best_ < 0)
        give_up();
    return tried_[size_t(best_)];
}

} // namespace bake
