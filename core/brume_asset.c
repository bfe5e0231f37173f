/* SPDX-License-Identifier: MIT */
/* Checks an asset and makes the view of it. docs/SPEC.md is the definition. */
#include "brume_inner.h"

/// Bytes ///

static uint32_t get16(const uint8_t *p)
{
    return p[0] | (uint32_t)p[1] << 8;
}

static uint32_t get32(const uint8_t *p)
{
    return get16(p) | get16(p + 2) << 16;
}

static struct brume_number get_number(const uint8_t *p)
{
    struct brume_number n = {get32(p), as_signed(get32(p + 4))};
    return n;
}

uint32_t brume_asset_crc(const void *asset, uint32_t size)
{
    /* Four bits at a time: 64 bytes of table against 1 KiB. */
    static const uint32_t k_nibble[16] = {
        0x00000000u, 0x1db71064u, 0x3b6e20c8u, 0x26d930acu,
        0x76dc4190u, 0x6b6b51f4u, 0x4db26158u, 0x5005713cu,
        0xedb88320u, 0xf00f9344u, 0xd6d6a3e8u, 0xcb61b38cu,
        0x9b64c2b0u, 0x86d3d2d4u, 0xa00ae278u, 0xbdbdf21cu};
    const uint8_t *p = asset;
    uint32_t crc = 0xffffffffu;
    for (uint32_t i = BRUME_OFF_FORMAT; i < size; i++) {
        crc = k_nibble[(crc ^ p[i]) & 15u] ^ crc >> 4;
        crc = k_nibble[(crc ^ (uint32_t)p[i] >> 4) & 15u] ^ crc >> 4;
    }
    return ~crc;
}

/// Header ///

static int check_ident(const uint8_t *p, size_t size, unsigned flags)
{
    if (((uintptr_t)p & 3u) != 0)
        return BRUME_ERR_ALIGN;
    if (size < 4)
        return BRUME_ERR_TRUNCATED;
    if (get32(p) != BRUME_MAGIC)
        return BRUME_ERR_MAGIC;
    if (size < BRUME_OFF_MINOR)
        return BRUME_ERR_TRUNCATED;
    if (get16(p + BRUME_OFF_MAJOR) != BRUME_ASSET_MAJOR)
        return BRUME_ERR_VERSION;
    if (size < BRUME_HEADER_BYTES || size < get32(p + BRUME_OFF_SIZE))
        return BRUME_ERR_TRUNCATED;
    uint32_t sections = get16(p + BRUME_OFF_SECTIONS);
    if (sections < 2 || sections > BRUME_MAX_SECTIONS ||
        get32(p + BRUME_OFF_SIZE) <
            BRUME_HEADER_BYTES + sections * BRUME_SECTION_BYTES)
        return BRUME_ERR_HEADER;
    if (!(flags & BRUME_OPEN_NO_CRC) &&
        brume_asset_crc(p, get32(p + BRUME_OFF_SIZE)) !=
            get32(p + BRUME_OFF_CRC))
        return BRUME_ERR_CRC;
    return BRUME_OK;
}

static bool number_is_good(struct brume_number n)
{
    return n.m == 0 || (n.m >= 0x80000000u && n.e >= -1024 && n.e <= 991);
}

/* Bytes of a brick, or 0 for a format or side that is none. */
static uint32_t brick_bytes(uint32_t format, uint32_t side)
{
    bool nibbles = format == BRUME_U4R;
    if (format < BRUME_U8 || format > BRUME_U4R)
        return 0;
    if (side == 8)
        return nibbles ? 256 : 512;
    if (side == 9)
        return nibbles ? 368 : 732;
    return 0;
}

static int read_header(struct brume_volume *v, const uint8_t *p)
{
    v->format = p[BRUME_OFF_FORMAT];
    v->side = p[BRUME_OFF_SIDE];
    v->brick_bytes = brick_bytes(v->format, v->side);
    v->bricks = get32(p + BRUME_OFF_BRICKS);
    v->voxels = get32(p + BRUME_OFF_VOXELS);
    v->density_max = get_number(p + BRUME_OFF_DENSITY_MAX);
    v->density_mean = get_number(p + BRUME_OFF_DENSITY_MEAN);
    if (v->brick_bytes == 0 || get16(p + 26) != 0 || get32(p + 76) != 0 ||
        !number_is_good(v->density_max) || !number_is_good(v->density_mean))
        return BRUME_ERR_HEADER;
    for (int i = 0; i < 3; i++) {
        v->cell_count[i] = (uint16_t)get16(p + BRUME_OFF_CELLS + 2 * i);
        v->box_min[i] = (uint16_t)get16(p + BRUME_OFF_BOX_MIN + 2 * i);
        v->box_max[i] = (uint16_t)get16(p + BRUME_OFF_BOX_MAX + 2 * i);
        if (v->cell_count[i] < 1 || v->cell_count[i] > BRUME_MAX_CELLS ||
            v->box_min[i] > v->box_max[i] ||
            v->box_max[i] >= 8u * v->cell_count[i])
            return BRUME_ERR_HEADER;
    }
    return BRUME_OK;
}

/// Sections ///

/* The offset of a section, 0 when there is none. */
static uint32_t find_section(const uint8_t *p, uint32_t id, uint32_t *bytes)
{
    uint32_t n = get16(p + BRUME_OFF_SECTIONS);
    const uint8_t *s = p + BRUME_HEADER_BYTES;
    for (uint32_t i = 0; i < n; i++, s += BRUME_SECTION_BYTES)
        if (get32(s) == id) {
            *bytes = get32(s + 8);
            return get32(s + 4);
        }
    *bytes = 0;
    return 0;
}

static int check_sections(const uint8_t *p, uint32_t size)
{
    uint32_t n = get16(p + BRUME_OFF_SECTIONS);
    uint32_t first = BRUME_HEADER_BYTES + n * BRUME_SECTION_BYTES;
    for (uint32_t i = 0; i < n; i++) {
        const uint8_t *s = p + BRUME_HEADER_BYTES + i * BRUME_SECTION_BYTES;
        uint32_t offset = get32(s + 4), bytes = get32(s + 8);
        if (offset % BRUME_SECTION_ALIGN != 0 || offset < first ||
            offset > size || bytes > size - offset || get32(s + 12) != 0)
            return BRUME_ERR_SECTION;
        for (uint32_t j = 0; j < i; j++)
            if (get32(p + BRUME_HEADER_BYTES + j * BRUME_SECTION_BYTES) ==
                get32(s))
                return BRUME_ERR_SECTION;
    }
    return BRUME_OK;
}

/* a * b == product, for a, b >= 1 of any size. */
static bool is_product(uint32_t a, uint32_t b, uint32_t product)
{
    return mul_hi_floor(a, b) == 0 && a * b == product;
}

static int bind_sections(struct brume_volume *v, const uint8_t *p)
{
    uint32_t bytes;
    uint32_t offset = find_section(p, BRUME_SECTION_CELL, &bytes);
    uint32_t plane = (uint32_t)v->cell_count[0] * v->cell_count[1];
    if (offset == 0 || bytes % 4 != 0 ||
        !is_product(plane, v->cell_count[2], bytes / 4))
        return BRUME_ERR_SECTION;
    v->cells = (const brume_word_t *)(const void *)(p + offset);

    offset = find_section(p, BRUME_SECTION_POOL, &bytes);
    if (offset == 0 || !is_product(v->bricks, v->brick_bytes, bytes))
        return BRUME_ERR_SECTION;
    v->pool = p + offset;

    offset = find_section(p, BRUME_SECTION_RNGE, &bytes);
    if (v->format == BRUME_U8)
        return offset == 0 ? BRUME_OK : BRUME_ERR_SECTION;
    if (offset == 0 || !is_product(v->bricks, 4, bytes))
        return BRUME_ERR_SECTION;
    v->ranges = (const brume_word_t *)(const void *)(p + offset);
    return BRUME_OK;
}

/// Sections for light ///

#define MIP_BYTES 72u      /* levels 1 and 2 of a brick */
#define SUN_HEAD_BYTES 32u /* spacing, direction, unit */
#define SUN_OFF_UNIT 16u
#define SKY_HEAD_BYTES 16u  /* extinction */
#define GLOW_HEAD_BYTES 16u /* value of code 255 */

#if BRUME_WITH_CONE
/* Means: 72 bytes for each brick, then a byte for each cell, and for each cube
 * of cells of every level up to the one that is a single cube. */
static int bind_mips(struct brume_volume *v, const uint8_t *p)
{
    uint32_t rest, offset = find_section(p, BRUME_SECTION_MIPS, &rest);
    uint32_t x = v->cell_count[0], y = v->cell_count[1], z = v->cell_count[2];
    if (offset == 0)
        return BRUME_OK;
    if (v->bricks > rest / MIP_BYTES)
        return BRUME_ERR_SECTION;
    rest -= v->bricks * MIP_BYTES;
    for (;;) {
        uint32_t cubes = x * y * z; /* < 2^30: CELL has a word for each */
        if (cubes > rest)
            return BRUME_ERR_SECTION;
        rest -= cubes;
        if (cubes == 1)
            break;
        x = (x + 1) >> 1;
        y = (y + 1) >> 1;
        z = (z + 1) >> 1;
    }
    v->mips = p + offset;
    return rest == 0 ? BRUME_OK : BRUME_ERR_SECTION;
}
#endif

#if BRUME_WITH_CACHE
/* Depths towards a sun: a head, and a byte for each point. */
static int bind_sun_cache(struct brume_volume *v, const uint8_t *p)
{
    uint32_t bytes, offset = find_section(p, BRUME_SECTION_SUNC, &bytes);
    uint32_t plane = (uint32_t)v->cell_count[0] * v->cell_count[1];
    if (offset == 0)
        return BRUME_OK;
    p += offset;
    if (bytes < SUN_HEAD_BYTES || p[0] < 1 || p[0] > 3 ||
        (get32(p) & ~0xffu) != 0 || get32(p + 24) != 0 || get32(p + 28) != 0 ||
        !number_is_good(get_number(p + SUN_OFF_UNIT)))
        return BRUME_ERR_SECTION;
    bytes -= SUN_HEAD_BYTES;
    uint32_t per_cell = 512u >> 3 * p[0];
    if (bytes % per_cell != 0 ||
        !is_product(plane, v->cell_count[2], bytes / per_cell))
        return BRUME_ERR_SECTION;
    v->sun_cache = p;
    return BRUME_OK;
}

int brume_cache_baked(struct brume_cache *out,
                      const struct brume_volume *volume)
{
    if (out == NULL || volume == NULL)
        return BRUME_ERR_NULL;
    const uint8_t *p = volume->sun_cache;
    if (p == NULL)
        return BRUME_ERR_SECTION;
    out->from = out->to = p + SUN_HEAD_BYTES;
    out->spacing_log2 = p[0];
    out->blend = 0;
    out->unit = get_number(p + SUN_OFF_UNIT);
    for (int i = 0; i < 3; i++)
        out->size[i] = (uint16_t)(8u * volume->cell_count[i] >> p[0]);
    return BRUME_OK;
}
#endif

#if BRUME_WITH_AMBIENT
/* What cells see of the sky: a head, and a byte for each. */
static int bind_sky(struct brume_volume *v, const uint8_t *p)
{
    uint32_t bytes, offset = find_section(p, BRUME_SECTION_AMBI, &bytes);
    uint32_t plane = (uint32_t)v->cell_count[0] * v->cell_count[1];
    if (offset == 0)
        return BRUME_OK;
    p += offset;
    if (bytes < SKY_HEAD_BYTES || !number_is_good(get_number(p)) ||
        get32(p + 8) != 0 || get32(p + 12) != 0 ||
        !is_product(plane, v->cell_count[2], bytes - SKY_HEAD_BYTES))
        return BRUME_ERR_SECTION;
    v->sky = p + SKY_HEAD_BYTES;
    return BRUME_OK;
}
#endif

#if BRUME_WITH_EMISSION
/* The second grid: a head, and 512 codes for each brick. */
static int bind_emission(struct brume_volume *v, const uint8_t *p)
{
    uint32_t bytes, offset = find_section(p, BRUME_SECTION_EMIT, &bytes);
    if (offset == 0)
        return BRUME_OK;
    p += offset;
    if (bytes < GLOW_HEAD_BYTES || !number_is_good(get_number(p)) ||
        get32(p + 8) != 0 || get32(p + 12) != 0 ||
        !is_product(v->bricks, 512, bytes - GLOW_HEAD_BYTES))
        return BRUME_ERR_SECTION;
    v->emission = p + GLOW_HEAD_BYTES;
    v->emission_max = get_number(p);
    return BRUME_OK;
}
#endif

static int bind_light(struct brume_volume *v, const uint8_t *p)
{
    int err = BRUME_OK;
    (void)v;
    (void)p;
#if BRUME_WITH_CONE
    err = bind_mips(v, p);
#endif
#if BRUME_WITH_CACHE
    if (!err)
        err = bind_sun_cache(v, p);
#endif
#if BRUME_WITH_AMBIENT
    if (!err)
        err = bind_sky(v, p);
#endif
#if BRUME_WITH_EMISSION
    if (!err)
        err = bind_emission(v, p);
#endif
    return err;
}

/// Contents ///

static int check_ranges(const struct brume_volume *v)
{
    uint32_t top = v->format == BRUME_U4R ? 15 : 255;
    if (v->format == BRUME_U8)
        return BRUME_OK;
    for (uint32_t i = 0; i < v->bricks; i++) {
        uint32_t range = le32(v->ranges[i]);
        if ((range & 0xffffu) + top * (range >> 16) > BRUME_RANGE_TOP)
            return BRUME_ERR_RANGE;
    }
    return BRUME_OK;
}

/* Distance of a cell to the nearest brick, 0 for an occupied one. */
static uint32_t distance_of(const struct brume_volume *v, uint32_t i)
{
    uint32_t cell = le32(v->cells[i]);
    return cell & BRUME_CELL_EMPTY ? cell & 0xffu : 0;
}

static int check_words(const struct brume_volume *v, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t cell = le32(v->cells[i]);
        if (!(cell & BRUME_CELL_EMPTY)) {
            if (cell >= v->bricks)
                return BRUME_ERR_CELL;
        } else if (cell > (BRUME_CELL_EMPTY | 255u) ||
                   cell == BRUME_CELL_EMPTY) {
            return BRUME_ERR_CELL;
        }
    }
    return BRUME_OK;
}

/* A row against the same row or one of its neighbours, y and z: are distances
 * of touching cells at most 1 apart? Then by induction no brick is nearer
 * than a distance says. */
static bool rows_are_lipschitz(const struct brume_volume *v, uint32_t row,
                               uint32_t other)
{
    uint32_t n = v->cell_count[0];
    uint32_t here = distance_of(v, other), before = here;
    for (uint32_t x = 0; x < n; x++) {
        uint32_t d = distance_of(v, row + x) + 1u;
        uint32_t after = x + 1 < n ? distance_of(v, other + x + 1) : here;
        /* differences in -1 .. 1 */
        if (d - before > 2u || d - here > 2u || d - after > 2u)
            return false;
        before = here;
        here = after;
    }
    return true;
}

static int check_cells(const struct brume_volume *v)
{
    uint32_t nx = v->cell_count[0], ny = v->cell_count[1];
    uint32_t nz = v->cell_count[2], plane = nx * ny;
    int err = check_words(v, plane * nz);
    if (err)
        return err;
    /* Each pair of rows once: this row, +y, +z, +z+y, +z-y. */
    for (uint32_t z = 0; z < nz; z++)
        for (uint32_t y = 0; y < ny; y++) {
            uint32_t row = z * plane + y * nx;
            bool up = z + 1 < nz, far = y + 1 < ny;
            if (!rows_are_lipschitz(v, row, row) ||
                (far && !rows_are_lipschitz(v, row, row + nx)) ||
                (up && !rows_are_lipschitz(v, row, row + plane)) ||
                (up && far && !rows_are_lipschitz(v, row, row + plane + nx)) ||
                (up && y > 0 && !rows_are_lipschitz(v, row, row + plane - nx)))
                return BRUME_ERR_DISTANCE;
        }
    return BRUME_OK;
}

static int open_checked(struct brume_volume *v, const uint8_t *p, size_t size,
                        unsigned flags)
{
    int err = check_ident(p, size, flags);
    if (err)
        return err;
    v->asset = p;
    v->size = get32(p + BRUME_OFF_SIZE);
    err = read_header(v, p);
    if (!err)
        err = check_sections(p, v->size);
    if (!err)
        err = bind_sections(v, p);
    if (!err)
        err = bind_light(v, p);
    if (!err)
        err = check_ranges(v);
    if (!err)
        err = check_cells(v);
    return err;
}

int brume_volume_open(struct brume_volume *volume, const void *asset,
                      size_t size, unsigned flags)
{
    static const struct brume_volume k_none;
    if (volume == NULL)
        return BRUME_ERR_NULL;
    *volume = k_none;
    if (asset == NULL)
        return BRUME_ERR_NULL;
    int err = open_checked(volume, asset, size, flags);
    if (err)
        *volume = k_none;
    return err;
}

const char *brume_error_text(int error)
{
    switch (error) {
    case BRUME_OK: return "no error";
    case BRUME_ERR_NULL: return "a pointer is NULL";
    case BRUME_ERR_ALIGN: return "asset not on a 4-byte boundary";
    case BRUME_ERR_TRUNCATED: return "asset truncated";
    case BRUME_ERR_MAGIC: return "not a brume asset";
    case BRUME_ERR_VERSION: return "asset of another major version";
    case BRUME_ERR_CRC: return "asset checksum does not match";
    case BRUME_ERR_HEADER: return "asset header out of range";
    case BRUME_ERR_SECTION: return "asset section table is wrong";
    case BRUME_ERR_CELL: return "asset cell is wrong";
    case BRUME_ERR_DISTANCE: return "asset cell distance is wrong";
    case BRUME_ERR_RANGE: return "asset brick range is wrong";
    case BRUME_ERR_FEATURE: return "needs a feature not compiled in";
    case BRUME_ERR_SIZE: return "frame size out of range";
    case BRUME_ERR_CAMERA: return "eye, target or fov out of range";
    case BRUME_ERR_SUN: return "sun is no direction";
    case BRUME_ERR_STEP: return "step or light_step out of range";
    case BRUME_ERR_SAMPLES: return "light_samples out of range";
    case BRUME_ERR_SCENE: return "scene field out of range";
    case BRUME_ERR_RECT: return "rectangle outside the frame";
    case BRUME_ERR_STATE: return "no state, too small, or not begun";
    default: return "unknown error";
    }
}
