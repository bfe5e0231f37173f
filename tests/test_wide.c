/* SPDX-License-Identifier: MIT */
/*
 * test_wide [VOLUME=FILE.brume]...
 *
 * The wide kernels give the scalar march's bytes: radiance, transmittance and
 * depth of every ray, reading the asset and reading copies of it. Every golden
 * scene, rectangles of odd sizes and places, tiles of one ray, and ten thousand
 * random scenes with every feature; limits of the calls; and copies that are
 * not allowed.
 */
#include <stdlib.h>
#include <string.h>

#include "brume_inner.h"
#include "pool.h"
#include "support/asset_builder.h"
#include "support/random_light.h"
#include "support/volumes.h"
#include "tap.h"
#include "wide.h"

#define RANDOM_SCENES 10000
#define RANDOM_SIDE 20u /* rays, at most */

/* The kernels that are compared, and each volume's copies. */
static enum wide_kernel kernels[WIDE_KERNELS];
static int kernel_count;
static struct wide_copy copies[TEST_VOLUMES + 1];

static void find_kernels(void)
{
    for (int k = WIDE_SCALAR + 1; k < WIDE_KERNELS; k++) {
        const char *name = wide_name((enum wide_kernel)k);
        if (wide_has((enum wide_kernel)k))
            kernels[kernel_count++] = (enum wide_kernel)k;
        else
            tap_skip("THE WIDE KERNEL %s IS NOT TESTED: not on this machine",
                     name);
    }
}

/// Comparing ///

static struct brume_radiance *radiance(size_t n)
{
    struct brume_radiance *r = malloc(n * sizeof *r);
    if (r == NULL)
        abort();
    memset(r, 0xa5, n * sizeof *r);
    return r;
}

/* The w x h rays at (x, y) in tiles, by a kernel, into rows of `stride`. */
static void march(enum wide_kernel kernel, const struct wide_copy *copy,
                  const struct brume_frame *f, const unsigned rect[4],
                  unsigned tile_w, unsigned tile_h, struct brume_radiance *out,
                  size_t stride)
{
    for (unsigned j = 0; j < rect[3]; j += tile_h)
        for (unsigned i = 0; i < rect[2]; i += tile_w) {
            unsigned w = rect[2] - i, h = rect[3] - j;
            if (wide_march_copy_rect(kernel, copy, f, rect[0] + i, rect[1] + j,
                                     w < tile_w ? w : tile_w,
                                     h < tile_h ? h : tile_h,
                                     out + j * stride + i, stride) != BRUME_OK)
                abort();
        }
}

/* Does the kernel give what the scalar march gives, and leave the rest of the
 * memory alone? The tiles are the kernel's. */
static bool same(enum wide_kernel kernel, const struct wide_copy *copy,
                 const struct brume_frame *f, const unsigned rect[4],
                 unsigned tile_w, unsigned tile_h)
{
    size_t stride = rect[2] + 3, n = stride * rect[3] + 3;
    struct brume_radiance *is = radiance(n), *should = radiance(n);
    if (brume_march_rect(f, rect[0], rect[1], rect[2], rect[3], should,
                         stride) != BRUME_OK)
        abort();
    march(kernel, copy, f, rect, tile_w, tile_h, is, stride);
    bool good = memcmp(is, should, n * sizeof *is) == 0;
    free(is);
    free(should);
    return good;
}

/// Golden scenes ///

static void check_scene(const struct test_scene *t, const struct wide_copy *c,
                        const struct brume_frame *f)
{
    const unsigned whole[4] = {0, 0, f->lattice[0], f->lattice[1]};
    for (int k = 0; k < kernel_count; k++) {
        const char *name = wide_name(kernels[k]);
        tap_check(same(kernels[k], NULL, f, whole, 64, 64), "%s: %s", t->name,
                  name);
        tap_check(same(kernels[k], c, f, whole, 61, 19), "%s: %s, copies",
                  t->name, name);
    }
}

/* Copies of a volume of the list. */
static struct wide_copy *copy_of(const struct test_volumes *volumes,
                                 const struct brume_volume *v)
{
    for (int i = 0; i < volumes->count; i++)
        if (&volumes->item[i].volume == v)
            return &copies[i];
    return NULL;
}

static void check_scenes(const struct test_volumes *volumes)
{
    for (int i = 0; i < test_scene_count; i++) {
        const struct test_scene *t = &test_scenes[i];
        const struct brume_volume *v = test_volume_of(volumes, t);
        struct brume_scene scene;
        struct brume_frame frame;
        if (v == NULL) {
            tap_skip("%s: no volume %s", t->name, t->volume);
            continue;
        }
        test_scene_frame(&scene, t, v, test_scene_frames(t) - 1);
        if (brume_begin_frame(&frame, v, &scene) != BRUME_OK)
            abort();
        wide_copy_prepare(copy_of(volumes, v), &frame, NULL);
        check_scene(t, copy_of(volumes, v), &frame);
    }
}

/// Copies ///

/* Are the copies that both have the same? */
static bool equal_copies(const struct wide_copy *a, const struct wide_copy *b)
{
    return (a->bytes == NULL ||
            memcmp(a->bytes, b->bytes, a->bytes_size) == 0) &&
           (a->halves == NULL ||
            memcmp(a->halves, b->halves, 2 * a->halves_size) == 0) &&
           (a->half_aprons == NULL || memcmp(a->half_aprons, b->half_aprons,
                                             2 * a->half_aprons_size) == 0) &&
           (a->emission == NULL ||
            memcmp(a->emission, b->emission, a->aprons_size) == 0) &&
           (a->aprons == NULL ||
            memcmp(a->aprons, b->aprons, a->aprons_size) == 0);
}

/* Layers that threads make at the same time do not meet. */
static void check_threads(const struct test_volumes *volumes)
{
    static const uint32_t k_colour[256][3] = {{0}};
    static const struct brume_lighting k_glow = {
        .emission_colour = k_colour, .emission_scale = (uint64_t)1 << 32};
    struct pool *pool = pool_new(3);
    bool good = pool != NULL, glows = false;
    for (int i = 0; i < volumes->count; i++) {
        const struct brume_volume *v = &volumes->item[i].volume;
        struct wide_copy one, three;
        struct brume_scene scene;
        struct brume_frame frame;
        brume_scene_default(&scene, v);
        scene.lighting = v->emission != NULL ? &k_glow : NULL;
        wide_copy_init(&one, v, WIDE_COPY_MOST);
        wide_copy_init(&three, v, WIDE_COPY_MOST);
        for (int filter = 0; filter < 2; filter++) {
            scene.filter = (uint8_t)filter;
            if (brume_begin_frame(&frame, v, &scene) != BRUME_OK)
                abort();
            wide_copy_prepare(&one, &frame, NULL);
            wide_copy_prepare(&three, &frame, pool);
        }
        good = good && equal_copies(&one, &three);
        glows = glows || three.emission != NULL;
        wide_copy_free(&one);
        wide_copy_free(&three);
    }
    pool_free(pool);
    tap_check(good && glows, "copies by three threads are those by one");
}

/// Rectangles ///

static void check_rectangles(const struct test_volumes *volumes)
{
    static const unsigned k_rect[][4] = {
        {0, 0, 1, 1},    {79, 59, 1, 1},  {13, 7, 1, 90},  {3, 50, 131, 1},
        {17, 31, 37, 5}, {40, 40, 5, 37}, {63, 15, 65, 17}};
    struct brume_scene scene;
    struct brume_frame frame;
    const struct test_scene *t = &test_scenes[2]; /* jitter on both rays */
    const struct brume_volume *v = test_volume_of(volumes, t);
    test_scene_fill(&scene, t, v);
    if (brume_begin_frame(&frame, v, &scene) != BRUME_OK)
        abort();
    wide_copy_prepare(copy_of(volumes, v), &frame, NULL);
    for (int k = 0; k < kernel_count; k++) {
        bool good = true, ones = true;
        for (size_t i = 0; i < sizeof k_rect / sizeof k_rect[0]; i++) {
            const struct wide_copy *c = i & 1u ? copy_of(volumes, v) : NULL;
            good = good && same(kernels[k], c, &frame, k_rect[i], 999, 999);
            ones = ones && same(kernels[k], c, &frame, k_rect[i], 1, 1);
        }
        tap_check(good, "%s: odd rectangles", wide_name(kernels[k]));
        tap_check(ones, "%s: in tiles of one ray", wide_name(kernels[k]));
    }
}

/* The calls refuse what brume_march_rect refuses, and touch nothing. */
static void check_refusals(const struct test_volumes *volumes)
{
    struct brume_radiance out[4], before[4];
    struct brume_scene scene;
    struct brume_frame frame;
    const struct brume_volume *v = test_volume_of(volumes, &test_scenes[0]);
    test_scene_fill(&scene, &test_scenes[0], v);
    if (brume_begin_frame(&frame, v, &scene) != BRUME_OK)
        abort();
    memset(out, 0xa5, sizeof out);
    memcpy(before, out, sizeof out);
    unsigned w = frame.lattice[0], h = frame.lattice[1];
    for (int i = -1; i < kernel_count; i++) {
        enum wide_kernel k = i < 0 ? WIDE_SCALAR : kernels[i];
        bool good =
            wide_march_rect(k, NULL, 0, 0, 1, 1, out, 1) == BRUME_ERR_NULL &&
            wide_march_rect(k, &frame, 0, 0, 1, 1, NULL, 1) == BRUME_ERR_NULL &&
            wide_march_rect(k, &frame, w, 0, 1, 1, out, 1) == BRUME_ERR_RECT &&
            wide_march_rect(k, &frame, 0, h, 1, 1, out, 1) == BRUME_ERR_RECT &&
            wide_march_rect(k, &frame, 0, h - 1, 1, 2, out, 1) ==
                BRUME_ERR_RECT &&
            wide_march_rect(k, &frame, 0, 0, ~0u, 1, out, 1) ==
                BRUME_ERR_RECT &&
            wide_march_rect(k, &frame, 0, 0, 2, 2, out, 1) == BRUME_ERR_RECT &&
            wide_march_rect(k, &frame, w, h, 0, 0, out, 0) == BRUME_OK &&
            wide_march_rect(k, &frame, 0, 0, 0, 2, out, 0) == BRUME_OK;
        tap_check(good && memcmp(out, before, sizeof out) == 0,
                  "%s: bad rectangles are refused, empty ones are nothing",
                  wide_name(k));
    }
}

/// Fog ///

/* Fog around a small volume. */
static void fog_scene(struct brume_scene *s, const struct brume_volume *v,
                      const struct brume_lighting *light, uint16_t side)
{
    brume_scene_default(s, v);
    s->lighting = light;
    s->width = s->height = side;
    s->light = BRUME_LOG;
    s->light_samples = 16;
    s->noise = BRUME_NOISE_WHITE;
    s->jitter = BRUME_JITTER_LIGHT;
    for (int i = 0; i < 3; i++) /* along an axis */
        s->sun[i] = i == 0 ? 1 : 0;
}

static void check_fog_scene(const struct brume_scene *s,
                            const struct brume_volume *v, const char *what)
{
    const unsigned whole[4] = {0, 0, s->width, s->height};
    struct brume_frame frame;
    if (brume_begin_frame(&frame, v, s) != BRUME_OK)
        abort();
    for (int k = 0; k < kernel_count; k++)
        tap_check(same(kernels[k], NULL, &frame, whole, 999, 999), "%s: %s",
                  wide_name(kernels[k]), what);
}

/* Fog so thin that it takes nothing: then a sample is lit by it, which counts
 * for the directions that the sky is sampled in, or not, if it might glow. */
static void check_thin_fog(const struct test_volumes *volumes)
{
    static int8_t ways[3 * 64];
    static const struct brume_direction_table k_table = {ways, 3, 3, 0};
    static const struct brume_fog k_fog = {.density = 1, .far = 3000u << 16};
    static const uint32_t k_colour[256][3] = {{0}};
    static const struct brume_lighting k_light = {
        .sun_colour = {0x10000, 0x10000, 0x10000},
        .fog = &k_fog,
        .ambient = BRUME_AMBIENT_CONSTANT,
        .ambient_colour = {{0x10000, 0x10000, 0x10000}},
        .visibility = BRUME_SKY_SAMPLED,
        .visibility_samples = 4,
        .visibility_step = 0x20000,
        .directions = &k_table,
        .emission_colour = k_colour,
        .emission_scale = (uint64_t)1 << 32};
    for (int i = 0; i < 3 * 64; i++) /* of any length that is not 0 */
        ways[i] = (int8_t)(1 + i * 37 % 90);
    for (int i = 0; i < volumes->count; i++) {
        const struct brume_volume *v = &volumes->item[i].volume;
        struct brume_scene s;
        if (v->emission == NULL)
            continue;
        fog_scene(&s, v, &k_light, 24);
        s.min_density = 0x40000000u;
        check_fog_scene(&s, v, "fog that takes nothing, and emission");
    }
}

/* Light samples so far away that they do not fit a word: seen from outside of
 * the pool, one that was taken all the same could come to lie in it. And rays
 * with more samples outside than are found by adding up. */
static void check_fog(const struct test_volumes *volumes)
{
    static const struct brume_fog k_fog = {
        .density = 1u << 20, .falloff = 100u << 16, .far = 3000u << 16};
    static const struct brume_lighting k_light = {
        .sun_colour = {0x10000, 0x10000, 0x10000}, .fog = &k_fog};
    const struct brume_volume *v = &volumes->item[0].volume;
    struct brume_scene s;
    fog_scene(&s, v, &k_light, 64);
    s.light_step = BRUME_MAX_STEP;
    check_fog_scene(&s, v, "fog, and light samples beyond the word");
    fog_scene(&s, v, &k_light, 9);
    s.step = 0x4000;
    check_fog_scene(&s, v, "fog, and rays of 12000 samples");
}

/// Cache ///

/* The frame whose light goes into a cache. */
static void light_frame(struct brume_frame *f, const struct brume_volume *v,
                        int filter)
{
    static const struct brume_lighting k_white = {
        .sun_colour = {0x10000, 0x10000, 0x10000}};
    struct brume_scene scene;
    brume_scene_default(&scene, v);
    scene.lighting = &k_white;
    scene.light = BRUME_UNIFORM;
    scene.light_samples = 40;
    scene.light_step = 0x28000;
    scene.filter = (uint8_t)filter;
    scene.noise = BRUME_NOISE_NONE;
    scene.jitter = BRUME_JITTER_NONE;
    if (brume_begin_frame(f, v, &scene) != BRUME_OK)
        abort();
}

/* Are the codes of a kernel those of the core? */
static bool same_codes(enum wide_kernel kernel, const struct wide_copy *copy,
                       const struct brume_frame *f, unsigned spacing_log2)
{
    size_t n = brume_cache_bytes(f->volume, spacing_log2);
    uint8_t *is = malloc(n), *should = malloc(n);
    struct brume_cache c;
    if (is == NULL || should == NULL ||
        brume_cache_begin(&c, f->volume, spacing_log2, should) != BRUME_OK)
        abort();
    uint32_t rows = (uint32_t)c.size[1] * c.size[2], half = rows / 2;
    bool good =
        brume_cache_rows(&c, should, f, 0, rows) == BRUME_OK &&
        wide_cache_rows(kernel, copy, &c, is, f, 0, half) == BRUME_OK &&
        wide_cache_rows(kernel, copy, &c, is, f, half, rows - half) ==
            BRUME_OK &&
        memcmp(is, should, n) == 0 &&
        wide_cache_rows(kernel, copy, &c, is, f, 1, rows) == BRUME_ERR_RECT &&
        wide_cache_rows(kernel, copy, &c, NULL, f, 0, 1) == BRUME_ERR_NULL;
    free(is);
    free(should);
    return good;
}

static void check_caches(const struct test_volumes *volumes)
{
    for (int k = 0; k < kernel_count; k++) {
        bool good = true;
        for (int which = 0; which < 9; which++) /* the small ones */
            for (int filter = 0; filter < 2; filter++) {
                struct brume_frame f;
                light_frame(&f, &volumes->item[which].volume, filter);
                wide_copy_prepare(&copies[which], &f, NULL);
                for (unsigned log2 = 1; log2 < 4; log2++)
                    good = good && same_codes(kernels[k], NULL, &f, log2) &&
                           same_codes(kernels[k], &copies[which], &f, log2);
            }
        tap_check(good, "%s: codes of caches", wide_name(kernels[k]));
    }
}

/// Random scenes ///

static uint32_t random_state = 2463534242u;

/* Marsaglia's xorshift, 0 .. n - 1. */
static uint32_t random_below(uint32_t n)
{
    random_state ^= random_state << 13;
    random_state ^= random_state >> 17;
    random_state ^= random_state << 5;
    return (uint32_t)((uint64_t)random_state * n >> 32);
}

static bool one_in(uint32_t n)
{
    return random_below(n) == 0;
}

/* -range .. range */
static int32_t random_within(int32_t range)
{
    return (int32_t)((int64_t)random_below(2u * (uint32_t)range + 1u) - range);
}

/* Octaves are as likely as one another. */
static uint32_t random_octave(uint32_t low, uint32_t high)
{
    uint32_t octaves = 0;
    while (high >> octaves > low)
        octaves++;
    uint32_t top = high >> random_below(octaves + 1);
    uint32_t value = top / 2 + random_below(top / 2 + 1);
    return value < low ? low : value > high ? high : value;
}

static void random_camera(struct brume_scene *s, const struct brume_volume *v)
{
    static const int32_t k_far[4] = {10, 40, 200, 20000};
    int32_t away = k_far[random_below(4)] * 65536;
    for (int i = 0; i < 3; i++) {
        int32_t middle = (v->box_min[i] + v->box_max[i]) * 32768;
        s->target[i] = middle + random_within(30 * 65536);
        s->eye[i] = middle + random_within(away);
        if (one_in(8)) /* on a boundary of cells, looking along it */
            s->eye[i] = s->target[i] = (int32_t)random_below(9) << 19;
        s->up[i] = random_within(3);
        s->sun[i] = random_within(one_in(6) ? 1 : 1000);
    }
    s->sun[1] |= 1;
    s->eye[0] += s->eye[0] == s->target[0];
    s->fov = BRUME_MIN_FOV + random_below(BRUME_MAX_FOV - BRUME_MIN_FOV + 1);
}

static void random_light(struct brume_scene *s)
{
    s->light = (uint8_t)random_below(3);
    s->light_step = random_octave(BRUME_MIN_STEP, BRUME_MAX_STEP);
    s->light_samples = (uint16_t)random_below(s->light == BRUME_LOG ? 17 : 80);
    if (s->light == BRUME_NO_LIGHT)
        s->light_samples = 0;
    s->light_density_scale = random_octave(1, 1u << 31);
}

static void random_marching(struct brume_scene *s,
                            const struct brume_noise_table *table)
{
    s->frame = one_in(2) ? random_below(100) : random_below(~0u);
    s->density_scale = random_octave(1u << 8, 1u << 31);
    s->min_density = one_in(3) ? 0 : random_octave(1, 1u << 31);
    s->max_density = one_in(3) ? random_octave(1u << 24, 1u << 31) : 0;
    s->albedo = random_below(65537);
    s->step = random_octave(one_in(9) ? BRUME_MIN_STEP : 0x8000, 0x200000);
    s->min_transmittance = one_in(3) ? 0 : random_below(65537);
    s->filter = (uint8_t)random_below(2);
    s->jitter = (uint8_t)random_below(4);
    s->noise = (uint8_t)random_below(BRUME_NOISE_TABLE_R2 + 1);
    s->noise_table = table;
    s->skip = !one_in(5);
}

/* Lattice, place in the pixel, strata, depth. */
static void random_sequence(struct brume_scene *s)
{
    s->temporal = (uint8_t)random_below(BRUME_TAA + 1);
    s->window = (uint8_t)(1 + random_below(BRUME_MAX_WINDOW));
    s->alpha = 0x400 + random_below(0x10000 - 0x400 + 1);
    s->update = (uint8_t)random_below(BRUME_BAYER4 + 1);
    s->resolution = (uint8_t)random_below(BRUME_QUARTER + 1);
    s->upsample = (uint8_t)random_below(2);
    s->spatial = (uint8_t)random_below(BRUME_BILATERAL15 + 1);
    s->edge_falloff = one_in(2) ? 0x20000 : 0;
    s->subpixel = one_in(2);
}

static void random_scene(struct brume_scene *s, const struct brume_volume *v,
                         const struct brume_noise_table *table)
{
    static const struct brume_scene k_zero;
    *s = k_zero;
    s->width = (uint16_t)(1 + random_below(RANDOM_SIDE));
    s->height = (uint16_t)(1 + random_below(RANDOM_SIDE));
    random_camera(s, v);
    random_light(s);
    random_marching(s, table);
    if (one_in(2))
        random_sequence(s);
    if (one_in(2))
        random_light_fill(s, v, random_below);
}

/* A rectangle of the lattice, mostly all of it. */
static void random_rect(unsigned rect[4], const struct brume_frame *f)
{
    bool whole = !one_in(4);
    for (int i = 0; i < 2; i++) {
        rect[i] = whole ? 0 : random_below(f->lattice[i]);
        uint32_t room = f->lattice[i] - rect[i];
        rect[2 + i] = whole ? room : 1 + random_below(room);
    }
}

static void check_random(const struct test_volumes *volumes)
{
    uint8_t values[8 * 16 * 2];
    struct brume_noise_table tables[2] = {{values, 3, 4, 1, 4},
                                          {values, 3, 4, 1, 8}};
    static int bad[WIDE_KERNELS], copied_bad[WIDE_KERNELS];
    int drawn = 0, first_bad = -1;
    for (size_t i = 0; i < sizeof values; i++)
        values[i] = (uint8_t)random_below(256);
    for (int n = 0; n < RANDOM_SCENES; n++) {
        /* Those made here, not the files: they are small. */
        int which = (int)random_below(9);
        const struct brume_volume *v = &volumes->item[which].volume;
        struct brume_scene scene;
        struct brume_frame frame;
        unsigned rect[4];
        random_scene(&scene, v, &tables[random_below(2)]);
        if (brume_begin_frame(&frame, v, &scene) != BRUME_OK)
            continue;
        drawn++;
        random_rect(rect, &frame);
        wide_copy_prepare(&copies[which], &frame, NULL);
        for (int k = 0; k < kernel_count; k++) {
            bool direct = same(kernels[k], NULL, &frame, rect, 999, 999);
            bool copied =
                same(kernels[k], &copies[which], &frame, rect, 999, 999);
            bad[k] += !direct;
            copied_bad[k] += !copied;
            if (first_bad < 0 && !(direct && copied))
                first_bad = n;
        }
    }
    tap_check(drawn > RANDOM_SCENES * 9 / 10, "%d of %d random scenes are good",
              drawn, RANDOM_SCENES);
    for (int k = 0; k < kernel_count; k++) {
        const char *name = wide_name(kernels[k]);
        tap_check(bad[k] == 0, "%s: %d random scenes differ, the first is %d",
                  name, bad[k], first_bad);
        tap_check(copied_bad[k] == 0,
                  "%s: %d differ by copies, the first is %d", name,
                  copied_bad[k], first_bad);
    }
}

/// Copies ///

/* A volume without bricks, and copies that find no room. */
static void check_few(void)
{
    static const struct density_box none = {{0, 0, 0}, {0, 0, 0}, 0};
    struct asset_spec spec =
        asset_spec_of(3, 2, 1, BRUME_U8R, density_in_box, &none);
    struct brume_volume volume;
    struct brume_scene scene;
    struct brume_frame frame;
    struct wide_copy c, no_room;
    size_t size;
    uint8_t *asset = asset_build(&spec, &size);
    if (brume_volume_open(&volume, asset, size, 0) != BRUME_OK)
        abort();
    brume_scene_default(&scene, &volume);
    scene.width = 40;
    scene.height = 30;
    const unsigned whole[4] = {0, 0, 40, 30};
    wide_copy_init(&c, &volume, WIDE_COPY_MOST);
    wide_copy_init(&no_room, &volume, 100);
    for (int filter = 0; filter < 2; filter++) {
        scene.filter = (uint8_t)filter;
        if (brume_begin_frame(&frame, &volume, &scene) != BRUME_OK)
            abort();
        wide_copy_prepare(&c, &frame, NULL);
        wide_copy_prepare(&no_room, &frame, NULL);
        for (int k = 0; k < kernel_count; k++)
            tap_check(same(kernels[k], &c, &frame, whole, 999, 999) &&
                          same(kernels[k], &no_room, &frame, whole, 999, 999),
                      "%s, %s: an empty volume, and copies without room",
                      wide_name(kernels[k]), filter ? "trilinear" : "nearest");
    }
    tap_check(no_room.halves == NULL && no_room.aprons == NULL &&
                  no_room.half_aprons == NULL && no_room.most == 100,
              "copies that are too large are not made");
    wide_copy_free(&c);
    wide_copy_free(&no_room);
    free(asset);
}

static void check_names(void)
{
    bool good = true;
    enum wide_kernel k;
    for (int i = 0; i < WIDE_KERNELS; i++)
        good = good && wide_by_name(wide_name((enum wide_kernel)i), &k) &&
               (int)k == i;
    tap_check(good && !wide_by_name("wide", &k), "kernels have names");
    tap_check(wide_has(WIDE_SCALAR) && wide_has(wide_best()),
              "the best kernel here is %s", wide_name(wide_best()));
}

int main(int argc, char **argv)
{
    static struct test_volumes volumes;
    if (test_volumes_make(&volumes, argc, argv) != 0)
        return 1;
    for (int i = 0; i < volumes.count; i++)
        wide_copy_init(&copies[i], &volumes.item[i].volume, WIDE_COPY_MOST);
    find_kernels();
    check_names();
    check_threads(&volumes);
    check_rectangles(&volumes);
    check_refusals(&volumes);
    check_few();
    check_fog(&volumes);
    check_thin_fog(&volumes);
    check_caches(&volumes);
    check_random(&volumes);
    check_scenes(&volumes);
    for (int i = 0; i < volumes.count; i++)
        wide_copy_free(&copies[i]);
    test_volumes_free(&volumes);
    return tap_done();
}
