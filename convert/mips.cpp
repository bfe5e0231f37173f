// SPDX-License-Identifier: MIT
//
// Means are of what the bricks decode to, not of the input: so they belong to
// a brick, whichever cells share it, and they are sums of integers.
#include "mips.hpp"

#include <algorithm>
#include <tbb/parallel_for.h>

#include "decoder.hpp"

namespace bake
{

namespace
{

constexpr size_t brick_mip_bytes = 64 + 8; // levels 1 and 2

// The code whose density q (q + 1) is nearest to a mean, the lower one of two:
// q^2 < mean <= (q + 1)^2. A mean is sum / count; count <= 2^45.
uint8_t code_of(uint64_t sum, uint64_t count)
{
    uint64_t q = 0;

    for (uint64_t bit = 128; bit > 0; bit /= 2)
        if ((q + bit) * (q + bit) * count < sum)
            q += bit;
    return uint8_t(q);
}

// Sums over the 2x2x2 of each cube of a level: `fine` has `side` cubes along
// an axis, `coarse` half of them.
void add_up(const uint32_t *fine, int side, uint32_t *coarse)
{
    const int half = side / 2;

    std::fill_n(coarse, half * half * half, 0u);
    for (int z = 0; z < side; z++)
        for (int y = 0; y < side; y++)
            for (int x = 0; x < side; x++)
                coarse[x / 2 + half * (y / 2 + half * (z / 2))] += *fine++;
}

// Writes a brick's levels 1 and 2, and returns its sum.
uint32_t make_brick_mips(const decoder &pool, uint32_t brick, uint8_t *out)
{
    uint32_t voxels[block_voxels], level1[64], level2[8], all[1];

    for (int i = 0; i < block_voxels; i++)
        voxels[i] = pool.voxel(brick, i & 7, i >> 3 & 7, i >> 6);
    add_up(voxels, 8, level1);
    add_up(level1, 4, level2);
    add_up(level2, 2, all);
    for (const uint32_t sum : level1)
        *out++ = code_of(sum, 8);
    for (const uint32_t sum : level2)
        *out++ = code_of(sum, 64);
    return all[0];
}

size_t volume_of(ijk n)
{
    return size_t(n.x) * size_t(n.y) * size_t(n.z);
}

ijk halved(ijk n)
{
    return {(n.x + 1) / 2, (n.y + 1) / 2, (n.z + 1) / 2};
}

// The sums of the cubes of a level above the cells. `at` gives those of the
// level below, of which there are `fine`.
template <class sum_at>
std::vector<uint64_t> sums_above(ijk fine, const sum_at &at)
{
    const ijk size = halved(fine);
    std::vector<uint64_t> sums(volume_of(size));

    tbb::parallel_for(0, size.z, [&](int z) {
        for (int k = 2 * z; k < std::min(2 * z + 2, fine.z); k++)
            for (int j = 0; j < fine.y; j++) {
                const size_t row = size_t(j) + size_t(fine.y) * size_t(k);
                uint64_t *to =
                    &sums[size_t(size.x) *
                          (size_t(j / 2) + size_t(size.y) * size_t(z))];
                for (int i = 0; i < fine.x; i++)
                    to[i / 2] += at(row * size_t(fine.x) + size_t(i));
            }
    });
    return sums;
}

// Appends the codes of a level of `size` cubes of `count` voxels.
template <class sum_at>
void append_level(std::vector<uint8_t> &out, ijk size, uint64_t count,
                  const sum_at &at)
{
    const size_t first = out.size(), n = volume_of(size);

    out.resize(first + n);
    tbb::parallel_for(size_t(0), n, [&](size_t i) {
        out[first + i] = code_of(at(i), count);
    });
}

} // namespace

uint64_t mip_bytes(ijk cells, uint64_t bricks)
{
    uint64_t bytes = brick_mip_bytes * bricks + volume_of(cells);

    for (ijk n = cells; volume_of(n) > 1;) {
        n = halved(n);
        bytes += volume_of(n);
    }
    return bytes;
}

std::vector<uint8_t> make_mips(const layout &l, const brick_pool &p)
{
    const decoder pool(l, p);
    const size_t bricks = size_t(p.bricks);
    std::vector<uint32_t> of_brick(bricks);
    std::vector<uint64_t> sums;
    std::vector<uint8_t> out;
    const auto of_cell = [&](size_t i) -> uint64_t {
        const uint32_t cell = p.cells[i];
        return cell & BRUME_CELL_EMPTY ? 0 : of_brick[cell];
    };
    const auto of_cube = [&](size_t i) { return sums[i]; };

    out.reserve(size_t(mip_bytes(l.cells, p.bricks)));
    out.resize(brick_mip_bytes * bricks);
    tbb::parallel_for(size_t(0), bricks, [&](size_t i) {
        of_brick[i] =
            make_brick_mips(pool, uint32_t(i), &out[brick_mip_bytes * i]);
    });
    append_level(out, l.cells, block_voxels, of_cell);
    uint64_t count = block_voxels;
    for (ijk n = l.cells; volume_of(n) > 1;) {
        sums = count == block_voxels ? sums_above(n, of_cell)
                                     : sums_above(n, of_cube);
        n = halved(n);
        count *= 8;
        append_level(out, n, count, of_cube);
    }
    return out;
}

} // namespace bake
