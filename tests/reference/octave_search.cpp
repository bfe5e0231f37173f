// SPDX-License-Identifier: MIT

#include "octave_search.hpp"

#include <cmath>
#include <limits>

namespace reference
{

static const int a_count = 51, c_count = 21;

octave_search::octave_search(const phase_model &phase,
                             std::vector<double> albedos,
                             const std::vector<octave_target> &targets)
    : phase_(phase), albedos_(std::move(albedos)), targets_(targets)
{
    for (size_t w = 0; w < albedos_.size(); w++)
        for (const octave_target &t : targets) {
            double sum = 0;
            for (double v : t.truth[w])
                sum += v * v;
            squares_[w].push_back(sum / static_cast<double>(t.truth[w].size()) -
                                  t.noise[w]);
        }
    for (int i = 0; i < a_count; i++)
        for (int j = 0; j < c_count; j++)
            for (const octave_target &t : targets)
                products_.push_back(make_products(t, i * a_step, j * c_step));
}

// Means over the picture.
octave_search::products octave_search::make_products(const octave_target &t,
                                                     double a, double c) const
{
    products p{};
    light_table::place place[max_octaves];
    phase_model phase[max_octaves];
    for (int i = 0; i < max_octaves; i++) {
        place[i] = light_table::find(std::pow(a, i));
        phase[i] = widened(phase_, std::pow(c, i));
    }
    const double share = 1 / static_cast<double>(t.pixels.size());
    for (size_t n = 0; n < t.pixels.size(); n++) {
        double term[max_octaves];
        for (int i = 0; i < max_octaves; i++) {
            term[i] = octave_term(t.pixels[n], phase[i], place[i]);
            p.sum[i] += share * term[i];
            for (int j = 0; j <= i; j++)
                p.terms[i][j] += share * term[i] * term[j];
            for (size_t w = 0; w < albedos_.size(); w++)
                p.truth[w][i] += share * term[i] * t.truth[w][n];
        }
    }
    return p;
}

const octave_search::products &octave_search::find(const octave_model &m,
                                                   size_t target) const
{
    const long i = std::lround(m.a / a_step), j = std::lround(m.c / c_step);
    return products_[static_cast<size_t>(i * c_count + j) * targets_.size() +
                     target];
}

octave_error octave_search::error_of(const products &p, const octave_target &t,
                                     size_t albedo,
                                     const std::vector<double> &weight) const
{
    const size_t at = static_cast<size_t>(&t - targets_.data());
    double square = squares_[albedo][at], mean = 0;
    for (size_t i = 0; i < weight.size(); i++) {
        mean += weight[i] * p.sum[i];
        square -= 2 * weight[i] * p.truth[albedo][i];
        for (size_t j = 0; j < i; j++)
            square += 2 * weight[i] * weight[j] * p.terms[i][j];
        square += weight[i] * weight[i] * p.terms[i][i];
    }
    const double scale = t.mean[albedo];
    return {square / (scale * scale), mean / scale - 1};
}

octave_error octave_search::sum_errors(const octave_model &m, size_t albedo,
                                       const choice &of,
                                       const std::vector<double> &weight) const
{
    octave_error sum = {0, 0};
    int count = 0;
    for (size_t n = 0; n < targets_.size(); n++) {
        if (!of(targets_[n]))
            continue;
        const octave_error e =
            error_of(find(m, n), targets_[n], albedo, weight);
        sum.rmse += e.rmse;
        sum.mean += e.mean;
        count++;
    }
    return {std::sqrt(std::max(0.0, sum.rmse / count)), sum.mean / count};
}

octave_error octave_search::error(const octave_model &m, size_t albedo,
                                  const choice &of, double share) const
{
    std::vector<double> weight;
    for (int i = 0; i < m.count; i++)
        weight.push_back(share * albedos_[albedo] * std::pow(m.b, i));
    return sum_errors(m, albedo, of, weight);
}

// That is octave 1 alone, its phase function unchanged.
octave_error octave_search::softened(double a, size_t albedo,
                                     const choice &of) const
{
    const octave_model m = {a, 1, 1, 2};
    return sum_errors(m, albedo, of, {0, albedos_[albedo]});
}

octave_model octave_search::fit(int count, size_t albedo, const choice &of,
                                const rule &share) const
{
    octave_model best, m;
    double least = std::numeric_limits<double>::infinity();
    m.count = count;
    for (int i = 0; i < a_count; i++)
        for (int j = 0; j < c_count; j++)
            for (int k = 0; k <= 100; k++) {
                m.a = i * a_step;
                m.b = k * 0.01;
                m.c = j * c_step;
                const double factor = share ? share(m) : 1;
                if (!(factor > 0))
                    continue;
                const double e = error(m, albedo, of, factor).rmse;
                if (e < least) {
                    least = e;
                    best = m;
                }
            }
    return best;
}

} // namespace reference
