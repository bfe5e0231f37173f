/* SPDX-License-Identifier: MIT */
/*
 * Fog in the wide march: core/brume_fog.h in lanes, and what of the volume lies
 * between samples outside of the pool and the sun: core/brume_air.h. Part of
 * wide_march.c.
 */
#ifndef BRUME_HOST_WIDE_FOG_H
#define BRUME_HOST_WIDE_FOG_H

#include "brume_air.h"
#include "brume_fog.h"
#include "wide_patch.h"

/* As struct fog. */
struct fog_lanes {
    lanes by_height, shapes, all;
    lanes above; /* the base, Q17.14 */
};

/// Density ///

/* brume_along_zenith */
LANES_INLINE lanes along_zeniths(const struct brume_frame *f, const lanes p[3])
{
    return along_axis(f->lit.zenith, p);
}

/* fog_by_height */
LANES_INLINE lanes fogs_by_height(const struct brume_frame *f, lanes above)
{
    const struct brume_lit_fog *fog = &f->lit.fog;
    lanes density = lanes_of(fog->density);
    if (fog->per_falloff.m == 0)
        return density;
    lanes octaves = times_lanes(above, fog->per_falloff);
    lanes tau = ((octaves & 0xffffu) * 45426u + 0x80000u) >> 20;
    lanes e = lanes_of_table16(brume_exp_coarse, tau >> 8) *
              lanes_of_table16(brume_exp_fine, tau & 255u);
    e = lanes_select(mask_less(e, lanes_of(1u << 30)), e << 2,
                     lanes_of(0xffffffffu));
    e = lanes_mul_hi(density, e) >> (octaves >> 16 & 31u);
    e = lanes_where(mask_less(octaves, lanes_of(32u << 16)), e);
    return lanes_select(less_signed(lanes_of(0), above), e, density);
}

/* edge_share */
LANES_INLINE lanes edge_shares(const struct brume_lit_fog *fog, uint32_t n,
                               lanes square)
{
    lanes rest =
        lanes_where(mask_less(square, lanes_of(1u << 30)), (1u << 30) - square);
    return times_lanes(rest, fog->shape[n].edge);
}

/* fog_of_shape, at p without bias */
static lanes fogs_of_shape(const struct brume_frame *f, uint32_t n,
                           const lanes p[3])
{
    const struct brume_lit_fog *fog = &f->lit.fog;
    const struct brume_fog_shape *s = &f->lit.lighting->fog->shapes[n];
    bool box = s->kind == BRUME_FOG_BOX;
    lanes square[3], density = lanes_of(s->density);
    lanes_mask within = mask_first(WIDE_LANES);
    for (int i = 0; i < 3; i++) {
        lanes c = lanes_of((uint32_t)s->centre[i]);
        lanes half = lanes_of(s->half[box ? i : 0]);
        lanes way = lanes_select(less_signed(p[i], c), c - p[i], p[i] - c);
        within = mask_and(within, mask_less(way, half));
        lanes share = lanes_mul_hi(way << fog->shape[n].shift[i],
                                   lanes_of(fog->shape[n].per_half[i]));
        square[i] = lanes_mul_hi(share, share);
    }
    if (!mask_any(within))
        return lanes_of(0);
    if (!box)
        square[0] += square[1] + square[2];
    for (int i = 0; i < (box ? 3 : 1); i++)
        density = lanes_mul_hi(density, edge_shares(fog, n, square[i]));
    return lanes_where(within, density);
}

/* fog_of_shapes, at positions of the frame */
LANES_INLINE lanes fogs_of_shapes(const struct brume_frame *f, const lanes p[3])
{
    uint32_t bias = 0x8000u - brume_half_voxel(f);
    const lanes q[3] = {p[0] - bias, p[1] - bias, p[2] - bias};
    lanes sum = lanes_of(0);
    for (uint32_t n = 0; n < f->lit.fog.shape_count; n++)
        sum = held_sum(sum, fogs_of_shape(f, n, q));
    return sum;
}

/* fog_at */
LANES_INLINE struct fog_lanes fogs_at(const struct brume_frame *f,
                                      const lanes p[3])
{
    struct fog_lanes fog;
    fog.shapes = fogs_of_shapes(f, p);
    fog.above = along_zeniths(f, p) - (uint32_t)f->lit.fog.base;
    fog.by_height = fogs_by_height(f, fog.above);
    fog.all = held_sum(fog.by_height, fog.shapes);
    return fog;
}

/* fog_opacity */
LANES_INLINE lanes fog_opacities(const struct brume_frame *f, lanes fog)
{
    int32_t up = f->lit.fog.step_log2;
    lanes n = lanes_mul_hi(fog, lanes_of(f->lit.fog.step));
    lanes whole = up > 0 ? n >> (uint32_t)(32 - up) : lanes_of(0);
    lanes part = up > 0 ? n << (uint32_t)up : n >> (uint32_t)-up;
    lanes sixteenths = whole << 4 | part >> 28;
    lanes r = part & 0x0fffffffu, square = lanes_mul_hi(r, r);
    lanes o = r - (square >> 1) +
              lanes_mul_hi(lanes_mul_hi(square, r), lanes_of(715827883u));
    lanes some =
        mask_any(mask_less(lanes_of(0), sixteenths))
            ? ~lanes_mul_hi(
                  lanes_of_table16(brume_exp_coarse, sixteenths & 255u) << 17,
                  ~o)
            : o;
    o = lanes_select(mask_equal(sixteenths, lanes_of(0)), o, some);
    return lanes_select(mask_less(lanes_of(255), sixteenths),
                        lanes_of(0xffffffffu), o);
}

/// Towards the sun ///

/* fog_place; which of the places are within */
LANES_INLINE lanes_mask fog_places(lanes q[3], const lanes p[3],
                                   const lanes way[3])
{
    lanes out = lanes_of(0);
    for (int i = 0; i < 3; i++) {
        q[i] = p[i] + way[i];
        out |= (p[i] ^ q[i]) & (way[i] ^ q[i]);
    }
    return mask_less(out, lanes_of(0x80000000u));
}

/* shapes_doubling, from the first samples' ways and sums on */
static lanes shapes_doubling_lanes(const struct brume_frame *f,
                                   const lanes first[3], const lanes p[3],
                                   lanes sum)
{
    const lanes step = lanes_of(f->light_step << 7);
    lanes way[3] = {first[0], first[1], first[2]}, q[3];
    lanes_mask on = mask_first(WIDE_LANES);
    for (uint32_t i = 0; i < f->lit.fog.light_samples; i++) {
        lanes most = lanes_of(0);
        on = mask_and(on, fog_places(q, p, way));
        if (!mask_any(on))
            break;
        lanes part = lanes_mul_hi(fogs_of_shapes(f, q), step);
        lanes_mask fits =
            mask_and(mask_less(part, lanes_of(MOST_DEPTH >> i)),
                     mask_less(sum + (part << i), lanes_of(MOST_DEPTH)));
        lanes next =
            lanes_select(fits, sum + (part << i), lanes_of(MOST_DEPTH));
        sum = lanes_select(on, next, sum);
        for (int axis = 0; axis < 3; axis++) {
            most |= magnitudes(way[axis]);
            way[axis] += way[axis];
        }
        on = mask_and(on, fits);
        on = mask_and(on, mask_less(most, lanes_of(1u << 30)));
        if (i == 15)
            break;
    }
    return sum;
}

/* shapes_uniform */
static lanes shapes_uniform_lanes(const struct brume_frame *f, const lanes p[3])
{
    const lanes step = lanes_of(f->light_step << 7);
    lanes q[3], at[3], move[3], first[3], sum = lanes_of(0);
    for (int i = 0; i < 3; i++) {
        move[i] = lanes_of((uint32_t)f->light_line.move[i]);
        first[i] = lanes_of((uint32_t)f->light.first[i]);
    }
    lanes_mask on = fog_places(q, p, first);
    for (uint32_t i = 0; i < f->lit.fog.light_samples && mask_any(on); i++) {
        for (int axis = 0; axis < 3; axis++)
            at[axis] = q[axis];
        sum += lanes_where(on, lanes_mul_hi(fogs_of_shapes(f, at), step));
        lanes_mask black = mask_less(lanes_of(MOST_DEPTH - 1u), sum);
        sum = lanes_min(sum, lanes_of(MOST_DEPTH));
        on = mask_less_those(mask_and(on, fog_places(q, at, move)), black);
    }
    return sum;
}

/* fog_depth, of samples at p, from number `at` of the queue on */
static lanes fog_depths(const struct brume_frame *f, const struct patch *b,
                        uint32_t at, const lanes p[3])
{
    const struct brume_lit_fog *fog = &f->lit.fog;
    const lanes by_height = lanes_load(b->fog.by_height + at);
    const lanes here = lanes_load(b->fog.shapes + at);
    const lanes above = lanes_load(b->fog.above + at);
    lanes way = lanes_of(fog->way), shapes = lanes_of(0);
    if (f->lit.light == BRUME_NO_LIGHT)
        return shapes;
    if (fog->per_rise.m != 0) {
        lanes up = times_lanes(magnitudes(above), fog->per_rise);
        lanes longer = lanes_select(mask_less(up, fog->most_way - way),
                                    way + up, lanes_of(fog->most_way));
        way = lanes_select(mask_high(above), longer, way);
    }
    if (fog->shape_count != 0 && f->lit.light == BRUME_UNIFORM) {
        shapes = shapes_uniform_lanes(f, p);
    } else if (fog->shape_count != 0) {
        struct light_lanes light;
        begin_light(&light, f, &b->queue, at);
        if (f->lit.light != BRUME_LOG)
            shapes = lanes_mul_hi(here, lanes_of(f->light_step << 7));
        shapes = shapes_doubling_lanes(f, light.first, p, shapes);
    }
    return (lanes_mul_hi(by_height, way << 1) >> 4) + (shapes >> 10);
}

/* transmittance_beyond */
LANES_INLINE lanes transmittances_beyond(const struct brume_tau *t, lanes sum,
                                         lanes more)
{
    lanes_mask black = mask_less(lanes_of(t->limit), sum);
    lanes tau = lanes_mul_hi(sum << t->shift, lanes_of(t->m)) + more;
    black = mask_or(black, mask_less(lanes_of(131070u), tau));
    tau = lanes_unless(black, (tau + 1u) >> 1);
    lanes s = lanes_of_table16(brume_exp_coarse, tau >> 8) *
              lanes_of_table16(brume_exp_fine, tau & 255u);
    return lanes_unless(black, s);
}

/// Outside ///

/* The queue's samples from number `at` on that are outside of the pool. */
LANES_INLINE lanes_mask queued_outside(const struct brume_frame *f,
                                       const struct patch *b, uint32_t at)
{
    if (!f->lit.fog.on)
        return mask_first(0);
    return mask_less(lanes_of(0), lanes_load(b->fog.outside + at));
}

/* leads_away */
LANES_INLINE lanes_mask lead_away(const struct brume_frame *f, const lanes p[3],
                                  const lanes way[3])
{
    lanes_mask away = mask_first(0);
    for (int i = 0; i < 3; i++) {
        lanes_mask low = mask_high(p[i]), up = less_signed(lanes_of(0), way[i]);
        lanes_mask high =
            mask_less_those(mask_less(lanes_of(f->limit[i] - 1u), p[i]), low);
        away = mask_or(away, mask_less_those(low, up));
        away = mask_or(away, mask_less_those(high, mask_high(way[i])));
    }
    return away;
}

/* Whose way to the sun enters the pool, and where: way_to_pool, for samples
 * outside. */
static lanes_mask ways_to_pool(const struct brume_frame *f, const lanes p[3],
                               lanes *enter)
{
    lanes t_in = lanes_of(0), t_out = lanes_of(0xffffffffu), sun[3];
    for (int i = 0; i < 3; i++)
        sun[i] = lanes_of((uint32_t)f->sun[i]);
    lanes_mask away = lead_away(f, p, sun);
    for (int i = 0; i < 3; i++) {
        lanes limit = lanes_of(f->limit[i]);
        lanes_mask high = mask_less(limit - 1u, p[i]); /* or below 0 */
        bool down = f->sun[i] < 0;
        if (f->sun[i] == 0)
            continue;
        lanes out = down ? p[i] + 1u : limit - p[i];
        lanes in = down ? p[i] - (limit - 1u) : 0u - p[i];
        t_out = lanes_min(t_out, times_lanes(out, f->lit.fog.pace[i]));
        in = lanes_where(high, times_lanes(in, f->lit.fog.pace[i]));
        t_in = lanes_max(t_in, in);
    }
    *enter = t_in;
    lanes_mask late =
        mask_and(mask_less(t_out, t_in), mask_less(lanes_of(15), t_in - t_out));
    return mask_less_those(mask_first(WIDE_LANES), mask_or(late, away));
}

/* Of `wanted` samples from number `at` of the queue on those that have uniform
 * light samples in the pool, and how many are before these: 0 of a sample
 * inside; of one outside as in sum_uniform_outside. */
static lanes_mask uniform_ways(const struct brume_frame *f,
                               const struct patch *b, uint32_t at,
                               lanes_mask wanted, lanes *before)
{
    const lanes samples = lanes_of(f->light.samples);
    lanes_mask outside = mask_and(queued_outside(f, b, at), wanted);
    lanes p[3], t_in, n;
    *before = lanes_of(0);
    if (!mask_any(outside))
        return wanted;
    for (int i = 0; i < 3; i++)
        p[i] = lanes_load(b->queue.p[i] + at);
    lanes_mask on = mask_and(outside, ways_to_pool(f, p, &t_in));
    lanes_mask found = mask_less_those(wanted, outside);
    n = times_lanes(t_in, f->lit.fog.per_light_step);
    n -= lanes_min(n, lanes_of(2));
    for (int i = 0; i < 3; i++)
        p[i] +=
            (uint32_t)f->light.first[i] + n * (uint32_t)f->light_line.move[i];
    for (uint32_t tries = 0; tries < 5 && mask_any(on); tries++) {
        on = mask_and(on, mask_less(n, samples));
        lanes_mask inside = mask_and(on, inside_lanes(f, p[0], p[1], p[2]));
        found = mask_or(found, inside);
        *before = lanes_select(inside, n, *before);
        on = mask_less_those(on, inside);
        n += 1u;
        for (int i = 0; i < 3; i++)
            p[i] += (uint32_t)f->light_line.move[i];
    }
    return found;
}

/* The sums of n samples from number `at` of the queue on; those outside of the
 * pool whose way enters it are looked for by the core. */
static lanes sums_outside(const struct brume_frame *f, const struct patch *b,
                          uint32_t at, uint32_t n, lanes sum)
{
    uint32_t sums[WIDE_LANES] __attribute__((aligned(64))), moved[3] = {0};
    lanes_mask outside = mask_and(queued_outside(f, b, at), mask_first(n));
    lanes p[3], t_in;
    struct kernel k = KERNEL_OF(BRUME_U8R, 0, true, false, false);
    k.moved = moved;
    if (!mask_any(outside))
        return sum;
    for (int i = 0; i < 3; i++)
        p[i] = lanes_load(b->queue.p[i] + at);
    unsigned enter = mask_bits(mask_and(outside, ways_to_pool(f, p, &t_in)));
    lanes_spill(sums, lanes_unless(outside, sum));
    for (uint32_t i = 0; i < n; i++) {
        uint32_t from[3];
        if (!(enter >> i & 1u))
            continue;
        queued_position(from, &b->queue, at + i);
        for (int axis = 0; axis < 3 && f->lit.stochastic; axis++)
            moved[axis] = b->lit.moved[axis][at + i];
        sums[i] = sun_sum_outside(f, &f->light, from, &k);
    }
    FORGET(sums);
    return lanes_load(sums);
}

#endif
