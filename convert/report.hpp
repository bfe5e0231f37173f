// SPDX-License-Identifier: MIT
//
// What was done, for people (summary) and for programs (JSON).
#ifndef BRUME_CONVERT_REPORT_HPP
#define BRUME_CONVERT_REPORT_HPP

#include <string>

#include "asset_writer.hpp"
#include "source.hpp"

namespace bake
{

struct stage_seconds {
    double read = 0, voxels = 0, quantise = 0, write = 0;

    double total() const
    {
        return read + voxels + quantise + write;
    }
};

struct report {
    std::string input, output, asked_format, why;
    const source *src = nullptr;
    const measures *m = nullptr;
    const layout *l = nullptr;
    const brick_pool *pool = nullptr;
    asset_size size = {};
    int lod = 0;
    bool resampled = false;
    stage_seconds seconds;
};

std::string to_json(const report &r);

// Three to six lines.
std::string summary(const report &r);

} // namespace bake

#endif
