// SPDX-License-Identifier: MIT
//
// The command line of brume-bake.
#ifndef BRUME_CONVERT_OPTIONS_HPP
#define BRUME_CONVERT_OPTIONS_HPP

#include <string>
#include <vector>

#include "light_sections.hpp"
#include "source_text.hpp"

namespace bake
{

constexpr int most_lod = 8;

struct options {
    std::string input, output, grid, format = "auto", report, dump;
    std::string symbol, licence;
    std::string emission, emission_dump; // grid; file
    float emission_max = 0;              // 0: its own
    int lod = -1;                        // -1: not given
    int threads = 0;
    uint64_t budget = 0;   // bytes; 0: not given
    float max_density = 0; // 0: no limit
    bool apron = false, fog = false, help = false;
    bool allow_empty = false;
    bool sun = false, sky = false; // were they given?
    brick_order order = brick_order::morton;
    light_request light;

    // The formats that `--format` leaves to choose from.
    std::vector<int> formats() const;
    output_form form() const
    {
        return form_of(output);
    }
};

extern const char usage[];

// Throws `failure` with status_usage.
options parse(int count, char **args);

} // namespace bake

#endif
