// SPDX-License-Identifier: MIT
#include "bake.hpp"

#include <cstdarg>
#include <cstdio>
#include <unistd.h>
#include <vector>

namespace bake
{

std::string text(const char *format, ...)
{
    va_list args, again;

    va_start(args, format);
    va_copy(again, args);
    const int length = std::vsnprintf(nullptr, 0, format, args);
    va_end(args);
    std::vector<char> line(size_t(length < 0 ? 0 : length) + 1);
    std::vsnprintf(line.data(), line.size(), format, again);
    va_end(again);
    return line.data();
}

double physical_memory()
{
    const double pages = double(sysconf(_SC_PHYS_PAGES));
    return pages * double(sysconf(_SC_PAGESIZE));
}

void require_memory(double bytes, const char *what)
{
    const double have = physical_memory();

    if (bytes > have)
        throw failure(text("%s would take %.1f GiB of memory; this machine "
                           "has %.1f GiB",
                           what, bytes / 1073741824, have / 1073741824));
}

} // namespace bake
