// SPDX-License-Identifier: MIT
//
// The a, b, c of octaves that come nearest to pictures of multiple scattering.
//
// For a, c given an octave picture is a polynomial in b, so its squared error
// is one too, made of products of the octaves with each other and with the
// picture. These are kept for a lattice of a and c; then any b, number of
// octaves, albedo and choice of pictures costs nothing.
#ifndef BRUME_REFERENCE_OCTAVE_SEARCH_HPP
#define BRUME_REFERENCE_OCTAVE_SEARCH_HPP

#include <functional>
#include <string>
#include <vector>

#include "octaves.hpp"

namespace reference
{

const int max_albedos = 4;

// One picture: what is marched, and what is true, with its variance.
struct octave_target {
    int group;  // the volume it is of
    bool probe; // to be shown, but not fitted to
    int view;
    std::vector<marched_pixel> pixels;
    std::vector<double> truth[max_albedos];
    double noise[max_albedos]; // mean of the squared standard errors
    double mean[max_albedos];  // of truth
};

// Relative to a picture's mean. The RMSE has the noise of the truth taken out;
// of several pictures, it is the root of the mean of its squares.
struct octave_error {
    double rmse, mean;
};

class octave_search
{
  public:
    using choice = std::function<bool(const octave_target &)>;
    using rule = std::function<double(const octave_model &)>;

    // Keeps a reference to the targets.
    octave_search(const phase_model &phase, std::vector<double> albedos,
                  const std::vector<octave_target> &targets);

    // Over the pictures of a choice. `share` is a factor for all octaves.
    octave_error error(const octave_model &m, size_t albedo, const choice &of,
                       double share = 1) const;

    // That of one octave whose optical depth towards the sun is a times what
    // it is: light_density_scale = a * density_scale.
    octave_error softened(double a, size_t albedo, const choice &of) const;

    // Least RMSE over the lattice; with a share for each model, if given, and
    // without those whose share is 0.
    octave_model fit(int count, size_t albedo, const choice &of,
                     const rule &share = nullptr) const;

    // The lattice: a and c in these steps, b in hundredths.
    static constexpr double a_step = 0.02, c_step = 0.05;

  private:
    struct products {
        double terms[max_octaves][max_octaves];
        double truth[max_albedos][max_octaves];
        double sum[max_octaves];
    };
    products make_products(const octave_target &t, double a, double c) const;
    const products &find(const octave_model &m, size_t target) const;
    octave_error sum_errors(const octave_model &m, size_t albedo,
                            const choice &of,
                            const std::vector<double> &weight) const;
    octave_error error_of(const products &p, const octave_target &t,
                          size_t albedo,
                          const std::vector<double> &weight) const;

    const phase_model phase_;
    const std::vector<double> albedos_;
    const std::vector<octave_target> &targets_;
    std::vector<double> squares_[max_albedos]; // of truth, mean, less noise
    std::vector<products> products_;           // by a, c, target
};

} // namespace reference

#endif
