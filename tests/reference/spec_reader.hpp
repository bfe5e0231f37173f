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
#include <optional>
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

// The number of an element.
inline size_t index_of(const ijk &at, const ijk &size)
{
    const size_t nx = static_cast<size_t>(size.x);
    const size_t ny = static_cast<size_t>(size.y);
    return static_cast<size_t>(at.x) +
           nx * (static_cast<size_t>(at.y) + ny * static_cast<size_t>(at.z));
}

inline size_t volume_of(const ijk &size)
{
    return static_cast<size_t>(size.x) * static_cast<size_t>(size.y) *
           static_cast<size_t>(size.z);
}

inline bool inside_of(const ijk &at, const ijk &size)
{
    return at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < size.x &&
           at.y < size.y && at.z < size.z;
}

// Throws std::runtime_error(what) when that does not hold.
void must(bool holds, const std::string &what);

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

// The head of SUNC. `at`: byte of the first code.
struct sun_points {
    int spacing; // voxels
    ijk size;    // points per axis
    std::array<double, 3> direction;
    double unit;
    size_t at;
};

// The head of AMBI. `at`: byte of the first cell.
struct sky_cells {
    double extinction;
    size_t at;
};

// The head of EMIT. `at`: byte of the first code.
struct emission_codes {
    double value; // of code 255
    size_t at;
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

    // Section MIPS: levels 1 .. mip_levels(), or 0.
    int mip_levels() const { return mip_levels_; }
    // Cubes of a level that reach into the pool, per axis.
    ijk mip_size(int level) const;
    // Of cube number (x,y,z); 0 outside the pool.
    int mip_code(int level, const ijk &cube) const;
    double mip_density(int level, const ijk &cube) const;

    // Section SUNC, if there is one, and what its codes mean.
    std::optional<sun_points> sun;
    int sun_code(const ijk &point) const; // of one of the grid's
    double sun_depth(double code) const;

    // Section AMBI, if there is one: 0 .. 1 of a cell of the grid.
    std::optional<sky_cells> sky;
    double sky_visibility(const ijk &cell) const;

    // Section EMIT, if there is one: codes of a brick's own 8x8x8 voxels.
    std::optional<emission_codes> emission;
    int emission_code(uint32_t brick, const ijk &voxel) const;
    // Anywhere in pool space: 0 outside the pool and in empty cells.
    int emission_at(const ijk &voxel) const;
    double emission_value(const ijk &voxel) const;

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
    void read_mips();
    void read_sun();
    void read_sky();
    void read_emission();
    const section &require(const std::string &id) const;
    uint32_t cell_word(const ijk &cell) const;
    uint32_t u16(size_t at) const;
    uint32_t u32(size_t at) const;
    double f64(size_t at) const;
    double number(size_t at) const;
    ijk u16x3(size_t at) const;

    std::vector<uint8_t> bytes_; // cut to the blob's size
    size_t cell_at_ = 0, pool_at_ = 0, range_at_ = 0, mips_at_ = 0;
    int mip_levels_ = 0;
};

// Reads a file; errors name it.
asset read_asset(const std::string &path);

} // namespace reference

#endif
