/* SPDX-License-Identifier: MIT */
/*
 * brume_volume_open against docs/SPEC.md: what is good opens, each rule that
 * is broken gets its own error code, and whatever opens can be rendered.
 *
 * Bytes are opened in heap blocks of exactly their size, so that a sanitizer
 * sees the first read beyond them. The random numbers are always the same.
 */
#include "tap.h"

#include "brume.h"
#include "support/asset_builder.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#define FLIPS 10000
#define FRAME_W 16
#define FRAME_H 12
#define PIXEL_BYTES 6 /* of the widest pixel format */
#define ENTRY(i) (BRUME_HEADER_BYTES + BRUME_SECTION_BYTES * (uint32_t)(i))

struct blob {
    uint8_t *p;
    size_t size;
};

static const char *const k_format[] = {"", "u8", "u8r", "u4r"};
static const struct density_cloud k_cloud = {24, 7};

/* Set when a failed open leaves anything in the volume. */
static bool left_dirty;

/// Helpers ///

static void *get_memory(size_t n)
{
    void *p = malloc(n ? n : 1);
    if (p == NULL)
        abort();
    return p;
}

static uint32_t next_random(uint32_t *seed)
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 17;
    *seed ^= *seed << 5;
    return *seed;
}

static struct blob make(int x, int y, int z, int format, bool apron,
                        density_fn *density, const void *context)
{
    struct asset_spec spec = asset_spec_of(x, y, z, format, density, context);
    struct blob b;
    spec.apron = apron;
    b.p = asset_build(&spec, &b.size);
    return b;
}

/* 3x3x3 cells of a cloud. */
static struct blob make_cloud(int format, bool apron)
{
    return make(3, 3, 3, format, apron, density_in_cloud, &k_cloud);
}

static struct blob copy_of(const struct blob *b)
{
    struct blob copy = {get_memory(b->size), b->size};
    memcpy(copy.p, b->p, b->size);
    return copy;
}

/* Seals what the header calls its size, as the core will check it. */
static void seal(struct blob *b)
{
    uint32_t size = asset_get32(b->p + BRUME_OFF_SIZE);
    if (size >= BRUME_OFF_FORMAT && size <= b->size)
        asset_seal(b->p, size);
}

static void put(struct blob *b, uint32_t at, int bytes, uint32_t value)
{
    if (bytes == 4)
        asset_put32(b->p + at, value);
    else if (bytes == 2)
        asset_put16(b->p + at, value);
    else
        b->p[at] = (uint8_t)value;
}

static int open_volume(struct brume_volume *v, const void *p, size_t n,
                       unsigned flags)
{
    static const struct brume_volume k_none;
    memset(v, 0xa5, sizeof *v);
    int error = brume_volume_open(v, p, n, flags);
    if (error && memcmp(v, &k_none, sizeof *v) != 0)
        left_dirty = true;
    return error;
}

static int open_code(const struct blob *b, unsigned flags)
{
    struct brume_volume v;
    return open_volume(&v, b->p, b->size, flags);
}

/* The code for a copy of an asset in which one number is another. */
static int code_with(const struct blob *good, uint32_t at, int bytes,
                     uint32_t value)
{
    struct blob b = copy_of(good);
    put(&b, at, bytes, value);
    seal(&b);
    int code = open_code(&b, 0);
    free(b.p);
    return code;
}

/// Good assets ///

static void test_view(const struct blob *b, int format, bool apron)
{
    struct brume_volume v;
    const uint32_t plain = format == BRUME_U4R ? 256 : 512;
    const uint32_t wide = format == BRUME_U4R ? 368 : 732;
    bool good = open_volume(&v, b->p, b->size, 0) == BRUME_OK;
    const uint8_t *cells = b->p + asset_section(b->p, BRUME_SECTION_CELL);
    const uint8_t *ranges = b->p + asset_section(b->p, BRUME_SECTION_RNGE);
    good = good && v.format == format && v.side == (apron ? 9 : 8) &&
           v.brick_bytes == (apron ? wide : plain) && v.size == b->size &&
           v.bricks == asset_get32(b->p + BRUME_OFF_BRICKS) &&
           v.voxels == asset_get32(b->p + BRUME_OFF_VOXELS) && v.voxels > 0 &&
           v.density_max.m == 0x80000000u && v.density_max.e == -31;
    for (int i = 0; good && i < 3; i++)
        good = v.cell_count[i] == 3 && v.box_min[i] >= 1 && v.box_max[i] < 23;
    good = good && v.asset == b->p && (const uint8_t *)v.cells == cells &&
           v.pool == b->p + asset_section(b->p, BRUME_SECTION_POOL);
    good = good && (format == BRUME_U8 ? v.ranges == NULL
                                       : (const uint8_t *)v.ranges == ranges);
    tap_check(good, "%s%s opens, and the view says what was built",
              k_format[format], apron ? " with apron" : "");
}

static void test_bytes_at_hand(const struct blob *b)
{
    struct brume_volume v;
    uint8_t *room = get_memory(b->size + 8);
    memcpy(room, b->p, b->size);
    memset(room + b->size, 0xff, 8);
    tap_check(open_volume(&v, room, b->size + 8, 0) == BRUME_OK &&
                  v.size == b->size,
              "bytes after the asset are ignored");
    memmove(room + 4, room, b->size);
    tap_check(open_volume(&v, room + 4, b->size, 0) == BRUME_OK,
              "a boundary of 4 bytes will do");
    for (unsigned i = 1; i < 4; i++) {
        memmove(room + i, b->p, b->size);
        tap_check(open_volume(&v, room + i, b->size, 0) == BRUME_ERR_ALIGN,
                  "an address 4k+%u is refused", i);
    }
    free(room);
}

static void test_null(const struct blob *b)
{
    struct brume_volume v;
    tap_check(brume_volume_open(NULL, b->p, b->size, 0) == BRUME_ERR_NULL,
              "no volume to fill: NULL");
    tap_check(open_volume(&v, NULL, b->size, 0) == BRUME_ERR_NULL,
              "no asset: NULL");
}

static void test_error_texts(void)
{
    bool good = true;
    for (int e = BRUME_ERR_STATE; e <= BRUME_OK; e++)
        for (int f = BRUME_ERR_STATE - 1; f < e; f++)
            good = good && brume_error_text(e) && brume_error_text(f) &&
                   strcmp(brume_error_text(e), brume_error_text(f)) != 0;
    good = good && brume_error_text(INT_MIN) && brume_error_text(INT_MAX);
    tap_check(good, "each error code has a text of its own, others one too");
}

/// Checksum ///

static void test_crc(const struct blob *good)
{
    /* The check value of every catalogue of CRCs, at byte 16. */
    uint8_t text[] = "................123456789";
    tap_check(brume_asset_crc(text, 25) == 0xcbf43926u,
              "the checksum is the CRC-32 of PNG");

    bool all_refused = true, all_taken = true;
    struct blob b = copy_of(good);
    for (int bit = 0; bit < 32; bit++) {
        uint8_t *byte = b.p + BRUME_OFF_CRC + bit / 8;
        *byte = (uint8_t)(*byte ^ 1u << bit % 8);
        all_refused = all_refused && open_code(&b, 0) == BRUME_ERR_CRC;
        all_taken = all_taken && open_code(&b, BRUME_OPEN_NO_CRC) == BRUME_OK;
        *byte = (uint8_t)(*byte ^ 1u << bit % 8);
    }
    tap_check(all_refused, "a checksum with any bit wrong: CRC");
    tap_check(all_taken, "and BRUME_OPEN_NO_CRC does not look at it");

    const size_t at[] = {16, 28, 80, good->size / 2, good->size - 1};
    all_refused = true;
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        b.p[at[i]] ^= 1;
        all_refused = all_refused && open_code(&b, 0) == BRUME_ERR_CRC;
        b.p[at[i]] ^= 1;
    }
    tap_check(all_refused, "the checksum covers the first and the last byte");
    free(b.p);
}

/// Header ///

struct field {
    const char *what;
    uint32_t at;
    int bytes;
    uint32_t value;
    int code;
};

/* Of an asset of 3x3x3 cells, u8r, side 8, with three sections. */
static const struct field k_fields[] = {
    {"magic of another kind", 0, 1, 'b', BRUME_ERR_MAGIC},
    {"magic, last byte", 3, 1, 'F', BRUME_ERR_MAGIC},
    {"major 0", BRUME_OFF_MAJOR, 2, 0, BRUME_ERR_VERSION},
    {"major 2", BRUME_OFF_MAJOR, 2, 2, BRUME_ERR_VERSION},
    {"major 257", BRUME_OFF_MAJOR, 2, 257, BRUME_ERR_VERSION},
    {"minor 1", BRUME_OFF_MINOR, 2, 1, BRUME_OK},
    {"minor 65535", BRUME_OFF_MINOR, 2, 65535, BRUME_OK},
    {"size 0", BRUME_OFF_SIZE, 4, 0, BRUME_ERR_HEADER},
    {"size below the header", BRUME_OFF_SIZE, 4, 175, BRUME_ERR_HEADER},
    {"size below the entries", BRUME_OFF_SIZE, 4, 223, BRUME_ERR_HEADER},
    {"size 2^32-1", BRUME_OFF_SIZE, 4, UINT32_MAX, BRUME_ERR_TRUNCATED},
    {"format 0", BRUME_OFF_FORMAT, 1, 0, BRUME_ERR_HEADER},
    {"format 4", BRUME_OFF_FORMAT, 1, 4, BRUME_ERR_HEADER},
    {"format 255", BRUME_OFF_FORMAT, 1, 255, BRUME_ERR_HEADER},
    {"format u8, but with RNGE", BRUME_OFF_FORMAT, 1, 1, BRUME_ERR_SECTION},
    {"format u4r, POOL of u8r", BRUME_OFF_FORMAT, 1, 3, BRUME_ERR_SECTION},
    {"side 0", BRUME_OFF_SIDE, 1, 0, BRUME_ERR_HEADER},
    {"side 7", BRUME_OFF_SIDE, 1, 7, BRUME_ERR_HEADER},
    {"side 10", BRUME_OFF_SIDE, 1, 10, BRUME_ERR_HEADER},
    {"side 9, POOL of 8", BRUME_OFF_SIDE, 1, 9, BRUME_ERR_SECTION},
    {"0 sections", BRUME_OFF_SECTIONS, 2, 0, BRUME_ERR_HEADER},
    {"1 section", BRUME_OFF_SECTIONS, 2, 1, BRUME_ERR_HEADER},
    {"33 sections", BRUME_OFF_SECTIONS, 2, 33, BRUME_ERR_HEADER},
    {"65535 sections", BRUME_OFF_SECTIONS, 2, 65535, BRUME_ERR_HEADER},
    {"RNGE not listed", BRUME_OFF_SECTIONS, 2, 2, BRUME_ERR_SECTION},
    {"cells x 0", 20, 2, 0, BRUME_ERR_HEADER},
    {"cells y 0", 22, 2, 0, BRUME_ERR_HEADER},
    {"cells z 0", 24, 2, 0, BRUME_ERR_HEADER},
    {"cells x 4096", 20, 2, 4096, BRUME_ERR_HEADER},
    {"cells y 4096", 22, 2, 4096, BRUME_ERR_HEADER},
    {"cells z 65535", 24, 2, 65535, BRUME_ERR_HEADER},
    {"cells z 4, CELL of 3", 24, 2, 4, BRUME_ERR_SECTION},
    {"first zero, low byte", 26, 1, 1, BRUME_ERR_HEADER},
    {"first zero, high byte", 27, 1, 128, BRUME_ERR_HEADER},
    {"any origin", BRUME_OFF_ORIGIN + 4, 4, 0x80000000u, BRUME_OK},
    {"box_min above box_max, x", 40, 2, 23, BRUME_ERR_HEADER},
    {"box_min above box_max, y", 42, 2, 23, BRUME_ERR_HEADER},
    {"box_min above box_max, z", 44, 2, 65535, BRUME_ERR_HEADER},
    {"box_max beyond the pool, x", 46, 2, 24, BRUME_ERR_HEADER},
    {"box_max beyond the pool, y", 48, 2, 24, BRUME_ERR_HEADER},
    {"box_max beyond the pool, z", 50, 2, 65535, BRUME_ERR_HEADER},
    {"box_max the last voxel", 46, 2, 23, BRUME_OK},
    {"0 bricks, but a POOL", BRUME_OFF_BRICKS, 4, 0, BRUME_ERR_SECTION},
    {"2^32-1 bricks", BRUME_OFF_BRICKS, 4, UINT32_MAX, BRUME_ERR_SECTION},
    {"density_max m 1", 56, 4, 1, BRUME_ERR_HEADER},
    {"density_max m 2^31-1", 56, 4, 0x7fffffffu, BRUME_ERR_HEADER},
    {"density_max e -1025", 60, 4, (uint32_t)-1025, BRUME_ERR_HEADER},
    {"density_max e 992", 60, 4, 992, BRUME_ERR_HEADER},
    {"density_max e -2^31", 60, 4, 0x80000000u, BRUME_ERR_HEADER},
    {"density_max e -1024", 60, 4, (uint32_t)-1024, BRUME_OK},
    {"density_max e 991", 60, 4, 991, BRUME_OK},
    {"density_max 0", 56, 4, 0, BRUME_OK},
    {"density_mean m 2^31-1", 64, 4, 0x7fffffffu, BRUME_ERR_HEADER},
    {"density_mean e -1025", 68, 4, (uint32_t)-1025, BRUME_ERR_HEADER},
    {"density_mean e 992", 68, 4, 992, BRUME_ERR_HEADER},
    {"density_mean 0", 64, 4, 0, BRUME_OK},
    {"any count of voxels", BRUME_OFF_VOXELS, 4, UINT32_MAX, BRUME_OK},
    {"second zero, low byte", 76, 1, 1, BRUME_ERR_HEADER},
    {"second zero, high byte", 79, 1, 128, BRUME_ERR_HEADER},
    {"a world of NaN", BRUME_OFF_WORLD + 4, 4, 0x7ff80000u, BRUME_OK},
};

static void test_header(const struct blob *good)
{
    for (size_t i = 0; i < sizeof k_fields / sizeof *k_fields; i++) {
        const struct field *f = &k_fields[i];
        int code = code_with(good, f->at, f->bytes, f->value);
        tap_check(code == f->code, "header, %s: %s", f->what,
                  brume_error_text(code));
    }
    uint32_t size = (uint32_t)good->size;
    tap_check(code_with(good, BRUME_OFF_SIZE, 4, size + 1) ==
                  BRUME_ERR_TRUNCATED,
              "header, size one byte beyond those at hand: truncated");
    uint32_t bricks = asset_get32(good->p + BRUME_OFF_BRICKS);
    for (int d = -1; d <= 1; d += 2)
        tap_check(code_with(good, BRUME_OFF_BRICKS, 4, bricks + (uint32_t)d) ==
                      BRUME_ERR_SECTION,
                  "header, bricks%+d, POOL of bricks: section", d);
}

/* Products that are right only modulo 2^32. */
static void test_products(const struct blob *good)
{
    struct blob b = copy_of(good);
    const uint16_t cells[3] = {2048, 2048, 1024};
    uint32_t bricks = asset_get32(good->p + BRUME_OFF_BRICKS);
    tap_check(code_with(good, BRUME_OFF_BRICKS, 4, bricks + (1u << 23)) ==
                  BRUME_ERR_SECTION,
              "bricks * 512 is not taken modulo 2^32");
    for (int i = 0; i < 3; i++)
        put(&b, BRUME_OFF_CELLS + 2 * (uint32_t)i, 2, cells[i]);
    put(&b, ENTRY(0) + 8, 4, 0);
    seal(&b);
    tap_check(open_code(&b, 0) == BRUME_ERR_SECTION,
              "cells are not multiplied modulo 2^32");
    free(b.p);
}

static uint32_t one_voxel(int x, int y, int z, const void *context)
{
    const int *at = context;
    return x == at[0] && y == at[1] && z == at[2] ? 65280 : 0;
}

/* The largest number of cells, along each axis. */
static void test_long_pools(void)
{
    const int voxel[3] = {4, 4, 4};
    for (int axis = 0; axis < 3; axis++) {
        int n[3] = {1, 1, 1};
        n[axis] = BRUME_MAX_CELLS;
        struct blob b =
            make(n[0], n[1], n[2], BRUME_U8, false, one_voxel, voxel);
        tap_check(open_code(&b, 0) == BRUME_OK, "4095 cells along %c open",
                  'x' + axis);
        free(b.p);
    }
}

/// Sections ///

struct entry {
    const char *what;
    int entry;      /* 0 CELL, 1 POOL, 2 RNGE */
    uint32_t field; /* 0 id, 4 offset, 8 bytes, 12 zero */
    uint32_t value;
};

static void test_entries(const struct blob *good)
{
    const uint32_t size = (uint32_t)good->size;
    const uint32_t cell_bytes = asset_get32(good->p + ENTRY(0) + 8);
    const uint32_t pool_bytes = asset_get32(good->p + ENTRY(1) + 8);
    const uint32_t range_at = asset_get32(good->p + ENTRY(2) + 4);
    const uint32_t range_bytes = asset_get32(good->p + ENTRY(2) + 8);
    const struct entry entries[] = {
        {"no CELL", 0, 0, 0x41414141u},
        {"no POOL", 1, 0, 0x41414141u},
        {"no RNGE", 2, 0, 0x41414141u},
        {"CELL twice", 1, 0, BRUME_SECTION_CELL},
        {"POOL twice", 2, 0, BRUME_SECTION_POOL},
        {"offset 0", 0, 4, 0},
        {"offset in the header", 0, 4, 128},
        {"offset in the entries", 0, 4, 192},
        {"offset no multiple of 64", 2, 4, range_at - 4},
        {"offset beyond the end", 2, 4, (size + 63) / 64 * 64 + 64},
        {"offset that wraps", 2, 4, 0xffffffc0u},
        {"end beyond the end", 2, 4, range_at + 64},
        {"bytes that wrap", 1, 8, UINT32_MAX},
        {"CELL a byte short", 0, 8, cell_bytes - 1},
        {"CELL a word short", 0, 8, cell_bytes - 4},
        {"CELL a word long", 0, 8, cell_bytes + 4},
        {"POOL a byte short", 1, 8, pool_bytes - 1},
        {"POOL a byte long", 1, 8, pool_bytes + 1},
        {"POOL empty", 1, 8, 0},
        {"RNGE a byte short", 2, 8, range_bytes - 1},
        {"RNGE a word short", 2, 8, range_bytes - 4},
        {"zero of an entry", 1, 12, 1},
        {"zero of an entry, high bit", 2, 12, 0x80000000u},
    };
    for (size_t i = 0; i < sizeof entries / sizeof *entries; i++) {
        const struct entry *e = &entries[i];
        int code = code_with(good, ENTRY(e->entry) + e->field, 4, e->value);
        tap_check(code == BRUME_ERR_SECTION, "sections, %s: %s", e->what,
                  brume_error_text(code));
    }
}

/* The same asset with `n` entries, those new with ids of their own. */
static struct blob with_entries(const struct blob *good, uint32_t n)
{
    uint32_t old = good->p[BRUME_OFF_SECTIONS];
    uint32_t first = (ENTRY(n) + 63) / 64 * 64, move = first - 256;
    struct blob b = {get_memory(good->size + move), good->size + move};
    memset(b.p, 0, first);
    memcpy(b.p, good->p, ENTRY(old));
    memcpy(b.p + first, good->p + 256, good->size - 256);
    put(&b, BRUME_OFF_SIZE, 4, (uint32_t)b.size);
    put(&b, BRUME_OFF_SECTIONS, 2, n);
    for (uint32_t i = 0; i < old; i++)
        put(&b, ENTRY(i) + 4, 4, asset_get32(b.p + ENTRY(i) + 4) + move);
    for (uint32_t i = old; i < n; i++) {
        put(&b, ENTRY(i), 4, 0x30305858u + (i << 16)); /* "XX.0" */
        put(&b, ENTRY(i) + 4, 4, first);
        put(&b, ENTRY(i) + 8, 4, i);
    }
    seal(&b);
    return b;
}

static void test_more_sections(const struct blob *good)
{
    struct blob b = with_entries(good, 4);
    tap_check(open_code(&b, 0) == BRUME_OK, "an unknown section is skipped");
    put(&b, BRUME_OFF_MINOR, 2, 9);
    seal(&b);
    tap_check(open_code(&b, 0) == BRUME_OK, "also under a later minor version");
    put(&b, ENTRY(3) + 4, 4, (uint32_t)(b.size + 63) / 64 * 64 + 64);
    seal(&b);
    tap_check(open_code(&b, 0) == BRUME_ERR_SECTION,
              "but not one that lies beyond the end");
    free(b.p);

    b = with_entries(good, 5);
    put(&b, ENTRY(4), 4, asset_get32(b.p + ENTRY(3)));
    seal(&b);
    tap_check(open_code(&b, 0) == BRUME_ERR_SECTION,
              "an unknown section must not occur twice");
    put(&b, ENTRY(4), 4, BRUME_SECTION_NAME);
    seal(&b);
    tap_check(open_code(&b, 0) == BRUME_OK, "a NAME may be there");
    free(b.p);

    b = with_entries(good, 32);
    tap_check(open_code(&b, 0) == BRUME_OK, "32 sections open");
    free(b.p);
    b = with_entries(good, 33);
    tap_check(open_code(&b, 0) == BRUME_ERR_HEADER, "33 sections do not");
    free(b.p);
}

/// Cells ///

/* Five cells in a row, the middle one full: 2 1 (brick 0) 1 2. */
static struct blob make_row(void)
{
    static const struct density_box k_box = {{16, 0, 0}, {24, 8, 8}, 65280};
    return make(5, 1, 1, BRUME_U8, false, density_in_box, &k_box);
}

static void test_cell_words(void)
{
    static const struct {
        const char *what;
        uint32_t word;
        int code;
    } k_words[] = {
        {"brick 0 of 1", 0, BRUME_OK},
        {"brick 1 of 1", 1, BRUME_ERR_CELL},
        {"brick 2^31-1", 0x7fffffffu, BRUME_ERR_CELL},
        {"distance 0", BRUME_CELL_EMPTY, BRUME_ERR_CELL},
        {"distance 256", BRUME_CELL_EMPTY | 256, BRUME_ERR_CELL},
        {"distance 1 and bit 8", BRUME_CELL_EMPTY | 257, BRUME_ERR_CELL},
        {"distance 1 and bit 30", 0xc0000001u, BRUME_ERR_CELL},
        {"all ones", UINT32_MAX, BRUME_ERR_CELL},
    };
    struct blob b = make_row();
    uint32_t at = asset_section(b.p, BRUME_SECTION_CELL);
    for (size_t i = 0; i < sizeof k_words / sizeof *k_words; i++)
        tap_check(code_with(&b, at + 8, 4, k_words[i].word) == k_words[i].code,
                  "a cell with %s: %s", k_words[i].what,
                  brume_error_text(k_words[i].code));
    free(b.p);

    b = make_cloud(BRUME_U8, false);
    at = asset_section(b.p, BRUME_SECTION_CELL);
    uint32_t bricks = asset_get32(b.p + BRUME_OFF_BRICKS);
    tap_check(code_with(&b, at + 4 * 13, 4, bricks - 1) == BRUME_OK &&
                  code_with(&b, at + 4 * 13, 4, bricks) == BRUME_ERR_CELL,
              "a cell may name the last of %lu bricks, not the next",
              (unsigned long)bricks);
    free(b.p);
}

/* Distance of a cell as its word says, 0 with a brick. */
static int distance_at(const uint8_t *cells, const int n[3], int x, int y,
                       int z)
{
    uint32_t word = asset_get32(cells + 4 * (x + n[0] * (y + n[1] * z)));
    return word & BRUME_CELL_EMPTY ? (int)(word & 255) : 0;
}

/* SPEC.md's rule, cell by cell. */
static bool is_lipschitz(const uint8_t *cells, const int n[3])
{
    for (int i = 0; i < 27 * n[0] * n[1] * n[2]; i++) {
        int c = i / 27, k = i % 27;
        int x = c % n[0], y = c / n[0] % n[1], z = c / n[0] / n[1];
        int u = x + k % 3 - 1, v = y + k / 3 % 3 - 1, w = z + k / 9 - 1;
        if (u < 0 || v < 0 || w < 0 || u >= n[0] || v >= n[1] || w >= n[2])
            continue;
        int d = distance_at(cells, n, x, y, z);
        if (abs(d - distance_at(cells, n, u, v, w)) > 1)
            return false;
    }
    return true;
}

/* Every distance in the place of every cell's word. */
static void test_distances(void)
{
    static const int n[3] = {6, 5, 4};
    static const struct density_box k_box = {{8, 8, 8}, {12, 12, 12}, 9000};
    struct blob b =
        make(n[0], n[1], n[2], BRUME_U8, false, density_in_box, &k_box);
    uint8_t *cells = b.p + asset_section(b.p, BRUME_SECTION_CELL);
    bool agree = true;
    int near = 0, far = 0; /* refused, by a distance one too small or large */
    for (int i = 0; i < n[0] * n[1] * n[2]; i++) {
        uint32_t word = asset_get32(cells + 4 * i);
        for (uint32_t d = 1; d < 256; d++) {
            asset_put32(cells + 4 * i, BRUME_CELL_EMPTY | d);
            int want = is_lipschitz(cells, n) ? BRUME_OK : BRUME_ERR_DISTANCE;
            agree = agree && open_code(&b, BRUME_OPEN_NO_CRC) == want;
            near += want && (word & BRUME_CELL_EMPTY) && d + 1 == (word & 255);
            far += want && (word & BRUME_CELL_EMPTY) && d - 1 == (word & 255);
        }
        asset_put32(cells + 4 * i, word);
    }
    tap_check(agree, "any distance in any cell: what the rule says");
    tap_check(near > 0 && far > 0,
              "among those refused, distances one too small (%d) and one too "
              "large (%d)",
              near, far);
    free(b.p);
}

/// Ranges ///

static void test_ranges(int format)
{
    const uint32_t top = format == BRUME_U4R ? 15 : 255;
    struct blob b = make_cloud(format, false);
    uint32_t first = asset_section(b.p, BRUME_SECTION_RNGE);
    uint32_t last = first + 4 * (asset_get32(b.p + BRUME_OFF_BRICKS) - 1);
    const uint32_t full = (65280 / top) << 16;
    const uint32_t good[] = {full, 65280, 0, (full - 0x10000) | top};
    const uint32_t bad[] = {full | 1, 65281, UINT32_MAX, full + 0x10000,
                            (full - 0x10000) | (top + 1)};
    bool all_taken = true, all_refused = true;
    for (size_t i = 0; i < sizeof good / sizeof *good; i++)
        all_taken = all_taken && code_with(&b, first, 4, good[i]) == BRUME_OK &&
                    code_with(&b, last, 4, good[i]) == BRUME_OK;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        all_refused = all_refused &&
                      code_with(&b, first, 4, bad[i]) == BRUME_ERR_RANGE &&
                      code_with(&b, last, 4, bad[i]) == BRUME_ERR_RANGE;
    tap_check(all_taken, "%s ranges up to 65280 open", k_format[format]);
    tap_check(all_refused, "%s ranges from 65281 on do not", k_format[format]);
    free(b.p);
}

/// Empty volumes ///

static uint32_t no_density(int x, int y, int z, const void *context)
{
    (void)x, (void)y, (void)z, (void)context;
    return 0;
}

static bool is_background(const struct brume_volume *v, int filter)
{
    struct brume_scene scene;
    struct brume_frame frame;
    uint16_t pixel[FRAME_W * FRAME_H];
    brume_scene_default(&scene, v);
    scene.width = FRAME_W;
    scene.height = FRAME_H;
    scene.filter = (uint8_t)filter;
    scene.output = BRUME_LINEAR;
    scene.background[0] = 12345;
    if (brume_begin_frame(&frame, v, &scene) != BRUME_OK ||
        brume_render_rect(&frame, 0, 0, FRAME_W, FRAME_H, BRUME_L16, pixel,
                          FRAME_W * sizeof *pixel) != BRUME_OK)
        return false;
    for (int i = 0; i < FRAME_W * FRAME_H; i++)
        if (pixel[i] != 12345)
            return false;
    return true;
}

static void test_empty(int format, bool apron)
{
    struct blob b = make(2, 3, 2, format, apron, no_density, NULL);
    struct brume_volume v;
    bool good = open_volume(&v, b.p, b.size, 0) == BRUME_OK && v.bricks == 0;
    tap_check(good && is_background(&v, BRUME_NEAREST) &&
                  is_background(&v, BRUME_TRILINEAR),
              "%s%s without a brick opens, and shows the background",
              k_format[format], apron ? " with apron" : "");
    uint32_t at = asset_section(b.p, BRUME_SECTION_CELL);
    tap_check(code_with(&b, at, 4, 0) == BRUME_ERR_CELL,
              "and no cell of it may name brick 0");
    free(b.p);
}

/// Truncation ///

static int code_of_first(const struct blob *b, size_t n, bool patch_size,
                         unsigned flags)
{
    struct blob cut = {get_memory(n), n};
    memcpy(cut.p, b->p, n);
    if (patch_size && n >= BRUME_OFF_CRC + 4) {
        put(&cut, BRUME_OFF_SIZE, 4, (uint32_t)n);
        seal(&cut);
    }
    int code = open_code(&cut, flags);
    free(cut.p);
    return code;
}

static void test_truncation(int format, bool apron)
{
    static const struct density_box k_box = {{1, 1, 1}, {7, 7, 7}, 30000};
    struct blob b = make(1, 1, 1, format, apron, density_in_box, &k_box);
    bool as_it_is = true, unchecked = true, resized = true;
    for (size_t n = 0; n < b.size; n++) {
        as_it_is =
            as_it_is && code_of_first(&b, n, false, 0) == BRUME_ERR_TRUNCATED;
        unchecked =
            unchecked && code_of_first(&b, n, false, BRUME_OPEN_NO_CRC) ==
                             BRUME_ERR_TRUNCATED;
        resized = resized && code_of_first(&b, n, true, 0) != BRUME_OK;
    }
    tap_check(as_it_is && unchecked,
              "%s%s cut anywhere in its %zu bytes is truncated",
              k_format[format], apron ? " with apron" : "", b.size);
    tap_check(resized, "also refused when its size and checksum are set right");
    tap_check(code_of_first(&b, b.size, true, 0) == BRUME_OK,
              "and accepted when it is whole");
    free(b.p);
}

/// Damaged assets ///

static uint32_t hash3(int x, int y, int z)
{
    uint32_t h = (uint32_t)(x + 64 * (y + 64 * z)) * 0x9e3779b1u;
    h = (h ^ h >> 15) * 0x85ebca6bu;
    return h ^ h >> 13;
}

/* One cell in five is full, up to its faces: much to leap over, and every
 * leap a voxel too far would show. */
static uint32_t sparse(int x, int y, int z, const void *context)
{
    (void)context;
    if (hash3(x >> 3, y >> 3, z >> 3) % 5 != 0)
        return 0;
    return 20000 + hash3(x, y, z) % 40000;
}

static struct blob make_sparse(int format, bool apron)
{
    return make(5, 4, 4, format, apron, sparse, NULL);
}

struct tally {
    unsigned opened, refused, unsealed;
    unsigned rendered, inside, clamped, trilinear;
    unsigned scenes_refused, skips_differ;
};

/* Somewhere around the box, or in the pool. */
static void move_camera(struct brume_scene *s, const struct brume_volume *v,
                        bool inside, uint32_t *seed)
{
    for (int i = 0; i < 3; i++) {
        uint32_t room = v->cell_count[i] * 8u << 16;
        int32_t at = (int32_t)(next_random(seed) % room);
        int32_t away = (int32_t)(next_random(seed) & 0x1fffff) - 0x100000;
        s->target[i] = at;
        s->eye[i] = inside ? at + away / 16 : at + 4 * away;
    }
    s->target[0]++; /* never the eye */
}

static struct brume_scene random_scene(const struct brume_volume *v,
                                       struct tally *tally, uint32_t *seed)
{
    struct brume_scene s;
    uint32_t r = next_random(seed);
    bool inside = r & 1, clamp = r & 2;
    brume_scene_default(&s, v);
    s.width = FRAME_W;
    s.height = FRAME_H;
    s.step = 0x8000u << (r >> 2 & 3);
    s.filter = r >> 4 & 1;
    s.light = (r >> 5 & 3) % 3;
    s.light_samples = r >> 7 & 7;
    s.light_step = 0x8000u << (r >> 10 & 3);
    s.jitter = r >> 12 & 3;
    s.noise = r >> 14 & 3;
    s.output = r >> 16 & 1;
    s.max_density = clamp ? next_random(seed) : 0;
    if (r >> 17 & 3)
        move_camera(&s, v, inside, seed);
    tally->inside += inside;
    tally->clamped += clamp;
    tally->trilinear += s.filter == BRUME_TRILINEAR;
    return s;
}

static int render(const struct brume_volume *v, const struct brume_scene *s,
                  int pixel_format, uint8_t *dst)
{
    struct brume_frame frame;
    int error = brume_begin_frame(&frame, v, s);
    if (!error)
        error =
            brume_render_rect(&frame, 0, 0, FRAME_W, FRAME_H, pixel_format, dst,
                              FRAME_W * brume_pixel_bytes(pixel_format));
    return error;
}

/* A volume that has opened: a random scene with skip on and off. */
static void render_both(const struct brume_volume *v, struct tally *tally,
                        uint32_t *seed)
{
    struct brume_scene s = random_scene(v, tally, seed);
    int format = (int)(next_random(seed) % 7);
    size_t bytes = FRAME_W * FRAME_H * (size_t)brume_pixel_bytes(format);
    uint8_t *leaping = get_memory(bytes), *walking = get_memory(bytes);
    s.skip = true;
    int error = render(v, &s, format, leaping);
    s.skip = false;
    if (error || render(v, &s, format, walking) != BRUME_OK)
        tally->scenes_refused++;
    else if (memcmp(leaping, walking, bytes) != 0)
        tally->skips_differ++;
    tally->rendered++;
    free(leaping);
    free(walking);
}

/* As it is, and without the checksum. */
static void try_damaged(const struct blob *b, struct tally *tally,
                        uint32_t *seed)
{
    struct brume_volume v;
    if (open_volume(&v, b->p, b->size, 0) == BRUME_OK)
        tally->unsealed++;
    if (open_volume(&v, b->p, b->size, BRUME_OPEN_NO_CRC) != BRUME_OK) {
        tally->refused++;
        return;
    }
    tally->opened++;
    render_both(&v, tally, seed);
}

/* 1 to 8 bits, anywhere, or in what comes before the pool. */
static void flip_bits(struct blob *b, uint32_t *seed)
{
    uint32_t n = next_random(seed) % 8 + 1;
    uint32_t pool = asset_get32(b->p + ENTRY(1) + 4);
    uint32_t room =
        next_random(seed) & 1 && pool < b->size ? pool : (uint32_t)b->size;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t bit = next_random(seed) % (8 * room);
        b->p[bit / 8] = (uint8_t)(b->p[bit / 8] ^ 1u << bit % 8);
    }
}

static void report(const char *what, const struct tally *t)
{
    tap_check(t->opened > 100 && t->refused > 100,
              "%s: %u open without the checksum, %u are refused", what,
              t->opened, t->refused);
    tap_check(t->rendered == t->opened && t->scenes_refused == 0 &&
                  t->inside > 10 && t->clamped > 10 && t->trilinear > 10,
              "%s: what opens is rendered (%u inside, %u clamped, %u "
              "trilinear)",
              what, t->inside, t->clamped, t->trilinear);
    tap_check(t->skips_differ == 0, "%s: skip on and off give the same", what);
}

static void test_flips(void)
{
    uint32_t seed = 0x2545f491u;
    struct tally tally = {0};
    struct blob good[6];
    for (int i = 0; i < 6; i++)
        good[i] = make_sparse(i / 2 + 1, i & 1);
    for (int i = 0; i < FLIPS; i++) {
        struct blob b = copy_of(&good[i % 6]);
        flip_bits(&b, &seed);
        try_damaged(&b, &tally, &seed);
        free(b.p);
    }
    for (int i = 0; i < 6; i++)
        free(good[i].p);
    report("10000 assets with bits flipped", &tally);
    tap_check(tally.unsealed < FLIPS / 50,
              "%u of them pass the checksum: flips that cancel, or of the "
              "minor version",
              tally.unsealed);
}

/* Garbage after a header that is good but for its size. With `keep` bytes of
 * the asset before the garbage, from none to all but the densities. */
static void try_garbage(const struct blob *good, size_t keep, size_t size,
                        struct tally *tally, uint32_t *seed)
{
    struct blob b = {get_memory(size), size};
    for (size_t i = 0; i < size; i++)
        b.p[i] = (uint8_t)next_random(seed);
    memcpy(b.p, good->p, keep < size ? keep : size);
    if (size >= BRUME_HEADER_BYTES)
        put(&b, BRUME_OFF_SIZE, 4, (uint32_t)size);
    try_damaged(&b, tally, seed);
    free(b.p);
}

static void test_garbage(void)
{
    uint32_t seed = 0x9e3779b9u;
    struct tally tally = {0};
    for (int i = 0; i < 6; i++) {
        struct blob good = make_sparse(i / 2 + 1, i & 1);
        size_t pool = asset_get32(good.p + ENTRY(1) + 4);
        for (size_t n = 0; n < 4096; n += 1 + n / 16)
            try_garbage(&good, BRUME_HEADER_BYTES, n, &tally, &seed);
        for (size_t n = 0; n < 4096; n += 1 + n / 16)
            try_garbage(&good, ENTRY(good.p[BRUME_OFF_SECTIONS]), n, &tally,
                        &seed);
        /* Ranges in random bytes rarely hold: keep those of u8r and u4r. */
        for (int k = 0; k < 40; k++) {
            struct blob b = copy_of(&good);
            size_t end = asset_section(b.p, BRUME_SECTION_RNGE);
            for (size_t at = pool; at < (end ? end : b.size); at++)
                b.p[at] = (uint8_t)next_random(&seed);
            try_damaged(&b, &tally, &seed);
            free(b.p);
        }
        free(good.p);
    }
    report("garbage behind a good header", &tally);
}

int main(void)
{
    for (int format = BRUME_U8; format <= BRUME_U4R; format++)
        for (int apron = 0; apron < 2; apron++) {
            struct blob b = make_cloud(format, apron);
            test_view(&b, format, apron);
            free(b.p);
            test_empty(format, apron);
            test_truncation(format, apron);
        }
    struct blob good = make_cloud(BRUME_U8R, false);
    test_bytes_at_hand(&good);
    test_null(&good);
    test_error_texts();
    test_crc(&good);
    test_header(&good);
    test_products(&good);
    test_entries(&good);
    test_more_sections(&good);
    free(good.p);
    test_long_pools();
    test_cell_words();
    test_distances();
    test_ranges(BRUME_U8R);
    test_ranges(BRUME_U4R);
    test_flips();
    test_garbage();
    tap_check(!left_dirty, "after every error the volume was all zero");
    return tap_done();
}
