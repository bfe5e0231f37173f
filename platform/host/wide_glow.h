/* SPDX-License-Identifier: MIT */
/*
 * What samples of the view take of their rays, and give to the queue; and what
 * they glow: core/brume_emission.h in lanes. Part of wide_march.c.
 */
#ifndef BRUME_HOST_WIDE_GLOW_H
#define BRUME_HOST_WIDE_GLOW_H

#include "wide_light.h"

/// Loss ///

LANES_INLINE lanes opacities(const struct brume_frame *f, lanes d, bool narrow)
{
    if (narrow)
        return lanes_of_table32(f->table, d);
    return ~lanes_mul_hi(lanes_of_table32(f->table, d >> 8),
                         lanes_of_table32(f->table + 256, d & 255u));
}

LANES_INLINE void push(struct patch *b, const lanes p[3], lanes lost,
                       uint32_t ray, lanes_mask lit, bool jittered)
{
    struct queue *q = &b->queue;
    uint32_t at = q->count;
    for (int i = 0; i < 3; i++)
        lanes_pack(q->p[i] + at, p[i], lit);
    lanes_pack(q->lost + at, lost, lit);
    lanes_pack(q->ray + at, lanes_count() + ray, lit);
    if (jittered)
        for (int i = 0; i < 3; i++)
            lanes_pack(q->light_first[i] + at,
                       lanes_load(b->light_first[i] + ray), lit);
    q->count = at + (uint32_t)__builtin_popcount(mask_bits(lit));
}

/* What density d does at sample n of group g since its place; `on` are the
 * rays that go on, and those that do are returned. */
LANES_INLINE lanes_mask lose_light(const struct brume_frame *f, struct patch *b,
                                   uint32_t ray, const lanes p[3], lanes left,
                                   lanes d, lanes_mask on, bool lit_rays,
                                   struct kernel k)
{
    bool jittered =
        f->jitter & BRUME_JITTER_LIGHT && f->light_kind != BRUME_UNIFORM;
    uint32_t at = b->queue.count;
    lanes_mask lit = mask_and(on, mask_less(lanes_of(f->min_density), d));
    if (!mask_any(lit))
        return on;
    lanes transmittance = lanes_load(b->transmittance + ray);
    lanes lost = lanes_where(
        lit, lanes_mul_hi(transmittance, opacities(f, d, is_narrow(k))));
    push(b, p, lost, ray, lit, jittered);
    if (lit_rays)
        push_lit(f, b, at, ray, d, lanes_load(b->samples + ray) - left, lit);
    transmittance -= lost;
    lanes_store(b->transmittance + ray, transmittance);
    if (f->depth) {
        lanes index = lanes_load(b->samples + ray) - left;
        lanes_store(b->moment + ray, lanes_load(b->moment + ray) +
                                         lanes_mul_hi(lost, index << 12));
    }
    lanes_mask dark = mask_less(transmittance, lanes_of(f->min_transmittance));
    return mask_less_those(on, mask_and(lit, dark));
}

/// Emission ///

/* emission_code; 0 where not wanted. */
LANES_INLINE lanes emission_codes(const struct brume_volume *v, lanes x,
                                  lanes y, lanes z, lanes_mask wanted)
{
    lanes at = lanes_where(wanted, cell_number(v, x, y, z));
    lanes cell = gather_words(v->cells, at);
    wanted = mask_less_those(wanted, mask_high(cell));
    if (!mask_any(wanted))
        return lanes_of(0);
    lanes i = (x >> 16 & 7u) | (y >> 13 & 56u) | (z >> 10 & 448u);
    lanes code =
        gather_bytes(v->emission, lanes_where(wanted, (cell << 9) + i));
    return lanes_where(wanted, code);
}

/* emission_between, wherever the voxels lie */
static lanes emission_anywhere(const struct brume_volume *v, const lanes p[3],
                               lanes_mask wanted)
{
    lanes wx = p[0] >> 8 & 255u, wy = p[1] >> 8 & 255u, wz = p[2] >> 8 & 255u;
    lanes x = p[0], y = p[1], z = p[2], plane[2];
    lanes x1 = x + 0x10000u, y1 = y + 0x10000u;
    for (uint32_t n = 0; n < 2; n++, z += 0x10000u) {
        lanes low = mix_lanes(emission_codes(v, x, y, z, wanted),
                              emission_codes(v, x1, y, z, wanted), wx);
        lanes high = mix_lanes(emission_codes(v, x, y1, z, wanted),
                               emission_codes(v, x1, y1, z, wanted), wx);
        plane[n] = mix_lanes(low, high, wy);
    }
    return (mix_lanes(plane[0], plane[1], wz) + 0x8000u) >> 16;
}

/* emission_between, where a lookup of density may find something: in bricks,
 * and beside them unless they have an apron, as lookups in these end with the
 * cell. Elsewhere the core does not ask. */
static lanes emission_mixes(const struct brume_frame *f, const lanes p[3],
                            lanes_mask wanted)
{
    const struct brume_volume *v = f->volume;
    uint32_t at_voxel[WIDE_LANES] __attribute__((aligned(64)));
    lanes at = lanes_where(wanted, cell_number(v, p[0], p[1], p[2]));
    lanes cell = gather_words(v->cells, at), m = lanes_of(0);
    lanes_mask face = on_high_faces(p[0], p[1], p[2]);
    lanes_mask brick =
        mask_and(wanted, mask_less(cell, lanes_of(BRUME_CELL_EMPTY)));
    lanes_mask near =
        mask_and(wanted, mask_less(cell, lanes_of(BRUME_CELL_EMPTY + 2u)));
    face = mask_and(face, f->leap_margin != 0 ? near : brick);
    brick = mask_less_those(brick, face);
    if (mask_any(brick)) {
        lanes i = (p[0] >> 16 & 7u) | (p[1] >> 13 & 56u) | (p[2] >> 10 & 448u);
        lanes_spill(at_voxel, lanes_where(brick, (cell << 9) + i));
        m = mean_of_cubes(v->emission, 8, at_voxel,
                          weights_of(p[0], p[1], p[2]));
        m = lanes_where(brick, m);
    }
    if (mask_any(face))
        m = lanes_select(face, emission_anywhere(v, p, face), m);
    return m;
}

/* The same from a copy, which has all that is beside a cell. */
LANES_INLINE lanes emission_copied(const struct brume_frame *f,
                                   const struct wide_copy *c, const lanes p[3],
                                   lanes_mask wanted)
{
    uint32_t i[WIDE_LANES] __attribute__((aligned(64)));
    lanes at = lanes_where(wanted, cell_number(f->volume, p[0], p[1], p[2]));
    if (f->leap_margin == 0) {
        lanes cell = gather_words(f->volume->cells, at);
        wanted = mask_less_those(wanted, mask_high(cell));
    }
    at = number_in_aprons(at, p[0], p[1], p[2]);
    lanes_spill(i,
                lanes_select(wanted, at, lanes_of((uint32_t)c->aprons_size)));
    return mean_of_cubes(c->emission, 9, i, weights_of(p[0], p[1], p[2]));
}

/* emission_at, of the samples that are number n of the rays from `ray` on. In
 * an empty cell the core does not ask unless a lookup of density, too, may find
 * what is beyond its faces: elsewhere one voxel, wherever moved to, is 0. */
LANES_INLINE lanes emissions_at(const struct brume_frame *f,
                                const struct patch *b, uint32_t ray, lanes n,
                                const lanes p[3], lanes_mask wanted)
{
    lanes moved[3] = {{0}};
    if (f->kernel & 4u)
        return b->copy != NULL && b->copy->emission != NULL
                   ? emission_copied(f, b->copy, p, wanted)
                   : emission_mixes(f, p, wanted);
    if (f->lit.stochastic)
        moves_of(moved, b, ray, n);
    return emission_codes(f->volume, p[0] + moved[0], p[1] + moved[1],
                          p[2] + moved[2], wanted)
           << 8;
}

/* add_glow, to the rays from number `ray` on */
LANES_INLINE void add_glows(const struct brume_frame *f, struct patch *b,
                            uint32_t ray, lanes m, lanes glowing)
{
    const uint32_t *colour = f->lit.lighting->emission_colour[0];
    lanes w = m & 255u, code = (m >> 8) * 3u;
    lanes next = lanes_select(mask_less(lanes_of(0), w), code + 3u, code);
    for (uint32_t c = 0; c < (f->lit.colour ? 3u : 1u); c++) {
        lanes light = mix_lanes(gather_words(colour, code + c),
                                gather_words(colour, next + c), w);
        uint32_t *sums = b->lit.glow[c] + ray;
        lanes_store(sums, lanes_load(sums) + lanes_mul_hi(glowing, light << 3));
    }
}

/* glow_of; `fade` is that of the samples that scatter, 0 of others */
LANES_INLINE lanes glows_of(const struct brume_frame *f, struct patch *b,
                            uint32_t ray, lanes m, lanes *fade)
{
    lanes_mask any = mask_less(lanes_of(0), m);
    if (!mask_any(any))
        return lanes_of(0);
    lanes glow =
        ~lanes_mul_hi(lanes_of_table32(f->lit.emission, m >> 8),
                      lanes_of_table32(f->lit.emission + 256, m & 255u));
    lanes both = lanes_mul_hi(*fade, glow);
    both = lanes_where(mask_less(lanes_of(0), both), (both >> 1) + 1u);
    both = lanes_where(any, both);
    *fade -= both;
    lanes glowing = lanes_where(
        any, lanes_mul_hi(lanes_load(b->transmittance + ray), glow - both));
    add_glows(f, b, ray, m, glowing);
    return glowing;
}

/* lose_light of frames that emit: any sample may glow, and of the others those
 * are lit that have an opacity. `index` is the samples' number. */
LANES_INLINE lanes_mask lose_glowing(const struct brume_frame *f,
                                     struct patch *b, uint32_t ray,
                                     const lanes p[3], lanes index, lanes d,
                                     lanes_mask on)
{
    bool jittered =
        f->jitter & BRUME_JITTER_LIGHT && f->light_kind != BRUME_UNIFORM;
    uint32_t at = b->queue.count;
    lanes transmittance = lanes_load(b->transmittance + ray);
    lanes m = emissions_at(f, b, ray, index, p, on);
    lanes_mask dense = mask_and(on, mask_less(lanes_of(f->min_density), d));
    lanes fade = lanes_where(dense, opacities(f, d, is_narrow_frame(f)));
    lanes_mask lit = mask_less(lanes_of(0), fade);
    lanes glowing = glows_of(f, b, ray, m, &fade);
    lanes lost = lanes_mul_hi(transmittance, fade);
    push(b, p, lost, ray, lit, jittered);
    push_lit(f, b, at, ray, d, index, lit);
    lost += glowing;
    transmittance -= lost;
    lanes_store(b->transmittance + ray, transmittance);
    if (f->depth)
        lanes_store(b->moment + ray, lanes_load(b->moment + ray) +
                                         lanes_mul_hi(lost, index << 12));
    return mask_less_those(
        on, mask_less(transmittance, lanes_of(f->min_transmittance)));
}

/* The samples of group g of a frame that emits; which rays go on. */
LANES_CALL lanes_mask glow_group(const struct brume_frame *f, struct patch *b,
                                 uint32_t g, uint32_t ray)
{
    lanes left = lanes_load(b->left + ray), p[3];
    lanes first = lanes_load(b->samples + ray) - left;
    lanes_mask on = mask_less(lanes_of(0), left);
    for (int i = 0; i < 3; i++)
        p[i] = lanes_load(b->p[i] + ray);
    for (uint32_t n = 0; n < AHEAD_VIEW; n++) {
        lanes d = lanes_load(b->lookups.d[g * AHEAD_VIEW + n]);
        on = mask_and(on, mask_less(lanes_of(n), left));
        if (!mask_any(on))
            break;
        on = lose_glowing(f, b, ray, p, first + n, d, on);
        for (int i = 0; i < 3; i++)
            p[i] += lanes_load(b->move[i] + ray);
    }
    return on;
}

#endif
