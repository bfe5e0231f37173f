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
 * Warfare", 2014: fract(52.9829189 * fract(0.06711056 x + 0.00583715 y)).
 * Fractions in Q0.32 wrap by themselves. `moved` is what the frame adds to
 * the inner one. */
static uint32_t ign(uint32_t x, uint32_t y, uint32_t moved, uint32_t channel)
{
    x += 96u * channel;
    y += 72u * channel;
    uint32_t u = x * 288237660u + y * 25070368u + moved;
    return (52u * u + mul_hi_floor(u, 4221604530u)) >> 16;
}

/* fract(0.80014635 x + 0.66377714 y + 0.28119233 frame), found by searching
 * lattices for the least error after accumulation and filters; see
 * docs/noise.md. */
static uint32_t rank1(uint32_t x, uint32_t y, uint32_t frame, uint32_t channel)
{
    x += 96u * channel;
    y += 72u * channel;
    return (x * 3436602405u + y * 2850901108u + frame * 1207711862u) >> 16;
}

/* Where channel c looks in a tile of side 2^log2: moved by point c of Roberts'
 * R2 sequence, (0.7549, 0.5698), so that channels are nearly independent. */
static uint32_t channel_x(uint32_t channel, uint32_t log2)
{
    return (channel * 49472u & 0xffffu) >> (16u - log2);
}

static uint32_t channel_y(uint32_t channel, uint32_t log2)
{
    return (channel * 37345u & 0xffffu) >> (16u - log2);
}

/* Bayer's ordered dither matrix of side 2^log2, from interleaved bits of x ^ y
 * and y, lowest first. */
static uint32_t bayer(uint32_t x, uint32_t y, uint32_t channel, uint32_t log2)
{
    x += channel_x(channel, log2);
    y += channel_y(channel, log2);
    uint32_t d = x ^ y, v = 0;
    for (uint32_t i = 0; i < log2; i++) {
        v = v << 2 | (d & 1u) << 1 | (y & 1u);
        d >>= 1;
        y >>= 1;
    }
    return (2u * v + 1u) << (15u - 2u * log2);
}

/* A value of the table, whose sides wrap, in the middle of its bin of 1/256. */
static uint32_t table_value(const struct brume_noise_table *t, uint32_t x,
                            uint32_t y, uint32_t frame)
{
    x &= (1u << t->width_log2) - 1u;
    y &= (1u << t->height_log2) - 1u;
    frame &= (1u << t->frames_log2) - 1u;
    uint32_t i = ((frame << t->height_log2 | y) << t->width_log2) | x;
    if (t->bits == 8)
        return t->values[i] * 256u + 128u;
    /* Below the upper half, the 4x4 matrix of the place. */
    uint32_t v = t->values[i >> 1] >> ((i & 1u) << 2) & 15u;
    return v << 12 | bayer(x & 3u, y & 3u, 0, 2) >> 4;
}

static uint32_t table(int noise, const struct brume_noise_table *t, uint32_t x,
                      uint32_t y, uint32_t frame, uint32_t channel)
{
    x += channel_x(channel, t->width_log2);
    y += channel_y(channel, t->height_log2);
    if (noise == BRUME_NOISE_TABLE)
        return table_value(t, x, y, frame);
    if (noise == BRUME_NOISE_TABLE_R2) {
        /* Point `frame` of the same sequence, in Q0.32. */
        x += (frame * 3242174889u) >> (32u - t->width_log2);
        y += (frame * 2447445414u) >> (32u - t->height_log2);
        return table_value(t, x, y, 0);
    }
    /* The golden ratio's fraction, Q0.32, in steps of 1/256. */
    uint32_t further = (frame * 2654435769u) >> 24 << 8;
    return (table_value(t, x, y, 0) + further) & 0xffffu;
}

uint32_t brume_noise_value(int noise, const struct brume_noise_table *values,
                           uint32_t x, uint32_t y, uint32_t frame,
                           uint32_t channel)
{
    if (!BRUME_WITH_NOISE)
        return 0;
    switch (noise) {
    case BRUME_NOISE_WHITE: return white(x, y, frame, channel);
    /* 5.588238 per frame on both axes, for 64 frames */
    case BRUME_NOISE_IGN:
        return ign(x, y, (frame & 63u) * 1750839832u, channel);
    /* (2.083, 4.867) per frame */
    case BRUME_NOISE_IGN_THESIS: return ign(x, y, frame * 722416529u, channel);
    case BRUME_NOISE_RANK1: return rank1(x, y, frame, channel);
    case BRUME_NOISE_BAYER4: return bayer(x, y, channel, 2);
    case BRUME_NOISE_BAYER8: return bayer(x, y, channel, 3);
    case BRUME_NOISE_BAYER16: return bayer(x, y, channel, 4);
    case BRUME_NOISE_TABLE:
    case BRUME_NOISE_TABLE_GOLDEN:
    case BRUME_NOISE_TABLE_R2:
        return table(noise, values, x, y, frame, channel);
    default: return 0;
    }
}

bool brume_noise_usable(int noise, const struct brume_noise_table *t)
{
    if (noise < BRUME_NOISE_TABLE)
        return true;
    return noise <= BRUME_NOISE_TABLE_R2 && t != NULL && t->values != NULL &&
           t->width_log2 >= 3 && t->width_log2 <= 8 && t->height_log2 >= 3 &&
           t->height_log2 <= 8 && t->frames_log2 <= 6 &&
           (t->bits == 4 || t->bits == 8);
}
