/* SPDX-License-Identifier: MIT */
/*
 * What is kept from frame to frame, and how a frame's rays enter it:
 *
 *   ema     f <- f + alpha (s - f), in place
 *   window  the mean of the last n: a ring of n planes, and their sums
 *   taa     this frame's rays as they are; brume_resolve.c does the rest
 *   none    this frame's rays as they are
 *
 * Light and transmittance are kept apart and before the background, so that
 * it is never blurred and may change. docs/temporal.md has definitions.
 */
#include "brume_inner.h"

#if BRUME_WITH_TEMPORAL

/// Rounding ///

/* A number in 0 .. 65535 for rounding what ray (x, y) keeps in this frame, so
 * that on average nothing is lost and nothing sticks: an additive recurrence
 * (R2 in space, the square root of 2 in time), whose means over neighbours
 * and frames converge faster than those of random numbers. It has a direction
 * in time, which an average with feedback notices (0.08/255 in 8 bits): so
 * every other ray has the mirrored one. No noise of the march uses the same
 * steps. */
BRUME_INLINE uint32_t dither(uint32_t x, uint32_t y, uint32_t frame,
                             uint32_t quantity)
{
    uint32_t r = (x * 3242174889u + y * 2447445414u + frame * 1779033704u +
                  quantity * 2654435769u) >>
                 16;
    return (x ^ y) & 1u ? 65535u - r : r;
}

/* h + alpha (s - h), rounded by r. h, s and r in 0 .. 65535; alpha Q0.16. */
BRUME_INLINE uint32_t blend(uint32_t h, uint32_t s, uint32_t alpha, uint32_t r)
{
    if (alpha >= 0x10000u)
        return s;
    /* < 2^32 - 2^17 + 2^16 */
    return s >= h ? h + (((s - h) * alpha + r) >> 16)
                  : h - (((h - s) * alpha + r) >> 16);
}

/* 16 bits to 8, rounded by r: 257 c + d becomes c + 1 with a probability of
 * d / 257. Exact where it can be. v + 256 < 2^16 + 2^8, and the product is
 * below 2^32. */
BRUME_INLINE uint32_t to_8_bits(uint32_t v, uint32_t r)
{
    return ((v + (r * 257u >> 16)) * 65281u) >> 24;
}

/// Memory ///

/* What decides on the planes. */
struct shape {
    uint32_t temporal, bits, window, update;
    uint32_t grid, lattice; /* rays */
    bool depth;
};

static struct shape shape_of(const struct brume_frame *f)
{
    struct shape shape = {f->temporal,
                          f->history_bits,
                          f->window,
                          f->update,
                          (uint32_t)f->grid[0] * f->grid[1],
                          (uint32_t)f->lattice[0] * f->lattice[1],
                          false};
#if BRUME_WITH_DEPTH
    shape.depth = f->depth;
#endif
    return shape;
}

/* Bytes of `rays` times so many, as a multiple of 4. */
static uint64_t plane_bytes(uint32_t rays, uint32_t each)
{
    uint64_t bytes = (uint64_t)mul_hi_floor(rays, each) << 32 | rays * each;
    return (bytes + 3u) & ~(uint64_t)3;
}

/* Offsets of the planes; returns the bytes of the whole. A plane has layer 0
 * of all rays, then layer 1 of all; depths are of rays. */
static uint64_t lay_out(struct brume_state *s, const struct shape *shape,
                        uint32_t layers)
{
    bool window = shape->temporal == BRUME_WINDOW;
    uint32_t planes = shape->temporal == BRUME_TEMPORAL_NONE ? 0
                      : shape->temporal == BRUME_TAA         ? 2
                                                             : 1;
    uint32_t pair = shape->bits / 4u, pairs = shape->grid * layers;
    uint64_t end = (sizeof *s + 3u) & ~(size_t)3;
    s->samples = (uint32_t)end;
    if (planes != 1)
        end +=
            plane_bytes(shape->lattice * layers, sizeof(struct brume_sample));
    s->sums = (uint32_t)end;
    if (window)
        end += plane_bytes(pairs, 2u * pair);
    for (uint32_t i = 0; i < planes; i++) {
        s->values[i] = (uint32_t)end;
        end += plane_bytes(pairs, pair * (window ? shape->window : 1u));
        s->depth[i] = (uint32_t)end;
        end += shape->depth ? plane_bytes(shape->grid, 2) : 0;
    }
    return end;
}

uint32_t brume_state_layout(const struct brume_frame *frame)
{
    struct shape shape = shape_of(frame);
    uint32_t layout =
        1u | shape.temporal << 1 | (shape.bits == 8 ? 1u << 3 : 0) |
        (shape.depth ? 1u << 4 : 0) | shape.window << 5 | shape.update << 10;
#if BRUME_WITH_RESOLUTION
    layout |= (uint32_t)frame->resolution << 12;
#endif
#if BRUME_WITH_COLOUR
    layout |= (uint32_t)frame->lit.colour << 14;
#endif
#if BRUME_WITH_LIGHTING /* a history of eighths is none of ones */
    layout |= (uint32_t)frame->lit.light_log2 << 15;
#endif
    return layout;
}

static bool scene_has_colour(const struct brume_scene *s)
{
#if BRUME_WITH_COLOUR
    return brume_scene_has_colour(s);
#else
    (void)s;
    return false;
#endif
}

size_t brume_state_bytes(const struct brume_scene *scene)
{
    const struct brume_scene *s = scene;
    struct brume_state state;
    if (s == NULL || s->width < 1 || s->width > BRUME_MAX_SIZE ||
        s->height < 1 || s->height > BRUME_MAX_SIZE ||
        brume_lattice_check(s) != BRUME_OK)
        return 0;
    uint32_t x = brume_rays(s->width, s->resolution);
    uint32_t y = brume_rays(s->height, s->resolution);
    struct shape shape = {
        s->temporal, s->history_bits == 8 ? 8 : 16, s->window, s->update, x * y,
        0,           brume_scene_has_depth(s)};
    shape.lattice = brume_rays(x, brume_cell_log2(s->update, 0)) *
                    brume_rays(y, brume_cell_log2(s->update, 1));
    uint64_t bytes = lay_out(&state, &shape, scene_has_colour(s) ? 2 : 1);
    return bytes > SIZE_MAX ? 0 : (size_t)bytes;
}

int brume_state_init(struct brume_state *state, size_t size)
{
    static const struct brume_state k_empty = {0};
    if (state == NULL)
        return BRUME_ERR_NULL;
    if (size < sizeof *state)
        return BRUME_ERR_STATE;
    *state = k_empty;
    state->size = size > 0xffffffffu ? 0xffffffffu : (uint32_t)size;
    return BRUME_OK;
}

/* The count has no end: what is read of it is whether it is small, and its
 * remainder by window * period, which divides 11531520. */
static uint32_t next_count(uint32_t frames)
{
    return frames < 0x80000000u ? frames + 1u : frames + 1u - 64u * 11531520u;
}

int brume_begin_state(struct brume_state *state,
                      const struct brume_frame *frame)
{
    struct brume_state *s = state, planes;
    if (s == NULL || frame == NULL)
        return BRUME_ERR_NULL;
    struct shape shape = shape_of(frame);
    uint32_t layers = brume_has_colour(frame) ? 2 : 1;
    if (lay_out(&planes, &shape, layers) > s->size)
        return BRUME_ERR_STATE;
    bool fresh = frame->cut || !brume_state_fits(s, frame);
    lay_out(s, &shape, layers);
    s->layout = brume_state_layout(frame);
    s->image[0] = frame->width;
    s->image[1] = frame->height;
    s->frames = fresh ? 0 : next_count(s->frames);
    s->now ^= 1u;
#if BRUME_WITH_TAA
    if (frame->temporal == BRUME_TAA)
        brume_motion_begin(s, frame);
#endif
    return BRUME_OK;
}

/// Planes ///

/* Halves of the caller's memory, whatever that was declared as. */
#if defined(__GNUC__)
typedef uint16_t __attribute__((__may_alias__)) half_t;
#else
typedef uint16_t half_t;
#endif

static brume_word_t *words(const struct brume_state *s, uint32_t offset)
{
    return (brume_word_t *)(void *)((uint8_t *)(uintptr_t)s + offset);
}

static half_t *halves(const struct brume_state *s, uint32_t offset)
{
    return (half_t *)(void *)((uint8_t *)(uintptr_t)s + offset);
}

/* Light and transmittance number i of a plane, in 16 bits. Those of layer 1
 * follow all of layer 0's. */
BRUME_INLINE void get_pair(const struct brume_state *s, uint32_t plane,
                           uint32_t i, uint32_t bits, uint32_t pair[2])
{
    if (bits == 8) {
        const uint8_t *p = (const uint8_t *)s + plane + 2u * i;
        pair[0] = p[0] * 257u;
        pair[1] = p[1] * 257u;
    } else {
        const half_t *p = halves(s, plane) + 2u * i;
        pair[0] = p[0];
        pair[1] = p[1];
    }
}

/* The same way back; `code` holds codes of the plane's bits. */
BRUME_INLINE void put_pair(struct brume_state *s, uint32_t plane, uint32_t i,
                           uint32_t bits, const uint32_t code[2])
{
    if (bits == 8) {
        uint8_t *p = (uint8_t *)s + plane + 2u * i;
        p[0] = (uint8_t)code[0];
        p[1] = (uint8_t)code[1];
    } else {
        half_t *p = halves(s, plane) + 2u * i;
        p[0] = (uint16_t)code[0];
        p[1] = (uint16_t)code[1];
    }
}

static void get_sums(const struct brume_state *s, uint32_t i, uint32_t bits,
                     uint32_t sum[2])
{
    for (uint32_t q = 0; q < 2; q++)
        sum[q] = bits == 8 ? halves(s, s->sums)[2u * i + q]
                           : words(s, s->sums)[2u * i + q];
}

BRUME_INLINE void put_sums(struct brume_state *s, uint32_t i, uint32_t bits,
                           const uint32_t sum[2])
{
    for (uint32_t q = 0; q < 2; q++)
        if (bits == 8)
            halves(s, s->sums)[2u * i + q] = (uint16_t)sum[q];
        else
            words(s, s->sums)[2u * i + q] = sum[q];
}

static uint32_t grid_of(const struct brume_frame *f)
{
    return (uint32_t)f->grid[0] * f->grid[1];
}

static void get_depth(const struct brume_frame *f, const struct brume_state *s,
                      uint32_t plane, uint32_t i, struct brume_sample *out)
{
    out->depth = 0;
#if BRUME_WITH_DEPTH
    if (f->depth)
        out->depth = halves(s, s->depth[plane])[i];
#else
    (void)f;
    (void)s;
    (void)plane;
    (void)i;
#endif
}

BRUME_INLINE void history_get(const struct brume_frame *f,
                              const struct brume_state *s, uint32_t plane,
                              uint32_t i, struct brume_sample *out,
                              uint32_t layer)
{
    uint32_t pair[2];
    get_pair(s, s->values[plane], layer * grid_of(f) + i, f->history_bits,
             pair);
    out->light = (uint16_t)pair[0];
    out->transmittance = (uint16_t)pair[1];
    if (layer == 0)
        get_depth(f, s, plane, i, out);
}

void brume_history_get(const struct brume_frame *frame,
                       const struct brume_state *state, uint32_t plane,
                       uint32_t i, struct brume_sample *out)
{
    history_get(frame, state, plane, i, out, 0);
}

/* A depth between two, h + alpha (s - h). Where one has none, the other: a
 * pixel of thin cloud is seen in some frames only. Until nothing is left of
 * the cloud. */
static uint32_t blend_depth(uint32_t h, uint32_t s, uint32_t alpha, uint32_t r,
                            bool clear)
{
    if (clear)
        return BRUME_NO_DEPTH;
    if (h == BRUME_NO_DEPTH || s == BRUME_NO_DEPTH)
        return h == BRUME_NO_DEPTH ? s : h;
    return blend(h, s, alpha, r);
}

static void put_depth(const struct brume_frame *f, struct brume_state *s,
                      uint32_t plane, uint32_t i, uint32_t depth)
{
#if BRUME_WITH_DEPTH
    if (f->depth)
        halves(s, s->depth[plane])[i] = (uint16_t)depth;
#else
    (void)f;
    (void)s;
    (void)plane;
    (void)i;
    (void)depth;
#endif
}

BRUME_INLINE void history_put(const struct brume_frame *f,
                              struct brume_state *s, uint32_t plane, uint32_t x,
                              uint32_t y, const struct brume_sample *old,
                              const struct brume_sample *in, uint32_t alpha,
                              uint32_t layer)
{
    uint32_t i = y * f->grid[0] + x;
    uint32_t v[2] = {in->light, in->transmittance};
    const uint32_t h[2] = {old->light, old->transmittance};
    for (uint32_t q = 0; q < 2; q++) {
        uint32_t r = dither(x, y, f->frame, layer == 0 ? q : 0);
        v[q] = blend(h[q], v[q], alpha, f->history_bits == 8 ? 0x8000u : r);
        if (f->history_bits == 8)
            v[q] = to_8_bits(v[q], r);
    }
    put_pair(s, s->values[plane], layer * grid_of(f) + i, f->history_bits, v);
    if (layer == 0)
        put_depth(f, s, plane, i,
                  blend_depth(old->depth, in->depth, alpha,
                              dither(x, y, f->frame, 2),
                              v[1] == (f->history_bits == 8 ? 255u : 65535u)));
}

void brume_history_put(const struct brume_frame *frame,
                       struct brume_state *state, uint32_t plane, uint32_t x,
                       uint32_t y, const struct brume_sample *old,
                       const struct brume_sample *in, uint32_t alpha)
{
    history_put(frame, state, plane, x, y, old, in, alpha, 0);
}

/// Window ///

/* Adds the ray to its window, as number `count` that it has seen, from 0. */
BRUME_INLINE void window_put(const struct brume_frame *f, struct brume_state *s,
                             uint32_t x, uint32_t y, uint32_t count,
                             const struct brume_sample *in, uint32_t layer)
{
    uint32_t i = y * f->grid[0] + x, bits = f->history_bits;
    uint32_t rays = grid_of(f), at = layer * rays + i;
    uint32_t slot = (layer * f->window + count % f->window) * rays + i;
    uint32_t v[2] = {in->light, in->transmittance}, sum[2] = {0, 0};
    uint32_t old[2] = {0, 0};
    if (bits == 8)
        for (uint32_t q = 0; q < 2; q++)
            v[q] = to_8_bits(v[q], dither(x, y, f->frame, layer == 0 ? q : 0));
    if (count > 0)
        get_sums(s, at, bits, sum);
    if (count >= f->window)
        get_pair(s, s->values[0], slot, bits, old);
    for (uint32_t q = 0; q < 2; q++)
        sum[q] += v[q] - (bits == 8 ? old[q] / 257u : old[q]);
    put_sums(s, at, bits, sum);
    put_pair(s, s->values[0], slot, bits, v);
    if (layer != 0)
        return;
    struct brume_sample before;
    get_depth(f, s, 0, i, &before);
    put_depth(f, s, 0, i,
              blend_depth(count > 0 ? before.depth : BRUME_NO_DEPTH, in->depth,
                          0x10000u / f->window, dither(x, y, f->frame, 2),
                          sum[1] == (bits == 8 ? 255u : 65535u) * f->window));
}

/* The mean of `count` frames, rounded to nearest. sum < 2^20, so that the
 * quotient by the reciprocal, which is up to 1/2^32 too large, is exact. */
BRUME_INLINE void window_get(const struct brume_frame *f,
                             const struct brume_state *s, uint32_t i,
                             uint32_t count, struct brume_sample *out,
                             uint32_t layer)
{
    uint32_t sum[2], n = count < f->window ? count : f->window;
    uint32_t inverse = 0xffffffffu / n + 1u; /* n = 1: 0, and 2^32 is meant */
    get_sums(s, layer * grid_of(f) + i, f->history_bits, sum);
    for (uint32_t q = 0; q < 2; q++) {
        if (f->history_bits == 8)
            sum[q] *= 257u;
        if (n > 1)
            sum[q] = mul_hi_floor(sum[q] + n / 2u, inverse);
    }
    out->light = (uint16_t)sum[0];
    out->transmittance = (uint16_t)sum[1];
    if (layer == 0)
        get_depth(f, s, 0, i, out);
}

/// Turns ///

uint32_t brume_age_of(const struct brume_frame *frame, uint32_t x, uint32_t y)
{
    const struct brume_frame *f = frame;
    static const uint8_t k_bayer[16] = {0, 8,  2, 10, 12, 4, 14, 6,
                                        3, 11, 1, 9,  15, 7, 13, 5};
    if (f->update == BRUME_CHECKER)
        return (f->frame ^ x ^ y) & 1u;
    if (f->update == BRUME_BAYER4)
        return (f->frame - k_bayer[(y & 3u) << 2 | (x & 3u)]) & 15u;
    return 0;
}

/* How often a ray was marched since the cut, up to and with this frame, whose
 * turn was `age` frames ago. */
BRUME_INLINE uint32_t visits_of(const struct brume_frame *f,
                                const struct brume_state *s, uint32_t age)
{
    if (age > s->frames)
        return 0;
    return ((s->frames - age) >> brume_period_log2(f->update)) + 1u;
}

uint32_t brume_lattice_index(const struct brume_frame *frame, uint32_t x,
                             uint32_t y)
{
    return (y >> frame->cell_log2[1]) * frame->lattice[0] +
           (x >> frame->cell_log2[0]);
}

/// Rays in ///

/* What ray (x, y) of the grid gets. One that had no turn yet takes its cell's
 * ray for the time being. */
BRUME_INLINE void put_in(const struct brume_frame *f, struct brume_state *s,
                         uint32_t x, uint32_t y, uint32_t age,
                         const struct brume_sample *in, uint32_t layer)
{
    uint32_t visits = visits_of(f, s, age);
    struct brume_sample old = *in;
    if (visits > 0 && age > 0)
        return;
    if (f->temporal == BRUME_WINDOW) {
        window_put(f, s, x, y, visits > 0 ? visits - 1u : 0, in, layer);
        return;
    }
    if (visits > 1)
        brume_layer_get(f, s, 0, y * f->grid[0] + x, &old, layer);
    brume_layer_put(f, s, 0, x, y, &old, in, f->alpha, layer);
}

static void put_ray(const struct brume_frame *f, struct brume_state *s,
                    uint32_t x, uint32_t y, uint32_t age,
                    const struct brume_sample *in)
{
    put_in(f, s, x, y, age, in, 0);
}

/* Not inlined: one for each layer. */
static void put_colours(const struct brume_frame *f, struct brume_state *s,
                        uint32_t x, uint32_t y, uint32_t age,
                        const struct brume_sample *in)
{
    put_in(f, s, x, y, age, in, 1);
}

BRUME_INLINE void put_layer(const struct brume_frame *f, struct brume_state *s,
                            uint32_t x, uint32_t y, uint32_t age,
                            const struct brume_sample *in, uint32_t layer)
{
    if (BRUME_WITH_COLOUR && layer == 1)
        put_colours(f, s, x, y, age, in);
    else
        put_ray(f, s, x, y, age, in);
}

/* All rays of the grid in cell (x, y) of the lattice. */
BRUME_INLINE void put_cell(const struct brume_frame *f, struct brume_state *s,
                           uint32_t x, uint32_t y,
                           const struct brume_sample *in, uint32_t layer)
{
    uint32_t across = 1u << f->cell_log2[0], down = 1u << f->cell_log2[1];
    x <<= f->cell_log2[0];
    y <<= f->cell_log2[1];
    for (uint32_t j = 0; j < down && y + j < f->grid[1]; j++)
        for (uint32_t i = 0; i < across && x + i < f->grid[0]; i++)
            put_layer(f, s, x + i, y + j, brume_age_of(f, x + i, y + j), in,
                      layer);
}

BRUME_INLINE void store(const struct brume_frame *f, struct brume_state *s,
                        uint32_t x, uint32_t y, uint32_t n,
                        const struct brume_radiance *in, uint32_t layer)
{
    const uint32_t log2 = brume_light_log2(f);
    bool kept = f->temporal == BRUME_EMA || f->temporal == BRUME_WINDOW;
    for (uint32_t i = 0; i < n; i++) {
        struct brume_sample sample = brume_sample_from(&in[i], log2, layer);
        if (kept && f->update == BRUME_UPDATE_ALL)
            put_layer(f, s, x + i, y, 0, &sample, layer);
        else if (kept)
            put_cell(f, s, x + i, y, &sample, layer);
        else
            *brume_sample_at(f, s, y * f->lattice[0] + x + i, layer) = sample;
    }
}

void brume_store_span(const struct brume_frame *frame,
                      struct brume_state *state, uint32_t x, uint32_t y,
                      uint32_t n, const struct brume_radiance *in)
{
    store(frame, state, x, y, n, in, 0);
    if (brume_has_colour(frame))
        store(frame, state, x, y, n, in, 1);
}

/// Rays out ///

BRUME_INLINE void history_row(const struct brume_frame *f,
                              const struct brume_state *s, uint32_t x,
                              uint32_t y, uint32_t n, struct brume_sample *out,
                              uint32_t layer)
{
    uint32_t taa = f->temporal == BRUME_TAA ? s->now : 0;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t at = y * f->grid[0] + x + i;
        if (f->temporal == BRUME_TEMPORAL_NONE) {
            out[i] =
                *brume_sample_at(f, s, brume_lattice_index(f, x + i, y), layer);
        } else if (f->temporal == BRUME_WINDOW) {
            uint32_t visits = visits_of(f, s, brume_age_of(f, x + i, y));
            window_get(f, s, at, visits > 0 ? visits : 1, &out[i], layer);
        } else {
            brume_layer_get(f, s, taa, at, &out[i], layer);
        }
    }
}

void brume_history_row(const struct brume_frame *frame,
                       const struct brume_state *state, uint32_t x, uint32_t y,
                       uint32_t n, struct brume_sample *out)
{
    history_row(frame, state, x, y, n, out, 0);
}

/// Layer 1 ///

#if BRUME_WITH_COLOUR
void brume_colours_get(const struct brume_frame *frame,
                       const struct brume_state *state, uint32_t plane,
                       uint32_t i, struct brume_sample *out)
{
    history_get(frame, state, plane, i, out, 1);
}

void brume_colours_put(const struct brume_frame *frame,
                       struct brume_state *state, uint32_t plane, uint32_t x,
                       uint32_t y, const struct brume_sample *old,
                       const struct brume_sample *in, uint32_t alpha)
{
    history_put(frame, state, plane, x, y, old, in, alpha, 1);
}

void brume_colours_row(const struct brume_frame *frame,
                       const struct brume_state *state, uint32_t x, uint32_t y,
                       uint32_t n, struct brume_sample *out)
{
    history_row(frame, state, x, y, n, out, 1);
}
#endif

#endif
