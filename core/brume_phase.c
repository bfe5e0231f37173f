/* SPDX-License-Identifier: MIT */
/*
 * Phase functions as tables of logarithms: between two entries a power law,
 * which is what those of Henyey-Greenstein and Schlick are on either side of
 * their peak.
 */
#include "brume_inner.h"

#if BRUME_WITH_LIGHTING

#define MIDDLE 352       /* entry of cos = 0 */
#define HALF 320         /* of w = 1/2 */
#define MOST 1072668082u /* 0.999, Q2.30 */
#define ONE_Q30 (1u << 30)

/// Numbers ///

static struct brume_number q30(uint32_t a)
{
    return brume_number_of(a, -30);
}

struct brume_number brume_number_plus(struct brume_number a,
                                      struct brume_number b)
{
    struct brume_number high = a.e > b.e ? a : b, low = a.e > b.e ? b : a;
    if (low.m == 0 || high.m == 0)
        return low.m == 0 ? high : low;
    uint32_t gap = (uint32_t)(high.e - low.e);
    uint32_t rest = gap < 32 ? low.m >> gap : 0, sum = high.m + rest;
    if (sum >= high.m)
        return brume_number_of(sum, high.e);
    return brume_number_of(sum >> 1 | 0x80000000u, high.e + 1);
}

/* a^(-3/2); a > 0 */
static struct brume_number to_minus_3_2(struct brume_number a)
{
    /* x 2^(2 half), x = m 2^-32 or half of that: 1/4 <= x < 1 */
    uint32_t odd = (uint32_t)a.e & 1u;
    int32_t half = (a.e + 32 + (int32_t)odd) / 2;
    unsigned shift;
    uint32_t root = brume_rsqrt(a.m >> odd, &shift); /* Q1.31 */
    struct brume_number r = brume_number_of(root, (int32_t)shift - 31 - half);
    return brume_number_mul(r, brume_number_inverse(a));
}

int32_t brume_log2(struct brume_number a)
{
    uint32_t x = a.m, y = 0; /* Q1.31 */
    for (int bit = 0; bit < 16; bit++) {
        x = mul_hi_floor(x, x); /* Q2.30 */
        y = y << 1 | x >> 31;
        x <<= x >> 31 ? 0 : 1;
    }
    return (a.e + 31) * 65536 + (int32_t)y;
}

/// Models ///

/* The angle of an entry: 1 - cos and 1 + cos, Q2.30. */
struct angle {
    uint32_t u, v;
};

static struct angle angle_of(uint32_t entry)
{
    uint32_t n = entry > MIDDLE ? 2u * MIDDLE - entry : entry;
    uint32_t w = n < 16 ? n << 6 : (16u + (n & 15u)) << ((n >> 4) + 5u);
    if (n > HALF) /* in steps half as wide */
        w = (32u + n - HALF) << 24;
    struct angle a = {w, 2u * ONE_Q30 - w};
    struct angle b = {a.v, a.u};
    return entry > MIDDLE ? b : a;
}

/* (1 - g^2) / (1 + g^2 - 2 g cos)^(3/2), with the denominator as
 * (1 - |g|)^2 + 2 |g| (1 -+ cos), which nothing cancels in. */
static struct brume_number henyey_greenstein(int32_t g, struct angle a)
{
    uint32_t h = magnitude(g);
    struct brume_number less = q30(ONE_Q30 - h), more = q30(ONE_Q30 + h);
    struct brume_number way = q30(g < 0 ? a.v : a.u);
    way = brume_number_mul(way, brume_number_of(h, -29));
    way = brume_number_plus(brume_number_mul(less, less), way);
    return brume_number_mul(brume_number_mul(less, more), to_minus_3_2(way));
}

/* HG(g) (1 + alpha cos^2) / (1 + alpha (1 + 2 g^2) / 3) */
static struct brume_number draine(int32_t g, struct brume_number alpha,
                                  struct angle a)
{
    static const struct brume_number k_one = {0x80000000u, -31};
    static const struct brume_number k_third = {0xaaaaaaabu, -33};
    struct brume_number h = q30(magnitude(g));
    struct brume_number x = q30(a.u < a.v ? ONE_Q30 - a.u : ONE_Q30 - a.v);
    struct brume_number lobe = brume_number_plus(
        k_one, brume_number_mul(alpha, brume_number_mul(x, x)));
    struct brume_number norm = brume_number_mul(h, h);
    norm.e += norm.m != 0 ? 1 : 0;
    norm = brume_number_mul(brume_number_plus(k_one, norm), k_third);
    norm = brume_number_plus(k_one, brume_number_mul(alpha, norm));
    lobe = brume_number_mul(lobe, brume_number_inverse(norm));
    return brume_number_mul(henyey_greenstein(g, a), lobe);
}

/* (1 - k^2) / (1 - k cos)^2, with 1 - |k| + |k| (1 -+ cos). From g = 0.93 on
 * the k of the formula exceeds 1, which is no phase function: 0.999 at most. */
static struct brume_number schlick(int32_t g, struct angle a)
{
    /* k = g (1.55 - 0.55 g^2); g^2 Q60 -> Q28 */
    uint32_t h = magnitude(g), gg = mul_hi_floor(h, h);
    uint32_t factor = 1664299827u - mul_hi_floor(gg << 2, 2362232013u);
    uint32_t k = mul_hi_floor(h << 1, factor << 1); /* Q31 + Q31 -> Q30 */
    k = k < MOST ? k : MOST;
    struct brume_number less = q30(ONE_Q30 - k), more = q30(ONE_Q30 + k);
    struct brume_number way = brume_number_mul(q30(k), q30(g < 0 ? a.v : a.u));
    way = brume_number_inverse(brume_number_plus(less, way));
    way = brume_number_mul(way, way);
    return brume_number_mul(brume_number_mul(less, more), way);
}

static struct brume_number value_of(const struct brume_phase_model *m,
                                    struct angle a)
{
    struct brume_number rest = brume_number_of(0x10000u - m->weight, -16);
    struct brume_number weight = brume_number_of(m->weight, -16);
    if (m->kind == BRUME_PHASE_SCHLICK)
        return schlick(m->g, a);
    rest = brume_number_mul(rest, henyey_greenstein(m->g, a));
    if (weight.m == 0)
        return rest;
    return brume_number_plus(
        rest, brume_number_mul(
                  weight, draine(m->draine_g,
                                 brume_number_of(m->draine_alpha, -16), a)));
}

static bool is_good(const struct brume_phase_model *m, uint32_t octave,
                    uint32_t octave_c)
{
    return m->kind <= BRUME_PHASE_SCHLICK && magnitude(m->g) <= MOST &&
           magnitude(m->draine_g) <= MOST && m->draine_alpha <= 1024u << 16 &&
           m->weight <= 0x10000u && octave < BRUME_MAX_OCTAVES &&
           octave_c <= 0x10000u;
}

int brume_phase_build(struct brume_phase *out,
                      const struct brume_phase_model *model, uint32_t octave,
                      uint32_t octave_c)
{
    if (out == NULL || model == NULL)
        return BRUME_ERR_NULL;
    if (!is_good(model, octave, octave_c))
        return BRUME_ERR_SCENE;
    struct brume_phase_model m = *model;
    for (; octave > 0; octave--) {
        m.g = mul_signed_round(m.g, octave_c << 14, 2);
        m.draine_g = mul_signed_round(m.draine_g, octave_c << 14, 2);
        m.draine_alpha = mul_hi_floor(m.draine_alpha, octave_c << 15) << 1;
    }
    for (uint32_t i = 0; i < BRUME_PHASE_CODES; i++) {
        int32_t y = brume_log2(value_of(&m, angle_of(i)));
        out->code[i] = (uint16_t)((y + (16 << 16) + 32) >> 6);
    }
    return BRUME_OK;
}

/// Values ///

struct brume_number brume_exp2(uint32_t y)
{
    /* 2 exp(-(1 - f) ln 2), by the tables in steps of 1/4096 */
    uint32_t rest = 0x10000u - (y & 0xffffu);
    uint32_t tau = (rest * 45426u + 0x80000u) >> 20;
    uint32_t m =
        (uint32_t)brume_exp_coarse[tau >> 8] * brume_exp_fine[tau & 255u];
    return brume_number_of(m, (int32_t)(y >> 16) - 29);
}

uint32_t brume_one_minus_cos(const int32_t a[3], const int32_t b[3])
{
    uint32_t m[3], all = 1, sum = 0;
    for (int i = 0; i < 3; i++) {
        m[i] = a[i] < b[i] ? (uint32_t)b[i] - (uint32_t)a[i]
                           : (uint32_t)a[i] - (uint32_t)b[i];
        all |= m[i];
    }
    unsigned up = leading_zeros(all);
    for (int i = 0; i < 3; i++) {
        uint32_t s = m[i] << up;
        sum += mul_hi_floor(s, s) >> 2;
    }
    /* Q(28 + 2 up - 2), halved */
    int32_t down = 2 * (int32_t)up - 3;
    uint32_t u = down < 0 ? sum << -down : down < 32 ? sum >> down : 0;
    return u < 0x80000000u ? u : 0x80000000u;
}

struct brume_number brume_phase_value(const struct brume_phase *phase,
                                      uint32_t u)
{
    bool back = u > ONE_Q30;
    uint32_t w = back ? 2u * ONE_Q30 - u : u, n = w >> 6;
    uint32_t between = (w & 63u) << 6; /* of 4096 */
    if (w >= 1024u) {
        uint32_t shift = leading_zeros(w), t = w << shift;
        n = (22u - shift) * 16u + (t >> 27 & 15u);
        between = t >> 15 & 4095u;
        if (shift == 2) {
            n = HALF + (t >> 26 & 31u);
            between = t >> 14 & 4095u;
        } else if (shift == 1) {
            n = MIDDLE;
        }
    }
    uint32_t a = phase->code[back ? 2u * MIDDLE - n : n];
    uint32_t next = n < MIDDLE ? n + 1u : n;
    uint32_t b = phase->code[back ? 2u * MIDDLE - next : next];
    /* Q10 to Q16, with the offset of 16 */
    uint32_t y = (a * (4096u - between) + b * between) >> 6;
    struct brume_number value = brume_exp2(y);
    value.e -= 16;
    return value;
}

#endif
