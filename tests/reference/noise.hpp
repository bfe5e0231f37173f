// SPDX-License-Identifier: MIT
//
// The noises of docs/SPEC.md.
#ifndef BRUME_REFERENCE_NOISE_HPP
#define BRUME_REFERENCE_NOISE_HPP

#include <cstdint>

namespace reference {

enum class noise { none, white, ign, bayer8 };

enum channel : uint32_t { primary_channel = 0, light_channel = 1 };

// J of pixel (x, y) in `frame`: 0 .. 65535. The jitter is J / 65536.
uint32_t noise_value(noise kind, uint32_t x, uint32_t y, uint32_t frame,
                     channel c);

} // namespace reference

#endif
