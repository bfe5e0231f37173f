// SPDX-License-Identifier: MIT
//
// Wrenninge's octaves of multiple scattering (docs/light.md) in double, in a
// form in which any a, b, c is evaluated without marching again.
//
// Wrenninge, Kulla, Lundqvist, "Oz: The Great and Volumetric", 2013.
#ifndef BRUME_REFERENCE_OCTAVES_HPP
#define BRUME_REFERENCE_OCTAVES_HPP

#include <array>
#include <vector>

#include "march.hpp"
#include "medium.hpp"
#include "phase.hpp"

namespace reference
{

const int max_octaves = 8;

struct octave_model {
    double a = 0.5, b = 0.5, c = 0.5;
    int count = 1;

    double weight_sum() const; // of b^i
};

// The sum of lost * exp(-s * tau) along a ray as a function of s, at four
// nodes an octave of s from 1 down, and cubic in log s between them: within
// 1e-5 of the sum.
class light_table
{
  public:
    static constexpr int nodes = 57; // to 2^-14

    void add(double lost, double tau);
    double at_node(int i) const
    {
        return value_[static_cast<size_t>(i)];
    }

    // Weights of four nodes from the first on.
    struct place {
        int first;
        std::array<double, 4> weight;
    };
    static place find(double s);
    double at(const place &p) const;

  private:
    std::array<double, nodes> value_{};
};

// What the march of one pixel says of light, whatever the octaves.
struct marched_pixel {
    int x, y;
    double cosine; // of ray and sun
    double transmittance;
    light_table light;
};

// The march of docs/light.md with the scene's step and uniform light samples,
// and with density_scale for view and light rays alike, of its whole picture;
// pixels that let more than 0.99 through are left out.
std::vector<marched_pixel> march_picture(const volume &v, const scene &s);

// b^i left out: P_i * A_i.
double octave_term(const marched_pixel &p, const phase_model &phase,
                   const light_table::place &place);

} // namespace reference

#endif
