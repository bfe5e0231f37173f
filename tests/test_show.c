/* SPDX-License-Identifier: MIT */
/*
 * brume_show_rect: the same pixels however the image is cut, with a state or
 * without one, in exactly the scratch memory that it asks for; and what it
 * refuses.
 */
#include <stdlib.h>
#include <string.h>

#include "brume_inner.h"
#include "support/asset_builder.h"
#include "tap.h"

enum { KERNELS = 7 };
#define GUARD 64 /* bytes on either side of what may be written */
#define MARK 0xa5

static struct brume_volume s_volume;

static void *allocate(size_t size)
{
    void *p = malloc(size ? size : 1);
    if (p == NULL)
        abort();
    return p;
}

/// Settings ///

struct setting {
    int spatial;
    uint32_t falloff; /* Q16.16 */
    int resolution, upsample;
    unsigned w, h;
};

static void scene_of(struct brume_scene *scene, const struct setting *t)
{
    brume_scene_default(scene, &s_volume);
    scene->width = (uint16_t)t->w;
    scene->height = (uint16_t)t->h;
    scene->step = 0x40000; /* coarse: the march is not the subject */
    scene->light_samples = 3;
    scene->spatial = (uint8_t)t->spatial;
    scene->edge_falloff = t->falloff;
    scene->resolution = (uint8_t)t->resolution;
    scene->upsample = (uint8_t)t->upsample;
}

/* Calls f for every kernel, plain and edge-aware, every resolution and every
 * way to upsample; adds up what it returns. */
static int over_settings(unsigned w, unsigned h,
                         int (*f)(const struct setting *t))
{
    int sum = 0;
    for (int k = 0; k < KERNELS; k++)
        for (uint32_t e = 0; e < (k ? 2u : 1u); e++)
            for (int r = 0; r < 3; r++)
                for (int up = 0; up < (r ? 2 : 1); up++) {
                    struct setting t = {k, e * 0x18000u, r, up, w, h};
                    sum += f(&t);
                }
    return sum;
}

/* A frame and, unless it marches as it shows, its state. */
struct subject {
    struct brume_frame frame;
    struct brume_state *state;
};

static void begin(struct subject *s, const struct setting *t, bool state)
{
    struct brume_scene scene;
    scene_of(&scene, t);
    s->state = NULL;
    if (brume_begin_frame(&s->frame, &s_volume, &scene) != BRUME_OK)
        abort();
    if (!state)
        return;
    size_t size = brume_state_bytes(&scene);
    s->state = allocate(size);
    if (brume_state_init(s->state, size) != BRUME_OK ||
        brume_begin_state(s->state, &s->frame) != BRUME_OK)
        abort();
}

/* Rays of every value and depth, some beside nothing. */
static void store_random(struct subject *s)
{
    uint32_t count = (uint32_t)s->frame.grid[0] * s->frame.grid[1], r = 7;
    struct brume_radiance *rays = allocate(count * sizeof *rays);
    for (uint32_t i = 0; i < count; i++) {
        r = r * 1664525u + 1013904223u;
        rays[i].light = r >> 17;
        rays[i].transmittance = 0x10000u - (r >> 16);
        rays[i].depth = r % 7u == 0 ? 65535u : 40000u + (r >> 8) % 4096u;
    }
    if (brume_store_rect(&s->frame, s->state, 0, 0, s->frame.grid[0],
                         s->frame.grid[1], rays, s->frame.grid[0]) != BRUME_OK)
        abort();
    free(rays);
}

/// Cuts ///

static bool is_marked(const uint8_t *p, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (p[i] != MARK)
            return false;
    return true;
}

/* A rectangle into dst, in scratch memory that is not a byte larger than asked
 * for and full of rubbish. False on an error or a byte written beside it. */
static bool show(const struct subject *s, unsigned x, unsigned y, unsigned w,
                 unsigned h, uint8_t *dst, size_t stride)
{
    size_t size = brume_work_bytes(&s->frame, w);
    uint8_t *work = allocate(size + 2 * GUARD);
    memset(work, MARK, size + 2 * GUARD);
    int err = brume_show_rect(&s->frame, s->state, x, y, w, h, BRUME_RGB888,
                              dst, stride, work + GUARD, size);
    bool good = err == BRUME_OK && size <= BRUME_WORK_BYTES(w) &&
                is_marked(work, GUARD) && is_marked(work + GUARD + size, GUARD);
    free(work);
    return good;
}

/* The image in tiles, last one first. A line is 5 bytes longer than it need
 * be, and all around is marked; the size in *size. */
static uint8_t *show_tiles(const struct subject *s, unsigned tile_w,
                           unsigned tile_h, size_t *size)
{
    unsigned w = s->frame.width, h = s->frame.height;
    size_t stride = 3 * (size_t)w + 5;
    *size = stride * h + 2 * GUARD;
    uint8_t *image = allocate(*size), *first = image + GUARD;
    bool good = true;

    memset(image, MARK, *size);
    for (unsigned y = (h - 1) / tile_h * tile_h + tile_h; y > 0;) {
        y -= tile_h;
        for (unsigned x = (w - 1) / tile_w * tile_w + tile_w; x > 0;) {
            x -= tile_w;
            good = show(s, x, y, w - x < tile_w ? w - x : tile_w,
                        h - y < tile_h ? h - y : tile_h,
                        first + y * stride + 3 * (size_t)x, stride) &&
                   good;
        }
    }
    for (unsigned y = 0; y < h; y++)
        good = good && is_marked(first + y * stride + 3 * (size_t)w, 5);
    good = good && is_marked(image, GUARD) &&
           is_marked(image + *size - GUARD, GUARD);
    if (!good)
        memset(image, 0, *size); /* equal to nothing */
    return image;
}

static int differ(const struct subject *s, const uint8_t *whole, unsigned w,
                  unsigned h)
{
    size_t size;
    uint8_t *cut = show_tiles(s, w, h, &size);
    int wrong = memcmp(whole, cut, size) != 0;
    free(cut);
    return wrong;
}

static int cuts_of(const struct subject *s)
{
    unsigned w = s->frame.width, h = s->frame.height;
    size_t size;
    uint8_t *whole = show_tiles(s, w, h, &size);
    int wrong = whole[0] != MARK;
    wrong += differ(s, whole, w, 1);
    wrong += differ(s, whole, 1, h);
    wrong += differ(s, whole, 7, 5);
    wrong += differ(s, whole, 40, 3); /* more than a span */
    wrong += differ(s, whole, 1, 1);
    free(whole);
    return wrong;
}

static int cuts_with_state(const struct setting *t)
{
    struct subject s;
    begin(&s, t, true);
    store_random(&s);
    int wrong = cuts_of(&s);
    free(s.state);
    return wrong;
}

static int cuts_without_state(const struct setting *t)
{
    struct subject s;
    begin(&s, t, false);
    return cuts_of(&s);
}

/* Rays marched into a state give what rays marched on the way do. */
static int state_differs(const struct setting *t)
{
    struct subject without, with;
    size_t size, size2;
    begin(&without, t, false);
    begin(&with, t, true);
    if (brume_trace_rect(&with.frame, with.state, 0, 0, with.frame.lattice[0],
                         with.frame.lattice[1]) != BRUME_OK)
        abort();
    uint8_t *a = show_tiles(&without, t->w, t->h, &size);
    uint8_t *b = show_tiles(&with, t->w, t->h, &size2);
    int wrong = a[0] != MARK || size != size2 || memcmp(a, b, size) != 0;
    free(a);
    free(b);
    free(with.state);
    return wrong;
}

/* Three frames of a kind of history, the last of them in every cut. */
static int history_differs(int temporal, int update)
{
    struct setting t = {BRUME_BOX5,           0x40000, BRUME_HALF,
                        BRUME_UPSAMPLE_AWARE, 37,      26};
    struct brume_scene scene;
    struct subject s;
    scene_of(&scene, &t);
    scene.temporal = (uint8_t)temporal;
    scene.update = (uint8_t)update;
    size_t size = brume_state_bytes(&scene);
    s.state = allocate(size);
    if (brume_state_init(s.state, size) != BRUME_OK)
        abort();
    for (scene.frame = 0; scene.frame < 3; scene.frame++) {
        if (brume_begin_frame(&s.frame, &s_volume, &scene) != BRUME_OK ||
            brume_begin_state(s.state, &s.frame) != BRUME_OK ||
            brume_trace_rect(&s.frame, s.state, 0, 0, s.frame.lattice[0],
                             s.frame.lattice[1]) != BRUME_OK ||
            brume_resolve_rect(&s.frame, s.state, 0, 0, s.frame.grid[0],
                               s.frame.grid[1]) != BRUME_OK)
            abort();
    }
    int wrong = cuts_of(&s);
    free(s.state);
    return wrong;
}

/* With nothing to do, it is brume_render_rect. */
static void test_nothing_to_do(void)
{
    struct setting t = {0, 0, 0, 0, 61, 47};
    struct subject s;
    size_t size, stride = 3 * 61 + 5;
    begin(&s, &t, false);
    uint8_t *shown = show_tiles(&s, 61, 47, &size), *image = allocate(size);
    memset(image, MARK, size);
    if (brume_render_rect(&s.frame, 0, 0, 61, 47, BRUME_RGB888, image + GUARD,
                          stride) != BRUME_OK)
        abort();
    tap_check(memcmp(shown, image, size) == 0,
              "no filter, full resolution: the image of brume_render_rect");
    free(shown);
    free(image);
}

static void test_cuts(void)
{
    static const unsigned k_sizes[][2] = {{1, 1}, {1, 13}, {13, 1},
                                          {2, 3}, {5, 5},  {37, 26}};
    for (size_t i = 0; i < sizeof k_sizes / sizeof *k_sizes; i++) {
        unsigned w = k_sizes[i][0], h = k_sizes[i][1];
        int wrong = over_settings(w, h, cuts_with_state);
        tap_check(wrong == 0,
                  "%ux%u: whole, rows, columns, tiles, pixels alike, all "
                  "settings",
                  w, h);
    }
    tap_check(over_settings(11, 9, cuts_without_state) == 0,
              "the same without a state");
    tap_check(over_settings(45, 38, state_differs) == 0 &&
                  over_settings(1, 1, state_differs) == 0,
              "a state without history changes nothing, all settings");
    int wrong = 0;
    for (int temporal = BRUME_EMA; temporal <= BRUME_TAA; temporal++)
        for (int update = BRUME_UPDATE_ALL; update <= BRUME_BAYER4; update++)
            wrong += history_differs(temporal, update);
    tap_check(wrong == 0, "with history, too: ema, window and taa, all rays or "
                          "some, half resolution");
}

/// Scratch memory ///

static int work_is_wrong(const struct setting *t)
{
    struct subject s;
    uint8_t dst[3 * 40];
    int wrong = 0;
    begin(&s, t, false);
    for (unsigned w = 1; w <= t->w; w++) {
        size_t size = brume_work_bytes(&s.frame, w);
        void *work = allocate(size);
        memset(dst, MARK, sizeof dst);
        wrong += brume_show_rect(&s.frame, NULL, 0, 0, w, 1, BRUME_RGB888, dst,
                                 0, work, size - 1) != BRUME_ERR_STATE ||
                 !is_marked(dst, sizeof dst);
        wrong += brume_show_rect(&s.frame, NULL, 0, 0, w, 1, BRUME_RGB888, dst,
                                 0, work, size) != BRUME_OK;
        free(work);
    }
    return wrong;
}

/* The macro bounds the function for all kernels, by their taps. */
static int macro_is_low(const struct setting *t)
{
    static const unsigned k_taps[] = {1, 3, 5, 7, 3, 5, 13};
    struct subject s;
    int wrong = 0;
    begin(&s, t, false);
    for (unsigned w = 0; w <= t->w; w += w < 40 ? 1 : 97) {
        size_t size = brume_work_bytes(&s.frame, w);
        wrong += size > BRUME_WORK_BYTES_OF(w, k_taps[t->spatial]) ||
                 size > BRUME_WORK_BYTES(w);
    }
    return wrong;
}

static void test_work(void)
{
    tap_check(over_settings(40, 10, work_is_wrong) == 0,
              "scratch memory: a byte less fails, and writes nothing");
    tap_check(over_settings(BRUME_MAX_SIZE, 3, macro_is_low) == 0 &&
                  over_settings(3, BRUME_MAX_SIZE, macro_is_low) == 0,
              "BRUME_WORK_BYTES is enough for every setting and width");
    struct setting t = {BRUME_BOX5, 0, 0, 0, 320, 240};
    struct subject s;
    begin(&s, &t, false);
    tap_check(brume_work_bytes(&s.frame, 320) ==
                  BRUME_SPAN * sizeof(struct brume_radiance) + 6 * 5 * 320 +
                      6 * 324,
              "box5, 320 pixels: five rows, a padded line, a span: %zu bytes",
              brume_work_bytes(&s.frame, 320));
    tap_check(brume_work_bytes(NULL, 320) == 0, "no frame: 0 bytes");
}

/// Errors ///

static uint8_t s_dst[64 * 3];
static uint32_t s_work[BRUME_WORK_BYTES(64) / 4 + 1];

static int try_rect(const struct subject *s, unsigned x, unsigned y, unsigned w,
                    unsigned h, int format, size_t stride)
{
    return brume_show_rect(&s->frame, s->state, x, y, w, h, format, s_dst,
                           stride, s_work, sizeof s_work);
}

static void test_rectangles(const struct subject *s)
{
    unsigned w = s->frame.width, h = s->frame.height;
    memset(s_dst, MARK, sizeof s_dst);
    bool good = try_rect(s, w, 0, 1, 1, BRUME_L8, 1) == BRUME_ERR_RECT &&
                try_rect(s, 1, 0, w, 1, BRUME_L8, w) == BRUME_ERR_RECT &&
                try_rect(s, 0, h, 1, 1, BRUME_L8, 1) == BRUME_ERR_RECT &&
                try_rect(s, 0, 1, 1, h, BRUME_L8, 1) == BRUME_ERR_RECT &&
                try_rect(s, 0, 0, 8, 2, BRUME_L8, 7) == BRUME_ERR_RECT &&
                try_rect(s, 0, 0, ~0u, 1, BRUME_L8, 8) == BRUME_ERR_RECT &&
                try_rect(s, 0, 0, 8, 2, 99, 64) == BRUME_ERR_RECT;
    tap_check(good, "rectangles outside, short strides, no format: refused");
    good = try_rect(s, w, h, 0, 0, BRUME_L8, 0) == BRUME_OK &&
           try_rect(s, 0, 0, 0, h, BRUME_L8, 0) == BRUME_OK &&
           try_rect(s, 3, 3, 5, 0, BRUME_L8, 0) == BRUME_OK;
    tap_check(good && is_marked(s_dst, sizeof s_dst),
              "empty rectangles: fine, and nothing is written");
}

static void test_pointers(const struct subject *s)
{
    const struct brume_frame *f = &s->frame;
    size_t size = sizeof s_work;
    bool good = brume_show_rect(NULL, NULL, 0, 0, 1, 1, BRUME_L8, s_dst, 1,
                                s_work, size) == BRUME_ERR_NULL &&
                brume_show_rect(f, NULL, 0, 0, 1, 1, BRUME_L8, NULL, 1, s_work,
                                size) == BRUME_ERR_NULL &&
                brume_show_rect(f, NULL, 0, 0, 1, 1, BRUME_L8, s_dst, 1, NULL,
                                size) == BRUME_ERR_NULL;
    tap_check(good, "NULL: refused");
    good = true;
    for (int i = 1; i < 4; i++)
        good = good && brume_show_rect(f, NULL, 0, 0, 1, 1, BRUME_L8, s_dst, 1,
                                       (uint8_t *)s_work + i,
                                       size - 4) == BRUME_ERR_STATE;
    tap_check(good, "misaligned scratch memory: refused");
}

static void test_states(void)
{
    struct setting t = {BRUME_BOX3, 0, 0, 0, 32, 16};
    struct subject s, other;
    struct brume_scene scene;
    begin(&s, &t, true);
    tap_check(try_rect(&s, 0, 0, 8, 8, BRUME_L8, 8) == BRUME_OK,
              "a state that was begun is shown");
    brume_state_init(s.state, s.state->size);
    tap_check(try_rect(&s, 0, 0, 8, 8, BRUME_L8, 8) == BRUME_ERR_STATE,
              "one that was not is refused");
    free(s.state);

    begin(&s, &t, true);
    t.w = 31;
    begin(&other, &t, false);
    other.state = s.state;
    tap_check(try_rect(&other, 0, 0, 8, 8, BRUME_L8, 8) == BRUME_ERR_STATE,
              "one of another size is refused");
    free(s.state);

    scene_of(&scene, &t);
    scene.temporal = BRUME_EMA;
    s.state = NULL;
    bool good = brume_begin_frame(&s.frame, &s_volume, &scene) == BRUME_OK &&
                try_rect(&s, 0, 0, 8, 8, BRUME_L8, 8) == BRUME_ERR_STATE;
    scene.temporal = BRUME_TEMPORAL_NONE;
    scene.update = BRUME_CHECKER;
    good = good && brume_begin_frame(&s.frame, &s_volume, &scene) == BRUME_OK &&
           try_rect(&s, 0, 0, 8, 8, BRUME_L8, 8) == BRUME_ERR_STATE;
    tap_check(good, "ema, or rays of several frames, without a state: refused");
}

static void test_errors(void)
{
    struct setting t = {BRUME_GAUSS1, 0, 0, 0, 64, 48};
    struct subject s;
    begin(&s, &t, false);
    test_rectangles(&s);
    test_pointers(&s);
    test_states();
}

int main(void)
{
    static const struct density_cloud k_cloud = {40, 5};
    struct asset_spec spec =
        asset_spec_of(5, 5, 5, BRUME_U8, density_in_cloud, &k_cloud);
    size_t size;
    uint8_t *asset = asset_build(&spec, &size);

    if (brume_volume_open(&s_volume, asset, size, 0) != BRUME_OK)
        abort();
    test_nothing_to_do();
    test_cuts();
    test_work();
    test_errors();
    free(asset);
    return tap_done();
}
