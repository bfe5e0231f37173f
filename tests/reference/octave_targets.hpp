// SPDX-License-Identifier: MIT
//
// The pictures that octaves are fitted to: volumes, views and suns, and what
// the Monte Carlo reference sees there.
#ifndef BRUME_REFERENCE_OCTAVE_TARGETS_HPP
#define BRUME_REFERENCE_OCTAVE_TARGETS_HPP

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "medium.hpp"
#include "octave_search.hpp"
#include "scene.hpp"
#include "volume.hpp"

namespace reference
{

const std::vector<double> fit_albedos = {1, 0.99, 0.9, 0.5};

struct subject {
    std::string name;
    double extinction; // per voxel at density 1, for view and light alike
    bool probe;        // is shown, but not fitted to
    uint64_t hash;     // of the voxels
    std::unique_ptr<volume> voxels;
    std::unique_ptr<medium> inside;
};

// Of `NAME=FILE.float,EXTINCTION`, with a + before it for a probe. Throws
// std::runtime_error.
subject open_subject(const std::string &text);

// By how far the eye's azimuth is from the sun's: 40, 70, 170 degrees.
enum { view_count = 3, sun_count = 3 };

// A square picture of the whole subject.
scene view_scene(const subject &s, int view, int sun, int side,
                 const std::string &phase);

struct target_options {
    uint64_t passes = 256;
    int side = 40;
    int threads = 1;
    std::string cache; // a folder of sums, or empty
};

// The pictures of a subject, all views under all suns.
void add_targets(const subject &s, int group, const std::string &phase,
                 const target_options &o, std::vector<octave_target> &out);

} // namespace reference

#endif
