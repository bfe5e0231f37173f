/* SPDX-License-Identifier: MIT */
#include "asset_light.h"

#include <stdlib.h>
#include <string.h>

#define SUN_HEAD 32u
#define SKY_HEAD 16u

/* 2^(1/48) - 1 in Q32, and 2^(255/24) - 1 in Q20. */
#define HALF_CODE 62471738u
#define DEPTH_OF_255 1654887689u

/// Bytes ///

static void *get_memory(size_t n)
{
    void *p = calloc(n ? n : 1, 1);
    if (p == NULL)
        abort();
    return p;
}

static uint32_t get16(const uint8_t *p)
{
    return p[0] | (uint32_t)p[1] << 8;
}

uint32_t asset_section_bytes(const uint8_t *asset, uint32_t id)
{
    const uint8_t *entry = asset + BRUME_HEADER_BYTES;
    for (int i = 0; i < asset[BRUME_OFF_SECTIONS]; i++, entry += 16)
        if (asset_get32(entry) == id)
            return asset_get32(entry + 8);
    return 0;
}

static size_t aligned(size_t n)
{
    return (n + 63) / 64 * 64;
}

static size_t end_of_entries(uint32_t sections)
{
    return aligned(BRUME_HEADER_BYTES + BRUME_SECTION_BYTES * sections);
}

/// Voxels ///

/* What is read from the blob. */
struct source {
    const uint8_t *asset;
    int cells[3];
    const uint8_t *cell, *pool, *range;
    uint32_t bricks;
};

static struct source source_of(const uint8_t *asset)
{
    struct source s = {.asset = asset};
    for (int i = 0; i < 3; i++)
        s.cells[i] = (int)get16(asset + BRUME_OFF_CELLS + 2 * i);
    s.cell = asset + asset_section(asset, BRUME_SECTION_CELL);
    s.pool = asset + asset_section(asset, BRUME_SECTION_POOL);
    s.range = asset + asset_section(asset, BRUME_SECTION_RNGE);
    s.bricks = asset_get32(asset + BRUME_OFF_BRICKS);
    return s;
}

static size_t cell_count(const struct source *s)
{
    return (size_t)s->cells[0] * (size_t)s->cells[1] * (size_t)s->cells[2];
}

static uint32_t voxel_of(const struct source *s, uint32_t brick, int x, int y,
                         int z)
{
    int format = s->asset[BRUME_OFF_FORMAT], side = s->asset[BRUME_OFF_SIDE];
    bool nibbles = format == BRUME_U4R;
    size_t bytes = side == 9 ? 732 : 512, i = (size_t)(x + side * y);
    i += (size_t)(side * side * z);
    if (nibbles)
        bytes = side == 9 ? 368 : 256;
    const uint8_t *p = s->pool + brick * bytes;
    if (format == BRUME_U8)
        return 256u * p[i];
    uint32_t range = asset_get32(s->range + 4 * brick);
    uint32_t code = nibbles ? p[i / 2] >> i % 2 * 4 & 15u : p[i];
    return (range & 0xffff) + code * (range >> 16);
}

/* A voxel of the pool in units of density_max / 65280; 0 outside. */
static uint32_t voxel_at(const struct source *s, int x, int y, int z)
{
    const int *n = s->cells;
    if (x < 0 || y < 0 || z < 0 || x >= 8 * n[0] || y >= 8 * n[1] ||
        z >= 8 * n[2])
        return 0;
    uint32_t cell =
        asset_get32(s->cell + 4 * (x / 8 + n[0] * (y / 8 + n[1] * (z / 8))));
    return cell & BRUME_CELL_EMPTY ? 0 : voxel_of(s, cell, x & 7, y & 7, z & 7);
}

/* Sum over n^3 voxels of a brick from (x,y,z) on. */
static uint32_t brick_sum(const struct source *s, uint32_t brick, int x, int y,
                          int z, int n)
{
    uint32_t sum = 0;
    for (int i = 0; i < n * n * n; i++)
        sum += voxel_of(s, brick, x + i % n, y + i / n % n, z + i / n / n);
    return sum;
}

/// MIPS ///

/* The code q with q^2 < sum / count <= (q + 1)^2. */
static uint8_t code_of_mean(uint64_t sum, uint64_t count)
{
    uint32_t q = 0;
    while ((uint64_t)(q + 1) * (q + 1) * count < sum)
        q++;
    return (uint8_t)q;
}

static void halve(int n[3])
{
    for (int i = 0; i < 3; i++)
        n[i] = (n[i] + 1) / 2;
}

static size_t volume_of(const int n[3])
{
    return (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
}

static size_t mip_bytes(const struct source *s)
{
    int n[3] = {s->cells[0], s->cells[1], s->cells[2]};
    size_t bytes = 72u * (size_t)s->bricks + volume_of(n);
    while (volume_of(n) > 1) {
        halve(n);
        bytes += volume_of(n);
    }
    return bytes;
}

static uint8_t *put_brick_means(const struct source *s, uint8_t *out)
{
    for (uint32_t b = 0; b < s->bricks; b++)
        for (int n = 2; n <= 4; n *= 2)
            for (int z = 0; z < 8; z += n)
                for (int y = 0; y < 8; y += n)
                    for (int x = 0; x < 8; x += n)
                        *out++ = code_of_mean(brick_sum(s, b, x, y, z, n),
                                              (uint64_t)(n * n * n));
    return out;
}

/* Sums of a level, where `fine` sums are those of the one below. */
static uint64_t *sums_above(const uint64_t *fine, const int n[3])
{
    int up[3] = {n[0], n[1], n[2]};
    halve(up);
    uint64_t *sums = get_memory(volume_of(up) * sizeof *sums);
    for (int z = 0; z < n[2]; z++)
        for (int y = 0; y < n[1]; y++)
            for (int x = 0; x < n[0]; x++)
                sums[x / 2 + up[0] * (y / 2 + up[1] * (z / 2))] += *fine++;
    return sums;
}

static void put_mips(const struct source *s, uint8_t *out)
{
    int n[3] = {s->cells[0], s->cells[1], s->cells[2]};
    uint64_t *sums = get_memory(volume_of(n) * sizeof *sums), count = 512;
    out = put_brick_means(s, out);
    for (size_t i = 0; i < volume_of(n); i++) {
        uint32_t cell = asset_get32(s->cell + 4 * i);
        if (!(cell & BRUME_CELL_EMPTY))
            sums[i] = brick_sum(s, cell, 0, 0, 0, 8);
    }
    for (;; count *= 8) {
        for (size_t i = 0; i < volume_of(n); i++)
            *out++ = code_of_mean(sums[i], count);
        if (volume_of(n) == 1)
            break;
        uint64_t *above = sums_above(sums, n);
        free(sums);
        sums = above;
        halve(n);
    }
    free(sums);
}

/// SUNC ///

static size_t sun_bytes(const struct source *s, int log2)
{
    return SUN_HEAD + (cell_count(s) * 512 >> 3 * log2);
}

/* 32 times the integral from the point in the middle of the eight voxels from
 * (x,y,z) on, along +y: trilinear, so 1/8 and 7/8 of the first two voxels of
 * four columns, and all of the others. */
static uint64_t depth_along_y(const struct source *s, int x, int y, int z)
{
    uint64_t sum = 0;
    for (int i = 0; i < 4; i++) {
        int u = x + i % 2, w = z + i / 2;
        sum += voxel_at(s, u, y, w) + 7u * voxel_at(s, u, y + 1, w);
        for (int v = y + 2; v < 8 * s->cells[1]; v++)
            sum += 8u * voxel_at(s, u, v, w);
    }
    return sum;
}

/* The depths at which the next code begins: 2^((2q + 1) / 48) - 1 units. */
static void code_limits(uint64_t most, uint64_t limit[255])
{
    uint64_t one = (uint64_t)1 << 32, power = one + HALF_CODE;
    for (int q = 0; q < 255; q++) {
        limit[q] = ((power - one) >> 12) * most / DEPTH_OF_255;
        for (int i = 0; i < 2; i++)
            power += (power >> 12) * HALF_CODE >> 20;
    }
}

/* most / (32 * 65280 * (2^(255/24) - 1)) of density_max; most < 2^31. */
static void put_unit(const struct source *s, uint64_t most, uint8_t *out)
{
    uint64_t m = most * asset_get32(s->asset + BRUME_OFF_DENSITY_MAX);
    int32_t e = (int32_t)asset_get32(s->asset + BRUME_OFF_DENSITY_MAX + 4);
    if (m == 0)
        return;
    for (; m < (uint64_t)1 << 62; m <<= 1)
        e--;
    m = m / DEPTH_OF_255 / 255; /* 32 * 65280 = 255 * 2^13 */
    for (; m < 0x80000000u; m <<= 1)
        e--;
    asset_put32(out, (uint32_t)m);
    asset_put32(out + 4, (uint32_t)(e + 20 - 13));
}

static void put_sun(const struct source *s, int log2, uint8_t *out)
{
    size_t count = sun_bytes(s, log2) - SUN_HEAD;
    uint64_t *depth = get_memory(count * sizeof *depth), most = 0, limit[255];
    int n[3], width = 1 << log2;
    for (int i = 0; i < 3; i++)
        n[i] = 8 * s->cells[i] >> log2;
    for (size_t i = 0; i < count; i++) {
        int p[3] = {(int)i % n[0], (int)i / n[0] % n[1], (int)i / n[0] / n[1]};
        for (int k = 0; k < 3; k++)
            p[k] = p[k] * width + width / 2 - 1;
        depth[i] = depth_along_y(s, p[0], p[1], p[2]);
        most = depth[i] > most ? depth[i] : most;
    }
    out[0] = (uint8_t)log2;
    asset_put32(out + 8, 0x40000000u); /* +y */
    put_unit(s, most, out + 16);
    code_limits(most, limit);
    for (size_t i = 0; i < count; i++)
        while (most > 0 && out[SUN_HEAD + i] < 255 &&
               depth[i] > limit[out[SUN_HEAD + i]])
            out[SUN_HEAD + i]++;
    free(depth);
}

/// AMBI ///

static size_t sky_bytes(const struct source *s)
{
    return SKY_HEAD + cell_count(s);
}

static void put_sky(const struct source *s, uint8_t *out)
{
    asset_put32(out, 0x80000000u); /* an extinction of 1/2 */
    asset_put32(out + 4, (uint32_t)-32);
    for (size_t i = 0; i < cell_count(s); i++) {
        uint32_t cell = asset_get32(s->cell + 4 * i);
        uint32_t sum =
            cell & BRUME_CELL_EMPTY ? 0 : brick_sum(s, cell, 0, 0, 0, 8);
        out[SKY_HEAD + i] = (uint8_t)(255u - sum / 512 * 200 / 65280);
    }
}

/// Blob ///

/* Makes room for more entries and moves what follows them. */
static uint8_t *with_entries(uint8_t *asset, size_t *size, uint32_t more)
{
    uint32_t old = asset[BRUME_OFF_SECTIONS];
    size_t from = end_of_entries(old), to = end_of_entries(old + more);
    uint8_t *p = get_memory(*size + to - from);
    memcpy(p, asset, BRUME_HEADER_BYTES + BRUME_SECTION_BYTES * old);
    memcpy(p + to, asset + from, *size - from);
    free(asset);
    for (uint32_t i = 0; i < old; i++) {
        uint8_t *e = p + BRUME_HEADER_BYTES + BRUME_SECTION_BYTES * i + 4;
        asset_put32(e, asset_get32(e) + (uint32_t)(to - from));
    }
    *size += to - from;
    return p;
}

/* Appends a section of zeros in the next entry. */
static uint8_t *append(uint8_t *asset, size_t *size, uint32_t id, size_t bytes)
{
    uint32_t n = asset[BRUME_OFF_SECTIONS]++;
    size_t at = aligned(*size);
    uint8_t *p = realloc(asset, at + bytes);
    if (p == NULL)
        abort();
    memset(p + *size, 0, at + bytes - *size);
    uint8_t *e = p + BRUME_HEADER_BYTES + BRUME_SECTION_BYTES * n;
    asset_put32(e, id);
    asset_put32(e + 4, (uint32_t)at);
    asset_put32(e + 8, (uint32_t)bytes);
    *size = at + bytes;
    return p;
}

uint8_t *asset_add_light(uint8_t *asset, size_t *size,
                         const struct asset_light *what)
{
    bool sun = what->spacing_log2 > 0;
    uint8_t *p =
        with_entries(asset, size, (uint32_t)(what->mips + sun + what->sky));
    struct source s = source_of(p);
    if (what->mips)
        p = append(p, size, BRUME_SECTION_MIPS, mip_bytes(&s));
    if (sun)
        p = append(p, size, BRUME_SECTION_SUNC,
                   sun_bytes(&s, what->spacing_log2));
    if (what->sky)
        p = append(p, size, BRUME_SECTION_AMBI, sky_bytes(&s));
    s = source_of(p);
    if (what->mips)
        put_mips(&s, p + asset_section(p, BRUME_SECTION_MIPS));
    if (sun)
        put_sun(&s, what->spacing_log2,
                p + asset_section(p, BRUME_SECTION_SUNC));
    if (what->sky)
        put_sky(&s, p + asset_section(p, BRUME_SECTION_AMBI));
    asset_put16(p + BRUME_OFF_MINOR, 1);
    asset_put32(p + BRUME_OFF_SIZE, (uint32_t)*size);
    asset_seal(p, *size);
    return p;
}

/// EMIT ///

static uint8_t emission_code(uint32_t brick, uint32_t voxel)
{
    uint32_t h = brick * 0x9e3779b1u + voxel * 0x85ebca6bu;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h ^= h >> 13;
    return h >> 30 ? (uint8_t)(h >> 8) : 0;
}

uint8_t *asset_add_emission(uint8_t *asset, size_t *size, uint32_t value_m,
                            int32_t value_e)
{
    uint32_t bricks = asset_get32(asset + BRUME_OFF_BRICKS);
    uint8_t *p = with_entries(asset, size, 1);
    p = append(p, size, BRUME_SECTION_EMIT, 16u + (size_t)512 * bricks);
    uint8_t *out = p + asset_section(p, BRUME_SECTION_EMIT);
    asset_put32(out, value_m);
    asset_put32(out + 4, (uint32_t)value_e);
    for (uint32_t i = 0; i < 512 * bricks; i++)
        out[16 + i] = emission_code(i / 512, i % 512);
    asset_put16(p + BRUME_OFF_MINOR, 2);
    asset_put32(p + BRUME_OFF_SIZE, (uint32_t)*size);
    asset_seal(p, *size);
    return p;
}
