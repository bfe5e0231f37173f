/* SPDX-License-Identifier: MIT */
/*
 * The march with lighting: docs/light.md. One function for every volume and
 * scene, with its choices made at run time: a lookup costs a branch more than
 * in brume_march.c, whose kernels serve scenes that need none of this. Where
 * a build has one format and one lookup, that branch is gone.
 */
#include "brume_air.h"
#include "brume_ambient.h"
#include "brume_emission.h"
#include "brume_fog.h"
#include "brume_lamp_light.h"
#include "brume_sun.h"
#include "brume_sun_map.h"

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
            a = brume_times(a, f->lit.headroom,
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
#endif
#if BRUME_WITH_LAMPS
    light += (g->lamp[c] >> 13) + (g->lamp[c] >> 12 & 1u);
#endif
#if BRUME_WITH_EMISSION
    if (f->lit.emits) /* Q6.26: three bits less than scaled() takes */
        light += scaled(g->glow[c], f->lit.exposure << 3);
#endif
    (void)g;
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

/* A march under way. */
struct walk {
    struct gathered g;
    uint32_t p[3];          /* the sample, Q16.16 */
    uint32_t index;         /* and its number, from the ray's first */
    uint32_t transmittance; /* Q1.31 */
    uint32_t reach;         /* of the light ray */
#if BRUME_WITH_FOG
    bool outside; /* of the pool? */
#endif
#if BRUME_WITH_DEPTH
    uint32_t where; /* sum of moments */
#endif
};

/* Is there more than the volume, the sun and the sky? The loop is compiled
 * twice, and where there is not `more` is a constant: what a scene does not
 * use costs it nothing. */
#define HAS_MORE \
    (BRUME_WITH_FOG || BRUME_WITH_LAMPS || BRUME_WITH_EMISSION || \
     BRUME_WITH_SURFACE)
#if HAS_MORE
static bool has_more(const struct brume_frame *f)
{
    bool more = brume_has_fog(f);
#if BRUME_WITH_LAMPS
    more = more || f->lit.clusters != NULL;
#endif
#if BRUME_WITH_EMISSION
    more = more || f->lit.emits;
#endif
#if BRUME_WITH_SURFACE
    more = more || f->lit.sun_map != NULL;
#endif
    return more;
}
#endif

BRUME_INLINE bool is_inside(const struct walk *w, bool more)
{
#if BRUME_WITH_FOG
    return !(more && w->outside);
#else
    (void)w, (void)more;
    return true;
#endif
}

/* What is at a sample. */
struct matter {
    uint32_t d;       /* density, in codes of the kernel */
    uint32_t opacity; /* Q0.32 */
    bool any;
#if BRUME_WITH_EMISSION
    bool glows; /* may it? */
#endif
#if BRUME_WITH_FOG
    struct fog fog;
#endif
};

/* Looks for it; how many samples there are to the next that may hold
 * something. */
BRUME_INLINE uint32_t find_matter(const struct brume_frame *f,
                                  const struct brume_ray *ray,
                                  const struct walk *w, struct matter *at,
                                  const struct kernel *k, bool more)
{
    const uint32_t *p = w->p;
    uint32_t m = 1;
    at->d = at->opacity = 0;
    at->any = false;
#if BRUME_WITH_EMISSION
    at->glows = false;
#endif
    if (is_inside(w, more) && !find_density(f, p[0], p[1], p[2], &at->d, *k)) {
        m = leap(f, &ray->line, p[0], p[1], p[2], at->d, *k);
        at->d = 0;
    } else {
#if BRUME_WITH_EMISSION
        at->any = at->glows = more && f->lit.emits && is_inside(w, more);
#endif
        if (at->d > f->min_density) {
            at->any = true;
            at->opacity = opacity(f, at->d, is_narrow_frame(f));
        }
    }
#if BRUME_WITH_FOG
    if (more && brume_has_fog(f)) {
        m = 1;
        at->fog = fog_at(f, p);
        at->any = at->any || at->fog.all != 0;
        at->opacity += mul_hi_floor(fog_opacity(f, at->fog.all), ~at->opacity);
    }
#endif
    return m;
}

/* Sunlight that `lost` of the ray's transmittance scatters, Q1.31. */
BRUME_INLINE void add_sun(const struct brume_frame *f,
                          const struct brume_ray *ray, struct walk *w,
                          const struct matter *at, uint32_t lost,
                          const struct kernel *k, bool more)
{
    uint32_t sum = 0;
    (void)more; /* in builds without what it tells of */
#if BRUME_WITH_SURFACE
    if (more && f->lit.sun_map != NULL) { /* Q31 * Q16 -> Q31 */
        uint32_t share = sun_map_light(f, w->p);
        if (share == 0)
            return;
        if (share < 0x10000u)
            lost = mul_hi_floor(lost, share << 16);
    }
#endif
#if BRUME_WITH_FOG
    if (more && brume_has_fog(f)) {
        uint32_t depth = fog_depth(f, &ray->light, w->p, &at->fog);
        sum = is_inside(w, more)
                  ? sun_sum(f, &ray->light, w->p, at->d, &w->reach, k)
                  : sun_sum_outside(f, &ray->light, w->p, k);
        for (uint32_t i = 0; i < f->lit.octaves; i++) {
            uint32_t a = f->lit.fog.extinction[i];
            uint32_t part = a == 0xffffffffu ? depth : mul_hi_floor(depth, a);
            w->g.sun[i] += mul_hi_floor(
                lost, transmittance_beyond(&f->lit.tau[i], sum, part));
        }
        return;
    }
#endif
    sum = sun_sum(f, &ray->light, w->p, at->d, &w->reach, k);
    for (uint32_t i = 0; i < f->lit.octaves; i++)
        w->g.sun[i] +=
            mul_hi_floor(lost, transmittance_of(&f->lit.tau[i], sum));
}

/* What a sample takes of the ray, Q1.31. */
BRUME_INLINE void lose(struct walk *w, uint32_t lost)
{
    w->transmittance -= lost;
#if BRUME_WITH_DEPTH
    w->where += moment(lost, w->index);
#endif
}

/* Light and loss at a sample that holds something. */
BRUME_INLINE void add_light(const struct brume_frame *f,
                            const struct brume_ray *ray, struct walk *w,
                            const struct matter *at, const struct kernel *k,
                            bool more)
{
    uint32_t fade = at->opacity, glowing = 0;
#if BRUME_WITH_EMISSION
    if (more && at->glows) {
        glowing = glow_of(f, &w->g, w->p, w->transmittance, &fade);
        if (at->opacity == 0) {
            lose(w, glowing);
            return;
        }
    }
#endif
    uint32_t lost = mul_hi_floor(w->transmittance, fade);
    BRUME_TALLY(lit_samples, 1);
    add_sun(f, ray, w, at, lost, k, more);
#if BRUME_WITH_AMBIENT
    if (f->lit.ambient != BRUME_AMBIENT_NONE)
        add_sky(f, &w->g, ray, w->p, lost, k, is_inside(w, more));
#endif
#if BRUME_WITH_LAMPS
    if (more && f->lit.clusters != NULL)
        add_lamps(f, &w->g, ray, w->p, lost, k);
#endif
    w->g.lit++;
    lose(w, lost + glowing);
}

/* The next n samples, all of them in the pool or none. False when too little is
 * left to go on. */
BRUME_INLINE bool march_loop(const struct brume_frame *f,
                             const struct brume_ray *ray, struct walk *w,
                             uint32_t n, const struct kernel *k, bool more)
{
    for (;;) {
        struct matter at;
        BRUME_TALLY(view_samples, 1);
#if BRUME_WITH_STOCHASTIC
        if (f->lit.stochastic)
            move_lookup(&w->g, ray, w->index);
#endif
        uint32_t m = find_matter(f, ray, w, &at, k, more);
        if (at.any) {
            add_light(f, ray, w, &at, k, more);
            if (w->transmittance < f->min_transmittance)
                return false;
        }
        if (m >= n)
            return true;
        n -= m;
        w->index += m;
        for (int i = 0; i < 3; i++)
            w->p[i] += m * (uint32_t)ray->line.move[i];
    }
}

#if HAS_MORE
static bool march_part(const struct brume_frame *f, const struct brume_ray *ray,
                       struct walk *w, uint32_t n, const struct kernel *k)
{
    return march_loop(f, ray, w, n, k, true);
}
#endif

#if BRUME_WITH_FOG
/* Samples that are found by adding up moves of 2^-17 voxels' error each. */
#define MOST_MOVES 4096u

/* Before the pool, in it, behind it. Each part begins where its first sample
 * is, to the bit. */
static void march_in_fog(const struct brume_frame *f,
                         const struct brume_ray *ray, struct walk *w,
                         const struct kernel *k)
{
    uint32_t behind = ray->before + ray->count, n;
    for (uint32_t at = 0; at < ray->samples; at += n) {
        w->index = at;
        w->outside = at < ray->before || at >= behind;
        if (w->outside) {
            n = (at < ray->before ? ray->before : ray->samples) - at;
            n = n < MOST_MOVES ? n : MOST_MOVES;
            brume_ray_place(f, ray->unit, ray->t + at * f->step, w->p);
        } else {
            n = behind - at;
            for (int i = 0; i < 3; i++)
                w->p[i] = ray->position[i];
        }
        if (!march_part(f, ray, w, n, k))
            return;
    }
}
#endif

/* All samples of the ray. */
static void march_all(const struct brume_frame *f, const struct brume_ray *ray,
                      struct walk *w, const struct kernel *k)
{
#if BRUME_WITH_FOG
    if (brume_has_fog(f)) {
        march_in_fog(f, ray, w, k);
        return;
    }
#endif
#if HAS_MORE
    if (has_more(f)) {
        march_part(f, ray, w, ray->count, k);
        return;
    }
#endif
    march_loop(f, ray, w, ray->count, k, false);
}

void brume_lit_march(const struct brume_frame *frame,
                     const struct brume_ray *ray, struct brume_radiance *out)
{
    const struct brume_frame *f = frame;
    static const struct gathered k_none;
    struct walk w = {.g = k_none, .transmittance = 1u << 31};
    const struct kernel k = kernel_of(&w.g);
    BRUME_TALLY(rays_in_pool, 1);
    for (int i = 0; i < 3; i++)
        w.p[i] = ray->position[i];
    march_all(f, ray, &w, &k);
#if BRUME_WITH_DEPTH
    out->depth = 0;
    if (f->depth)
        out->depth =
            brume_mean_depth(f, ray->t, w.where, (1u << 31) - w.transmittance);
#endif
    brume_lit_finish(f, &w.g, ray->unit, w.transmittance, out);
}

#endif
