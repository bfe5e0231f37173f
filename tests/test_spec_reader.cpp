// SPDX-License-Identifier: MIT
//
// The second reader on assets laid out here by hand, byte by byte: it decodes
// them, refuses what it must and reports what the converter would not write.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tap.h"
#include "spec_check.hpp"
#include "spec_reader.hpp"

using namespace reference;

namespace {

using blob = std::vector<uint8_t>;

/// Writing ///

void put(blob &b, size_t at, uint64_t value, size_t bytes)
{
    for (size_t i = 0; i < bytes; i++)
        b[at + i] = static_cast<uint8_t>(value >> 8 * i);
}

void put_f64(blob &b, size_t at, double value)
{
    uint64_t bits;
    std::memcpy(&bits, &value, 8);
    put(b, at, bits, 8);
}

// value = m·2^e with 2^31 <= m < 2^32.
void put_number(blob &b, size_t at, double value)
{
    int e;
    const double fraction = std::frexp(value, &e);
    put(b, at, static_cast<uint32_t>(std::lround(std::ldexp(fraction, 32))),
        4);
    put(b, at + 4, static_cast<uint32_t>(e - 32), 4);
}

void seal(blob &b)
{
    put(b, 12, crc32(b.data() + 16, b.size() - 16), 4);
}

const ijk cells = {5, 3, 4};

// Two 12-voxel-wide blobs of codes, one of them crossing a cell's border;
// both look the same within their own bricks, so that bricks are shared.
int code_at(const ijk &v)
{
    const ijk p = v.x >= 24 ? v + ijk{-24, 0, -16} : v;
    if (p.x < 2 || p.x > 13 || p.y < 3 || p.y > 12 || p.z < 1 || p.z > 9)
        return 0;
    return 1 + (p.x * 3 + p.y * 5 + p.z * 7) % 15;
}

struct layout {
    code_format format;
    int side;
};

blob encode_brick(const layout &how, const ijk &cell)
{
    const int n = how.side;
    const bool nibbles = how.format == code_format::u4r;
    const size_t sizes[2][2] = {{512, 732}, {256, 368}};
    blob brick(sizes[nibbles][n - 8]);
    for (int i = 0; i < n * n * n; i++) {
        const ijk v = cell * 8 + ijk{i % n, i / n % n, i / n / n};
        const int code = code_at(v);
        const int at = nibbles ? i / 2 : i;
        brick[static_cast<size_t>(at)] |= static_cast<uint8_t>(
            nibbles && i % 2 ? code << 4 : code);
    }
    return brick;
}

// By brute force over all pairs.
int nearest_brick(const std::vector<int> &bricks, size_t from)
{
    int best = 255;
    for (size_t to = 0; to < bricks.size(); to++) {
        const ijk a = ijk_of(from, cells), b = ijk_of(to, cells);
        if (bricks[to] >= 0)
            best = std::min(best, std::max({std::abs(a.x - b.x),
                                            std::abs(a.y - b.y),
                                            std::abs(a.z - b.z)}));
    }
    return best;
}

struct content {
    std::vector<int> brick_of_cell; // -1: empty
    std::vector<blob> bricks;
};

content collect(const layout &how)
{
    content c;
    const size_t count = static_cast<size_t>(cells.x * cells.y * cells.z);
    for (size_t i = 0; i < count; i++) {
        const blob brick = encode_brick(how, ijk_of(i, cells));
        const auto same =
            std::find(c.bricks.begin(), c.bricks.end(), brick);
        if (std::count(brick.begin(), brick.end(), 0) ==
            static_cast<long>(brick.size())) {
            c.brick_of_cell.push_back(-1);
            continue;
        }
        c.brick_of_cell.push_back(static_cast<int>(same - c.bricks.begin()));
        if (same == c.bricks.end())
            c.bricks.push_back(brick);
    }
    return c;
}

// Appends at the next multiple of 64.
void append(blob &b, size_t entry, const char *id, const blob &bytes)
{
    b.resize((b.size() + 63) / 64 * 64);
    std::memcpy(&b[entry], id, 4);
    put(b, entry + 4, b.size(), 4);
    put(b, entry + 8, bytes.size(), 4);
    b.insert(b.end(), bytes.begin(), bytes.end());
}

void put_header(blob &b, const layout &how, const content &c)
{
    std::memcpy(b.data(), "BRME", 4);
    put(b, 4, 1, 2);
    b[16] = static_cast<uint8_t>(how.format);
    b[17] = static_cast<uint8_t>(how.side);
    put(b, 18, 4, 2);
    const int fields[] = {cells.x, cells.y, cells.z};
    const int low[] = {2, 3, 1}, high[] = {37, 12, 25};
    double sum = 0;
    uint32_t voxels = 0;
    for (int i = 0; i < 40 * 24 * 32; i++) {
        const int code = code_at(ijk_of(static_cast<size_t>(i), cells * 8));
        sum += code;
        voxels += code != 0;
    }
    for (size_t i = 0; i < 3; i++) {
        put(b, 20 + 2 * i, static_cast<uint64_t>(fields[i]), 2);
        put(b, 28 + 4 * i, static_cast<uint64_t>(-7), 4);
        put(b, 40 + 2 * i, static_cast<uint64_t>(low[i]), 2);
        put(b, 46 + 2 * i, static_cast<uint64_t>(high[i]), 2);
        put_f64(b, 80 + 40 * i, 0.5);
    }
    put(b, 52, c.bricks.size(), 4);
    put_number(b, 56, 5.7);
    put_number(b, 64, sum * 5.7 / 255 / voxels);
    put(b, 72, voxels, 4);
}

// Ranged bricks have base 0 and scale 256, which makes a code worth the same
// in all three formats. The fourth section is NAME, or one of unknown id.
blob make_asset(const layout &how)
{
    const content c = collect(how);
    blob b(176 + 4 * 16), grid(4 * c.brick_of_cell.size()), pool, ranges;
    put_header(b, how, c);
    for (size_t i = 0; i < c.brick_of_cell.size(); i++) {
        const int brick = c.brick_of_cell[i];
        const uint32_t distance = static_cast<uint32_t>(
            nearest_brick(c.brick_of_cell, i));
        put(grid, 4 * i,
            brick < 0 ? 0x80000000U | distance : static_cast<uint32_t>(brick),
            4);
    }
    for (const blob &brick : c.bricks)
        pool.insert(pool.end(), brick.begin(), brick.end());
    ranges.resize(4 * c.bricks.size());
    for (size_t i = 0; i < c.bricks.size(); i++)
        put(ranges, 4 * i + 2, 256, 2);
    append(b, 176, "CELL", grid);
    append(b, 192, "POOL", pool);
    append(b, 208, how.format == code_format::u8 ? "what" : "RNGE", ranges);
    append(b, 224, "NAME", {'f', 'o', 'g'});
    put(b, 8, b.size(), 4);
    seal(b);
    return b;
}

size_t section_at(const blob &b, const char *id)
{
    const asset a(b);
    return a.find(id)->offset;
}

/// Reading ///

void test_crc()
{
    const char digits[] = "123456789";
    tap_check(crc32(reinterpret_cast<const uint8_t *>(digits), 9) ==
                  0xcbf43926U,
              "crc of 123456789, the check value of every catalogue");
}

void test_decode(const char *name, const layout &how)
{
    const asset a(make_asset(how));
    bool same = true;
    for (size_t i = 0; i < 40 * 24 * 32; i++) {
        const ijk v = ijk_of(i, a.size());
        same = same && std::fabs(a.density(v) - code_at(v) * 5.7 / 255) < 1e-9;
    }
    tap_check(same, "%s: every voxel decodes", name);
    const std::vector<std::string> lines = check_asset(a);
    tap_check(lines.empty(), "%s: the checks find nothing", name);
    for (const std::string &line : lines)
        std::printf("# %s\n", line.c_str());
    tap_check(a.bricks < 16 && a.origin.z == -7 &&
                  std::fabs(a.density_max - 5.7) < 1e-8,
              "%s: header; bricks are shared", name);
}

// d = (base + q·scale)·density_max / 65280, by hand: 1000 + 3·41 = 1123.
void test_range()
{
    blob b = make_asset({code_format::u4r, 8});
    const asset plain(b);
    const uint32_t brick = plain.brick({0, 0, 0});
    const size_t at = section_at(b, "RNGE") + 4 * brick;
    put(b, at, 1000, 2);
    put(b, at + 2, 41, 2);
    seal(b);
    const asset a(b);
    // (2,4,6) has code 1 + (6 + 20 + 42) % 15 = 9, (3,3,6) code 1 + 66 % 15.
    tap_check(std::fabs(a.density({2, 4, 6}) - 1369 * 5.7 / 65280) < 1e-9 &&
                  std::fabs(a.density({3, 3, 6}) - 1287 * 5.7 / 65280) < 1e-9,
              "a brick's base and scale");
}

/// Refusing ///

struct change {
    const char *what;
    size_t at;
    uint64_t value;
    size_t bytes;
    bool reseal;
    const char *message;
};

std::string refusal(const blob &b)
{
    try {
        const asset a(b);
    } catch (const std::runtime_error &e) {
        return e.what();
    }
    return "";
}

void test_refused(blob b, const change &c)
{
    put(b, c.at, c.value, c.bytes);
    if (c.reseal)
        seal(b);
    const std::string got = refusal(b);
    tap_check(got.find(c.message) != std::string::npos && !got.empty(),
              "refused: %s (%s)", c.what, got.c_str());
}

void test_must()
{
    const blob good = make_asset({code_format::u8r, 9});
    const size_t cell = section_at(good, "CELL");
    const size_t range = section_at(good, "RNGE");
    const change changes[] = {
        {"magic", 0, 'b', 1, true, "magic"},
        {"major", 4, 2, 2, true, "major"},
        {"size beyond the file", 8, good.size() + 1, 4, true, "at hand"},
        {"size under the entries", 8, 239, 4, true, "less than"},
        {"crc", 12, 0, 4, false, "CRC"},
        {"a flipped bit", good.size() - 1, 'h', 1, false, "CRC"},
        {"format", 16, 4, 1, true, "format"},
        {"side", 17, 7, 1, true, "side"},
        {"one section", 18, 1, 2, true, "sections"},
        {"cells", 22, 4096, 2, true, "cells"},
        {"box", 40, 38, 2, true, "box"},
        {"box beyond the pool", 46, 40, 2, true, "box"},
        {"number", 56, 0x7fffffff, 4, true, "number"},
        {"exponent", 60, 1024, 4, true, "number"},
        {"offset in the header", 180, 192, 4, true, "header"},
        {"offset off 64", 180, cell + 4, 4, true, "64"},
        {"section past the end", 184, good.size(), 4, true, "after"},
        {"id twice", 224, 'L' << 24 | 'L' << 16 | 'E' << 8 | 'C', 4, true,
         "twice"},
        {"no cells", 176, 'c', 1, true, "CELL: missing"},
        {"no ranges", 208, 'r', 1, true, "RNGE: missing"},
        {"cells too short", 184, 4 * 59, 4, true, "CELL: wrong"},
        {"fewer bricks", 52, 1, 4, true, ""},
        {"brick number", cell, 1000, 4, true, "no such brick"},
        {"distance 0", cell + 4 * 59, 0x80000000U, 4, true, "distance"},
        {"bit 8 of a distance", cell + 4 * 59 + 1, 1, 1, true, "distance"},
        {"distance too far", cell + 4 * 59, 0x80000005U, 4, true, "differ"},
        // 0 + 255·257 is 255 more than 65280.
        {"range", range + 2, 257, 2, true, "range"},
    };
    for (const change &c : changes)
        test_refused(good, c);
    blob with_range = make_asset({code_format::u8, 8});
    put(with_range, 208, 'E' << 24 | 'G' << 16 | 'N' << 8 | 'R', 4);
    seal(with_range);
    tap_check(refusal(with_range) == "RNGE: not allowed in u8",
              "refused: ranges in u8");
}

void test_truncated()
{
    const blob good = make_asset({code_format::u4r, 8});
    bool refused = true;
    for (size_t n = 0; n < good.size(); n += n < 512 ? 1 : 97) {
        const blob cut(good.begin(), good.begin() + static_cast<long>(n));
        refused = refused && !refusal(cut).empty();
    }
    tap_check(refused, "refused: truncations");
    blob longer = good;
    longer.push_back(1);
    tap_check(refusal(longer).empty(), "bytes after the blob are ignored");
}

/// Checking ///

bool reports(blob b, const std::string &kind)
{
    seal(b);
    for (const std::string &line : check_asset(asset(b)))
        if (line.compare(0, kind.size() + 1, kind + ":") == 0)
            return true;
    return false;
}

void test_is(const change &c)
{
    blob b = make_asset({code_format::u8, 9});
    put(b, c.at, c.value, c.bytes);
    tap_check(reports(b, c.message), "reported: %s", c.what);
}

void test_checks()
{
    const blob good = make_asset({code_format::u8, 9});
    const asset a(good);
    const size_t cell = section_at(good, "CELL");
    const size_t pool = section_at(good, "POOL");
    const size_t first = pool + 732 * a.brick({0, 0, 0});
    const size_t second = pool + 732 * ((a.brick({0, 0, 0}) + 1) % a.bricks);
    const change changes[] = {
        {"a reserved field", 26, 1, 2, true, "reserved"},
        {"a reserved field of an entry", 176 + 12, 1, 4, true, "reserved"},
        {"a byte between sections", 176 + 4 * 16, 1, 1, true, "gap"},
        {"brick padding", first + 729, 1, 1, true, "padding"},
        {"name not UTF-8", section_at(good, "NAME"), 0xff, 1, true, "name"},
        {"name with a zero", section_at(good, "NAME") + 2, 0, 1, true,
         "name"},
        {"shear", 88, 0x3fd0000000000000U, 8, true, "transform"},
        {"mirror", 80, 0xbfe0000000000000U, 8, true, "transform"},
        {"a distance too short", cell + 4 * 55, 0x80000001U, 4, true,
         "distance"},
        {"an apron voxel", first + 728, 99, 1, true, "apron"},
        {"a voxel an apron repeats", second, 99, 1, true, "apron"},
        {"too few voxels", 72, 5, 4, true, "voxels"},
        {"box too small", 40, 3, 2, true, "box"},
        {"a voxel in the outermost layer", first + 9 * 30 + 9 * 3, 9, 1, true,
         "border"},
        {"mean", 68, static_cast<uint32_t>(-33), 4, true, "density_mean"},
    };
    for (const change &c : changes)
        test_is(c);
}

void test_duplicate_brick()
{
    blob b = make_asset({code_format::u8, 9});
    const size_t pool = section_at(b, "POOL");
    std::copy_n(b.begin() + static_cast<long>(pool), 732,
                b.begin() + static_cast<long>(pool + 732));
    tap_check(reports(b, "identical"), "reported: two identical bricks");
    std::fill_n(b.begin() + static_cast<long>(pool), 732, uint8_t{0});
    tap_check(reports(b, "zero brick"), "reported: a brick of zeros");
}

/// Against the voxels ///

void test_against()
{
    const asset a(make_asset({code_format::u8, 9}));
    float_dump dump;
    dump.size = {40, 24, 32};
    dump.origin = {-7, -7, -7};
    dump.world_from_index = a.world_from_index;
    for (size_t i = 0; i < voxel_count(dump.size); i++)
        dump.voxels.push_back(
            static_cast<float>(code_at(ijk_of(i, a.size())) * 5.7 / 255));
    tap_check(check_against(a, dump).empty(), "the voxels it was made of");
    float_dump other = dump;
    other.voxels[40 * 24 * 9 + 40 * 9 + 9] += 0.02F;
    tap_check(!check_against(a, other).empty(), "reported: a voxel that is"
                                                " 0.9 codes off");
    other = dump;
    other.voxels[40 * (24 * 5 + 5) + 20] = 0.001F;
    tap_check(check_against(a, other).size() == 2,
              "reported: a voxel that rounds to 0 counts in the header");
    other = dump;
    other.origin[1] = 0;
    tap_check(!check_against(a, other).empty(), "reported: another origin");
}

} // namespace

int main()
{
    test_crc();
    test_decode("u8, side 8", {code_format::u8, 8});
    test_decode("u8, side 9", {code_format::u8, 9});
    test_decode("u8r, side 8", {code_format::u8r, 8});
    test_decode("u8r, side 9", {code_format::u8r, 9});
    test_decode("u4r, side 8", {code_format::u4r, 8});
    test_decode("u4r, side 9", {code_format::u4r, 9});
    test_range();
    test_must();
    test_truncated();
    test_checks();
    test_duplicate_brick();
    test_against();
    return tap_done();
}
