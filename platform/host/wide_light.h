/* SPDX-License-Identifier: MIT */
/*
 * The light half of the wide march: density towards the sun, by the lookups of
 * a kernel. Part of wide_march.c.
 */
#ifndef BRUME_HOST_WIDE_LIGHT_H
#define BRUME_HOST_WIDE_LIGHT_H

#include "wide_sky.h"

/// Light ///

/* Sum of d * 2^i over the samples in the pool. */
LANES_INLINE lanes sum_log_lanes(const struct brume_frame *f,
                                 const struct source *s, struct lookups *l,
                                 const struct light_lanes *light,
                                 const lanes p[3], lanes_mask wanted,
                                 struct kernel k)
{
    lanes sum = lanes_of(0), way[3], at[3];
    uint32_t n;
    for (int i = 0; i < 3; i++)
        way[i] = light->first[i];
    for (n = 0; n < light->samples; n++) {
        for (int i = 0; i < 3; i++) {
            at[i] = p[i] + way[i];
            way[i] += way[i];
        }
        wanted = mask_and(wanted, inside_lanes(f, at[0], at[1], at[2]));
        if (light->unequal)
            wanted = mask_and(wanted, mask_less(lanes_of(n), light->own));
        if (!mask_any(wanted))
            break;
        want(l, n, s, at, wanted, k);
    }
    look_up(l, n, s, k);
    for (uint32_t i = 0; i < n; i++)
        sum += lanes_load(l->d[i]) << i;
    return sum;
}

/* The sums of samples from number `at` of the queue on over b->lit.ways. */
LANES_INLINE lanes sum_of_ways(const struct brume_frame *f,
                               const struct source *s, struct patch *b,
                               uint32_t at, struct kernel k)
{
    struct ways *w = &b->lit.ways;
    lanes sum = lanes_of(0), moved[3], p[3];
    lanes_mask wanted = w->wanted;
    uint32_t n;
    for (int i = 0; i < 3; i++)
        moved[i] =
            s->stochastic ? lanes_load(b->lit.moved[i] + at) : lanes_of(0);
    for (n = 0; n < w->count; n++) {
        for (int i = 0; i < 3; i++)
            p[i] = lanes_load(b->queue.p[i] + at) + lanes_load(w->way[n][i]);
        lanes_mask inside = inside_lanes(f, p[0], p[1], p[2]);
        wanted = mask_and(wanted, mask_or(inside, w->outside));
        wanted = mask_and(wanted, mask_less(lanes_of(n), w->own));
        if (!mask_any(wanted))
            break;
        want_moved(&b->lookups, n, s, p, moved, mask_and(wanted, inside), k);
    }
    look_up(&b->lookups, n, s, k);
    for (uint32_t i = 0; i < n; i++)
        sum += lanes_load(b->lookups.d[i]) * w->weight[i];
    w->wanted = wanted;
    return sum;
}

/* Adds the light of samples whose sums are known, from number `at` of the
 * queue on, to their rays. */
LANES_INLINE void add_light(const struct brume_frame *f, struct patch *b,
                            uint32_t at, uint32_t n, lanes sum)
{
    lanes lost = lanes_load(b->queue.lost + at);
    add_to_rays(b->sun[0], &b->queue, at, n,
                lanes_mul_hi(lost, sun_transmittances(&f->tau, sum)));
}

LANES_INLINE void light_log(const struct brume_frame *f, const struct source *s,
                            struct patch *b, uint32_t at, uint32_t n,
                            struct kernel k)
{
    struct light_lanes light;
    lanes p[3];
    begin_light(&light, f, &b->queue, at);
    for (int i = 0; i < 3; i++)
        p[i] = lanes_load(b->queue.p[i] + at);
    add_light(f, b, at, n,
              sum_log_lanes(f, s, &b->lookups, &light, p, mask_first(n), k));
}

/* Samples on their way to the sun at equal distances, by groups of the queue.
 * Of each, a step looks up several samples; only from the last is leapt. */
#define AHEAD 4u
#define AHEAD_VIEW 4u

struct light_wave {
    uint32_t p[3][LOOKUPS][WIDE_LANES], left[LOOKUPS][WIDE_LANES];
    uint32_t sum[LOOKUPS][WIDE_LANES];
    uint32_t first[LOOKUPS]; /* of the queue's */
    uint32_t count;
    lanes move[3], inverse[3];
} __attribute__((aligned(64)));

LANES_INLINE void begin_light_wave(const struct brume_frame *f,
                                   struct light_wave *w)
{
    w->count = 0;
    for (int i = 0; i < 3; i++) {
        w->move[i] = lanes_of((uint32_t)f->light_line.move[i]);
        w->inverse[i] = inverse_of(w->move[i], f->skip);
    }
}

LANES_INLINE void fill_light_wave(const struct brume_frame *f,
                                  struct light_wave *w, const struct patch *b,
                                  uint32_t *next, uint32_t end)
{
    const struct queue *q = &b->queue;
    for (; *next < end && w->count < LOOKUPS / AHEAD; *next += WIDE_LANES) {
        uint32_t g = w->count++, at = *next;
        lanes_mask valid = mask_less(lanes_count(), lanes_of(end - at));
        lanes before = lanes_of(0);
        if (f->lit.fog.on)
            valid = uniform_ways(f, b, at, valid, &before);
        w->first[g] = at;
        for (int i = 0; i < 3; i++)
            lanes_store(w->p[i][g], lanes_load(q->p[i] + at) +
                                        (uint32_t)f->light.first[i] +
                                        before * w->move[i]);
        lanes_store(w->left[g], lanes_where(valid, f->light.samples - before));
        lanes_store(w->sum[g], lanes_of(0));
    }
}

/* Wants the next samples of group g, and leaves it at the last of them. */
LANES_INLINE void want_light_group(const struct brume_frame *f,
                                   const struct source *s, struct light_wave *w,
                                   struct lookups *l, uint32_t g,
                                   struct kernel k)
{
    lanes left = lanes_load(w->left[g]), p[3];
    for (int i = 0; i < 3; i++)
        p[i] = lanes_load(w->p[i][g]);
    for (uint32_t n = 0;; n++) {
        lanes_mask on = mask_and(mask_less(lanes_of(n), left),
                                 inside_lanes(f, p[0], p[1], p[2]));
        want(l, g * AHEAD + n, s, p, on, k);
        if (n == AHEAD - 1) {
            for (int i = 0; i < 3; i++)
                lanes_store(w->p[i][g], p[i]);
            lanes_store(w->left[g], lanes_where(on, left - (AHEAD - 1)));
            return;
        }
        for (int i = 0; i < 3; i++)
            p[i] += w->move[i];
    }
}

/* Sums the samples of group g, moves on, to number `to` of the wave. False when
 * it has ended: then its sums are in place. */
LANES_INLINE bool step_light_group(const struct source *s, struct light_wave *w,
                                   struct lookups *l, uint32_t g, uint32_t to,
                                   uint32_t *sums, struct kernel k)
{
    lanes left = lanes_load(w->left[g]), m = lanes_of(1), p[3];
    lanes sum = lanes_load(w->sum[g]);
    lanes_mask on = mask_less(lanes_of(0), left);
    for (uint32_t n = 0; n < AHEAD; n++)
        sum += lanes_load(l->d[g * AHEAD + n]);
    if (!mask_any(on)) {
        lanes_store(sums + w->first[g], sum);
        return false;
    }
    for (int i = 0; i < 3; i++)
        p[i] = lanes_load(w->p[i][g]);
    lanes cell = cells_to_leap(l, g * AHEAD + AHEAD - 1, s, p, on, k);
    lanes_mask empty = mask_and(on, mask_high(cell));
    if (mask_any(empty))
        m = lanes_select(empty, leap_lanes(s, p, w->move, w->inverse, cell, k),
                         m);
    w->first[to] = w->first[g];
    for (int i = 0; i < 3; i++)
        lanes_store(w->p[i][to], p[i] + m * w->move[i]);
    lanes_store(w->left[to],
                lanes_where(mask_and(on, mask_less(m, left)), left - m));
    lanes_store(w->sum[to], sum);
    return true;
}

LANES_INLINE void light_uniform(const struct brume_frame *f,
                                const struct source *s, struct patch *b,
                                uint32_t end, struct kernel k)
{
    struct light_wave w;
    uint32_t own ROOM(QUEUE), *sums = b->sums != NULL ? b->sums : own;
    uint32_t next = 0;
    begin_light_wave(f, &w);
    for (;;) {
        fill_light_wave(f, &w, b, &next, end);
        if (w.count == 0)
            break;
        for (uint32_t g = 0; g < w.count; g++)
            want_light_group(f, s, &w, &b->lookups, g, k);
        look_up(&b->lookups, w.count * AHEAD, s, k);
        uint32_t to = 0;
        for (uint32_t g = 0; g < w.count; g++)
            to += step_light_group(s, &w, &b->lookups, g, to, sums, k);
        w.count = to;
    }
    for (uint32_t at = 0; b->sums == NULL && at < end; at += WIDE_LANES) {
        uint32_t n = end - at < WIDE_LANES ? end - at : WIDE_LANES;
        if (f->lit.on)
            add_octaves(f, b, at, n, lanes_load(sums + at));
        else
            add_light(f, b, at, n, lanes_load(sums + at));
    }
}

/* Lights what waits, but for less than a vector; or all. */
LANES_INLINE void light_queue(const struct brume_frame *f,
                              const struct wide_copy *c, struct patch *b,
                              bool all, struct kernel k)
{
    struct queue *q = &b->queue;
    uint32_t end = all ? q->count : q->count / WIDE_LANES * WIDE_LANES;
    uint32_t rest = q->count - end;
    struct source s = source_of(f, c, false, k);
    if (is_queue_lit(f))
        light_lit(f, b, end);
    else if (k.uniform)
        light_uniform(f, &s, b, end, k);
    else
        for (uint32_t at = 0; at < end; at += WIDE_LANES)
            light_log(f, &s, b, at,
                      end - at < WIDE_LANES ? end - at : WIDE_LANES, k);
    if (f->lit.on)
        light_from_sky(f, b, end);
    if (f->lit.on && f->lit.clusters != NULL)
        light_from_lamps(f, b, end);
    if (rest != 0) {
        for (int i = 0; i < 3; i++)
            lanes_store(q->p[i], lanes_load(q->p[i] + end));
        lanes_store(q->lost, lanes_load(q->lost + end));
        lanes_store(q->ray, lanes_load(q->ray + end));
        for (int i = 0; i < 3; i++)
            lanes_store(q->light_first[i], lanes_load(q->light_first[i] + end));
        if (f->lit.on)
            keep_lit(b, end);
    }
    q->count = rest;
}

#endif
