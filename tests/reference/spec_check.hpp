// SPDX-License-Identifier: MIT
//
// What SPEC.md says the converter writes ("is"), beyond what it says is
// checked when a volume is opened ("must").
#ifndef BRUME_REFERENCE_SPEC_CHECK_HPP
#define BRUME_REFERENCE_SPEC_CHECK_HPP

#include <string>
#include <vector>

#include "float_dump.hpp"
#include "spec_reader.hpp"

namespace reference {

// One line a violation. Of one kind the first few are listed, the others
// counted, so that a single mistake does not print every cell.
std::vector<std::string> check_asset(const asset &a);

// The asset against the dump of the voxels it was made of: every voxel has the
// nearest code of its brick's range, zeros stay zero; and box_min, box_max,
// voxels and density_mean, which an asset alone confirms only roughly.
std::vector<std::string> check_against(const asset &a,
                                       const float_dump &dump,
                                       const float_dump *glow = nullptr);

} // namespace reference

#endif
