/* SPDX-License-Identifier: MIT */
/* Noises as formulas; formula.h says which, docs/SPEC.md defines the core's.
 * Written again rather than shared: a test holds both against each other. */
#include "formula.h"

/* 1 / golden ratio, and 1/p and 1/p^2 with p^3 = p + 1 (Roberts 2018, the R2
 * sequence), Q0.32. */
#define GOLDEN 2654435769u
#define R2_X 3242174889u
#define R2_Y 2447445414u

static uint8_t *texel(struct noise_texture *t, uint32_t x, uint32_t y,
                      uint32_t frame)
{
    return t->values + ((size_t)frame * t->height + y) * t->width + x;
}

/* Fill a texture with value_of(x, y, frame, option), 0 .. 255. */
static void fill(struct noise_texture *t,
                 uint32_t value_of(uint32_t, uint32_t, uint32_t, uint32_t),
                 uint32_t option)
{
    for (uint32_t frame = 0; frame < t->frames; frame++)
        for (uint32_t y = 0; y < t->height; y++)
            for (uint32_t x = 0; x < t->width; x++)
                *texel(t, x, y, frame) = (uint8_t)value_of(x, y, frame, option);
}

/// White ///

static uint32_t white(uint32_t x, uint32_t y, uint32_t frame, uint32_t seed)
{
    const uint32_t later = frame + 65536u * seed;
    return noise_hash(x +
                      noise_hash(y + noise_hash(2u * later + 0x9e3779b9u))) >>
           24;
}

void noise_white(struct noise_texture *t, uint32_t seed)
{
    fill(t, white, seed);
}

/* A number below n <= 64; the counter moves on. 32 random bits times n: the
 * bias is below n / 2^32. */
static uint32_t below(uint32_t n, uint32_t *counter)
{
    return (uint32_t)((uint64_t)noise_hash(++*counter) * n >> 32);
}

static void shuffle(uint8_t order[64], uint32_t *counter)
{
    for (uint32_t i = 0; i < 64; i++)
        order[i] = (uint8_t)i;
    for (uint32_t i = 63; i > 0; i--) {
        const uint32_t k = below(i + 1, counter);
        const uint8_t other = order[k];
        order[k] = order[i];
        order[i] = other;
    }
}

void noise_white8(struct noise_texture *t, uint32_t seed)
{
    uint32_t counter = noise_hash(seed + 0x9e3779b9u);
    uint8_t order[64];

    for (uint32_t frame = 0; frame < t->frames; frame++) {
        shuffle(order, &counter);
        for (uint32_t y = 0; y < t->height; y++)
            for (uint32_t x = 0; x < t->width; x++)
                *texel(t, x, y, frame) =
                    (uint8_t)(4 * order[y % 8 * 8 + x % 8] + 2);
    }
}

/// Ordered ///

/* The bits of x ^ y and y interleaved, lowest first, are the level's bits from
 * the highest down; a level of s x s is half a level off zero. */
static uint32_t bayer(uint32_t x, uint32_t y, uint32_t frame, uint32_t side)
{
    uint32_t value = 0, weight = 128;

    (void)frame;
    for (uint32_t bit = 1; bit < side; bit *= 2) {
        value += (x ^ y) & bit ? weight : 0;
        value += y & bit ? weight / 2 : 0;
        weight /= 4;
    }
    return value + weight;
}

void noise_bayer(struct noise_texture *t, uint32_t side)
{
    fill(t, bayer, side);
}

/// Interleaved gradient noise ///

/* fract(52.9829189 fract(0.06711056 x + 0.00583715 y)), Jimenez 2014, with
 * fractions in Q0.32, which wrap by themselves. Both frame offsets end in one
 * addition: 5.588238 (0.06711056 + 0.00583715), and 2.083 * 0.06711056 +
 * 4.867 * 0.00583715, each times 2^32. */
static uint32_t ign(uint32_t x, uint32_t y, uint32_t frame, uint32_t offsets)
{
    const uint32_t moved = offsets == IGN_THESIS ? frame * 722416529u
                                                 : (frame & 63u) * 1750839832u;
    const uint32_t u = x * 288237660u + y * 25070368u + moved;
    return (52u * u + (uint32_t)((uint64_t)u * 4221604530u >> 32)) >> 24;
}

void noise_ign(struct noise_texture *t, enum ign_offsets offsets)
{
    fill(t, ign, offsets);
}

/// A rank-1 lattice ///

/* fract(0.80014635 x + 0.66377714 y + 0.28119233 t), Q0.32. The error spectrum
 * of such a lattice has lines at the multiples k of (a, b, c) alone, with the
 * power 6 / (pi k)^2 of all, so what a filter leaves is a short sum of its
 * gains there; these are the best of 3 million random (a, b, c) and of small
 * changes of the best, for the product of the five RMSE of measure.h. */
static uint32_t rank1(uint32_t x, uint32_t y, uint32_t frame, uint32_t unused)
{
    (void)unused;
    return (x * 3436602405u + y * 2850901108u + frame * 1207711862u) >> 24;
}

void noise_rank1(struct noise_texture *t)
{
    fill(t, rank1, 0);
}

/// A 2D table over time ///

void noise_golden(struct noise_texture *t)
{
    const size_t pixels = (size_t)t->width * t->height;

    for (uint32_t frame = 1; frame < t->frames; frame++)
        for (size_t i = 0; i < pixels; i++)
            t->values[frame * pixels + i] =
                (uint8_t)(t->values[i] + (frame * GOLDEN >> 24));
}

void noise_r2(struct noise_texture *t)
{
    for (uint32_t frame = 1; frame < t->frames; frame++) {
        const uint32_t dx =
            (uint32_t)((uint64_t)(frame * R2_X) * t->width >> 32);
        const uint32_t dy =
            (uint32_t)((uint64_t)(frame * R2_Y) * t->height >> 32);
        for (uint32_t y = 0; y < t->height; y++)
            for (uint32_t x = 0; x < t->width; x++)
                *texel(t, x, y, frame) = *texel(t, (x + dx) & (t->width - 1),
                                                (y + dy) & (t->height - 1), 0);
    }
}
