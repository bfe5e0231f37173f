/* SPDX-License-Identifier: MIT */
/* The table of keys, and values as text. */
#include "scene_keys.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noises.h"

#define FAR 1e9 /* world coordinates; the pool's own limit comes later */
#define MAX_Q32 4294967295.0 /* whole part of the core's Q32.32 */

const struct scene_key_info scene_keys[SCENE_KEYS] = {
    {"size", SCENE_IS_SIZE, 1, BRUME_MAX_SIZE, NULL, "WxH pixels (640x480)"},
    {"eye", SCENE_IS_VECTOR, -FAR, FAR, NULL,
     "world position (in front of the box)"},
    {"target", SCENE_IS_VECTOR, -FAR, FAR, NULL,
     "world position (middle of the box)"},
    {"up", SCENE_IS_VECTOR, -FAR, FAR, NULL, "direction (0,1,0)"},
    {"fov", SCENE_IS_NUMBER, 1, 160, NULL, "vertical, degrees (40)"},
    {"sun", SCENE_IS_ANGLES, -3600, 3600, NULL,
     "azimuth elevation, degrees, towards the sun (-60 30)"},
    {"density_scale", SCENE_IS_NUMBER, 0, MAX_Q32, NULL,
     "extinction per voxel per density, view rays (from the mean density)"},
    {"light_density_scale", SCENE_IS_NUMBER, 0, MAX_Q32, NULL,
     "the same on light rays (from the mean density)"},
    {"albedo", SCENE_IS_NUMBER, 0, 1, NULL, "(1)"},
    {"step", SCENE_IS_NUMBER, 0.0625, 256, NULL,
     "voxels between samples (1 to 4)"},
    {"min_density", SCENE_IS_NUMBER, 0, 1e9, NULL,
     "samples not above count for 0 (0)"},
    {"min_transmittance", SCENE_IS_NUMBER, 0, 1, NULL,
     "ends a ray below it (0.01)"},
    {"max_density", SCENE_IS_NUMBER, 0, 1e9, NULL,
     "clamps voxels (0: no clamp)"},
    {"filter", SCENE_IS_WORD, 0, 0, "nearest trilinear", "(trilinear)"},
    {"light", SCENE_IS_WORD, 0, 0, "log uniform none", "(uniform)"},
    {"light_samples", SCENE_IS_INTEGER, 0, BRUME_MAX_UNIFORM_SAMPLES, NULL,
     "per lit sample; log: at most 16 (64; log: to cross the box)"},
    {"light_step", SCENE_IS_NUMBER, 0.0625, 256, NULL,
     "voxels; log doubles it (1/64 of the box; log: 1)"},
    {"jitter", SCENE_IS_WORD, 0, 0, "none primary light both",
     "which rays are jittered (primary)"},
    {"noise", SCENE_IS_WORD, 0, 0, noise_words,
     "or NAME.WxHxT.raw: of the jitter (ign)"},
    {"frame", SCENE_IS_INTEGER, 0, UINT32_MAX, NULL, "moves the noise (0)"},
    {"background", SCENE_IS_COLOUR, 0, 1, NULL,
     "linear grey or r,g,b (0.12,0.25,0.5)"},
    {"output", SCENE_IS_WORD, 0, 0, "linear srgb", "mapping to 0..255 (srgb)"},
    {"skip", SCENE_IS_WORD, 0, 0, "off on", "leap over empty cells (on)"},
    {"temporal", SCENE_IS_WORD, 0, 0, "none ema window taa",
     "what earlier frames add (none)"},
    {"history_bits", SCENE_IS_WORD, 0, 0, "8 16", "kept per quantity (16)"},
    {"window", SCENE_IS_INTEGER, 1, BRUME_MAX_WINDOW, NULL,
     "frames of window (8)"},
    {"alpha", SCENE_IS_NUMBER, 1.0 / 64, 1, NULL,
     "weight of the new frame, ema and taa (0.1)"},
    {"fetch", SCENE_IS_WORD, 0, 0, "bilinear catmull-rom",
     "how taa reads its history (catmull-rom)"},
    {"clamp", SCENE_IS_WORD, 0, 0, "none minmax variance",
     "bounds of taa's history (variance)"},
    {"gamma", SCENE_IS_NUMBER, 0, 16, NULL, "deviations of variance (0.5)"},
    {"spatial", SCENE_IS_WORD, 0, 0,
     "none box3 box5 gauss1 binomial3 binomial5 bilateral15",
     "filter over the image (none)"},
    {"edge_falloff", SCENE_IS_NUMBER, 0, 1024, NULL,
     "of spatial, nats per octave of depth (0; bilateral15: 16)"},
    {"resolution", SCENE_IS_WORD, 0, 0, "full half quarter",
     "rays across and down (full)"},
    {"update", SCENE_IS_WORD, 0, 0, "all checker bayer4",
     "rays marched in a frame (all)"},
    {"upsample", SCENE_IS_WORD, 0, 0, "bilinear aware", "to full (bilinear)"},
    {"subpixel", SCENE_IS_WORD, 0, 0, "off on",
     "moves rays within their pixels (off; window, taa: on)"},
    {"cut", SCENE_IS_WORD, 0, 0, "off on", "forgets earlier frames (off)"},
};

void scene_print_keys(FILE *to)
{
    for (int i = 0; i < SCENE_KEYS; i++) {
        const struct scene_key_info *k = &scene_keys[i];
        fprintf(to, "  %-20s %s%s%s", k->name, k->words ? k->words : "",
                k->words ? " " : "", k->meaning);
        if (k->kind == SCENE_IS_NUMBER || k->kind == SCENE_IS_INTEGER)
            fprintf(to, ", %g to %g", k->min, k->max);
        fputc('\n', to);
    }
}

/// Parsing ///

/* A decimal number, and *text moves past it. strtod by itself would also take
 * hexadecimal, "inf" and "nan". */
static bool read_number(const char **text, double *out)
{
    char digits[64], *end;
    size_t n = strspn(*text, "+-.0123456789eE");
    if (n == 0 || n >= sizeof digits)
        return false;
    memcpy(digits, *text, n);
    digits[n] = '\0';
    *text += n;
    *out = strtod(digits, &end);
    return end != digits && *end == '\0' && isfinite(*out);
}

/* Up to three numbers separated by commas, spaces or `also`; how many there
 * were, or -1 on anything else. */
static int read_numbers(const char *text, double out[3], char also)
{
    int n = 0;
    for (;;) {
        text += strspn(text, " \t");
        if (*text == '\0')
            return n;
        if (n == 3 || !read_number(&text, &out[n]))
            return -1;
        n++;
        text += strspn(text, " \t");
        if (*text == ',' || (also && *text == also)) {
            if (*++text == '\0')
                return -1;
        }
    }
}

static int word_index(const char *words, const char *word)
{
    size_t n = strlen(word);
    for (int i = 0; *words; i++) {
        size_t len = strcspn(words, " ");
        if (len == n && strncmp(words, word, n) == 0)
            return i;
        words += len;
        words += strspn(words, " ");
    }
    return -1;
}

static const char *wanted(enum scene_kind kind)
{
    switch (kind) {
    case SCENE_IS_VECTOR: return "three numbers x,y,z";
    case SCENE_IS_ANGLES: return "two numbers, azimuth elevation";
    case SCENE_IS_SIZE: return "two whole numbers WxH";
    case SCENE_IS_COLOUR: return "one number, or three r,g,b";
    case SCENE_IS_INTEGER: return "a whole number";
    default: return "a number";
    }
}

static bool count_is_right(enum scene_kind kind, int n)
{
    switch (kind) {
    case SCENE_IS_VECTOR: return n == 3;
    case SCENE_IS_ANGLES:
    case SCENE_IS_SIZE: return n == 2;
    case SCENE_IS_COLOUR: return n == 1 || n == 3;
    default: return n == 1;
    }
}

int scene_read_value(int key, const char *text, double out[3],
                     const char *where, char *err, size_t err_size)
{
    const struct scene_key_info *k = &scene_keys[key];
    if (k->kind == SCENE_IS_WORD) {
        int word = word_index(k->words, text);
        if (word < 0) {
            snprintf(err, err_size, "%s: %s is one of %s, not '%.40s'", where,
                     k->name, k->words, text);
            return -1;
        }
        out[0] = word;
        return 0;
    }
    int n = read_numbers(text, out, k->kind == SCENE_IS_SIZE ? 'x' : '\0');
    bool whole = k->kind == SCENE_IS_INTEGER || k->kind == SCENE_IS_SIZE;
    bool good = count_is_right(k->kind, n);
    for (int i = 0; good && i < n; i++)
        good = !whole || out[i] == floor(out[i]);
    if (!good) {
        snprintf(err, err_size, "%s: %s is %s, not '%.40s'", where, k->name,
                 wanted(k->kind), text);
        return -1;
    }
    for (int i = 0; i < n; i++)
        if (out[i] < k->min || out[i] > k->max) {
            snprintf(err, err_size, "%s: %s is %g, outside %g to %g", where,
                     k->name, out[i], k->min, k->max);
            return -1;
        }
    if (k->kind == SCENE_IS_COLOUR && n == 1)
        out[1] = out[2] = out[0];
    return 0;
}
