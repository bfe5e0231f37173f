// SPDX-License-Identifier: MIT
//
// What every part of brume-bake shares: how it fails, small integer vectors,
// and the path of a volume through the program:
//
//     source -> extract -> resample -> layout -> quantise -> asset_writer
//     (grid)    (volume)   (volume)    (jobs)    (bricks)    (file)
//
// with light_sections, on demand, between the last two.
// Only source.cpp, source_nano.cpp and extract.cpp know OpenVDB.
#ifndef BRUME_CONVERT_BAKE_HPP
#define BRUME_CONVERT_BAKE_HPP

#include <cstdint>
#include <stdexcept>
#include <string>

namespace bake
{

// Exit statuses: the input is at fault, or the way we were called is.
enum status { status_failed = 1, status_usage = 2 };

// The one exception thrown by our own code. The text completes the line
// `brume-bake: FILE: `.
class failure : public std::runtime_error
{
  public:
    explicit failure(const std::string &what, status status = status_failed)
        : std::runtime_error(what), code(status)
    {
    }
    const status code;
};

struct ijk {
    int32_t x, y, z;
};

inline bool operator==(const ijk &a, const ijk &b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

// Both corners belong to the box.
struct box {
    ijk lo, hi;
};

// x / 8 rounded down, for either sign: shifts of negative numbers are
// arithmetic on every compiler that has C++17.
inline int32_t floor8(int32_t x)
{
    return x >> 3;
}

// printf into a string.
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
std::string
text(const char *format, ...);

// Bytes of memory this machine has, the limit of what is tried.
double physical_memory();

// Throws `failure` with the figures when `bytes` cannot be had.
void require_memory(double bytes, const char *what);

} // namespace bake

#endif
