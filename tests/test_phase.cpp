// SPDX-License-Identifier: MIT
//
// The core's phase tables against the formulas in double: every value within
// 0.5 %, narrow lobes included, and their integral over the sphere.

#include <cmath>
#include <string>

#include "brume.h"
#include "reference/phase.hpp"
#include "tap.h"

using namespace reference;

namespace
{

int32_t fixed(double value, int bits)
{
    return static_cast<int32_t>(std::lround(std::ldexp(value, bits)));
}

brume_phase_model core_model(const phase_model &m)
{
    brume_phase_model out = {};
    out.kind =
        m.kind == phase_kind::schlick ? BRUME_PHASE_SCHLICK : BRUME_PHASE_MIX;
    out.g = fixed(m.g, 30);
    out.draine_g = fixed(m.draine_g, 30);
    out.draine_alpha = static_cast<uint32_t>(fixed(m.draine_alpha, 16));
    out.weight = static_cast<uint32_t>(fixed(m.weight, 16));
    return out;
}

double value_of(const brume_phase &table, uint32_t u)
{
    const brume_number n = brume_phase_value(&table, u);
    return std::ldexp(static_cast<double>(n.m), n.e);
}

// Distances from either end of 0 .. 2, equally far apart in their logarithm:
// number i of n.
uint32_t distance(int i, int n)
{
    const double w = std::exp2(-30 + 30.0 * i / n);
    return static_cast<uint32_t>(std::lround(std::ldexp(w, 30)));
}

const uint32_t two = 1U << 31; // Q2.30

double worst_error(const brume_phase &table, const phase_model &m)
{
    const int n = 60000;
    double worst = 0;
    for (int i = 0; i <= n; i++) {
        const uint32_t w = distance(i, n);
        for (uint32_t u : {w, two - w}) {
            const double want = phase_value(m, 1 - std::ldexp(u, -30));
            const double off = std::fabs(value_of(table, u) / want - 1);
            worst = std::fmax(worst, off);
        }
    }
    return worst;
}

// The mean over the sphere: trapezoids between the same distances.
double mean_of(const brume_phase &table)
{
    const int n = 20000;
    double sum = 0, before = 0, weight = 0;
    for (int i = 0; i <= n; i++) {
        const uint32_t w = distance(i, n);
        const double both = value_of(table, w) + value_of(table, two - w);
        const double at = std::ldexp(w, -30);
        sum += (at - before) * (i == 0 ? both : (both + weight) / 2);
        before = at;
        weight = both;
    }
    return sum / 2;
}

void check_model(const std::string &name, const phase_model &m)
{
    for (unsigned octave : {0U, 1U, 5U}) {
        brume_phase table;
        const brume_phase_model model = core_model(m);
        const uint32_t c = 45875; // 0.7
        if (brume_phase_build(&table, &model, octave, c) != BRUME_OK) {
            tap_check(false, "%s: octave %u is built", name.c_str(), octave);
            continue;
        }
        const double factor = std::pow(c / 65536.0, octave);
        const double worst = worst_error(table, widened(m, factor));
        const double mean = mean_of(table);
        tap_check(worst <= 0.005 && std::fabs(mean - 1) <= 0.005,
                  "%s, octave %u: values within %.3f %%, mean %.5f",
                  name.c_str(), octave, 100 * worst, mean);
    }
}

void test_models()
{
    const phase_kind mix = phase_kind::mix, schlick = phase_kind::schlick;
    check_model("isotropic", {});
    for (double g : {-0.99, -0.5, 0.3, 0.9, 0.99, 0.999}) {
        const std::string of = " of g " + std::to_string(g);
        check_model("Henyey-Greenstein" + of, {mix, g, 0, 0, 0});
        check_model("Schlick" + of, {schlick, g, 0, 0, 0});
        check_model("Draine, alpha 1," + of, {mix, 0, g, 1, 1});
        check_model("Draine, alpha 40," + of, {mix, 0, g, 40, 1});
    }
    for (double d : {0.05, 0.1, 0.5, 1.0, 3.0, 5.0, 10.0, 50.0})
        check_model("droplets of " + std::to_string(d) + " um",
                    droplet_phase(d));
}

void test_refused()
{
    brume_phase table;
    const brume_phase_model good = {};
    brume_phase_model m = good;
    const auto build = [&](uint32_t octave, uint32_t c) {
        const int result = brume_phase_build(&table, &m, octave, c);
        m = good;
        return result;
    };
    tap_check(build(BRUME_MAX_OCTAVES - 1, 65536) == BRUME_OK &&
                  build(BRUME_MAX_OCTAVES, 0) == BRUME_ERR_SCENE &&
                  build(0, 65537) == BRUME_ERR_SCENE,
              "octaves and their factor: ranges");
    m.g = 1 << 30;
    tap_check(build(0, 0) == BRUME_ERR_SCENE, "refused: g of 1");
    m.draine_g = -(1 << 30);
    tap_check(build(0, 0) == BRUME_ERR_SCENE, "refused: draine_g of -1");
    m.draine_alpha = (1024U << 16) + 1;
    tap_check(build(0, 0) == BRUME_ERR_SCENE, "refused: alpha above 1024");
    m.weight = 65537;
    tap_check(build(0, 0) == BRUME_ERR_SCENE, "refused: a weight above 1");
    m.kind = 2;
    tap_check(build(0, 0) == BRUME_ERR_SCENE, "refused: another kind");
    tap_check(brume_phase_build(nullptr, &good, 0, 0) == BRUME_ERR_NULL &&
                  brume_phase_build(&table, nullptr, 0, 0) == BRUME_ERR_NULL,
              "refused: no table, no model");
}

} // namespace

int main()
{
    test_models();
    test_refused();
    return tap_done();
}
