/* SPDX-License-Identifier: MIT */
/*
 * What the halves of the wide march share: the state of a patch of rays,
 * leaping, rays towards the sun. Part of wide_march.c.
 */
#ifndef BRUME_HOST_WIDE_PATCH_H
#define BRUME_HOST_WIDE_PATCH_H

#include "wide_lookup.h"
#include "wide_rays.h"

/* Called by every kernel: one of each is enough. */
#define LANES_CALL static __attribute__((noinline))

#define TILE_WIDTH 4u
#define TILE_HEIGHT (WIDE_LANES / TILE_WIDTH)
#define PATCH_WIDTH 16u
#define PATCH_HEIGHT 16u
#define PATCH (PATCH_WIDTH * PATCH_HEIGHT)
#define WAVE (LOOKUPS * WIDE_LANES)
#define QUEUE (2u * WAVE)

/* Arrays that are written at any place have room for a vector more. */
#define ROOM(n) [(n) + WIDE_LANES]

/* Lit samples, which wait for light. */
struct queue {
    uint32_t p[3] ROOM(QUEUE);
    uint32_t lost ROOM(QUEUE), ray ROOM(QUEUE);
    uint32_t light_first[3] ROOM(QUEUE); /* if jittered */
    uint32_t count;
} __attribute__((aligned(64)));

/* Ways from a vector of samples, nearest first: the density at the end of each,
 * times 2^shift, is summed as long as a sample's ways end in the pool. */
struct ways {
    uint32_t way[LOOKUPS][3][WIDE_LANES];
    uint32_t weight[LOOKUPS], count;
    lanes own;         /* how many are taken of each sample's */
    lanes_mask wanted; /* samples; afterwards those with all ways in the pool */
    lanes_mask outside; /* of the pool: those whose ways may come into it */
} __attribute__((aligned(64)));

/* Of rays with lighting; and of the queue's samples. */
struct lit_rays {
    uint32_t d ROOM(QUEUE);                /* density */
    uint32_t nth ROOM(QUEUE);              /* number of the ray's lit sample */
    uint32_t moved[3] ROOM(QUEUE);         /* of stochastic lookups */
    uint32_t unit[3] ROOM(PATCH);          /* direction, Q2.30 */
    uint32_t x ROOM(PATCH), y ROOM(PATCH); /* of the grid */
    uint32_t noise[3] ROOM(PATCH);         /* of stochastic lookups */
    uint32_t count ROOM(PATCH);            /* lit samples */
    uint32_t sky[6] ROOM(PATCH);           /* B_j of docs/light.md, Q3.29 */
    uint32_t lamp[3] ROOM(PATCH);          /* C_c, Q3.29 */
    uint32_t glow[3] ROOM(PATCH);          /* E_c, Q6.26 */
    uint32_t depth_of_code[256];           /* of the cache */
    struct ways ways;
} __attribute__((aligned(64)));

/* Of rays through fog; and of the queue's samples. */
struct fog_rays {
    uint32_t by_height ROOM(QUEUE); /* struct fog_lanes */
    uint32_t shapes ROOM(QUEUE), above ROOM(QUEUE);
    uint32_t outside ROOM(QUEUE); /* of the pool? All ones, or 0 */
    uint32_t left ROOM(PATCH);    /* samples of a part outside of the pool */
    /* Numbers of samples: the first in the pool, the first behind it, all. */
    uint32_t before ROOM(PATCH), behind ROOM(PATCH), all ROOM(PATCH);
    uint32_t enter[3] ROOM(PATCH); /* where the first in the pool is */
} __attribute__((aligned(64)));

/* The rays of a rectangle, group by group, and the groups under way. */
struct patch {
    const struct wide_copy *copy;
    void (*light)(const struct brume_frame *f, struct patch *b, bool all);
    lanes (*sum_ways)(const struct brume_frame *f, struct patch *b,
                      uint32_t at);
    uint32_t *sums; /* where uniform light puts them, or NULL: to the rays */
    uint32_t count; /* groups of the wave: numbers of their first rays */
    uint32_t first[LOOKUPS];
    struct lookups lookups;
    struct queue queue;
    uint32_t p[3] ROOM(PATCH), move[3] ROOM(PATCH);
    uint32_t inverse[3] ROOM(PATCH); /* floats: (1 - 2^-20) / |move| */
    uint32_t left ROOM(PATCH);       /* samples in the pool; 0 when ended */
    uint32_t samples ROOM(PATCH);    /* that there were; of the ray. In fog
                                      * before the part's end */
    uint32_t t ROOM(PATCH);          /* of the first */
    uint32_t transmittance ROOM(PATCH), moment ROOM(PATCH);
    uint32_t light_first[3] ROOM(PATCH);         /* if jittered */
    uint32_t sun[BRUME_MAX_OCTAVES] ROOM(PATCH); /* A_i, Q3.29; without
                                                  * lighting the first */
    struct lit_rays lit;
    struct fog_rays fog;
} __attribute__((aligned(64)));

/// Leaping ///

LANES_INLINE lanes_float way_of(lanes p, lanes move, lanes far, uint32_t margin,
                                lanes inverse)
{
    lanes forwards = ~signs_of(move);
    lanes room = far + ((p ^ forwards) & 0x7ffffu) - (forwards & margin);
    return lanes_to_float(room) * (lanes_float)inverse;
}

/* (1 - 2^-20) / |move|, as a float. */
LANES_INLINE lanes inverse_of(lanes move, bool skip)
{
    lanes_float m = lanes_to_float(lanes_max(magnitudes(move), lanes_of(1)));
    return (lanes)((skip ? 0x0.fffffp0f : 0.0f) / m);
}

/* As leap of the core, but now and then one less: the inverse is too small by
 * more than floats are rounded, which costs a lookup and no pixel. */
LANES_INLINE lanes leap_by(uint32_t margin, const lanes p[3],
                           const lanes move[3], const lanes inverse[3],
                           lanes cell)
{
    lanes far = (cell << 19) - (1u << 19);
    lanes_float n = way_of(p[0], move[0], far, margin, inverse[0]);
    n = lanes_min_float(n, way_of(p[1], move[1], far, margin, inverse[1]));
    n = lanes_min_float(n, way_of(p[2], move[2], far, margin, inverse[2]));
    return lanes_from_float(n) + 1u;
}

LANES_INLINE lanes leap_lanes(const struct source *s, const lanes p[3],
                              const lanes move[3], const lanes inverse[3],
                              lanes cell, struct kernel k)
{
    if (k.trilinear || s->stochastic)
        return leap_by(s->frame->leap_margin, p, move, inverse, cell);
    return leap_by(0, p, move, inverse, cell);
}

/// Light ///

/* Light rays of doubling steps. */
struct light_lanes {
    lanes first[3];
    uint32_t samples; /* of all */
    bool unequal;     /* each has a number of its own: */
    lanes own;
};

/* Those of the n samples from number `at` of the queue on. A sample whose
 * distance does not fit the word is not taken; only in pools beyond 16384
 * voxels, or seen from outside, is it not out of the pool anyway, and the one
 * before it inside. */
LANES_INLINE void begin_light(struct light_lanes *light,
                              const struct brume_frame *f,
                              const struct queue *q, uint32_t at)
{
    bool jittered = f->jitter & BRUME_JITTER_LIGHT;
    uint32_t far = f->limit[0] | f->limit[1] | f->limit[2];
    light->samples = jittered ? f->light_samples : f->light.samples;
    light->unequal = jittered && (far > 1u << 30 || f->lit.fog.on);
    for (int i = 0; i < 3; i++)
        light->first[i] = jittered ? lanes_load(q->light_first[i] + at)
                                   : lanes_of((uint32_t)f->light.first[i]);
    light->own = light->unequal ? light_samples_of(light->first, f)
                                : lanes_of(light->samples);
}

LANES_INLINE void queued_position(uint32_t p[3], const struct queue *q,
                                  uint32_t at)
{
    for (int i = 0; i < 3; i++)
        p[i] = q->p[i][at];
}

LANES_INLINE lanes sun_transmittances(const struct brume_tau *t, lanes sum)
{
    lanes_mask black = mask_less(lanes_of(t->limit), sum);
    lanes tau = lanes_mul_hi(sum << t->shift, lanes_of(t->m)) + 1u;
    tau = lanes_unless(black, tau >> 1);
    lanes s = lanes_of_table16(brume_exp_coarse, tau >> 8) *
              lanes_of_table16(brume_exp_fine, tau & 255u);
    return lanes_unless(black, s);
}

/* Adds to the sums of the rays whose n samples are in the queue from number
 * `at` on. */
LANES_INLINE void add_to_rays(uint32_t *sums, const struct queue *q,
                              uint32_t at, uint32_t n, lanes light)
{
    uint32_t got[WIDE_LANES] __attribute__((aligned(64)));
    lanes_spill(got, light);
    for (uint32_t i = 0; i < n; i++)
        sums[q->ray[at + i]] += got[i];
}

#endif
