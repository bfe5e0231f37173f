/* SPDX-License-Identifier: MIT */
/* Vector noise: its points, its distances, its loss, its bytes. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "brume_noise_tables.h"
#include "space_points.h"
#include "tap.h"

static const double pi = 3.14159265358979323846;

static const char *const names[] = {"scalar", "vec2",       "vec3",
                                    "sphere", "hemisphere", "cosine"};
enum { spaces = 6 };

/* What the core's filters are of no matter here: binomial 3x3 with itself,
 * times some weights over four frames. */
enum { radius = 2, side = 5, frames = 4 };
static int32_t weights[frames * side * side];
static const struct noise_space_kernel kernel = {radius, frames, weights};

static void make_kernel(void)
{
    const int32_t space[side] = {1, 4, 6, 4, 1}, time[frames] = {8, 3, 2, 3};
    for (int i = 0; i < frames * side * side; i++)
        weights[i] = time[i / 25] * space[i / side % side] * space[i % side];
}

static uint64_t state = 1;

/* Uniform in [0, 1), 53 bits: the SplitMix64 generator (Steele et al. 2014). */
static double chance(void)
{
    uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return (double)((z ^ z >> 31) >> 11) / 9007199254740992.0;
}

/// Points ///

/* Every coordinate of n = 2^bits points has each of n, at most 256, evenly
 * spaced bytes equally often. */
static void test_even(enum noise_space space, uint32_t bits)
{
    const uint32_t n = 1u << bits, levels = n < 256 ? n : 256;
    uint32_t count[3][256] = {{0}}, wrong = 0;

    for (uint32_t i = 0; i < n; i++) {
        uint8_t bytes[3] = {0};
        space_point(space, i, bits, bytes);
        for (uint32_t axis = 0; axis < noise_space_channels(space); axis++)
            count[axis][bytes[axis]]++;
    }
    for (uint32_t axis = 0; axis < noise_space_channels(space); axis++)
        for (uint32_t k = 0; k < levels; k++)
            wrong += count[axis][k * (256 / levels) + (256 / levels) / 2] !=
                     n / levels;
    tap_check(wrong == 0, "%s, %u points: exact histograms", names[space], n);
}

/* Any square of 2^a by 2^(bits - a) cells has one point per cell. */
static void test_net(void)
{
    int wrong = 0;
    for (uint32_t a = 0; a <= 8; a++) {
        uint8_t seen[256] = {0};
        for (uint32_t i = 0; i < 256; i++) {
            uint8_t b[3];
            space_point(NOISE_VEC2, i, 8, b);
            seen[((uint32_t)b[0] >> (8 - a)) << (8 - a) |
                 (uint32_t)b[1] >> a]++;
        }
        for (int i = 0; i < 256; i++)
            wrong += seen[i] != 1;
    }
    tap_check(wrong == 0, "vec2: one point in every dyadic box");
}

/* Moments of directions: mean z, and mean x and y 0. 4096 points are much more
 * even than random ones; bytes are good to 1 / 255. */
static void test_directions(enum noise_space space, double mean_z)
{
    double sum[3] = {0}, worst = 0;
    int below = 0;

    for (uint32_t i = 0; i < 4096; i++) {
        double length = 0;
        uint8_t bytes[3];
        int32_t v[3];
        space_point(space, i, 12, bytes);
        noise_octahedral(bytes, v);
        for (int axis = 0; axis < 3; axis++) {
            sum[axis] += v[axis] / 32768.0 / 4096;
            length += v[axis] / 32768.0 * v[axis] / 32768.0;
        }
        worst = fmax(worst, fabs(sqrt(length) - 1));
        below += v[2] < 0;
    }
    tap_check(fabs(sum[0]) < .004 && fabs(sum[1]) < .004 &&
                  fabs(sum[2] - mean_z) < .004,
              "%s: mean direction (%.4f, %.4f, %.4f), (0, 0, %.4f) expected",
              names[space], sum[0], sum[1], sum[2], mean_z);
    tap_check(worst < 1e-4, "%s: lengths are 1 to %.1e", names[space], worst);
    tap_check(space == NOISE_SPHERE || below == 0,
              "%s: nothing below the horizon", names[space]);
}

/* Point i of the sphere, computed in double, is where its bytes say. Half a
 * step of x and of y is 1 / 255, on the octahedron's face sqrt(6) / 255, as z
 * moves by both; from there to the sphere it is at most sqrt(3) times as far.
 */
static void test_octahedral(void)
{
    const double golden = (sqrt(5) - 1) / 2;
    double worst = 0;

    for (uint32_t i = 0; i < 4096; i++) {
        const double z = 1 - (2 * i + 1) / 4096.0, r = sqrt(1 - z * z);
        const double v[3] = {r * cos(2 * pi * golden * i),
                             r * sin(2 * pi * golden * i), z};
        double square = 0;
        uint8_t bytes[3];
        int32_t is[3];
        space_point(NOISE_SPHERE, i, 12, bytes);
        noise_octahedral(bytes, is);
        for (int axis = 0; axis < 3; axis++)
            square += pow(is[axis] / 32768.0 - v[axis], 2);
        worst = fmax(worst, sqrt(square));
    }
    tap_check(worst < sqrt(18) / 255, "sphere: bytes within %.4f of the points",
              worst);
}

/// Distances ///

static void test_distances(void)
{
    static uint16_t table[SPACE_SQUARES];
    double worst = 0;

    space_distances(NOISE_VEC3, table);
    for (int i = 0; i < SPACE_SQUARES; i++)
        worst = fmax(worst, fabs(table[i] / 64.0 - sqrt(i)));
    tap_check(worst <= 1.0 / 64, "Euclidean distances to %.4f", worst);
    space_distances(NOISE_SPHERE, table);
    worst = 0;
    for (int i = 0; i <= 4 * SPACE_RADIUS * SPACE_RADIUS; i++) {
        const double angle = 2 * asin(fmin(sqrt(i) / 2 / SPACE_RADIUS, 1));
        worst = fmax(worst, fabs(table[i] * pi / 32768 - angle));
    }
    tap_check(worst < 1.01 * pi / 32768, "angles to %.6f", worst);
}

/// Loss ///

/* A random half-space: a uniform direction and offset, or a great circle. */
static double random_half_space(enum noise_space space, double normal[3])
{
    const double u = 2 * pi * chance(), z = 2 * chance() - 1;
    const double r = sqrt(1 - z * z);
    double centre = 0;

    normal[0] = space == NOISE_SCALAR ? 1 : cos(u);
    normal[1] = space == NOISE_SCALAR ? 0 : sin(u);
    normal[2] = 0;
    if (space >= NOISE_VEC3) {
        normal[0] *= r;
        normal[1] *= r;
        normal[2] = z;
    }
    if (space >= NOISE_SPHERE)
        return 0;
    for (uint32_t axis = 0; axis < noise_space_channels(space); axis++)
        centre += 127.5 * normal[axis];
    return centre + 221 * (2 * chance() - 1); /* 127.5 sqrt(3) */
}

/* sum_o G(o) E_p[e_p e_{p+o}], e being whether a texel is in the half-space
 * less the part that is; *variance = G(0) E[e^2]. */
static double filtered_error(const struct noise_texture *t,
                             enum noise_space space, double *variance)
{
    static double e[4 * 8 * 8];
    double normal[3], mean = 0, sum = 0;
    const double offset = random_half_space(space, normal);

    for (int p = 0; p < 256; p++) {
        int16_t v[3];
        space_vector(space, t->values + p * (int)t->channels, v);
        e[p] = normal[0] * v[0] + normal[1] * v[1] + normal[2] * v[2] > offset;
        mean += e[p] / 256;
    }
    for (int p = 0; p < 256; p++)
        e[p] -= mean;
    for (int i = 0; i < frames * side * side; i++)
        for (int p = 0; p < 256; p++) {
            const int x = (p + i % side + 8 - radius) % 8;
            const int y = (p / 8 + i / side % side + 8 - radius) % 8;
            sum +=
                weights[i] * e[p] * e[(p / 64 + i / 25) % 4 * 64 + y * 8 + x];
        }
    *variance = weights[12] * mean * (1 - mean) * 256;
    return sum;
}

/* The loss is a ratio of means, sum / variance: its standard error is that of
 * the mean of sum - loss * variance, over the mean variance. */
static void test_loss(const struct noise_texture *t, enum noise_space space,
                      double loss)
{
    const int n = 3000;
    double sum = 0, variance = 0, squares = 0, off = 0;

    for (int i = 0; i < n; i++) {
        double v;
        const double s = filtered_error(t, space, &v), d = s - loss * v;
        sum += s / n;
        variance += v / n;
        off += d / n;
        squares += d * d / n;
    }
    squares = sqrt((squares - off * off) / n) / variance;
    tap_check(fabs(sum / variance - loss) < 5 * squares,
              "%s: loss %.4f, of random half-spaces %.4f +- %.4f", names[space],
              loss, sum / variance, squares);
}

/// Textures ///

/* FNV-1a. The bytes are the same on every machine; a change of the method
 * changes these. */
static uint32_t hash(const uint8_t *bytes, size_t n)
{
    uint32_t h = 2166136261u;
    for (size_t i = 0; i < n; i++)
        h = (h ^ bytes[i]) * 16777619u;
    return h;
}

static int order(const void *a, const void *b)
{
    return memcmp(a, b, 3);
}

/* Whether a frame is a permutation of the points. */
static bool all_points(const struct noise_texture *t, enum noise_space space,
                       uint32_t frame)
{
    uint8_t is[64][3] = {{0}}, should[64][3] = {{0}};

    for (uint32_t i = 0; i < 64; i++) {
        memcpy(is[i], t->values + (frame * 64 + i) * t->channels, t->channels);
        space_point(space, i, 6, should[i]);
    }
    qsort(is, 64, 3, order);
    qsort(should, 64, 3, order);
    return !memcmp(is, should, sizeof is);
}

static void test_texture(enum noise_space space, uint32_t expected)
{
    struct noise_texture t;
    double random, loss;
    int wrong = 0;

    if (!noise_texture_make(&t, 8, 8, frames, noise_space_channels(space)))
        exit(1);
    for (uint32_t i = 0; i < 64 * frames; i++) {
        uint8_t bytes[3];
        space_point(space, (i * 29 ^ i / 64 * 23) % 64, 6, bytes);
        memcpy(t.values + i * t.channels, bytes, t.channels);
    }
    noise_space_loss(&t, space, &kernel, &random);
    test_loss(&t, space, random);
    noise_space_fill(&t, space, &kernel, 1, 0, NULL, NULL);
    noise_space_loss(&t, space, &kernel, &loss);
    test_loss(&t, space, loss);
    tap_check(loss < 0.5, "%s: loss %.4f of random noise's", names[space],
              loss);
    for (uint32_t frame = 0; frame < frames; frame++)
        wrong += !all_points(&t, space, frame);
    tap_check(wrong == 0, "%s: every frame has all the points", names[space]);
    tap_check(hash(t.values, noise_texture_bytes(&t)) == expected,
              "%s: hash %08x", names[space],
              hash(t.values, noise_texture_bytes(&t)));
    noise_texture_free(&t);
}

/* The committed directions: of length 1 and above the horizon to what a byte
 * can say, each frame's mean half way up, as that of a hemisphere is. */
static void test_hemisphere(void)
{
    const struct brume_direction_table *t = &brume_noise_hemisphere;
    const uint32_t count = 1u << (t->width_log2 + t->height_log2);
    double longest = 0, shortest = 9, off = 0;
    int below = 0;

    for (uint32_t frame = 0; frame < 1u << t->frames_log2; frame++) {
        const int8_t *v = t->values + (size_t)3 * count * frame;
        double sum[3] = {0, 0, -0.5};
        for (uint32_t i = 0; i < count; i++, v += 3) {
            double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) / 128;
            longest = fmax(longest, length);
            shortest = fmin(shortest, length);
            below += v[2] < 0;
            for (int axis = 0; axis < 3; axis++)
                sum[axis] += v[axis] / 128.0 / count;
        }
        for (int axis = 0; axis < 3; axis++)
            off = fmax(off, fabs(sum[axis]));
    }
    tap_check(below == 0 && longest < 1.01 && shortest > 0.985,
              "the committed hemisphere: lengths %.4f to %.4f, %d below",
              shortest, longest, below);
    tap_check(off < 0.005, "its frames' means are (0, 0, 1/2) to %.4f", off);
}

int main(void)
{
    static const uint32_t expected[spaces] = {
        0x7636ecdd, 0x3953b915, 0x3b802d35, 0x74b10e65, 0x501029d5, 0x99b97409};

    make_kernel();
    for (uint32_t bits = 6; bits <= 14; bits += 4) {
        test_even(NOISE_SCALAR, bits);
        test_even(NOISE_VEC2, bits);
        test_even(NOISE_VEC3, bits);
    }
    test_net();
    test_directions(NOISE_SPHERE, 0);
    test_directions(NOISE_HEMISPHERE, 0.5);
    test_directions(NOISE_COSINE, 2.0 / 3);
    test_octahedral();
    test_distances();
    for (int space = 0; space < spaces; space++)
        test_texture((enum noise_space)space, expected[space]);
    test_hemisphere();
    return tap_done();
}
