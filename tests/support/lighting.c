/* SPDX-License-Identifier: MIT */
#include "lighting.h"

#if TEST_LIGHTING

#define SLOTS 40
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

#if BRUME_WITH_LAMPS
static struct brume_lamp s_lamps[BRUME_MAX_LAMPS];
static struct brume_clusters s_clusters;

/* The radius, Q16.16, of a sphere of a tenth of the box's volume; in whole
 * sixteenths of a voxel: 4/3 pi r^3 = V / 10, V in those is 42 r^3. */
static uint32_t tenth_of(const struct brume_volume *v)
{
    uint64_t box = 4096, r = 16;
    for (int i = 0; i < 3; i++)
        box *= v->box_max[i] - v->box_min[i] + 1u;
    while (42 * (r + 1) * (r + 1) * (r + 1) <= box)
        r++;
    return (uint32_t)r << 12;
}

/* A place from low to high, Q16.16, and moves the seed on. */
static int32_t place_of(uint32_t *seed, int32_t low, int32_t high)
{
    *seed = *seed * 1664525u + 1013904223u;
    uint32_t room = high > low ? (uint32_t)(high - low) : 0;
    return low + (int32_t)((uint64_t)room * (*seed >> 8) >> 24);
}

/* Anywhere in the box such that all of the reach is in it, where it fits. */
static void set_lamp(struct brume_lamp *p, const struct brume_volume *v,
                     const struct test_lighting *light, uint32_t *seed)
{
    static const struct brume_lamp k_none;
    *p = k_none;
    p->radius = tenth_of(v);
    p->size = 2 * ONE < p->radius ? 2 * ONE : p->radius;
    p->cos_outer = -(1 << 30);
    for (int i = 0; i < 3; i++) {
        int32_t low = v->box_min[i] * 65536, high = v->box_max[i] * 65536;
        int32_t reach = (int32_t)p->radius, half = (high - low) / 2;
        reach = reach < half ? reach : half;
        p->position[i] = place_of(seed, low + reach, high - reach);
        p->direction[i] = place_of(seed, -1000, 1000);
        p->colour[i] = 4 * ONE;
        if (light->colour)
            p->colour[i] = (uint32_t)place_of(seed, ONE, 8 * ONE);
    }
    if (!light->spots)
        return;
    p->direction[1] += 2000; /* never none */
    p->cos_outer = place_of(seed, -(1 << 29), 1 << 29);
    p->cos_inner = p->cos_outer + place_of(seed, 0, 1 << 28);
    p->shadow_samples = 3;
}

static void set_lamps(struct brume_lighting *l,
                      const struct test_lighting *light,
                      const struct brume_volume *v)
{
    uint32_t seed = 1;
    l->lamp_count = light->lamps;
    l->lamps = s_lamps;
    l->clusters = &s_clusters;
    for (uint32_t i = 0; i < light->lamps && i < BRUME_MAX_LAMPS; i++)
        set_lamp(&s_lamps[i], v, light, &seed);
}
#else
static void set_lamps(struct brume_lighting *l,
                      const struct test_lighting *light,
                      const struct brume_volume *v)
{
    l->lamp_count = light->lamps; /* refused */
    (void)v;
}
#endif

/// What there is besides the volume ///

#define SURFACE_WIDTH 48
#define SURFACE_HEIGHT 36
#define MAP_SIDE 16

static struct brume_fog s_fog[SLOTS];
static struct brume_fog_shape s_shapes[SLOTS][2];
static struct brume_surface s_surface;
static struct brume_sun_map s_sun_map[SLOTS];
static uint16_t s_depth[SURFACE_HEIGHT][SURFACE_WIDTH];
static uint16_t s_texels[MAP_SIDE][MAP_SIDE];

static uint32_t most_of(const int32_t v[3])
{
    uint32_t most = 1;
    for (int i = 0; i < 3; i++) {
        uint32_t m = (uint32_t)(v[i] < 0 ? -v[i] : v[i]);
        most = m > most ? m : most;
    }
    return most;
}

/* The longest side of the box in voxels, and its middle, Q16.16. */
static int32_t side_of(const struct brume_volume *v, int32_t middle[3])
{
    int32_t side[3];
    for (int i = 0; i < 3; i++) {
        side[i] = v->box_max[i] - v->box_min[i] + 1;
        middle[i] = (v->box_min[i] + v->box_max[i]) * 32768;
    }
    return (int32_t)most_of(side);
}

/* Fog up to the middle of the box; a sphere in it, a box beside that. */
static void set_fog(struct brume_lighting *l, uint32_t air, unsigned slot,
                    const struct brume_volume *v)
{
    struct brume_fog *fog = &s_fog[slot];
    struct brume_fog_shape *shapes = s_shapes[slot];
    int32_t middle[3], side = side_of(v, middle);
    fog->density = air & AIR_FOG ? 30000000u : 0; /* 0.007 */
    fog->base = middle[1];
    fog->falloff = (uint32_t)side * 0x4000u;
    fog->far = (uint32_t)side * 8u * ONE;
    fog->shapes = shapes;
    fog->shape_count = air & AIR_SHAPES ? 2 : 0;
    for (int i = 0; i < 3; i++) {
        shapes[0].centre[i] = middle[i];
        shapes[1].centre[i] = middle[i] + side * (i == 0 ? 0xb000 : 0);
        shapes[0].half[i] = shapes[1].half[i] = (uint32_t)side * 0x9000u + ONE;
    }
    shapes[0].kind = BRUME_FOG_SPHERE;
    shapes[0].density = 80000000u;
    shapes[0].softness = ONE / 2;
    shapes[1].kind = BRUME_FOG_BOX;
    shapes[1].density = 50000000u;
    shapes[1].softness = 0;
    l->fog = fog;
}

/* Slopes in and around the box, with holes. */
static void set_surface(struct brume_lighting *l, const struct brume_scene *s)
{
    int32_t way[3];
    for (int i = 0; i < 3; i++)
        way[i] = s->eye[i] - s->target[i];
    uint32_t distance = most_of(way); /* of all three, 1 to 1.7 times that */
    for (uint32_t y = 0; y < SURFACE_HEIGHT; y++)
        for (uint32_t x = 0; x < SURFACE_WIDTH; x++) {
            uint32_t part = 14u + (5u * x + 3u * y) % 17u;
            s_depth[y][x] = (uint16_t)brume_depth_of(distance / 20u * part);
            if ((x + 7u * y) % 5u == 0)
                s_depth[y][x] = 65535;
        }
    s_surface.depth = s_depth[0];
    s_surface.stride = SURFACE_WIDTH;
    l->surface = &s_surface;
}

/* Bars between the sun and the box, in a plane exactly across it. */
static void set_sun_map(struct brume_lighting *l, unsigned slot,
                        const struct brume_scene *s,
                        const struct brume_volume *v)
{
    struct brume_sun_map *m = &s_sun_map[slot];
    const int32_t *sun = s->sun; /* a few units */
    int32_t middle[3], side = side_of(v, middle);
    int32_t a[3] = {sun[1], -sun[0], 0};
    int32_t d[3] = {-sun[2] * a[1], sun[2] * a[0],
                    sun[0] * a[1] - sun[1] * a[0]};
    int32_t step[3] = {side * 0x20000 / (int32_t)most_of(a),
                       side * 0x20000 / (int32_t)most_of(d),
                       side * 0x10000 / (int32_t)most_of(sun)};
    for (int i = 0; i < 3; i++) {
        m->across[i] = a[i] * step[0];
        m->down[i] = d[i] * step[1];
        m->origin[i] =
            middle[i] + sun[i] * step[2] - m->across[i] / 2 - m->down[i] / 2;
    }
    for (int y = 0; y < MAP_SIDE; y++)
        for (int x = 0; x < MAP_SIDE; x++)
            s_texels[y][x] = (x ^ y) & 3 ? 65535 : (uint16_t)(900 * y);
    m->width = m->height = MAP_SIDE;
    m->stride = MAP_SIDE;
    m->range = (uint32_t)side * 4u * ONE;
    m->bias = ONE / 2;
    m->depth = s_texels[0];
    l->sun_map = m;
}

static void set_air(struct brume_lighting *l, uint32_t air, unsigned slot,
                    const struct brume_scene *s, const struct brume_volume *v)
{
    if (air & (AIR_FOG | AIR_SHAPES))
        set_fog(l, air, slot, v);
    if (air & AIR_SURFACE)
        set_surface(l, s);
    if (air & AIR_SUN_MAP)
        set_sun_map(l, slot, s, v);
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
    set_air(l, light->air, slot, out, volume);
    l->exposure = light->filmic ? ONE / 2 : 0;
    if (light->filmic)
        out->output = BRUME_FILMIC;
    set_lamps(l, light, volume);
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
