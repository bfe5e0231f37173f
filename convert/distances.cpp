// SPDX-License-Identifier: MIT
//
// The distance field of the CELL section. The Chebyshev distance on a grid is
// exact after one pass forwards and one backwards when each step looks at the
// 13 neighbours already visited (Borgefors 1986, chessboard weights): a
// shortest path of king's moves can always be ordered that way.
#include "bricks.hpp"

#include <algorithm>

#include "brume.h"

namespace bake
{

namespace
{

constexpr uint32_t far_away = 255;

uint32_t distance(uint32_t cell)
{
    return cell & BRUME_CELL_EMPTY ? cell & 0xff : 0;
}

// The grid within a margin of far-away cells, so that no step needs to ask
// whether a neighbour exists: outside, cells are empty and far away.
class field
{
  public:
    field(const std::vector<uint32_t> &cells, ijk size)
        : size_(size), nx_(size.x + 2), ny_(size.y + 2)
    {
        d_.assign(size_t(nx_) * size_t(ny_) * size_t(size.z + 2),
                  uint8_t(far_away));
        for_each([&](size_t to, size_t from) {
            d_[to] = uint8_t(distance(cells[from]));
        });
    }

    void pass(int sign)
    {
        const ptrdiff_t row = nx_, plane = ptrdiff_t(nx_) * ny_;
        const ptrdiff_t centres[] = {-row, -plane - row, -plane, -plane + row};
        const auto step = [&](size_t i) {
            const uint8_t *p = &d_[i];
            uint8_t least = p[-sign];
            for (ptrdiff_t c : centres)
                least = std::min(
                    {least, p[sign * c - 1], p[sign * c], p[sign * c + 1]});
            if (least < *p)
                d_[i] = std::min(*p, uint8_t(least + 1));
        };
        if (sign > 0)
            for_each([&](size_t i, size_t) { step(i); });
        else
            for_each_backwards(step);
    }

    void store(std::vector<uint32_t> &cells) const
    {
        for_each([&](size_t from, size_t to) {
            if (cells[to] & BRUME_CELL_EMPTY)
                cells[to] = BRUME_CELL_EMPTY | d_[from];
        });
    }

  private:
    size_t index(int y, int z) const
    {
        return 1 + size_t(nx_) * (size_t(y + 1) + size_t(ny_) * size_t(z + 1));
    }

    // visit(index with margin, index without)
    template <class visitor> void for_each(visitor visit) const
    {
        size_t inner = 0;

        for (int z = 0; z < size_.z; z++)
            for (int y = 0; y < size_.y; y++)
                for (int x = 0; x < size_.x; x++)
                    visit(index(y, z) + size_t(x), inner++);
    }

    template <class visitor> void for_each_backwards(visitor visit) const
    {
        for (int z = size_.z; z-- > 0;)
            for (int y = size_.y; y-- > 0;)
                for (int x = size_.x; x-- > 0;)
                    visit(index(y, z) + size_t(x));
    }

    ijk size_;
    int nx_, ny_;
    std::vector<uint8_t> d_;
};

} // namespace

void fill_distances(std::vector<uint32_t> &cells, ijk size)
{
    field f(cells, size);

    f.pass(1);
    f.pass(-1);
    f.store(cells);
}

} // namespace bake
