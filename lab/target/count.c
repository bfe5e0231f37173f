/* SPDX-License-Identifier: MIT */
/*
 * On a Cortex-M4 in its emulator: draws the scenes of record.h and counts the
 * instructions of the last frame of each. A line for each, in their order:
 *
 *   count PIXELS BEGIN TRACE RESOLVE SHOW same|OTHER
 *
 * BEGIN is of brume_begin_frame and brume_begin_state, TRACE has all of a frame
 * without passes, and the last word says whether its picture is the host's.
 * Volume and records are put into memory by the emulator's loader.
 * Freestanding.
 */
#include "record.h"

#include "print.h"
#include "target.h"

/* The board's PSRAM, 16 MiB (Arm AN386, table of its memory map): the volume
 * in its lower half, the records in its upper one. */
#define VOLUME_AT 0x21000000u
#define RECORDS_AT 0x21800000u
#define HALF 0x00800000u
#define PIXELS_MOST (240u * 135u)

static uint32_t s_state[2u << 18]; /* 2 MiB */
static uint32_t s_work[BRUME_WORK_BYTES(240) / 4 + 1];
static uint16_t s_picture[PIXELS_MOST];
static struct brume_volume s_volume;
static struct brume_frame s_frame;
static struct brume_scene s_scene;
static struct brume_lighting s_light;
static struct brume_noise_table s_noise;
static struct brume_cache s_cache;

/// Records ///

/* Fields are narrower than words, or bool; what was packed fits. */
#define GET_ONE(field) to->field = (__typeof__(to->field))*w++
#define GET_THREE(field) \
    for (int i = 0; i < 3; i++) \
    to->field[i] = (__typeof__(to->field[i]))*w++
#define GET_LONG(field) to->field = w[0] | (uint64_t)w[1] << 32, w += 2

static const uint32_t *get_light(const uint32_t *w)
{
    struct brume_lighting *to = &s_light;
    RECORD_LIGHT_FIELDS(GET_ONE, GET_THREE, GET_LONG);
    return w;
}

static const uint32_t *get_noise(const uint32_t *w)
{
    struct brume_noise_table *to = &s_noise;
    RECORD_NOISE_FIELDS(GET_ONE, GET_THREE, GET_LONG);
    return w;
}

static int get_scene(const uint32_t *w)
{
    struct brume_scene *to = &s_scene;
    int error = BRUME_OK;
    RECORD_SCENE_FIELDS(GET_ONE, GET_THREE, GET_LONG);
    to->lighting = NULL;
    to->noise_table = NULL;
    if (*w++) {
        w = get_light(w);
        to->lighting = &s_light;
        s_light.cache = &s_cache;
        error = brume_cache_baked(&s_cache, &s_volume);
    }
    if (*w++) {
        w = get_noise(w);
        to->noise_table = &s_noise;
        s_noise.values = (const uint8_t *)w;
    }
    return error;
}

/// Frames ///

static bool is_plain(const struct brume_scene *s)
{
    return s->temporal == BRUME_TEMPORAL_NONE &&
           s->spatial == BRUME_SPATIAL_NONE && s->resolution == BRUME_FULL &&
           s->update == BRUME_UPDATE_ALL;
}

/* Since the last call. */
static uint32_t lap(void)
{
    static uint64_t s_before;
    uint64_t now = target_instructions();
    uint32_t gone = (uint32_t)(now - s_before);
    s_before = now;
    return gone;
}

static int draw_passes(uint32_t count[4])
{
    struct brume_state *state = (struct brume_state *)(void *)s_state;
    const struct brume_frame *f = &s_frame;
    int error = brume_begin_state(state, f);
    count[0] += lap();
    if (!error)
        error = brume_trace_rect(f, state, 0, 0, f->lattice[0], f->lattice[1]);
    count[1] = lap();
    if (!error)
        error = brume_resolve_rect(f, state, 0, 0, f->grid[0], f->grid[1]);
    count[2] = lap();
    if (!error)
        error =
            brume_show_rect(f, state, 0, 0, f->width, f->height, BRUME_L16,
                            s_picture, f->width * 2u, s_work, sizeof s_work);
    count[3] = lap();
    return error;
}

static int draw_frame(uint32_t count[4])
{
    lap();
    int error = brume_begin_frame(&s_frame, &s_volume, &s_scene);
    count[0] = lap();
    if (error)
        return error;
    if (!is_plain(&s_scene))
        return draw_passes(count);
    error = brume_render_rect(&s_frame, 0, 0, s_frame.width, s_frame.height,
                              BRUME_L16, s_picture, s_frame.width * 2u);
    count[1] = lap();
    count[2] = count[3] = 0;
    return error;
}

static int draw(const uint32_t *record, uint32_t count[4])
{
    int error = get_scene(record + RECORD_HEAD);
    if (s_scene.width > 240 ||
        (uint32_t)s_scene.width * s_scene.height > PIXELS_MOST)
        return BRUME_ERR_SIZE;
    if (!error)
        error = brume_state_init((struct brume_state *)(void *)s_state,
                                 sizeof s_state);
    for (uint32_t i = 0; i < record[2] && !error; i++) {
        s_scene.frame = i;
        error = draw_frame(count);
    }
    return error;
}

/// The program ///

static void print_count(const uint32_t *record, const uint32_t count[4])
{
    const uint32_t pixels = (uint32_t)s_scene.width * s_scene.height;
    target_write("count ");
    print_number(pixels);
    for (int i = 0; i < 4; i++) {
        target_write(" ");
        print_number(count[i]);
    }
    target_write(record_crc((const uint8_t *)s_picture, 2 * pixels) == record[3]
                     ? " same\n"
                     : " OTHER\n");
}

static int fail(int error)
{
    target_write("error ");
    target_write(brume_error_text(error));
    target_write("\n");
    return 1;
}

int target_main(void)
{
    /* An asset's third word is its size. */
    const uint32_t *volume = (const uint32_t *)VOLUME_AT;
    const uint32_t *record = (const uint32_t *)RECORDS_AT;
    if (volume[2] > HALF)
        return fail(BRUME_ERR_TRUNCATED);
    int error =
        brume_volume_open(&s_volume, volume, volume[2], BRUME_OPEN_NO_CRC);
    if (error)
        return fail(error);
    for (; record[0] == RECORD_MAGIC; record += record[1] / 4) {
        uint32_t count[4] = {0, 0, 0, 0};
        error = draw(record, count);
        if (error)
            return fail(error);
        print_count(record, count);
    }
    return 0;
}
