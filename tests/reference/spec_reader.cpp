// SPDX-License-Identifier: MIT

#include "spec_reader.hpp"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace reference {

static const size_t header_bytes = 176;
static const size_t entry_bytes = 16;

void must(bool holds, const std::string &what)
{
    if (!holds)
        throw std::runtime_error(what);
}

// Bit by bit: reflected, polynomial 0x04c11db7.
uint32_t crc32(const uint8_t *data, size_t count)
{
    uint32_t crc = 0xffffffffU;
    for (size_t i = 0; i < count; i++) {
        crc ^= data[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320U : 0);
    }
    return ~crc;
}

/// Bytes ///

uint32_t asset::u16(size_t at) const
{
    return bytes_[at] | static_cast<uint32_t>(bytes_[at + 1]) << 8;
}

uint32_t asset::u32(size_t at) const
{
    return u16(at) | u16(at + 2) << 16;
}

double asset::f64(size_t at) const
{
    static_assert(sizeof(double) == 8, "f64 is IEEE 754 binary64");
    const uint64_t bits = u32(at) | static_cast<uint64_t>(u32(at + 4)) << 32;
    double value;
    std::memcpy(&value, &bits, 8);
    return value;
}

double asset::number(size_t at) const
{
    const uint32_t m = u32(at);
    const int e = static_cast<int32_t>(u32(at + 4));
    must(m == 0 || (m >= 0x80000000U && e >= -1024 && e <= 991),
         "number at byte " + std::to_string(at) + " is not normal");
    return m == 0 ? 0 : std::ldexp(static_cast<double>(m), e);
}

ijk asset::u16x3(size_t at) const
{
    return {static_cast<int>(u16(at)), static_cast<int>(u16(at + 2)),
            static_cast<int>(u16(at + 4))};
}

/// Header and sections ///

asset::asset(std::vector<uint8_t> bytes) : bytes_(std::move(bytes))
{
    read_ident();
    read_volume();
    read_sections();
    cell_at_ = require("CELL").offset;
    pool_at_ = require("POOL").offset;
    if (ranged())
        range_at_ = require("RNGE").offset;
    check_cells();
    check_pool();
    check_ranges();
    read_mips();
    read_sun();
    read_sky();
    read_emission();
}

void asset::read_ident()
{
    must(bytes_.size() >= header_bytes, "shorter than the header");
    must(std::memcmp(bytes_.data(), "BRME", 4) == 0, "bad magic");
    must(u16(4) == 1, "major version is not 1");
    const size_t size = u32(8);
    must(size <= bytes_.size(), "size exceeds the bytes at hand");
    must(size >= header_bytes + entry_bytes * u16(18),
         "size is less than the header and the section entries");
    bytes_.resize(size);
    must(crc32(bytes_.data() + 16, size - 16) == u32(12), "bad CRC");
}

void asset::read_volume()
{
    must(bytes_[16] >= 1 && bytes_[16] <= 3, "unknown format");
    format = static_cast<code_format>(bytes_[16]);
    side = bytes_[17];
    must(side == 8 || side == 9, "side is neither 8 nor 9");
    cells = u16x3(20);
    for (int n : {cells.x, cells.y, cells.z})
        must(n >= 1 && n <= 4095, "cells out of range");
    origin = {static_cast<int32_t>(u32(28)), static_cast<int32_t>(u32(32)),
              static_cast<int32_t>(u32(36))};
    box_min = u16x3(40);
    box_max = u16x3(46);
    must(box_min.x <= box_max.x && box_max.x < size().x &&
             box_min.y <= box_max.y && box_max.y < size().y &&
             box_min.z <= box_max.z && box_max.z < size().z,
         "box_min and box_max are not a box in the pool");
    bricks = u32(52);
    density_max = number(56);
    density_mean = number(64);
    voxels = u32(72);
    for (size_t i = 0; i < 12; i++)
        world_from_index[i] = f64(80 + 8 * i);
}

void asset::read_sections()
{
    const size_t count = u16(18);
    must(count >= 2 && count <= 32, "number of sections out of range");
    const size_t entries_end = header_bytes + entry_bytes * count;
    for (size_t i = 0; i < count; i++) {
        const size_t at = header_bytes + entry_bytes * i;
        const section s = {{bytes_.begin() + static_cast<long>(at),
                            bytes_.begin() + static_cast<long>(at + 4)},
                           u32(at + 4),
                           u32(at + 8)};
        must(s.offset % 64 == 0, s.id + ": offset is not a multiple of 64");
        must(s.offset >= entries_end, s.id + ": lies in the header");
        must(s.offset <= blob_size() && s.bytes <= blob_size() - s.offset,
             s.id + ": ends after the blob");
        must(!find(s.id), s.id + ": occurs twice");
        sections.push_back(s);
    }
}

const section *asset::find(const std::string &id) const
{
    for (const section &s : sections)
        if (s.id == id)
            return &s;
    return nullptr;
}

const section &asset::require(const std::string &id) const
{
    const section *s = find(id);
    must(s, id + ": missing");
    return *s;
}

/// Cells ///

size_t asset::cell_count() const
{
    return volume_of(cells);
}

bool asset::inside(const ijk &c) const
{
    return inside_of(c, cells);
}

uint32_t asset::cell_word(const ijk &c) const
{
    return u32(cell_at_ + 4 * index_of(c, cells));
}

bool asset::occupied(const ijk &cell) const
{
    return cell_word(cell) >> 31 == 0;
}

int asset::distance(const ijk &cell) const
{
    return occupied(cell) ? 0 : static_cast<int>(cell_word(cell) & 255);
}

uint32_t asset::brick(const ijk &cell) const
{
    return cell_word(cell);
}

std::string to_text(const ijk &p)
{
    return "(" + std::to_string(p.x) + "," + std::to_string(p.y) + "," +
           std::to_string(p.z) + ")";
}

// "Neighbouring" is read as the 26 around a cell: with the 6 that share a
// face, a distance would not be safe to leap over along a diagonal.
void asset::check_neighbours(const ijk &cell) const
{
    for (int n = 0; n < 27; n++) {
        const ijk other = cell + ijk{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
        must(!inside(other) ||
                 std::abs(distance(cell) - distance(other)) <= 1,
             "CELL: distances at " + to_text(cell) + " and " + to_text(other) +
                 " differ by more than 1");
    }
}

void asset::check_cells() const
{
    must(require("CELL").bytes == 4 * cell_count(),
         "CELL: wrong number of bytes");
    for (size_t i = 0; i < cell_count(); i++) {
        const ijk cell = ijk_of(i, cells);
        const uint32_t word = cell_word(cell);
        if (occupied(cell))
            must(word < bricks, "CELL: no such brick at " + to_text(cell));
        else
            must((word & 0x7fffff00U) == 0 && (word & 255) != 0,
                 "CELL: bad distance at " + to_text(cell));
    }
    for (size_t i = 0; i < cell_count(); i++)
        check_neighbours(ijk_of(i, cells));
}

/// Bricks ///

size_t asset::brick_bytes() const
{
    if (format == code_format::u4r)
        return side == 8 ? 256 : 368;
    return side == 8 ? 512 : 732;
}

void asset::check_pool() const
{
    must(require("POOL").bytes == uint64_t{bricks} * brick_bytes(),
         "POOL: wrong number of bytes");
}

void asset::check_ranges() const
{
    if (!ranged()) {
        must(!find("RNGE"), "RNGE: not allowed in u8");
        return;
    }
    must(require("RNGE").bytes == uint64_t{4} * bricks,
         "RNGE: wrong number of bytes");
    for (uint32_t b = 0; b < bricks; b++)
        must(range(b)[0] + top_code() * range(b)[1] <= 65280,
             "RNGE: range of brick " + std::to_string(b) + " is too large");
}

const uint8_t *asset::brick_data(uint32_t brick) const
{
    return bytes_.data() + pool_at_ + brick * brick_bytes();
}

std::array<int, 2> asset::range(uint32_t brick) const
{
    const size_t at = range_at_ + 4 * size_t{brick};
    return {static_cast<int>(u16(at)), static_cast<int>(u16(at + 2))};
}

int asset::code(uint32_t brick, const ijk &v) const
{
    const size_t i = static_cast<size_t>(v.x + side * (v.y + side * v.z));
    const uint8_t *data = brick_data(brick);
    if (format != code_format::u4r)
        return data[i];
    return i % 2 == 0 ? data[i / 2] & 15 : data[i / 2] >> 4;
}

density_units asset::units(uint32_t brick, const ijk &voxel) const
{
    const int q = code(brick, voxel);
    const std::array<int, 2> r =
        ranged() ? range(brick) : std::array<int, 2>{0, 256};
    return {r[0] + q * r[1], r[1], q == 0, q == top_code(), true};
}

density_units asset::units_at(const ijk &v) const
{
    const ijk cell = {v.x >> 3, v.y >> 3, v.z >> 3};
    if (!inside(cell) || !occupied(cell))
        return {0, 0, false, false, false};
    return units(brick(cell), {v.x & 7, v.y & 7, v.z & 7});
}

double asset::density(const ijk &voxel) const
{
    return units_at(voxel).value * density_max / 65280;
}

asset read_asset(const std::string &path)
{
    std::ifstream in(path, std::ios::binary);
    must(static_cast<bool>(in), path + ": cannot open");
    std::vector<uint8_t> bytes{std::istreambuf_iterator<char>(in),
                               std::istreambuf_iterator<char>()};
    must(!in.bad(), path + ": cannot read");
    try {
        return asset(std::move(bytes));
    } catch (const std::runtime_error &e) {
        throw std::runtime_error(path + ": " + e.what());
    }
}

} // namespace reference
