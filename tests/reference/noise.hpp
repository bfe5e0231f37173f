// SPDX-License-Identifier: MIT
//
// The noises of docs/SPEC.md.
#ifndef BRUME_REFERENCE_NOISE_HPP
#define BRUME_REFERENCE_NOISE_HPP

#include <cstdint>
#include <string>
#include <vector>

namespace reference
{

enum class noise {
    none,
    white,
    ign,
    bayer8,
    bayer4,
    bayer16,
    ign_thesis,
    rank1,
    table,
    table_golden,
    table_r2
};

// W x H x T bytes, x fastest.
struct noise_table {
    uint32_t width = 0, height = 0, frames = 0;
    std::vector<uint8_t> values;
};

// NAME.WxHxT.raw; throws std::runtime_error.
noise_table read_noise_table(const std::string &path);

enum channel : uint32_t { primary_channel = 0, light_channel = 1 };

// J of pixel (x, y) in `frame`: 0 .. 65535. The jitter is J / 65536.
uint32_t noise_value(noise kind, uint32_t x, uint32_t y, uint32_t frame,
                     channel c, const noise_table &table = {});

} // namespace reference

#endif
