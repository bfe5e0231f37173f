/* SPDX-License-Identifier: MIT */
/*
 * The shadow that a volume throws on other things: what a ray from a point
 * towards the sun lets through. docs/light.md has the definition.
 *
 * All rays are parallel and have the same steps, so what the camera works out
 * for each ray is known for all of them here.
 */
#include "brume_light.h"

#if BRUME_WITH_SHADOW

/* As the camera's rays: one that is farther from the pool misses. */
#define FAR_ENTRY 0xfde80000u /* 65000 voxels, Q16.16 */
/* Samples on a ray, so that sums of 16-bit codes fit a word. */
#define MOST_SAMPLES 0xffffu

/// Beginning ///

/* 255 times what a sum of densities lets through, rounded to the nearest. */
static uint32_t byte_of(const struct brume_shadow *s, uint32_t sum)
{
    /* Q2.30 * 2 * 2040 / 2^32: 255 T in Q8.2 */
    uint32_t q2 =
        mul_hi_floor(transmittance_of(&s->frame.tau, sum) << 1, 255u << 3);
    return (q2 + 2u) >> 2;
}

/* Are all corners of what texels can be within reach? */
static bool map_in_bounds(const struct brume_shadow_map *m)
{
    for (int i = 0; i < 3; i++)
        for (unsigned corner = 0; corner < 8; corner++) {
            int64_t p = m->origin[i];
            p += corner & 1u ? m->across[i] : 0;
            p += corner & 2u ? m->down[i] : 0;
            p += corner & 4u && m->heights != NULL ? m->rise[i] : 0;
            if (p > BRUME_MAX_COORDINATE || p < -BRUME_MAX_COORDINATE)
                return false;
        }
    return true;
}

static int check_map(const struct brume_shadow_map *m)
{
    if (m->width < 1 || m->width > BRUME_MAX_SIZE || m->height < 1 ||
        m->height > BRUME_MAX_SIZE ||
        (m->heights != NULL && m->heights_stride < m->width))
        return BRUME_ERR_SIZE;
    return map_in_bounds(m) ? BRUME_OK : BRUME_ERR_SCENE;
}

/* A frame whose light rays are the map's: of the scene only what decides on
 * them. Its camera is at the origin, so that frame.eye is the lookup's bias. */
static int begin_frame(struct brume_shadow *s,
                       const struct brume_volume *volume,
                       const struct brume_scene *scene, uint32_t step)
{
    static const struct brume_scene k_zero;
    struct brume_scene plain = k_zero;
    plain.width = plain.height = 1;
    plain.target[2] = 1 << 16;
    plain.fov = BRUME_MIN_FOV;
    for (int i = 0; i < 3; i++)
        plain.sun[i] = scene->sun[i];
    plain.light_density_scale = scene->light_density_scale;
    plain.max_density = scene->max_density;
    plain.step = plain.light_step = step;
    plain.filter = scene->filter;
    if (scene->filter == BRUME_STOCHASTIC) /* its mean */
        plain.filter = BRUME_WITH_TRILINEAR ? BRUME_TRILINEAR : BRUME_NEAREST;
    plain.light = BRUME_NO_LIGHT;
    plain.skip = scene->skip;
    return brume_begin_frame(&s->frame, volume, &plain);
}

/* (2 x + 1) / (2 size) is ((2 x + 1) << shift) * reciprocal, Q0.31 in the high
 * word. */
static void set_share(struct brume_shadow *s, int axis, uint32_t size)
{
    s->shift[axis] = (uint8_t)leading_zeros(2u * size);
    s->per_texel[axis] = brume_reciprocal(2u * size << s->shift[axis]);
}

/* The largest sum that is not black. */
static uint32_t darkest_sum(const struct brume_shadow *s)
{
    uint32_t sum = 0;
    for (uint32_t bit = 0x80000000u; bit != 0; bit >>= 1)
        if (byte_of(s, sum | bit) > 0)
            sum |= bit;
    return sum;
}

int brume_shadow_begin(struct brume_shadow *shadow,
                       const struct brume_volume *volume,
                       const struct brume_scene *scene,
                       const struct brume_shadow_map *map)
{
    struct brume_shadow *s = shadow;
    if (s == NULL || volume == NULL || scene == NULL || map == NULL)
        return BRUME_ERR_NULL;
    int err = check_map(map);
    if (err == BRUME_OK)
        err = begin_frame(s, volume, scene, map->step);
    if (err)
        return err;
    const struct brume_frame *f = &s->frame;
    uint32_t most = 0xffffffffu;
    s->map = *map;
    for (int i = 0; i < 3; i++) {
        uint32_t speed = magnitude(f->sun[i]);
        uint32_t move = magnitude(f->light_line.move[i]);
        s->map.origin[i] += f->eye[i];
        s->pace[i] = brume_number_of(0, 0);
        if (speed != 0)
            s->pace[i] = brume_number_inverse(brume_number_of(speed, -30));
        if (move != 0 && f->limit[i] / move < most)
            most = f->limit[i] / move;
    }
    if (most >= MOST_SAMPLES)
        return BRUME_ERR_STEP;
    set_share(s, 0, map->width);
    set_share(s, 1, map->height);
    s->black = darkest_sum(s);
    return BRUME_OK;
}

/// Rays ///

/* Where the ray through a texel is, and how far it has come. */
struct sun_ray {
    uint32_t p[3]; /* Q16.16, as lookups take them */
    uint32_t t;    /* from the surface, Q16.16 */
};

/* Q16.16, all ones when it is more. */
static uint32_t time_of(const struct brume_shadow *s, int axis,
                        uint32_t distance)
{
    return brume_number_floor(
        brume_number_mul(brume_number_of(distance, -16), s->pace[axis]), 16);
}

/* The time at which the ray from a point is in the pool first; false when it
 * never is. */
static bool clip(const struct brume_shadow *s, const int32_t from[3],
                 uint32_t *t_in)
{
    uint32_t t_out = 0xffffffffu;
    *t_in = 0;
    for (int i = 0; i < 3; i++) {
        uint32_t limit = s->frame.limit[i], p = (uint32_t)from[i];
        bool low = from[i] < 0, high = !low && p >= limit;
        bool down = s->frame.sun[i] < 0;
        if (s->frame.sun[i] == 0) {
            if (low || high)
                return false;
            continue;
        }
        if (down ? low : high) /* leads away */
            return false;
        /* The way to the first position inside, and to the face beyond. */
        if (low || high) {
            uint32_t t = time_of(s, i, down ? p - (limit - 1u) : 0u - p);
            *t_in = t > *t_in ? t : *t_in;
        }
        uint32_t t = time_of(s, i, down ? p + 1u : limit - p);
        t_out = t < t_out ? t : t_out;
    }
    /* By rounding a ray along a face may seem to leave before it enters. */
    return *t_in < FAR_ENTRY && (*t_in <= t_out || *t_in - t_out < 16u);
}

static bool inside(const struct brume_frame *f, const uint32_t p[3])
{
    return p[0] < f->limit[0] && p[1] < f->limit[1] && p[2] < f->limit[2];
}

/* To the first lattice point (k + 1/2) step that is in the pool: the first or
 * the second behind t_in, or none. Decided by the positions themselves. */
static bool enter(const struct brume_shadow *s, const int32_t from[3],
                  struct sun_ray *ray)
{
    const struct brume_frame *f = &s->frame;
    uint32_t t_in;
    if (!clip(s, from, &t_in))
        return false;
    ray->t = t_in / f->step * f->step + (f->step >> 1);
    for (int tries = 0; tries < 2; tries++, ray->t += f->step) {
        for (int i = 0; i < 3; i++) {
            uint32_t m = magnitude(f->sun[i]), low = m * ray->t;
            /* Q30 * Q16 -> Q16, rounded; true modulo 2^32 */
            uint32_t way =
                (mul_hi_floor(m, ray->t) << 2 | low >> 30) + (low >> 29 & 1u);
            ray->p[i] = (uint32_t)from[i] + (f->sun[i] < 0 ? 0u - way : way);
        }
        if (inside(f, ray->p))
            return true;
    }
    return false;
}

/* What a ray meets: densities in the kernel's codes, and times the number of
 * the sample. */
struct met {
    uint32_t sum;
    uint64_t moment;
    uint32_t first; /* sample with density */
};

/* Marches to the end of the pool, or to black where no depth is wanted. */
static struct met march(const struct brume_shadow *s, struct sun_ray ray,
                        bool whole)
{
    static const uint32_t k_unmoved[3];
    const struct brume_frame *f = &s->frame;
    const struct brume_line *line = &f->light_line;
    struct kernel k = KERNEL_OF(BRUME_U8R, 0, true, false, false);
    struct met met = {0, 0, 0};
    uint32_t m, d;
    k.moved = k_unmoved;
    for (uint32_t n = 0; inside(f, ray.p); n += m) {
        m = 1;
        BRUME_TALLY(light_samples, 1);
        if (!find_density(f, ray.p[0], ray.p[1], ray.p[2], &d, k)) {
            m = leap(f, line, ray.p[0], ray.p[1], ray.p[2], d, k);
        } else if (d != 0) {
            met.first = met.sum == 0 ? n : met.first;
            met.sum += d;
            met.moment += d * n; /* < 2^16 both */
            if (!whole && met.sum > s->black)
                break;
        }
        for (int i = 0; i < 3; i++)
            ray.p[i] += m * (uint32_t)line->move[i];
    }
    return met;
}

/// Depth ///

/* Codes of the largest distances stand for all beyond. */
#define FARTHEST 0xffdfffffu /* of code 65533 */

static uint16_t depth_after(const struct brume_shadow *s, uint32_t t,
                            struct brume_number samples)
{
    struct brume_number way =
        brume_number_mul(samples, brume_number_of(s->frame.step, 0));
    uint32_t more = brume_number_floor(way, 0);
    return (uint16_t)brume_depth_code(
        t < FARTHEST && more < FARTHEST - t ? t + more : FARTHEST);
}

static struct brume_shadow_depth depth_of(const struct brume_shadow *s,
                                          uint32_t t, const struct met *met)
{
    struct brume_shadow_depth out = {BRUME_NO_DEPTH, BRUME_NO_DEPTH};
    if (met->sum == 0)
        return out;
    /* The highest 32 bits of the moment; its high word is below 2^16. */
    uint32_t high = (uint32_t)(met->moment >> 32);
    uint32_t low = (uint32_t)met->moment;
    unsigned up = high == 0 ? 32u : leading_zeros(high); /* >= 16 */
    struct brume_number moment =
        up == 32
            ? brume_number_of(low, 0)
            : brume_number_of(high << up | low >> (32u - up), 32 - (int32_t)up);
    out.front = depth_after(s, t, brume_number_of(met->first, 0));
    out.mean = depth_after(
        s, t,
        brume_number_mul(moment,
                         brume_number_inverse(brume_number_of(met->sum, 0))));
    return out;
}

/* Q16.16: what the code stands for, rounded down. */
static uint32_t distance_of(uint32_t code)
{
    uint32_t high = code >> 11, m = (code & 0x7ffu) | 0x800u;
    return high > 11 ? m << (high - 11u) : m >> (11u - high);
}

uint32_t brume_shadow_at(uint8_t transmittance,
                         const struct brume_shadow_depth *depth,
                         uint32_t distance)
{
    uint32_t front = distance_of(depth->front), mean = distance_of(depth->mean);
    uint32_t half = mean > front ? mean - front : 0;
    if (depth->front == BRUME_NO_DEPTH ||
        (distance > mean && distance - mean >= half))
        return 0x10000u;
    /* What is left of the slab, Q0.16. */
    uint32_t left = 0x10000u;
    if (distance > front) {
        struct brume_number part = brume_number_mul(
            brume_number_of(half - ((distance - front) >> 1), 0),
            brume_number_inverse(brume_number_of(half, 0)));
        left = brume_number_floor(part, 16);
    }
    /* T^left, T = code / 255, by exponents of 2 */
    const int32_t all = brume_log2(brume_number_of(510, 0));
    uint32_t code = transmittance == 0 ? 1u : 2u * transmittance;
    uint32_t depth_log2 =
        (uint32_t)(all - brume_log2(brume_number_of(code, 0)));
    uint32_t y = (16u << 16) - mul_hi_floor(depth_log2 << 12, left << 4);
    uint32_t value = brume_number_floor(brume_exp2(y), 0);
    return value < 0x10000u ? value : 0x10000u;
}

/// Texels ///

/* Part of the map's edge to the middle of a texel, Q0.31. */
static uint32_t share_of(const struct brume_shadow *s, int axis, uint32_t i)
{
    return mul_hi_floor((2u * i + 1u) << s->shift[axis], s->per_texel[axis]);
}

static void texel(const struct brume_shadow *s, const int32_t from[3],
                  uint8_t *transmittance, struct brume_shadow_depth *depth)
{
    static const struct brume_shadow_depth k_none = {BRUME_NO_DEPTH,
                                                     BRUME_NO_DEPTH};
    struct sun_ray ray;
    *transmittance = 255;
    if (depth != NULL)
        *depth = k_none;
    if (!enter(s, from, &ray))
        return;
    struct met met = march(s, ray, depth != NULL);
    *transmittance = (uint8_t)byte_of(s, met.sum);
    if (depth != NULL)
        *depth = depth_of(s, ray.t, &met);
}

static void texels(const struct brume_shadow *s, uint32_t x, uint32_t y,
                   uint32_t w, uint8_t *transmittance,
                   struct brume_shadow_depth *depth)
{
    const struct brume_shadow_map *m = &s->map;
    uint32_t down = share_of(s, 1, y);
    for (uint32_t i = 0; i < w; i++) {
        uint32_t across = share_of(s, 0, x + i), height = 0;
        int32_t p[3];
        if (m->heights != NULL)
            height = m->heights[y * m->heights_stride + x + i];
        for (int a = 0; a < 3; a++)
            p[a] = m->origin[a] + mul_signed_round(m->across[a], across, 1) +
                   mul_signed_round(m->down[a], down, 1) +
                   mul_signed_round(m->rise[a], height << 15, 1);
        texel(s, p, &transmittance[i], depth != NULL ? &depth[i] : NULL);
    }
}

int brume_shadow_rect(const struct brume_shadow *shadow, unsigned x, unsigned y,
                      unsigned w, unsigned h, uint8_t *transmittance,
                      size_t stride, struct brume_shadow_depth *depth,
                      size_t depth_stride)
{
    const struct brume_shadow *s = shadow;
    if (s == NULL || transmittance == NULL)
        return BRUME_ERR_NULL;
    const uint16_t size[2] = {s->map.width, s->map.height};
    if (!brume_rect_fits(size, x, y, w, h) || (h > 1 && stride < w) ||
        (h > 1 && depth != NULL && depth_stride < w))
        return BRUME_ERR_RECT;
    for (unsigned j = 0; j < h; j++)
        texels(s, x, y + j, w, transmittance + j * stride,
               depth != NULL ? depth + j * depth_stride : NULL);
    return BRUME_OK;
}

#endif
