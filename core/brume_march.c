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

/* How many samples to move from a position in an empty cell: at least 1, and
 * such that all between lie in cells that are empty by the cell's distance d,
 * that is, less than d cells away along each axis. `margin` is a voxel where a
 * lookup reads one voxel beyond, else 0.
 *
 * Along an axis the way to the last such position is, forwards,
 *     (d << 19) - 1 - (p & mask) = ((d - 1) << 19) + (~p & mask),
 * and backwards ((d - 1) << 19) + (p & mask). `inverse` is rounded down, so
 * the quotient is never too large. */
BRUME_INLINE uint32_t leap(const struct brume_frame *f, const uint32_t p[3],
                           const int32_t move[3], const uint32_t inverse[3],
                           uint32_t d)
{
    const uint32_t mask = (1u << 19) - 1u;
    uint32_t far = (d - 1u) << 19, n = 0xfffffffeu;
    for (int i = 0; i < 3; i++) {
        uint32_t room = move[i] < 0 ? far + (p[i] & mask)
                                    : far + (~p[i] & mask) - f->leap_margin;
        uint32_t m = mul_hi_floor(room, inverse[i]);
        n = m < n ? m : n;
    }
    n++;
    return n < f->max_leap ? n : f->max_leap;
}

/// Light ///

/* Sum of d * 2^k over the samples at p + light * 2^k. < 2^32: a 16-bit code
 * times 2^16 - 1. The pool is convex: out once, out for good. From one sample
 * to the next, q = p + light * 2^k becomes 2 q - p. */
BRUME_INLINE uint32_t sum_log(const struct brume_frame *f,
                              const struct brume_ray *ray, const uint32_t p[3],
                              struct kernel k)
{
    uint32_t x = p[0] + (uint32_t)ray->light[0];
    uint32_t y = p[1] + (uint32_t)ray->light[1];
    uint32_t z = p[2] + (uint32_t)ray->light[2];
    uint32_t end = 1u << ray->light_samples, sum = 0, d;
    for (uint32_t w = 1; w != end; w += w) {
        if (x >= f->limit[0] || y >= f->limit[1] || z >= f->limit[2])
            break;
        if (density_at(f, x, y, z, &d, k))
            sum += d * w;
        x = 2 * x - p[0];
        y = 2 * y - p[1];
        z = 2 * z - p[2];
    }
    return sum;
}

/* Sum of d over the samples at p + light + i * light_move; < 2^28. */
BRUME_INLINE uint32_t sum_uniform(const struct brume_frame *f,
                                  const struct brume_ray *ray,
                                  const uint32_t p[3], struct kernel k)
{
    uint32_t q[3], n = ray->light_samples, sum = 0, m, d;
    for (int i = 0; i < 3; i++)
        q[i] = p[i] + (uint32_t)ray->light[i];
    for (uint32_t i = 0; i < n; i += m) {
        if (q[0] >= f->limit[0] || q[1] >= f->limit[1] || q[2] >= f->limit[2])
            break;
        m = 1;
        if (density_at(f, q[0], q[1], q[2], &d, k))
            sum += d;
        else
            m = leap(f, q, f->light_move, f->light_inverse, d & 255u);
        q[0] += m * (uint32_t)f->light_move[0];
        q[1] += m * (uint32_t)f->light_move[1];
        q[2] += m * (uint32_t)f->light_move[2];
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

BRUME_INLINE void march(const struct brume_frame *f,
                        const struct brume_ray *ray, struct brume_radiance *out,
                        struct kernel k)
{
    uint32_t p[3] = {ray->position[0], ray->position[1], ray->position[2]};
    uint32_t transmittance = 1u << 31; /* Q1.31 */
    uint32_t light = 0;                /* Q3.29, <= 1 */
    uint32_t left = ray->count, m, d;
    for (;;) {
        m = 1;
        if (!density_at(f, p[0], p[1], p[2], &d, k)) {
            m = leap(f, p, ray->move, ray->inverse, d & 255u);
        } else if (d > f->min_density) {
            uint32_t sum =
                k.uniform ? sum_uniform(f, ray, p, k) : sum_log(f, ray, p, k);
            uint32_t lost = mul_hi_floor(transmittance, opacity(f, d, k));
            light += mul_hi_floor(lost, sun_transmittance(f, sum));
            transmittance -= lost;
            if (transmittance < f->min_transmittance)
                break;
        }
        if (m >= left)
            break;
        left -= m;
        p[0] += m * (uint32_t)ray->move[0];
        p[1] += m * (uint32_t)ray->move[1];
        p[2] += m * (uint32_t)ray->move[2];
    }
    /* Q31 * Q18 -> Q17 -> Q16 */
    out->light = (mul_hi_floor(light << 2, f->albedo << 2) + 1u) >> 1;
    out->transmittance = (transmittance + 0x4000u) >> 15;
}

BRUME_INLINE void span(const struct brume_frame *f, uint32_t x, uint32_t y,
                       uint32_t n, struct brume_radiance *out, struct kernel k)
{
    static const struct brume_radiance k_clear = {0, 0x10000u};
    for (uint32_t i = 0; i < n; i++) {
        struct brume_ray ray;
        if (brume_ray_begin(&ray, f, x + i, y))
            march(f, &ray, &out[i], k);
        else
            out[i] = k_clear;
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
    f->light = s->light == BRUME_UNIFORM ? BRUME_UNIFORM : BRUME_LOG;
    f->light_samples = s->light == BRUME_NO_LIGHT ? 0 : s->light_samples;
    f->light_step = s->light_step;
    for (int i = 0; i < 3; i++) {
        f->light_move[i] = mul_signed_round(f->sun[i], s->light_step, 2);
        f->light_inverse[i] = brume_inverse_of_move(f->light_move[i]);
    }
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
    f->max_leap = scene->skip ? 0xffffffffu : 1;
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
