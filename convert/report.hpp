// SPDX-License-Identifier: MIT
//
// What was done, for people (summary) and for programs (JSON).
#ifndef BRUME_CONVERT_REPORT_HPP
#define BRUME_CONVERT_REPORT_HPP

#include <string>
#include <vector>

#include "asset_writer.hpp"
#include "budget.hpp"
#include "source.hpp"

namespace bake
{

struct stage_seconds {
    double read = 0, voxels = 0, quantise = 0, light = 0, write = 0;

    double total() const
    {
        return read + voxels + quantise + light + write;
    }
};

// What `--budget` did.
struct budget_report {
    uint64_t bytes = 0; // 0: there was none
    std::vector<candidate> tried;
    grid_error error; // of the one chosen
    double input_max = 0;
};

struct report {
    std::string input, output, asked_format, why;
    std::string symbol; // in C or assembly
    budget_report budget;
    const source *src = nullptr;
    const measures *m = nullptr;
    const emission_grid *glow = nullptr;
    std::string glow_name;
    bad_voxels glow_bad;
    const layout *l = nullptr;
    const brick_pool *pool = nullptr;
    asset_size size = {};
    light_request light;
    int lod = 0;
    bool resampled = false;
    stage_seconds seconds;
};

std::string to_json(const report &r);

// What was chosen and what it costs, in a line.
std::string budget_notice(const budget_report &b, const candidate &chosen);

// For the comment of C or assembly, a line each.
std::vector<std::string> facts(const report &r);

// Three to seven lines.
std::string summary(const report &r);

} // namespace bake

#endif
