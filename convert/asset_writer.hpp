// SPDX-License-Identifier: MIT
//
// The bytes of docs/SPEC.md: the asset, and the float dump.
#ifndef BRUME_CONVERT_ASSET_WRITER_HPP
#define BRUME_CONVERT_ASSET_WRITER_HPP

#include "atomic_file.hpp"
#include "bricks.hpp"
#include "light_sections.hpp"

namespace bake
{

// Bytes of each section, and of the whole.
struct asset_size {
    uint64_t cell, pool, range, name, emission;
    light_sizes light;
    bool has_ranges; // there is a section RNGE, if an empty one
    uint64_t total;
};

// What a pool, its name and its sections for light will take.
asset_size size_of_asset(const brick_pool &p, const std::string &name,
                         const light_sizes &light);

struct asset_contents {
    const volume &vol;
    const measures &m; // of the density
    const emission_grid &glow;
    const layout &l;
    const brick_pool &p;
    const light_sections &light;
    const std::string &name;
};

asset_size write_asset(output &out, const asset_contents &c);

// `vol` is the density or the emission.
void write_float_dump(output &out, const volume &vol, const layout &l);

} // namespace bake

#endif
