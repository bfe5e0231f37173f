/* SPDX-License-Identifier: MIT */
/*
 * What lighting adds to the wide march: octaves, the cache, cones;
 * core/brume_lit.c and brume_sun.h in lanes; the sky is in wide_sky.h. Nothing
 * here depends on a kernel: densities come from b->sum_ways. Part of
 * wide_march.c.
 */
#ifndef BRUME_HOST_WIDE_LIT_H
#define BRUME_HOST_WIDE_LIT_H

#include "brume_ambient.h"
#include "brume_sun.h"
#include "wide_fog.h"
#include "wide_sun_map.h"

/// Queue ///

LANES_INLINE bool samples_sky(const struct brume_frame *f)
{
    return f->lit.ambient != BRUME_AMBIENT_NONE &&
           f->lit.visibility == BRUME_SKY_SAMPLED;
}

/* Where sample number n of the rays from number `ray` on looks, as move_lookup
 * of brume_lit.c. */
LANES_INLINE void moves_of(lanes moved[3], const struct patch *b, uint32_t ray,
                           lanes n)
{
    for (uint32_t i = 0; i < 3; i++)
        moved[i] =
            (lanes_load(b->lit.noise[i] + ray) + n * brume_r3(1, i)) & 0xffffu;
}

/* Lit samples of density d, number n of their rays, join the queue from number
 * `at` on. */
LANES_CALL void push_lit(const struct brume_frame *f, struct patch *b,
                         uint32_t at, uint32_t ray, lanes d, lanes n,
                         lanes_mask lit)
{
    lanes_pack(b->lit.d + at, d, lit);
    if (samples_sky(f)) {
        lanes nth = lanes_load(b->lit.count + ray);
        lanes_pack(b->lit.nth + at, nth, lit);
        lanes_store(b->lit.count + ray, nth + lanes_where(lit, lanes_of(1)));
    }
    if (f->lit.stochastic) {
        lanes moved[3];
        moves_of(moved, b, ray, n);
        for (int i = 0; i < 3; i++)
            lanes_pack(b->lit.moved[i] + at, moved[i], lit);
    }
}

/* The last samples of a queue, from number `end` on, are its first. */
LANES_CALL void keep_lit(struct patch *b, uint32_t end)
{
    struct fog_rays *fog = &b->fog;
    lanes_store(fog->by_height, lanes_load(fog->by_height + end));
    lanes_store(fog->shapes, lanes_load(fog->shapes + end));
    lanes_store(fog->above, lanes_load(fog->above + end));
    lanes_store(fog->outside, lanes_load(fog->outside + end));
    lanes_store(b->lit.d, lanes_load(b->lit.d + end));
    lanes_store(b->lit.nth, lanes_load(b->lit.nth + end));
    for (int i = 0; i < 3; i++)
        lanes_store(b->lit.moved[i], lanes_load(b->lit.moved[i] + end));
}

/* Positions half a voxel further, so that the nearest point is below them. */
LANES_INLINE void queued_positions(lanes p[3], const struct brume_frame *f,
                                   const struct queue *q, uint32_t at)
{
    for (int i = 0; i < 3; i++)
        p[i] = lanes_load(q->p[i] + at) + brume_half_voxel(f);
}

/// Ways ///

/* Of n samples, all the same number. */
LANES_INLINE void begin_ways(struct ways *w, uint32_t n, uint32_t count)
{
    w->wanted = mask_first(n);
    w->outside = mask_first(0);
    w->count = count;
    w->own = lanes_of(LOOKUPS);
}

/* Way k is 2^k times as long as the first, and counts as much. */
LANES_INLINE void put_doubled(struct ways *w, const lanes first[3], uint32_t k)
{
    for (int i = 0; i < 3; i++)
        lanes_store(w->way[k][i], first[i] << k);
    w->weight[k] = 1u << k;
}

/* Of samples outside of the pool, only those that `enter` have ways. */
LANES_INLINE void keep_outside(struct ways *w, lanes_mask outside,
                               lanes_mask enter)
{
    w->outside = mask_and(outside, enter);
    w->wanted = mask_or(mask_less_those(w->wanted, outside), w->outside);
}

/* In fog samples may be outside of the pool, and of these only those that see
 * the sun through it have ways. */
LANES_INLINE void leave_out_ways(const struct brume_frame *f, struct patch *b,
                                 uint32_t at)
{
    struct ways *w = &b->lit.ways;
    lanes_mask outside = mask_and(queued_outside(f, b, at), w->wanted);
    lanes p[3], t_in;
    if (!mask_any(outside))
        return;
    for (int i = 0; i < 3; i++)
        p[i] = lanes_load(b->queue.p[i] + at);
    keep_outside(w, outside, ways_to_pool(f, p, &t_in));
}

/// Octaves ///

/* add_octaves in fog: its optical depth is added to that of the sums */
static void add_octaves_in_fog(const struct brume_frame *f, struct patch *b,
                               uint32_t at, uint32_t n, lanes sum, lanes lost)
{
    lanes p[3];
    for (int i = 0; i < 3; i++)
        p[i] = lanes_load(b->queue.p[i] + at);
    lanes depth = fog_depths(f, b, at, p);
    for (uint32_t i = 0; i < f->lit.octaves; i++) {
        uint32_t a = f->lit.fog.extinction[i];
        lanes part =
            a == 0xffffffffu ? depth : lanes_mul_hi(depth, lanes_of(a));
        add_to_rays(b->sun[i], &b->queue, at, n,
                    lanes_mul_hi(lost, transmittances_beyond(&f->lit.tau[i],
                                                             sum, part)));
    }
}

LANES_CALL void add_octaves(const struct brume_frame *f, struct patch *b,
                            uint32_t at, uint32_t n, lanes sum)
{
    lanes lost = lanes_load(b->queue.lost + at);
    if (f->lit.sun_map != NULL)
        lost = in_sun(f, &b->queue, at, lost);
    if (f->lit.fog.on) {
        add_octaves_in_fog(f, b, at, n, sum, lost);
        return;
    }
    for (uint32_t i = 0; i < f->lit.octaves; i++)
        add_to_rays(
            b->sun[i], &b->queue, at, n,
            lanes_mul_hi(lost, sun_transmittances(&f->lit.tau[i], sum)));
}

/// Dense grids ///

LANES_INLINE lanes points_at(const struct patch *b, const struct dense *g,
                             lanes x, lanes y, lanes z)
{
    lanes q = gather_bytes(g->values, (z * g->size[1] + y) * g->size[0] + x);
    return g->codes ? lanes_of_table32(b->lit.depth_of_code, q) : q << 16;
}

LANES_INLINE lanes blended_lanes(lanes a, lanes b, lanes w)
{
    return (mix_lanes(a, b, w) + 128u) >> 8;
}

/* dense_value */
static lanes dense_lanes(const struct patch *b, const struct dense *g,
                         const lanes p[3], bool between)
{
    lanes low[3], high[3], weight[3], plane[2];
    for (int i = 0; i < 3; i++) {
        lanes at = between ? p[i] : p[i] + 0x8000u;
        lanes most = lanes_of((g->size[i] - 1u) << 16);
        at = lanes_min(lanes_unless(mask_high(at), at), most);
        low[i] = at >> 16;
        high[i] = lanes_min(low[i] + 1u, most >> 16);
        weight[i] = at >> 8 & 255u;
    }
    if (!between)
        return points_at(b, g, low[0], low[1], low[2]);
    for (uint32_t n = 0; n < 2; n++) {
        lanes z = n ? high[2] : low[2];
        plane[n] = blended_lanes(
            blended_lanes(points_at(b, g, low[0], low[1], z),
                          points_at(b, g, high[0], low[1], z), weight[0]),
            blended_lanes(points_at(b, g, low[0], high[1], z),
                          points_at(b, g, high[0], high[1], z), weight[0]),
            weight[1]);
    }
    return blended_lanes(plane[0], plane[1], weight[2]);
}

/// Cache ///

/* sum_cache, of n samples; of those outside of the pool it is anything */
LANES_INLINE lanes cache_sums(const struct brume_frame *f,
                              const struct patch *b, uint32_t at, uint32_t n)
{
    const struct brume_cache *c = &f->lit.cache;
    struct dense g = {c->from, {c->size[0], c->size[1], c->size[2]}, true};
    bool between = f->kernel & 4u;
    lanes p[3], sum;
    if (!mask_any(mask_less_those(mask_first(n), queued_outside(f, b, at))))
        return lanes_of(0);
    queued_positions(p, f, &b->queue, at);
    for (int i = 0; i < 3; i++) {
        p[i] = (p[i] >> c->spacing_log2) - 0x8000u;
        if (f->lit.stochastic)
            p[i] += lanes_load(b->lit.moved[i] + at) - 0x8000u;
    }
    sum = dense_lanes(b, &g, p, between);
    if (c->blend == 0)
        return sum;
    g.values = c->to;
    return blended_lanes(sum, dense_lanes(b, &g, p, between),
                         lanes_of(c->blend >> 8));
}

/// Cones ///

/* brick_mean */
LANES_INLINE lanes brick_means(const struct brume_volume *v, const lanes p[3],
                               uint32_t level, lanes_mask wanted)
{
    lanes at = lanes_where(wanted, cell_number(v, p[0], p[1], p[2]));
    lanes cell = gather_words(v->cells, at);
    uint32_t shift = 16u + level, row = 3u - level;
    uint32_t mask = level == 1 ? 3u : 1u, first = level == 1 ? 0 : 64u;
    lanes i = (p[0] >> shift & mask) | (p[1] >> shift & mask) << row |
              (p[2] >> shift & mask) << 2u * row;
    wanted = mask_less_those(wanted, mask_high(cell));
    at = lanes_where(wanted, cell * 72u + first + i);
    lanes q = lanes_where(wanted, gather_bytes(v->mips, at));
    return q * (q + 1u);
}

/* mean_at, of levels above 0; p half a voxel further */
LANES_INLINE lanes means_at(const struct brume_volume *v, struct mip *m,
                            const lanes p[3], uint32_t level, lanes_mask wanted)
{
    if (level < 3)
        return brick_means(v, p, level, wanted);
    seek_mip(m, level);
    uint32_t s = 16u + m->level;
    lanes row = (p[2] >> s) * m->size[1] + (p[1] >> s);
    lanes at = m->offset + row * m->size[0] + (p[0] >> s);
    lanes q = gather_bytes(v->mips, lanes_where(wanted, at));
    q = lanes_where(wanted, q);
    return q * (q + 1u);
}

/* The way to a segment's sample. Those that do not fit the word (is_far of
 * brume_ray.c) are returned: they are out of the pool. */
LANES_INLINE lanes_mask segment_ways(lanes way[3], const struct brume_frame *f,
                                     const struct light_lanes *light,
                                     struct brume_segment s)
{
    lanes high = lanes_of(0);
    for (int a = 0; a < 3; a++) {
        uint32_t move = (uint32_t)f->light_line.move[a];
        way[a] = light->first[a] * s.length + move * s.before;
        high |= (magnitudes(light->first[a]) >> 4) * s.length +
                (magnitude(f->light_line.move[a]) >> 4) * s.before;
    }
    return mask_less(lanes_of((1u << 27) - 1u), high);
}

/* Segments that are short enough for densities. They fit the word. */
LANES_INLINE lanes near_segments(const struct brume_frame *f, struct patch *b,
                                 const struct light_lanes *light, uint32_t at)
{
    struct ways *w = &b->lit.ways;
    for (; w->count < light->samples; w->count++) {
        struct brume_segment s = brume_segment_of(w->count, f->light_samples);
        lanes way[3];
        if (f->lit.cone_level + (int32_t)s.log2 > 0)
            break;
        segment_ways(way, f, light, s);
        for (int i = 0; i < 3; i++)
            lanes_store(w->way[w->count][i], way[i]);
        w->weight[w->count] = s.length;
    }
    lanes sum = lanes_load(b->lit.d + at) + b->sum_ways(f, b, at);
    return is_narrow_frame(f) ? sum << 8 : sum;
}

/* sum_cone, of n samples */
static lanes cone_sums(const struct brume_frame *f, struct patch *b,
                       uint32_t at, uint32_t n)
{
    const struct brume_volume *v = f->volume;
    struct mip mip = {3,
                      v->bricks * 72u,
                      {v->cell_count[0], v->cell_count[1], v->cell_count[2]}};
    struct light_lanes light;
    lanes p[3], half = lanes_of(brume_half_voxel(f));
    begin_light(&light, f, &b->queue, at);
    begin_ways(&b->lit.ways, n, 0);
    leave_out_ways(f, b, at);
    lanes sum = near_segments(f, b, &light, at);
    lanes_mask wanted = b->lit.ways.wanted, outside = b->lit.ways.outside;
    for (uint32_t i = b->lit.ways.count; i < light.samples; i++) {
        struct brume_segment s = brume_segment_of(i, f->light_samples);
        lanes way[3];
        lanes_mask far = segment_ways(way, f, &light, s);
        for (int a = 0; a < 3; a++)
            p[a] = lanes_load(b->queue.p[a] + at) + way[a];
        lanes_mask inside = inside_lanes(f, p[0], p[1], p[2]);
        wanted = mask_and(wanted, mask_or(inside, outside));
        wanted = mask_less_those(wanted, far);
        if (!mask_any(wanted))
            break;
        for (int a = 0; a < 3; a++)
            p[a] += half;
        sum += s.length * means_at(v, &mip, p,
                                   (uint32_t)f->lit.cone_level + s.log2,
                                   mask_and(wanted, inside));
    }
    return sum;
}

/// Sun ///

/* Sums of log. */
LANES_INLINE lanes log_sums(const struct brume_frame *f, struct patch *b,
                            uint32_t at, uint32_t n)
{
    struct ways *w = &b->lit.ways;
    struct light_lanes light;
    begin_light(&light, f, &b->queue, at);
    begin_ways(w, n, light.samples);
    leave_out_ways(f, b, at);
    w->own = light.own;
    for (uint32_t k = 0; k < w->count; k++)
        put_doubled(w, light.first, k);
    return b->sum_ways(f, b, at);
}

/* Sums of uniform by stochastic lookups: a few samples at a time, as long as
 * any is in the pool. */
static lanes uniform_sums(const struct brume_frame *f, struct patch *b,
                          uint32_t at, uint32_t n)
{
    struct ways *w = &b->lit.ways;
    lanes sum = lanes_of(0);
    begin_ways(w, n, 0);
    w->wanted = mask_less_those(w->wanted, queued_outside(f, b, at));
    for (uint32_t k = 0; k < f->light.samples; k += w->count) {
        uint32_t left = f->light.samples - k;
        if (!mask_any(w->wanted))
            break;
        w->count = left < LOOKUPS ? left : LOOKUPS;
        for (uint32_t j = 0; j < w->count; j++) {
            for (int i = 0; i < 3; i++)
                lanes_store(
                    w->way[j][i],
                    lanes_of((uint32_t)f->light.first[i] +
                             (k + j) * (uint32_t)f->light_line.move[i]));
            w->weight[j] = 1;
        }
        sum += b->sum_ways(f, b, at);
    }
    return sums_outside(f, b, at, n, sum);
}

/* Is the sun's light the business of light_lit? Else of a kernel alone. */
LANES_INLINE bool is_queue_lit(const struct brume_frame *f)
{
    return f->lit.on && (f->lit.light != BRUME_UNIFORM || f->lit.stochastic);
}

static lanes lit_sums(const struct brume_frame *f, struct patch *b, uint32_t at,
                      uint32_t n)
{
    switch (f->lit.light) {
    case BRUME_LOG: return log_sums(f, b, at, n);
    case BRUME_UNIFORM: return uniform_sums(f, b, at, n);
    case BRUME_CONE: return cone_sums(f, b, at, n);
    case BRUME_CACHE: return sums_outside(f, b, at, n, cache_sums(f, b, at, n));
    default: return lanes_of(0);
    }
}

/* Lights the queue's samples before number `end`. */
LANES_CALL void light_lit(const struct brume_frame *f, struct patch *b,
                          uint32_t end)
{
    for (uint32_t at = 0; at < end; at += WIDE_LANES) {
        uint32_t n = end - at < WIDE_LANES ? end - at : WIDE_LANES;
        add_octaves(f, b, at, n, lit_sums(f, b, at, n));
    }
}

/// Rays ///

/* What is the same for all rays. */
LANES_INLINE void begin_lit(const struct brume_frame *f, struct patch *b)
{
    for (uint32_t q = 0; q < 256 && f->lit.light == BRUME_CACHE; q++)
        b->lit.depth_of_code[q] = depth_of_code(q);
}

LANES_CALL void clear_lit(struct patch *b, uint32_t ray)
{
    lanes_store(b->lit.count + ray, lanes_of(0));
    for (int c = 0; c < 3; c++) {
        lanes_store(b->lit.lamp[c] + ray, lanes_of(0));
        lanes_store(b->lit.glow[c] + ray, lanes_of(0));
    }
    for (int j = 0; j < 6; j++)
        lanes_store(b->lit.sky[j] + ray, lanes_of(0));
}

LANES_CALL void add_lit_rays(const struct brume_frame *f, struct patch *b,
                             uint32_t ray, struct rays r)
{
    for (uint32_t i = 0; i < 3; i++) {
        lanes_store(b->lit.unit[i] + ray, r.unit[i]);
        if (f->lit.stochastic)
            lanes_store(b->lit.noise[i] + ray, lookup_noises(f, r.x, r.y, i));
    }
    lanes_store(b->lit.x + ray, r.x);
    lanes_store(b->lit.y + ray, r.y);
}

/* The light and transmittance of a ray; its depth is there. Most of it is done
 * once a ray, so one by one. */
LANES_CALL void finish_lit(const struct brume_frame *f, const struct patch *b,
                           uint32_t ray, struct brume_radiance *out)
{
    struct gathered g = {0};
    int32_t unit[3];
    for (int i = 0; i < 3; i++)
        unit[i] = as_signed(b->lit.unit[i][ray]);
    for (uint32_t i = 0; i < f->lit.octaves; i++)
        g.sun[i] = b->sun[i][ray];
    for (int j = 0; j < 6; j++)
        g.sky[j] = b->lit.sky[j][ray];
    for (int c = 0; c < 3; c++) {
        g.lamp[c] = b->lit.lamp[c][ray];
        g.glow[c] = b->lit.glow[c][ray];
    }
    brume_lit_finish(f, &g, unit, b->transmittance[ray], out);
}

#endif
