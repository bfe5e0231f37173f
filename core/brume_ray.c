/* SPDX-License-Identifier: MIT */
/* The lattice of a ray: where its samples are, and which rays have none. */
#include "brume_inner.h"

/* A ray whose entry into the pool is farther than this misses, Q16.16. */
#define FAR_ENTRY 0xfde80000u /* 65000 voxels */

/* From a ray of the lattice to that of the grid. */
static void grid_of(const struct brume_frame *f, uint32_t *x, uint32_t *y)
{
#if BRUME_WITH_TEMPORAL
    uint32_t place = f->place[0];
    if (f->update == BRUME_CHECKER) /* rows take turns */
        place ^= *y & 1u;
    *x = (*x << f->cell_log2[0]) + place;
    *y = (*y << f->cell_log2[1]) + f->place[1];
#else
    (void)f;
    (void)x;
    (void)y;
#endif
}
/* At (u, v) half pixels from the middle. */
static void direction_of(int32_t out[3], const struct brume_frame *f, int32_t u,
                         int32_t v)
{
    for (int i = 0; i < 3; i++)
        out[i] = f->ahead[i] + u * f->per_x[i] + v * f->per_y[i];
}

#if BRUME_WITH_SKY
void brume_pixel_direction(const struct brume_frame *frame, uint32_t x,
                           uint32_t y, int32_t out[3])
{
    direction_of(out, frame, (int32_t)(2u * x + 1u) - (int32_t)frame->width,
                 (int32_t)frame->height - (int32_t)(2u * y + 1u));
}
#endif

/* Exact: linear in x and y. */
void brume_grid_direction(const struct brume_frame *frame, uint32_t x,
                          uint32_t y, int32_t out[3])
{
    const struct brume_frame *f = frame;
    uint32_t r = brume_resolution_of(f);
    int32_t u = (int32_t)((2u * x + 1u) << r) - (int32_t)f->width;
    int32_t v = (int32_t)f->height - (int32_t)((2u * y + 1u) << r);
    direction_of(out, f, u, v);
}

#if BRUME_WITH_TEMPORAL
/* Moves a direction by u to the right and v down, Q16.16 half pixels,
 * |.| <= 2^18. */
static void move_direction(int32_t d[3], const struct brume_frame *f, int32_t u,
                           int32_t v)
{
    for (int i = 0; i < 3; i++)
        d[i] += mul_both_signed_round(f->per_x[i], u * 512, 7) -
                mul_both_signed_round(f->per_y[i], v * 512, 7);
}

/* Where in its pixel the ray (x, y) of the grid goes: the frame's point, plus
 * two values of noise that stay the same from frame to frame. */
static void move_in_pixel(int32_t d[3], const struct brume_frame *f, uint32_t x,
                          uint32_t y)
{
    int32_t move[2];
    for (uint32_t i = 0; i < 2; i++) {
        uint32_t p = f->point[i];
        if (BRUME_WITH_NOISE)
            p += brume_noise_value(f->noise, &f->noise_table, x, y, 0, 2u + i);
        move[i] = ((int32_t)(p & 0xffffu) - 0x8000) *
                  (int32_t)(2u << brume_resolution_of(f));
    }
    move_direction(d, f, move[0], move[1]);
}
#endif

uint32_t brume_inverse_of_move(int32_t move)
{
    return move == 0 ? 0xffffffffu : 0xffffffffu / magnitude(move);
}

/* 1 / speed of an axis, for time_of: 2^63 / (speed * 2^shift). */
struct pace {
    uint32_t reciprocal;
    unsigned shift;
};

/* speed in Q2.30, 1 .. 2^30: shift >= 1. */
static struct pace pace_of(uint32_t speed)
{
    unsigned shift = leading_zeros(speed);
    struct pace pace = {brume_reciprocal(speed << shift), shift};
    return pace;
}

/* distance / speed: Q16.16 / Q2.30 -> Q16.16, all ones when it is more. */
static uint32_t time_of(uint32_t distance, struct pace pace)
{
    /* distance 2^30 2^shift / speed = distance r 2^(shift-33) */
    unsigned shift = pace.shift;
    uint32_t high = mul_hi_floor(distance, pace.reciprocal);
    uint32_t low = distance * pace.reciprocal;
    if (shift > 1 && high >> (33 - shift) != 0)
        return 0xffffffffu;
    return shift > 1 ? high << (shift - 1) | low >> (33 - shift) : high;
}

/* The times within which the ray can be in the pool; false when never. */
static bool clip(const struct brume_frame *f, const int32_t unit[3],
                 uint32_t *t_in, uint32_t *t_out)
{
    *t_in = 0;
    *t_out = 0xffffffffu;
    for (int i = 0; i < 3; i++) {
        bool below = f->eye[i] < 0;
        bool above = !below && (uint32_t)f->eye[i] >= f->limit[i];
        if ((below && unit[i] <= 0) || (above && unit[i] >= 0))
            return false;
        if (unit[i] == 0)
            continue;
        /* Distances to the planes 0 and limit. */
        uint32_t to_low = magnitude(f->eye[i]);
        uint32_t to_high = f->limit[i] - (uint32_t)f->eye[i];
        if (above)
            to_high = 0u - to_high;
        struct pace pace = pace_of(magnitude(unit[i]));
        uint32_t t = time_of(unit[i] > 0 ? to_high : to_low, pace);
        if (t < *t_out)
            *t_out = t;
        if (below || above) {
            t = time_of(below ? to_low : to_high, pace);
            if (t > *t_in)
                *t_in = t;
        }
        /* A ray along a face may seem to leave before it enters, by
         * rounding. */
        if (*t_in > *t_out && *t_in - *t_out >= 16u)
            return false;
    }
    return *t_in < FAR_ENTRY;
}

static bool inside(const struct brume_frame *f, const uint32_t p[3])
{
    return p[0] < f->limit[0] && p[1] < f->limit[1] && p[2] < f->limit[2];
}

static void set_moves(struct brume_ray *ray, const struct brume_frame *f,
                      const int32_t unit[3])
{
    for (int i = 0; i < 3; i++)
        ray->line.move[i] = mul_signed_round(unit[i], f->step, 2);
}

/* Distance of the lattice's first point. */
static uint32_t first_t(const struct brume_frame *f, uint32_t jitter)
{
    return mul_hi_floor(jitter << 16, f->step);
}

/* To the first lattice point in the pool: near `t_in`, but decided by the
 * positions themselves, so that later code need not look. Positions are true
 * modulo 2^32 and within a few steps of the pool, so none wraps into it. */
static bool enter(struct brume_ray *ray, const struct brume_frame *f,
                  const int32_t unit[3], uint32_t jitter, uint32_t t_in,
                  uint32_t t_out)
{
    uint32_t k = t_in / f->step;
    if (k > 0)
        k--;
    uint32_t t = k * f->step + first_t(f, jitter);
    brume_ray_place(f, unit, t, ray->position);
    set_moves(ray, f, unit);
    uint32_t tries = t_out > t ? (t_out - t) / f->step + 2u : 2u;
    for (; !inside(f, ray->position); tries--, t += f->step) {
        if (tries == 0)
            return false;
        for (int i = 0; i < 3; i++)
            ray->position[i] += (uint32_t)ray->line.move[i];
    }
#if BRUME_RAY_HAS_T
    ray->t = t;
#endif
    return true;
}

/* Lattice points from the position to the pool's end: exact. */
static uint32_t count_inside(const struct brume_ray *ray,
                             const struct brume_frame *f)
{
    uint32_t count = 0xffffffffu;
    for (int i = 0; i < 3; i++) {
        uint32_t move = magnitude(ray->line.move[i]);
        if (move == 0)
            continue;
        uint32_t room = ray->line.move[i] < 0
                            ? ray->position[i]
                            : f->limit[i] - 1u - ray->position[i];
        /* The product is the quotient or one less. */
        uint32_t n = mul_hi_floor(room, ray->line.inverse[i]);
        if ((n + 1u) * move <= room) /* < 2^31 + 2^25 */
            n++;
        if (n < count)
            count = n;
    }
    return count + 1u;
}

/* Is sample i of a light ray 32768 voxels away on an axis, along which its
 * first one is `first` and a light step `step`? Then it is out of the pool, and
 * might not fit the word. Of cones within 1/4 of a voxel: the pool is 8
 * shorter.
 */
static bool is_far(const struct brume_frame *f, uint32_t first, uint32_t step,
                   uint32_t i)
{
#if BRUME_WITH_CONE
    if (f->lit.light == BRUME_CONE) {
        /* first < 2^25, length <= 2^9: their product >> 4 is below 2^30 */
        struct brume_segment s = brume_segment_of(i, f->light_samples);
        return (first >> 4) * s.length + (step >> 4) * s.before >= 1u << 27;
    }
#else
    (void)f, (void)step;
#endif
    return first >> (31u - i) != 0;
}

void brume_light_begin(struct brume_light_ray *light,
                       const struct brume_frame *frame, uint32_t jitter)
{
    const struct brume_frame *f = frame;
    bool uniform = f->light_kind == BRUME_UNIFORM;
    uint32_t first =
        uniform ? f->light_step >> 1
                : f->light_step + mul_hi_floor(jitter << 16, f->light_step);
    uint32_t n = f->light_samples;
    for (int i = 0; i < 3; i++) {
        light->first[i] = mul_signed_round(f->sun[i], first, 2);
        while (!uniform && n > 0 &&
               is_far(f, magnitude(light->first[i]),
                      magnitude(f->light_line.move[i]), n - 1u))
            n--;
    }
    light->samples = n;
}

static uint32_t jitter_of(const struct brume_frame *f, uint32_t x, uint32_t y,
                          uint32_t channel)
{
    return BRUME_WITH_NOISE && (f->jitter >> channel & 1u)
               ? brume_noise_value(f->noise, &f->noise_table, x, y,
                                   brume_noise_frame(f), channel)
               : 0;
}

/* The jitter of a view ray: within the frame's stratum of the step. */
static uint32_t view_jitter(const struct brume_frame *f, uint32_t x, uint32_t y)
{
    uint32_t jitter = jitter_of(f, x, y, 0);
#if BRUME_WITH_TEMPORAL
    jitter = f->stratum + ((jitter * f->strata) >> 16);
#endif
    return jitter;
}

/* Two directions, and all between them, on the outer side of a line? */
static bool both_outside(const struct brume_outline *o, const int32_t d[3],
                         const int32_t e[3])
{
    return product_less(d[o->i], o->b, d[o->j], o->a) &&
           product_less(e[o->i], o->b, e[o->j], o->a);
}

bool brume_rays_miss(const struct brume_frame *frame, uint32_t x, uint32_t y,
                     uint32_t n)
{
    const struct brume_frame *f = frame;
    uint32_t last = x + n - 1u, bottom = y;
    int32_t d[4][3];
    if (brume_has_fog(f))
        return false;
    grid_of(f, &x, &y);
    grid_of(f, &last, &bottom);
    brume_grid_direction(f, x, y, d[0]);
    brume_grid_direction(f, last, y, d[1]);
#if BRUME_WITH_TEMPORAL
    if (f->subpixel) { /* the four corners of what the rays may be */
        int32_t half = (int32_t)(0x10000u << brume_resolution_of(f));
        for (int i = 0; i < 3; i++) {
            d[2][i] = d[0][i];
            d[3][i] = d[1][i];
        }
        move_direction(d[0], f, -half, -half);
        move_direction(d[1], f, half, -half);
        move_direction(d[2], f, -half, half);
        move_direction(d[3], f, half, half);
    }
    bool corners = f->subpixel;
#else
    bool corners = false;
#endif
    for (uint32_t k = 0; k < f->outlines; k++)
        if (both_outside(&f->outline[k], d[0], d[1]) &&
            (!corners || both_outside(&f->outline[k], d[2], d[3])))
            return true;
    return false;
}

#if BRUME_WITH_STOCHASTIC
/* Axis i of where the ray's first lookup is moved to. Noises whose channels
 * keep their distance from frame to frame get one that each axis moves by. */
static uint32_t lookup_noise(const struct brume_frame *f, uint32_t x,
                             uint32_t y, uint32_t i)
{
    uint32_t frame = brume_noise_frame(f);
    uint32_t value =
        brume_noise_value(f->noise, &f->noise_table, x, y, frame, 4u + i);
    bool apart = f->noise == BRUME_NOISE_WHITE ||
                 f->noise == BRUME_NOISE_TABLE ||
                 f->noise == BRUME_NOISE_TABLE_R2;
    return apart ? value : value + brume_r3(frame, i);
}
#endif

#if BRUME_WITH_LIGHTING
static void set_lit(struct brume_ray *ray, const struct brume_frame *f,
                    const int32_t unit[3], uint32_t x, uint32_t y)
{
    ray->x = x;
    ray->y = y;
    for (uint32_t i = 0; i < 3; i++) {
        ray->unit[i] = unit[i];
#if BRUME_WITH_STOCHASTIC
        if (f->lit.stochastic)
            ray->noise[i] = lookup_noise(f, x, y, i);
#endif
    }
}
#endif

/// Where rays end ///

#if BRUME_WITH_SURFACE
/* Takes away what lies at or behind the surface; false when nothing is left. */
static bool cut_at_surface(struct brume_ray *ray, const struct brume_frame *f,
                           uint32_t x, uint32_t y)
{
    uint32_t n =
        brume_samples_before(brume_surface_distance(f, x, y), ray->t, f->step);
    ray->count = n < ray->count ? n : ray->count;
    return n > 0;
}
#endif

#if BRUME_WITH_FOG
/* Where the ray comes to a coordinate of +-32767, Q16.16. */
static uint32_t time_of_edge(const struct brume_frame *f, const int32_t unit[3])
{
    const uint32_t edge = 0x7fff0000u;
    uint32_t t_edge = 0xffffffffu;
    for (int i = 0; i < 3; i++) {
        if (unit[i] == 0)
            continue;
        uint32_t room = unit[i] < 0 ? edge + (uint32_t)f->eye[i]
                                    : edge - (uint32_t)f->eye[i];
        uint32_t t = time_of(room, pace_of(magnitude(unit[i])));
        t_edge = t < t_edge ? t : t_edge;
    }
    return t_edge;
}

/* Samples of a ray through fog, from the eye on; those in the pool, if there
 * are any (`meets`), are known already. False when nothing is left. */
static bool begin_in_fog(struct brume_ray *ray, const struct brume_frame *f,
                         const int32_t unit[3], uint32_t x, uint32_t y,
                         bool meets)
{
    uint32_t end = f->lit.lighting->fog->far;
    uint32_t t = first_t(f, view_jitter(f, x, y));
    uint32_t edge = time_of_edge(f, unit);
    end = edge < end ? edge : end;
#if BRUME_WITH_SURFACE
    uint32_t surface = brume_surface_distance(f, x, y);
    end = surface < end ? surface : end;
#else
    (void)x, (void)y;
#endif
    ray->samples = brume_samples_before(end, t, f->step);
    ray->before = meets ? (ray->t - t) / f->step : ray->samples;
    if (!meets) {
        set_moves(ray, f, unit);
        ray->count = 0;
    }
    if (ray->before > ray->samples)
        ray->before = ray->samples;
    if (ray->count > ray->samples - ray->before)
        ray->count = ray->samples - ray->before;
    ray->t = t;
    return ray->samples > 0;
}
#endif

/* The end of what the lattice in the pool leaves; false when there is no
 * sample. */
static bool end_ray(struct brume_ray *ray, const struct brume_frame *f,
                    const int32_t unit[3], uint32_t x, uint32_t y, bool meets)
{
    (void)ray, (void)f, (void)unit, (void)x, (void)y;
#if BRUME_WITH_FOG
    if (brume_has_fog(f))
        return begin_in_fog(ray, f, unit, x, y, meets);
#endif
#if BRUME_WITH_SURFACE
    if (meets && brume_has_surface(f))
        return cut_at_surface(ray, f, x, y);
#endif
    return meets;
}

bool brume_ray_begin(struct brume_ray *ray, const struct brume_frame *frame,
                     uint32_t x, uint32_t y)
{
    const struct brume_frame *f = frame;
    int32_t unit[3];
    uint32_t t_in, t_out;
    grid_of(f, &x, &y);
    brume_grid_direction(f, x, y, unit);
#if BRUME_WITH_TEMPORAL
    if (f->subpixel)
        move_in_pixel(unit, f, x, y);
#endif
    brume_normalise(unit);
    bool meets = clip(f, unit, &t_in, &t_out) &&
                 enter(ray, f, unit, view_jitter(f, x, y), t_in, t_out);
    if (!meets && !brume_has_fog(f))
        return false;
    for (int i = 0; meets && i < 3; i++)
        ray->line.inverse[i] = brume_inverse_of_move(ray->line.move[i]);
    if (meets)
        ray->count = count_inside(ray, f);
    if (!end_ray(ray, f, unit, x, y, meets))
        return false;
    if (!f->skip)
        for (int i = 0; i < 3; i++)
            ray->line.inverse[i] = 0;
    ray->light = f->light;
    if (BRUME_WITH_NOISE && (f->jitter & BRUME_JITTER_LIGHT))
        brume_light_begin(&ray->light, f, jitter_of(f, x, y, 1));
#if BRUME_WITH_LIGHTING
    if (f->lit.on)
        set_lit(ray, f, unit, x, y);
#endif
    return true;
}
