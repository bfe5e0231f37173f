/* SPDX-License-Identifier: MIT */
/*
 * Lamps in the wide march: core/brume_lamp_light.h in lanes, for samples of the
 * queue. A lamp is met by all samples of a vector whose clusters have it at
 * once; which those are, and what is in a shadow's way, is found sample by
 * sample by the core's functions. Part of wide_march.c.
 */
#ifndef BRUME_HOST_WIDE_LAMPS_H
#define BRUME_HOST_WIDE_LAMPS_H

#include "brume_lamps.h"
#include "wide_patch.h"

/* The ways from samples to a lamp, as struct lamp_way. */
struct lamp_lanes {
    lanes d[3], square, zeros;
};

/* A vector of samples, as struct lamp_sample. */
struct lamp_samples {
    uint32_t at; /* number in the queue of the first */
    lanes halved[3], ray[3], sum[3];
    uint32_t words[BRUME_LAMP_WORDS][WIDE_LANES];
} __attribute__((aligned(64)));

/// Distance ///

/* lamp_square and what is made of it; which samples are within the radius. */
LANES_INLINE lanes_mask lamp_ways(struct lamp_lanes *w,
                                  const struct brume_lit_lamp *l,
                                  const lanes at[3])
{
    uint32_t radius = (uint32_t)(l->radius_square >> 32);
    lanes high = lanes_of(0), low = lanes_of(0);
    for (int i = 0; i < 3; i++) {
        w->d[i] = l->position[i] - at[i];
        lanes m = magnitudes(w->d[i]), part = m * m;
        low += part;
        high +=
            lanes_mul_hi(m, m) + lanes_where(mask_less(low, part), lanes_of(1));
    }
    lanes_mask within =
        mask_or(mask_less(high, lanes_of(radius)),
                mask_and(mask_equal(high, lanes_of(radius)),
                         mask_less(low, lanes_of((uint32_t)l->radius_square))));
    lanes_mask far = mask_less(lanes_of(0), high);
    lanes up = lanes_leading_zeros(lanes_select(far, high, low | 1u));
    w->zeros = lanes_select(far, up, up + 32u);
    /* up is below 32 */
    w->square = lanes_select(far, high << up | low >> 1 >> (31u - up),
                             (low | 1u) << up);
    return within;
}

/* lamp_reciprocal */
LANES_INLINE lanes lamp_reciprocals(lanes d)
{
    lanes y = 3031741620u - lanes_mul_hi(d, lanes_of(2021161080u));
    for (int i = 0; i < 2; i++)
        y = lanes_mul_hi(y, 0x80000000u - lanes_mul_hi(d, y)) << 2;
    return y;
}

/* lamp_window times lamp_fall, of samples within the radius. */
LANES_INLINE lanes lamp_falls(const struct brume_lit_lamp *l,
                              const struct lamp_lanes *w)
{
    lanes most = lanes_of(0xffffffffu), size = lanes_of(l->size_shift);
    lanes down = w->zeros - l->radius_shift;
    lanes q = lanes_mul_hi(w->square, lanes_of(l->per_radius)) >> (down & 31u);
    lanes window = ~lanes_mul_hi(q << 1, q << 1);
    window = lanes_select(mask_less(down, lanes_of(32)),
                          lanes_mul_hi(window, window), most);
    lanes h = lanes_mul_hi(lanes_of(l->size), lamp_reciprocals(w->square));
    lanes_mask same =
        mask_and(mask_equal(w->zeros, size), mask_less(h, lanes_of(1u << 30)));
    lanes fall = lanes_select(mask_less(w->zeros, size),
                              h << 1 >> ((size - w->zeros - 1u) & 31u),
                              lanes_select(same, h << 2, most));
    fall = lanes_unless(mask_less(w->zeros + 32u, size), fall);
    return lanes_mul_hi(window, fall);
}

/// Direction ///

/* brume_rsqrt of x >= 1/4, whose shift is 0. */
LANES_INLINE lanes rsqrt_lanes(lanes x)
{
    lanes y = 2426656522u - lanes_mul_hi(x, lanes_of(1417339208u));
    for (int i = 0; i < 4; i++) {
        lanes xyy = lanes_mul_hi(x, lanes_mul_hi(y, y));
        y = lanes_mul_hi(y, (3u << 28) - xyy) << 3;
    }
    return lanes_select(mask_less(y, lanes_of(0x7fffffffu)), y << 1,
                        lanes_of(0xffffffffu));
}

/* lamp_unit */
LANES_INLINE lanes lamp_units(const struct lamp_lanes *w, lanes unit[3])
{
    lanes half = w->zeros >> 1, x = w->square >> (w->zeros & 1u);
    lanes r = rsqrt_lanes(x);
    for (int i = 0; i < 3; i++) {
        lanes u = lanes_mul_hi(magnitudes(w->d[i]) << half, r);
        unit[i] = with_signs((u >> 1) + (u & 1u), signs_of(w->d[i]));
    }
    return lanes_mul_hi(x, r) >> ((half - 2u) & 31u);
}

/* lamp_spot */
LANES_INLINE lanes lamp_spots(const struct brume_lit_lamp *l,
                              const lanes unit[3], lanes_mask here)
{
    lanes cosine = lanes_of(0), outer = lanes_of((uint32_t)l->cos_outer);
    for (int i = 0; i < 3; i++)
        cosine -= mul_both_round_lanes(unit[i],
                                       lanes_of((uint32_t)l->direction[i]), 2);
    lanes_mask beyond = less_signed(outer, cosine);
    lanes_mask between = less_signed(cosine, lanes_of((uint32_t)l->cos_inner));
    lanes x = lanes_mul_hi(cosine - outer, lanes_of(l->slope))
              << l->slope_shift;
    x = lanes_min(x, lanes_of(0x7fffffffu));
    x = lanes_mul_hi(lanes_mul_hi(x, x), (3u << 29) - (x >> 1)) << 5;
    x = lanes_select(between, x, lanes_of(0xffffffffu));
    return lanes_select(here, lanes_of(0xffffffffu), lanes_where(beyond, x));
}

/// Phase ///

/* brume_one_minus_cos */
LANES_INLINE lanes one_minus_cosines(const lanes a[3], const lanes b[3])
{
    lanes m[3], all = lanes_of(1), sum = lanes_of(0);
    for (int i = 0; i < 3; i++) {
        m[i] = lanes_select(less_signed(a[i], b[i]), b[i] - a[i], a[i] - b[i]);
        all |= m[i];
    }
    lanes up = lanes_leading_zeros(all), down = 2u * up - 3u;
    for (int i = 0; i < 3; i++) {
        lanes s = m[i] << up;
        sum += lanes_mul_hi(s, s) >> 2;
    }
    lanes u = lanes_where(mask_less(down, lanes_of(32)), sum >> (down & 31u));
    u = lanes_select(mask_less(up, lanes_of(2)), sum << (-down & 31u), u);
    return lanes_min(u, lanes_of(0x80000000u));
}

/* brume_phase_value: the mantissa is returned, *up is the exponent and 32 */
LANES_INLINE lanes phase_values(const struct brume_phase *phase, lanes u,
                                lanes *up)
{
    const uint32_t middle = BRUME_PHASE_CODES / 2, half = middle - 32u;
    lanes_mask back = mask_less(lanes_of(1u << 30), u);
    lanes w = lanes_select(back, 0x80000000u - u, u);
    lanes shift = lanes_leading_zeros(w | 1u), t = w << shift;
    lanes n = (22u - shift) * 16u + (t >> 27 & 15u);
    lanes between = t >> 15 & 4095u;
    lanes_mask last = mask_equal(shift, lanes_of(2));
    n = lanes_select(last, half + (t >> 26 & 31u), n);
    between = lanes_select(last, t >> 14 & 4095u, between);
    n = lanes_select(mask_equal(shift, lanes_of(1)), lanes_of(middle), n);
    lanes_mask few = mask_less(w, lanes_of(1024));
    n = lanes_select(few, w >> 6, n);
    between = lanes_select(few, (w & 63u) << 6, between);
    lanes next = lanes_min(n + 1u, lanes_of(middle));
    n = lanes_select(back, 2u * middle - n, n);
    next = lanes_select(back, 2u * middle - next, next);
    lanes y = (gather_halves(phase->code, n) * (4096u - between) +
               gather_halves(phase->code, next) * between) >>
              6;
    /* brume_exp2 */
    lanes tau = ((0x10000u - (y & 0xffffu)) * 45426u + 0x80000u) >> 20;
    lanes m = lanes_of_table16(brume_exp_coarse, tau >> 8) *
              lanes_of_table16(brume_exp_fine, tau & 255u);
    lanes zeros = lanes_leading_zeros(m);
    *up = (y >> 16) - 29u - 16u + 32u - zeros;
    return m << zeros;
}

/* lamp_times; `up` is signed. */
LANES_INLINE lanes lamp_times_lanes(lanes a, lanes up)
{
    lanes down = -up;
    lanes_mask above = less_signed(lanes_of(0), up);
    lanes_mask over = less_signed(lanes_leading_zeros(a), up);
    lanes less = lanes_where(mask_less(down, lanes_of(32)), a >> (down & 31u));
    lanes more = lanes_select(over, lanes_of(0xffffffffu), a << (up & 31u));
    more = lanes_unless(mask_equal(a, lanes_of(0)), more);
    return lanes_select(above, more, less);
}

/// Shadow ///

/* What the core's lamps read of a ray. */
LANES_INLINE void ray_of(struct brume_ray *ray, const struct patch *b,
                         uint32_t number)
{
    for (int i = 0; i < 3; i++)
        ray->unit[i] = as_signed(b->lit.unit[i][number]);
    ray->x = b->lit.x[number];
    ray->y = b->lit.y[number];
}

/* Falls of samples of distance r, times lamp_through. */
static lanes lamp_throughs(const struct brume_frame *f, const struct patch *b,
                           uint32_t at, const struct brume_lit_lamp *l,
                           const struct lamp_lanes *w, lanes r, lanes fall)
{
    uint32_t falls[WIDE_LANES] __attribute__((aligned(64)));
    uint32_t far[WIDE_LANES] __attribute__((aligned(64)));
    uint32_t d[3][WIDE_LANES] __attribute__((aligned(64))), moved[3] = {0};
    struct kernel k = KERNEL_OF(BRUME_U8R, 0, true, false, false);
    k.moved = moved;
    lanes_spill(falls, fall);
    lanes_spill(far, r);
    for (int i = 0; i < 3; i++)
        lanes_spill(d[i], w->d[i]);
    for (uint32_t n = 0; n < WIDE_LANES; n++) {
        struct lamp_way way;
        struct brume_ray ray;
        uint32_t p[3];
        if (falls[n] == 0)
            continue;
        ray_of(&ray, b, b->queue.ray[at + n]);
        queued_position(p, &b->queue, at + n);
        for (int i = 0; i < 3; i++) {
            way.d[i] = as_signed(d[i][n]);
            if (f->lit.stochastic)
                moved[i] = b->lit.moved[i][at + n];
        }
        falls[n] =
            mul_hi_floor(falls[n], lamp_through(f, l, &way, far[n],
                                                lamp_jitter(f, &ray), p, &k))
            << 2;
    }
    FORGET(falls);
    return lanes_load(falls);
}

/// Sums ///

/* add_any_lamp, for those of the samples that are `wanted`. */
static void meet_lamp(const struct brume_frame *f, const struct patch *b,
                      struct lamp_samples *s, const struct brume_lit_lamp *l,
                      lanes_mask wanted)
{
    const struct brume_phase *phase = f->lit.lighting->phase;
    struct lamp_lanes w;
    wanted = mask_and(wanted, lamp_ways(&w, l, s->halved));
    if (!mask_any(wanted))
        return;
    lanes fall = lanes_where(wanted, lamp_falls(l, &w)), up = lanes_of(0);
    if (l->spot || l->shadow_samples != 0 || phase != NULL) {
        lanes unit[3], r = lamp_units(&w, unit);
        lanes_mask here = mask_equal(unit[0] | unit[1] | unit[2], lanes_of(0));
        if (l->spot)
            fall = lanes_mul_hi(fall, lamp_spots(l, unit, here));
        if (l->shadow_samples != 0)
            fall = lamp_throughs(f, b, s->at, l, &w, r, fall);
        if (phase != NULL) {
            lanes m = phase_values(phase, one_minus_cosines(s->ray, unit), &up);
            up = lanes_unless(here, up);
            fall = lanes_select(here, fall, lanes_mul_hi(fall, m));
        }
    }
    for (int c = 0; c < (f->lit.colour ? 3 : 1); c++) {
        lanes light = lanes_mul_hi(fall, lanes_of(l->colour[c]));
        s->sum[c] = held_sum(
            s->sum[c], phase != NULL ? lamp_times_lanes(light, up) : light);
    }
}

/* Adds what n samples scatter to their rays. */
static void add_lamp_sums(const struct lamp_samples *s, struct patch *b,
                          uint32_t n, uint32_t c)
{
    uint32_t got[WIDE_LANES] __attribute__((aligned(64)));
    lanes lost = lanes_load(b->queue.lost + s->at);
    lanes high = lanes_mul_hi(lost, s->sum[c]), low = lost * s->sum[c];
    lanes_spill(got,
                lanes_select(mask_less(high, lanes_of(1u << 22)),
                             high << 10 | low >> 22, lanes_of(0xffffffffu)));
    for (uint32_t i = 0; i < n; i++) {
        uint32_t *sum = &b->lit.lamp[c][b->queue.ray[s->at + i]];
        *sum = lamp_sum(*sum, got[i]);
    }
}

/* The n samples from number `at` of the queue on, and their lamps' words;
 * *bits are those that any of them has. */
static void begin_lamps(struct lamp_samples *s, const struct brume_frame *f,
                        const struct patch *b, uint32_t at, uint32_t n,
                        uint32_t bits[BRUME_LAMP_WORDS])
{
    lanes number = lanes_where(mask_first(n), lanes_load(b->queue.ray + at));
    s->at = at;
    for (int i = 0; i < 3; i++) {
        s->halved[i] = (lanes_load(b->queue.p[i] + at) + 0x80000000u) >> 1;
        s->ray[i] = gather_words(b->lit.unit[i], number);
        s->sum[i] = lanes_of(0);
    }
    for (uint32_t w = 0; w < BRUME_LAMP_WORDS; w++) {
        bits[w] = 0;
        lanes_store(s->words[w], lanes_of(0));
    }
    for (uint32_t i = 0; i < n; i++) {
        struct brume_ray ray;
        uint32_t p[3];
        ray_of(&ray, b, b->queue.ray[at + i]);
        queued_position(p, &b->queue, at + i);
        const uint32_t *near = lamps_near(f, &ray, p);
        for (uint32_t w = 0; w < BRUME_LAMP_WORDS; w++) {
            s->words[w][i] = near[w];
            bits[w] |= near[w];
        }
    }
    FORGET(s->words);
}

/* add_lamps, for the queue's samples before number `end`. Sums that stay at
 * their most come to the same in any order. */
LANES_CALL void light_from_lamps(const struct brume_frame *f, struct patch *b,
                                 uint32_t end)
{
    const struct brume_lit_lamp *lamps = f->lit.clusters->lamp;
    for (uint32_t at = 0; at < end; at += WIDE_LANES) {
        uint32_t n = end - at < WIDE_LANES ? end - at : WIDE_LANES;
        uint32_t bits[BRUME_LAMP_WORDS];
        struct lamp_samples s;
        begin_lamps(&s, f, b, at, n, bits);
        for (uint32_t w = 0; w < BRUME_LAMP_WORDS; w++)
            while (bits[w] != 0) {
                uint32_t i = leading_zeros(bits[w]);
                lanes_mask has = mask_high(lanes_load(s.words[w]) << i);
                bits[w] -= 0x80000000u >> i;
                meet_lamp(f, b, &s, lamps + 32u * w + i, has);
            }
        for (uint32_t c = 0; c < (f->lit.colour ? 3u : 1u); c++)
            add_lamp_sums(&s, b, n, c);
    }
}

#endif
