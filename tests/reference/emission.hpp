// SPDX-License-Identifier: MIT
//
// What a volume glows by: a second float dump and the colours of its values,
// as docs/light.md has them.
#ifndef BRUME_REFERENCE_EMISSION_HPP
#define BRUME_REFERENCE_EMISSION_HPP

#include <array>
#include <string>

#include "lighting.hpp"
#include "volume.hpp"

namespace reference
{

// Colours of codes 0 .. 255, which stand for equal parts of the largest value:
// `blackbody:LOW,HIGH,BRIGHTNESS`, or a file of 256 lines of red, green, blue.
// "none": none. Throws std::runtime_error.
emission_colours read_emission(const std::string &text);

class emission
{
  public:
    // `largest` is the value of code 255; 0: the dump's own.
    emission(float_dump dump, double largest);

    double value(const vec3 &p, lookup filter) const
    {
        return volume_.density(p, filter);
    }
    // Between the colours of two codes.
    vec3 colour(double value, const emission_colours &colours) const;

  private:
    volume volume_;
    double largest_;
};

} // namespace reference

#endif
