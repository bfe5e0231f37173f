// SPDX-License-Identifier: MIT
//
// The bytes of docs/SPEC.md: the asset, and the float dump.
#ifndef BRUME_CONVERT_ASSET_WRITER_HPP
#define BRUME_CONVERT_ASSET_WRITER_HPP

#include "atomic_file.hpp"
#include "bricks.hpp"

namespace bake
{

// Bytes of each section, and of the whole.
struct asset_size {
    uint64_t cell, pool, range, name, total;
};

// What a pool and its name will take.
asset_size size_of_asset(const brick_pool &p, const std::string &name);

asset_size write_asset(output &out, const volume &vol, const measures &m,
                       const layout &l, const brick_pool &p,
                       const std::string &name);

void write_float_dump(output &out, const volume &vol, const layout &l);

} // namespace bake

#endif
