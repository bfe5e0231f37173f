// SPDX-License-Identifier: MIT
//
// Values of scene keys as text, and the table of keys that takes them.
#ifndef BRUME_REFERENCE_SCENE_VALUES_HPP
#define BRUME_REFERENCE_SCENE_VALUES_HPP

#include <limits>
#include <string>
#include <vector>

#include "scene.hpp"

namespace reference
{

constexpr double infinity = std::numeric_limits<double>::infinity();

// All throw std::runtime_error for text that does not parse or that is out of
// its range.
double parse_in(const std::string &text, double low, double high);
double parse_positive(const std::string &text);
uint32_t parse_integer(const std::string &text, double low, double high);
// Numbers separated by commas, by blanks, or by both.
std::vector<double> parse_list(const std::string &text);
vec3 parse_vec3(const std::string &text);
vec3 parse_colour(const std::string &text); // 0..16 each
// The position of `text` among `words`.
size_t parse_word(const std::string &text,
                  const std::vector<std::string> &words);

// Which scenes must set a key: what they are lit by decides.
enum class need { always, sun, light_scale, light_rays, never };

struct scene_key {
    const char *name;
    const char *fallback; // the default as it would be written, or null
    need required;
    const char *meaning;
    void (*set)(scene &, const std::string &);
};

// The keys of docs/light.md.
const std::vector<scene_key> &light_keys();

} // namespace reference

#endif
