// SPDX-License-Identifier: MIT
#include "asset_writer.hpp"

#include <algorithm>
#include <cstring>
#include <tbb/parallel_invoke.h>
#include <zlib.h>

#include "brume.h"
#include "bytes.hpp"

namespace bake
{

namespace
{

constexpr size_t name_limit = 255;
constexpr size_t ident_bytes = 16; // magic .. crc, not under the CRC
constexpr size_t buffer_words = 16384;

uint32_t float_bits(float v)
{
    uint32_t bits;

    std::memcpy(&bits, &v, sizeof bits);
    return bits;
}

// The file, with the CRC of what went into it.
class sink
{
  public:
    explicit sink(output &out) : out_(out)
    {
    }

    void put(const void *data, size_t bytes)
    {
        tbb::parallel_invoke([&] { out_.write(data, bytes); },
                             [&] { add_crc(data, bytes); });
        at_ += bytes;
    }

    // word(i) for i in [0, count), little-endian.
    template <class maker> void put_words(size_t count, maker word)
    {
        std::vector<uint8_t> buffer(4 * std::min(count, buffer_words));

        for (size_t i = 0; i < count;) {
            const size_t n = std::min(count - i, buffer_words);
            for (size_t k = 0; k < n; k++)
                put32(&buffer[4 * k], word(i + k));
            put(buffer.data(), 4 * n);
            i += n;
        }
    }

    void pad_to(uint64_t offset)
    {
        static const uint8_t zeros[BRUME_SECTION_ALIGN] = {};

        put(zeros, size_t(offset - at_));
    }

    uint32_t crc() const
    {
        return uint32_t(crc_);
    }
    void start_at(uint64_t offset)
    {
        at_ = offset;
    }

  private:
    void add_crc(const void *data, size_t bytes)
    {
        const auto *p = static_cast<const Bytef *>(data);

        // zlib counts in 32 bits.
        for (size_t done = 0; done < bytes;) {
            const size_t n = std::min(bytes - done, size_t(1) << 30);
            crc_ = crc32(crc_, p + done, uInt(n));
            done += n;
        }
    }

    output &out_;
    uLong crc_ = crc32(0, nullptr, 0);
    uint64_t at_ = 0;
};

struct section {
    uint32_t id;
    uint64_t offset, bytes;
};

uint64_t align(uint64_t offset)
{
    const uint64_t a = BRUME_SECTION_ALIGN;

    return (offset + a - 1) / a * a;
}

std::vector<section> place(const asset_size &size)
{
    std::vector<section> list = {{BRUME_SECTION_CELL, 0, size.cell},
                                 {BRUME_SECTION_POOL, 0, size.pool}};

    if (size.has_ranges)
        list.push_back({BRUME_SECTION_RNGE, 0, size.range});
    if (size.name > 0)
        list.push_back({BRUME_SECTION_NAME, 0, size.name});
    if (size.light.mips > 0)
        list.push_back({BRUME_SECTION_MIPS, 0, size.light.mips});
    if (size.light.sun > 0)
        list.push_back({BRUME_SECTION_SUNC, 0, size.light.sun});
    if (size.light.sky > 0)
        list.push_back({BRUME_SECTION_AMBI, 0, size.light.sky});
    if (size.emission > 0)
        list.push_back({BRUME_SECTION_EMIT, 0, size.emission});
    uint64_t end = BRUME_HEADER_BYTES + list.size() * BRUME_SECTION_BYTES;
    for (section &s : list) {
        s.offset = align(end);
        end = s.offset + s.bytes;
    }
    return list;
}

// Files without sections that came later say so, and stay as they were.
uint32_t minor_version(const asset_contents &c)
{
    if (c.p.glows)
        return 2;
    return c.light.sizes().total() > 0 ? 1 : 0;
}

std::vector<uint8_t> make_header(const asset_contents &c,
                                 const std::vector<section> &list)
{
    const layout &l = c.l;
    const measures &m = c.m;
    const brick_pool &p = c.p;
    std::vector<uint8_t> h(BRUME_HEADER_BYTES +
                           list.size() * BRUME_SECTION_BYTES);
    const int32_t cells[3] = {l.cells.x, l.cells.y, l.cells.z};
    const int32_t origin[3] = {l.origin.x, l.origin.y, l.origin.z};
    const box both = box_of_both(m, c.glow);
    const int32_t lo[3] = {both.lo.x, both.lo.y, both.lo.z};
    const int32_t hi[3] = {both.hi.x, both.hi.y, both.hi.z};

    put32(&h[BRUME_OFF_MAGIC], BRUME_MAGIC);
    put16(&h[BRUME_OFF_MAJOR], BRUME_ASSET_MAJOR);
    put16(&h[BRUME_OFF_MINOR], minor_version(c));
    put32(&h[BRUME_OFF_SIZE], uint32_t(list.back().offset + list.back().bytes));
    h[BRUME_OFF_FORMAT] = uint8_t(p.format.format);
    h[BRUME_OFF_SIDE] = uint8_t(p.format.side);
    put16(&h[BRUME_OFF_SECTIONS], uint32_t(list.size()));
    for (int a = 0; a < 3; a++) {
        put16(&h[BRUME_OFF_CELLS + 2 * a], uint32_t(cells[a]));
        put32(&h[BRUME_OFF_ORIGIN + 4 * a], uint32_t(origin[a]));
        put16(&h[BRUME_OFF_BOX_MIN + 2 * a], uint32_t(lo[a] - origin[a]));
        put16(&h[BRUME_OFF_BOX_MAX + 2 * a], uint32_t(hi[a] - origin[a]));
    }
    put32(&h[BRUME_OFF_BRICKS], uint32_t(p.bricks));
    put_number(&h[BRUME_OFF_DENSITY_MAX], double(p.format.density_max));
    put_number(&h[BRUME_OFF_DENSITY_MEAN], m.mean);
    put32(&h[BRUME_OFF_VOXELS],
          uint32_t(std::min<uint64_t>(m.voxels, UINT32_MAX)));
    for (int i = 0; i < 12; i++)
        put_double(&h[BRUME_OFF_WORLD + 8 * i], c.vol.world[i]);
    for (size_t i = 0; i < list.size(); i++) {
        uint8_t *e = &h[BRUME_HEADER_BYTES + i * BRUME_SECTION_BYTES];
        put32(e, list[i].id);
        put32(e + 4, uint32_t(list[i].offset));
        put32(e + 8, uint32_t(list[i].bytes));
    }
    return h;
}

void put_ranges(sink &s, const std::vector<range> &ranges)
{
    s.put_words(ranges.size(), [&](size_t i) {
        return uint32_t(ranges[i].base) | uint32_t(ranges[i].scale) << 16;
    });
}

void put_bytes(sink &s, const std::vector<uint8_t> &bytes)
{
    s.put(bytes.data(), bytes.size());
}

void put_emission(sink &s, const asset_contents &c)
{
    uint8_t head[emission_head] = {};

    put_number(head, double(c.glow.max));
    s.put(head, sizeof head);
    put_bytes(s, c.p.codes);
}

// At most 255 bytes, cut between two UTF-8 characters.
std::string short_name(const std::string &name)
{
    size_t n = std::min(name.size(), name_limit);

    while (n < name.size() && n > 0 && (uint8_t(name[n]) & 0xc0) == 0x80)
        n--;
    return name.substr(0, n);
}

} // namespace

asset_size size_of_asset(const brick_pool &p, const std::string &name,
                         const light_sizes &light)
{
    asset_size size = {};

    size.cell = 4 * p.cells.size();
    size.pool = p.bytes.size();
    size.range = 4 * p.ranges.size();
    size.name = short_name(name).size();
    size.emission = p.glows ? emission_head + p.codes.size() : 0;
    size.light = light;
    size.has_ranges = p.format.has_ranges();
    const section last = place(size).back();

    size.total = last.offset + last.bytes;
    return size;
}

asset_size write_asset(output &out, const asset_contents &c)
{
    const brick_pool &p = c.p;
    const std::string label = short_name(c.name);
    const asset_size size = size_of_asset(p, c.name, c.light.sizes());
    const std::vector<section> list = place(size);
    std::vector<uint8_t> header = make_header(c, list);
    sink s(out);

    out.write(header.data(), ident_bytes);
    s.start_at(ident_bytes);
    s.put(&header[ident_bytes], header.size() - ident_bytes);
    for (const section &part : list) {
        s.pad_to(part.offset);
        if (part.id == BRUME_SECTION_CELL)
            s.put_words(p.cells.size(), [&](size_t i) { return p.cells[i]; });
        else if (part.id == BRUME_SECTION_POOL)
            put_bytes(s, p.bytes);
        else if (part.id == BRUME_SECTION_RNGE)
            put_ranges(s, p.ranges);
        else if (part.id == BRUME_SECTION_NAME)
            s.put(label.data(), label.size());
        else if (part.id == BRUME_SECTION_MIPS)
            put_bytes(s, c.light.mips);
        else if (part.id == BRUME_SECTION_SUNC)
            put_bytes(s, c.light.sun);
        else if (part.id == BRUME_SECTION_AMBI)
            put_bytes(s, c.light.sky);
        else
            put_emission(s, c);
    }
    put32(&header[BRUME_OFF_CRC], s.crc());
    out.write_at(0, header.data(), ident_bytes);
    return size;
}

void write_float_dump(output &out, const volume &vol, const layout &l)
{
    const block_map map(vol);
    const size_t nx = size_t(l.cells.x) * block_side;
    std::string head = text("brume-float 1\nsize %zu %d %d\n"
                            "origin %d %d %d\nworld_from_index",
                            nx, l.cells.y * block_side, l.cells.z * block_side,
                            l.origin.x, l.origin.y, l.origin.z);
    sink s(out);

    for (double v : vol.world)
        head += text(" %.17g", v);
    head += "\ndata float32le\n";
    s.put(head.data(), head.size());
    // A row of voxels at a time.
    for (int z = l.origin.z; z < l.origin.z + l.cells.z * block_side; z++)
        for (int y = l.origin.y; y < l.origin.y + l.cells.y * block_side; y++)
            s.put_words(nx, [&](size_t i) {
                const int x = l.origin.x + int(i);
                const uint32_t b = map.at({floor8(x), floor8(y), floor8(z)});
                if (b == block_map::none)
                    return uint32_t(0);
                const block &k = vol.blocks[b];
                return float_bits(
                    k.voxels ? k.voxels[(x & 7) + 8 * (y & 7) + 64 * (z & 7)]
                             : k.value);
            });
}

} // namespace bake
