/* SPDX-License-Identifier: MIT */
#include "random_light.h"

#define ONE 0x10000u
#define CACHE_BYTES 65536u
#define DIRECTIONS (8u * 16u * 4u)
#define MODELS 4
#define DEPTHS 1024u /* of surfaces up to 24x24 and of sun maps */

static struct brume_lighting s_lighting;
static struct brume_cache s_cache;
static struct brume_phase s_phase[MODELS][BRUME_MAX_OCTAVES];
static struct brume_direction_table s_directions;
static uint8_t s_codes[2 * CACHE_BYTES];
static int8_t s_ways[3 * DIRECTIONS];
static bool s_made;
static struct brume_lamp s_lamps[BRUME_MAX_LAMPS];
static struct brume_clusters s_clusters;
static struct brume_fog s_fog;
static struct brume_fog_shape s_shape;
static struct brume_surface s_surface;
static struct brume_sun_map s_sun_map;
static uint16_t s_depth[DEPTHS];

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

/* Now and then, as it is slow and the core's own. */
static void fog_of(struct brume_lighting *l, const struct brume_volume *v,
                   uint32_t (*below)(uint32_t))
{
    s_fog.density = below(2) * below(1u << below(32));
    s_fog.base = (int32_t)below(100u * ONE);
    s_fog.falloff = below(2) * (ONE + below(50u * ONE));
    s_fog.far = ONE + below(200u * ONE);
    s_fog.shapes = &s_shape;
    s_fog.shape_count = below(2);
    s_shape.kind = (uint8_t)below(2);
    s_shape.softness = below(ONE + 1u);
    s_shape.density = below(1u << below(32));
    for (int i = 0; i < 3; i++) {
        s_shape.centre[i] = (int32_t)below(v->box_max[i] * 2u * ONE);
        s_shape.half[i] = ONE + below(40u * ONE);
    }
    l->fog = &s_fog;
}

/* Across the sun when that is along +y; else the frame is refused. */
static void sun_map_of(struct brume_lighting *l, struct brume_scene *s,
                       uint32_t (*below)(uint32_t))
{
    static const struct brume_sun_map k_none;
    s->sun[0] = s->sun[2] = 0;
    s->sun[1] = 1;
    s_sun_map = k_none;
    s_sun_map.width = (uint16_t)(1u + below(32));
    s_sun_map.height = (uint16_t)(1u + below(32));
    s_sun_map.stride = 32;
    s_sun_map.depth = s_depth;
    s_sun_map.range = (16u + below(200)) * ONE;
    s_sun_map.bias = below(2u * ONE);
    for (int i = 0; i < 3; i++)
        s_sun_map.origin[i] = (int32_t)below(80u * ONE);
    s_sun_map.across[0] = (int32_t)(ONE + below(80u * ONE));
    s_sun_map.down[2] = -(int32_t)(ONE + below(80u * ONE));
    l->sun_map = &s_sun_map;
}

static void surface_of(struct brume_lighting *l, const struct brume_scene *s,
                       uint32_t (*below)(uint32_t))
{
    uint32_t distance = 1;
    for (int i = 0; i < 3; i++) {
        int32_t way = s->eye[i] / 2 - s->target[i] / 2;
        distance += (uint32_t)(way < 0 ? -way : way);
    }
    for (uint32_t i = 0; i < DEPTHS; i++)
        s_depth[i] =
            (uint16_t)(below(6) == 0 ? 65535u * below(2)
                                     : brume_depth_of(below(distance) * 2u));
    s_surface.depth = s_depth;
    s_surface.stride = 24;
    l->surface = &s_surface;
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

/* A few lamps in and around the volume; none in most scenes. */
static void lamps_of(struct brume_lighting *l, const struct brume_volume *v,
                     bool grey, uint32_t (*below)(uint32_t))
{
    static const struct brume_lamp k_none;
    l->lamps = s_lamps;
    l->clusters = &s_clusters;
    l->lamp_count = below(4) == 0 ? below(BRUME_MAX_LAMPS + 1u) : 0;
    for (uint32_t n = 0; n < l->lamp_count; n++) {
        struct brume_lamp *p = &s_lamps[n];
        *p = k_none;
        p->radius = ONE + below(60u * ONE);
        p->size = ONE / 16 + below(p->radius - ONE / 16 + 1u);
        p->cos_outer = -(1 << 30);
        if (below(2) == 0)
            p->cos_outer = (int32_t)below(1u << 30) - (1 << 29);
        p->cos_inner = p->cos_outer + (int32_t)below(1u << 29);
        p->shadow_samples = (uint8_t)(below(2) * below(6));
        colour_of(p->colour, grey, below);
        for (int i = 0; i < 3; i++) {
            p->direction[i] = (int32_t)below(21) - 10;
            p->position[i] = (int32_t)below(12u * v->cell_count[i] * ONE) -
                             2 * v->cell_count[i] * (int32_t)ONE;
        }
        p->direction[1] += 20;
    }
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
    lamps_of(l, volume, grey, below);
    emission_of(l, volume, grey, below);
    l->cache = &s_cache;
    if (below(3) == 0)
        surface_of(l, out, below);
    if (below(16) == 0)
        sun_map_of(l, out, below);
    if (below(32) == 0)
        fog_of(l, volume, below);
    if (below(4) == 0)
        out->filter = BRUME_STOCHASTIC;
    if (below(3) == 0)
        out->output = BRUME_FILMIC;
    /* Cones and stochastic lookups do without. */
    if (out->light == BRUME_CACHE || below(5) != 0)
        out->lighting = l;
}
