/* SPDX-License-Identifier: MIT */
/* What a frame makes of its scene's lighting: docs/light.md. */
#include "brume_inner.h"

#if BRUME_WITH_LIGHTING

static bool colours_are_good(const uint32_t (*c)[3], uint32_t n)
{
    for (uint32_t i = 0; i < n; i++)
        for (int k = 0; k < 3; k++)
            if (c[i][k] > 16u << 16)
                return false;
    return true;
}

static bool directions_are_good(const struct brume_lighting *l)
{
    const struct brume_direction_table *t = l->directions;
    return t != NULL && t->values != NULL && t->width_log2 >= 3 &&
           t->width_log2 <= 8 && t->height_log2 >= 3 && t->height_log2 <= 8 &&
           t->frames_log2 <= 6 &&
           l->visibility_samples <= BRUME_MAX_LOG_SAMPLES &&
           l->visibility_step >= BRUME_MIN_STEP &&
           l->visibility_step <= BRUME_MAX_STEP;
}

static bool ambient_is_good(const struct brume_lighting *l)
{
    return l->ambient <= BRUME_AMBIENT_CUBE &&
           l->visibility <= BRUME_SKY_BAKED &&
           colours_are_good(l->ambient_colour,
                            brume_ambient_colours(l->ambient)) &&
           (l->ambient == BRUME_AMBIENT_NONE ||
            l->visibility != BRUME_SKY_SAMPLED || directions_are_good(l));
}

static bool sky_is_good(const struct brume_lighting *l)
{
    return !l->sky ||
           (colours_are_good(&l->sky_zenith, 1) &&
            colours_are_good(&l->sky_horizon, 1) &&
            colours_are_good(&l->sky_ground, 1) &&
            colours_are_good(&l->sun_disc, 1) && l->sun_size <= 1u << 31);
}

/* Does the lighting ask for what is not compiled in? */
static bool is_missing(const struct brume_scene *s)
{
    const struct brume_lighting *l = s->lighting;
    return (!BRUME_WITH_COLOUR && brume_scene_has_colour(s)) ||
           (!BRUME_WITH_AMBIENT && l->ambient != BRUME_AMBIENT_NONE) ||
           (!BRUME_WITH_SKY && (l->sky || l->haze != 0)) ||
           (!BRUME_WITH_FOG && l->fog != NULL) ||
           (!BRUME_WITH_SURFACE &&
            (l->surface != NULL || l->sun_map != NULL)) ||
           (!BRUME_WITH_DITHER && l->dither) ||
           (!BRUME_WITH_LAMPS && l->lamp_count != 0) ||
           (!BRUME_WITH_EMISSION && l->emission_colour != NULL);
}

static bool cache_is_good(const struct brume_lighting *l)
{
    const struct brume_cache *c = l != NULL ? l->cache : NULL;
    return c != NULL && c->from != NULL && (c->blend == 0 || c->to != NULL) &&
           c->spacing_log2 >= 1 && c->spacing_log2 <= 3 && c->blend <= 0x10000u;
}

/* Fog, surface, sun map: what is there besides the volume. */
static bool world_is_good(const struct brume_scene *s)
{
    const struct brume_lighting *l = s->lighting;
    bool good = true;
    (void)l;
#if BRUME_WITH_FOG
    good = good && (l->fog == NULL || brume_fog_is_good(l->fog));
#endif
#if BRUME_WITH_SURFACE
    good =
        good &&
        (l->surface == NULL || brume_surface_is_good(l->surface, s->width)) &&
        (l->sun_map == NULL || brume_sun_map_is_good(l->sun_map));
#endif
    return good;
}

int brume_lit_check(const struct brume_scene *scene)
{
    const struct brume_lighting *l = scene->lighting;
    if (scene->light == BRUME_CACHE && !cache_is_good(l))
        return BRUME_ERR_SCENE;
    if (l == NULL)
        return BRUME_OK;
    if (l->octaves > BRUME_MAX_OCTAVES || l->octave_a > 0x10000u ||
        l->octave_b > 0x10000u ||
        (l->exposure != 0 &&
         (l->exposure < 0x100u || l->exposure > 16u << 16)) ||
        !colours_are_good(&l->sun_colour, 1) || !ambient_is_good(l) ||
        (BRUME_WITH_EMISSION && l->emission_colour != NULL &&
         !colours_are_good(l->emission_colour, 256)) ||
        !sky_is_good(l) || (l->haze != 0 && l->haze < 0x10000u) ||
        !world_is_good(scene))
        return BRUME_ERR_SCENE;
    return is_missing(scene) ? BRUME_ERR_FEATURE : BRUME_OK;
}

void brume_lit_colour(uint32_t out[3], const struct brume_scene *scene,
                      const uint32_t colour[3])
{
    const struct brume_scene *s = scene;
    uint32_t exposure = s->lighting->exposure;
    for (int c = 0; c < 3; c++) {
        /* Q16 * Q16 -> Q16; the first factor is at most 1 */
        uint32_t a = mul_hi_floor(s->albedo << 15, colour[c]);
        uint32_t low = (s->albedo << 15) * colour[c];
        a = (a << 1 | low >> 31) + (low >> 30 & 1u);
        if (exposure != 0 && exposure != 0x10000u)
            a = mul_hi_floor(a << 5, exposure << 11);
        out[c] = a;
    }
}

/* What a dim sun leaves of the limit to a phase function's peak, log2. */
static uint8_t headroom_of(const uint32_t sun[3])
{
    uint32_t any = sun[0] | sun[1] | sun[2];
    return (uint8_t)(any < 0x10000u ? leading_zeros(any) - 15u : 0);
}

/* a^i, from 1 on, Q0.32, all ones for 1 */
static uint32_t power_of(uint32_t a, uint32_t i)
{
    uint32_t p = 0xffffffffu, base = a == 0x10000u ? p : a << 16;
    for (; i > 0; i--)
        p = p == 0xffffffffu      ? base
            : base == 0xffffffffu ? p
                                  : mul_hi_floor(p, base);
    return p;
}

#if BRUME_WITH_AMBIENT
/* The low end and the height of the volume's box along zenith, in positions
 * that carry the bias of the frame's. */
static void set_heights(struct brume_frame *f, const struct brume_scene *s)
{
    const struct brume_volume *v = f->volume;
    int32_t low = 0, high = 0; /* Q17.14 */
    for (int i = 0; i < 3; i++) {
        /* from face to face, half a voxel beyond the centres */
        int32_t bias = f->eye[i] - s->eye[i], up = f->lit.zenith[i];
        int32_t a = v->box_min[i] * 65536 + bias - 0x8000;
        int32_t b = v->box_max[i] * 65536 + bias + 0x8000;
        low += mul_both_signed_round(up < 0 ? b : a, up, 0);
        high += mul_both_signed_round(up < 0 ? a : b, up, 0);
    }
    f->lit.low = low;
    f->lit.height = (uint32_t)(high - low);
    f->lit.per_height = brume_number_inverse(brume_number_of(f->lit.height, 0));
}

/* Two axes across zenith, and zenith, times the step of visibility. */
static void set_sky_axes(struct brume_frame *f, uint32_t step)
{
    const int32_t *up = f->lit.zenith;
    int32_t axis[3][3] = {{0}, {0}, {up[0], up[1], up[2]}};
    /* the axis that zenith is least along, less what is along zenith */
    int least = 0;
    for (int i = 1; i < 3; i++)
        if (magnitude(up[i]) < magnitude(up[least]))
            least = i;
    axis[0][least] = 1 << 30;
    for (int i = 0; i < 3; i++)
        axis[0][i] -= mul_both_signed_round(up[least], up[i], 2);
    brume_normalise(axis[0]);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        axis[1][i] = mul_both_signed_round(up[j], axis[0][k], 2) -
                     mul_both_signed_round(up[k], axis[0][j], 2);
    }
    for (int n = 0; n < 3; n++)
        for (int i = 0; i < 3; i++)
            f->lit.sky_axis[n][i] = mul_signed_round(axis[n][i], step, 2);
}

static int set_ambient(struct brume_frame *f, const struct brume_scene *s)
{
    const struct brume_lighting *l = s->lighting;
    uint32_t n = brume_ambient_colours(l->ambient);
    f->lit.visibility = l->visibility;
    if (l->visibility == BRUME_SKY_BAKED && f->volume->sky == NULL)
        return BRUME_ERR_SECTION;
    for (uint32_t j = 0; j < n; j++)
        brume_lit_colour(f->lit.ambient_colour[j], s, l->ambient_colour[j]);
    if (n == 6 && l->visibility != BRUME_SKY_SAMPLED)
        for (int c = 0; c < 3; c++) {
            uint32_t sum = 3; /* six of at most 2^24 */
            for (int j = 0; j < 6; j++)
                sum += f->lit.ambient_colour[j][c];
            f->lit.ambient_colour[0][c] = sum / 6u;
        }
    set_heights(f, s);
    f->lit.sky_samples = l->visibility_samples;
    if (l->visibility == BRUME_SKY_SAMPLED) {
        set_sky_axes(f, l->visibility_step);
        /* A doubled distance of 32768 voxels would not fit the word. */
        while (f->lit.sky_samples > 0 &&
               (l->visibility_step * 2u) >> (32u - f->lit.sky_samples) != 0)
            f->lit.sky_samples--;
    }
    return BRUME_OK;
}
#endif

int brume_lit_begin(struct brume_frame *frame, const struct brume_scene *scene)
{
    static const struct brume_lit k_none;
    struct brume_frame *f = frame;
    const struct brume_lighting *l = scene->lighting;
    f->lit = k_none;
    f->lit.octaves = 1;
    f->lit.weight[0] = 0xffffffffu;
    f->lit.on = brume_scene_is_lit(scene);
    f->lit.light = scene->light;
    f->lit.stochastic = scene->filter == BRUME_STOCHASTIC;
#if BRUME_WITH_AMBIENT || BRUME_WITH_SKY || BRUME_WITH_FOG
    for (int i = 0; i < 3 && l != NULL; i++)
        f->lit.zenith[i] = l->zenith[i];
    if (!brume_normalise(f->lit.zenith))
        f->lit.zenith[1] = 1 << 30;
#endif
    for (int c = 0; c < 3; c++)
        f->lit.sun[c] = scene->albedo;
#if BRUME_WITH_CONE
    if (scene->light == BRUME_CONE && f->volume->mips == NULL)
        return BRUME_ERR_SECTION;
    f->lit.cone_level =
        (int8_t)(15 - (int32_t)leading_zeros(scene->light_step) +
                 BRUME_CONE_LEVEL);
#endif
    if (l == NULL)
        return BRUME_OK;
    f->lit.lighting = l;
    f->lit.octaves = l->octaves > 1 ? l->octaves : 1;
    for (uint32_t i = 0; i < f->lit.octaves; i++)
        f->lit.weight[i] = power_of(l->octave_b, i);
    brume_lit_colour(f->lit.sun, scene, l->sun_colour);
    if ((f->lit.sun[0] | f->lit.sun[1] | f->lit.sun[2]) == 0)
        f->lit.light = BRUME_NO_LIGHT;
    else if (l->phase != NULL)
        f->lit.headroom = headroom_of(f->lit.sun);
    f->lit.light_log2 = scene->output == BRUME_FILMIC ? 3 : 0;
#if BRUME_WITH_COLOUR
    f->lit.colour = brume_scene_has_colour(scene);
#endif
#if BRUME_WITH_CACHE
    if (scene->light == BRUME_CACHE) {
        f->lit.cache = *l->cache;
        for (int i = 0; i < 3; i++) /* of this volume? */
            if (l->cache->size[i] !=
                8u * f->volume->cell_count[i] >> l->cache->spacing_log2)
                return BRUME_ERR_SCENE;
    }
#endif
#if BRUME_WITH_DITHER
    f->lit.dither = l->dither;
#endif
#if BRUME_WITH_SURFACE
    if (l->sun_map != NULL && !brume_sun_map_begin(f, scene))
        return BRUME_ERR_SCENE;
#endif
#if BRUME_WITH_FOG
    for (uint32_t i = 0; i < f->lit.octaves; i++)
        f->lit.fog.extinction[i] = power_of(l->octave_a, i);
    if (l->fog != NULL)
        brume_fog_begin(f, scene);
#endif
#if BRUME_WITH_EMISSION
    f->lit.emits = l->emission_colour != NULL && l->emission_scale != 0;
    f->lit.exposure = l->exposure != 0 ? l->exposure : 0x10000u;
    if (l->emission_colour != NULL && f->volume->emission == NULL)
        return BRUME_ERR_SECTION;
#endif
#if BRUME_WITH_AMBIENT
    f->lit.ambient = l->ambient;
    if (l->ambient != BRUME_AMBIENT_NONE)
        return set_ambient(f, scene);
#endif
    return BRUME_OK;
}

uint32_t brume_lit_sameness(const struct brume_frame *frame)
{
    /* Words of what the frame made of its lighting; pointers and what is
     * behind the volume do not count. */
    const struct brume_lit *l = &frame->lit;
    uint32_t h = l->light + l->octaves * 16u + (l->stochastic ? 256u : 0);
#if BRUME_WITH_CACHE
    h ^= l->cache.blend << 12; /* goes on while a cache is being made */
#endif
    for (uint32_t i = 0; i < BRUME_MAX_OCTAVES; i++)
        h = (h * 16777619u ^ l->tau[i].m) * 16777619u ^
            (l->tau[i].shift ^ l->weight[i]);
    for (int c = 0; c < 3; c++)
        h = h * 16777619u ^ l->sun[c];
#if BRUME_WITH_FOG
    if (l->fog.on)
        h = h * 16777619u ^ brume_fog_sameness(frame);
#endif
#if BRUME_WITH_SURFACE
    if (l->sun_map != NULL)
        h = h * 16777619u ^ brume_sun_map_sameness(frame);
#endif
#if BRUME_WITH_AMBIENT
    h = h * 16777619u ^ (l->ambient | (uint32_t)l->visibility << 8);
    for (int j = 0; j < 6; j++)
        for (int c = 0; c < 3; c++)
            h = h * 16777619u ^ l->ambient_colour[j][c];
#endif
#if BRUME_WITH_EMISSION
    for (uint32_t i = 0; l->emits && i < 256; i++) {
        const uint32_t *colour = l->lighting->emission_colour[i];
        h = h * 16777619u ^ l->emission[i];
        h = h * 16777619u ^ l->emission[256 + i];
        for (int c = 0; c < 3; c++)
            h = h * 16777619u ^ colour[c];
    }
    h = h * 16777619u ^ (l->emits ? l->exposure : 0);
#endif
    return h;
}

#endif
