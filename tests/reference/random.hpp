// SPDX-License-Identifier: MIT
//
// Random numbers of the Monte Carlo reference: SplitMix64 (Steele, Lea and
// Flood, "Fast Splittable Pseudorandom Number Generators", 2014). A generator
// for each pixel and pass, so that no order of work shows in a picture.
#ifndef BRUME_REFERENCE_RANDOM_HPP
#define BRUME_REFERENCE_RANDOM_HPP

#include <cmath>
#include <cstdint>
#include <initializer_list>

namespace reference
{

class random_source
{
  public:
    // A stream for each list of keys.
    explicit random_source(std::initializer_list<uint64_t> keys)
    {
        for (uint64_t key : keys)
            state_ = mix(state_ + gamma + key);
    }

    uint64_t bits()
    {
        state_ += gamma;
        return mix(state_);
    }

    // 0 <= u < 1, 53 bits.
    double uniform()
    {
        return static_cast<double>(bits() >> 11) * 0x1p-53;
    }

    // Of mean 1.
    double exponential()
    {
        return -std::log1p(-uniform());
    }

  private:
    static constexpr uint64_t gamma = 0x9e3779b97f4a7c15u;

    static uint64_t mix(uint64_t z)
    {
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
        z = (z ^ z >> 27) * 0x94d049bb133111ebu;
        return z ^ z >> 31;
    }

    uint64_t state_ = 0;
};

} // namespace reference

#endif
