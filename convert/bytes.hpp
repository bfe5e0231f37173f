// SPDX-License-Identifier: MIT
//
// Little-endian stores, on any host.
#ifndef BRUME_CONVERT_BYTES_HPP
#define BRUME_CONVERT_BYTES_HPP

#include <cmath>
#include <cstdint>
#include <cstring>

namespace bake
{

inline void put16(uint8_t *p, uint32_t v)
{
    p[0] = uint8_t(v);
    p[1] = uint8_t(v >> 8);
}

inline void put32(uint8_t *p, uint32_t v)
{
    put16(p, v);
    put16(p + 2, v >> 16);
}

inline void put64(uint8_t *p, uint64_t v)
{
    put32(p, uint32_t(v));
    put32(p + 4, uint32_t(v >> 32));
}

inline void put_double(uint8_t *p, double v)
{
    uint64_t bits;

    std::memcpy(&bits, &v, sizeof bits);
    put64(p, bits);
}

// m * 2^e with m in [2^31, 2^32), or 0: exact for every float.
inline void put_number(uint8_t *p, double v)
{
    int e = 0;
    double m = std::floor(std::ldexp(std::frexp(v, &e), 32) + 0.5);

    if (m >= 4294967296.0) {
        m /= 2;
        e++;
    }
    put32(p, uint32_t(m));
    put32(p + 4, uint32_t(v > 0 ? e - 32 : 0));
}

} // namespace bake

#endif
