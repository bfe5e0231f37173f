// SPDX-License-Identifier: MIT
//
// The Portable Float Map: Debevec's format, as Photoshop and pbrt read it.
#ifndef BRUME_REFERENCE_PFM_HPP
#define BRUME_REFERENCE_PFM_HPP

#include <string>

#include "march.hpp"

namespace reference {

// "Pf" for one channel, "PF" for three; little-endian, bottom row first.
// Throws std::runtime_error when the file cannot be written.
void write_pfm(const std::string &path, const picture &image);

} // namespace reference

#endif
