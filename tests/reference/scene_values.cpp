// SPDX-License-Identifier: MIT

#include "scene_values.hpp"

#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace reference
{

static double parse_number(const std::string &text)
{
    char *end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !std::isfinite(value))
        throw std::runtime_error("'" + text + "' is not a number");
    return value;
}

double parse_in(const std::string &text, double low, double high)
{
    const double value = parse_number(text);
    if (value < low || value > high)
        throw std::runtime_error(text + " is out of range");
    return value;
}

double parse_positive(const std::string &text)
{
    return parse_in(text, std::numeric_limits<double>::min(), infinity);
}

uint32_t parse_integer(const std::string &text, double low, double high)
{
    const double value = parse_in(text, low, high);
    if (value != std::floor(value))
        throw std::runtime_error(text + " is not an integer");
    return static_cast<uint32_t>(value);
}

std::vector<double> parse_list(const std::string &text)
{
    static const char separators[] = ", \t";
    std::vector<double> values;
    size_t at = text.find_first_not_of(separators);
    while (at != std::string::npos) {
        const size_t end = text.find_first_of(separators, at);
        values.push_back(parse_number(text.substr(at, end - at)));
        at = text.find_first_not_of(separators, end);
    }
    return values;
}

vec3 parse_vec3(const std::string &text)
{
    const std::vector<double> v = parse_list(text);
    if (v.size() != 3)
        throw std::runtime_error("expected three numbers");
    return {v[0], v[1], v[2]};
}

vec3 parse_colour(const std::string &text)
{
    const vec3 c = parse_vec3(text);
    for (double value : {c.x, c.y, c.z})
        if (value < 0 || value > 16)
            throw std::runtime_error("a colour's parts are 0..16");
    return c;
}

size_t parse_word(const std::string &text,
                  const std::vector<std::string> &words)
{
    std::string all;
    for (size_t i = 0; i < words.size(); i++) {
        if (words[i] == text)
            return i;
        all += (i ? ", " : "") + words[i];
    }
    throw std::runtime_error("'" + text + "' is not one of " + all);
}

} // namespace reference
