/* SPDX-License-Identifier: MIT */
/*
 * What few scenes have, in the wide march: the sun's map, for samples of the
 * queue. The core's own functions are called sample by sample. Part of
 * wide_march.c.
 */
#ifndef BRUME_HOST_WIDE_THINGS_H
#define BRUME_HOST_WIDE_THINGS_H

#include "brume_sun_map.h"
#include "wide_lamps.h"

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

#endif
