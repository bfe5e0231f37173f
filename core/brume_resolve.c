/* SPDX-License-Identifier: MIT */
/*
 * Temporal anti-aliasing: history is fetched where the camera of the frame
 * before saw what this ray sees now, at the ray's mean depth, and is held to
 * what this frame's rays around it allow. After Pedersen, "Temporal
 * Reprojection Anti-Aliasing in INSIDE", 2016 (depth of 3x3, clipping towards
 * the mean), Salvi, "An Excursion in Temporal Supersampling", 2016
 * (variance clipping) and Toft, Bowles, Zimmermann, "Optimisations for
 * Real-Time Volumetric Cloudscapes", 2016 (the depth of a cloud).
 *
 * While nothing moves, history is neither resampled nor clipped: then this is
 * brume_temporal.c's moving average.
 *
 * A ray is an array of its layers' samples.
 */
#include "brume_inner.h"

#if BRUME_WITH_TAA

/* Depths that differ by more, a sixteenth of an octave, are two things. */
#define DISOCCLUDED 128u

/* What this frame's rays around a place say about light and transmittance of a
 * layer, in 16 bits. */
struct vicinity {
    uint32_t low[2], high[2], mean[2];
    uint32_t depth; /* mean of those that have one */
    uint32_t deep;  /* how many have */
};

/// Motion ///

static bool same_view(const struct brume_view *a, const struct brume_view *b)
{
    for (int i = 0; i < 3; i++)
        if (a->eye[i] != b->eye[i] || a->ahead[i] != b->ahead[i] ||
            a->right[i] != b->right[i] || a->up[i] != b->up[i])
            return false;
    return a->focal.m == b->focal.m && a->focal.e == b->focal.e;
}

void brume_motion_begin(struct brume_state *state,
                        const struct brume_frame *frame)
{
    struct brume_state *s = state;
    const struct brume_view *before = &s->view, *now = &frame->view;
    s->at_rest = s->frames > 0 && same_view(before, now);
    s->still = s->at_rest && s->same == frame->same;
    for (int i = 0; i < 3; i++) {
        s->axes[0][i] = before->right[i];
        s->axes[1][i] = before->up[i];
        s->axes[2][i] = before->ahead[i];
        /* |.| < 2^32, Q16.16 -> Q18.13 */
        s->moved[i] = (int32_t)(((int64_t)now->eye[i] - before->eye[i]) / 8);
    }
    s->focal = before->focal;
    s->view = *now;
    s->same = frame->same;
}

/* Distance of a code, Q16.16. */
static uint32_t distance_of(uint32_t code)
{
    uint32_t high = code >> 11, mantissa = (code & 0x7ffu) | 0x800u;
    return high > 11 ? mantissa << (high - 11u) : mantissa >> (11u - high);
}

/* a . b of a vector in Q18.13 and a unit one, |a| < 2^31. */
static int32_t dot(const int32_t a[3], const int32_t unit[3])
{
    int32_t sum = 0;
    for (int i = 0; i < 3; i++)
        sum += mul_both_signed_round(a[i], unit[i], 2);
    return sum;
}

/* From the middle of the image to a point `across` to the side, both seen at
 * `scale` = focal / depth: in rays, Q8. False when far outside. */
static bool place_of(int32_t across, struct brume_number scale, uint32_t size,
                     uint32_t resolution, int32_t *out)
{
    struct brume_number n =
        brume_number_mul(brume_number_of(magnitude(across), 0), scale);
    uint32_t away = brume_number_floor(n, 9 - (int32_t)resolution);
    if (away >= 0x2000000u) /* 2^16 rays */
        return false;
    int32_t q8 = with_sign((away + 1u) >> 1, across < 0);
    /* The middle is `size` / 2 pixels from the side, the first ray 1/2 ray. */
    *out = q8 + (int32_t)((size << 7) >> resolution) - 128;
    return true;
}

/* Where the frame before saw what is on ray (x, y) at a depth: in rays of the
 * grid, Q8, 0 in the middle of the first; and the code of its depth there.
 * False when nowhere. */
static bool reproject(const struct brume_frame *f, const struct brume_state *s,
                      uint32_t x, uint32_t y, uint32_t *depth, int32_t at[2])
{
    uint32_t t = distance_of(*depth) >> 1, r = brume_resolution_of(f);
    int32_t p[3];
    brume_grid_direction(f, x, y, p);
    brume_normalise(p);
    for (int i = 0; i < 3; i++) /* Q30 * Q15 -> Q13; |p| < 2^30.5 */
        p[i] = mul_signed_round(p[i], t, 0) + s->moved[i];
    int32_t ahead = dot(p, s->axes[2]);
    if (ahead <= 0)
        return false;
    struct brume_number scale = brume_number_mul(
        s->focal, brume_number_inverse(brume_number_of((uint32_t)ahead, 0)));
    if (!place_of(dot(p, s->axes[0]), scale, f->width, r, &at[0]) ||
        !place_of(-dot(p, s->axes[1]), scale, f->height, r, &at[1]))
        return false;
    for (int i = 0; i < 2; i++) /* not more than half a ray outside */
        if (at[i] < -128 || at[i] >= (int32_t)f->grid[i] * 256 - 128)
            return false;
    int32_t unit[3] = {p[0], p[1], p[2]};
    brume_normalise(unit);
    *depth = brume_depth_code((uint32_t)dot(p, unit) << 1) + (2u << 11);
    return true;
}

/// Fetch ///

BRUME_INLINE uint32_t held(int32_t i, uint32_t size)
{
    return i < 0 ? 0 : (uint32_t)i < size ? (uint32_t)i : size - 1u;
}

/* Weights of the rays -1, 0, 1, 2 around a place `t` / 256 from ray 0, Q14;
 * they sum to 1. Catmull and Rom, "A class of local interpolating splines",
 * 1974, with a tension of 1/2: the outer ones are negative. */
static void weights_of(uint32_t fetch, int32_t t, int32_t w[4])
{
    w[0] = w[3] = 0;
    w[2] = t * 64;
    if (fetch == BRUME_FETCH_CATMULL_ROM) {
        int32_t u = 256 - t;
        w[0] = -(t * u * u + 1024) / 2048;
        w[3] = -(t * t * u + 1024) / 2048;
        w[2] = (t * (65536 + 4 * 256 * t - 3 * t * t) + 1024) / 2048;
    }
    w[1] = 16384 - w[0] - w[2] - w[3];
}

/* A layer of history at a place, and its depth at the ray next to it. */
BRUME_INLINE void fetch(const struct brume_frame *f,
                        const struct brume_state *s, const int32_t at[2],
                        struct brume_sample *out, uint32_t layer)
{
    int32_t x = (at[0] + 256) / 256 - 1, y = (at[1] + 256) / 256 - 1;
    int32_t across[4], down[4], sum[2] = {0, 0};
    int32_t tx = at[0] - x * 256, ty = at[1] - y * 256;
    uint32_t plane = s->now ^ 1u;
    struct brume_sample h;
    weights_of(f->fetch, tx, across);
    weights_of(f->fetch, ty, down);
    for (int j = 0; j < 4; j++) {
        int32_t row[2] = {0, 0};
        if (down[j] == 0)
            continue;
        for (int i = 0; i < 4; i++) {
            if (across[i] == 0)
                continue;
            /* Weights are below 2^14 and their magnitudes sum to at most 1.25
             * of it: below 2^31 */
            uint32_t n = held(y + j - 1, f->grid[1]) * f->grid[0] +
                         held(x + i - 1, f->grid[0]);
            brume_layer_get(f, s, plane, n, &h, layer);
            row[0] += across[i] * h.light;
            row[1] += across[i] * h.transmittance;
        }
        for (int q = 0; q < 2; q++)
            sum[q] +=
                down[j] * ((row[q] + (row[q] < 0 ? -8192 : 8192)) / 16384);
    }
    uint32_t n = held(y + (ty >= 128), f->grid[1]) * f->grid[0] +
                 held(x + (tx >= 128), f->grid[0]);
    if (layer == 0)
        brume_history_get(f, s, plane, n, out);
    out->light = (uint16_t)held((sum[0] + 8192) / 16384, 65536);
    out->transmittance = (uint16_t)held((sum[1] + 8192) / 16384, 65536);
}

/// Clipping ///

static uint32_t root_of(uint32_t v)
{
    uint32_t root = 0;
    for (uint32_t bit = 1u << 15; bit != 0; bit >>= 1)
        if ((root | bit) * (root | bit) <= v)
            root |= bit;
    return root;
}

/* The range of a quantity: its mean +- gamma deviations. Given are the mean of
 * what its 9 values differ from one of them, and the sum of the squares of
 * that, in 14 bits: < 2^14 and < 9 * 2^28. */
BRUME_INLINE void spread(const struct brume_frame *f, struct vicinity *v,
                         uint32_t q, int32_t mean, uint32_t squares)
{
    uint32_t rest = squares / 9u, square = magnitude(mean) * magnitude(mean);
    uint32_t deviation = root_of(rest > square ? rest - square : 0);
    uint32_t reach = mul_hi_floor(deviation << 18, f->gamma) + 4u;
    v->low[q] = v->mean[q] > reach ? v->mean[q] - reach : 0;
    v->high[q] = v->mean[q] + reach;
}

/* Adds a ray to what is known of its neighbours'. */
BRUME_INLINE void add_ray(struct vicinity *v, const struct brume_sample *in,
                          const uint32_t base[2], int32_t sum[2],
                          uint32_t squares[2])
{
    const uint32_t value[2] = {in->light, in->transmittance};
    if (in->depth != BRUME_NO_DEPTH) {
        v->depth += in->depth;
        v->deep++;
    }
    for (uint32_t q = 0; q < 2; q++) {
        int32_t d = (int32_t)(value[q] >> 2) - (int32_t)(base[q] >> 2);
        v->low[q] = value[q] < v->low[q] ? value[q] : v->low[q];
        v->high[q] = value[q] > v->high[q] ? value[q] : v->high[q];
        sum[q] += d;
        squares[q] += magnitude(d) * magnitude(d);
    }
}

/* The 3x3 rays of this frame's lattice around that of ray (x, y), `own`, in a
 * layer. */
BRUME_INLINE void look_around(const struct brume_frame *f,
                              const struct brume_state *s, uint32_t x,
                              uint32_t y, const struct brume_sample *own,
                              struct vicinity *v, uint32_t layer)
{
    int32_t cx = (int32_t)(x >> f->cell_log2[0]);
    int32_t cy = (int32_t)(y >> f->cell_log2[1]);
    const uint32_t base[2] = {own->light, own->transmittance};
    int32_t sum[2] = {0, 0};
    uint32_t squares[2] = {0, 0};
    v->depth = v->deep = 0;
    for (uint32_t q = 0; q < 2; q++)
        v->low[q] = v->high[q] = base[q];
    for (int32_t j = cy - 1; j <= cy + 1; j++)
        for (int32_t i = cx - 1; i <= cx + 1; i++) {
            uint32_t row = held(j, f->lattice[1]) * f->lattice[0];
            row += held(i, f->lattice[0]);
            add_ray(v, brume_sample_at(f, s, row, layer), base, sum, squares);
        }
    v->depth = v->deep > 0 ? v->depth / v->deep : BRUME_NO_DEPTH;
    for (uint32_t q = 0; q < 2; q++) {
        int32_t mean = (sum[q] + (sum[q] < 0 ? -4 : 4)) / 9;
        v->mean[q] = base[q] + 4u * (uint32_t)mean;
        if (f->clamp == BRUME_CLAMP_VARIANCE && v->low[q] < v->high[q])
            spread(f, v, q, mean, squares[q]);
    }
}

/* How far a value may go from the mean towards where it is, to be in the
 * range, Q0.16. All are below 2^16 where it matters. */
BRUME_INLINE uint32_t room_for(const struct vicinity *v, uint32_t q,
                               uint32_t value)
{
    uint32_t mean = v->mean[q];
    if (value < v->low[q])
        return ((mean - v->low[q]) << 16) / (mean - value);
    if (value > v->high[q])
        return ((v->high[q] - mean) << 16) / (value - mean);
    return 0x10000u;
}

/* That of both quantities of a layer. */
BRUME_INLINE uint32_t room_of(const struct vicinity *v,
                              const struct brume_sample *h)
{
    uint32_t room = room_for(v, 0, h->light);
    uint32_t other = room_for(v, 1, h->transmittance);
    return other < room ? other : room;
}

BRUME_INLINE void draw_in(const struct vicinity *v, struct brume_sample *h,
                          uint32_t room)
{
    uint32_t value[2] = {h->light, h->transmittance};
    for (uint32_t q = 0; q < 2; q++) {
        uint32_t mean = v->mean[q], n = value[q];
        uint32_t way = ((n < mean ? mean - n : n - mean) * (room >> 1)) >> 15;
        value[q] = n < mean ? mean - way : mean + way;
    }
    h->light = (uint16_t)value[0];
    h->transmittance = (uint16_t)value[1];
}

/* Moves history towards the mean until all quantities are in their ranges, and
 * a colour by the same share in all channels: it keeps its hue. Returns what is
 * left of its way from the mean, Q0.16. */
static uint32_t clip(const struct vicinity *v, struct brume_sample *h,
                     bool colour)
{
    uint32_t room = room_of(v, h);
    if (colour) {
        uint32_t other = room_of(v + 1, h + 1);
        room = other < room ? other : room;
        draw_in(v + 1, h + 1, room);
    }
    draw_in(v, h, room);
    return room;
}

static uint32_t between(uint32_t n, uint32_t low, uint32_t high)
{
    return n < low ? low : n > high ? high : n;
}

BRUME_INLINE void hold_in(const struct vicinity *v, struct brume_sample *h)
{
    h->light = (uint16_t)between(h->light, v->low[0], v->high[0]);
    h->transmittance =
        (uint16_t)between(h->transmittance, v->low[1], v->high[1]);
}

/* Holds history to the range, and returns the weight of this frame: the more
 * had to be taken away, the less is the rest believed, by up to half. */
static uint32_t hold(const struct brume_frame *f, const struct vicinity *v,
                     struct brume_sample *h, bool colour)
{
    if (f->clamp == BRUME_CLAMP_MINMAX) {
        hold_in(v, h);
        if (colour)
            hold_in(v + 1, h + 1);
    }
    if (f->clamp != BRUME_CLAMP_VARIANCE)
        return f->alpha;
    uint32_t lost = (0x10000u - clip(v, h, colour)) >> 1;
    return f->alpha + (lost * ((0x10000u - f->alpha) >> 1) >> 15);
}

/// Rays ///

/* History of ray (x, y) at the place that it comes from; false when that is
 * not in the image, or another thing was there. */
static bool find(const struct brume_frame *f, const struct brume_state *s,
                 uint32_t x, uint32_t y, uint32_t depth, struct brume_sample *h,
                 bool colour)
{
    int32_t at[2];
    if (!reproject(f, s, x, y, &depth, at))
        return false;
    fetch(f, s, at, h, 0);
    if (colour)
        fetch(f, s, at, h + 1, 1);
    return h->depth == BRUME_NO_DEPTH ||
           magnitude((int32_t)depth - h->depth) <= DISOCCLUDED;
}

/* History of ray number i where it is. */
BRUME_INLINE void get_ray(const struct brume_frame *f,
                          const struct brume_state *s, uint32_t i,
                          struct brume_sample *h, bool colour)
{
    brume_layer_get(f, s, s->now ^ 1u, i, h, 0);
    if (colour)
        brume_layer_get(f, s, s->now ^ 1u, i, h + 1, 1);
}

/* Half of it, and half of the mean. */
BRUME_INLINE void halve(const struct vicinity *v, struct brume_sample *in)
{
    in->light = (uint16_t)((in->light + v->mean[0] + 1u) >> 1);
    in->transmittance = (uint16_t)((in->transmittance + v->mean[1] + 1u) >> 1);
}

/* The ray's history into *h, and the weight of this frame's ray beside it.
 * False when it has none; then *in is drawn towards its neighbours. */
static bool history_of(const struct brume_frame *f, const struct brume_state *s,
                       uint32_t x, uint32_t y, struct brume_sample *in,
                       struct brume_sample *h, uint32_t *alpha, bool colour)
{
    struct vicinity v[BRUME_LAYERS];
    *alpha = f->alpha;
    if (s->at_rest)
        get_ray(f, s, y * f->grid[0] + x, h, colour);
    if (s->still)
        return true;
    look_around(f, s, x, y, in, v, 0);
    if (v->depth == BRUME_NO_DEPTH) /* clear: there is nothing to average */
        return false;
    if (colour)
        look_around(f, s, x, y, in + 1, v + 1, 1);
    if (s->at_rest || find(f, s, x, y, v->depth, h, colour)) {
        *alpha = hold(f, v, h, colour);
        return true;
    }
    halve(v, in);
    if (colour)
        halve(v + 1, in + 1);
    return false;
}

/* The weight of a ray that has its turn. The first one since the cut takes the
 * place of its cell's; later, while things move, it weighs what the frames
 * since the last one would have weighed. */
static uint32_t weight_of_turn(const struct brume_frame *f,
                               const struct brume_state *s, uint32_t alpha)
{
    uint32_t turns = brume_period_log2(f->update), keep = 0x10000u - alpha;
    if (s->frames >> turns == 0)
        return 0x10000u;
    for (; turns > 0 && !s->still; turns--)
        keep = keep * keep >> 16; /* keep < 2^16 */
    return 0x10000u - keep;
}

BRUME_INLINE void copy_ray(struct brume_sample *out,
                           const struct brume_sample *in, bool colour)
{
    out[0] = in[0];
    if (colour)
        out[1] = in[1];
}

void brume_resolve_span(const struct brume_frame *frame,
                        struct brume_state *state, uint32_t x, uint32_t y,
                        uint32_t n)
{
    const struct brume_frame *f = frame;
    const bool colour = brume_has_colour(f);
    for (uint32_t i = x; i < x + n; i++) {
        struct brume_sample in[BRUME_LAYERS], h[BRUME_LAYERS];
        /* That of a neighbour when the ray was not marched. */
        uint32_t from = brume_lattice_index(f, i, y);
        in[0] = *brume_sample_at(f, state, from, 0);
        if (colour)
            in[BRUME_LAYERS - 1] = *brume_sample_at(f, state, from, 1);
        copy_ray(h, in, colour);
        uint32_t depth = in->depth, alpha, age = brume_age_of(f, i, y);
        /* One that weighs all has no use for history. */
        if (state->frames == 0 || (age == 0 && f->alpha == 0x10000u) ||
            !history_of(f, state, i, y, in, h, &alpha, colour))
            alpha = 0x10000u;
        else if (age > 0)
            copy_ray(in, h, colour);
        else
            alpha = weight_of_turn(f, state, alpha);
        if (!state->still)
            h->depth = in->depth = (uint16_t)depth;
        brume_history_put(f, state, state->now, i, y, h, in, alpha);
        if (colour)
            brume_layer_put(f, state, state->now, i, y, h + 1, in + 1, alpha,
                            1);
    }
}

#endif
