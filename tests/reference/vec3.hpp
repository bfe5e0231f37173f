// SPDX-License-Identifier: MIT
//
// Three doubles: a point, a direction or a linear colour.
#ifndef BRUME_REFERENCE_VEC3_HPP
#define BRUME_REFERENCE_VEC3_HPP

#include <cmath>

namespace reference {

struct vec3 {
    double x, y, z;
};

inline vec3 operator+(const vec3 &a, const vec3 &b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

inline vec3 operator-(const vec3 &a, const vec3 &b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

inline vec3 operator*(const vec3 &a, double s)
{
    return {a.x * s, a.y * s, a.z * s};
}

inline double dot(const vec3 &a, const vec3 &b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline vec3 cross(const vec3 &a, const vec3 &b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
            a.x * b.y - a.y * b.x};
}

inline double length(const vec3 &a)
{
    return std::sqrt(dot(a, a));
}

inline vec3 normalise(const vec3 &a)
{
    return a * (1.0 / length(a));
}

} // namespace reference

#endif
