/* SPDX-License-Identifier: MIT */
/*
 * Rays through fog in the wide march: march_in_fog of core/brume_lit.c in
 * lanes. A ray has up to three parts, before the pool, in it and behind it, and
 * each begins where its first sample is. Those in the pool are counted in
 * b->left, so that they alone are looked up; the others in b->fog.left. Part of
 * wide_march.c.
 */
#ifndef BRUME_HOST_WIDE_FOG_VIEW_H
#define BRUME_HOST_WIDE_FOG_VIEW_H

#include "wide_glow.h"

/* Samples that are found by adding up moves, as in brume_lit.c. */
#define MOST_MOVES 4096u

/// Parts ///

/* The next parts of the rays from number `ray` on that are `ended`, from sample
 * number b->samples on. */
LANES_INLINE void begin_parts(const struct brume_frame *f, struct patch *b,
                              uint32_t ray, lanes_mask ended)
{
    lanes at = lanes_load(b->samples + ray), all = lanes_load(b->fog.all + ray);
    lanes before = lanes_load(b->fog.before + ray);
    lanes behind = lanes_load(b->fog.behind + ray);
    lanes_mask first = mask_less(at, before);
    lanes_mask inside = mask_less_those(mask_less(at, behind), first);
    lanes n =
        lanes_select(first, before, lanes_select(inside, behind, all)) - at;
    n = lanes_select(inside, n, lanes_min(n, lanes_of(MOST_MOVES)));
    n = lanes_where(mask_less(at, all), n);
    lanes t = lanes_load(b->t + ray) + at * f->step;
    for (int i = 0; i < 3; i++) {
        lanes p = places_along(f, i, lanes_load(b->lit.unit[i] + ray), t);
        p = lanes_select(inside, lanes_load(b->fog.enter[i] + ray), p);
        p = lanes_select(ended, p, lanes_load(b->p[i] + ray));
        lanes_store(b->p[i] + ray, p);
    }
    lanes_store(b->samples + ray, at + lanes_where(ended, n));
    lanes_store(b->left + ray, lanes_select(ended, lanes_where(inside, n),
                                            lanes_load(b->left + ray)));
    lanes_store(b->fog.left + ray, lanes_select(ended, lanes_unless(inside, n),
                                                lanes_load(b->fog.left + ray)));
}

LANES_CALL void add_fog_rays(const struct brume_frame *f, struct patch *b,
                             uint32_t ray, const struct rays *r)
{
    for (int i = 0; i < 3; i++)
        lanes_store(b->fog.enter[i] + ray, r->position[i]);
    lanes_store(b->fog.before + ray, r->before);
    lanes_store(b->fog.behind + ray, r->before + r->left);
    lanes_store(b->fog.all + ray, lanes_where(r->alive, r->samples));
    lanes_store(b->samples + ray, lanes_of(0));
    begin_parts(f, b, ray, mask_first(WIDE_LANES));
}

/// Samples ///

/* Samples of the rays from number `ray` on: which of them there are, and which
 * of these are in the pool. */
struct fog_samples {
    uint32_t ray;
    lanes p[3], index;
    lanes_mask on, inside;
};

/* Of samples with emission that take nothing, those at which a lookup of
 * density finds no voxel: to the core they are lit by fog alone. */
static lanes_mask find_nothing(const struct brume_frame *f,
                               const struct patch *b,
                               const struct fog_samples *s, lanes_mask of)
{
    uint32_t p[3][WIDE_LANES], moved[3][WIDE_LANES] = {{0}}, got, bits;
    lanes found = lanes_of(0), at[3] = {{0}};
    bits = mask_bits(mask_and(of, s->inside));
    if (bits == 0)
        return of;
    if (f->lit.stochastic)
        moves_of(at, b, s->ray, s->index);
    for (int i = 0; i < 3; i++) {
        lanes_spill(p[i], s->p[i]);
        lanes_spill(moved[i], at[i]);
    }
    for (uint32_t n = 0; n < WIDE_LANES; n++) {
        const uint32_t aside[3] = {moved[0][n], moved[1][n], moved[2][n]};
        if (bits >> n & 1u)
            found[n] =
                brume_lit_density(f, p[0][n], p[1][n], p[2][n], &got, aside);
    }
    return mask_and(of, mask_equal(found, lanes_of(0)));
}

/* Lit samples of opacity `lost` join the queue. */
LANES_INLINE void push_fog(const struct brume_frame *f, struct patch *b,
                           const struct fog_samples *s, lanes d, lanes lost,
                           const struct fog_lanes *fog, lanes_mask lit)
{
    bool jittered =
        f->jitter & BRUME_JITTER_LIGHT && f->light_kind != BRUME_UNIFORM;
    uint32_t at = b->queue.count;
    push(b, s->p, lost, s->ray, lit, jittered);
    push_lit(f, b, at, s->ray, d, s->index, lit);
    lanes_pack(b->fog.by_height + at, fog->by_height, lit);
    lanes_pack(b->fog.shapes + at, fog->all - fog->by_height, lit);
    lanes_pack(b->fog.above + at, fog->above, lit);
    lanes_pack(b->fog.outside + at,
               lanes_unless(s->inside, lanes_of(0xffffffffu)), lit);
}

/* What is at samples of density d, and what it takes of the rays; those that go
 * on are returned. */
LANES_INLINE lanes_mask meet_fog(const struct brume_frame *f, struct patch *b,
                                 const struct fog_samples *s, lanes d)
{
    lanes glowing = lanes_of(0);
    lanes transmittance = lanes_load(b->transmittance + s->ray);
    struct fog_lanes fog = fogs_at(f, s->p);
    lanes_mask dense = mask_less(lanes_of(f->min_density), d);
    lanes fade = lanes_where(dense, opacities(f, d, is_narrow_frame(f)));
    fade += lanes_mul_hi(fog_opacities(f, fog.all), ~fade);
    lanes_mask lit =
        mask_and(s->on, mask_or(dense, mask_less(lanes_of(0), fog.all)));
    if (f->lit.emits) {
        lanes_mask none = mask_and(lit, mask_equal(fade, lanes_of(0)));
        lit = mask_less_those(lit, none);
        if (mask_any(none))
            lit = mask_or(lit, find_nothing(f, b, s, none));
        lanes m = emissions_at(f, b, s->ray, s->index, s->p,
                               mask_and(s->on, s->inside));
        glowing = glows_of(f, b, s->ray, m, &fade);
    }
    lanes lost = lanes_where(lit, lanes_mul_hi(transmittance, fade));
    push_fog(f, b, s, d, lost, &fog, lit);
    lost += glowing;
    transmittance -= lost;
    lanes_store(b->transmittance + s->ray, transmittance);
    if (f->depth)
        lanes_store(b->moment + s->ray, lanes_load(b->moment + s->ray) +
                                            lanes_mul_hi(lost, s->index << 12));
    return mask_less_those(
        s->on, mask_less(transmittance, lanes_of(f->min_transmittance)));
}

/* The next samples of group g, whose rays are those from number `ray` on. False
 * when all have ended. */
LANES_CALL bool fog_group(const struct brume_frame *f, struct patch *b,
                          uint32_t g, uint32_t ray)
{
    lanes in = lanes_load(b->left + ray), out = lanes_load(b->fog.left + ray);
    lanes left = in + out, four = lanes_min(left, lanes_of(AHEAD_VIEW));
    struct fog_samples s = {.ray = ray,
                            .index = lanes_load(b->samples + ray) - left,
                            .on = mask_less(lanes_of(0), left),
                            .inside = mask_less(lanes_of(0), in)};
    lanes_mask alive = s.on;
    for (int i = 0; i < 3; i++)
        s.p[i] = lanes_load(b->p[i] + ray);
    for (uint32_t n = 0; n < AHEAD_VIEW; n++) {
        s.on = mask_and(alive, mask_less(lanes_of(n), left));
        if (!mask_any(s.on))
            break;
        lanes_mask dark = mask_less_those(
            s.on,
            meet_fog(f, b, &s, lanes_load(b->lookups.d[g * AHEAD_VIEW + n])));
        alive = mask_less_those(alive, dark);
        s.index += 1u;
        for (int i = 0; i < 3; i++)
            s.p[i] += lanes_load(b->move[i] + ray);
    }
    left = lanes_where(alive, left - four);
    for (int i = 0; i < 3; i++)
        lanes_store(b->p[i] + ray, s.p[i]);
    lanes_store(b->left + ray, lanes_where(s.inside, left));
    lanes_store(b->fog.left + ray, lanes_unless(s.inside, left));
    lanes_mask ended = mask_and(alive, mask_equal(left, lanes_of(0)));
    if (mask_any(ended))
        begin_parts(f, b, ray, ended);
    return mask_any(mask_less(lanes_of(0), lanes_load(b->left + ray) |
                                               lanes_load(b->fog.left + ray)));
}

#endif
