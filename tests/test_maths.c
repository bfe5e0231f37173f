/* SPDX-License-Identifier: MIT */
/*
 * Every function of brume_fixed.h and brume_fixed.c, and the tables, swept
 * over their domains: against exact 64-bit integers where the result is
 * defined to the bit, against the host's libm in double where the comment in
 * brume_inner.h states an error. double is some 2^20 times finer than any of
 * these errors, so that its own does not count.
 *
 * Each sweep also pins a hash of all outputs: a change of a single bit shows,
 * even one that stays within the error.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "brume_inner.h"
#include "support/mul32.h"
#include "tap.h"

/// Sweeps ///

/* The largest error of a sweep, where it was, and a hash of what came out. */
struct sweep {
    double worst;
    double at;
    uint32_t hash;
    uint32_t wrong; /* for results that have to be exact */
};

static void take(struct sweep *s, uint32_t bits)
{
    s->hash = (s->hash ^ bits) * 0x01000193u;
    s->hash ^= s->hash >> 15;
}

static void note_error(struct sweep *s, double error, double at)
{
    if (!(error <= s->worst)) { /* also for a NaN */
        s->worst = error;
        s->at = at;
    }
}

static void note_equal(struct sweep *s, uint32_t got, uint32_t expected)
{
    take(s, got);
    s->wrong += got != expected;
}

static void check_hash(const char *name, const struct sweep *s, uint32_t hash)
{
    tap_check(s->hash == hash, "%s: hash %08x, pinned %08x", name,
              (unsigned)s->hash, (unsigned)hash);
}

static void check_exact(const char *name, const struct sweep *s, uint32_t hash)
{
    tap_check(s->wrong == 0, "%s: exact (%u wrong)", name, (unsigned)s->wrong);
    check_hash(name, s, hash);
}

/* `bound` as a power of two reads like the comments in brume_inner.h. */
static void check_bound(const char *name, const struct sweep *s, double bound)
{
    tap_check(s->worst < bound, "%s: error %.4g = 2^%.2f < 2^%.2f (at %.10g)",
              name, s->worst, log2(s->worst), log2(bound), s->at);
}

static void check_error(const char *name, const struct sweep *s, double bound,
                        uint32_t hash)
{
    check_bound(name, s, bound);
    check_hash(name, s, hash);
}

/// Arguments ///

static uint32_t random_word(void)
{
    static uint32_t state = 0x2545f491u;
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state;
}

/* All magnitudes alike: a random word shifted by a random amount. */
static uint32_t random_magnitude(void)
{
    uint32_t shift = random_word() >> 27;
    return random_word() >> shift;
}

static int32_t random_signed(void)
{
    uint32_t m = random_magnitude() >> 1;
    return random_word() >> 31 ? -(int32_t)m : (int32_t)m;
}

/* 0, the powers of two, and what lies one beside them: 2^k - 1, 2^k, 2^k + 1,
 * which takes in the largest word. */
#define EDGES 96
static uint32_t edge(uint32_t i)
{
    return (1u << i / 3) + i % 3 - 1u;
}

/// brume_fixed.h ///

static void compare_products(struct sweep *s, uint32_t a, uint32_t b)
{
    uint32_t expected = (uint32_t)((uint64_t)a * b >> 32);
    note_equal(s, mul_hi_floor(a, b), expected);
    note_equal(s, mul32_hi_floor(a, b), expected);
}

static void test_mul_hi_floor(void)
{
    struct sweep s = {0};
    for (uint32_t i = 0; i <= EDGES; i++)
        for (uint32_t j = 0; j <= EDGES; j++)
            compare_products(&s, i < EDGES ? edge(i) : UINT32_MAX,
                             j < EDGES ? edge(j) : UINT32_MAX);
    for (uint32_t i = 0; i < 6000000; i++) {
        uint32_t a = i % 3 ? random_word() : random_magnitude();
        uint32_t b = i % 3 ? random_word() : random_magnitude();
        compare_products(&s, a, b);
    }
    check_exact("mul_hi_floor, by 64 and by 16 bits", &s, 0x2bfbcdc5);
}

static void test_signs(void)
{
    struct sweep s = {0};
    for (uint32_t i = 0; i < 1000000; i++) {
        uint32_t a = i < EDGES ? edge(i) : random_magnitude(), half = a >> 1;
        int32_t word;
        memcpy(&word, &a, sizeof word);
        int64_t wide = word;
        note_equal(&s, (uint32_t)as_signed(a), a);
        s.wrong += as_signed(a) != word;
        note_equal(&s, magnitude(word), (uint32_t)(wide < 0 ? -wide : wide));
        s.wrong += with_sign(half, false) != (int32_t)half;
        s.wrong += with_sign(half, true) != -(int32_t)half;
    }
    s.wrong += magnitude(INT32_MIN) != 0x80000000u;
    check_exact("magnitude, with_sign, as_signed", &s, 0xe8b34706);
}

/* a * b / 2^(32 - up) rounded half away from zero, in 64 bits; false when it
 * does not fit the word, which is the caller's to see to. */
static bool rounded_product(int64_t a, int64_t b, unsigned up, int32_t *out)
{
    int64_t product = a * b; /* |.| <= 2^63 - 2^31 */
    int64_t m = product < 0 ? -product : product;
    m = ((m >> (31 - up)) + 1) >> 1;
    if (m > INT32_MAX)
        return false;
    *out = (int32_t)(product < 0 ? -m : m);
    return true;
}

static void compare_rounded(struct sweep *s, int32_t a, uint32_t b, unsigned up)
{
    int32_t expected;
    if (rounded_product(a, b, up, &expected)) {
        note_equal(s, (uint32_t)mul_signed_round(a, b, up), (uint32_t)expected);
        s->wrong += mul32_signed_round(a, b, up) != expected;
    }
    int32_t c = as_signed(b);
    if (rounded_product(a, c, up, &expected))
        note_equal(s, (uint32_t)mul_both_signed_round(a, c, up),
                   (uint32_t)expected);
}

static void test_mul_signed_round(void)
{
    struct sweep s = {0};
    for (unsigned up = 0; up <= 7; up++) {
        for (uint32_t i = 0; i < EDGES; i++)
            for (uint32_t j = 0; j < EDGES; j++)
                compare_rounded(&s, as_signed(edge(i)), edge(j), up);
        for (uint32_t i = 0; i < 300000; i++) {
            int32_t a = random_signed();
            compare_rounded(&s, a, random_magnitude(), up);
        }
        /* Ties: an odd multiple of half a unit, both signs. */
        for (int32_t i = 1; i < 2000; i += 2) {
            compare_rounded(&s, i, 1u << (31 - up), up);
            compare_rounded(&s, -i, 1u << (31 - up), up);
        }
    }
    check_exact("mul_signed_round, mul_both_signed_round", &s, 0x888b22fe);
}

static void test_product_less(void)
{
    static const int32_t k_value[] = {
        0,     1,      -1,      2,          -2,        65535,     -65537,
        46341, -46341, 1 << 29, -(1 << 30), INT32_MAX, -INT32_MAX};
    const int n = sizeof k_value / sizeof k_value[0];
    int wrong = 0, wrong32 = 0;
    for (int i = 0; i < n * n * n * n; i++) {
        int32_t a = k_value[i % n], b = k_value[i / n % n];
        int32_t c = k_value[i / n / n % n], d = k_value[i / n / n / n];
        bool expected = (int64_t)a * b < (int64_t)c * d;
        wrong += product_less(a, b, c, d) != expected;
        wrong32 += mul32_product_less(a, b, c, d) != expected;
    }
    tap_check(wrong == 0 && wrong32 == 0,
              "product_less: of %d, %d wrong, without a wide product %d",
              n * n * n * n, wrong, wrong32);
}

static void test_le32(void)
{
    struct sweep s = {0};
    for (uint32_t i = 0; i < 100000; i++) {
        uint32_t word = i < EDGES ? edge(i) : random_word();
        uint8_t b[4] = {(uint8_t)word, (uint8_t)(word >> 8),
                        (uint8_t)(word >> 16), (uint8_t)(word >> 24)};
        uint32_t stored;
        memcpy(&stored, b, sizeof stored);
        note_equal(&s, le32(stored), word);
    }
    check_exact("le32", &s, 0xbd23570c);
}

/// Roots and reciprocals ///

static void try_rsqrt(struct sweep *s, uint32_t x)
{
    unsigned shift;
    uint32_t m = brume_rsqrt(x, &shift);
    double exact = 1.0 / sqrt(ldexp(x, -32));
    double got = ldexp(m, (int)shift - 31);
    take(s, m ^ shift);
    s->wrong += m < 0x80000000u;
    note_error(s, fabs(got / exact - 1.0), x);
}

static void test_rsqrt(void)
{
    struct sweep s = {0};
    for (uint32_t i = 0; i < EDGES; i++)
        if (edge(i) != 0)
            try_rsqrt(&s, edge(i));
    try_rsqrt(&s, UINT32_MAX);
    for (uint32_t x = 1; x < 1u << 18; x++)
        try_rsqrt(&s, x);
    /* The mantissas of two octaves are all that it ever works on. */
    for (uint64_t x = 0x40000000u; x <= UINT32_MAX; x += 1013)
        try_rsqrt(&s, (uint32_t)x);
    tap_check(s.wrong == 0, "brume_rsqrt: the mantissa is normalised");
    check_error("brume_rsqrt, relative", &s, ldexp(1, -26), 0x7824250a);
}

static void try_reciprocal(struct sweep *s, uint32_t d)
{
    uint32_t r = brume_reciprocal(d);
    take(s, r);
    s->wrong += r < 0x80000000u;
    note_error(s, fabs(r - ldexp(1.0 / d, 63)), d);
}

static void test_reciprocal(void)
{
    struct sweep s = {0};
    for (uint32_t i = 0; i < EDGES; i++)
        try_reciprocal(&s, edge(i) | 0x80000000u);
    try_reciprocal(&s, UINT32_MAX);
    for (uint64_t d = 0x80000000u; d <= UINT32_MAX; d += 509)
        try_reciprocal(&s, (uint32_t)d);
    /* Where the division's divisor steps. */
    for (uint32_t d = 0x80010000u; d >= 0x80000000u; d += 0x10000u)
        for (uint32_t i = 0; i < 2; i++)
            try_reciprocal(&s, d - i);
    tap_check(s.wrong == 0, "brume_reciprocal: at least 2^31");
    check_error("brume_reciprocal, units", &s, 4, 0x8864191f);
}

static void test_inverse_of_move(void)
{
    struct sweep s = {0};
    for (uint32_t i = 0; i < 500000; i++) {
        int32_t move = as_signed(i < EDGES ? edge(i) : random_magnitude());
        int64_t m = move;
        m = m < 0 ? -m : m;
        note_equal(&s, brume_inverse_of_move(move),
                   m == 0 ? UINT32_MAX : (uint32_t)(UINT32_MAX / m));
    }
    check_exact("brume_inverse_of_move", &s, 0x3a143401);
}

/// Vectors ///

/* Errors of direction (as an angle) and of length. */
static void try_normalise(struct sweep *angle, struct sweep *length,
                          const int32_t v[3])
{
    int32_t u[3] = {v[0], v[1], v[2]};
    double cross = 0, dot = 0, square = 0, exact = 0;
    angle->wrong += !brume_normalise(u);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        double c = (double)v[i] * u[j] - (double)v[j] * u[i];
        cross += c * c;
        dot += (double)v[i] * u[i];
        square += (double)u[i] * u[i];
        exact += (double)v[i] * v[i];
        take(angle, (uint32_t)u[i]);
    }
    note_error(angle, atan2(sqrt(cross), dot), sqrt(exact));
    note_error(length, fabs(ldexp(sqrt(square), -30) - 1.0), sqrt(exact));
}

static void try_small_vectors(struct sweep *angle, struct sweep *length)
{
    for (int32_t i = 1; i < 9 * 9 * 9; i++) {
        int32_t v[3] = {i % 9 - 4, i / 9 % 9 - 4, i / 81 - 4};
        if (v[0] != 0 || v[1] != 0 || v[2] != 0)
            try_normalise(angle, length, v);
    }
}

static void try_edge_vectors(struct sweep *angle, struct sweep *length)
{
    for (uint32_t i = 0; i < EDGES * EDGES; i++) {
        int32_t a = as_signed(edge(i % EDGES)), b = as_signed(edge(i / EDGES));
        int32_t v[3][3] = {{a, b, 0}, {0, a, b}, {a, b, a}};
        for (int k = 0; k < 3; k++)
            if (a != 0 || b != 0)
                try_normalise(angle, length, v[k]);
    }
}

static void test_normalise(void)
{
    struct sweep angle = {0}, length = {0};
    int32_t zero[3] = {0, 0, 0};
    tap_check(!brume_normalise(zero) && zero[0] == 0 && zero[1] == 0 &&
                  zero[2] == 0,
              "brume_normalise: zero has no direction, and stays");
    try_small_vectors(&angle, &length);
    try_edge_vectors(&angle, &length);
    for (int i = 0; i < 1000000; i++) {
        /* Components of one magnitude, and of three. */
        int32_t v[3], part = 1 << (random_word() >> 27) % 31;
        for (int k = 0; k < 3; k++)
            v[k] = i & 1 ? as_signed(random_word()) / part : random_signed();
        if (v[0] != 0 || v[1] != 0 || v[2] != 0)
            try_normalise(&angle, &length, v);
    }
    tap_check(angle.wrong == 0, "brume_normalise: any other vector has one");
    check_error("brume_normalise, angle", &angle, ldexp(1, -26), 0xcc0b0db0);
    check_bound("brume_normalise, length", &length, ldexp(1, -26));
}

/// Angles ///

static const double full_turn = 6.283185307179586476925;

static void try_sincos(struct sweep *s, uint32_t turn)
{
    int32_t sine, cosine;
    brume_sincos(turn, &sine, &cosine);
    take(s, (uint32_t)sine);
    take(s, (uint32_t)cosine);
    double a = ldexp(turn, -32) * full_turn;
    note_error(s, fabs(ldexp(sine, -30) - sin(a)), turn);
    note_error(s, fabs(ldexp(cosine, -30) - cos(a)), turn);
}

static void test_sincos(void)
{
    struct sweep s = {0};
    for (uint32_t i = 0; i < EDGES; i++) {
        try_sincos(&s, edge(i));
        try_sincos(&s, 0u - edge(i));
    }
    /* Around the eighths, where the quadrants and the signs change. */
    for (uint32_t eighth = 0; eighth < 8; eighth++)
        for (uint32_t i = 0; i < 2000; i++)
            try_sincos(&s, (eighth << 29) + i - 1000);
    for (uint64_t turn = 0; turn <= UINT32_MAX; turn += 2003)
        try_sincos(&s, (uint32_t)turn);
    check_error("brume_sincos", &s, ldexp(1, -28), 0x8cef2758);
}

static void try_direction(struct sweep *s, int32_t azimuth, int32_t elevation)
{
    int32_t out[3];
    double a = ldexp(azimuth, -16) * full_turn / 360;
    double e = ldexp(elevation, -16) * full_turn / 360;
    double exact[3] = {cos(e) * sin(a), sin(e), cos(e) * cos(a)};
    brume_direction(out, azimuth, elevation);
    for (int i = 0; i < 3; i++) {
        take(s, (uint32_t)out[i]);
        note_error(s, fabs(ldexp(out[i], -30) - exact[i]), azimuth);
    }
}

static void test_direction(void)
{
    struct sweep s = {0};
    const int32_t most = 32767 << 16;
    for (int32_t a = -720; a <= 720; a += 15)
        for (int32_t e = -90; e <= 90; e += 15)
            try_direction(&s, a * 65536, e * 65536);
    for (int i = 0; i < 9; i++)
        try_direction(&s, (i % 3 - 1) * most, (i / 3 - 1) * most);
    for (int i = 0; i < 1000000; i++) {
        int32_t azimuth = random_signed() % most;
        try_direction(&s, azimuth, random_signed() % most);
    }
    check_error("brume_direction", &s, ldexp(1, -26), 0x73eeb1e1);
}

/// Numbers ///

static bool is_normal(struct brume_number n)
{
    return n.m == 0 ? n.e == 0 : n.m >= 0x80000000u;
}

static double value_of(struct brume_number n)
{
    return ldexp(n.m, n.e);
}

static void take_number(struct sweep *s, struct brume_number n)
{
    take(s, n.m);
    take(s, (uint32_t)n.e);
    s->wrong += !is_normal(n);
}

static void test_number_of(void)
{
    struct sweep of = {0}, q32 = {0};
    for (uint32_t i = 0; i < 300000; i++) {
        uint32_t m = i < EDGES ? edge(i) : random_magnitude();
        int32_t e = (int32_t)(random_word() % 1900) - 950;
        struct brume_number n = brume_number_of(m, e);
        take_number(&of, n);
        of.wrong += value_of(n) != ldexp(m, e);

        /* Mantissas truncate: 0 <= exact - number < a unit of the last. */
        uint64_t wide = (uint64_t)m << 32 | random_word();
        wide >>= random_word() & 31u;
        n = brume_number_q32(wide);
        take_number(&q32, n);
        double exact = ldexp((double)(wide >> 11), 11 - 32) +
                       ldexp((double)(wide & 2047), -32);
        double left = exact - value_of(n);
        q32.wrong += left < 0 || (wide != 0 && left >= ldexp(1, n.e));
        q32.wrong += (wide == 0) != (n.m == 0);
    }
    check_exact("brume_number_of", &of, 0xca972aa4);
    struct brume_number full = brume_number_q32(UINT64_MAX);
    struct brume_number least = brume_number_q32(1);
    tap_check(full.m == UINT32_MAX && full.e == 0 && least.m == 1u << 31 &&
                  least.e == -63,
              "brume_number_q32: the ends of its domain");
    check_exact("brume_number_q32, truncated", &q32, 0x47cf4edd);
}

/* Any number, with mantissas at the ends of their range now and then. */
static struct brume_number random_number(void)
{
    uint32_t m = random_word();
    if (m % 8 == 0)
        m = 0x80000000u + (random_magnitude() >> 1);
    else if (m % 8 == 1)
        m = 0u - 1u - (random_magnitude() >> 1);
    return brume_number_of(m | 0x80000000u, (int32_t)(random_word() % 64) - 64);
}

static void test_number_mul(void)
{
    struct sweep s = {0};
    for (uint32_t i = 0; i < 1000000; i++) {
        struct brume_number a = random_number(), b = random_number();
        struct brume_number n = brume_number_mul(a, b);
        uint64_t product = (uint64_t)a.m * b.m;
        int32_t up = product >> 63 ? 0 : 1;
        take_number(&s, n);
        s.wrong += n.m != (uint32_t)(product >> (32 - up)) ||
                   n.e != a.e + b.e + 32 - up;
    }
    struct brume_number zero = {0, 0}, one = {0x80000000u, -31};
    s.wrong += brume_number_mul(zero, one).m != 0;
    s.wrong += brume_number_mul(one, zero).m != 0;
    s.wrong += value_of(brume_number_mul(one, one)) != 1.0;
    check_exact("brume_number_mul, truncated", &s, 0xf0b4e193);
}

static void test_number_inverse(void)
{
    struct sweep s = {0};
    for (uint32_t i = 0; i < 1000000; i++) {
        struct brume_number a = random_number();
        struct brume_number n = brume_number_inverse(a);
        take_number(&s, n);
        note_error(&s, fabs(value_of(n) * value_of(a) - 1.0), a.m);
    }
    tap_check(s.wrong == 0, "brume_number_inverse: normalised");
    /* 4 units of a mantissa of at least 2^31 */
    check_error("brume_number_inverse, relative", &s, ldexp(1, -29),
                0x6535ff82);
}

static void test_number_floor(void)
{
    struct sweep s = {0};
    for (uint32_t i = 0; i < 1000000; i++) {
        struct brume_number a = random_number();
        int32_t q = (int32_t)(random_word() % 128);
        double exact = floor(ldexp(value_of(a), q));
        note_equal(&s, brume_number_floor(a, q),
                   exact < 4294967295.0 ? (uint32_t)exact : UINT32_MAX);
    }
    struct brume_number zero = {0, 0}, most = {UINT32_MAX, 991};
    struct brume_number least = {0x80000000u, -1024};
    s.wrong += brume_number_floor(zero, 32) != 0;
    s.wrong += brume_number_floor(most, 0) != UINT32_MAX;
    s.wrong += brume_number_floor(least, 32) != 0;
    check_exact("brume_number_floor", &s, 0x03c7222a);
}

/// Exponential ///

/* The error as a part of what is allowed at x. */
static void try_one_minus_exp(struct sweep *s, struct brume_number x)
{
    uint32_t om = brume_one_minus_exp(x);
    double exact = -expm1(-value_of(x)), error;
    take(s, om);
    error = fabs(ldexp(om, -32) - exact);
    note_error(s, error / fmax(ldexp(exact, -22), ldexp(1, -32)), value_of(x));
}

static void test_one_minus_exp(void)
{
    struct sweep s = {0};
    for (int32_t e = -72; e <= 9; e++) /* x from 2^-41 to 2^41 */
        for (uint32_t i = 0; i < 20000; i++) {
            uint32_t m = i < EDGES ? edge(i) : random_word();
            struct brume_number x = {m | 0x80000000u, e};
            try_one_minus_exp(&s, x);
        }
    struct brume_number zero = {0, 0}, most = {UINT32_MAX, 991};
    struct brume_number least = {0x80000000u, -1024};
    tap_check(brume_one_minus_exp(zero) == 0 &&
                  brume_one_minus_exp(least) == 0 &&
                  brume_one_minus_exp(most) == UINT32_MAX,
              "brume_one_minus_exp: the ends of its domain");
    check_error("brume_one_minus_exp, of max(2^-22 relative, 2^-32)", &s, 1,
                0x81ce8768);
}

/* A greater extinction must not show more light through. */
static void test_one_minus_exp_rises(void)
{
    uint32_t last = 0, falls = 0;
    for (int32_t e = -72; e <= 9; e++)
        for (uint32_t m = 0x80000000u; m >= 0x80000000u; m += 0x10000u) {
            struct brume_number x = {m, e};
            uint32_t om = brume_one_minus_exp(x);
            falls += om < last;
            last = om;
        }
    tap_check(falls == 0, "brume_one_minus_exp never falls (%u times)",
              (unsigned)falls);
}

/// Tables ///

static void test_exp_tables(void)
{
    uint32_t coarse = 0, fine = 0;
    for (int i = 0; i < 256; i++) {
        coarse += brume_exp_coarse[i] != lrint(32768 * exp(-i / 16.0));
        fine += brume_exp_fine[i] != lrint(32768 * exp(-i / 4096.0));
    }
    tap_check(coarse == 0 && fine == 0,
              "brume_exp_coarse, brume_exp_fine: "
              "round(2^15 exp(-i / 16)) and (-i / 4096)");
}

/* IEC 61966-2-1. */
static double srgb_of(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear
                               : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

static uint32_t srgb_code(uint32_t linear)
{
    return (uint32_t)floor(255 * srgb_of(linear / 65536.0) + 0.5);
}

/* Found by looking at every value, not by inverting the curve. */
static void test_srgb_table(void)
{
    uint32_t wrong = 0, code = 0;
    for (uint32_t v = 0; v <= 65536; v++)
        for (; code < srgb_code(v); code++)
            wrong += brume_srgb_threshold[code] != v;
    tap_check(wrong == 0 && code == 255,
              "brume_srgb_threshold: first values that round to each code");
}

/// Pixels ///

/* One value through brume_pack_span, over a black background. */
static uint32_t packed(struct brume_frame *f, uint32_t linear, int format)
{
    struct brume_radiance in = {.light = linear, .transmittance = 0x10000u};
    uint8_t bytes[8] = {0};
    uint16_t word;
    brume_pack_span(f, 0, 0, &in, 1, format, bytes);
    if (format == BRUME_L8)
        return bytes[0];
    memcpy(&word, bytes, sizeof word);
    return word;
}

static void test_srgb_output(void)
{
    static struct brume_frame f = {.output = BRUME_SRGB};
    uint32_t wrong8 = 0, wrong16 = 0;
    for (uint32_t v = 0; v <= 65536; v++) {
        wrong8 += packed(&f, v, BRUME_L8) != srgb_code(v);
        wrong16 += packed(&f, v, BRUME_L16) != 257 * srgb_code(v);
    }
    tap_check(wrong8 == 0 && wrong16 == 0,
              "sRGB: round(255 srgb(v / 65536)) of every v (%u, %u wrong)",
              (unsigned)wrong8, (unsigned)wrong16);
}

static void test_linear_output(void)
{
    static struct brume_frame f = {.output = BRUME_LINEAR};
    uint32_t wrong8 = 0, wrong16 = 0;
    for (uint32_t v = 0; v <= 65536; v++) {
        wrong8 += packed(&f, v, BRUME_L8) != lround(255 * (v / 65536.0));
        wrong16 += packed(&f, v, BRUME_L16) != (v < 65536 ? v : 65535);
    }
    tap_check(wrong8 == 0 && wrong16 == 0,
              "linear: round(255 v / 65536) of every v (%u, %u wrong)",
              (unsigned)wrong8, (unsigned)wrong16);
}

static void test_565_levels(void)
{
    static struct brume_frame f = {.output = BRUME_LINEAR};
    uint32_t wrong = 0;
    for (uint32_t v = 0; v <= 65536; v++) {
        double code = packed(&f, v, BRUME_L8);
        uint32_t r = (uint32_t)lround(code * 31 / 255);
        uint32_t g = (uint32_t)lround(code * 63 / 255);
        uint32_t word = r << 11 | g << 5 | r;
        wrong += packed(&f, v, BRUME_RGB565) != word;
        wrong += packed(&f, v, BRUME_RGB565_SWAPPED) !=
                 (word >> 8 | (word & 255u) << 8);
    }
    tap_check(wrong == 0, "RGB565: the nearest level of every code");
}

/* light + transmittance * background, rounded, at most 1. */
static void test_composition(void)
{
    static struct brume_frame f = {.output = BRUME_LINEAR};
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < 500000; i++) {
        uint32_t t = i < EDGES ? edge(i) % 65537 : random_word() % 65537;
        uint32_t b = i % 7 ? random_word() % 65537 : 65536 - i % 2;
        struct brume_radiance in = {.light = random_magnitude() % 65537,
                                    .transmittance = t};
        uint64_t sum = in.light + (((uint64_t)t * b + 0x8000u) >> 16);
        uint16_t got;
        f.background[0] = b;
        brume_pack_span(&f, 0, 0, &in, 1, BRUME_L16, &got);
        wrong += got != (sum < 65535 ? sum : 65535);
    }
    tap_check(wrong == 0, "composition: L + T * background, rounded");
}

int main(void)
{
    test_mul_hi_floor();
    test_signs();
    test_mul_signed_round();
    test_product_less();
    test_le32();
    test_rsqrt();
    test_reciprocal();
    test_inverse_of_move();
    test_normalise();
    test_sincos();
    test_direction();
    test_number_of();
    test_number_mul();
    test_number_inverse();
    test_number_floor();
    test_one_minus_exp();
    test_one_minus_exp_rises();
    test_exp_tables();
    test_srgb_table();
    test_srgb_output();
    test_linear_output();
    test_565_levels();
    test_composition();
    return tap_done();
}
