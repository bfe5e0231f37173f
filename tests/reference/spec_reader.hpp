// SPDX-License-Identifier: MIT
//
// A second reader of the .brume asset, written from docs/SPEC.md alone.
//
// It decodes to double, one voxel at a time, and favours the page's wording
// over speed: where the core disagrees with it, one of the two misreads.
#ifndef BRUME_REFERENCE_SPEC_READER_HPP
#define BRUME_REFERENCE_SPEC_READER_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace reference {

struct ijk {
    int x, y, z;
};

inline ijk operator+(const ijk &a, const ijk &b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

inline ijk operator*(const ijk &a, int s)
{
    return {a.x * s, a.y * s, a.z * s};
}

// "(x,y,z)", for messages.
std::string to_text(const ijk &p);

// Element number `index` of a grid of `size`: x runs fastest, then y, then z.
inline ijk ijk_of(size_t index, const ijk &size)
{
    const size_t nx = static_cast<size_t>(size.x);
    const size_t ny = static_cast<size_t>(size.y);
    return {static_cast<int>(index % nx), static_cast<int>(index / nx % ny),
            static_cast<int>(index / nx / ny)};
}

// The CRC of PNG and zlib.
uint32_t crc32(const uint8_t *data, size_t count);

enum class code_format { u8 = 1, u8r = 2, u4r = 3 };

struct section {
    std::string id;
    size_t offset, bytes;
};

// A code's density is this many 65280ths of density_max.
struct density_units {
    int value;
    int step;             // what one code more adds
    bool lowest, highest; // the first or the last code of its brick's range
    bool stored;          // in a brick, not implied by an empty cell
};

class asset {
public:
    // Checks what SPEC.md says must hold; throws std::runtime_error with
    // what does not. Bytes after the blob's end are ignored.
    explicit asset(std::vector<uint8_t> bytes);

    // Header fields, by the names of SPEC.md.
    code_format format{};
    int side{};
    ijk cells{}, origin{}, box_min{}, box_max{};
    uint32_t bricks{}, voxels{};
    double density_max{}, density_mean{};
    std::array<double, 12> world_from_index{};
    std::vector<section> sections;

    size_t cell_count() const;
    ijk size() const { return cells * 8; } // voxels per axis
    bool inside(const ijk &cell) const;
    bool occupied(const ijk &cell) const;
    // 0 when occupied.
    int distance(const ijk &cell) const;
    uint32_t brick(const ijk &cell) const; // of an occupied cell

    // Voxel (x,y,z) of a brick; codes run to side - 1 on each axis.
    int code(uint32_t brick, const ijk &voxel) const;
    density_units units(uint32_t brick, const ijk &voxel) const;
    // Anywhere in pool space: zero outside the pool and in empty cells.
    density_units units_at(const ijk &voxel) const;
    double density(const ijk &voxel) const;

    // Raw bytes, for checks below the level of a voxel.
    const uint8_t *blob() const { return bytes_.data(); }
    size_t blob_size() const { return bytes_.size(); }
    const uint8_t *brick_data(uint32_t brick) const;
    size_t brick_bytes() const;
    // Base and scale of a ranged format's brick.
    std::array<int, 2> range(uint32_t brick) const;
    int top_code() const { return format == code_format::u4r ? 15 : 255; }
    bool ranged() const { return format != code_format::u8; }
    // Null when the asset has no such section.
    const section *find(const std::string &id) const;

private:
    void read_ident();
    void read_volume();
    void read_sections();
    void check_cells() const;
    void check_neighbours(const ijk &cell) const;
    void check_pool() const;
    void check_ranges() const;
    const section &require(const std::string &id) const;
    uint32_t cell_word(const ijk &cell) const;
    uint32_t u16(size_t at) const;
    uint32_t u32(size_t at) const;
    double f64(size_t at) const;
    double number(size_t at) const;
    ijk u16x3(size_t at) const;

    std::vector<uint8_t> bytes_; // cut to the blob's size
    size_t cell_at_ = 0, pool_at_ = 0, range_at_ = 0;
};

// Reads a file; errors name it.
asset read_asset(const std::string &path);

} // namespace reference

#endif
