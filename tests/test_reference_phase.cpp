// SPDX-License-Identifier: MIT
//
// The reference's phase functions against integrals, moments and identities.

#include <cmath>

#include "reference/made.hpp"
#include "reference/phase.hpp"
#include "tap.h"

using namespace reference;

namespace
{

// Mean over all directions of f(cosine), which may have a narrow lobe at
// either end: Simpson's rule in the logarithm of the distance from the end.
template <class function> double mean_over_sphere(const function &f)
{
    const int n = 20000;
    const double low = std::log(1e-14);
    double sum = 0;
    for (int i = 0; i <= n; i++) {
        const double u = std::exp(low - low * i / n);
        const double weight = i == 0 || i == n ? 1 : i % 2 ? 4 : 2;
        sum += weight * u * (f(1 - u) + f(u - 1));
    }
    return sum * -low / n / 3 / 2;
}

double mean_cosine(const phase_model &m)
{
    return mean_over_sphere([&](double x) { return x * phase_value(m, x); });
}

phase_model hg_of(double g)
{
    return {phase_kind::mix, g, 0, 0, 0};
}

phase_model draine_of(double alpha, double g)
{
    return {phase_kind::mix, 0, g, alpha, 1};
}

phase_model schlick_of(double g)
{
    return {phase_kind::schlick, g, 0, 0, 0};
}

void test_phase_integrals()
{
    double worst = 0;
    int functions = 0;
    const auto check = [&](const phase_model &m) {
        const double mean =
            mean_over_sphere([&](double x) { return phase_value(m, x); });
        worst = std::fmax(worst, std::fabs(mean - 1));
        functions++;
    };
    for (double g : {-0.99, -0.6, -0.2, 0.0, 0.3, 0.7, 0.9, 0.99}) {
        check(hg_of(g));
        check(schlick_of(g));
        for (double alpha : {0.0, 0.5, 1.0, 22.0, 250.0})
            check(draine_of(alpha, g));
    }
    for (double d : {0.01, 0.05, 0.1, 0.3, 1.0, 1.5, 2.0, 4.9, 5.0, 10.0, 50.0})
        for (int octave = 0; octave < 8; octave++)
            check(widened(droplet_phase(d), std::pow(0.5, octave)));
    tap_check(functions == 8 * 7 + 11 * 8 && worst < 1e-6,
              "%d phase functions have mean 1 (worst %.1g off)", functions,
              worst);
}

void test_phase_moments()
{
    double worst = 0, worst_draine = 0;
    for (double g : {-0.99, -0.5, 0.0, 0.25, 0.85, 0.99}) {
        worst = std::fmax(worst, std::fabs(mean_cosine(hg_of(g)) - g));
        for (double alpha : {0.0, 1.0, 22.0, 250.0}) {
            const double want = g * (1 + alpha * (3 + 2 * g * g) / 5) /
                                (1 + alpha * (1 + 2 * g * g) / 3);
            const double got = mean_cosine(draine_of(alpha, g));
            worst_draine = std::fmax(worst_draine, std::fabs(got - want));
        }
    }
    check_near(worst, 0, 1e-6, "Henyey-Greenstein's mean cosine is g");
    check_near(worst_draine, 0, 1e-6, "Draine's mean cosine");
}

void test_phase_identities()
{
    double same = 0, rayleigh = 0, mirrored = 0;
    for (int i = 0; i <= 100; i++) {
        const double x = -1 + i / 50.0;
        same = std::fmax(
            same, std::fabs(draine(0, 0.7, x) / henyey_greenstein(0.7, x) - 1));
        rayleigh = std::fmax(rayleigh,
                             std::fabs(draine(1, 0, x) - 0.75 * (1 + x * x)));
        mirrored =
            std::fmax(mirrored, std::fabs(henyey_greenstein(-0.99, x) /
                                              henyey_greenstein(0.99, -x) -
                                          1));
    }
    check_near(same, 0, 1e-14, "Draine with alpha 0: Henyey-Greenstein");
    check_near(rayleigh, 0, 1e-14, "Draine with alpha 1 and g 0: Rayleigh");
    check_near(mirrored, 0, 1e-12, "-g turned about: g");
    // (1 + g) / (1 - g)^2, straight on
    check_near(henyey_greenstein(0.99, 1), 19900, 1e-6,
               "Henyey-Greenstein's peak");
    check_near(phase_value({}, 0.3), 1, 0, "isotropic");
    check_near(phase_value({phase_kind::mix, 0.5, 0.5, 0, 0.25}, 0.5),
               0.75 / std::pow(0.75, 1.5), 1e-14, "both parts of a mix");
}

// Schlick's is made to be like Henyey-Greenstein's; mean of the difference
// over the sphere.
void test_schlick()
{
    for (double g : {-0.4, 0.2, 0.6}) {
        const double off = mean_over_sphere([&](double x) {
            return std::fabs(schlick(g, x) - henyey_greenstein(g, x));
        });
        tap_check(off < 0.1,
                  "Schlick's differs from Henyey-Greenstein's by"
                  " %.3f in the mean at g = %g",
                  off, g);
    }
    check_near(schlick(0.99, 1), 1999, 1e-9, "Schlick's k is at most 0.999");
    // k = 1.55 / 2 - 0.55 / 8 = 0.70625
    check_near(schlick(0.5, -1), (1 - 0.70625) / (1 + 0.70625), 1e-14,
               "Schlick's k");
}

void test_droplets()
{
    // exp of -0.01189377, -0.1586445 - 0.428934, 3.62489 - 0.5340722 and
    // -0.06401563 - 0.665888
    const phase_model m = droplet_phase(10);
    tap_check(std::fabs(m.g - 0.988177) < 1e-6 &&
                  std::fabs(m.draine_g - 0.555671) < 1e-6 &&
                  std::fabs(m.draine_alpha - 21.9955) < 1e-4 &&
                  std::fabs(m.weight - 0.481955) < 1e-6,
              "droplets of 10 um: %.6f %.6f %.5f %.6f", m.g, m.draine_g,
              m.draine_alpha, m.weight);
    bool sane = true;
    for (double d = 0.01; d <= 50; d *= 1.01) {
        const phase_model p = droplet_phase(d);
        sane = sane && p.g > 0 && p.g < 1 && std::fabs(p.draine_g) < 1 &&
               p.draine_alpha > 0 && p.weight > 0 && p.weight < 1;
    }
    tap_check(sane, "0.01 to 50 um: all parameters in range");
    // Larger droplets scatter more of it forwards.
    double before = 0;
    for (double d : {0.05, 0.2, 2.0, 10.0, 40.0}) {
        const double cosine = mean_cosine(droplet_phase(d));
        tap_check(cosine > before, "%g um: mean cosine %.4f", d, cosine);
        before = cosine;
    }
}

} // namespace

int main()
{
    test_phase_integrals();
    test_phase_moments();
    test_phase_identities();
    test_schlick();
    test_droplets();
    return tap_done();
}
