/* SPDX-License-Identifier: MIT */
/*
 * The rays of a tile in lanes: brume_ray_begin of core/brume_ray.c and the
 * noises of core/brume_noise.c, step by step. Where the core divides words,
 * doubles do: of two words below 2^32 they give the quotient's floor exactly.
 */
#ifndef BRUME_HOST_WIDE_RAYS_H
#define BRUME_HOST_WIDE_RAYS_H

#include "brume_lookup.h"
#include "wide_maths.h"

/* A ray whose entry into the pool is farther than this misses, Q16.16. */
#define FAR_ENTRY 0xfde80000u

/* One ray a lane. */
struct rays {
    lanes position[3];
    lanes move[3];
    lanes left;    /* samples in the pool */
    lanes t;       /* of the first, Q16.16 */
    lanes unit[3]; /* direction, Q2.30 */
    lanes x, y;    /* of the grid */
    lanes before;  /* in fog: samples before those in the pool, */
    lanes samples; /* and all; t is of the first of these */
    lanes_mask alive;
};

/// Noise ///

LANES_INLINE lanes lanes_mix(lanes h)
{
    h ^= h >> 16;
    h *= 0x7feb352du;
    h ^= h >> 15;
    h *= 0x846ca68bu;
    return h ^ h >> 16;
}

LANES_INLINE lanes lanes_ign(lanes x, lanes y, uint32_t moved)
{
    lanes u = x * 288237660u + y * 25070368u + moved;
    return (u * 52u + lanes_mul_hi(u, lanes_of(4221604530u))) >> 16;
}

LANES_INLINE lanes lanes_bayer(lanes x, lanes y, uint32_t log2)
{
    lanes d = x ^ y, v = lanes_of(0);
    for (uint32_t i = 0; i < log2; i++) {
        v = v << 2 | (d & 1u) << 1 | (y & 1u);
        d >>= 1;
        y >>= 1;
    }
    return (v * 2u + 1u) << (15u - 2u * log2);
}

/* Where channel c looks in a tile of side 2^log2. */
LANES_INLINE uint32_t channel_place(uint32_t channel, uint32_t per_channel,
                                    uint32_t log2)
{
    return (channel * per_channel & 0xffffu) >> (16u - log2);
}

static inline lanes table_lanes(const struct brume_noise_table *t, lanes x,
                                lanes y, uint32_t frame)
{
    x &= (1u << t->width_log2) - 1u;
    y &= (1u << t->height_log2) - 1u;
    frame &= (1u << t->frames_log2) - 1u;
    lanes i = ((y | frame << t->height_log2) << t->width_log2) | x;
    if (t->bits == 8)
        return gather_bytes(t->values, i) * 256u + 128u;
    lanes v = gather_bytes(t->values, i >> 1) >> ((i & 1u) << 2) & 15u;
    return v << 12 | lanes_bayer(x & 3u, y & 3u, 2) >> 4;
}

static inline lanes table_noise(int noise, const struct brume_noise_table *t,
                                lanes x, lanes y, uint32_t frame,
                                uint32_t channel)
{
    x += channel_place(channel, 49472u, t->width_log2);
    y += channel_place(channel, 37345u, t->height_log2);
    if (noise == BRUME_NOISE_TABLE)
        return table_lanes(t, x, y, frame);
    if (noise == BRUME_NOISE_TABLE_R2) {
        x += (frame * 3242174889u) >> (32u - t->width_log2);
        y += (frame * 2447445414u) >> (32u - t->height_log2);
        return table_lanes(t, x, y, 0);
    }
    uint32_t further = (frame * 2654435769u) >> 24 << 8;
    return (table_lanes(t, x, y, 0) + further) & 0xffffu;
}

LANES_INLINE lanes bayer_noise(lanes x, lanes y, uint32_t channel,
                               uint32_t log2)
{
    return lanes_bayer(x + channel_place(channel, 49472u, log2),
                       y + channel_place(channel, 37345u, log2), log2);
}

/* brume_noise_value. */
static inline lanes noise_lanes(const struct brume_frame *f, lanes x, lanes y,
                                uint32_t frame, uint32_t channel)
{
    lanes far_x = x + 96u * channel, far_y = y + 72u * channel;
    switch (f->noise) {
    case BRUME_NOISE_WHITE:
        y += lanes_mix(lanes_of(2u * frame + channel + 0x9e3779b9u));
        return lanes_mix(x + lanes_mix(y)) >> 16;
    case BRUME_NOISE_IGN:
        return lanes_ign(far_x, far_y, (frame & 63u) * 1750839832u);
    case BRUME_NOISE_IGN_THESIS:
        return lanes_ign(far_x, far_y, frame * 722416529u);
    case BRUME_NOISE_RANK1:
        return (far_x * 3436602405u + far_y * 2850901108u +
                frame * 1207711862u) >>
               16;
    case BRUME_NOISE_BAYER4: return bayer_noise(x, y, channel, 2);
    case BRUME_NOISE_BAYER8: return bayer_noise(x, y, channel, 3);
    case BRUME_NOISE_BAYER16: return bayer_noise(x, y, channel, 4);
    case BRUME_NOISE_TABLE:
    case BRUME_NOISE_TABLE_GOLDEN:
    case BRUME_NOISE_TABLE_R2:
        return table_noise(f->noise, &f->noise_table, x, y, frame, channel);
    default: return lanes_of(0);
    }
}

LANES_INLINE lanes jitter_lanes(const struct brume_frame *f, lanes x, lanes y,
                                uint32_t channel)
{
    return f->jitter >> channel & 1u
               ? noise_lanes(f, x, y, f->noise_frame, channel)
               : lanes_of(0);
}

/* lookup_noise: of stochastic lookups, along axis i. */
static inline lanes lookup_noises(const struct brume_frame *f, lanes x, lanes y,
                                  uint32_t i)
{
    lanes value = noise_lanes(f, x, y, f->noise_frame, 4u + i);
    bool apart = f->noise == BRUME_NOISE_WHITE ||
                 f->noise == BRUME_NOISE_TABLE ||
                 f->noise == BRUME_NOISE_TABLE_R2;
    return apart ? value : value + brume_r3(f->noise_frame, i);
}

/// Directions ///

static inline void move_in_pixels(lanes d[3], const struct brume_frame *f,
                                  lanes x, lanes y)
{
    lanes move[2];
    for (uint32_t i = 0; i < 2; i++) {
        lanes p = noise_lanes(f, x, y, 0, 2u + i) + f->point[i];
        move[i] = ((p & 0xffffu) - 0x8000u) * ((2u << f->resolution) * 512u);
    }
    for (int i = 0; i < 3; i++) {
        lanes per_x = lanes_of((uint32_t)f->per_x[i]);
        lanes per_y = lanes_of((uint32_t)f->per_y[i]);
        d[i] += mul_both_round_lanes(per_x, move[0], 7) -
                mul_both_round_lanes(per_y, move[1], 7);
    }
}

/* Unit vectors of the rays x, y of the grid. */
static inline void directions_of(lanes d[3], const struct brume_frame *f,
                                 lanes x, lanes y)
{
    lanes u = ((x * 2u + 1u) << f->resolution) - f->width;
    lanes v = f->height - ((y * 2u + 1u) << f->resolution);
    for (int i = 0; i < 3; i++)
        d[i] = u * (uint32_t)f->per_x[i] + v * (uint32_t)f->per_y[i] +
               (uint32_t)f->ahead[i];
    if (f->subpixel)
        move_in_pixels(d, f, x, y);
    normalise_lanes(d);
}

/// Pool ///

/* brume_ray_place along axis i */
LANES_INLINE lanes places_along(const struct brume_frame *f, int i, lanes unit,
                                lanes t)
{
    lanes m = magnitudes(unit), low = m * t;
    lanes way = (lanes_mul_hi(m, t) << 2 | low >> 30) + (low >> 29 & 1u);
    return with_signs(way, signs_of(unit)) + (uint32_t)f->eye[i];
}

/* pace_of, of speeds that may be 0 */
struct pace_lanes {
    lanes reciprocal, shift;
};

LANES_INLINE struct pace_lanes paces_of(lanes speed)
{
    struct pace_lanes pace;
    pace.shift = lanes_min(lanes_leading_zeros(speed), lanes_of(31));
    pace.reciprocal = reciprocals(speed << pace.shift | 0x80000000u);
    return pace;
}

/* time_of. Shifts by 33 - shift are two, as shift may be 1. */
LANES_INLINE lanes times_of(lanes distance, struct pace_lanes pace)
{
    lanes high = lanes_mul_hi(distance, pace.reciprocal);
    lanes low = distance * pace.reciprocal;
    lanes up = pace.shift - 1u, down = 32u - pace.shift;
    lanes_mask fits = mask_equal(high >> 1 >> down, lanes_of(0));
    return lanes_select(fits, high << up | low >> 1 >> down,
                        lanes_of(0xffffffffu));
}

/* clip: which rays can be in the pool, and when. */
static inline lanes_mask clip_lanes(const struct brume_frame *f,
                                    const lanes unit[3], lanes *t_in,
                                    lanes *t_out)
{
    lanes zero = lanes_of(0);
    lanes_mask may = mask_first(WIDE_LANES);
    *t_in = zero;
    *t_out = lanes_of(0xffffffffu);
    for (int i = 0; i < 3; i++) {
        bool below = f->eye[i] < 0;
        bool above = !below && (uint32_t)f->eye[i] >= f->limit[i];
        uint32_t to_low = magnitude(f->eye[i]);
        uint32_t to_high = f->limit[i] - (uint32_t)f->eye[i];
        if (above)
            to_high = 0u - to_high;
        lanes speed = magnitudes(unit[i]);
        lanes_mask moves = mask_less(zero, speed);
        lanes_mask backwards = mask_high(unit[i]);
        if (below)
            may = mask_and(may, mask_less_those(moves, backwards));
        if (above)
            may = mask_and(may, backwards);
        struct pace_lanes pace = paces_of(speed);
        lanes t = times_of(
            lanes_select(backwards, lanes_of(to_low), lanes_of(to_high)), pace);
        *t_out = lanes_min(*t_out, lanes_select(moves, t, *t_out));
        if (!below && !above)
            continue;
        t = times_of(lanes_of(below ? to_low : to_high), pace);
        *t_in = lanes_select(mask_and(moves, mask_less(*t_in, t)), t, *t_in);
    }
    lanes_mask late = mask_and(mask_less(*t_out, *t_in),
                               mask_less(lanes_of(15), *t_in - *t_out));
    return mask_and(mask_less_those(may, late),
                    mask_less(*t_in, lanes_of(FAR_ENTRY)));
}

LANES_INLINE lanes_mask inside_lanes(const struct brume_frame *f, lanes x,
                                     lanes y, lanes z)
{
    return mask_and(mask_less(x, lanes_of(f->limit[0])),
                    mask_and(mask_less(y, lanes_of(f->limit[1])),
                             mask_less(z, lanes_of(f->limit[2]))));
}

/* enter, for r->alive; takes those away that never are inside. */
static inline void enter_lanes(struct rays *r, const struct brume_frame *f,
                               const lanes unit[3], lanes jitter, lanes t_in,
                               lanes t_out)
{
    lanes step = lanes_of(f->step), *p = r->position;
    lanes k = lanes_quotient(t_in, step);
    k -= lanes_min(k, lanes_of(1));
    lanes t = k * step + lanes_mul_hi(jitter << 16, step);
    for (int i = 0; i < 3; i++) {
        p[i] = places_along(f, i, unit[i], t);
        r->move[i] = mul_round_lanes(unit[i], step, 2);
    }
    lanes_mask outside =
        mask_less_those(r->alive, inside_lanes(f, p[0], p[1], p[2]));
    if (mask_any(outside)) {
        lanes tries =
            lanes_select(mask_less(t, t_out), lanes_quotient(t_out - t, step),
                         lanes_of(0)) +
            2u;
        while (mask_any(outside)) {
            lanes_mask lost = mask_and(outside, mask_equal(tries, lanes_of(0)));
            r->alive = mask_less_those(r->alive, lost);
            outside = mask_less_those(outside, lost);
            for (int i = 0; i < 3; i++)
                p[i] += lanes_where(outside, r->move[i]);
            t += lanes_where(outside, step);
            tries -= 1u;
            outside =
                mask_less_those(outside, inside_lanes(f, p[0], p[1], p[2]));
        }
    }
    r->t = t;
}

/* count_inside */
LANES_INLINE lanes counts_inside(const struct rays *r,
                                 const struct brume_frame *f)
{
    lanes count = lanes_of(0xffffffffu);
    for (int i = 0; i < 3; i++) {
        lanes move = magnitudes(r->move[i]);
        lanes room = lanes_select(mask_high(r->move[i]), r->position[i],
                                  f->limit[i] - 1u - r->position[i]);
        lanes n = lanes_quotient(room, lanes_max(move, lanes_of(1)));
        n = lanes_select(mask_less(lanes_of(0), move), n, count);
        count = lanes_min(count, n);
    }
    return count + 1u;
}

/// Rays ///

/* brume_light_begin: to the first sample */
LANES_INLINE void begin_light_lanes(lanes first[3], const struct brume_frame *f,
                                    lanes jitter)
{
    lanes step = lanes_of(f->light_step);
    step += lanes_mul_hi(jitter << 16, step);
    for (int i = 0; i < 3; i++)
        first[i] = mul_round_lanes(lanes_of((uint32_t)f->sun[i]), step, 2);
}

/* and how many samples fit a word. */
LANES_INLINE lanes light_samples_of(const lanes first[3],
                                    const struct brume_frame *f)
{
    lanes most =
        magnitudes(first[0]) | magnitudes(first[1]) | magnitudes(first[2]);
    return lanes_min(lanes_of(f->light_samples), lanes_leading_zeros(most));
}

/* brume_surface_distance of the rays that are alive */
LANES_INLINE lanes surface_distances(const struct rays *r,
                                     const struct brume_frame *f)
{
    uint32_t alive = mask_bits(r->alive);
    lanes far = lanes_of(0xffffffffu);
    for (uint32_t n = 0; n < WIDE_LANES; n++)
        if (alive >> n & 1u)
            far[n] = brume_surface_distance(f, r->x[n], r->y[n]);
    return far;
}

/* brume_samples_before, of ends that are not all ones */
LANES_INLINE lanes samples_before(lanes end, lanes t, lanes step)
{
    lanes_mask some = mask_less(t, end);
    return lanes_where(
        some, lanes_quotient(lanes_where(some, end - t - 1u), step) + 1u);
}

/* cut_at_surface, for r->alive; takes those away that have nothing left. */
static inline void cut_lanes(struct rays *r, const struct brume_frame *f)
{
    lanes far = surface_distances(r, f);
    lanes most = lanes_select(mask_equal(far, lanes_of(0xffffffffu)), far,
                              samples_before(far, r->t, lanes_of(f->step)));
    r->left = lanes_min(r->left, most);
    r->alive = mask_and(r->alive, mask_less(lanes_of(0), most));
}

/* time_of_edge */
LANES_INLINE lanes times_of_edge(const struct brume_frame *f,
                                 const lanes unit[3])
{
    const uint32_t edge = 0x7fff0000u;
    lanes most = lanes_of(0xffffffffu);
    for (int i = 0; i < 3; i++) {
        lanes speed = magnitudes(unit[i]);
        lanes room = lanes_select(mask_high(unit[i]),
                                  lanes_of(edge + (uint32_t)f->eye[i]),
                                  lanes_of(edge - (uint32_t)f->eye[i]));
        lanes t = times_of(room, paces_of(speed));
        most = lanes_select(mask_less(lanes_of(0), speed), lanes_min(most, t),
                            most);
    }
    return most;
}

/* begin_in_fog: those alive so far meet the pool, and in the end all that have
 * a sample are. */
static inline void begin_fog_lanes(struct rays *r, const struct brume_frame *f,
                                   lanes jitter, lanes_mask wanted)
{
    lanes step = lanes_of(f->step), t = lanes_mul_hi(jitter << 16, step);
    lanes end = lanes_min(lanes_of(f->lit.lighting->fog->far),
                          times_of_edge(f, r->unit));
    lanes_mask meets = r->alive;
    r->alive = wanted;
    if (brume_has_surface(f))
        end = lanes_min(end, surface_distances(r, f));
    r->samples = samples_before(end, t, step);
    r->before = lanes_quotient(lanes_where(meets, r->t - t), step);
    r->before =
        lanes_min(lanes_select(meets, r->before, r->samples), r->samples);
    r->left = lanes_min(lanes_where(meets, r->left), r->samples - r->before);
    r->t = t;
    r->alive = mask_and(wanted, mask_less(lanes_of(0), r->samples));
}

/* brume_ray_begin for the rays x, y of the lattice that are wanted. */
static inline void begin_lanes(struct rays *r, lanes light_first[3],
                               const struct brume_frame *f, lanes x, lanes y,
                               lanes_mask wanted)
{
    lanes t_in, t_out, place = lanes_of(f->place[0]);
    if (f->update == BRUME_CHECKER)
        place ^= y & 1u;
    r->x = x = (x << f->cell_log2[0]) + place;
    r->y = y = (y << f->cell_log2[1]) + f->place[1];
    directions_of(r->unit, f, x, y);
    r->alive = mask_and(wanted, clip_lanes(f, r->unit, &t_in, &t_out));
    if (!mask_any(r->alive) && !brume_has_fog(f))
        return;
    lanes jitter = jitter_lanes(f, x, y, 0);
    jitter = (jitter * f->strata >> 16) + f->stratum;
    enter_lanes(r, f, r->unit, jitter, t_in, t_out);
    r->left = counts_inside(r, f);
    if (brume_has_fog(f))
        begin_fog_lanes(r, f, jitter, wanted);
    else if (brume_has_surface(f))
        cut_lanes(r, f);
    if ((f->jitter & BRUME_JITTER_LIGHT) && f->light_kind != BRUME_UNIFORM)
        begin_light_lanes(light_first, f, jitter_lanes(f, x, y, 1));
}

#endif
