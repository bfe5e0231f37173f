/* SPDX-License-Identifier: MIT */
/*
 * The program of `make targets`: renders every test scene whose volume is at
 * hand, in rectangles that fit a small line buffer, and prints
 *
 *   open VOLUME INSTRUCTIONS
 *   scene NAME HASH WIDTHxHEIGHT INSTRUCTIONS BEGIN_INSTRUCTIONS
 *   passes NAME BEGIN TRACE RESOLVE SHOW
 *   tally NAME VIEW_SAMPLES LIT_SAMPLES LIGHT_SAMPLES RAYS_IN_POOL
 *   feature NAME      compiled out
 *   error NAME TEXT   then the exit status is 1
 *   stack BYTES       deepest of all calls of the core
 *
 * The hash is the CRC-32 of RGB888 bytes in the order of rows, so it is that of
 * a whole frame. INSTRUCTIONS are those of brume_render_rect alone, and
 * BEGIN_INSTRUCTIONS those of brume_begin_frame. Of a scene with a sequence
 * they are sums over the last frame's passes, which `passes` has one by one:
 * BEGIN is brume_begin_state. Freestanding.
 *
 * TARGET_PIXELS_MAX leaves out larger frames, for slow emulators; sequences
 * need TARGET_STATE_BYTES of memory beside. With
 * TARGET_TALLY (and BRUME_CONFIG="targets/tally.h") lookups are counted. With
 * TARGET_WIDE the wide kernel of hosts renders, where there is a heap for it.
 */
#include "target.h"

#include "support/scenes.h"

#ifndef TARGET_PIXELS_MAX
#define TARGET_PIXELS_MAX 76800 /* 320x240 */
#endif
#define BUFFER_BYTES 2880 /* three rows of 320 pixels */
#ifndef TARGET_STATE_BYTES
#define TARGET_STATE_BYTES 0
#endif
#define SEQUENCES (TARGET_STATE_BYTES > 0 && BRUME_WITH_SEQUENCES)

/* The march of hosts instead of the core's; its stack is no concern here. */
#ifdef TARGET_WIDE
#include "targets/wide_rect.h"
#define RENDER_RECT wide_render_rect
#define TRACE_RECT wide_trace_rect
#define STACK_USED() 0
#else
#define RENDER_RECT brume_render_rect
#define TRACE_RECT brume_trace_rect
#define STACK_USED() target_stack_used()
#endif

static struct brume_volume s_volume;
static const char *s_volume_name; /* of s_volume, or NULL */
static struct brume_frame s_frame;
static struct brume_scene s_scene;
static uint8_t s_buffer[BUFFER_BYTES];
static uint32_t s_stack_used; /* at most, in bytes */

#if SEQUENCES
static uint32_t s_state[TARGET_STATE_BYTES / 4];
static uint32_t s_work[BRUME_WORK_BYTES(64) / 4 + 1];
static uint8_t s_pixels[64 * 48 * 3];
#endif

#ifdef TARGET_TALLY
uint64_t tally_view_samples, tally_lit_samples, tally_light_samples,
    tally_rays_in_pool;
#endif

/// Text ///

static bool same_text(const char *a, const char *b)
{
    while (*a != '\0' && *a == *b) {
        a++;
        b++;
    }
    return *a == *b;
}

/* By subtraction: a 64-bit division would be a function of the compiler's
 * library, which firmware with brume does not need. */
static void write_number(const char *before, uint64_t number)
{
    static const uint64_t k_powers[] = {10000000000000000000u,
                                        1000000000000000000u,
                                        100000000000000000u,
                                        10000000000000000u,
                                        1000000000000000u,
                                        100000000000000u,
                                        10000000000000u,
                                        1000000000000u,
                                        100000000000u,
                                        10000000000u,
                                        1000000000u,
                                        100000000u,
                                        10000000u,
                                        1000000u,
                                        100000u,
                                        10000u,
                                        1000u,
                                        100u,
                                        10u,
                                        1u};
    char text[24], *to = text;

    for (int i = 0; i < 20; i++) {
        char digit = '0';
        for (; number >= k_powers[i]; number -= k_powers[i])
            digit++;
        if (digit != '0' || to != text || i == 19)
            *to++ = digit;
    }
    *to = '\0';
    target_write(before);
    target_write(text);
}

static void write_hash(uint32_t hash)
{
    char text[10] = " ";
    for (int i = 0; i < 8; i++)
        text[1 + i] = "0123456789abcdef"[hash >> (28 - 4 * i) & 15u];
    target_write(text);
}

static void write_line(const char *kind, const char *name, const char *text)
{
    target_write(kind);
    target_write(name);
    target_write(text);
}

/// Scenes ///

/* What the core alone takes of the stack: paint, call it, measure. */
static void measure_stack(void)
{
    uint32_t used = STACK_USED();
    if (used > s_stack_used)
        s_stack_used = used;
}

/* Opens a volume, unless it is the one opened last. */
static int open_volume(const char *name, const struct target_asset *asset)
{
    if (s_volume_name != NULL && same_text(s_volume_name, name))
        return BRUME_OK;
    target_stack_paint();
    uint64_t start = target_instructions();
    int error = brume_volume_open(&s_volume, asset->bytes, asset->size, 0);
    uint64_t end = target_instructions();
    measure_stack();
    s_volume_name = error ? NULL : name;
    write_line("open ", name, "");
    write_number(" ", end - start);
    target_write("\n");
    return error;
}

/* In rectangles as high as the buffer allows, or else in pieces of rows. The
 * instructions go to *count. */
static uint32_t render(const struct brume_scene *s, uint64_t *count, int *error)
{
    unsigned w = s->width < BUFFER_BYTES / 3 ? s->width : BUFFER_BYTES / 3;
    unsigned h = BUFFER_BYTES / 3 / w; /* 1 when rows are cut */
    uint32_t crc = 0;
    *count = 0;
    for (unsigned y = 0; y < s->height; y += h)
        for (unsigned x = 0; x < s->width; x += w) {
            unsigned cols = s->width - x < w ? s->width - x : w;
            unsigned rows = s->height - y < h ? s->height - y : h;
            uint64_t start = target_instructions();
            int result = RENDER_RECT(&s_frame, x, y, cols, rows, BRUME_RGB888,
                                     s_buffer, cols * 3);
            *count += target_instructions() - start;
            if (result != BRUME_OK)
                *error = result;
            crc = test_crc32_more(crc, s_buffer, (size_t)cols * rows * 3);
        }
    return crc;
}

static void write_scene(const char *name, uint32_t hash, uint64_t count,
                        uint64_t begin)
{
    write_line("scene ", name, "");
    write_hash(hash);
    write_number(" ", s_scene.width);
    write_number("x", s_scene.height);
    write_number(" ", count);
    write_number(" ", begin);
    target_write("\n");
}

static void clear_tally(void)
{
#ifdef TARGET_TALLY
    tally_view_samples = tally_lit_samples = 0;
    tally_light_samples = tally_rays_in_pool = 0;
#endif
}

static void write_tally(const char *name)
{
#ifdef TARGET_TALLY
    write_line("tally ", name, "");
    write_number(" ", tally_view_samples);
    write_number(" ", tally_lit_samples);
    write_number(" ", tally_light_samples);
    write_number(" ", tally_rays_in_pool);
    target_write("\n");
#else
    (void)name;
#endif
}

/// Sequences ///

#if SEQUENCES
static struct brume_state *state_memory(void)
{
    return (struct brume_state *)(void *)s_state;
}

/* The passes of the frame in s_frame; the instructions of each go to count. */
static int draw_frame(uint64_t count[4])
{
    struct brume_state *state = state_memory();
    const struct brume_frame *f = &s_frame;
    int err[4];
    uint64_t start = target_instructions();
    err[0] = brume_begin_state(state, f);
    count[0] = target_instructions() - start;
    start = target_instructions();
    err[1] = TRACE_RECT(f, state, 0, 0, f->lattice[0], f->lattice[1]);
    count[1] = target_instructions() - start;
    start = target_instructions();
    err[2] = brume_resolve_rect(f, state, 0, 0, f->grid[0], f->grid[1]);
    count[2] = target_instructions() - start;
    start = target_instructions();
    err[3] = brume_show_rect(f, state, 0, 0, f->width, f->height, BRUME_RGB888,
                             s_pixels, f->width * 3u, s_work, sizeof s_work);
    count[3] = target_instructions() - start;
    for (int i = 0; i < 4; i++)
        if (err[i] != BRUME_OK)
            return err[i];
    return BRUME_OK;
}

static int draw_sequence(const struct test_scene *t, uint64_t count[4],
                         uint64_t *begin)
{
    int error = brume_state_init(state_memory(), sizeof s_state);
    for (unsigned i = 0; i < test_scene_frames(t) && !error; i++) {
        test_scene_frame(&s_scene, t, &s_volume, i);
        target_stack_paint();
        uint64_t start = target_instructions();
        error = brume_begin_frame(&s_frame, &s_volume, &s_scene);
        *begin = target_instructions() - start;
        if (!error)
            error = draw_frame(count);
        measure_stack();
    }
    return error;
}

/* Does it fit the memory here? */
static bool fits(const struct test_scene *t)
{
    test_scene_frame(&s_scene, t, &s_volume, 0);
    return brume_state_bytes(&s_scene) <= sizeof s_state &&
           (size_t)t->width * t->height * 3 <= sizeof s_pixels;
}

static int run_sequence(const struct test_scene *t,
                        const struct target_asset *asset)
{
    uint64_t count[4] = {0, 0, 0, 0}, begin = 0;
    int error = open_volume(t->volume, asset);
    if (!error && (!test_scene_supported(t) || !fits(t)))
        return 0;
    if (!error)
        error = draw_sequence(t, count, &begin);
    if (error) {
        write_line("error ", t->name, " ");
        write_line(brume_error_text(error), "", "\n");
        return 1;
    }
    write_scene(t->name, test_crc32(s_pixels, (size_t)t->width * t->height * 3),
                count[0] + count[1] + count[2] + count[3], begin);
    write_line("passes ", t->name, "");
    for (int i = 0; i < 4; i++)
        write_number(" ", count[i]);
    target_write("\n");
    return 0;
}
#else
static int run_sequence(const struct test_scene *t,
                        const struct target_asset *asset)
{
    (void)t;
    (void)asset;
    return 0;
}
#endif

static int run_scene(const struct test_scene *t,
                     const struct target_asset *asset)
{
    uint64_t count = 0;
    uint32_t hash = 0;
    int error = open_volume(t->volume, asset);
    if (!error && !test_scene_supported(t))
        error = BRUME_ERR_FEATURE;
    if (!error) {
        test_scene_fill(&s_scene, t, &s_volume);
        clear_tally();
        target_stack_paint();
        uint64_t start = target_instructions();
        error = brume_begin_frame(&s_frame, &s_volume, &s_scene);
        uint64_t begin = target_instructions() - start;
        if (!error)
            hash = render(&s_scene, &count, &error);
        measure_stack();
        if (!error) {
            write_scene(t->name, hash, count, begin);
            write_tally(t->name);
            return 0;
        }
    }
    if (error == BRUME_ERR_FEATURE) {
        write_line("feature ", t->name, "\n");
        return 0;
    }
    write_line("error ", t->name, " ");
    write_line(brume_error_text(error), "", "\n");
    return 1;
}

static const struct target_asset *asset_of(const struct test_scene *t)
{
    for (int i = 0; i < target_asset_count; i++)
        if (same_text(target_assets[i].name, t->volume))
            return &target_assets[i];
    return NULL;
}

int target_main(void)
{
    int status = 0;
    for (int i = 0; i < test_scene_count; i++) {
        const struct test_scene *t = &test_scenes[i];
        const struct target_asset *asset = asset_of(t);
        if (asset != NULL && t->width * t->height <= TARGET_PIXELS_MAX)
            status |= t->sequence != NULL ? run_sequence(t, asset)
                                          : run_scene(t, asset);
    }
    target_write("stack");
    write_number(" ", s_stack_used);
    target_write("\n");
    return status;
}
