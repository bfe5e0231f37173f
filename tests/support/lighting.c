/* SPDX-License-Identifier: MIT */
#include "lighting.h"

#if TEST_LIGHTING

#define SLOTS 32
#define ONE 0x10000u

/* A few directions of the upper hemisphere, Q1.7. */
static const int8_t k_directions[3 * 64] = {
    126, 0,    0,   -93, 85,  2,    11,  -126, 4,   77,   100,  6,   -124,
    -22, 8,    106, -67, 10,  -32,  122, 12,   -58, -111, 14,   118, 43,
    16,  -116, 47,  18,  53,  -113, 20,  37,   119, 22,   -107, -62, 24,
    121, -26,  26,  -71, 101, 28,   -15, -122, 30,  93,   79,   32,  -122,
    5,   34,   86,  -85, 36,  -5,   120, 38,   -77, -92,  40,   118, 15,
    42,  -97,  67,  44,  25,  -115, 46,  58,   101, 48,   -110, -35, 50,
    104, -48,  52,  -44, 105, 54,   -38, -107, 56,  99,   52,   58,  -107,
    28,  60,   59,  -92, 62,  18,   107, 64,   -85, -66,  66,   106, -8,
    68,  -71,  77,  70,  0,   -104, 72,  69,   76,  74,   -101, -9,  76,
    79,  -60,  78,  -17, 96,  80,   -51, -81,  82,  91,   25,   84,  -82,
    42,  86,   31,  -85, 88,  33,   82,  90,   -78, -37,  92,   81,  -25,
    94,  -41,  71,  96,  -16, -78,  98,  63,   45,  100,  -74,  9,   102,
    47,  -55,  104, 2,   69,  106,  -46, -47,  108, 63,   3,    110, -45,
    37,  112,  7,   -55, 114, 29,   42,  116,  -45, -10,  118,  36,  -20,
    120, -10,  33,  122, -11, -24,  124, 14,   6,   126,
};
static const struct brume_direction_table k_table = {k_directions, 3, 3, 0};

static struct brume_lighting s_lighting[SLOTS];
static struct brume_cache s_cache[SLOTS];
static struct brume_phase s_phase[3][4]; /* octaves of each but isotropic */

static void set_phase(struct brume_lighting *l, unsigned phase)
{
    /* 10 um: Jendersie and d'Eon */
    static const struct brume_phase_model k_models[3] = {
        {BRUME_PHASE_MIX, 912680550, 0, 0, 0},
        {BRUME_PHASE_MIX, 1060964296, 597752922, 1441497, 31615},
        {BRUME_PHASE_SCHLICK, -536870912, 0, 0, 0}};
    if (phase == 0)
        return;
    for (uint32_t i = 0; i < 4; i++)
        brume_phase_build(&s_phase[phase - 1][i], &k_models[phase - 1], i,
                          ONE / 2);
    l->phase = s_phase[phase - 1];
}

static void set_colours(struct brume_lighting *l, bool colour)
{
    for (uint32_t c = 0; c < 3; c++) {
        uint32_t tint = colour ? c : 1;
        l->sun_colour[c] = ONE + ONE / 2 - tint * ONE / 4;
        for (uint32_t j = 0; j < 6; j++)
            l->ambient_colour[j][c] = ONE / 8 + j * ONE / 16 + tint * ONE / 12;
        l->sky_zenith[c] = ONE / 10 + c * ONE / 5;
        l->sky_horizon[c] = ONE / 2 + c * ONE / 8;
        l->sky_ground[c] = ONE / 5;
        l->sun_disc[c] = 6 * ONE;
    }
}

/* From red to blue by code, or all alike. */
static void set_emission(struct brume_lighting *l, bool colour)
{
    static uint32_t s_colours[2][256][3];
    for (uint32_t i = 0; i < 256; i++)
        for (uint32_t c = 0; c < 3; c++)
            s_colours[colour][i][c] =
                i * ONE / (colour ? 64u + 96u * (c ^ 1u) : 100u);
    l->emission_colour = (const uint32_t(*)[3])s_colours[colour];
    l->emission_scale = BRUME_Q32(0.5);
}

void test_lighting_fill(struct brume_scene *out,
                        const struct test_lighting *light, unsigned slot,
                        const struct brume_volume *volume)
{
    static const struct brume_lighting k_none;
    struct brume_lighting *l = &s_lighting[slot];
    *l = k_none;
    out->lighting = l;
    set_phase(l, light->phase);
    set_colours(l, light->colour);
    if (light->octaves == 0 && light->ambient == 0 && !light->colour)
        for (int c = 0; c < 3; c++)
            l->sun_colour[c] = ONE;
    l->octaves = light->octaves;
    l->octave_a = l->octave_b = ONE / 2;
    l->ambient = light->ambient;
    l->visibility = light->visibility;
    l->visibility_samples = 4;
    l->visibility_step = 2 * ONE;
    l->directions = &k_table;
    l->zenith[0] = 1;
    l->zenith[1] = 3;
    l->sky = light->sky;
    l->sun_size = light->sky ? 1u << 22 : 0;
    l->haze = light->sky ? 400 * ONE : 0;
    l->exposure = light->filmic ? ONE / 2 : 0;
    if (light->filmic)
        out->output = BRUME_FILMIC;
    if (light->emission)
        set_emission(l, light->colour);
#if BRUME_WITH_CACHE
    if (out->light == BRUME_CACHE &&
        brume_cache_baked(&s_cache[slot], volume) == BRUME_OK) {
        s_cache[slot].blend = light->blend * 256u;
        l->cache = &s_cache[slot];
    }
#else
    (void)volume, (void)s_cache;
#endif
}

#else

void test_lighting_fill(struct brume_scene *out,
                        const struct test_lighting *light, unsigned slot,
                        const struct brume_volume *volume)
{
    (void)out, (void)light, (void)slot, (void)volume;
}

#endif
