// SPDX-License-Identifier: MIT
//
// From 512 (or, with an apron, 729) float densities to the codes of a brick.
// Inside, density is in units of density_max / 65280, docs/SPEC.md's unit of
// a brick's range; u8 is then the fixed range base 0, scale 256.
#ifndef BRUME_CONVERT_QUANTISE_HPP
#define BRUME_CONVERT_QUANTISE_HPP

#include <cstddef>
#include <cstdint>

namespace bake
{

constexpr int apron_side = 9;
constexpr int max_brick_voxels = 729;
constexpr int max_brick_bytes = 732;

struct range {
    uint16_t base, scale;
};

inline bool operator==(const range &a, const range &b)
{
    return a.base == b.base && a.scale == b.scale;
}

// How bricks are stored: set once for a volume.
struct brick_format {
    int format;        // BRUME_U8, BRUME_U8R or BRUME_U4R
    int side;          // 8, or 9 with an apron
    float density_max; // what the largest code stands for

    int top() const;          // the largest code
    bool has_ranges() const;  // a range per brick
    size_t bytes() const;     // of one brick in POOL
    const char *name() const; // as `--format` spells it
};

struct brick_result {
    range r;
    bool empty; // every code decodes to 0
    // Over the non-zero voxels of the cell itself, without the apron:
    double squared_error; // summed, in units^2
    double worst_error;   // in units
};

// Quantise side^3 densities in [0, density_max] to `codes`, bytes() of them.
//
// The range is the one with the smallest worst error, half a step: scale =
// ceil((max - min) / (top + 1)), with the slack of rounding up split between
// the two ends. A brick that has a zero takes base 0 instead, so that zeros
// stay exactly zero: empty space around a cloud must not glow. u4r then moves
// base and scale by least squares as long as that lowers the squared error.
brick_result quantise(const brick_format &f, const float *densities,
                      uint8_t *codes);

} // namespace bake

#endif
