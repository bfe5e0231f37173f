/* SPDX-License-Identifier: MIT */
/*
 * What few scenes have, in the wide march: the sun's map and lamps, for samples
 * of the queue. The core's own functions are called sample by sample. Part of
 * wide_march.c.
 */
#ifndef BRUME_HOST_WIDE_THINGS_H
#define BRUME_HOST_WIDE_THINGS_H

#include "brume_lamps.h"
#include "brume_sun_map.h"
#include "wide_patch.h"

LANES_INLINE void queued_position(uint32_t p[3], const struct queue *q,
                                  uint32_t at)
{
    for (int i = 0; i < 3; i++)
        p[i] = q->p[i][at];
}

/// Sun's map ///

/* Of what n samples from number `at` of the queue on scatter, what the sun's
 * map leaves of the sun. The sky sees all of it. */
LANES_CALL lanes in_sun(const struct brume_frame *f, const struct queue *q,
                        uint32_t at, uint32_t n, lanes lost)
{
    uint32_t shares[WIDE_LANES] __attribute__((aligned(64))) = {0};
    for (uint32_t i = 0; i < n; i++) {
        uint32_t p[3];
        queued_position(p, q, at + i);
        shares[i] = sun_map_light(f, p);
    }
    FORGET(shares);
    lanes share = lanes_load(shares);
    return lanes_select(mask_less(share, lanes_of(0x10000u)),
                        lanes_mul_hi(lost, share << 16), lost);
}

/// Lamps ///

/* What the core's lamps read of a ray. */
LANES_INLINE void ray_of(struct brume_ray *ray, const struct patch *b,
                         uint32_t number)
{
    for (int i = 0; i < 3; i++)
        ray->unit[i] = as_signed(b->lit.unit[i][number]);
    ray->x = b->lit.x[number];
    ray->y = b->lit.y[number];
}

/* add_lamps, for the queue's samples before number `end`. A ray's samples are
 * one after another in it, though others are between them; sums that stay at
 * their most do not ask for the order. */
LANES_CALL void light_from_lamps(const struct brume_frame *f, struct patch *b,
                                 uint32_t end)
{
    struct gathered g = {0};
    struct kernel k = KERNEL_OF(BRUME_U8R, 0, true, false, false);
    k.moved = g.moved;
    for (uint32_t at = 0; at < end; at++) {
        uint32_t number = b->queue.ray[at], p[3];
        struct brume_ray ray;
        ray_of(&ray, b, number);
        queued_position(p, &b->queue, at);
        for (int i = 0; i < 3; i++) {
            g.lamp[i] = b->lit.lamp[i][number];
            if (f->lit.stochastic)
                g.moved[i] = b->lit.moved[i][at];
        }
        add_lamps(f, &g, &ray, p, b->queue.lost[at], &k);
        for (int i = 0; i < 3; i++)
            b->lit.lamp[i][number] = g.lamp[i];
    }
}

#endif
