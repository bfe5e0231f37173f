/* SPDX-License-Identifier: MIT */
/* Noises as functions of pixel and frame; docs/SPEC.md defines each. */
#include "brume_inner.h"

/* lowbias32 of C. Wellons' hash prospector: a bijection of 32 bits whose bias
 * is below that of MurmurHash3's finaliser. */
static uint32_t mix(uint32_t h)
{
    h ^= h >> 16;
    h *= 0x7feb352du;
    h ^= h >> 15;
    h *= 0x846ca68bu;
    return h ^ h >> 16;
}

static uint32_t white(uint32_t x, uint32_t y, uint32_t frame, uint32_t channel)
{
    return mix(x + mix(y + mix(2u * frame + channel + 0x9e3779b9u))) >> 16;
}

/* Jimenez, "Next Generation Post Processing in Call of Duty: Advanced
 * Warfare", 2014: fract(52.9829189 * fract(0.06711056 x + 0.00583715 y)), both
 * coordinates moved by 5.588238 per frame for 64 frames. Fractions in Q0.32
 * wrap by themselves. */
static uint32_t ign(uint32_t x, uint32_t y, uint32_t frame, uint32_t channel)
{
    x += 96u * channel;
    y += 72u * channel;
    uint32_t u = x * 288237660u + y * 25070368u + (frame & 63u) * 1750839832u;
    return (52u * u + mul_hi_floor(u, 4221604530u)) >> 16;
}

/* Bayer's ordered dither matrix 8x8, from interleaved bits of x ^ y and y,
 * lowest first. */
static uint32_t bayer8(uint32_t x, uint32_t y, uint32_t channel)
{
    x += 6u * channel;
    y += 4u * channel;
    uint32_t d = x ^ y;
    uint32_t v = (d & 1u) << 5 | (y & 1u) << 4 | (d & 2u) << 2 | (y & 2u) << 1 |
                 (d & 4u) >> 1 | (y & 4u) >> 2;
    return 1024u * v + 512u;
}

uint32_t brume_noise_value(int noise, uint32_t x, uint32_t y, uint32_t frame,
                           uint32_t channel)
{
    switch (noise) {
    case BRUME_NOISE_WHITE: return white(x, y, frame, channel);
    case BRUME_NOISE_IGN: return ign(x, y, frame, channel);
    case BRUME_NOISE_BAYER8: return bayer8(x, y, channel);
    default: return 0;
    }
}
