/* SPDX-License-Identifier: MIT */
/*
 * The march in lanes: core/brume_march.c for many rays at once. Compiled for
 * each kind of lanes under another WIDE_NAME; see wide.h.
 *
 * A group is the rays of a small tile, one a lane. A wave is up to LOOKUPS
 * groups, all of which a step moves by one sample or leap; a group whose rays
 * have all ended gives its place to the next. Lit samples are not lit at once:
 * they wait in a queue until there are enough to fill all lanes. That changes
 * no byte, as the light of a ray is a sum.
 */
#include "wide_lookup.h"
#include "wide_rays.h"

#define TILE_WIDTH 4u
#define TILE_HEIGHT (WIDE_LANES / TILE_WIDTH)
#define PATCH_WIDTH 64u
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
    uint32_t count;
} __attribute__((aligned(64)));

/* The rays of a rectangle, group by group, and the groups under way. */
struct patch {
    const struct wide_copy *copy;
    void (*light)(const struct brume_frame *f, struct patch *b, bool all);
    uint32_t count; /* groups of the wave: numbers of their first rays */
    uint32_t first[LOOKUPS];
    struct lookups lookups;
    struct queue queue;
    uint32_t p[3] ROOM(PATCH), move[3] ROOM(PATCH);
    uint32_t inverse[3] ROOM(PATCH); /* floats: (1 - 2^-20) / |move| */
    uint32_t left ROOM(PATCH);       /* samples in the pool; 0 when ended */
    uint32_t samples ROOM(PATCH);    /* that there were; of the ray */
    uint32_t t ROOM(PATCH);          /* of the first */
    uint32_t transmittance ROOM(PATCH), moment ROOM(PATCH), light_of ROOM(PATCH);
    uint32_t light_first[3] ROOM(PATCH), light_samples ROOM(PATCH); /* if jittered */
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
LANES_INLINE lanes leap_lanes(const struct brume_frame *f, const lanes p[3],
                              const lanes move[3], const lanes inverse[3],
                              lanes cell, struct kernel k)
{
    uint32_t margin = k.trilinear ? f->leap_margin : 0;
    lanes far = (cell << 19) - (1u << 19);
    lanes_float n = way_of(p[0], move[0], far, margin, inverse[0]);
    n = lanes_min_float(n, way_of(p[1], move[1], far, margin, inverse[1]));
    n = lanes_min_float(n, way_of(p[2], move[2], far, margin, inverse[2]));
    return lanes_from_float(n) + 1u;
}

/// Light ///

/* Sum of d * 2^i over the samples in the pool. */
LANES_INLINE lanes sum_log_lanes(const struct brume_frame *f,
                                 const struct wide_copy *c, struct lookups *l,
                                 const struct light_lanes *light,
                                 const lanes p[3], lanes_mask wanted,
                                 struct kernel k)
{
    lanes sum = lanes_of(0);
    uint32_t n;
    for (n = 0; n < f->light_samples; n++) {
        lanes at[3];
        for (int i = 0; i < 3; i++)
            at[i] = p[i] + (light->first[i] << n);
        wanted = mask_and(wanted, inside_lanes(f, at[0], at[1], at[2]));
        wanted = mask_and(wanted, mask_less(lanes_of(n), light->samples));
        if (!mask_any(wanted))
            break;
        want(l, n, f, c, at, wanted, k);
    }
    look_up(l, n, f, c, k);
    for (uint32_t i = 0; i < n; i++)
        sum += lanes_load(l->d[i]) << i;
    return sum;
}

LANES_INLINE lanes sun_transmittances(const struct brume_frame *f, lanes sum)
{
    lanes_mask black = mask_less(lanes_of(f->tau_limit), sum);
    lanes tau = lanes_mul_hi(sum << f->tau_shift, lanes_of(f->tau_m)) + 1u;
    tau = lanes_unless(black, tau >> 1);
    lanes s = gather_halves(brume_exp_coarse, tau >> 8) *
              gather_halves(brume_exp_fine, tau & 255u);
    return lanes_unless(black, s);
}

/* Adds the light of samples whose sums are known, from number `at` of the
 * queue on, to their rays. */
LANES_INLINE void add_light(const struct brume_frame *f, struct patch *b,
                            uint32_t at, uint32_t n, lanes sum)
{
    uint32_t got[WIDE_LANES] __attribute__((aligned(64)));
    lanes lost = lanes_load(b->queue.lost + at);
    lanes_spill(got, lanes_mul_hi(lost, sun_transmittances(f, sum)));
    for (uint32_t i = 0; i < n; i++)
        b->light_of[b->queue.ray[at + i]] += got[i];
}

LANES_INLINE void light_log(const struct brume_frame *f,
                            const struct wide_copy *c, struct patch *b,
                            uint32_t at, uint32_t n, struct kernel k)
{
    const struct queue *q = &b->queue;
    lanes_mask wanted = mask_first(n);
    struct light_lanes light;
    lanes p[3];
    if (f->jitter & BRUME_JITTER_LIGHT) {
        lanes ray = lanes_where(wanted, lanes_load(q->ray + at));
        for (int i = 0; i < 3; i++)
            light.first[i] = gather_words(b->light_first[i], ray);
        light.samples = gather_words(b->light_samples, ray);
    } else {
        for (int i = 0; i < 3; i++)
            light.first[i] = lanes_of((uint32_t)f->light.first[i]);
        light.samples = lanes_of(f->light.samples);
    }
    for (int i = 0; i < 3; i++)
        p[i] = lanes_load(q->p[i] + at);
    add_light(f, b, at, n,
              sum_log_lanes(f, c, &b->lookups, &light, p, wanted, k));
}

/* Samples on their way to the sun at equal distances, by groups of the queue. */
struct light_wave {
    uint32_t p[3][LOOKUPS][WIDE_LANES], left[LOOKUPS][WIDE_LANES];
    uint32_t sum[LOOKUPS][WIDE_LANES];
    uint32_t first[LOOKUPS]; /* of the queue's */
    uint32_t count;
} __attribute__((aligned(64)));

LANES_INLINE void fill_light_wave(const struct brume_frame *f,
                                  struct light_wave *w, const struct queue *q,
                                  uint32_t *next, uint32_t end)
{
    for (; *next < end && w->count < LOOKUPS; *next += WIDE_LANES) {
        uint32_t g = w->count++, at = *next;
        lanes_mask valid = mask_less(lanes_count(), lanes_of(end - at));
        w->first[g] = at;
        for (int i = 0; i < 3; i++)
            lanes_store(w->p[i][g], lanes_load(q->p[i] + at) +
                                        (uint32_t)f->light.first[i]);
        lanes_store(w->left[g],
                    lanes_where(valid, lanes_of(f->light.samples)));
        lanes_store(w->sum[g], lanes_of(0));
    }
}

/* One group of a step, to number `to` of the wave. False when it has ended:
 * then its sums are in place. */
LANES_INLINE bool step_light_group(const struct brume_frame *f,
                                   const struct wide_copy *c,
                                   struct light_wave *w, struct lookups *l,
                                   uint32_t g, uint32_t to, uint32_t *sums,
                                   struct kernel k)
{
    const struct brume_line *line = &f->light_line;
    lanes left = lanes_load(w->left[g]), m = lanes_of(1), move[3], p[3];
    lanes sum = lanes_load(w->sum[g]) + lanes_load(l->d[g]), inverse[3];
    for (int i = 0; i < 3; i++) {
        p[i] = lanes_load(w->p[i][g]);
        move[i] = lanes_of((uint32_t)line->move[i]);
    }
    lanes_mask on = mask_and(mask_less(lanes_of(0), left),
                             inside_lanes(f, p[0], p[1], p[2]));
    lanes cell = cells_to_leap(l, g, f, c, p, on, k);
    lanes_mask empty = mask_and(on, mask_high(cell));
    if (mask_any(empty)) {
        for (int i = 0; i < 3; i++)
            inverse[i] = inverse_of(move[i], f->skip);
        m = lanes_select(empty, leap_lanes(f, p, move, inverse, cell, k), m);
    }
    on = mask_and(on, mask_less(m, left));
    if (!mask_any(on)) {
        lanes_store(sums + w->first[g], sum);
        return false;
    }
    w->first[to] = w->first[g];
    for (int i = 0; i < 3; i++)
        lanes_store(w->p[i][to], p[i] + m * move[i]);
    lanes_store(w->left[to], lanes_where(on, left - m));
    lanes_store(w->sum[to], sum);
    return true;
}

LANES_INLINE void light_uniform(const struct brume_frame *f,
                                const struct wide_copy *c, struct patch *b,
                                uint32_t end, struct kernel k)
{
    struct light_wave w;
    struct lookups *l = &b->lookups;
    uint32_t sums ROOM(QUEUE), next = 0;
    w.count = 0;
    for (;;) {
        fill_light_wave(f, &w, &b->queue, &next, end);
        if (w.count == 0)
            break;
        for (uint32_t g = 0; g < w.count; g++) {
            lanes p[3], left = lanes_load(w.left[g]);
            for (int i = 0; i < 3; i++)
                p[i] = lanes_load(w.p[i][g]);
            want(l, g, f, c, p,
                 mask_and(mask_less(lanes_of(0), left),
                          inside_lanes(f, p[0], p[1], p[2])),
                 k);
        }
        look_up(l, w.count, f, c, k);
        uint32_t to = 0;
        for (uint32_t g = 0; g < w.count; g++)
            to += step_light_group(f, c, &w, l, g, to, sums, k);
        w.count = to;
    }
    for (uint32_t at = 0; at < end; at += WIDE_LANES)
        add_light(f, b, at, end - at < WIDE_LANES ? end - at : WIDE_LANES,
                  lanes_load(sums + at));
}

/* Lights what waits, but for less than a vector; or all. */
LANES_INLINE void light_queue(const struct brume_frame *f,
                              const struct wide_copy *c, struct patch *b,
                              bool all, struct kernel k)
{
    struct queue *q = &b->queue;
    uint32_t end = all ? q->count : q->count / WIDE_LANES * WIDE_LANES;
    uint32_t rest = q->count - end;
    if (k.uniform)
        light_uniform(f, c, b, end, k);
    else
        for (uint32_t at = 0; at < end; at += WIDE_LANES)
            light_log(f, c, b, at, end - at < WIDE_LANES ? end - at : WIDE_LANES,
                      k);
    if (rest != 0) {
        for (int i = 0; i < 3; i++)
            lanes_store(q->p[i], lanes_load(q->p[i] + end));
        lanes_store(q->lost, lanes_load(q->lost + end));
        lanes_store(q->ray, lanes_load(q->ray + end));
    }
    q->count = rest;
}

/// View ///

LANES_INLINE lanes opacities(const struct brume_frame *f, lanes d,
                             struct kernel k)
{
    if (is_narrow(k))
        return gather_words(f->table, d);
    return ~lanes_mul_hi(gather_words(f->table, d >> 8),
                         gather_words(f->table, (d & 255u) + 256u));
}

LANES_INLINE void push(struct queue *q, const lanes p[3], lanes lost, lanes ray,
                       lanes_mask lit)
{
    uint32_t at = q->count;
    for (int i = 0; i < 3; i++)
        lanes_pack(q->p[i] + at, p[i], lit);
    lanes_pack(q->lost + at, lost, lit);
    lanes_pack(q->ray + at, ray, lit);
    q->count = at + (uint32_t)__builtin_popcount(mask_bits(lit));
}

/* What the densities of group g do to its rays, which are those from number
 * `ray` on. False when all have ended. */
LANES_INLINE bool step_group(const struct brume_frame *f,
                             const struct wide_copy *c, struct patch *b,
                             uint32_t g, uint32_t ray, struct kernel k)
{
    lanes left = lanes_load(b->left + ray), d = lanes_load(b->lookups.d[g]);
    lanes m = lanes_of(1), p[3], move[3], inverse[3];
    lanes_mask on = mask_less(lanes_of(0), left);
    lanes_mask lit = mask_less(lanes_of(f->min_density), d);
    for (int i = 0; i < 3; i++) {
        p[i] = lanes_load(b->p[i] + ray);
        move[i] = lanes_load(b->move[i] + ray);
    }
    if (mask_any(lit)) {
        lanes transmittance = lanes_load(b->transmittance + ray);
        lanes lost = lanes_where(
            lit, lanes_mul_hi(transmittance, opacities(f, d, k)));
        push(&b->queue, p, lost, lanes_count() + ray, lit);
        transmittance -= lost;
        lanes_store(b->transmittance + ray, transmittance);
        if (f->depth) {
            lanes index = lanes_load(b->samples + ray) - left;
            lanes_store(b->moment + ray, lanes_load(b->moment + ray) +
                                             lanes_mul_hi(lost, index << 12));
        }
        lanes_mask dark =
            mask_less(transmittance, lanes_of(f->min_transmittance));
        on = mask_less_those(on, mask_and(lit, dark));
    }
    lanes cell = cells_to_leap(&b->lookups, g, f, c, p, on, k);
    lanes_mask empty = mask_high(cell);
    if (mask_any(empty)) {
        for (int i = 0; i < 3; i++)
            inverse[i] = lanes_load(b->inverse[i] + ray);
        m = lanes_select(empty, leap_lanes(f, p, move, inverse, cell, k), m);
        for (int i = 0; i < 3; i++)
            move[i] *= m;
    }
    on = mask_and(on, mask_less(m, left));
    lanes_store(b->left + ray, lanes_where(on, left - m));
    for (int i = 0; i < 3; i++)
        lanes_store(b->p[i] + ray, p[i] + move[i]);
    return mask_any(on);
}

/* Moves the wave by one sample or leap. */
LANES_INLINE void step_wave(const struct brume_frame *f,
                            const struct wide_copy *c, struct patch *b,
                            struct kernel k)
{
    for (uint32_t g = 0; g < b->count; g++) {
        uint32_t ray = b->first[g];
        lanes p[3], left = lanes_load(b->left + ray);
        for (int i = 0; i < 3; i++)
            p[i] = lanes_load(b->p[i] + ray);
        want(&b->lookups, g, f, c, p, mask_less(lanes_of(0), left), k);
    }
    look_up(&b->lookups, b->count, f, c, k);
    uint32_t to = 0;
    for (uint32_t g = 0; g < b->count; g++) {
        uint32_t ray = b->first[g];
        b->first[to] = ray;
        to += step_group(f, c, b, g, ray, k);
    }
    b->count = to;
    if (b->queue.count >= QUEUE - WAVE)
        b->light(f, b, false);
}

/// Kernels ///

/* Tells the compiler that there is one. */
LANES_INLINE const struct wide_copy *some_copy(const struct wide_copy *c)
{
    if (c == NULL)
        __builtin_unreachable();
    return c;
}

struct march_kernel {
    void (*light)(const struct brume_frame *f, struct patch *b, bool all);
    void (*step)(const struct brume_frame *f, struct patch *b);
};

/* A kernel of its own for each lookup and light; what it reads are the asset's
 * bricks, or copies (1). Of copies, halves serve u8r and u4r, clamped or not:
 * max_density is then above all densities. */
#define NAME(what, format, apron, tri, uni, clamp, copied) \
    what##_##format##_##apron##tri##uni##clamp##copied
#define KERNEL(format, apron, tri, uni, clamp, copied) \
    static void NAME(light, format, apron, tri, uni, clamp, copied)( \
        const struct brume_frame *f, struct patch *b, bool all) \
    { \
        static const struct kernel k = {format, 8 + apron, tri, uni, clamp}; \
        light_queue(f, copied ? some_copy(b->copy) : NULL, b, all, k); \
    } \
    static void NAME(step, format, apron, tri, uni, clamp, copied)( \
        const struct brume_frame *f, struct patch *b) \
    { \
        static const struct kernel k = {format, 8 + apron, tri, uni, clamp}; \
        step_wave(f, copied ? some_copy(b->copy) : NULL, b, k); \
    }
#define DIRECT_CLAMP(format, apron, tri, uni) \
    KERNEL(format, apron, tri, uni, 0, 0) KERNEL(format, apron, tri, uni, 1, 0)
#define DIRECT_LIGHT(format, apron, tri) \
    DIRECT_CLAMP(format, apron, tri, 0) DIRECT_CLAMP(format, apron, tri, 1)
#define DIRECT_LOOKUP(format, apron) \
    DIRECT_LIGHT(format, apron, 0) DIRECT_LIGHT(format, apron, 1)
#define DIRECT(format) DIRECT_LOOKUP(format, 0) DIRECT_LOOKUP(format, 1)
#define COPIED(uni) \
    KERNEL(BRUME_U8, 0, 0, uni, 0, 1) \
    KERNEL(BRUME_U8, 0, 0, uni, 1, 1) \
    KERNEL(BRUME_U8R, 0, 0, uni, 1, 1) \
    KERNEL(BRUME_U8, 1, 1, uni, 0, 1) \
    KERNEL(BRUME_U8R, 0, 1, uni, 0, 1) \
    KERNEL(BRUME_U8R, 1, 1, uni, 0, 1) \
    KERNEL(BRUME_U8R, 0, 1, uni, 1, 1)
#ifdef QUICK
#define ALL_KERNELS \
    KERNEL(BRUME_U8, 0, 0, 0, 0, 0) KERNEL(BRUME_U8, 0, 0, 1, 0, 0) \
    KERNEL(BRUME_U8, 1, 1, 0, 0, 0) KERNEL(BRUME_U8, 0, 1, 0, 0, 0) \
    COPIED(0) COPIED(1)
#else
#define ALL_KERNELS \
    DIRECT(BRUME_U8) DIRECT(BRUME_U8R) DIRECT(BRUME_U4R) COPIED(0) COPIED(1)
#endif

ALL_KERNELS

#undef KERNEL
#define KERNEL(format, apron, tri, uni, clamp, copied) \
    [(copied) << 6 | (format) << 4 | (apron) << 3 | (tri) << 2 | (uni) << 1 | \
     (clamp)] = {NAME(light, format, apron, tri, uni, clamp, copied), \
                 NAME(step, format, apron, tri, uni, clamp, copied)},

static const struct march_kernel k_kernels[128] = {ALL_KERNELS};

/* The kernel for a frame, by copies if it can be. */
static const struct march_kernel *kernel_of(const struct brume_frame *f,
                                            const struct wide_copy *c)
{
    uint32_t id = f->kernel, uniform = id & 2u;
    bool u8 = f->volume->format == BRUME_U8, apron = f->volume->side == 9;
    bool trilinear = id & 4u, clamp = id & 1u;
    const struct march_kernel *direct = &k_kernels[id];
    const struct march_kernel *copied = &k_kernels[64 + uniform];
    if (c == NULL)
        return direct;
    if (!trilinear && u8)
        return c->bytes ? copied + (BRUME_U8 << 4) + clamp : direct;
    if (!trilinear)
        return c->halves ? copied + (BRUME_U8R << 4) + 1 : direct;
    if (clamp)
        return c->halves ? copied + (BRUME_U8R << 4) + 5 : direct;
    if (u8)
        return c->octets ? copied + (BRUME_U8 << 4) + 12 : direct;
    if (!c->octets || !c->ranges || (!apron && !c->halves))
        return direct;
    return copied + (BRUME_U8R << 4) + (apron ? 12 : 4);
}

/// Patches ///

/* Makes the rays of a tile, whose numbers are from `ray` on; lanes that are not
 * wanted have none. */
static void add_rays(const struct brume_frame *f, struct patch *b, uint32_t ray,
                     lanes x, lanes y, lanes_mask wanted)
{
    struct rays r;
    struct light_lanes light = {0};
    begin_lanes(&r, &light, f, x, y, wanted);
    lanes_store(b->light_of + ray, lanes_of(0));
    lanes_store(b->transmittance + ray, lanes_of(1u << 31));
    lanes_store(b->moment + ray, lanes_of(0));
    if (!mask_any(r.alive))
        return;
    b->first[b->count++] = ray;
    if (f->jitter & BRUME_JITTER_LIGHT) {
        for (int i = 0; i < 3; i++)
            lanes_store(b->light_first[i] + ray, light.first[i]);
        lanes_store(b->light_samples + ray, light.samples);
    }
    for (int i = 0; i < 3; i++) {
        lanes_store(b->p[i] + ray, r.position[i]);
        lanes_store(b->move[i] + ray, r.move[i]);
        lanes_store(b->inverse[i] + ray, inverse_of(r.move[i], f->skip));
    }
    lanes_store(b->t + ray, r.t);
    lanes_store(b->left + ray, lanes_where(r.alive, r.left));
    lanes_store(b->samples + ray, r.left);
}

/* depth_of */
static uint32_t mean_depth(const struct brume_frame *f, uint32_t t,
                           uint32_t moment, uint32_t lost)
{
    const uint32_t cap = 0xffdfffffu;
    if (lost == 0)
        return BRUME_NO_DEPTH;
    struct brume_number way =
        brume_number_mul(brume_number_of(moment, 20),
                         brume_number_inverse(brume_number_of(lost, 0)));
    way = brume_number_mul(way, brume_number_of(f->step, 0));
    uint32_t further = brume_number_floor(way, 0);
    return brume_depth_code(t < cap && further < cap - t ? t + further : cap);
}

/* The w x h rays of a tile. */
static void store_rays(const struct brume_frame *f, const struct patch *b,
                       uint32_t ray, uint32_t w, uint32_t h,
                       struct brume_radiance *out, size_t stride)
{
    for (uint32_t n = 0; n < WIDE_LANES; n++, ray++) {
        uint32_t i = n % TILE_WIDTH, j = n / TILE_WIDTH;
        if (i >= w || j >= h)
            continue;
        struct brume_radiance *o = out + j * stride + i;
        uint32_t light = b->light_of[ray];
        uint32_t transmittance = b->transmittance[ray];
        o->light = (mul_hi_floor(light << 2, f->albedo << 2) + 1u) >> 1;
        o->transmittance = (transmittance + 0x4000u) >> 15;
        o->depth = 0;
        if (f->depth)
            o->depth = mean_depth(f, b->t[ray], b->moment[ray],
                                  (1u << 31) - transmittance);
    }
}

static void march_patch(const struct brume_frame *f, struct patch *b,
                        uint32_t x, uint32_t y, uint32_t w, uint32_t h,
                        struct brume_radiance *out, size_t stride)
{
    const struct march_kernel *k = kernel_of(f, b->copy);
    lanes column = lanes_count() % TILE_WIDTH, row = lanes_count() / TILE_WIDTH;
    uint32_t ray = 0;
    b->light = k->light;
    b->count = b->queue.count = 0;
    for (uint32_t j = 0; j < h; j += TILE_HEIGHT)
        for (uint32_t i = 0; i < w; i += TILE_WIDTH, ray += WIDE_LANES) {
            lanes_mask wanted = mask_and(mask_less(column, lanes_of(w - i)),
                                         mask_less(row, lanes_of(h - j)));
            add_rays(f, b, ray, column + (x + i), row + (y + j), wanted);
            while (b->count == LOOKUPS)
                k->step(f, b);
        }
    while (b->count != 0)
        k->step(f, b);
    k->light(f, b, true);
    ray = 0;
    for (uint32_t j = 0; j < h; j += TILE_HEIGHT)
        for (uint32_t i = 0; i < w; i += TILE_WIDTH, ray += WIDE_LANES)
            store_rays(f, b, ray, w - i, h - j, out + j * stride + i, stride);
}

#ifndef WIDE_NAME
#define WIDE_NAME wide_march_avx512
#endif
void WIDE_NAME(const struct wide_copy *copy, const struct brume_frame *frame,
               unsigned x, unsigned y, unsigned w, unsigned h,
               struct brume_radiance *out, size_t stride);
void WIDE_NAME(const struct wide_copy *copy, const struct brume_frame *frame,
               unsigned x, unsigned y, unsigned w, unsigned h,
               struct brume_radiance *out, size_t stride)
{
    struct patch b;
    b.copy = copy;
    for (unsigned j = 0; j < h; j += PATCH_HEIGHT)
        for (unsigned i = 0; i < w; i += PATCH_WIDTH)
            march_patch(frame, &b, x + i, y + j,
                        w - i < PATCH_WIDTH ? w - i : PATCH_WIDTH,
                        h - j < PATCH_HEIGHT ? h - j : PATCH_HEIGHT,
                        out + j * stride + i, stride);
}
