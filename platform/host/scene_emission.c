/* SPDX-License-Identifier: MIT */
/* Colours of emission: text, files, black bodies. */
#include "scene_emission.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "blackbody_table.h"
#include "scene_keys.h"

#define MAX_COLOUR 16
#define ONE 65536

enum emission { NONE, BLACKBODY, FROM_FILE };

const char scene_emission_words[] =
    "none blackbody:KELVIN_LOW,KELVIN_HIGH,BRIGHTNESS FILE";

/// Files ///

static int fail(char *err, size_t err_size, const char *path, int line,
                const char *what)
{
    if (line > 0)
        snprintf(err, err_size, "%.200s:%d: %s", path, line, what);
    else
        snprintf(err, err_size, "%.200s: %s", path, what);
    return -1;
}

static int read_colour(char *line, uint32_t out[3])
{
    double value[3];
    if (scene_read_numbers(line, value, 3, '\0') != 3)
        return -1;
    for (int c = 0; c < 3; c++) {
        if (!(value[c] >= 0 && value[c] <= MAX_COLOUR))
            return -1;
        out[c] = (uint32_t)floor(value[c] * ONE + 0.5);
    }
    return 0;
}

static int read_colours(FILE *f, const char *path, uint32_t out[256][3],
                        char *err, size_t err_size)
{
    char line[SCENE_LINE_SIZE + 1];
    int count = 0;
    for (int n = 1; scene_next_line(f, line); n++) {
        char *text = scene_trimmed(line);
        if (*text == '\0')
            continue;
        if (count == 256)
            return fail(err, err_size, path, n, "more than 256 colours");
        if (read_colour(text, out[count]) != 0)
            return fail(err, err_size, path, n,
                        "not three numbers from 0 to 16, red green blue");
        count++;
    }
    if (ferror(f))
        return fail(err, err_size, path, 0, strerror(errno));
    if (count == 256)
        return 0;
    snprintf(err, err_size, "%.200s: %d colours, not 256", path, count);
    return -1;
}

/* NULL on errors. */
static struct emission_file *read_file(const char *path, char *err,
                                       size_t err_size)
{
    struct emission_file *file = calloc(1, sizeof *file);
    FILE *f = fopen(path, "r");
    int result = -1;
    if (f == NULL || file == NULL)
        fail(err, err_size, path, 0, strerror(errno));
    else
        result = read_colours(f, path, file->colour, err, err_size);
    if (f != NULL)
        fclose(f);
    if (result == 0)
        snprintf(file->path, sizeof file->path, "%s", path);
    else
        free(file);
    return result == 0 ? file : NULL;
}

/// Text ///

static int read_blackbody(const char *text, double out[SCENE_VALUES],
                          const char *where, char *err, size_t err_size)
{
    double v[3];
    if (scene_read_numbers(text, v, 3, '\0') != 3) {
        snprintf(err, err_size, "%s: emission is one of %s, not '%.40s'", where,
                 scene_emission_words, text);
        return -1;
    }
    for (int i = 0; i < 2; i++)
        if (!(v[i] >= BLACKBODY_FIRST && v[i] <= BLACKBODY_LAST)) {
            snprintf(err, err_size, "%s: emission: %g kelvin, outside %d to %d",
                     where, v[i], BLACKBODY_FIRST, BLACKBODY_LAST);
            return -1;
        }
    if (v[0] > v[1]) {
        snprintf(err, err_size,
                 "%s: emission: KELVIN_LOW of %g is above KELVIN_HIGH of %g",
                 where, v[0], v[1]);
        return -1;
    }
    if (!(v[2] >= 0 && v[2] <= MAX_COLOUR)) {
        snprintf(err, err_size,
                 "%s: emission: BRIGHTNESS is %g, outside 0 to %d", where, v[2],
                 MAX_COLOUR);
        return -1;
    }
    out[0] = BLACKBODY;
    memcpy(out + 1, v, sizeof v);
    return 0;
}

int scene_emission_read(const char *text, double out[SCENE_VALUES],
                        const struct emission_file **file, const char *where,
                        char *err, size_t err_size)
{
    static const char k_blackbody_word[] = "blackbody:";
    char reason[SCENE_LINE_SIZE];
    size_t n = sizeof k_blackbody_word - 1;
    *file = NULL;
    memset(out, 0, SCENE_VALUES * sizeof *out);
    if (strcmp(text, "none") == 0)
        return 0;
    if (strncmp(text, k_blackbody_word, n) == 0)
        return read_blackbody(text + n, out, where, err, err_size);
    *file = read_file(text, reason, sizeof reason);
    if (*file == NULL) {
        snprintf(err, err_size, "%s: emission: %s", where, reason);
        return -1;
    }
    out[0] = FROM_FILE;
    return 0;
}

void scene_emission_print(FILE *to, const double value[SCENE_VALUES],
                          const struct emission_file *file)
{
    if (value[0] == NONE)
        fputs("none", to);
    if (value[0] == FROM_FILE)
        fputs(file->path, to);
    if (value[0] != BLACKBODY)
        return;
    fputs("blackbody", to);
    for (int i = 1; i <= 3; i++) {
        fputc(i == 1 ? ':' : ',', to);
        scene_print_number(to, value[i]);
    }
}

/// Colours ///

/* 2^(x / 65536), Q16.16, x <= 0: a factor 2^(-2^-i) for each bit of -x below
 * 1. Each is rounded to 2^-32; so is each product, down: error < 2^-15 of
 * 2^-16. */
static uint64_t exp2_of(int64_t x)
{
    /* 2^32 / 2^(2^-i), i = 1 .. 16 */
    static const uint64_t k_root[16] = {
        3037000500u, 3611622603u, 3938502376u, 4112874773u,
        4202935003u, 4248701965u, 4271771996u, 4283353945u,
        4289156690u, 4292061010u, 4293513907u, 4294240540u,
        4294603903u, 4294785595u, 4294876445u, 4294921870u};
    uint64_t down = (uint64_t)-x, y = (uint64_t)1 << 32;
    for (int i = 0; i < 16; i++)
        if (down >> (15 - i) & 1)
            y = y * k_root[i] >> 32;
    return down >> 16 < 48 ? y >> 16 >> (down >> 16) : 0;
}

/* Row of the table at a temperature, Q16.16, between two rows. */
static void row_at(uint32_t kelvin, int64_t out[4])
{
    uint32_t way = (kelvin - BLACKBODY_FIRST * ONE) / BLACKBODY_STEP;
    const int32_t *low = k_blackbody[way >> 16];
    const int32_t *high =
        k_blackbody[kelvin >= BLACKBODY_LAST * (uint32_t)ONE ? way >> 16
                                                             : (way >> 16) + 1];
    for (int i = 0; i < 4; i++)
        /* a sum of positive parts, so that shifts round alike everywhere */
        out[i] = low[i] + (int64_t)(high[i] - low[i]) * (way & 0xffff) / ONE;
}

/* In integers, so that it is the same on every host. */
static void blackbody_colours(uint32_t low, uint32_t high, uint32_t brightness,
                              uint32_t out[256][3])
{
    int64_t brightest[4], row[4];
    row_at(high, brightest);
    for (uint32_t i = 0; i < 256; i++) {
        uint64_t span = (uint64_t)(high - low) * i / 255;
        row_at(low + (uint32_t)span, row);
        int64_t below = row[0] < brightest[0] ? row[0] - brightest[0] : 0;
        uint64_t y = brightness * exp2_of(below); /* Q32 */
        for (int c = 0; c < 3; c++) {
            uint64_t v = ((y >> 16) * (uint64_t)row[1 + c] + ONE / 2) >> 16;
            out[i][c] = (uint32_t)(v < MAX_COLOUR * ONE ? v : MAX_COLOUR * ONE);
        }
    }
}

static uint32_t q16(double v)
{
    return (uint32_t)floor(v * ONE + 0.5);
}

bool scene_emission_colours(const double value[SCENE_VALUES],
                            const struct emission_file *file,
                            uint32_t out[256][3])
{
    memset(out, 0, 256 * sizeof *out);
    if (value[0] == BLACKBODY)
        blackbody_colours(q16(value[1]), q16(value[2]), q16(value[3]), out);
    if (value[0] == FROM_FILE)
        memcpy(out, file->colour, sizeof file->colour);
    return value[0] != NONE;
}
