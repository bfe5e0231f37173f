/* SPDX-License-Identifier: MIT */
/*
 * Light from the sky in the wide march: core/brume_ambient.h in lanes. Part of
 * wide_march.c.
 */
#ifndef BRUME_HOST_WIDE_SKY_H
#define BRUME_HOST_WIDE_SKY_H

#include "wide_lamps.h"
#include "wide_lit.h"

/* baked_sky */
LANES_INLINE lanes baked_skies(const struct brume_frame *f,
                               const struct patch *b, uint32_t at)
{
    const struct brume_volume *v = f->volume;
    struct dense g = {
        v->sky, {v->cell_count[0], v->cell_count[1], v->cell_count[2]}, false};
    lanes p[3];
    for (int i = 0; i < 3; i++) {
        p[i] = lanes_load(b->queue.p[i] + at);
        if (f->lit.fog.on) /* hold_in_pool */
            p[i] = lanes_unless(mask_high(p[i]),
                                lanes_min(p[i], lanes_of(f->limit[i] - 1u)));
        p[i] = ((p[i] + brume_half_voxel(f)) >> 3) - 0x8000u;
    }
    return lanes_mul_hi(dense_lanes(b, &g, p, true) << 8,
                        lanes_of(1077952577u));
}

/* sky_direction */
LANES_INLINE void sky_directions(lanes out[3], const struct brume_frame *f,
                                 const struct patch *b, uint32_t at, uint32_t n)
{
    const struct brume_direction_table *t = f->lit.lighting->directions;
    lanes ray = lanes_where(mask_first(n), lanes_load(b->queue.ray + at));
    lanes nth = lanes_load(b->lit.nth + at);
    lanes x = gather_words(b->lit.x, ray), y = gather_words(b->lit.y, ray);
    uint32_t frame = brume_noise_frame(f) & ((1u << t->frames_log2) - 1u);
    x += (nth * 3242174889u) >> (32u - t->width_log2);
    y += (nth * 2447445414u) >> (32u - t->height_log2);
    x &= (1u << t->width_log2) - 1u;
    y &= (1u << t->height_log2) - 1u;
    lanes i = (((y | frame << t->height_log2) << t->width_log2) | x) * 3u;
    for (uint32_t axis = 0; axis < 3; axis++) {
        lanes a = gather_bytes((const uint8_t *)t->values, i + axis);
        out[axis] = with_signs((a ^ 0x80u) - 0x80u, 0u - (nth & 1u));
    }
}

/* sky_transmittance; the direction is `way` */
static lanes sky_transmittances(lanes way[3], const struct brume_frame *f,
                                struct patch *b, uint32_t at, uint32_t n)
{
    struct ways *w = &b->lit.ways;
    lanes local[3], p[3];
    sky_directions(local, f, b, at, n);
    for (int i = 0; i < 3; i++) {
        way[i] = lanes_of(0);
        for (int axis = 0; axis < 3; axis++) {
            lanes a = lanes_of((uint32_t)f->lit.sky_axis[axis][i]);
            lanes m = mul_round_lanes(a, magnitudes(local[axis]) << 18, 7);
            way[i] += with_signs(m, signs_of(local[axis]));
        }
    }
    begin_ways(w, n, f->lit.sky_samples);
    lanes_mask outside = mask_and(queued_outside(f, b, at), w->wanted);
    if (mask_any(outside)) {
        for (int i = 0; i < 3; i++)
            p[i] = lanes_load(b->queue.p[i] + at);
        keep_outside(w, outside,
                     mask_less_those(outside, lead_away(f, p, way)));
    }
    for (uint32_t k = 0; k < w->count; k++)
        put_doubled(w, way, k);
    return sun_transmittances(&f->lit.sky_tau, b->sum_ways(f, b, at));
}

/* height_of */
LANES_INLINE lanes heights_of(const struct brume_frame *f,
                              const struct queue *q, uint32_t at)
{
    lanes p[3];
    for (int i = 0; i < 3; i++)
        p[i] = lanes_load(q->p[i] + at);
    lanes above = along_zeniths(f, p) - (uint32_t)f->lit.low;
    above = lanes_unless(mask_high(above), above);
    uint32_t up = (uint32_t)(f->lit.per_height.e + 62) & 31u;
    lanes height = lanes_mul_hi(above << up, lanes_of(f->lit.per_height.m))
                   << 2;
    height = lanes_select(mask_less(above, lanes_of(f->lit.height)), height,
                          lanes_of(0xffffffffu));
    return lanes_where(mask_less(lanes_of(0), above), height);
}

/* add_cube */
static void add_cubes(struct patch *b, uint32_t at, uint32_t n, lanes seen,
                      lanes way[3])
{
    normalise_lanes(way);
    for (int i = 0; i < 3; i++) {
        lanes m = magnitudes(way[i]) << 1;
        lanes square = lanes_mul_hi(m, m);
        lanes share = lanes_select(mask_less(square, lanes_of(1u << 30)),
                                   square << 2, lanes_of(0xffffffffu));
        lanes_mask down = mask_high(way[i]);
        share = lanes_mul_hi(seen, share);
        add_to_rays(b->lit.sky[2 * i], &b->queue, at, n,
                    lanes_unless(down, share));
        add_to_rays(b->lit.sky[2 * i + 1], &b->queue, at, n,
                    lanes_where(down, share));
    }
}

/* add_sky, for the queue's samples before number `end` */
LANES_CALL void light_from_sky(const struct brume_frame *f, struct patch *b,
                               uint32_t end)
{
    const struct queue *q = &b->queue;
    bool baked = f->lit.visibility == BRUME_SKY_BAKED;
    if (f->lit.ambient == BRUME_AMBIENT_NONE)
        return;
    for (uint32_t at = 0; at < end; at += WIDE_LANES) {
        uint32_t n = end - at < WIDE_LANES ? end - at : WIDE_LANES;
        lanes way[3], through = lanes_of(1u << 30);
        if (samples_sky(f))
            through = sky_transmittances(way, f, b, at, n);
        else if (baked)
            through = baked_skies(f, b, at);
        lanes seen = lanes_mul_hi(lanes_load(q->lost + at), through);
        if (f->lit.ambient == BRUME_AMBIENT_GRADIENT) {
            lanes upper = lanes_mul_hi(seen, heights_of(f, q, at));
            add_to_rays(b->lit.sky[0], q, at, n, upper);
            add_to_rays(b->lit.sky[1], q, at, n, seen - upper);
        } else if (f->lit.ambient == BRUME_AMBIENT_CUBE && samples_sky(f)) {
            add_cubes(b, at, n, seen, way);
        } else {
            add_to_rays(b->lit.sky[0], q, at, n, seen);
        }
    }
}

#endif
