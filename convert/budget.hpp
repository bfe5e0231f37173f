// SPDX-License-Identifier: MIT
//
// `--budget`: the level of detail and format with the least error among those
// whose asset fits into so many bytes.
#ifndef BRUME_CONVERT_BUDGET_HPP
#define BRUME_CONVERT_BUDGET_HPP

#include <deque>
#include <string>
#include <vector>

#include "grid_error.hpp"
#include "light_sections.hpp"

namespace bake
{

struct budget_request {
    uint64_t bytes;
    std::vector<int> formats;
    int first_lod, last_lod;
    int side;
    brick_order order;
    std::string name; // of the grid: it takes room too, as do
    light_request light;
};

struct candidate {
    int lod, format;
    // Of the whole asset; when not complete, what it had come to when it was
    // given up.
    uint64_t bytes;
    bool complete, fits;
    // Error of nearest reads over the input's voxels, as in grid_error.hpp; of
    // use when complete.
    double rmse;
};

// The input and its levels of detail, each made once.
class budget_search
{
  public:
    budget_search(const budget_request &want, volume input, emission_grid glow,
                  progress &bar);

    // Throws `failure` with the smallest size there is when nothing fits.
    const candidate &choose();

    const std::vector<candidate> &tried() const
    {
        return tried_;
    }
    const measures &input_measures() const
    {
        return levels_[0].m;
    }
    const measures &measures_at(int lod) const
    {
        return levels_[size_t(lod)].m;
    }
    const volume &volume_at(int lod) const
    {
        return levels_[size_t(lod)].vol;
    }
    const emission_grid &emission_at(int lod) const
    {
        return levels_[size_t(lod)].glow;
    }
    volume take_volume(int lod)
    {
        return std::move(levels_[size_t(lod)].vol);
    }
    emission_grid take_emission(int lod)
    {
        return std::move(levels_[size_t(lod)].glow);
    }

  private:
    struct level {
        volume vol;
        measures m;
        emission_grid glow;
        double loss; // sum of squares over the input that halving has cost
    };

    void add_level();
    bool lay_out(int lod, layout &l);
    bool try_level(int lod);
    candidate try_format(const layout &l, int lod, int format, uint64_t bytes);
    void consider(const candidate &c);
    [[noreturn]] void give_up();

    const budget_request want_;
    progress &bar_;
    std::deque<level> levels_;
    std::vector<candidate> tried_;
    int best_ = -1;
};

} // namespace bake

#endif
