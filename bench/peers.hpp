// SPDX-License-Identifier: MIT
//
// The peers: one grid in each of their forms, and a march over each.
#ifndef BRUME_BENCH_PEERS_HPP
#define BRUME_BENCH_PEERS_HPP

#include <cstddef>
#include <memory>
#include <string>

#include "view.hpp"

namespace bench
{

// What the grid of a .vdb is converted to. Pointers are to nanovdb::NanoGrid
// of float and of Fp8, and to openvdb::FloatGrid: the files that march over
// them know.
struct grids {
    const void *nano, *nano_fp8, *open;
    size_t nano_bytes, nano_fp8_bytes, open_bytes;
    int low[3], high[3];         // active voxels, inclusive
    double world_from_index[12]; // rows
    std::shared_ptr<void> owner;
};

// Reads the float grid ('density' when there are several) of the file. Throws
// std::runtime_error.
grids read_grids(const std::string &path);

// Styles are those of march.hpp. Compiled for any machine of the architecture,
// as packages are: every light sample has its exponential, nothing is skipped.
void nano_shipped(const grids &, const view &, strips, float *out);
void nano_double(const grids &, const view &, strips, float *out);
// Compiled with -O3 -march=native -ffast-math.
void nano_tuned(const grids &, const view &, strips, float *out);
void nano_leaf(const grids &, const view &, strips, float *out);
void nano_leaping(const grids &, const view &, strips, float *out);
void nano_fp8(const grids &, const view &, strips, float *out);
void pnano(const grids &, const view &, strips, float *out);
// Linked with the package's library, and so for any machine.
void open_tuned(const grids &, const view &, strips, float *out);

} // namespace bench

#endif
