// SPDX-License-Identifier: MIT

#include "noise.hpp"

#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace reference
{

// Wellons' lowbias32.
static uint32_t mix(uint32_t h)
{
    h ^= h >> 16;
    h *= 0x7feb352dU;
    h ^= h >> 15;
    h *= 0x846ca68bU;
    h ^= h >> 16;
    return h;
}

static uint32_t white(uint32_t x, uint32_t y, uint32_t frame, channel c)
{
    return mix(x + mix(y + mix(2 * frame + c + 0x9e3779b9U))) >> 16;
}

// frac(52.9829189 * frac(0.06711056 x + 0.00583715 y + ...)), Jimenez 2014;
// u is the inner fraction in units of 2^-32.
static uint32_t interleaved_gradient(uint32_t x, uint32_t y, uint32_t moved,
                                     channel c)
{
    if (c == light_channel) {
        x += 96;
        y += 72;
    }
    const uint32_t u = x * 288237660U + y * 25070368U + moved;
    const uint64_t fraction = uint64_t{u} * 4221604530U >> 32;
    return (52 * u + static_cast<uint32_t>(fraction)) >> 16;
}

static uint32_t rank1(uint32_t x, uint32_t y, uint32_t frame, channel c)
{
    const uint32_t u = x + (c == light_channel ? 96 : 0);
    const uint32_t v = y + (c == light_channel ? 72 : 0);
    return (u * 3436602405U + v * 2850901108U + frame * 1207711862U) / 65536;
}

// Where the light channel looks, in a tile of that side: moved by the first
// point of the R2 sequence.
static uint32_t moved_x(uint32_t x, channel c, uint32_t side)
{
    return c == light_channel ? x + (49472 * side >> 16) : x;
}

static uint32_t moved_y(uint32_t y, channel c, uint32_t side)
{
    return c == light_channel ? y + (37345 * side >> 16) : y;
}

static uint32_t bayer(uint32_t x, uint32_t y, channel c, uint32_t side)
{
    x = moved_x(x, c, side);
    y = moved_y(y, c, side);
    uint32_t v = 0;
    for (uint32_t bit = 1; bit < side; bit *= 2) {
        const uint32_t xi = (x & bit) != 0, yi = (y & bit) != 0;
        v = v << 2 | (xi ^ yi) << 1 | yi;
    }
    return (2 * v + 1) * 32768 / (side * side);
}

static uint32_t table_value(const noise_table &t, uint32_t x, uint32_t y,
                            uint32_t frame)
{
    const size_t row = size_t{frame % t.frames} * t.height + y % t.height;
    return 256 * t.values[row * t.width + x % t.width] + 128;
}

static uint32_t tabled(noise kind, const noise_table &t, uint32_t x, uint32_t y,
                       uint32_t frame, channel c)
{
    x = moved_x(x, c, t.width);
    y = moved_y(y, c, t.height);
    if (kind == noise::table)
        return table_value(t, x, y, frame);
    if (kind == noise::table_golden) {
        const uint32_t further = frame * 2654435769U >> 24;
        return (table_value(t, x, y, 0) + 256 * further) % 65536;
    }
    const uint64_t dx = frame * 3242174889U, dy = frame * 2447445414U;
    return table_value(t, x + static_cast<uint32_t>(dx * t.width >> 32),
                       y + static_cast<uint32_t>(dy * t.height >> 32), 0);
}

noise_table read_noise_table(const std::string &path)
{
    const std::string stem = path.substr(0, path.size() - 4);
    noise_table t;
    const size_t dot = stem.rfind('.');
    if (dot == std::string::npos ||
        std::sscanf(stem.c_str() + dot, ".%ux%ux%u", &t.width, &t.height,
                    &t.frames) != 3)
        throw std::runtime_error(path + ": not NAME.WxHxT.raw");
    std::ifstream file(path, std::ios::binary);
    t.values.assign(std::istreambuf_iterator<char>(file), {});
    if (t.values.size() != size_t{t.width} * t.height * t.frames)
        throw std::runtime_error(path + ": not of that size");
    return t;
}

uint32_t noise_value(noise kind, uint32_t x, uint32_t y, uint32_t frame,
                     channel c, const noise_table &table)
{
    switch (kind) {
    case noise::white: return white(x, y, frame, c);
    case noise::ign:
        return interleaved_gradient(x, y, frame % 64 * 1750839832U, c);
    case noise::ign_thesis:
        return interleaved_gradient(x, y, frame * 722416529U, c);
    case noise::rank1: return rank1(x, y, frame, c);
    case noise::bayer4: return bayer(x, y, c, 4);
    case noise::bayer8: return bayer(x, y, c, 8);
    case noise::bayer16: return bayer(x, y, c, 16);
    case noise::table:
    case noise::table_golden:
    case noise::table_r2: return tabled(kind, table, x, y, frame, c);
    case noise::none: break;
    }
    return 0;
}

} // namespace reference
