// SPDX-License-Identifier: MIT
//
// Files of what is there besides the volume.

#include "air.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "scene_values.hpp"

namespace reference
{

static std::runtime_error bad(const std::string &path, const std::string &what)
{
    return std::runtime_error(path + ": " + what);
}

static fog_shape shape_of(const std::string &line)
{
    std::istringstream in(line);
    std::string kind, centre, half, rest;
    in >> kind >> centre >> half;
    std::getline(in, rest);
    fog_shape s{};
    s.box = kind == "box";
    if (!s.box && kind != "sphere")
        throw std::runtime_error("'" + kind + "' is not sphere, box");
    s.centre = parse_vec3(centre);
    s.half = s.box ? parse_vec3(half) : vec3{parse_positive(half), 0, 0};
    const std::vector<double> numbers = parse_list(rest);
    if (numbers.empty() || numbers.size() > 2)
        throw std::runtime_error("expected a density and perhaps a softness");
    s.density = numbers[0];
    s.softness = numbers.size() == 2 ? numbers[1] : 0;
    return s;
}

std::vector<fog_shape> read_fog_shapes(const std::string &path)
{
    std::ifstream in(path);
    std::vector<fog_shape> shapes;
    std::string line;
    if (!in)
        throw bad(path, "cannot open");
    for (int number = 1; std::getline(in, line); number++) {
        line = line.substr(0, line.find('#'));
        if (line.find_first_not_of(" \t\r") == std::string::npos)
            continue;
        try {
            shapes.push_back(shape_of(line));
        } catch (const std::runtime_error &e) {
            throw bad(path + ":" + std::to_string(number), e.what());
        }
    }
    return shapes;
}

// The next word of a PGM's head; comments are collected.
static std::string head_word(std::istream &in, grey_map &map)
{
    std::string word, comment;
    while (in >> word && word[0] == '#') {
        std::getline(in, comment);
        map.comments.push_back(word.substr(1) + comment);
    }
    return word;
}

grey_map read_grey_map(const std::string &path)
{
    std::ifstream in(path, std::ios::binary);
    grey_map map;
    if (!in || head_word(in, map) != "P5")
        throw bad(path, "is no binary PGM");
    map.width = static_cast<int>(parse_integer(head_word(in, map), 1, 65535));
    map.height = static_cast<int>(parse_integer(head_word(in, map), 1, 65535));
    if (head_word(in, map) != "65535" || in.get() < 0)
        throw bad(path, "is not of 16 bits");
    const size_t n = static_cast<size_t>(map.width) *
                     static_cast<size_t>(map.height);
    std::vector<char> bytes(2 * n);
    if (!in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
        throw bad(path, "is too short");
    for (size_t i = 0; i < n; i++)
        map.values.push_back(
            static_cast<uint16_t>(static_cast<uint8_t>(bytes[2 * i]) << 8 |
                                  static_cast<uint8_t>(bytes[2 * i + 1])));
    return map;
}

// The numbers of the comment that begins with a word.
static std::vector<double> comment_of(const sun_map &map,
                                      const std::string &path,
                                      const std::string &word)
{
    for (const std::string &comment : map.texels.comments) {
        std::istringstream in(comment);
        std::string first, rest;
        in >> first;
        std::getline(in, rest);
        if (first == word)
            return parse_list(rest);
    }
    throw bad(path, "no comment '" + word + "'");
}

sun_map read_sun_map(const std::string &path)
{
    sun_map map;
    map.texels = read_grey_map(path);
    const auto vector_of = [&](const char *word) {
        const std::vector<double> v = comment_of(map, path, word);
        if (v.size() != 3)
            throw bad(path, std::string("expected three numbers: ") + word);
        return vec3{v[0], v[1], v[2]};
    };
    map.origin = vector_of("origin");
    map.across = vector_of("across");
    map.down = vector_of("down");
    map.range = comment_of(map, path, "range").at(0);
    map.bias = comment_of(map, path, "bias").at(0);
    return map;
}

} // namespace reference
