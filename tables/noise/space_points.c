/* SPDX-License-Identifier: MIT */
/* Evenly spread points, half-spaces and distances, without floating point. */
#include "space_points.h"

#include <stdlib.h>

#define ONE (1 << 30)      /* Q2.30 */
#define GOLDEN 2654435769u /* 1 / golden ratio, Q0.32 */

bool space_is_sphere(enum noise_space space)
{
    return space >= NOISE_SPHERE;
}

uint32_t noise_space_channels(enum noise_space space)
{
    return space == NOISE_SCALAR ? 1 : space == NOISE_VEC3 ? 3 : 2;
}

/// Arithmetic ///

/* floor(sqrt(v)), bit by bit. */
static uint32_t root(uint64_t v)
{
    uint32_t r = 0;
    for (uint32_t bit = 1u << 31; bit; bit >>= 1) {
        const uint64_t more = r | bit;
        if (more * more <= v)
            r |= bit;
    }
    return r;
}

/* sin(x pi / 2), x in [0, 2^30], Q2.30: the Taylor series in x, whose terms
 * come as a_k x^2 / ((2k) (2k + 1)); its error is below 2^-27. */
static int32_t quarter_sine(int64_t x)
{
    const int64_t half_pi = 1686629713; /* pi / 2, Q2.30 */
    const int64_t angle = half_pi * x / ONE;
    int64_t term = angle, sum = angle;

    for (int64_t k = 1; k < 8; k++) {
        term = term * angle / ONE * angle / ONE / (-2 * k * (2 * k + 1));
        sum += term;
    }
    return sum > ONE ? ONE : (int32_t)sum;
}

/* sin(2 pi turn), turn in Q0.32; Q2.30. */
static int32_t sine(uint32_t turn)
{
    const int64_t x = turn & (ONE - 1);
    switch (turn >> 30) {
    case 0: return quarter_sine(x);
    case 1: return quarter_sine(ONE - x);
    case 2: return -quarter_sine(x);
    default: return -quarter_sine(ONE - x);
    }
}

static int32_t cosine(uint32_t turn)
{
    return sine(turn + ONE);
}

/* The unit vector with this z (Q2.30) and azimuth. */
static void direction(int64_t z, uint32_t turn, int64_t v[3])
{
    const int64_t r = root((uint64_t)((int64_t)ONE * ONE - z * z));
    v[0] = r * cosine(turn) / ONE;
    v[1] = r * sine(turn) / ONE;
    v[2] = z;
}

/* n / d rounded to nearest, d > 0. */
static int64_t nearest(int64_t n, int64_t d)
{
    return (n + (n < 0 ? -d : d) / 2) / d;
}

/// Nets ///

static uint32_t reversed(uint32_t v)
{
    uint32_t r = 0;
    for (int i = 0; i < 32; i++)
        r |= (v >> i & 1u) << (31 - i);
    return r;
}

/* Second component of Sobol's sequence, the first being the reversed bits:
 * direction numbers v, v ^ v >> 1, ... */
static uint32_t sobol(uint32_t i)
{
    uint32_t v = 1u << 31, sum = 0;
    for (; i; i >>= 1, v ^= v >> 1)
        sum ^= i & 1u ? v : 0;
    return sum;
}

/* Point i of a (0, bits, 3)-net in base 2, Q0.32: each coordinate has each of
 * the multiples of 2^-bits once, and any box of that volume with dyadic sides
 * has one point. */
static uint32_t net(uint32_t i, uint32_t bits, uint32_t axis)
{
    if (axis == 0)
        return bits ? i << (32 - bits) : 0;
    return axis == 1 ? reversed(i) : sobol(i);
}

/// Points ///

/* Fold a direction into the octahedron's square; |x| + |y| <= 1 is z >= 0.
 * Coordinates are in 1/256 of what decode calls 1 / 255. */
static void encode(const int64_t v[3], bool upper, uint8_t bytes[2])
{
    const int64_t one = 255 * 256;
    const int64_t sum = llabs(v[0]) + llabs(v[1]) + llabs(v[2]);
    int64_t x = nearest(v[0] * one, sum), y = nearest(v[1] * one, sum);

    if (v[2] < 0) {
        const int64_t folded = (one - llabs(y)) * (v[0] < 0 ? -1 : 1);
        y = (one - llabs(x)) * (v[1] < 0 ? -1 : 1);
        x = folded;
    }
    bytes[0] = (uint8_t)((x + 65536) / 512);
    bytes[1] = (uint8_t)((y + 65536) / 512);
    /* Rounding must not put a direction below the horizon. */
    x = 2 * bytes[0] - 255;
    y = 2 * bytes[1] - 255;
    if (upper && llabs(x) + llabs(y) > 255) {
        const int axis = llabs(x) < llabs(y);
        bytes[axis] = (uint8_t)(bytes[axis] + (bytes[axis] < 128 ? 1 : -1));
    }
}

/* Fibonacci's lattice: equal steps of z (of z^2 for the density z / pi), the
 * azimuth a golden section further each time. */
static void sphere_point(enum noise_space space, uint32_t i, uint32_t bits,
                         uint8_t bytes[2])
{
    /* The middle of step i, Q2.30. */
    const int64_t part = (((int64_t)2 * i + 1) << 29) >> bits;
    int64_t z = ONE - part, v[3];

    if (space == NOISE_SPHERE)
        z = ONE - 2 * part;
    if (space == NOISE_COSINE)
        z = root((uint64_t)z << 30);
    direction(z, i * GOLDEN, v);
    encode(v, space != NOISE_SPHERE, bytes);
}

void space_point(enum noise_space space, uint32_t i, uint32_t bits,
                 uint8_t bytes[3])
{
    const uint32_t middle = bits < 8 ? 1u << (31 - bits) : 0;

    if (space_is_sphere(space)) {
        sphere_point(space, i, bits, bytes);
        return;
    }
    for (uint32_t axis = 0; axis < noise_space_channels(space); axis++)
        bytes[axis] = (uint8_t)((net(i, bits, axis) + middle) >> 24);
}

/* Scaled so that the length is near `length`. */
static void decode(const uint8_t bytes[2], int64_t length, int32_t v[3])
{
    int64_t x = 2 * bytes[0] - 255, y = 2 * bytes[1] - 255, norm;
    const int64_t z = 255 - llabs(x) - llabs(y);

    if (z < 0) {
        const int64_t unfolded = (255 - llabs(y)) * (x < 0 ? -1 : 1);
        y = (255 - llabs(x)) * (y < 0 ? -1 : 1);
        x = unfolded;
    }
    /* Q16: below 2^8 * sqrt(3) * 2^16. */
    norm = root((uint64_t)(x * x + y * y + z * z) << 32);
    v[0] = (int32_t)nearest(x * length * 65536, norm);
    v[1] = (int32_t)nearest(y * length * 65536, norm);
    v[2] = (int32_t)nearest(z * length * 65536, norm);
}

void noise_octahedral(const uint8_t bytes[2], int32_t vector[3])
{
    decode(bytes, 32768, vector);
}

void space_vector(enum noise_space space, const uint8_t *bytes,
                  int16_t vector[3])
{
    int32_t v[3] = {0};

    if (space_is_sphere(space))
        decode(bytes, SPACE_RADIUS, v);
    else
        for (uint32_t axis = 0; axis < noise_space_channels(space); axis++)
            v[axis] = bytes[axis];
    for (int axis = 0; axis < 3; axis++)
        vector[axis] = (int16_t)v[axis];
}

/// Distances ///

/* Chord and angle: chord^2 = 2 r^2 (1 - cos angle). */
static void sphere_distances(uint16_t *distance)
{
    const int64_t twice = 2 * SPACE_RADIUS * SPACE_RADIUS;
    uint32_t angle = 0;

    for (int64_t square = 0; square < SPACE_SQUARES; square++) {
        while (angle < 32768 &&
               twice * (ONE - cosine(angle << 16)) < square * ONE)
            angle++;
        distance[square] = (uint16_t)angle;
    }
}

void space_distances(enum noise_space space, uint16_t distance[SPACE_SQUARES])
{
    if (space_is_sphere(space)) {
        sphere_distances(distance);
        return;
    }
    for (uint32_t square = 0; square < SPACE_SQUARES; square++)
        distance[square] = (uint16_t)root((uint64_t)square * 64 * 64);
}

/// Half-spaces ///

/* Uniform directions, and for bodies uniform offsets from their centre, 127.5
 * per axis: up to the corners, 127.5 sqrt(dimensions) away. Some miss the
 * body, which belongs to the measure. */
void space_half_space(enum noise_space space, uint32_t i, uint32_t bits,
                      const uint32_t shift[3], struct half_space *h)
{
    const int32_t reach[] = {255, 361, 442}; /* twice, rounded up */
    const uint32_t axes = noise_space_channels(space);
    const int64_t u[3] = {net(i, bits, 0) ^ shift[0],
                          net(i, bits, 1) ^ shift[1],
                          net(i, bits, 2) ^ shift[2]};
    int64_t n[3] = {ONE, 0, 0};

    if (space == NOISE_VEC2) {
        n[0] = cosine((uint32_t)u[1] / 2);
        n[1] = sine((uint32_t)u[1] / 2);
    } else if (space != NOISE_SCALAR) {
        direction(u[1] / 4, (uint32_t)u[2], n);
    }
    h->offset = 0;
    for (int axis = 0; axis < 3; axis++)
        h->normal[axis] = (int32_t)nearest(n[axis], 1 << 16);
    if (space_is_sphere(space))
        return;
    for (uint32_t axis = 0; axis < axes; axis++)
        h->offset += h->normal[axis] * 255 / 2;
    /* Q0.32 - 1/2 times twice the reach / 2, in Q14. */
    h->offset += (int32_t)((u[0] - (1LL << 31)) * reach[axes - 1] / (1 << 18));
}
