// SPDX-License-Identifier: MIT

#include "noise.hpp"

namespace reference {

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
static uint32_t interleaved_gradient(uint32_t x, uint32_t y, uint32_t frame,
                                     channel c)
{
    if (c == light_channel) {
        x += 96;
        y += 72;
    }
    const uint32_t u =
        x * 288237660U + y * 25070368U + frame % 64 * 1750839832U;
    const uint64_t fraction = uint64_t{u} * 4221604530U >> 32;
    return (52 * u + static_cast<uint32_t>(fraction)) >> 16;
}

static uint32_t bayer8(uint32_t x, uint32_t y, channel c)
{
    if (c == light_channel) {
        x += 6;
        y += 4;
    }
    uint32_t v = 0;
    for (unsigned i = 0; i < 3; i++) {
        const uint32_t xi = x >> i & 1, yi = y >> i & 1;
        v = v << 2 | (xi ^ yi) << 1 | yi;
    }
    return 1024 * v + 512;
}

uint32_t noise_value(noise kind, uint32_t x, uint32_t y, uint32_t frame,
                     channel c)
{
    switch (kind) {
    case noise::white:
        return white(x, y, frame, c);
    case noise::ign:
        return interleaved_gradient(x, y, frame, c);
    case noise::bayer8:
        return bayer8(x, y, c);
    case noise::none:
        break;
    }
    return 0;
}

} // namespace reference
