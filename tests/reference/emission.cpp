// SPDX-License-Identifier: MIT

#include "emission.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "scene_values.hpp"

namespace reference
{

/// Black bodies ///

static double skewed(double x, double mean, double below, double above)
{
    const double t = (x - mean) / (x < mean ? below : above);
    return std::exp(-0.5 * t * t);
}

// CIE 1931's matching functions at a wavelength in nanometres, as fitted by
// Wyman, Sloan and Shirley 2013.
static vec3 xyz_of(double l)
{
    return {1.056 * skewed(l, 599.8, 37.9, 31.0) +
                0.362 * skewed(l, 442.0, 16.0, 26.7) -
                0.065 * skewed(l, 501.1, 20.4, 26.2),
            0.821 * skewed(l, 568.8, 46.9, 40.5) +
                0.286 * skewed(l, 530.9, 16.3, 31.1),
            1.217 * skewed(l, 437.0, 11.8, 36.0) +
                0.681 * skewed(l, 459.0, 26.0, 13.8)};
}

// Planck's law, by Simpson's rule over the same range of the visible.
static vec3 radiated(double kelvin)
{
    const double hc_over_k = 1.438776877e7; // nanometre kelvin
    const int parts = 4000;
    const double from = 379.5, to = 780.5, h = (to - from) / parts;
    vec3 sum = {0, 0, 0};
    for (int i = 0; i <= parts; i++) {
        const double l = from + i * h;
        const double weight = i == 0 || i == parts ? 1 : i % 2 ? 4 : 2;
        const double b =
            1e13 / (std::pow(l, 5) * std::expm1(hc_over_k / (l * kelvin)));
        sum = sum + xyz_of(l) * (weight * b);
    }
    return sum;
}

// Linear sRGB of luminance 1, nothing negative.
static vec3 tint_of(const vec3 &c)
{
    vec3 rgb = {3.2404542 * c.x - 1.5371385 * c.y - 0.4985314 * c.z,
                -0.9692660 * c.x + 1.8760108 * c.y + 0.0415560 * c.z,
                0.0556434 * c.x - 0.2040259 * c.y + 1.0572252 * c.z};
    rgb = {std::max(rgb.x, 0.0), std::max(rgb.y, 0.0), std::max(rgb.z, 0.0)};
    const double y = 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z;
    return rgb * (1 / y);
}

static emission_colours black_body(double low, double high, double brightness)
{
    const double most = radiated(high).y;
    emission_colours out;
    for (int i = 0; i < 256; i++) {
        const vec3 xyz = radiated(low + (high - low) * i / 255);
        const vec3 c = tint_of(xyz) * (brightness * xyz.y / most);
        out.push_back(
            {std::min(c.x, 16.0), std::min(c.y, 16.0), std::min(c.z, 16.0)});
    }
    return out;
}

/// Text ///

static emission_colours read_file(const std::string &path)
{
    std::ifstream in(path);
    emission_colours out;
    std::string line;
    while (std::getline(in, line)) {
        line = line.substr(0, line.find('#'));
        if (line.find_first_not_of(" \t\r") != std::string::npos)
            out.push_back(parse_colour(line));
    }
    if (out.size() != 256)
        throw std::runtime_error(path + ": not 256 colours");
    return out;
}

emission_colours read_emission(const std::string &text)
{
    const std::string word = "blackbody:";
    if (text == "none")
        return {};
    if (text.compare(0, word.size(), word) != 0)
        return read_file(text);
    const std::vector<double> v = parse_list(text.substr(word.size()));
    if (v.size() != 3)
        throw std::runtime_error("expected 3 numbers after blackbody");
    return black_body(v[0], v[1], v[2]);
}

/// Values ///

static double largest_of(const float_dump &dump)
{
    float most = 0;
    for (const float v : dump.voxels)
        most = std::max(most, v);
    return static_cast<double>(most);
}

emission::emission(float_dump dump, double largest)
    : volume_(dump, std::numeric_limits<double>::infinity()),
      largest_(largest > 0 ? largest : largest_of(dump))
{
}

vec3 emission::colour(double value, const emission_colours &colours) const
{
    const double code = std::min(255 * value / largest_, 255.0);
    const size_t low = static_cast<size_t>(code);
    const double part = code - static_cast<double>(low);
    return colours[low] * (1 - part) +
           colours[std::min<size_t>(low + 1, 255)] * part;
}

} // namespace reference
