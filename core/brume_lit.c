/* SPDX-License-Identifier: MIT */
/*
 * The march with lighting: docs/light.md. One function for every volume and
 * scene, with its choices made at run time: a lookup costs a branch more than
 * in brume_march.c, whose kernels serve scenes that need none of this. Where
 * a build has one format and one lookup, that branch is gone.
 */
#include "brume_ambient.h"
#include "brume_emission.h"
#include "brume_sun.h"

#if BRUME_WITH_LIGHTING

/// Densities ///

#if BRUME_WITH_STOCHASTIC
/* As trilinear without an apron, but of the eight voxels one: that at p +
 * moved. */
BRUME_INLINE bool stochastic_at(const struct brume_frame *f, uint32_t x,
                                uint32_t y, uint32_t z, uint32_t *d,
                                const uint32_t moved[3], struct kernel k)
{
    uint32_t cell = cell_at(f->volume, x, y, z);
    *d = cell;
    if (cell & BRUME_CELL_EMPTY &&
        ((cell & 255u) > 1 || !on_high_face(x, y, z)))
        return false;
    if (!density_at(f, x + moved[0], y + moved[1], z + moved[2], d, k))
        *d = 0;
    return true;
}
#else
BRUME_INLINE bool stochastic_at(const struct brume_frame *f, uint32_t x,
                                uint32_t y, uint32_t z, uint32_t *d,
                                const uint32_t moved[3], struct kernel k)
{
    (void)moved;
    return density_at(f, x, y, z, d, k);
}
#endif

#define DENSITY(format, apron, tri, clamp) \
    case KERNEL_ID(format, apron, tri, 0, clamp): \
        if (KERNEL_HAS(format, apron, tri, 0, clamp)) { \
            static const struct kernel k = \
                KERNEL_OF(format, apron, tri, 0, clamp); \
            if (!(tri) && BRUME_WITH_STOCHASTIC && f->lit.stochastic) \
                return stochastic_at(f, x, y, z, d, moved, k); \
            return density_at(f, x, y, z, d, k); \
        } \
        break;
#define DENSITIES_CLAMP(format, apron, tri) \
    DENSITY(format, apron, tri, 0) DENSITY(format, apron, tri, 1)
#define DENSITIES_LOOKUP(format, apron) \
    DENSITIES_CLAMP(format, apron, 0) DENSITIES_CLAMP(format, apron, 1)
#define DENSITIES(format) \
    DENSITIES_LOOKUP(format, 0) DENSITIES_LOOKUP(format, 1)

bool brume_lit_density(const struct brume_frame *frame, uint32_t x, uint32_t y,
                       uint32_t z, uint32_t *d, const uint32_t moved[3])
{
    const struct brume_frame *f = frame;
    switch (f->kernel & ~2u) { /* whatever its light */
        DENSITIES(BRUME_U8)
        DENSITIES(BRUME_U8R)
        DENSITIES(BRUME_U4R)
    default: break;
    }
    *d = BRUME_CELL_EMPTY | 1u;
    return false;
}

/* What a lookup needs: margins are those of brume_frame. */
static struct kernel kernel_of(const struct gathered *g)
{
    struct kernel k = KERNEL_OF(BRUME_U8R, 0, true, false, false);
    k.moved = g->moved;
    return k;
}

#if BRUME_WITH_CACHE
uint32_t brume_lit_sun_sum(const struct brume_frame *frame, const uint32_t p[3])
{
    /* a stochastic lookup in its middle */
    static const struct gathered k_middle = {
        .moved = {0x8000u, 0x8000u, 0x8000u}};
    const struct kernel k = kernel_of(&k_middle);
    uint32_t reach = frame->light.samples >> 1, d;
    if (!find_density(frame, p[0], p[1], p[2], &d, k))
        d = 0;
    return sun_sum(frame, &frame->light, p, d, &reach, &k);
}
#endif

/// Ray ///

/* a n / 2^down, at most 2^32 - 1; exact for n = 1. */
static uint32_t times_number(uint32_t a, uint32_t down, struct brume_number n)
{
    uint32_t high = mul_hi_floor(a, n.m), low = a * n.m;
    int32_t up = n.e + 32 - (int32_t)down; /* 1 has m = 2^31, e = -31 */
    if (up <= 0)
        return up > -32 ? high >> (uint32_t)-up : 0;
    if (up > 31 || high >> (32u - (uint32_t)up) != 0)
        return high | low ? 0xffffffffu : 0;
    return high << (uint32_t)up | low >> (32u - (uint32_t)up);
}

/* Sum of octaves with their phase, Q29 less the headroom; held to what fits. */
static uint32_t sun_light(const struct brume_frame *f, const struct gathered *g,
                          const int32_t unit[3])
{
    const struct brume_lighting *l = f->lit.lighting;
    bool peaked = l != NULL && l->phase != NULL;
    uint32_t u = peaked ? brume_one_minus_cos(unit, f->sun) : 0, sum = 0;
    for (uint32_t i = 0; i < f->lit.octaves; i++) {
        uint32_t a = g->sun[i];
        if (f->lit.weight[i] != 0xffffffffu)
            a = mul_hi_floor(a, f->lit.weight[i]);
        if (peaked)
            a = times_number(a, f->lit.headroom,
                             brume_phase_value(&l->phase[i], u));
        sum = sum + a < sum ? 0xffffffffu : sum + a;
    }
    return sum;
}

/* light * scale, Q3.29 * Q16.16 -> Q16.16, rounded. scale < 2^29. */
static uint32_t scaled(uint32_t light, uint32_t scale)
{
    uint32_t high = mul_hi_floor(light, scale), low = light * scale;
    return (high << 3 | low >> 29) + (low >> 28 & 1u);
}

static uint32_t channel_of(const struct brume_frame *f,
                           const struct gathered *g, uint32_t sun, uint32_t c)
{
    uint32_t light = scaled(sun, f->lit.sun[c] << f->lit.headroom);
#if BRUME_WITH_AMBIENT
    for (uint32_t j = 0; j < 6 && f->lit.ambient != BRUME_AMBIENT_NONE; j++)
        if (g->sky[j] != 0)
            light += scaled(g->sky[j], f->lit.ambient_colour[j][c]);
#else
    (void)g;
#endif
#if BRUME_WITH_EMISSION
    if (f->lit.emits) /* Q6.26: three bits less than scaled() takes */
        light += scaled(g->glow[c], f->lit.exposure << 3);
#endif
    return light < BRUME_MAX_LIGHT ? light : BRUME_MAX_LIGHT;
}

#if BRUME_WITH_SKY
/* exp(-distance / haze), Q2.30, of a depth code. */
static uint32_t clear_of(const struct brume_frame *f, uint32_t depth)
{
    uint32_t high = depth >> 11, m = depth & 0x7ffu;
    uint32_t way =
        high > 11 ? (m | 0x800u) << (high - 11u) : (m | 0x800u) >> (11u - high);
    uint32_t tau = mul_hi_floor(way, f->lit.haze); /* Q16.16 */
    if (tau >= 16u << 16)
        return 0;
    tau >>= 4;
    return (uint32_t)brume_exp_coarse[tau >> 8] * brume_exp_fine[tau & 255u];
}
#endif

void brume_lit_finish(const struct brume_frame *frame, const struct gathered *g,
                      const int32_t unit[3], uint32_t transmittance,
                      struct brume_radiance *out)
{
    const struct brume_frame *f = frame;
    uint32_t sun = sun_light(f, g, unit), clear = 1u << 30;
#if BRUME_WITH_SKY
    if (f->lit.haze != 0 && out->depth != BRUME_NO_DEPTH) {
        clear = clear_of(f, out->depth);
        transmittance =
            (1u << 31) - (mul_hi_floor((1u << 31) - transmittance, clear) << 2);
    }
#endif
    out->transmittance = (transmittance + 0x4000u) >> 15;
    uint32_t light[3];
    for (uint32_t c = 0; c < (BRUME_WITH_COLOUR ? 3u : 1u); c++) {
        light[c] = channel_of(f, g, sun, c);
        if (clear != 1u << 30)
            light[c] = (mul_hi_floor(light[c] << 3, clear) + 1u) >> 1;
#if BRUME_WITH_COLOUR
        if (!f->lit.colour)
            break;
#endif
    }
    out->light = light[0];
#if BRUME_WITH_COLOUR
    out->green = f->lit.colour ? light[1] : 0;
    out->blue = f->lit.colour ? light[2] : 0;
#endif
}

#if BRUME_WITH_STOCHASTIC
/* Where sample n of a ray looks. */
static void move_lookup(struct gathered *g, const struct brume_ray *ray,
                        uint32_t n)
{
    for (uint32_t i = 0; i < 3; i++)
        g->moved[i] = (ray->noise[i] + brume_r3(n, i)) & 0xffffu;
}
#endif

/* A sample's light: `lost` of the ray's transmittance, Q1.31, scatters what
 * `sum` lets through of the sun, and of the sky. */
static void add_light(const struct brume_frame *f, struct gathered *g,
                      const struct brume_ray *ray, const uint32_t p[3],
                      uint32_t lost, uint32_t sum, const struct kernel *k)
{
    for (uint32_t i = 0; i < f->lit.octaves; i++)
        g->sun[i] += mul_hi_floor(lost, transmittance_of(&f->lit.tau[i], sum));
#if BRUME_WITH_AMBIENT
    if (f->lit.ambient != BRUME_AMBIENT_NONE)
        add_sky(f, g, ray, p, lost, k);
#else
    (void)ray, (void)p, (void)k;
#endif
    g->lit++;
}

void brume_lit_march(const struct brume_frame *frame,
                     const struct brume_ray *ray, struct brume_radiance *out)
{
    const struct brume_frame *f = frame;
    static const struct gathered k_none;
    struct gathered g = k_none;
    const struct kernel k = kernel_of(&g);
    const struct brume_line *line = &ray->line;
    uint32_t p[3] = {ray->position[0], ray->position[1], ray->position[2]};
    uint32_t transmittance = 1u << 31; /* Q1.31 */
    uint32_t left = ray->count, reach = 0, m, d;
#if BRUME_WITH_DEPTH
    uint32_t where = 0;
#endif
    BRUME_TALLY(rays_in_pool, 1);
    for (;;) {
        m = 1;
        BRUME_TALLY(view_samples, 1);
#if BRUME_WITH_STOCHASTIC
        if (f->lit.stochastic)
            move_lookup(&g, ray, ray->count - left);
#endif
        if (!find_density(f, p[0], p[1], p[2], &d, k)) {
            m = leap(f, line, p[0], p[1], p[2], d, k);
        } else if (d > f->min_density || emits(f)) {
            bool dense = d > f->min_density;
            uint32_t fade = dense ? opacity(f, d, is_narrow_frame(f)) : 0;
            uint32_t glowing = 0;
            if (emits(f)) {
                uint32_t share = fade; /* fade stays in a register */
                glowing = glow_of(f, &g, p, transmittance, &share);
                fade = share;
            }
            uint32_t lost = mul_hi_floor(transmittance, fade);
            if (dense) {
                BRUME_TALLY(lit_samples, 1);
                uint32_t sum = sun_sum(f, &ray->light, p, d, &reach, &k);
                add_light(f, &g, ray, p, lost, sum, &k);
            }
            lost += glowing;
            transmittance -= lost;
#if BRUME_WITH_DEPTH
            where += moment(lost, ray->count - left);
#endif
            if (transmittance < f->min_transmittance)
                break;
        }
        if (m >= left)
            break;
        left -= m;
        for (int i = 0; i < 3; i++)
            p[i] += m * (uint32_t)line->move[i];
    }
#if BRUME_WITH_DEPTH
    out->depth = 0;
    if (f->depth)
        out->depth =
            brume_mean_depth(f, ray->t, where, (1u << 31) - transmittance);
#endif
    brume_lit_finish(f, &g, ray->unit, transmittance, out);
}

#endif
