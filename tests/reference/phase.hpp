// SPDX-License-Identifier: MIT
//
// Phase functions, relative to isotropic: 4 pi p, whose mean over all
// directions is 1.
#ifndef BRUME_REFERENCE_PHASE_HPP
#define BRUME_REFERENCE_PHASE_HPP

namespace reference
{

enum class phase_kind { mix, schlick };

// weight * Draine + (1 - weight) * Henyey-Greenstein, or Schlick's of g.
struct phase_model {
    phase_kind kind = phase_kind::mix;
    double g = 0;
    double draine_g = 0, draine_alpha = 0;
    double weight = 0;
};

// Of the cosine of the angle by which light is turned: 1 is straight on.
double henyey_greenstein(double g, double cosine);
double draine(double alpha, double g, double cosine);
double schlick(double g, double cosine);
double phase_value(const phase_model &model, double cosine);

// With g, draine_g and draine_alpha times `factor`: wider lobes, for octaves.
phase_model widened(const phase_model &model, double factor);

// Water droplets of a diameter in micrometres, 0 < d <= 50. Jendersie and
// d'Eon, "An Approximate Mie Scattering Function for Fog and Cloud Rendering",
// 2023.
phase_model droplet_phase(double diameter);

} // namespace reference

#endif
