/* SPDX-License-Identifier: MIT */
/*
 * Sequences are the same however their passes are cut, threaded, copied and
 * resumed, for every kind of history; and history is dropped when it must be,
 * within the memory that was given.
 */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "brume_inner.h"
#include "support/asset_builder.h"
#include "support/passes.h"
#include "tap.h"

enum { W = 45, H = 35, FRAMES = 5, BYTES = W * H * 3, GUARD = 64 };
#define MARK 0xa5
static struct brume_volume s_volume;

/// Settings ///

struct setting {
    int temporal, bits, update, resolution;
    bool subpixel;
};
enum { SETTINGS = 4 * 2 * 3 * 3 * 2 };

static struct setting setting_of(int i)
{
    struct setting t = {i & 3, i & 4 ? 16 : 8, i / 8 % 3, i / 24 % 3,
                        i / 72 != 0};
    return t;
}

/* The eye moves, sideways and ahead. Filters come with some settings. */
static struct brume_scene scene_of(const struct setting *t, uint32_t frame)
{
    struct brume_scene s;
    brume_scene_default(&s, &s_volume);
    s.width = W;
    s.height = H;
    s.frame = frame;
    s.eye[0] += (int32_t)(frame & 63) * 90000;
    s.eye[2] -= (int32_t)(frame & 63) * 70000;
    s.step = 0x40000;
    s.light = BRUME_LOG;
    s.light_samples = 2;
    s.noise = BRUME_NOISE_RANK1;
    s.temporal = (uint8_t)t->temporal;
    s.history_bits = (uint8_t)t->bits;
    s.window = 3;
    s.fetch = t->resolution ? BRUME_FETCH_CATMULL_ROM : BRUME_FETCH_BILINEAR;
    s.clamp = t->update == 1 ? BRUME_CLAMP_MINMAX : BRUME_CLAMP_VARIANCE;
    s.update = (uint8_t)t->update;
    s.resolution = (uint8_t)t->resolution;
    s.upsample = t->bits == 8 ? BRUME_UPSAMPLE_AWARE : BRUME_UPSAMPLE_BILINEAR;
    s.spatial = t->subpixel ? BRUME_BINOMIAL3 : BRUME_SPATIAL_NONE;
    s.edge_falloff = t->bits == 8 ? 0x20000 : 0;
    s.subpixel = t->subpixel;
    return s;
}

/// Cuts ///

/* One pass over the tile at (x, y); `format` of what is shown. */
enum pass { TRACE, RESOLVE, SHOW };
struct job {
    struct passes *passes;
    enum pass pass;
    unsigned area[2], tile[2]; /* of the whole, of a piece */
    unsigned first, every;     /* which pieces */
    uint8_t *dst;
};

static void do_tile(const struct job *j, void *work, unsigned x, unsigned y,
                    unsigned w, unsigned h)
{
    struct passes *p = j->passes;
    int error = BRUME_OK;
    if (j->pass == TRACE)
        error = brume_trace_rect(&p->frame, p->state, x, y, w, h);
    else if (j->pass == RESOLVE)
        error = brume_resolve_rect(&p->frame, p->state, x, y, w, h);
    else
        error = brume_show_rect(&p->frame, p->state, x, y, w, h, BRUME_RGB888,
                                j->dst + (y * j->area[0] + x) * 3,
                                j->area[0] * 3, work, p->work_size);
    if (error != BRUME_OK)
        abort();
}

static void *do_job(void *job)
{
    const struct job *j = job;
    void *work = malloc(j->passes->work_size);
    unsigned n = 0;
    if (work == NULL)
        abort();
    for (unsigned y = 0; y < j->area[1]; y += j->tile[1])
        for (unsigned x = 0; x < j->area[0]; x += j->tile[0], n++) {
            unsigned w = j->area[0] - x, h = j->area[1] - y;
            if (n % j->every == j->first)
                do_tile(j, work, x, y, w < j->tile[0] ? w : j->tile[0],
                        h < j->tile[1] ? h : j->tile[1]);
        }
    free(work);
    return NULL;
}

enum cut { WHOLE, ROWS, TILES, SINGLE, THREADS, CUTS };
static const char *const k_cut[CUTS] = {"whole", "rows", "tiles of 7x5",
                                        "single rays and pixels",
                                        "two threads, tiles of 4x3"};

static void do_pass(struct passes *p, enum pass pass, enum cut cut,
                    const uint16_t area[2], uint8_t *dst)
{
    static const unsigned tile[CUTS][2] = {
        {W, H}, {W, 1}, {7, 5}, {1, 1}, {4, 3}};
    struct job job[2] = {{p,
                          pass,
                          {area[0], area[1]},
                          {tile[cut][0], tile[cut][1]},
                          0,
                          cut == THREADS ? 2 : 1,
                          dst}};
    pthread_t thread;
    job[1] = job[0];
    job[1].first = 1;
    if (cut == THREADS && pthread_create(&thread, NULL, do_job, &job[1]) != 0)
        abort();
    do_job(&job[0]);
    if (cut == THREADS && pthread_join(thread, NULL) != 0)
        abort();
}

static void draw_cut(struct passes *p, const struct brume_scene *s,
                     enum cut cut, uint8_t *dst)
{
    const uint16_t image[2] = {s->width, s->height};
    passes_begin(p, &s_volume, s);
    do_pass(p, TRACE, cut, p->frame.lattice, dst);
    if (s->temporal == BRUME_TAA)
        do_pass(p, RESOLVE, cut, p->frame.grid, dst);
    do_pass(p, SHOW, cut, image, dst);
}

/* The frames of a setting, in that way. */
static void draw_all(const struct setting *t, enum cut cut,
                     uint8_t out[FRAMES][BYTES])
{
    struct passes p = {0};
    for (uint32_t f = 0; f < FRAMES; f++) {
        struct brume_scene s = scene_of(t, f);
        draw_cut(&p, &s, cut, out[f]);
    }
    passes_free(&p);
}

static void test_cuts(void)
{
    static uint8_t whole[FRAMES][BYTES], cut[FRAMES][BYTES];
    int differ[CUTS] = {0}, same_as_first = 0;
    for (int i = 0; i < SETTINGS; i++) {
        struct setting t = setting_of(i);
        draw_all(&t, WHOLE, whole);
        same_as_first += memcmp(whole[0], whole[FRAMES - 1], BYTES) == 0;
        for (enum cut c = ROWS; c < CUTS; c++) {
            memset(cut, MARK, sizeof cut);
            draw_all(&t, c, cut);
            differ[c] += memcmp(whole, cut, sizeof whole) != 0;
        }
    }
    tap_check(same_as_first == 0, "%d sequences, none of which stands still",
              SETTINGS);
    for (enum cut c = ROWS; c < CUTS; c++)
        tap_check(differ[c] == 0, "%s: the same pixels, %d sequences", k_cut[c],
                  SETTINGS);
}

/// Copies ///

/* The state of frame f, copied to another place, goes on as the original. */
static void test_resume(void)
{
    static uint8_t whole[FRAMES][BYTES], resumed[BYTES];
    int differ = 0;
    for (int i = 0; i < SETTINGS; i++) {
        struct setting t = setting_of(i);
        struct passes p = {0};
        for (uint32_t f = 0; f < FRAMES; f++) {
            struct brume_scene s = scene_of(&t, f);
            struct passes copy = {0};
            if (f > 0) {
                copy.size = p.size;
                copy.state = malloc(p.size);
                if (copy.state == NULL)
                    abort();
                memcpy(copy.state, p.state, p.size);
                passes_draw(&copy, &s_volume, &s, BRUME_RGB888, resumed);
            }
            passes_draw(&p, &s_volume, &s, BRUME_RGB888, whole[f]);
            differ += f > 0 && memcmp(whole[f], resumed, BYTES) != 0;
            passes_free(&copy);
        }
        passes_free(&p);
    }
    tap_check(differ == 0, "a copied state goes on as the original");
}

/// Plain renders ///

static void render(const struct brume_scene *scene, int format, void *dst)
{
    static struct brume_frame frame;
    struct brume_scene s = *scene;
    s.temporal = BRUME_TEMPORAL_NONE;
    s.update = BRUME_UPDATE_ALL;
    if (brume_begin_frame(&frame, &s_volume, &s) != BRUME_OK ||
        brume_render_rect(&frame, 0, 0, s.width, s.height, format, dst,
                          s.width * brume_pixel_bytes(format)) != BRUME_OK)
        abort();
}

/* Nothing of older frames at alpha 1, nor in a window of 1 (whose only place
 * in the pixel is another): byte for byte the plain render. */
static void test_alpha_1(void)
{
    static uint8_t got[BYTES], wanted[BYTES];
    int differ[4] = {0};
    for (int temporal = 0; temporal <= BRUME_TAA; temporal++) {
        struct passes p = {0};
        for (uint32_t f = 0; f < FRAMES; f++) {
            struct setting t = {temporal, 16, 0, 0, false};
            struct brume_scene s = scene_of(&t, f);
            s.spatial = BRUME_SPATIAL_NONE;
            s.alpha = 0x10000;
            s.window = 1;
            s.subpixel = temporal != BRUME_WINDOW && (f & 1);
            passes_draw(&p, &s_volume, &s, BRUME_RGB888, got);
            render(&s, BRUME_RGB888, wanted);
            differ[temporal] += memcmp(got, wanted, BYTES) != 0;
        }
        passes_free(&p);
    }
    tap_check(differ[0] == 0, "no history: the plain render");
    tap_check(differ[1] == 0, "ema, alpha 1: the plain render");
    tap_check(differ[2] == 0, "window of 1: the plain render");
    tap_check(differ[3] == 0, "taa, alpha 1: the plain render");
}

/* A camera at rest, no jitter: when every ray had its turn, by turns is the
 * same as all at once. */
static void test_turns(void)
{
    static uint8_t got[BYTES], wanted[BYTES];
    int differ[3] = {0};
    for (int temporal = BRUME_EMA; temporal <= BRUME_TAA; temporal++)
        for (int update = 0; update < 3; update++) {
            struct passes p = {0};
            struct setting t = {temporal, 16, update, 0, false};
            struct brume_scene s = scene_of(&t, 0);
            s.jitter = BRUME_JITTER_NONE;
            s.spatial = BRUME_SPATIAL_NONE;
            s.window = 1;
            s.alpha = 0x10000;
            for (s.frame = 5; s.frame < 21; s.frame++)
                passes_draw(&p, &s_volume, &s, BRUME_RGB888, got);
            render(&s, BRUME_RGB888, wanted);
            differ[update] += memcmp(got, wanted, BYTES) != 0;
            passes_free(&p);
        }
    tap_check(differ[0] == 0, "update all: the whole picture");
    tap_check(differ[1] == 0, "checker: the whole picture after its turns");
    tap_check(differ[2] == 0, "bayer4: the whole picture after its turns");
}

/// History dropped ///

/* Draws `before`, then `after` in the same memory: the same as in a fresh
 * one? */
static bool is_fresh(const struct brume_scene *before,
                     const struct brume_scene *after)
{
    static uint8_t got[BYTES], wanted[BYTES];
    struct passes p = {0}, q = {0};
    struct brume_scene s = *before;
    size_t need[2] = {brume_state_bytes(before), brume_state_bytes(after)};
    p.size = need[0] > need[1] ? need[0] : need[1];
    p.state = malloc(p.size);
    if (p.state == NULL || brume_state_init(p.state, p.size) != BRUME_OK)
        abort();
    for (int f = 0; f < 3; f++, s.frame++)
        passes_draw(&p, &s_volume, &s, BRUME_RGB888, got);
    passes_draw(&p, &s_volume, after, BRUME_RGB888, got);
    passes_draw(&q, &s_volume, after, BRUME_RGB888, wanted);
    bool same =
        memcmp(got, wanted, (size_t)after->width * after->height * 3) == 0;
    passes_free(&p);
    passes_free(&q);
    return same;
}

static void test_cut(void)
{
    int traces = 0;
    for (int i = 0; i < SETTINGS; i++) {
        struct setting t = setting_of(i);
        struct brume_scene before = scene_of(&t, 40), after = scene_of(&t, 3);
        after.cut = true;
        traces += !is_fresh(&before, &after);
    }
    tap_check(traces == 0, "after a cut no trace of the frames before it");
}

/* From every setting to every 7th other one, and to other sizes. */
static void test_changes(void)
{
    int traces = 0, sizes = 0, pairs = 0;
    for (int i = 0; i < SETTINGS; i++)
        for (int k = i % 7; k < SETTINGS; k += 7) {
            struct setting a = setting_of(i), b = setting_of(k);
            struct brume_scene before = scene_of(&a, 40);
            struct brume_scene after = scene_of(&b, 43);
            bool kept = a.temporal == b.temporal && a.update == b.update &&
                        a.resolution == b.resolution && a.bits == b.bits;
            if (kept)
                continue;
            traces += !is_fresh(&before, &after);
            pairs++;
        }
    for (int i = 0; i < SETTINGS; i++) {
        static const uint16_t size[][2] = {{1, 1}, {1, 7}, {W, 1}, {H, W - 1}};
        struct setting t = setting_of(i);
        struct brume_scene before = scene_of(&t, 40), after = scene_of(&t, 43);
        after.width = size[i & 3][0];
        after.height = size[i & 3][1];
        sizes += !is_fresh(&before, &after) || !is_fresh(&after, &before);
    }
    tap_check(traces == 0,
              "%d changes of kind, bits, update, resolution drop "
              "history",
              pairs);
    tap_check(sizes == 0, "changes of size drop history, down to 1x1");
}

/// Frame numbers ///

/* Numbers wrap from 2^32 - 1 to 0 as they go on anywhere else: the rays, their
 * turns and history depend on them modulo 2^16 alone with this noise, N-rooks
 * sets of 16 points and a table of 2 frames. */
static void test_wrap(void)
{
    static const uint8_t values[64] = {13, 180, 91, 2, 169, 80, 247, 158};
    static const struct brume_noise_table noise = {values, 3, 3, 1, 4};
    static uint8_t a[BYTES], b[BYTES];
    int differ = 0;
    for (int i = 0; i < SETTINGS; i++) {
        struct setting t = setting_of(i);
        struct passes p = {0}, q = {0};
        if (t.bits == 8) /* rounded by frame number: not modulo anything */
            continue;
        for (uint32_t f = 0; f < 32; f++) {
            struct brume_scene s = scene_of(&t, f);
            s.noise = BRUME_NOISE_TABLE;
            s.noise_table = &noise;
            s.window = 4;
            s.alpha = 0x10000;
            s.frame = f + 0x0ffffff0u;
            passes_draw(&p, &s_volume, &s, BRUME_RGB888, a);
            s.frame = f + 0xfffffff0u;
            passes_draw(&q, &s_volume, &s, BRUME_RGB888, b);
            differ += memcmp(a, b, BYTES) != 0;
        }
        passes_free(&p);
        passes_free(&q);
    }
    tap_check(differ == 0, "frame numbers wrap unseen");
}

/// Memory ///

static bool is_marked(const uint8_t *p, size_t n)
{
    while (n > 0)
        if (p[--n] != MARK)
            return false;
    return true;
}

/* In exactly the bytes it asks for, with guards around; in fewer, not at
 * all, and the state is as it was. */
static int memory_wrong(const struct setting *t, unsigned w, unsigned h)
{
    static struct brume_frame frame;
    struct brume_scene s = scene_of(t, 0);
    s.width = (uint16_t)w;
    s.height = (uint16_t)h;
    size_t size = brume_state_bytes(&s);
    uint8_t *memory = malloc(size + 2 * GUARD), *copy = malloc(size);
    uint8_t *picture = malloc((size_t)w * h * 3);
    if (memory == NULL || copy == NULL || picture == NULL)
        abort();
    struct passes p = {0};
    p.state = (struct brume_state *)(void *)(memory + GUARD);
    p.size = size;
    memset(memory, MARK, size + 2 * GUARD);
    if (brume_state_init(p.state, size) != BRUME_OK)
        abort();
    for (uint32_t f = 0; f < 3; f++, s.frame++)
        passes_draw(&p, &s_volume, &s, BRUME_RGB888, picture);
    int wrong =
        !is_marked(memory, GUARD) || !is_marked(memory + GUARD + size, GUARD);
    wrong += (uint8_t *)p.state != memory + GUARD;
    memcpy(copy, p.state, size);
    p.state->size--;
    if (brume_begin_frame(&frame, &s_volume, &s) != BRUME_OK)
        abort();
    wrong += brume_begin_state(p.state, &frame) != BRUME_ERR_STATE;
    p.state->size++;
    wrong += memcmp(copy, p.state, size) != 0;
    free(memory);
    free(copy);
    free(picture);
    free(p.work);
    return wrong;
}

static size_t macro_bytes(const struct brume_scene *s, const struct setting *t)
{
    uint32_t grid = BRUME_RAYS(s->width, s->height, t->resolution);
    uint32_t x = (s->width + (1u << t->resolution) - 1) >> t->resolution;
    uint32_t y = (s->height + (1u << t->resolution) - 1) >> t->resolution;
    uint32_t lattice = t->update == BRUME_CHECKER  ? (x + 1) / 2 * y
                       : t->update == BRUME_BAYER4 ? (x + 3) / 4 * ((y + 3) / 4)
                                                   : grid;
    uint32_t bits = s->history_bits, depth = brume_scene_has_depth(s);
    switch (t->temporal) {
    case BRUME_EMA:
        return BRUME_STATE_BYTES(grid, BRUME_EMA_BYTES(bits, depth), 0, 0);
    case BRUME_WINDOW:
        return BRUME_STATE_BYTES(
            grid, BRUME_WINDOW_BYTES(bits, s->window, depth), 0, 0);
    case BRUME_TAA:
        return BRUME_STATE_BYTES(grid, BRUME_TAA_BYTES(bits), lattice,
                                 BRUME_SAMPLE_BYTES);
    default: return BRUME_STATE_BYTES(0, 0, lattice, BRUME_SAMPLE_BYTES);
    }
}

static void test_memory(void)
{
    static const unsigned size[][2] = {{1, 1}, {1, 7}, {7, 1}, {W, H}};
    int wrong = 0, macro = 0;
    for (int i = 0; i < SETTINGS; i++)
        for (int k = 0; k < 4; k++) {
            struct setting t = setting_of(i);
            struct brume_scene s = scene_of(&t, 0);
            wrong += memory_wrong(&t, size[k][0], size[k][1]);
            s.width = (uint16_t)size[k][0];
            s.height = (uint16_t)size[k][1];
            size_t exact = brume_state_bytes(&s), most = macro_bytes(&s, &t);
            macro += most < exact || most > exact + 64;
        }
    tap_check(wrong == 0, "the state keeps to its bytes, and refuses fewer");
    tap_check(macro == 0, "the macros are at most 64 bytes more");
    tap_check(BRUME_EMA_BYTES(8, 0) == 2, "8-bit ema: 2 bytes per ray");
    tap_check(brume_state_init(NULL, 1000) == BRUME_ERR_NULL, "init: NULL");
    struct brume_state head;
    tap_check(brume_state_init(&head, sizeof head - 1) == BRUME_ERR_STATE,
              "init: less than the head");
}

int main(void)
{
    static const struct density_cloud cloud = {40, 5};
    struct asset_spec spec =
        asset_spec_of(5, 5, 5, BRUME_U8, density_in_cloud, &cloud);
    size_t size;
    uint8_t *asset = asset_build(&spec, &size);
    if (brume_volume_open(&s_volume, asset, size, 0) != BRUME_OK)
        abort();
    test_cuts();
    test_resume();
    test_alpha_1();
    test_turns();
    test_cut();
    test_changes();
    test_wrap();
    test_memory();
    free(asset);
    return tap_done();
}
