/* SPDX-License-Identifier: MIT */
/*
 * The march: radiance and transmittance of a ray by single scattering.
 *
 * One function, `march`, is the definition. It is compiled once for each
 * combination of format, apron, lookup, light and clamp, so that its loops
 * have no branch on any of these; `brume_march_span` picks.
 */
#include "brume_lookup.h"

/// Leaping ///

/* Samples along one axis from p to the last position whose cell is less than
 * `cell` cells away. `far` = (cell - 1) << 19: the way is, forwards,
 *     (cell << 19) - 1 - (p & mask) = far + (~p & mask),
 * and backwards far + (p & mask). `inverse` is rounded down, so the quotient
 * is never too large. */
BRUME_INLINE uint32_t leap_axis(uint32_t p, int32_t move, uint32_t inverse,
                                uint32_t far, uint32_t margin)
{
    const uint32_t mask = (1u << 19) - 1u;
    uint32_t forwards = ~sign_mask(move);
    uint32_t room = far + ((p ^ forwards) & mask) - (margin & forwards);
    return mul_hi_floor(room, inverse);
}

/* How many samples to move from a position in an empty cell: at least 1, and
 * such that all between lie in cells that are empty by the cell's distance,
 * its low byte. The margin is a voxel where a lookup reads one voxel beyond,
 * else 0. A line whose `inverse` is 0 moves by one: skipping off. */
BRUME_INLINE uint32_t leap(const struct brume_frame *f,
                           const struct brume_line *line, uint32_t x,
                           uint32_t y, uint32_t z, uint32_t cell,
                           struct kernel k)
{
    uint32_t margin = k.trilinear ? f->leap_margin : 0;
    uint32_t far = (cell << 19) - (1u << 19); /* the shift drops the flag */
    uint32_t n = leap_axis(x, line->move[0], line->inverse[0], far, margin);
    uint32_t m = leap_axis(y, line->move[1], line->inverse[1], far, margin);
    n = m < n ? m : n;
    m = leap_axis(z, line->move[2], line->inverse[2], far, margin);
    n = m < n ? m : n;
    return n + 1u;
}

/// Light ///

/* Is sample i of the light ray, at p + light * 2^i, in the pool? */
BRUME_INLINE bool light_inside(const struct brume_frame *f,
                               const struct brume_light_ray *light, uint32_t px,
                               uint32_t py, uint32_t pz, uint32_t i)
{
    return px + ((uint32_t)light->first[0] << i) < f->limit[0] &&
           py + ((uint32_t)light->first[1] << i) < f->limit[1] &&
           pz + ((uint32_t)light->first[2] << i) < f->limit[2];
}

/* How many samples of the light ray are in the pool, which is convex: out
 * once, out for good. Searched from n, what the last position had. */
BRUME_INLINE uint32_t light_reach(const struct brume_frame *f,
                                  const struct brume_light_ray *light,
                                  uint32_t px, uint32_t py, uint32_t pz,
                                  uint32_t n)
{
    if (n < light->samples && light_inside(f, light, px, py, pz, n)) {
        do
            n++;
        while (n < light->samples && light_inside(f, light, px, py, pz, n));
        return n;
    }
    while (n > 0 && !light_inside(f, light, px, py, pz, n - 1))
        n--;
    return n;
}

/* d * 2^i of sample i, which is in the pool. */
BRUME_INLINE uint32_t light_sample(const struct brume_frame *f, uint32_t px,
                                   uint32_t py, uint32_t pz, uint32_t lx,
                                   uint32_t ly, uint32_t lz, uint32_t i,
                                   struct kernel k)
{
    uint32_t d;
    BRUME_TALLY(light_samples, 1);
    if (!density_at(f, px + (lx << i), py + (ly << i), pz + (lz << i), &d, k))
        return 0;
    return d << i;
}

/* Sum of d * 2^i over the first n samples, all in the pool. < 2^32: a 16-bit
 * code times 2^16 - 1. */
BRUME_INLINE uint32_t sum_log(const struct brume_frame *f,
                              const struct brume_light_ray *light, uint32_t px,
                              uint32_t py, uint32_t pz, uint32_t n,
                              struct kernel k)
{
    uint32_t lx = (uint32_t)light->first[0], sum = 0;
    uint32_t ly = (uint32_t)light->first[1], lz = (uint32_t)light->first[2];
    if (!BRUME_UNROLL_LIGHT || k.trilinear) {
        for (uint32_t i = 0; i < n; i++)
            sum += light_sample(f, px, py, pz, lx, ly, lz, i, k);
        return sum;
    }
    /* Falls through from the farthest to the nearest, so that shifts are
     * constants and nothing is counted. Compilers must not take the shifts
     * out of the march: there are no registers to keep them. */
    BRUME_OPAQUE(lx);
    BRUME_OPAQUE(ly);
    BRUME_OPAQUE(lz);
#define LIGHT_SAMPLE(i) \
    BRUME_FALLTHROUGH; \
    case (i) + 1: sum += light_sample(f, px, py, pz, lx, ly, lz, i, k)
    switch (n) {
    default:
        LIGHT_SAMPLE(15);
        LIGHT_SAMPLE(14);
        LIGHT_SAMPLE(13);
        LIGHT_SAMPLE(12);
        LIGHT_SAMPLE(11);
        LIGHT_SAMPLE(10);
        LIGHT_SAMPLE(9);
        LIGHT_SAMPLE(8);
        LIGHT_SAMPLE(7);
        LIGHT_SAMPLE(6);
        LIGHT_SAMPLE(5);
        LIGHT_SAMPLE(4);
        LIGHT_SAMPLE(3);
        LIGHT_SAMPLE(2);
        LIGHT_SAMPLE(1);
        LIGHT_SAMPLE(0);
        BRUME_FALLTHROUGH;
    case 0: return sum;
    }
}

/* Sum of d over the samples at p + first + i * light_line.move; < 2^28. */
BRUME_INLINE uint32_t sum_uniform(const struct brume_frame *f,
                                  const struct brume_light_ray *light,
                                  uint32_t px, uint32_t py, uint32_t pz,
                                  struct kernel k)
{
    const struct brume_line *line = &f->light_line;
    uint32_t n = light->samples, sum = 0, m, d;
    px += (uint32_t)light->first[0];
    py += (uint32_t)light->first[1];
    pz += (uint32_t)light->first[2];
    for (uint32_t i = 0; i < n; i += m) {
        if (px >= f->limit[0] || py >= f->limit[1] || pz >= f->limit[2])
            break;
        m = 1;
        BRUME_TALLY(light_samples, 1);
        if (density_at(f, px, py, pz, &d, k))
            sum += d;
        else
            m = leap(f, line, px, py, pz, d, k);
        px += m * (uint32_t)line->move[0];
        py += m * (uint32_t)line->move[1];
        pz += m * (uint32_t)line->move[2];
    }
    return sum;
}

/* exp(-tau) of a sum, in Q2.30. tau is rounded to 1/4096. */
BRUME_INLINE uint32_t sun_transmittance(const struct brume_frame *f,
                                        uint32_t sum)
{
    if (sum > f->tau_limit)
        return 0;
    uint32_t tau = (mul_hi_floor(sum << f->tau_shift, f->tau_m) + 1u) >> 1;
    BRUME_CHECK(tau <= 0xffffu);
    return (uint32_t)brume_exp_coarse[tau >> 8] * brume_exp_fine[tau & 255u];
}

/// View ///

/* 1 - exp(-sigma_t * step) of a density, Q0.32. */
BRUME_INLINE uint32_t opacity(const struct brume_frame *f, uint32_t d,
                              struct kernel k)
{
    if (is_narrow(k))
        return f->table[d];
    return ~mul_hi_floor(f->table[d >> 8], f->table[256u + (d & 255u)]);
}

/* Optical depth towards the sun, as a sum of codes times weights. *reach is
 * the ray's, from one sample to the next. */
BRUME_INLINE uint32_t light_sum(const struct brume_frame *f,
                                const struct brume_light_ray *light, uint32_t x,
                                uint32_t y, uint32_t z, uint32_t *reach,
                                struct kernel k)
{
    if (k.uniform)
        return sum_uniform(f, light, x, y, z, k);
    *reach = light_reach(f, light, x, y, z, *reach);
    return sum_log(f, light, x, y, z, *reach, k);
}

#if BRUME_WITH_DEPTH
/* Where in the sequence of samples the light was lost: sum of lost * index,
 * Q1.31 times 2^-20. index < 2^20, so each term is below 2^31, and the sum is,
 * as the losses sum to 1. */
BRUME_INLINE uint32_t moment(uint32_t lost, uint32_t index)
{
    return mul_hi_floor(lost, index << 12);
}

uint32_t brume_mean_depth(const struct brume_frame *frame, uint32_t t,
                          uint32_t moment, uint32_t lost)
{
    if (lost == 0)
        return BRUME_NO_DEPTH;
    struct brume_number way =
        brume_number_mul(brume_number_of(moment, 20),
                         brume_number_inverse(brume_number_of(lost, 0)));
    way = brume_number_mul(way, brume_number_of(frame->step, 0));
    const uint32_t cap = 0xffdfffffu; /* of code 65534 */
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
        if (!density_at(f, x, y, z, &d, k)) {
            m = leap(f, line, x, y, z, d, k);
        } else if (d > f->min_density) {
            BRUME_TALLY(lit_samples, 1);
            uint32_t sum = light_sum(f, &ray->light, x, y, z, &reach, k);
            uint32_t lost = mul_hi_floor(transmittance, opacity(f, d, k));
            light += mul_hi_floor(lost, sun_transmittance(f, sum));
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
        if (!miss && brume_ray_begin(&ray, f, x + i, y))
            march(f, &ray, &out[i], k);
        else
            out[i] = clear;
    }
}

/// Kernels ///

/* Number of a kernel, and whether it is compiled in. */
#define KERNEL_ID(format, apron, tri, uni, clamp) \
    ((format) << 4 | (apron) << 3 | (tri) << 2 | (uni) << 1 | (clamp))
#define KERNEL_HAS(format, apron, tri, uni, clamp) \
    (((format) == BRUME_U8    ? BRUME_WITH_U8 \
      : (format) == BRUME_U8R ? BRUME_WITH_U8R \
                              : BRUME_WITH_U4R) && \
     (BRUME_WITH_APRON || !(apron)) && \
     ((tri) ? BRUME_WITH_TRILINEAR : BRUME_WITH_NEAREST) && \
     (BRUME_WITH_UNIFORM || !(uni)) && (BRUME_WITH_MAX_DENSITY || !(clamp)))

#define KERNEL(format, apron, tri, uni, clamp) \
    case KERNEL_ID(format, apron, tri, uni, clamp): \
        if (KERNEL_HAS(format, apron, tri, uni, clamp)) { \
            static const struct kernel k_kernel = {format, 8 + (apron), tri, \
                                                   uni, clamp}; \
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
static void fill_table(struct brume_frame *f, struct brume_number unit,
                       bool narrow)
{
    for (uint32_t i = 0; i < 256; i++) {
        uint32_t fine = brume_one_minus_exp(times(unit, i));
        if (narrow) {
            f->table[i] = fine;
            continue;
        }
        f->table[i] = ~brume_one_minus_exp(times(unit, i << 8));
        f->table[256 + i] = ~fine;
    }
}

static bool tau_fits(const struct brume_frame *f, uint32_t sum)
{
    return sum <= 0xffffffffu >> f->tau_shift &&
           mul_hi_floor(sum << f->tau_shift, f->tau_m) <= 131070u;
}

/* unit: optical depth per unit of the light sum. The march takes tau * 2^13
 * as the high word of (sum << shift) * m. */
static void set_tau(struct brume_frame *f, struct brume_number unit)
{
    int32_t shift = unit.e + 45;
    f->tau_m = unit.m;
    f->tau_shift = 0;
    f->tau_limit = 0;
    if (unit.m == 0 || shift <= -32)
        f->tau_m = 0;
    else if (shift < 0)
        f->tau_m = unit.m >> (uint32_t)-shift;
    else if (shift > 31) /* any sum but 0 is black */
        return;
    else
        f->tau_shift = (uint32_t)shift;
    for (uint32_t bit = 0x80000000u; bit != 0; bit >>= 1)
        if (tau_fits(f, f->tau_limit | bit))
            f->tau_limit |= bit;
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
    f->light_samples = s->light == BRUME_NO_LIGHT ? 0 : s->light_samples;
    f->light_step = s->light_step;
    for (int i = 0; i < 3; i++) {
        line->move[i] = mul_signed_round(f->sun[i], s->light_step, 2);
        line->inverse[i] = s->skip ? brume_inverse_of_move(line->move[i]) : 0;
    }
    brume_light_begin(&f->light, f, 0);
}

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
    f->kernel = (uint8_t)KERNEL_ID(v->format, apron, tri, uni, clamp);
    f->max_density = clamp ? codes_of(limit, v, false) : BRUME_RANGE_TOP;
    f->min_density =
        v->density_max.m == 0
            ? 0
            : codes_of(brume_number_q32(scene->min_density), v, narrow);
    f->leap_margin = tri && (!apron || clamp) ? 0x10000u : 0;
    f->skip = scene->skip;
    struct brume_number unit =
        brume_number_mul(v->density_max, per_code(narrow));
    struct brume_number step = brume_number_of(scene->step, -16);
    struct brume_number light_step = brume_number_of(scene->light_step, -16);
    step = brume_number_mul(step, brume_number_q32(scene->density_scale));
    light_step = brume_number_mul(light_step,
                                  brume_number_q32(scene->light_density_scale));
    fill_table(f, brume_number_mul(unit, step), narrow);
    set_tau(f, brume_number_mul(unit, light_step));
    set_light(f, scene);
    return BRUME_OK;
}
