/* SPDX-License-Identifier: MIT */
/*
 * The march: radiance and transmittance of a ray by single scattering.
 *
 * One function, `march`, is the definition. It is compiled once for each
 * combination of format, apron, lookup, light and clamp, so that its loops
 * have no branch on any of these; `brume_march_span` picks.
 */
#include "brume_light.h"

/// View ///

#if BRUME_WITH_LIGHTING
uint32_t brume_depth_of(uint32_t distance)
{
    return brume_depth_code(distance);
}
#endif

#if BRUME_WITH_DEPTH
uint32_t brume_mean_depth(const struct brume_frame *frame, uint32_t t,
                          uint32_t moment, uint32_t lost)
{
    if (lost == 0)
        return BRUME_NO_DEPTH;
    struct brume_number way =
        brume_number_mul(brume_number_of(moment, 20),
                         brume_number_inverse(brume_number_of(lost, 0)));
    way = brume_number_mul(way, brume_number_of(frame->step, 0));
    const uint32_t cap = 0xffdfffffu; /* of code 65533 */
    uint32_t further = brume_number_floor(way, 0);
    return brume_depth_code(t < cap && further < cap - t ? t + further : cap);
}
#endif

/* One for all kernels. */
static void finish(const struct brume_frame *f, uint32_t light,
                   uint32_t transmittance, struct brume_radiance *out)
{
    /* Q31 * Q18 -> Q17 -> Q16 */
    out->light = (mul_hi_floor(light << 2, f->albedo << 2) + 1u) >> 1;
    out->transmittance = (transmittance + 0x4000u) >> 15;
#if BRUME_WITH_DEPTH
    out->depth = 0;
#endif
#if BRUME_WITH_COLOUR
    out->green = out->blue = 0;
#endif
}

BRUME_INLINE void march(const struct brume_frame *f,
                        const struct brume_ray *ray, struct brume_radiance *out,
                        struct kernel k)
{
    const struct brume_line *line = &ray->line;
    uint32_t x = ray->position[0], y = ray->position[1], z = ray->position[2];
    uint32_t transmittance = 1u << 31; /* Q1.31 */
    uint32_t light = 0;                /* Q3.29, <= 1 */
    uint32_t left = ray->count, reach = 0, m, d;
#if BRUME_WITH_DEPTH
    uint32_t where = 0;
#endif
    BRUME_TALLY(rays_in_pool, 1);
    for (;;) {
        m = 1;
        BRUME_TALLY(view_samples, 1);
        if (!find_density(f, x, y, z, &d, k)) {
            m = leap(f, line, x, y, z, d, k);
        } else if (d > f->min_density) {
            BRUME_TALLY(lit_samples, 1);
            uint32_t sum = light_sum(f, &ray->light, x, y, z, &reach, k);
            uint32_t lost =
                mul_hi_floor(transmittance, opacity(f, d, is_narrow(k)));
            light += mul_hi_floor(lost, transmittance_of(&f->tau, sum));
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
        x += m * (uint32_t)line->move[0];
        y += m * (uint32_t)line->move[1];
        z += m * (uint32_t)line->move[2];
    }
    finish(f, light, transmittance, out);
#if BRUME_WITH_DEPTH
    if (f->depth)
        out->depth =
            brume_mean_depth(f, ray->t, where, (1u << 31) - transmittance);
#endif
}

#if BRUME_WITH_LIGHTING
#define is_lit(k) ((k).moved != NULL)
#define march_lit brume_lit_march
#else
#define is_lit(k) false
#define march_lit(f, ray, out) (void)0
#endif

/* Rays are told to miss in groups of eight: fewer cost as much to tell as to
 * try. */
#define RAY_GROUP 8

BRUME_INLINE void span(const struct brume_frame *f, uint32_t x, uint32_t y,
                       uint32_t n, struct brume_radiance *out, struct kernel k)
{
    struct brume_radiance clear = {0};
    bool miss = false;
    clear.transmittance = 0x10000u;
#if BRUME_WITH_DEPTH
    clear.depth = f->depth ? BRUME_NO_DEPTH : 0;
#endif
    for (uint32_t i = 0; i < n; i++) {
        struct brume_ray ray;
        if (i % RAY_GROUP == 0)
            miss = brume_rays_miss(f, x + i, y,
                                   n - i < RAY_GROUP ? n - i : RAY_GROUP);
        if (miss || !brume_ray_begin(&ray, f, x + i, y))
            out[i] = clear;
        else if (is_lit(k))
            march_lit(f, &ray, &out[i]);
        else
            march(f, &ray, &out[i], k);
    }
}

/// Kernels ///

#define KERNEL(format, apron, tri, uni, clamp) \
    case KERNEL_ID(format, apron, tri, uni, clamp): \
        if (KERNEL_HAS(format, apron, tri, uni, clamp)) { \
            static const struct kernel k_kernel = \
                KERNEL_OF(format, apron, tri, uni, clamp); \
            span(f, x, y, n, out, k_kernel); \
        } \
        break;
#define KERNELS_CLAMP(format, apron, tri, uni) \
    KERNEL(format, apron, tri, uni, 0) KERNEL(format, apron, tri, uni, 1)
#define KERNELS_LIGHT(format, apron, tri) \
    KERNELS_CLAMP(format, apron, tri, 0) KERNELS_CLAMP(format, apron, tri, 1)
#define KERNELS_LOOKUP(format, apron) \
    KERNELS_LIGHT(format, apron, 0) KERNELS_LIGHT(format, apron, 1)
#define KERNELS(format) KERNELS_LOOKUP(format, 0) KERNELS_LOOKUP(format, 1)

void brume_march_span(const struct brume_frame *frame, uint32_t x, uint32_t y,
                      uint32_t n, struct brume_radiance *out)
{
    const struct brume_frame *f = frame;
    BRUME_CHECK(n <= BRUME_SPAN);
#if BRUME_WITH_LIGHTING
    if (f->lit.on) {
        static const uint32_t k_moved[3];
        const struct kernel lit = {.moved = k_moved};
        span(f, x, y, n, out, lit);
        return;
    }
#endif
    switch (f->kernel) {
        KERNELS(BRUME_U8)
        KERNELS(BRUME_U8R)
        KERNELS(BRUME_U4R)
    default: break;
    }
}

static bool kernel_is_compiled(uint32_t format, bool apron, bool tri, bool uni,
                               bool clamp)
{
    return KERNEL_HAS(format, apron, tri, uni, clamp);
}

/// Tables ///

/* 1/255 and 1/65280 as numbers. */
static struct brume_number per_code(bool narrow)
{
    struct brume_number n = {0x80808081u, narrow ? -39 : -47};
    return n;
}

static struct brume_number times(struct brume_number a, uint32_t i)
{
    return brume_number_mul(a, brume_number_of(i, 0));
}

/* unit: extinction over a step, per code. */
static void fill_table(uint32_t table[512], struct brume_number unit,
                       bool narrow)
{
    for (uint32_t i = 0; i < 256; i++) {
        uint32_t fine = brume_one_minus_exp(times(unit, i));
        if (narrow) {
            table[i] = fine;
            continue;
        }
        table[i] = ~brume_one_minus_exp(times(unit, i << 8));
        table[256 + i] = ~fine;
    }
}

static bool tau_fits(const struct brume_tau *t, uint32_t sum)
{
    return sum <= 0xffffffffu >> t->shift &&
           mul_hi_floor(sum << t->shift, t->m) <= 131070u;
}

/* unit: optical depth per unit of the light sum. */
static void set_tau(struct brume_tau *t, struct brume_number unit)
{
    int32_t shift = unit.e + 45;
    t->m = unit.m;
    t->shift = 0;
    t->limit = 0;
    if (unit.m == 0 || shift <= -32)
        t->m = 0;
    else if (shift < 0)
        t->m = unit.m >> (uint32_t)-shift;
    else if (shift > 31) /* any sum but 0 is black */
        return;
    else
        t->shift = (uint32_t)shift;
    for (uint32_t bit = 0x80000000u; bit != 0; bit >>= 1)
        if (tau_fits(t, t->limit | bit))
            t->limit |= bit;
}

/* Density in codes: floor(density / density_max * 255 or 65280). The quotient
 * is up to 2^-28 of itself too low, which is less than 2^-11 of a code: what
 * is that near below a code is that code, so that a threshold which is a code
 * stays one. */
static uint32_t codes_of(struct brume_number density,
                         const struct brume_volume *v, bool narrow)
{
    struct brume_number n =
        brume_number_mul(density, brume_number_inverse(v->density_max));
    uint32_t q11 = brume_number_floor(times(n, narrow ? 255 : 65280), 11);
    return (q11 >> 11) + ((q11 & 0x7ffu) == 0x7ffu ? 1u : 0u);
}

static void set_light(struct brume_frame *f, const struct brume_scene *s)
{
    struct brume_line *line = &f->light_line;
    f->light_kind = s->light == BRUME_UNIFORM ? BRUME_UNIFORM : BRUME_LOG;
    uint32_t jitter = 0;
#if BRUME_WITH_CONE
    if (s->light == BRUME_CONE) /* the middle of each segment */
        jitter = 0x8000u;
#endif
#if BRUME_WITH_FOG
    if (s->light == BRUME_CACHE) /* the same: of shapes of fog */
        jitter = 0x8000u;
#endif
    f->light_samples = s->light == BRUME_NO_LIGHT ? 0 : s->light_samples;
#if BRUME_WITH_CACHE
    if (s->light == BRUME_CACHE)
        f->light_samples = 0;
#endif
    f->light_step = s->light_step;
    for (int i = 0; i < 3; i++) {
        line->move[i] = mul_signed_round(f->sun[i], s->light_step, 2);
        line->inverse[i] = s->skip ? brume_inverse_of_move(line->move[i]) : 0;
    }
    brume_light_begin(&f->light, f, jitter);
}

#if BRUME_WITH_LIGHTING
/* Depths of the octaves and of the sky. unit: density of a code; light_step:
 * light_density_scale times that step. */
static void set_lit_taus(struct brume_frame *f, const struct brume_scene *s,
                         struct brume_number unit)
{
    const struct brume_lighting *l = f->lit.lighting;
    const struct brume_number scale = brume_number_q32(s->light_density_scale);
    struct brume_number depth =
        brume_number_mul(unit, brume_number_of(s->light_step, -16));
#if BRUME_WITH_CONE
    if (s->light == BRUME_CONE) /* counts in 16-bit codes */
        depth = brume_number_mul(
            brume_number_mul(f->volume->density_max, per_code(false)),
            brume_number_of(s->light_step, -16));
#endif
#if BRUME_WITH_CACHE
    if (s->light == BRUME_CACHE) {
        depth = f->lit.cache.unit;
        depth.e -= 13;
    }
    f->lit.sun_unit = depth;
#endif
    depth = brume_number_mul(depth, scale);
#if BRUME_WITH_LAMPS
    f->lit.lamp_depth = brume_number_mul(unit, scale);
#endif
    for (uint32_t i = 0; i < f->lit.octaves; i++) {
        set_tau(&f->lit.tau[i], depth);
        if (l != NULL)
            depth = brume_number_mul(depth, brume_number_of(l->octave_a, -16));
    }
#if BRUME_WITH_AMBIENT
    if (l != NULL && l->visibility == BRUME_SKY_SAMPLED) {
        depth =
            brume_number_mul(unit, brume_number_of(l->visibility_step, -16));
        set_tau(&f->lit.sky_tau, brume_number_mul(depth, scale));
    }
#endif
}
#endif

#if BRUME_WITH_EMISSION
/* Values of the second grid count in 1/256 of its codes of 8 bits. */
static void set_emission(struct brume_frame *f, const struct brume_scene *s)
{
    if (!f->lit.emits)
        return;
    struct brume_number unit =
        brume_number_mul(f->volume->emission_max, per_code(false));
    unit = brume_number_mul(unit, brume_number_of(s->step, -16));
    unit =
        brume_number_mul(unit, brume_number_q32(s->lighting->emission_scale));
    fill_table(f->lit.emission, unit, false);
}
#endif

int brume_march_begin(struct brume_frame *frame,
                      const struct brume_scene *scene)
{
    struct brume_frame *f = frame;
    const struct brume_volume *v = f->volume;
    bool apron = v->side == 9, tri = scene->filter == BRUME_TRILINEAR;
    bool uni = scene->light == BRUME_UNIFORM;
    struct brume_number limit = brume_number_q32(scene->max_density);
    /* A volume without density has no unit to clamp in. */
    bool clamp = limit.m != 0 && v->density_max.m != 0 &&
                 codes_of(limit, v, false) < BRUME_RANGE_TOP;
    bool narrow = v->format == BRUME_U8 && !tri && !clamp;
    if (!kernel_is_compiled(v->format, apron, tri, uni, clamp))
        return BRUME_ERR_FEATURE;
#if BRUME_WITH_LIGHTING
    int err = brume_lit_begin(f, scene);
    if (err)
        return err;
    uni = uni && !f->lit.on; /* lit frames know their light otherwise */
#endif
    f->kernel = (uint8_t)KERNEL_ID(v->format, apron, tri, uni, clamp);
    f->max_density = clamp ? codes_of(limit, v, false) : BRUME_RANGE_TOP;
#if BRUME_WITH_MAX_DENSITY
    if (f->max_density == 0) /* nothing would be left of the volume */
        return BRUME_ERR_SCENE;
#endif
    f->min_density =
        v->density_max.m == 0
            ? 0
            : codes_of(brume_number_q32(scene->min_density), v, narrow);
    f->leap_margin = tri && (!apron || clamp) ? 0x10000u : 0;
#if BRUME_WITH_STOCHASTIC
    if (f->lit.stochastic)
        f->leap_margin = 0x10000u;
#endif
    f->skip = scene->skip;
    struct brume_number unit =
        brume_number_mul(v->density_max, per_code(narrow));
    struct brume_number step = brume_number_of(scene->step, -16);
    struct brume_number light_step = brume_number_of(scene->light_step, -16);
    step = brume_number_mul(step, brume_number_q32(scene->density_scale));
    light_step = brume_number_mul(light_step,
                                  brume_number_q32(scene->light_density_scale));
    fill_table(f->table, brume_number_mul(unit, step), narrow);
    set_tau(&f->tau, brume_number_mul(unit, light_step));
#if BRUME_WITH_LIGHTING
    set_lit_taus(f, scene, unit);
#endif
#if BRUME_WITH_LAMPS
    brume_lamps_begin(f, scene);
#endif
#if BRUME_WITH_EMISSION
    set_emission(f, scene);
#endif
    set_light(f, scene);
    return BRUME_OK;
}
