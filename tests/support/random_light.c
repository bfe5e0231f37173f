/* SPDX-License-Identifier: MIT */
#include "random_light.h"

#define ONE 0x10000u
#define CACHE_BYTES 65536u
#define DIRECTIONS (8u * 16u * 4u)
#define MODELS 4

static struct brume_lighting s_lighting;
static struct brume_cache s_cache;
static struct brume_phase s_phase[MODELS][BRUME_MAX_OCTAVES];
static struct brume_direction_table s_directions;
static uint8_t s_codes[2 * CACHE_BYTES];
static int8_t s_ways[3 * DIRECTIONS];
static bool s_made;

static void make_phases(void)
{
    static const struct brume_phase_model k_models[MODELS] = {
        {BRUME_PHASE_MIX, 912680550, 0, 0, 0},
        {BRUME_PHASE_MIX, 1060964296, 597752922, 1441497, 31615},
        {BRUME_PHASE_SCHLICK, -536870912, 0, 0, 0},
        {BRUME_PHASE_MIX, 0, 0, 0, 0}};
    for (uint32_t m = 0; m < MODELS; m++)
        for (uint32_t i = 0; i < BRUME_MAX_OCTAVES; i++)
            brume_phase_build(&s_phase[m][i], &k_models[m], i, ONE / 2);
}

/* Once; depths are small more often than not. */
static void make_tables(uint32_t (*below)(uint32_t))
{
    if (s_made)
        return;
    s_made = true;
    make_phases();
    for (uint32_t i = 0; i < sizeof s_codes; i++)
        s_codes[i] = (uint8_t)below(1u + below(256));
    for (uint32_t i = 0; i < sizeof s_ways; i++)
        s_ways[i] = (int8_t)(i % 3 == 2 ? (int32_t)below(128)
                                        : (int32_t)below(256) - 128);
}

static void colour_of(uint32_t out[3], bool grey, uint32_t (*below)(uint32_t))
{
    uint32_t most = below(4) == 0 ? 16u * ONE : ONE;
    if (below(8) == 0)
        most = 0;
    for (int c = 0; c < 3; c++)
        out[c] = grey && c > 0 ? out[0] : below(most + 1u);
}

static void ambient_of(struct brume_lighting *l, const struct brume_volume *v,
                       bool grey, uint32_t (*below)(uint32_t))
{
    l->ambient = (uint8_t)below(BRUME_AMBIENT_CUBE + 1u);
    l->visibility = (uint8_t)below(v->sky != NULL ? 3 : 2);
    l->visibility_samples = (uint8_t)below(BRUME_MAX_LOG_SAMPLES + 1u);
    l->visibility_step =
        BRUME_MIN_STEP +
        below((BRUME_MAX_STEP - BRUME_MIN_STEP) << below(2) >> (1u + below(8)));
    for (int j = 0; j < 6; j++)
        colour_of(l->ambient_colour[j], grey, below);
    for (int i = 0; i < 3; i++)
        l->zenith[i] = (int32_t)below(21) - 10;
    s_directions.values = s_ways;
    s_directions.width_log2 = 3;
    s_directions.height_log2 = 4;
    s_directions.frames_log2 = (uint8_t)below(3);
    l->directions = &s_directions;
}

static void behind_of(struct brume_lighting *l, uint32_t (*below)(uint32_t))
{
    l->sky = below(2) == 0;
    colour_of(l->sky_zenith, false, below);
    colour_of(l->sky_horizon, false, below);
    l->haze = below(2) == 0 ? 0 : ONE + below(1000u * ONE);
}

/* False when there is no room for it. */
static bool make_cache(const struct brume_volume *v,
                       uint32_t (*below)(uint32_t))
{
    unsigned spacing = 1u + below(3);
    size_t bytes = brume_cache_bytes(v, spacing);
    if (bytes == 0 || bytes > CACHE_BYTES)
        return false;
    brume_cache_begin(&s_cache, v, spacing, s_codes);
    s_cache.to = s_codes + CACHE_BYTES;
    s_cache.blend = below(2) * below(ONE + 1u);
    return true;
}

static void light_of(struct brume_scene *s, const struct brume_volume *v,
                     uint32_t (*below)(uint32_t))
{
    uint32_t kind = below(6);
    if (kind == 0 && v->mips != NULL)
        s->light = BRUME_CONE;
    else if (kind == 1 && make_cache(v, below))
        s->light = BRUME_CACHE;
    else
        return;
    s->light_samples = (uint16_t)below(BRUME_MAX_LOG_SAMPLES + 1u);
}

/* Of volumes that have a second grid, half of the time. */
static void emission_of(struct brume_lighting *l, const struct brume_volume *v,
                        bool grey, uint32_t (*below)(uint32_t))
{
    static uint32_t s_colours[256][3];
    if (v->emission == NULL || below(2) == 0)
        return;
    for (int i = 0; i < 256; i++)
        colour_of(s_colours[i], grey, below);
    l->emission_colour = (const uint32_t(*)[3])s_colours;
    l->emission_scale = (uint64_t)below(0x7fffffffu) << below(4) * 2u;
}

void random_light_fill(struct brume_scene *out,
                       const struct brume_volume *volume,
                       uint32_t (*below)(uint32_t n))
{
    static const struct brume_lighting k_none;
    struct brume_lighting *l = &s_lighting;
    bool grey = below(2) == 0;
    make_tables(below);
    *l = k_none;
    l->octaves = below(3) == 0 ? 1 : below(BRUME_MAX_OCTAVES + 1u);
    l->octave_a = below(4) == 0 ? ONE : below(ONE);
    l->octave_b = below(4) == 0 ? ONE : below(ONE);
    if (below(3) != 0)
        l->phase = s_phase[below(MODELS)];
    colour_of(l->sun_colour, grey, below);
    l->exposure = below(2) == 0 ? 0 : 0x100u + below(2u * ONE);
    ambient_of(l, volume, grey, below);
    behind_of(l, below);
    light_of(out, volume, below);
    emission_of(l, volume, grey, below);
    l->cache = &s_cache;
    if (below(4) == 0)
        out->filter = BRUME_STOCHASTIC;
    if (below(3) == 0)
        out->output = BRUME_FILMIC;
    /* Cones and stochastic lookups do without. */
    if (out->light == BRUME_CACHE || below(5) != 0)
        out->lighting = l;
}
