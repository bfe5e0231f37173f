// SPDX-License-Identifier: MIT
//
// Lattice noise for modelling clouds. Every value comes from an integer hash
// of the lattice cell and from +, -, *, / and sqrt on floats, so that it is
// the same on each thread and each IEEE 754 machine: build without
// -ffast-math and with -ffp-contract=off.
#ifndef BRUME_CONVERT_NOISE3D_HPP
#define BRUME_CONVERT_NOISE3D_HPP

#include <cstdint>

namespace cloud
{

struct vec3 {
    float x, y, z;
};

inline vec3 operator+(vec3 a, vec3 b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

inline vec3 operator-(vec3 a, vec3 b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

inline vec3 operator*(vec3 a, float s)
{
    return {a.x * s, a.y * s, a.z * s};
}

inline float dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline float clamp01(float x)
{
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

inline float mix(float a, float b, float t)
{
    return a + (b - a) * t;
}

// 0 at a, 1 at b, with zero slope at both; a > b gives a falling step.
inline float smoothstep(float a, float b, float x)
{
    const float t = clamp01((x - a) / (b - a));
    return t * t * (3 - 2 * t);
}

// One 32-bit hash per lattice point and seed.
uint32_t hash3(int32_t x, int32_t y, int32_t z, uint32_t seed);

// A stream of hashes for things placed one by one. Copies are independent.
class hash_stream
{
  public:
    explicit hash_stream(uint32_t seed) : seed_(seed)
    {
    }
    uint32_t next()
    {
        return hash3(int32_t(count_++), 0, 0, seed_);
    }
    float unit()
    {
        return float(next() >> 8) * (1.0f / 16777216.0f);
    }
    float range(float a, float b)
    {
        return mix(a, b, unit());
    }
    vec3 direction(); // uniform on the unit sphere

  private:
    uint32_t seed_;
    uint32_t count_ = 0;
};

// Gradient noise in (-1.04, 1.04), usually in (-0.7, 0.7), lattice pitch 1
// (Perlin 2002, "Improving Noise").
float perlin(vec3 p, uint32_t seed);

// Octaves of perlin() at twice the frequency and half the weight each,
// weights adding up to 1.
float perlin_fbm(vec3 p, int octaves, uint32_t seed);

// Three independent perlin() values: an offset for domain warping.
vec3 perlin_vector(vec3 p, uint32_t seed);

// Squared distance to the nearest of one random point per unit cell, clamped
// to 1 (Worley 1996, "A Cellular Texture Basis Function"). Unlike the
// distance it is smooth at the points, and keeps the creases between cells:
// 1 - worley() is a heap of round bumps.
float worley(vec3 p, uint32_t seed);

// Perlin noise dilated by Worley cells, 0..1: connected like the one, billowy
// like the other (Schneider 2015, "The Real-time Volumetric Cloudscapes of
// Horizon Zero Dawn").
float perlin_worley(vec3 p, int octaves, uint32_t seed);

} // namespace cloud

#endif
