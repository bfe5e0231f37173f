// SPDX-License-Identifier: MIT
#include "noise3d.hpp"

#include <cmath>

namespace cloud
{

namespace
{

// floor() without a library call: exact for |x| < 2^31.
inline int32_t floor_int(float x)
{
    const int32_t i = int32_t(x);
    return i - (x < float(i));
}

// Wraps instead of overflowing at the ends of the lattice.
inline int32_t offset(int32_t a, int32_t b)
{
    return int32_t(uint32_t(a) + uint32_t(b));
}

inline float fade(float t)
{
    return t * t * t * (t * (t * 6 - 15) + 10);
}

// Dot product with one of the 12 edge directions of a cube, 4 of them twice.
inline float gradient(uint32_t hash, float x, float y, float z)
{
    const uint32_t h = hash >> 28;
    const float u = h < 8 ? x : y;
    const float v = h < 4 ? y : h == 12 || h == 14 ? x : z;
    return (h & 1 ? -u : u) + (h & 2 ? -v : v);
}

// Squared distance along one axis from f in [0, 1) to the cell at offset d.
inline float gap_squared(float f, int d)
{
    const float g = d < 0 ? f : d > 0 ? 1 - f : 0;
    return g * g;
}

} // namespace

// The finaliser is Mueller's, the multipliers of x, y and z are large odd
// constants, so that neighbouring cells differ in all bits.
uint32_t hash3(int32_t x, int32_t y, int32_t z, uint32_t seed)
{
    uint32_t h = seed * 0x9e3779b9u ^ uint32_t(x) * 0x8da6b343u;
    h ^= uint32_t(y) * 0xd8163841u;
    h ^= uint32_t(z) * 0xcb1ab31fu;
    h = (h ^ h >> 16) * 0x45d9f3bu;
    h = (h ^ h >> 16) * 0x45d9f3bu;
    return h ^ h >> 16;
}

// By rejection from the cube: no trigonometry, whose last bit differs between
// libraries. 64 tries fail with a chance below 2^-68.
vec3 hash_stream::direction()
{
    for (int i = 0; i < 64; i++) {
        const float x = range(-1, 1), y = range(-1, 1), z = range(-1, 1);
        const float d = x * x + y * y + z * z;
        if (d <= 1 && d > 1e-4f)
            return vec3{x, y, z} * (1 / std::sqrt(d));
    }
    return {0, 1, 0};
}

float perlin(vec3 p, uint32_t seed)
{
    const int32_t x = floor_int(p.x), y = floor_int(p.y), z = floor_int(p.z);
    const float fx = p.x - float(x), fy = p.y - float(y), fz = p.z - float(z);
    const float u = fade(fx), v = fade(fy), w = fade(fz);
    float plane[2];
    for (int k = 0; k < 2; k++) {
        const int32_t zk = offset(z, k);
        const float gz = fz - float(k);
        const int32_t x1 = offset(x, 1), y1 = offset(y, 1);
        const float a =
            mix(gradient(hash3(x, y, zk, seed), fx, fy, gz),
                gradient(hash3(x1, y, zk, seed), fx - 1, fy, gz), u);
        const float b =
            mix(gradient(hash3(x, y1, zk, seed), fx, fy - 1, gz),
                gradient(hash3(x1, y1, zk, seed), fx - 1, fy - 1, gz), u);
        plane[k] = mix(a, b, v);
    }
    return mix(plane[0], plane[1], w);
}

float perlin_fbm(vec3 p, int octaves, uint32_t seed)
{
    float sum = 0, weight = 1, total = 0;
    for (int i = 0; i < octaves; i++) {
        sum += weight * perlin(p, seed + uint32_t(i));
        total += weight;
        weight *= 0.5f;
        p = p * 2;
    }
    return sum / total;
}

vec3 perlin_vector(vec3 p, uint32_t seed)
{
    return {perlin(p, seed), perlin(p, seed + 101), perlin(p, seed + 202)};
}

float worley(vec3 p, uint32_t seed)
{
    const int32_t x = floor_int(p.x), y = floor_int(p.y), z = floor_int(p.z);
    const float fx = p.x - float(x), fy = p.y - float(y), fz = p.z - float(z);
    // The own cell comes first: most others then lie beyond the best so far.
    static const int order[3] = {0, -1, 1};
    float best = 1;
    for (int dz : order) {
        const float gz = gap_squared(fz, dz);
        for (int dy : order) {
            const float gyz = gz + gap_squared(fy, dy);
            for (int dx : order) {
                if (gyz + gap_squared(fx, dx) >= best)
                    continue;
                const uint32_t h =
                    hash3(offset(x, dx), offset(y, dy), offset(z, dz), seed);
                const float q = 1.0f / 1024.0f;
                const float rx = float(dx) + float(h & 1023) * q - fx;
                const float ry = float(dy) + float(h >> 10 & 1023) * q - fy;
                const float rz = float(dz) + float(h >> 20 & 1023) * q - fz;
                const float d = rx * rx + ry * ry + rz * rz;
                if (d < best)
                    best = d;
            }
        }
    }
    return best;
}

float perlin_worley(vec3 p, int octaves, uint32_t seed)
{
    const float base = clamp01(0.5f + perlin_fbm(p, octaves, seed));
    float billow = 0, weight = 0.625f;
    for (int i = 0; i < 3; i++) {
        const vec3 q = p * float(1 << i);
        billow += weight * (1 - worley(q, seed + 17 + uint32_t(i)));
        weight *= i ? 0.5f : 0.4f;
    }
    // Schneider's remap of [0, 1] to [billow, 1].
    return mix(billow, 1, base * base);
}

} // namespace cloud
