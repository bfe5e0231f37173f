/* SPDX-License-Identifier: MIT */
/* The table of keys, and values as text. */
#include "scene_keys.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noises.h"
#include "scene_emission.h"
#include "scene_lamps.h"
#include "scene_phase.h"

#define FAR 1e9 /* world coordinates; the pool's own limit comes later */
#define MAX_Q32 4294967295.0 /* whole part of the core's Q32.32 */
#define MAX_COLOUR 16

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
    {"filter", SCENE_IS_WORD, 0, 0, "nearest trilinear stochastic",
     "(trilinear)"},
    {"light", SCENE_IS_WORD, 0, 0, "log uniform none cone cache", "(uniform)"},
    {"light_samples", SCENE_IS_INTEGER, 0, BRUME_MAX_UNIFORM_SAMPLES, NULL,
     "per lit sample; log, cone: at most 16 (64; log, cone: to cross the "
     "box)"},
    {"light_step", SCENE_IS_NUMBER, 0.0625, 256, NULL,
     "voxels; log, cone double it (1/64 of the box; log, cone: 1)"},
    {"jitter", SCENE_IS_WORD, 0, 0, "none primary light both",
     "which rays are jittered (primary)"},
    {"noise", SCENE_IS_WORD, 0, 0, noise_words,
     "or NAME.WxHxT.raw: of the jitter (ign)"},
    {"frame", SCENE_IS_INTEGER, 0, UINT32_MAX, NULL, "moves the noise (0)"},
    {"background", SCENE_IS_COLOUR, 0, 1, NULL,
     "linear grey or r,g,b (0.12,0.25,0.5)"},
    {"output", SCENE_IS_WORD, 0, 0, "linear srgb filmic",
     "mapping to 0..255 (srgb)"},
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
    {"phase", SCENE_IS_PHASE, 0, 0, scene_phase_words,
     "phase function (isotropic)"},
    {"octaves", SCENE_IS_INTEGER, 1, BRUME_MAX_OCTAVES, NULL,
     "of multiple scattering; 1: single (1)"},
    {"octave_a", SCENE_IS_NUMBER, 0, 1, NULL,
     "extinction from one octave to the next (0.5)"},
    {"octave_b", SCENE_IS_NUMBER, 0, 1, NULL, "the same of light (0.5)"},
    {"octave_c", SCENE_IS_NUMBER, 0, 1, NULL,
     "the same of the phase function's parameters (0.5)"},
    {"sun_colour", SCENE_IS_COLOUR, 0, MAX_COLOUR, NULL,
     "linear grey or r,g,b (1)"},
    {"exposure", SCENE_IS_NUMBER, 1.0 / 256, 16, NULL,
     "of cloud and sky, not of background (1)"},
    {"ambient", SCENE_IS_WORD, 0, 0, "none constant gradient cube",
     "light from all around (none)"},
    {"ambient_colour", SCENE_IS_COLOUR, 0, MAX_COLOUR, NULL,
     "of constant (0.3)"},
    {"ambient_top", SCENE_IS_COLOUR, 0, MAX_COLOUR, NULL,
     "of gradient, upper end of the box (0.3)"},
    {"ambient_bottom", SCENE_IS_COLOUR, 0, MAX_COLOUR, NULL,
     "the same, lower end (0.1)"},
    {"ambient_px", SCENE_IS_COLOUR, 0, MAX_COLOUR, NULL,
     "of cube, from the world's +X (0.2)"},
    {"ambient_nx", SCENE_IS_COLOUR, 0, MAX_COLOUR, NULL, "from -X (0.2)"},
    {"ambient_py", SCENE_IS_COLOUR, 0, MAX_COLOUR, NULL, "from +Y (0.3)"},
    {"ambient_ny", SCENE_IS_COLOUR, 0, MAX_COLOUR, NULL, "from -Y (0.1)"},
    {"ambient_pz", SCENE_IS_COLOUR, 0, MAX_COLOUR, NULL, "from +Z (0.2)"},
    {"ambient_nz", SCENE_IS_COLOUR, 0, MAX_COLOUR, NULL, "from -Z (0.2)"},
    {"visibility", SCENE_IS_WORD, 0, 0, "open sampled baked",
     "what a sample sees of ambient light (open)"},
    {"visibility_samples", SCENE_IS_INTEGER, 0, 16, NULL,
     "of sampled, doubling distance (to cross the box)"},
    {"visibility_step", SCENE_IS_NUMBER, 0.0625, 256, NULL,
     "voxels to the first of them (2)"},
    {"cache_spacing", SCENE_IS_WORD, 0, 0, "auto 2 4 8",
     "voxels between points of light = cache (auto: of the baked one, or 4)"},
    {"sky", SCENE_IS_WORD, 0, 0, "off on",
     "a sky in the place of background (off)"},
    {"sky_zenith", SCENE_IS_COLOUR, 0, MAX_COLOUR, NULL,
     "its colour on top (0.1,0.22,0.5)"},
    {"sky_horizon", SCENE_IS_COLOUR, 0, MAX_COLOUR, NULL,
     "above the horizon (0.45,0.55,0.65)"},
    {"sky_ground", SCENE_IS_COLOUR, 0, MAX_COLOUR, NULL,
     "below the horizon (0.12,0.12,0.11)"},
    {"sun_disc", SCENE_IS_COLOUR, 0, MAX_COLOUR, NULL,
     "of the sun in the sky, added (8)"},
    {"sun_size", SCENE_IS_NUMBER, 0, 45, NULL,
     "radius of that disc, degrees; 0: none (0.27)"},
    {"haze", SCENE_IS_NUMBER, 0, 65535, NULL,
     "voxels in which the volume fades to 1/e; 0: never (0)"},
    {"dither", SCENE_IS_WORD, 0, 0, "off on",
     "of pixels with few bits, see --pixels (off)"},
    {"emission", SCENE_IS_EMISSION, 0, 0, scene_emission_words,
     "colours of codes 0 to 255 of the volume's second grid; FILE: 256 lines r "
     "g b (none)"},
    {"emission_scale", SCENE_IS_NUMBER, 0, MAX_Q32, NULL,
     "extinction per voxel per unit of it (16 across the box at 1/4 of its "
     "largest value)"},
    {"lamps", SCENE_IS_LAMPS, 0, 0, scene_lamps_words,
     "a lamp per line: X,Y,Z RADIUS SIZE COLOUR [spot X,Y,Z INNER OUTER] "
     "[shadow SAMPLES] (none)"},
    {"fog_density", SCENE_IS_NUMBER, 0, 0.999, NULL,
     "extinction of fog per voxel, up to fog_base; 0: none (0)"},
    {"fog_base", SCENE_IS_NUMBER, -FAR, FAR, NULL,
     "world height above which it is thinner (0)"},
    {"fog_falloff", SCENE_IS_NUMBER, 0, FAR, NULL,
     "world height in which it thins to 1/e; 0: never (0)"},
    {"fog_far", SCENE_IS_NUMBER, 0, FAR, NULL,
     "world distance at which rays through fog end; 0: 32766 voxels (0)"},
    {"fog_shapes", SCENE_IS_FILE, 0, 0, "none FILE",
     "spheres and boxes of fog: lines `sphere X,Y,Z RADIUS DENSITY "
     "[SOFTNESS]`, `box X,Y,Z HALF,HALF,HALF DENSITY [SOFTNESS]` (none)"},
    {"surface", SCENE_IS_FILE, 0, 0, "none FILE",
     "where rays end: .pgm or .png of 16 bits, depth codes, of the picture's "
     "size (none)"},
    {"sun_map", SCENE_IS_FILE, 0, 0, "none FILE",
     "what shades the sun: .pgm of 16 bits that says where it lies (none)"},
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

int scene_read_numbers(const char *text, double *out, int most, char also)
{
    int n = 0;
    for (;;) {
        text += strspn(text, " \t");
        if (*text == '\0')
            return n;
        if (n == most || !read_number(&text, &out[n]))
            return -1;
        n++;
        text += strspn(text, " \t");
        if (*text == ',' || (also && *text == also)) {
            if (*++text == '\0')
                return -1;
        }
    }
}

int scene_word_index(const char *words, const char *word)
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

void scene_print_word(FILE *to, const char *words, unsigned index)
{
    for (; index > 0; index--) {
        words += strcspn(words, " ");
        words += strspn(words, " ");
    }
    fprintf(to, "%.*s", (int)strcspn(words, " "), words);
}

void scene_print_number(FILE *to, double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.9g", value);
    if (strtod(text, NULL) != value)
        snprintf(text, sizeof text, "%.17g", value);
    fputs(text, to);
}

bool scene_key_moves(int key)
{
    return scene_keys[key].kind != SCENE_IS_WORD &&
           scene_keys[key].kind != SCENE_IS_PHASE &&
           scene_keys[key].kind != SCENE_IS_LAMPS &&
           scene_keys[key].kind != SCENE_IS_EMISSION &&
           scene_keys[key].kind != SCENE_IS_FILE;
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

int scene_read_value(int key, const char *text, double out[SCENE_VALUES],
                     const char *where, char *err, size_t err_size)
{
    const struct scene_key_info *k = &scene_keys[key];
    if (k->kind == SCENE_IS_WORD) {
        int word = scene_word_index(k->words, text);
        if (word < 0) {
            snprintf(err, err_size, "%s: %s is one of %s, not '%.40s'", where,
                     k->name, k->words, text);
            return -1;
        }
        out[0] = word;
        return 0;
    }
    if (k->kind == SCENE_IS_PHASE)
        return scene_phase_read(text, out, where, err, err_size);
    if (k->kind == SCENE_IS_LAMPS)
        return scene_lamps_read(text, out, where, err, err_size);
    int n =
        scene_read_numbers(text, out, 3, k->kind == SCENE_IS_SIZE ? 'x' : '\0');
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
