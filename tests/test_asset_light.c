/* SPDX-License-Identifier: MIT */
/*
 * The sections for light, MIPS, SUNC and AMBI, against docs/SPEC.md: what is
 * good is bound, each rule that is broken is refused, and whatever opens can
 * be rendered with light that reads them. A build without that light ignores
 * them.
 *
 * Bytes are opened in heap blocks of exactly their size, so that a sanitizer
 * sees the first read beyond them. The random numbers are always the same.
 */
#include "tap.h"

#include "brume.h"
#include "support/asset_light.h"

#include <stdlib.h>
#include <string.h>

#define FLIPS 6000
#define FRAME_W 16
#define FRAME_H 12
#define ENTRY(i) (BRUME_HEADER_BYTES + BRUME_SECTION_BYTES * (uint32_t)(i))

struct blob {
    uint8_t *p;
    size_t size;
};

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

static uint32_t spotted(int x, int y, int z, const void *context)
{
    uint32_t h = (uint32_t)(x / 5 + 31 * (y / 5) + 961 * (z / 5));
    (void)context;
    h = (h ^ h >> 7) * 0x9e3779b1u;
    return h >> 30 ? 0 : h >> 15;
}

static struct blob make(const int cells[3], int format, bool apron,
                        struct asset_light light)
{
    struct asset_spec spec =
        asset_spec_of(cells[0], cells[1], cells[2], format, spotted, NULL);
    struct blob b;
    spec.apron = apron;
    b.p = asset_build(&spec, &b.size);
    b.p = asset_add_light(b.p, &b.size, &light);
    return b;
}

/* 3x3x3 cells of a cloud. */
static struct blob make_cloud(struct asset_light light)
{
    struct asset_spec spec =
        asset_spec_of(3, 3, 3, BRUME_U8, density_in_cloud, &k_cloud);
    struct blob b;
    b.p = asset_build(&spec, &b.size);
    b.p = asset_add_light(b.p, &b.size, &light);
    return b;
}

static struct blob copy_of(const struct blob *b)
{
    struct blob copy = {get_memory(b->size), b->size};
    memcpy(copy.p, b->p, b->size);
    return copy;
}

static int open_volume(struct brume_volume *v, const struct blob *b,
                       unsigned flags)
{
    static const struct brume_volume k_none;
    memset(v, 0xa5, sizeof *v);
    int error = brume_volume_open(v, b->p, b->size, flags);
    if (error && memcmp(v, &k_none, sizeof *v) != 0)
        left_dirty = true;
    return error;
}

static int open_code(const struct blob *b)
{
    struct brume_volume v;
    return open_volume(&v, b, 0);
}

/* The code for a copy of an asset in which one number is another. */
static int code_with(const struct blob *good, uint32_t at, int bytes,
                     uint32_t value)
{
    struct blob b = copy_of(good);
    if (bytes == 4)
        asset_put32(b.p + at, value);
    else
        b.p[at] = (uint8_t)value;
    asset_seal(b.p, b.size);
    int code = open_code(&b);
    free(b.p);
    return code;
}

/* BRUME_ERR_SECTION where the feature is there, else the section is not
 * looked at. */
static int refused(bool feature)
{
    return feature ? BRUME_ERR_SECTION : BRUME_OK;
}

/// Good assets ///

static bool view_is_right(const struct brume_volume *v, const uint8_t *p)
{
    bool good = true;
    (void)v;
    (void)p;
#if BRUME_WITH_CONE
    good = good && v->mips == p + asset_section(p, BRUME_SECTION_MIPS);
#endif
#if BRUME_WITH_CACHE
    good = good && v->sun_cache == p + asset_section(p, BRUME_SECTION_SUNC);
#endif
#if BRUME_WITH_AMBIENT
    good = good && v->sky == p + asset_section(p, BRUME_SECTION_AMBI) + 16;
#endif
    return good;
}

static void test_view(const int cells[3], int format, bool apron, int spacing)
{
    struct asset_light light = {true, spacing, true};
    struct blob b = make(cells, format, apron, light);
    struct brume_volume v;
    tap_check(open_volume(&v, &b, 0) == BRUME_OK && view_is_right(&v, b.p),
              "format %d, side %d, %d x %d x %d cells, spacing %d: open, and "
              "the view has all three",
              format, apron ? 9 : 8, cells[0], cells[1], cells[2],
              1 << spacing);
    free(b.p);
}

static void test_none(void)
{
    struct asset_light light = {false, 0, false};
    struct blob b = make_cloud(light);
    struct brume_volume v;
    bool good = open_volume(&v, &b, 0) == BRUME_OK;
#if BRUME_WITH_CONE
    good = good && v.mips == NULL;
#endif
#if BRUME_WITH_CACHE
    struct brume_cache cache;
    good = good && v.sun_cache == NULL &&
           brume_cache_baked(&cache, &v) == BRUME_ERR_SECTION;
#endif
#if BRUME_WITH_AMBIENT
    good = good && v.sky == NULL;
#endif
    tap_check(good, "without the sections there are none");
    free(b.p);
}

#if BRUME_WITH_CACHE
static void test_baked_cache(int spacing)
{
    static const int cells[3] = {2, 3, 4};
    struct asset_light light = {false, spacing, false};
    struct blob b = make(cells, BRUME_U8R, false, light);
    const uint8_t *p = b.p + asset_section(b.p, BRUME_SECTION_SUNC);
    struct brume_volume v;
    struct brume_cache c;
    memset(&c, 0xa5, sizeof c);
    bool good = open_volume(&v, &b, 0) == BRUME_OK &&
                brume_cache_baked(&c, &v) == BRUME_OK && c.from == p + 32 &&
                c.to == c.from && c.blend == 0 && c.spacing_log2 == spacing &&
                c.unit.m == asset_get32(p + 16) && c.unit.m != 0 &&
                c.unit.e == (int32_t)asset_get32(p + 20);
    for (int i = 0; good && i < 3; i++)
        good = c.size[i] == 8 * cells[i] >> spacing;
    tap_check(good, "brume_cache_baked, spacing %d: the section's",
              1 << spacing);
    tap_check(brume_cache_baked(NULL, &v) == BRUME_ERR_NULL &&
                  brume_cache_baked(&c, NULL) == BRUME_ERR_NULL,
              "  and NULL is refused");
    free(b.p);
}
#endif

/// Bad sections ///

/* One section, last in the file, with `change` bytes more and all zero. */
static int code_with_length(struct asset_light light, int change)
{
    struct blob b = make_cloud(light);
    uint32_t bytes = asset_get32(b.p + ENTRY(2) + 8);
    size_t size = b.size + (size_t)change;
    b.p = realloc(b.p, size + 1);
    if (b.p == NULL)
        abort();
    if (change > 0)
        memset(b.p + b.size, 0, (size_t)change);
    b.size = size;
    asset_put32(b.p + ENTRY(2) + 8, bytes + (uint32_t)change);
    asset_put32(b.p + BRUME_OFF_SIZE, (uint32_t)b.size);
    asset_seal(b.p, b.size);
    int code = open_code(&b);
    free(b.p);
    return code;
}

static void test_lengths(const char *name, struct asset_light light,
                         bool feature)
{
    static const int k_change[] = {-1, 1, -4, 4, -8, 8, -32, 64};
    bool good = code_with_length(light, 0) == BRUME_OK;
    for (size_t i = 0; i < sizeof k_change / sizeof *k_change; i++)
        good = good && code_with_length(light, k_change[i]) == refused(feature);
    tap_check(good, "%s of any other length: %s", name,
              brume_error_text(refused(feature)));
}

/* Down to none at all, the section's bytes alone. */
static void test_short(const char *name, struct asset_light light, bool feature)
{
    struct blob b = make_cloud(light);
    uint32_t bytes = asset_get32(b.p + ENTRY(2) + 8);
    bool good = true;
    for (uint32_t n = 0; n < bytes; n += n < 80 ? 1 : 17)
        good = good && code_with(&b, ENTRY(2) + 8, 4, n) == refused(feature);
    tap_check(good, "%s cut anywhere: %s", name,
              brume_error_text(refused(feature)));
    free(b.p);
}

struct field {
    const char *what;
    uint32_t at;
    int bytes;
    uint32_t value;
    bool good;
};

static void test_fields(const char *name, const struct blob *b, uint32_t id,
                        const struct field *fields, size_t n, bool feature)
{
    uint32_t first = asset_section(b->p, id);
    for (size_t i = 0; i < n; i++) {
        const struct field *f = &fields[i];
        int code = code_with(b, first + f->at, f->bytes, f->value);
        tap_check(code == (f->good ? BRUME_OK : refused(feature)), "%s, %s: %s",
                  name, f->what, brume_error_text(code));
    }
}

static const struct field k_sun_fields[] = {
    {"spacing 0", 0, 1, 0, false},
    {"spacing 1, points of 2", 0, 1, 1, false},
    {"spacing 3, points of 2", 0, 1, 3, false},
    {"spacing 4", 0, 1, 4, false},
    {"spacing 12", 0, 1, 12, false},
    {"spacing 255", 0, 1, 255, false},
    {"first zero", 1, 1, 1, false},
    {"second zero", 2, 1, 1, false},
    {"third zero", 3, 1, 128, false},
    {"any direction", 4, 4, 0x80000000u, true},
    {"unit m 1", 16, 4, 1, false},
    {"unit m 2^31-1", 16, 4, 0x7fffffffu, false},
    {"unit 0", 16, 4, 0, true},
    {"unit e -1025", 20, 4, (uint32_t)-1025, false},
    {"unit e 992", 20, 4, 992, false},
    {"unit e 991", 20, 4, 991, true},
    {"fourth zero", 24, 4, 1, false},
    {"fifth zero", 28, 4, 0x80000000u, false},
    {"any code", 32, 1, 255, true},
};

static const struct field k_sky_fields[] = {
    {"extinction m 1", 0, 4, 1, false},
    {"extinction 0", 0, 4, 0, true},
    {"extinction e -1025", 4, 4, (uint32_t)-1025, false},
    {"extinction e 992", 4, 4, 992, false},
    {"first zero", 8, 4, 1, false},
    {"second zero", 12, 4, 0x80000000u, false},
    {"any visibility", 16, 1, 7, true},
};

static void test_bad_sections(void)
{
    static const struct asset_light k_mips = {true, 0, false};
    static const struct asset_light k_sun = {false, 2, false};
    static const struct asset_light k_sky = {false, 0, true};
    struct blob b = make_cloud(k_sun);
    test_fields("SUNC", &b, BRUME_SECTION_SUNC, k_sun_fields,
                sizeof k_sun_fields / sizeof *k_sun_fields, BRUME_WITH_CACHE);
    free(b.p);
    b = make_cloud(k_sky);
    test_fields("AMBI", &b, BRUME_SECTION_AMBI, k_sky_fields,
                sizeof k_sky_fields / sizeof *k_sky_fields, BRUME_WITH_AMBIENT);
    free(b.p);
    test_lengths("MIPS", k_mips, BRUME_WITH_CONE);
    test_lengths("SUNC", k_sun, BRUME_WITH_CACHE);
    test_lengths("AMBI", k_sky, BRUME_WITH_AMBIENT);
    test_short("MIPS", k_mips, BRUME_WITH_CONE);
    test_short("SUNC", k_sun, BRUME_WITH_CACHE);
    test_short("AMBI", k_sky, BRUME_WITH_AMBIENT);
}

/// Damaged assets ///

#if BRUME_WITH_LIGHTING
static uint32_t next_random(uint32_t *seed)
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 17;
    *seed ^= *seed << 5;
    return *seed;
}

struct tally {
    unsigned opened, refused, failed, cone, cache, sky;
};

/* What a random scene asks for, of what the volume has. */
struct wishes {
    struct brume_lighting lighting;
#if BRUME_WITH_CACHE
    struct brume_cache cache;
#endif
};

static void choose_light(struct brume_scene *s, struct wishes *w,
                         const struct brume_volume *v, struct tally *tally,
                         uint32_t random)
{
    (void)v;
    (void)tally;
    (void)random;
    memset(w, 0, sizeof *w);
    w->lighting.octaves = 1 + (random >> 8 & 3) % BRUME_MAX_OCTAVES;
    w->lighting.octave_a = w->lighting.octave_b = 0x8000;
    for (int i = 0; i < 3; i++)
        w->lighting.sun_colour[i] = 0x10000;
    s->lighting = &w->lighting;
#if BRUME_WITH_CONE
    if ((random & 1) && v->mips != NULL) {
        s->light = BRUME_CONE;
        tally->cone++;
    }
#endif
#if BRUME_WITH_CACHE
    if ((random & 3) == 2 && brume_cache_baked(&w->cache, v) == BRUME_OK) {
        s->light = BRUME_CACHE;
        w->lighting.cache = &w->cache;
        tally->cache++;
    }
#endif
#if BRUME_WITH_AMBIENT
    if ((random & 4) && v->sky != NULL) {
        w->lighting.ambient = BRUME_AMBIENT_CONSTANT;
        w->lighting.visibility = BRUME_SKY_BAKED;
        for (int i = 0; i < 3; i++)
            w->lighting.ambient_colour[0][i] = 0x4000;
        tally->sky++;
    }
#endif
}

/* Somewhere around the box, or in the pool. */
static void move_camera(struct brume_scene *s, const struct brume_volume *v,
                        uint32_t *seed)
{
    bool inside = next_random(seed) & 1;
    for (int i = 0; i < 3; i++) {
        uint32_t room = v->cell_count[i] * 8u << 16;
        int32_t at = (int32_t)(next_random(seed) % room);
        int32_t away = (int32_t)(next_random(seed) & 0x1fffff) - 0x100000;
        s->target[i] = at;
        s->eye[i] = inside ? at + away / 16 : at + 4 * away;
        s->sun[i] = (int32_t)(next_random(seed) >> 1) - 0x40000000;
    }
    s->target[0]++; /* never the eye */
    s->sun[1] |= 1;
}

static void render(const struct brume_volume *v, struct tally *tally,
                   uint32_t *seed)
{
    struct brume_scene s;
    struct brume_frame frame;
    struct wishes w;
    uint8_t *pixels = get_memory(FRAME_W * FRAME_H);
    uint32_t r = next_random(seed);
    brume_scene_default(&s, v);
    s.width = FRAME_W;
    s.height = FRAME_H;
    s.filter = (r >> 4 & 3) % 3;
    s.light = BRUME_LOG;
    s.light_samples = r >> 12 & 15;
    s.light_step = 0x4000u << (r >> 16 & 7);
    s.jitter = r >> 20 & 3;
    s.noise = r >> 22 & 3;
    move_camera(&s, v, seed);
    choose_light(&s, &w, v, tally, r);
    if (brume_begin_frame(&frame, v, &s) != BRUME_OK ||
        brume_render_rect(&frame, 0, 0, FRAME_W, FRAME_H, BRUME_L8, pixels,
                          FRAME_W) != BRUME_OK)
        tally->failed++;
    free(pixels);
}

/* 1 to 8 bits, in what comes before the pool, in the heads of the sections for
 * light, or anywhere. */
static void flip_bits(struct blob *b, uint32_t *seed)
{
    static const uint32_t k_id[] = {BRUME_SECTION_MIPS, BRUME_SECTION_SUNC,
                                    BRUME_SECTION_AMBI};
    uint32_t n = next_random(seed) % 8 + 1, kind = next_random(seed) % 4;
    uint32_t from = 0, room = (uint32_t)b->size;
    if (kind == 0) {
        room = asset_get32(b->p + ENTRY(1) + 4);
    } else if (kind == 1) {
        from = asset_section(b->p, k_id[next_random(seed) % 3]);
        room = room - from < 32 ? room - from : 32;
    }
    for (uint32_t i = 0; i < n; i++) {
        uint32_t bit = next_random(seed) % (8 * room);
        uint8_t *byte = b->p + from + bit / 8;
        *byte = (uint8_t)(*byte ^ 1u << bit % 8);
    }
}

static void test_flips(void)
{
    static const int k_cells[6][3] = {{5, 4, 3}, {1, 1, 1}, {2, 9, 1},
                                      {4, 4, 4}, {3, 1, 7}, {6, 5, 2}};
    uint32_t seed = 0x2545f491u;
    struct tally t = {0};
    struct blob good[6];
    struct brume_volume v;
    for (int i = 0; i < 6; i++) {
        struct asset_light light = {true, 1 + i % 3, true};
        good[i] = make(k_cells[i], i / 2 + 1, i & 1, light);
    }
    for (int i = 0; i < FLIPS; i++) {
        struct blob b = copy_of(&good[i % 6]);
        flip_bits(&b, &seed);
        if (open_volume(&v, &b, BRUME_OPEN_NO_CRC) == BRUME_OK) {
            t.opened++;
            render(&v, &t, &seed);
        } else {
            t.refused++;
        }
        free(b.p);
    }
    for (int i = 0; i < 6; i++)
        free(good[i].p);
    tap_check(t.opened > 100 && t.refused > 100 && t.failed == 0,
              "%d assets with bits flipped: %u open and are rendered, %u are "
              "refused",
              FLIPS, t.opened, t.refused);
    tap_check((!BRUME_WITH_CONE || t.cone > 100) &&
                  (!BRUME_WITH_CACHE || t.cache > 100) &&
                  (!BRUME_WITH_AMBIENT || t.sky > 100),
              "  with cones (%u), caches (%u) and a baked sky (%u)", t.cone,
              t.cache, t.sky);
}
#endif

int main(void)
{
    static const int k_cells[][3] = {
        {1, 1, 1}, {2, 1, 1}, {3, 3, 3}, {1, 5, 2}, {4, 2, 8}};
    int n = 0;
    for (int format = BRUME_U8; format <= BRUME_U4R; format++)
        for (int apron = 0; apron < 2; apron++, n++)
            test_view(k_cells[n % 5], format, apron, 1 + n % 3);
    static const int k_long[3] = {BRUME_MAX_CELLS, 1, 1};
    test_view(k_long, BRUME_U4R, false, 3);
    test_none();
#if BRUME_WITH_CACHE
    for (int spacing = 1; spacing <= 3; spacing++)
        test_baked_cache(spacing);
#endif
    test_bad_sections();
#if BRUME_WITH_LIGHTING
    test_flips();
#endif
    tap_check(!left_dirty, "after every error the volume was all zero");
    return tap_done();
}
