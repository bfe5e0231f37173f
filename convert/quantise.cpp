// SPDX-License-Identifier: MIT
//
// gcc's -O2 leaves most of these loops to the scalar unit, and so do
// floating-point exceptions, which nobody asks for.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("O3", "no-trapping-math")
#endif
#include "quantise.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "brume.h"

namespace bake
{

namespace
{

constexpr int top_u8 = 255, top_u4 = 15;
constexpr int u4_rounds = 4; // of least squares; more gain below 0.1 %

// One brick on its way: densities in units, and the codes so far. Floats hold
// units to 1/256 at worst, far below the half step of any code, and let twice
// as many voxels go through a vector register.
struct work {
    int count;
    int top;
    float units[max_brick_voxels];
    uint8_t codes[max_brick_voxels];
};

range fit(double lo, double hi, int top)
{
    double base = 0, scale;

    if (lo == 0) {
        scale = std::ceil(hi / (top + 0.5));
    } else {
        scale = std::ceil((hi - lo) / (top + 1));
        base = std::floor((lo + hi - top * scale) / 2 + 0.5);
        base = std::clamp(base, 0.0, BRUME_RANGE_TOP - top * scale);
    }
    return {uint16_t(base), uint16_t(scale)};
}

// Nearest codes for a range.
void encode(work &w, range r)
{
    const float base = r.base, inverse = r.scale ? 1.0f / r.scale : 0;
    const float top = float(w.top);

    for (int i = 0; i < w.count; i++) {
        float q = (w.units[i] - base) * inverse + 0.5f;
        q = q > 0 ? q : 0;
        q = q < top ? q : top;
        w.codes[i] = uint8_t(int(q));
    }
}

// Densities in units. Rounding may lift the maximum a hair above the top of
// the scale.
template <class real> void scale(const float *densities, real units, work &w)
{
    const float top = float(BRUME_RANGE_TOP);

    for (int i = 0; i < w.count; i++) {
        const float u = float(real(densities[i]) * units);
        w.units[i] = u < top ? u : top;
    }
}

void to_units(const brick_format &f, const float *densities, work &w)
{
    // Without density there is nothing to scale.
    const double units =
        f.density_max > 0 ? double(BRUME_RANGE_TOP) / double(f.density_max) : 0;

    // A product of two floats is exact in double, so one rounding to float
    // gives the same either way, and floats are twice as fast.
    if (double(float(units)) == units)
        scale(densities, float(units), w);
    else
        scale(densities, units, w);
}

// In columns, for the vector units. 512 and 729 leave a rest of 0 and 1: the
// last voxel, where the columns start.
void find_extremes(const work &w, float &lo, float &hi)
{
    float least[8], most[8];

    std::fill_n(least, 8, w.units[w.count - 1]);
    std::fill_n(most, 8, w.units[w.count - 1]);
    for (int i = 0; i + 8 <= w.count; i += 8)
        for (int k = 0; k < 8; k++) {
            const float u = w.units[i + k];
            least[k] = u < least[k] ? u : least[k];
            most[k] = u > most[k] ? u : most[k];
        }
    lo = *std::min_element(least, least + 8);
    hi = *std::max_element(most, most + 8);
}

double squared_error(const work &w, range r)
{
    double sum = 0;

    for (int i = 0; i < w.count; i++) {
        const double e =
            double(r.base + w.codes[i] * r.scale) - double(w.units[i]);
        sum += e * e;
    }
    return sum;
}

// The range that suits the present codes best: a line through (code, units),
// held through the origin when the brick has exact zeros.
range least_squares(const work &w, bool through_zero)
{
    double q = 0, u = 0, qq = 0, qu = 0, base = 0, scale = 0;

    for (int i = 0; i < w.count; i++) {
        q += w.codes[i];
        u += double(w.units[i]);
        qq += w.codes[i] * w.codes[i];
        qu += w.codes[i] * double(w.units[i]);
    }
    const double n = w.count, det = n * qq - q * q;
    if (through_zero) {
        scale = qq > 0 ? qu / qq : 0;
    } else {
        scale = det > 0 ? (n * qu - q * u) / det : 0;
        base = (u - scale * q) / n;
    }
    scale = std::clamp(std::floor(scale + 0.5), 0.0,
                       double(BRUME_RANGE_TOP / unsigned(w.top)));
    base = std::clamp(std::floor(base + 0.5), 0.0,
                      BRUME_RANGE_TOP - w.top * scale);
    return {uint16_t(base), uint16_t(scale)};
}

// Alternate least squares and nearest codes while that helps.
range refine(work &w, range best, bool through_zero)
{
    double error = squared_error(w, best);
    uint8_t codes[max_brick_voxels];

    for (int round = 0; round < u4_rounds; round++) {
        const range r = least_squares(w, through_zero);
        if (r == best)
            break;
        std::memcpy(codes, w.codes, sizeof codes);
        encode(w, r);
        const double e = squared_error(w, r);
        if (e >= error) {
            std::memcpy(w.codes, codes, sizeof codes);
            break;
        }
        error = e;
        best = r;
    }
    return best;
}

// The errors of the cell's own voxels, the first 8 of `side` on each axis.
void measure_error(const work &w, int side, brick_result &out)
{
    const float base = out.r.base, scale = out.r.scale;
    float sum[8] = {}, worst[8] = {};

    for (int row = 0; row < 64; row++) {
        const int first = side * (row % 8 + side * (row / 8));
#pragma GCC unroll 1
        for (int i = 0; i < 8; i++) {
            // Zeros add nothing: they decode to exactly 0.
            const float e = std::fabs(base + w.codes[first + i] * scale -
                                      w.units[first + i]);
            sum[i] += e * e;
            worst[i] = e > worst[i] ? e : worst[i];
        }
    }
    out.squared_error = 0;
    for (float s : sum)
        out.squared_error += double(s);
    out.worst_error = double(*std::max_element(worst, worst + 8));
}

void pack(const work &w, const brick_format &f, uint8_t *out)
{
    std::memset(out, 0, f.bytes());
    if (w.top == top_u8) {
        std::memcpy(out, w.codes, size_t(w.count));
        return;
    }
    for (int i = 0; i < w.count; i++)
        out[i / 2] = uint8_t(out[i / 2] | w.codes[i] << (i % 2 * 4));
}

} // namespace

int brick_format::top() const
{
    return format == BRUME_U4R ? top_u4 : top_u8;
}

bool brick_format::has_ranges() const
{
    return format != BRUME_U8;
}

size_t brick_format::bytes() const
{
    const int voxels = side * side * side;
    const int bytes = format == BRUME_U4R ? (voxels + 1) / 2 : voxels;

    return size_t(bytes + 3) / 4 * 4;
}

const char *brick_format::name() const
{
    return format == BRUME_U8 ? "u8" : format == BRUME_U8R ? "u8r" : "u4r";
}

brick_result quantise(const brick_format &f, const float *densities,
                      uint8_t *codes)
{
    work w;
    brick_result out = {};
    float lo = 0, hi = 0;

    w.count = f.side * f.side * f.side;
    w.top = f.top();
    to_units(f, densities, w);
    out.r = {0, 256};
    if (f.has_ranges()) {
        find_extremes(w, lo, hi);
        out.r = fit(double(lo), double(hi), w.top);
    }
    encode(w, out.r);
    if (f.format == BRUME_U4R)
        out.r = refine(w, out.r, lo == 0);
    measure_error(w, f.side, out);
    pack(w, f, codes);
    const auto used = [](uint8_t q) { return q != 0; };
    out.empty =
        out.r.base == 0 &&
        (out.r.scale == 0 || std::none_of(w.codes, w.codes + w.count, used));
    return out;
}

} // namespace bake
