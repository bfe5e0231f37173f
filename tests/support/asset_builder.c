/* SPDX-License-Identifier: MIT */
#include "asset_builder.h"

#include <stdlib.h>
#include <string.h>

#define UNITS 65280u

/// Bytes ///

void asset_put16(uint8_t *p, uint32_t value)
{
    p[0] = (uint8_t)value;
    p[1] = (uint8_t)(value >> 8);
}

void asset_put32(uint8_t *p, uint32_t value)
{
    asset_put16(p, value);
    asset_put16(p + 2, value >> 16);
}

uint32_t asset_get32(const uint8_t *p)
{
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 |
           (uint32_t)p[3] << 24;
}

static void put_f64(uint8_t *p, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    asset_put32(p, (uint32_t)bits);
    asset_put32(p + 4, (uint32_t)(bits >> 32));
}

static void *get_memory(size_t n)
{
    void *p = calloc(n ? n : 1, 1);
    if (p == NULL)
        abort();
    return p;
}

void asset_seal(uint8_t *asset, size_t size)
{
    asset_put32(asset + BRUME_OFF_CRC, brume_asset_crc(asset, (uint32_t)size));
}

uint32_t asset_section(const uint8_t *asset, uint32_t id)
{
    const uint8_t *entry = asset + BRUME_HEADER_BYTES;
    for (int i = 0; i < asset[BRUME_OFF_SECTIONS]; i++, entry += 16)
        if (asset_get32(entry) == id)
            return asset_get32(entry + 4);
    return 0;
}

/// Bricks ///

/* What is being built. */
struct builder {
    const struct asset_spec *spec;
    int side, top;
    size_t brick_bytes, cells;
    uint32_t *cell;  /* words of CELL */
    uint8_t *pool;   /* room for a brick per cell */
    uint32_t *range; /* the same for RNGE */
    uint32_t bricks;
    uint64_t sum, voxels;
    int box_min[3], box_max[3];
};

static uint32_t density_in(const struct builder *b, int x, int y, int z)
{
    const int *n = b->spec->cells;
    if (x >= 8 * n[0] || y >= 8 * n[1] || z >= 8 * n[2])
        return 0;
    uint32_t d = b->spec->density(x, y, z, b->spec->context);
    if (d > UNITS)
        abort();
    return b->spec->format == BRUME_U8 ? (d + 128) / 256 * 256 : d;
}

static void note_voxel(struct builder *b, const int p[3], uint32_t d)
{
    if (d == 0)
        return;
    for (int i = 0; i < 3; i++) {
        if (b->voxels == 0 || p[i] < b->box_min[i])
            b->box_min[i] = p[i];
        if (b->voxels == 0 || p[i] > b->box_max[i])
            b->box_max[i] = p[i];
    }
    b->voxels++;
    b->sum += d;
}

/* Densities of a cell's brick; true when one is not zero. */
static bool gather(struct builder *b, const int cell[3], uint32_t *d)
{
    bool any = false;
    for (int z = 0; z < b->side; z++)
        for (int y = 0; y < b->side; y++)
            for (int x = 0; x < b->side; x++, d++) {
                int p[3] = {8 * cell[0] + x, 8 * cell[1] + y, 8 * cell[2] + z};
                *d = density_in(b, p[0], p[1], p[2]);
                any = any || *d != 0;
                if (x < 8 && y < 8 && z < 8)
                    note_voxel(b, p, *d);
            }
    return any;
}

/* The tightest range that holds all densities: base | scale << 16. */
static uint32_t range_of(const struct builder *b, const uint32_t *d, int n)
{
    uint32_t low = UNITS, high = 0, top = (uint32_t)b->top;
    for (int i = 0; i < n; i++) {
        low = d[i] < low ? d[i] : low;
        high = d[i] > high ? d[i] : high;
    }
    if (b->spec->format == BRUME_U8)
        return 256u << 16;
    uint32_t scale = (high - low + top - 1) / top;
    if (scale == 0)
        scale = 1;
    if (low + top * scale > UNITS)
        low = UNITS - top * scale;
    return low | scale << 16;
}

static void encode(struct builder *b, const uint32_t *d)
{
    int n = b->side * b->side * b->side;
    uint32_t range = range_of(b, d, n), base = range & 0xffff;
    uint32_t scale = range >> 16;
    uint8_t *to = b->pool + b->bricks * b->brick_bytes;
    b->range[b->bricks] = range;
    for (int i = 0; i < n; i++) {
        uint32_t code = (d[i] - base + scale / 2) / scale;
        if (b->spec->format == BRUME_U4R)
            to[i / 2] |= (uint8_t)(code << (i & 1) * 4);
        else
            to[i] = (uint8_t)code;
    }
}

/* Stores the brick, or finds the same one among those before. */
static uint32_t store(struct builder *b, const uint32_t *d)
{
    uint8_t *to = b->pool + b->bricks * b->brick_bytes;
    memset(to, 0, b->brick_bytes);
    encode(b, d);
    for (uint32_t i = 0; i < b->bricks; i++)
        if (b->range[i] == b->range[b->bricks] &&
            memcmp(b->pool + i * b->brick_bytes, to, b->brick_bytes) == 0)
            return i;
    return b->bricks++;
}

static void make_bricks(struct builder *b)
{
    const int *n = b->spec->cells;
    uint32_t d[729];
    size_t i = 0;
    int c[3];
    for (c[2] = 0; c[2] < n[2]; c[2]++)
        for (c[1] = 0; c[1] < n[1]; c[1]++)
            for (c[0] = 0; c[0] < n[0]; c[0]++, i++)
                b->cell[i] =
                    gather(b, c, d) ? store(b, d) : BRUME_CELL_EMPTY | 255;
}

/* Distances by growing: round r reaches what touches distance r - 1. */
static void make_distances(struct builder *b)
{
    const int *n = b->spec->cells;
    bool changed = true;
    for (uint32_t r = 1; r < 255 && changed; r++) {
        changed = false;
        for (size_t i = 0; i < b->cells; i++) {
            int x = (int)(i % (size_t)n[0]);
            int y = (int)(i / (size_t)n[0] % (size_t)n[1]);
            int z = (int)(i / ((size_t)n[0] * (size_t)n[1]));
            if (b->cell[i] != (BRUME_CELL_EMPTY | 255))
                continue;
            for (int k = 0; k < 27; k++) {
                int u = x + k % 3 - 1, v = y + k / 3 % 3 - 1, w = z + k / 9 - 1;
                if (u < 0 || v < 0 || w < 0 || u >= n[0] || v >= n[1] ||
                    w >= n[2])
                    continue;
                uint32_t c = b->cell[u + n[0] * (v + n[1] * w)];
                uint32_t near = c & BRUME_CELL_EMPTY ? c & 255 : 0;
                if (near == r - 1) {
                    b->cell[i] = BRUME_CELL_EMPTY | r;
                    changed = true;
                }
            }
        }
    }
}

/// Blob ///

static size_t aligned(size_t n)
{
    return (n + 63) / 64 * 64;
}

static void put_entry(uint8_t *p, uint32_t i, uint32_t id, size_t offset,
                      size_t bytes)
{
    p += BRUME_HEADER_BYTES + 16 * i;
    asset_put32(p, id);
    asset_put32(p + 4, (uint32_t)offset);
    asset_put32(p + 8, (uint32_t)bytes);
}

static void put_header(const struct builder *b, uint8_t *p, size_t size)
{
    const struct asset_spec *s = b->spec;
    asset_put32(p, BRUME_MAGIC);
    asset_put16(p + BRUME_OFF_MAJOR, BRUME_ASSET_MAJOR);
    asset_put32(p + BRUME_OFF_SIZE, (uint32_t)size);
    p[BRUME_OFF_FORMAT] = (uint8_t)s->format;
    p[BRUME_OFF_SIDE] = (uint8_t)b->side;
    asset_put16(p + BRUME_OFF_SECTIONS, s->format == BRUME_U8 ? 2 : 3);
    for (int i = 0; i < 3; i++) {
        asset_put16(p + BRUME_OFF_CELLS + 2 * i, (uint32_t)s->cells[i]);
        asset_put16(p + BRUME_OFF_BOX_MIN + 2 * i, (uint32_t)b->box_min[i]);
        asset_put16(p + BRUME_OFF_BOX_MAX + 2 * i, (uint32_t)b->box_max[i]);
        put_f64(p + BRUME_OFF_WORLD + 40 * i, 1.0);
    }
    asset_put32(p + BRUME_OFF_BRICKS, b->bricks);
    asset_put32(p + BRUME_OFF_DENSITY_MAX, s->max_m);
    asset_put32(p + BRUME_OFF_DENSITY_MAX + 4, (uint32_t)s->max_e);
    if (b->voxels > 0) { /* mean in units, as a normalised number */
        uint32_t m = (uint32_t)(b->sum / b->voxels);
        int32_t e = s->max_e + 16;
        for (; m < 0x80000000u; m <<= 1)
            e--;
        asset_put32(p + BRUME_OFF_DENSITY_MEAN, m);
        asset_put32(p + BRUME_OFF_DENSITY_MEAN + 4, (uint32_t)e);
    }
    asset_put32(p + BRUME_OFF_VOXELS, (uint32_t)b->voxels);
}

static uint8_t *put_blob(const struct builder *b, size_t *size)
{
    bool ranged = b->spec->format != BRUME_U8;
    size_t cell_at = aligned(BRUME_HEADER_BYTES + (ranged ? 48 : 32));
    size_t pool_at = aligned(cell_at + 4 * b->cells);
    size_t pool_bytes = b->bricks * b->brick_bytes;
    size_t range_at = aligned(pool_at + pool_bytes);
    *size = ranged ? range_at + 4 * b->bricks : pool_at + pool_bytes;
    uint8_t *p = get_memory(*size);
    put_header(b, p, *size);
    put_entry(p, 0, BRUME_SECTION_CELL, cell_at, 4 * b->cells);
    put_entry(p, 1, BRUME_SECTION_POOL, pool_at, pool_bytes);
    for (size_t i = 0; i < b->cells; i++)
        asset_put32(p + cell_at + 4 * i, b->cell[i]);
    memcpy(p + pool_at, b->pool, pool_bytes);
    if (ranged)
        put_entry(p, 2, BRUME_SECTION_RNGE, range_at, 4 * b->bricks);
    for (uint32_t i = 0; ranged && i < b->bricks; i++)
        asset_put32(p + range_at + 4 * i, b->range[i]);
    asset_seal(p, *size);
    return p;
}

struct asset_spec asset_spec_of(int cells_x, int cells_y, int cells_z,
                                int format, density_fn *density,
                                const void *context)
{
    struct asset_spec spec = {{cells_x, cells_y, cells_z},
                              format,
                              false,
                              0x80000000u,
                              -31,
                              density,
                              context};
    return spec;
}

uint8_t *asset_build(const struct asset_spec *spec, size_t *size)
{
    struct builder b = {.spec = spec, .side = spec->apron ? 9 : 8};
    b.top = spec->format == BRUME_U4R ? 15 : 255;
    b.brick_bytes = spec->apron ? 732 : 512;
    if (spec->format == BRUME_U4R)
        b.brick_bytes = spec->apron ? 368 : 256;
    b.cells = (size_t)spec->cells[0] * (size_t)spec->cells[1] *
              (size_t)spec->cells[2];
    b.cell = get_memory(b.cells * sizeof *b.cell);
    b.pool = get_memory((b.cells + 1) * b.brick_bytes);
    b.range = get_memory((b.cells + 1) * sizeof *b.range);
    make_bricks(&b);
    make_distances(&b);
    uint8_t *blob = put_blob(&b, size);
    free(b.cell);
    free(b.pool);
    free(b.range);
    return blob;
}

/// Densities ///

uint32_t density_in_box(int x, int y, int z, const void *context)
{
    const struct density_box *b = context;
    const int p[3] = {x, y, z};
    for (int i = 0; i < 3; i++)
        if (p[i] < b->low[i] || p[i] >= b->high[i])
            return 0;
    return b->density;
}

static uint32_t hash3(uint32_t x, uint32_t y, uint32_t z, uint32_t seed)
{
    uint32_t h = x * 0x9e3779b1u + y * 0x85ebca77u + z * 0xc2b2ae3du + seed;
    h ^= h >> 15;
    h *= 0x2c1b3c6du;
    h ^= h >> 12;
    h *= 0x297a2d39u;
    return h ^ h >> 15;
}

/* Value noise on a lattice of 2^shift voxels, 0 .. 65535. */
static int64_t value_noise(int x, int y, int z, int shift, uint32_t seed)
{
    int64_t one = 1 << shift, sum = 0, p[3] = {x, y, z};
    for (int k = 0; k < 8; k++) {
        int64_t w = 1;
        uint32_t c[3];
        for (int i = 0; i < 3; i++) {
            int bit = k >> i & 1;
            c[i] = (uint32_t)((p[i] >> shift) + bit);
            int64_t f = p[i] & (one - 1);
            w *= bit ? f : one - f;
        }
        sum += w * (hash3(c[0], c[1], c[2], seed) >> 16);
    }
    return sum >> 3 * shift;
}

uint32_t density_in_cloud(int x, int y, int z, const void *context)
{
    const struct density_cloud *c = context;
    int64_t h = c->size / 2, dx = x - h, dy = y - h, dz = z - h;
    int64_t r = 65536 * (dx * dx + dy * dy + dz * dz) / (h * h);
    int64_t n = (8 * value_noise(x, y, z, 4, c->seed) +
                 5 * value_noise(x, y, z, 3, c->seed + 1) +
                 3 * value_noise(x, y, z, 1, c->seed + 2)) /
                16;
    int64_t d = n - r + 9000; /* ball minus distance squared */
    if (x < 1 || y < 1 || z < 1 || x > c->size - 2 || y > c->size - 2 ||
        z > c->size - 2 || d <= 0)
        return 0;
    /* Squared: thin veils around a dense core. */
    d = d * d >> 15;
    return (uint32_t)(d > 65280 ? 65280 : d);
}
