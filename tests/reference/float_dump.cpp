// SPDX-License-Identifier: MIT

#include "float_dump.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace reference {

static_assert(sizeof(float) == 4, "a dump holds IEEE 754 binary32");

// The largest volume a brume asset can index has 4095 cells of 8 voxels.
static const int max_size = 4095 * 8;

// Turns little-endian bytes, read as they lie into floats, into the host's
// floats, and back. Compilers reduce it to nothing on little-endian hosts.
static void convert_little_endian(std::vector<float> &values)
{
    for (float &value : values) {
        unsigned char b[4];
        std::memcpy(b, &value, 4);
        uint32_t bits = static_cast<uint32_t>(b[0]) |
                        static_cast<uint32_t>(b[1]) << 8 |
                        static_cast<uint32_t>(b[2]) << 16 |
                        static_cast<uint32_t>(b[3]) << 24;
        std::memcpy(&value, &bits, 4);
    }
}

// The rest of the line `keyword values...`, split into its `count` numbers.
template <typename T>
static void read_line(std::istream &in, const char *keyword, T *values,
                      size_t count)
{
    std::string line, word, surplus;
    std::getline(in, line);
    std::istringstream fields(line);
    fields >> word;
    for (size_t i = 0; i < count; i++)
        fields >> values[i];
    if (!fields || word != keyword || fields >> surplus)
        throw std::runtime_error("bad '" + std::string(keyword) + "' line");
}

static void read_header(std::istream &in, float_dump &dump)
{
    std::string line;
    std::getline(in, line);
    if (line != "brume-float 1")
        throw std::runtime_error("not a brume-float 1 file");
    read_line(in, "size", dump.size.data(), 3);
    read_line(in, "origin", dump.origin.data(), 3);
    read_line(in, "world_from_index", dump.world_from_index.data(), 12);
    std::getline(in, line);
    if (line != "data float32le")
        throw std::runtime_error("expected 'data float32le'");
    for (int n : dump.size)
        if (n < 1 || n > max_size)
            throw std::runtime_error("size out of range");
}

// Compares with the file's length first, so that a wrong header cannot ask
// for more memory than the file justifies.
static void read_voxels(std::istream &in, float_dump &dump)
{
    const size_t count = voxel_count(dump.size);
    const std::streamoff start = in.tellg();
    in.seekg(0, std::ios::end);
    const std::streamoff bytes = in.tellg() - std::streampos(start);
    if (static_cast<uint64_t>(bytes) != uint64_t{4} * count)
        throw std::runtime_error("holds " + std::to_string(bytes) +
                                 " bytes of voxels instead of " +
                                 std::to_string(uint64_t{4} * count));
    in.seekg(start);
    dump.voxels.resize(count);
    in.read(reinterpret_cast<char *>(dump.voxels.data()), bytes);
    if (!in)
        throw std::runtime_error("cannot read the voxels");
    convert_little_endian(dump.voxels);
    for (size_t i = 0; i < count; i++)
        if (!std::isfinite(dump.voxels[i]))
            throw std::runtime_error("voxel " + std::to_string(i) +
                                     " is not finite");
}

float_dump read_float_dump(const std::string &path)
{
    std::ifstream in(path, std::ios::binary);
    if (!in)
        throw std::runtime_error(path + ": cannot open");
    try {
        float_dump dump;
        read_header(in, dump);
        read_voxels(in, dump);
        return dump;
    } catch (const std::runtime_error &e) {
        throw std::runtime_error(path + ": " + e.what());
    }
}

void write_float_dump(const std::string &path, const float_dump &dump)
{
    std::ofstream out(path, std::ios::binary);
    out.precision(17);
    out << "brume-float 1\nsize";
    for (int n : dump.size)
        out << ' ' << n;
    out << "\norigin";
    for (int n : dump.origin)
        out << ' ' << n;
    out << "\nworld_from_index";
    for (double m : dump.world_from_index)
        out << ' ' << m;
    out << "\ndata float32le\n";
    std::vector<float> voxels = dump.voxels;
    convert_little_endian(voxels);
    out.write(reinterpret_cast<const char *>(voxels.data()),
              static_cast<std::streamsize>(voxels.size() * 4));
    out.close();
    if (!out)
        throw std::runtime_error(path + ": cannot write");
}

} // namespace reference
