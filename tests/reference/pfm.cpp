// SPDX-License-Identifier: MIT

#include "pfm.hpp"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace reference {

static void append_float(std::string &bytes, double value)
{
    const float narrow = static_cast<float>(value);
    uint32_t bits;
    std::memcpy(&bits, &narrow, 4);
    for (int shift = 0; shift < 32; shift += 8)
        bytes += static_cast<char>(bits >> shift & 255);
}

void write_pfm(const std::string &path, const picture &image)
{
    const size_t row = static_cast<size_t>(image.width) *
                       static_cast<size_t>(image.channels);
    // A negative scale says that the floats are little-endian.
    std::string bytes = (image.channels == 3 ? "PF\n" : "Pf\n") +
                        std::to_string(image.width) + " " +
                        std::to_string(image.height) + "\n-1.0\n";
    for (int y = image.height - 1; y >= 0; y--)
        for (size_t i = 0; i < row; i++)
            append_float(bytes,
                         image.values[static_cast<size_t>(y) * row + i]);
    std::ofstream out(path, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out)
        throw std::runtime_error(path + ": cannot write");
}

} // namespace reference
