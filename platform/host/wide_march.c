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
#include "wide_fog_view.h"

/// View ///

/* The samples of group g, whose rays are those from number `ray` on. False
 * when all have ended. */
LANES_INLINE bool step_group(const struct brume_frame *f,
                             const struct source *s, struct patch *b,
                             uint32_t g, uint32_t ray, bool lit,
                             struct kernel k)
{
    const bool glows = lit && f->lit.emits;
    if (lit && f->lit.fog.on)
        return fog_group(f, b, g, ray);
    lanes left = lanes_load(b->left + ray), m = lanes_of(1);
    lanes p[3], move[3], inverse[3];
    lanes_mask on = mask_less(lanes_of(0), left);
    for (int i = 0; i < 3; i++) {
        p[i] = lanes_load(b->p[i] + ray);
        move[i] = lanes_load(b->move[i] + ray);
    }
    if (glows) {
        on = glow_group(f, b, g, ray);
        for (int i = 0; i < 3; i++)
            p[i] += (AHEAD_VIEW - 1) * move[i];
    }
    for (uint32_t n = 0; !glows; n++) {
        lanes d = lanes_load(b->lookups.d[g * AHEAD_VIEW + n]);
        on = lose_light(f, b, ray, p, left - n, d, on, lit, k);
        if (n == AHEAD_VIEW - 1)
            break;
        for (int i = 0; i < 3; i++)
            p[i] += move[i];
    }
    on = mask_and(on, mask_less(lanes_of(AHEAD_VIEW - 1), left));
    left -= AHEAD_VIEW - 1;
    lanes cell = cells_to_leap(&b->lookups, g * AHEAD_VIEW + AHEAD_VIEW - 1, s,
                               p, on, k);
    lanes_mask empty = mask_high(cell);
    if (mask_any(empty)) {
        for (int i = 0; i < 3; i++)
            inverse[i] = lanes_load(b->inverse[i] + ray);
        m = lanes_select(empty, leap_lanes(s, p, move, inverse, cell, k), m);
        for (int i = 0; i < 3; i++)
            move[i] *= m;
    }
    on = mask_and(on, mask_less(m, left));
    lanes_store(b->left + ray, lanes_where(on, left - m));
    for (int i = 0; i < 3; i++)
        lanes_store(b->p[i] + ray, p[i] + move[i]);
    return mask_any(on);
}

/* Wants the next samples of group g; beside the ray where lookups are
 * stochastic. */
LANES_INLINE void want_group(const struct source *s, struct patch *b,
                             uint32_t g, bool beside, struct kernel k)
{
    uint32_t ray = b->first[g];
    lanes p[3], moved[3], left = lanes_load(b->left + ray);
    for (int i = 0; i < 3; i++) {
        p[i] = lanes_load(b->p[i] + ray);
        moved[i] = lanes_of(0);
    }
    for (uint32_t n = 0; n < AHEAD_VIEW; n++) {
        if (beside)
            moves_of(moved, b, ray, lanes_load(b->samples + ray) - left + n);
        want_moved(&b->lookups, g * AHEAD_VIEW + n, s, p, moved,
                   mask_less(lanes_of(n), left), k);
        for (int i = 0; i < 3; i++)
            p[i] += lanes_load(b->move[i] + ray);
    }
}

/* Moves the wave by some samples, and perhaps a leap. */
LANES_INLINE void step_wave(const struct brume_frame *f,
                            const struct wide_copy *c, struct patch *b,
                            bool lit, struct kernel k)
{
    struct source s = source_of(f, c, lit, k);
    for (uint32_t g = 0; g < b->count; g++)
        if (s.stochastic)
            want_group(&s, b, g, true, k);
        else
            want_group(&s, b, g, false, k);
    look_up(&b->lookups, b->count * AHEAD_VIEW, &s, k);
    uint32_t to = 0;
    for (uint32_t g = 0; g < b->count; g++) {
        uint32_t ray = b->first[g];
        b->first[to] = ray;
        to += step_group(f, &s, b, g, ray, lit, k);
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
    lanes (*sum_ways)(const struct brume_frame *f, struct patch *b,
                      uint32_t at);
};

/* A kernel of its own for each lookup and light. How rays move does not depend
 * on whether light is uniform: of each two kernels, the step of the second is
 * that of frames with lighting instead. What it reads are the asset's bricks,
 * or copies (1). Of copies, halves and what has ranges are u8r, whatever the
 * asset is; halves are of kernels that clamp, to something above all densities
 * where the frame does not; and aprons are those of bricks without one. */
#define NAME(what, format, apron, tri, uni, clamp, copied) \
    what##_##format##_##apron##tri##uni##clamp##copied
#define KERNEL(format, apron, tri, uni, clamp, copied) \
    static void NAME(light, format, apron, tri, uni, clamp, copied)( \
        const struct brume_frame *f, struct patch *b, bool all) \
    { \
        static const struct kernel k = \
            KERNEL_OF(format, apron, tri, uni, clamp); \
        light_queue(f, copied ? some_copy(b->copy) : NULL, b, all, k); \
    } \
    static void NAME(step, format, apron, tri, uni, clamp, \
                     copied)(const struct brume_frame *f, struct patch *b) \
    { \
        static const struct kernel k = \
            KERNEL_OF(format, apron, tri, uni, clamp); \
        step_wave(f, copied ? some_copy(b->copy) : NULL, b, uni, k); \
    } \
    static lanes NAME(ways, format, apron, tri, uni, clamp, copied)( \
        const struct brume_frame *f, struct patch *b, uint32_t at) \
    { \
        static const struct kernel k = \
            KERNEL_OF(format, apron, tri, uni, clamp); \
        struct source s = \
            source_of(f, copied ? some_copy(b->copy) : NULL, true, k); \
        return sum_of_ways(f, &s, b, at, k); \
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
    KERNEL(BRUME_U8, 0, 1, uni, 0, 1) \
    KERNEL(BRUME_U8R, 0, 1, uni, 0, 1) \
    KERNEL(BRUME_U8R, 1, 1, uni, 0, 1) \
    KERNEL(BRUME_U8R, 0, 1, uni, 1, 1)
#define ALL_KERNELS \
    DIRECT(BRUME_U8) DIRECT(BRUME_U8R) DIRECT(BRUME_U4R) COPIED(0) COPIED(1)

ALL_KERNELS

#undef KERNEL
#define KERNEL(format, apron, tri, uni, clamp, copied) \
    [(copied) << 6 | (format) << 4 | (apron) << 3 | (tri) << 2 | (uni) << 1 | \
        (clamp)] = {NAME(light, format, apron, tri, uni, clamp, copied), \
                    NAME(step, format, apron, tri, uni, clamp, copied), \
                    NAME(ways, format, apron, tri, uni, clamp, copied)},

static const struct march_kernel k_kernels[128] = {ALL_KERNELS};

/* The kernel for a frame, by copies if it can be; the first or, with 2, the
 * second of its pair. */
static const struct march_kernel *kernel_of(const struct brume_frame *f,
                                            const struct wide_copy *c,
                                            uint32_t second)
{
    uint32_t id = (f->kernel & ~2u) | second;
    bool u8 = f->volume->format == BRUME_U8, apron = f->volume->side == 9;
    bool trilinear = id & 4u, clamp = id & 1u;
    const struct march_kernel *direct = &k_kernels[id];
    const struct march_kernel *copied = &k_kernels[64 + second];
    if (c == NULL)
        return direct;
    if (!trilinear && u8)
        return c->bytes ? copied + (BRUME_U8 << 4) + clamp : direct;
    if (!trilinear)
        return c->halves ? copied + (BRUME_U8R << 4) + 1 : direct;
    if (clamp)
        return c->half_aprons ? copied + (BRUME_U8R << 4) + 5 : direct;
    if (u8)
        return c->aprons ? copied + (BRUME_U8 << 4) + 4 : direct;
    if (!c->aprons || !c->ranges || (!apron && !c->half_aprons))
        return direct;
    return copied + (BRUME_U8R << 4) + (apron ? 12 : 4);
}

/// Patches ///

/* Rays of a tile that have met nothing yet. */
static void clear_rays(const struct brume_frame *f, struct patch *b,
                       uint32_t ray)
{
    for (uint32_t i = 0; i < f->lit.octaves; i++)
        lanes_store(b->sun[i] + ray, lanes_of(0));
    if (f->lit.on)
        clear_lit(b, ray);
    lanes_store(b->transmittance + ray, lanes_of(1u << 31));
    lanes_store(b->moment + ray, lanes_of(0));
}

/* Makes the rays of a tile, whose numbers are from `ray` on; lanes that are not
 * wanted have none. */
static void add_rays(const struct brume_frame *f, struct patch *b, uint32_t ray,
                     lanes x, lanes y, lanes_mask wanted)
{
    struct rays r;
    lanes light_first[3] = {{0}};
    begin_lanes(&r, light_first, f, x, y, wanted);
    if (!mask_any(r.alive))
        return;
    b->first[b->count++] = ray;
    if (f->lit.on)
        add_lit_rays(f, b, ray, r);
    if (f->jitter & BRUME_JITTER_LIGHT)
        for (int i = 0; i < 3; i++)
            lanes_store(b->light_first[i] + ray, light_first[i]);
    lanes_store(b->t + ray, r.t);
    for (int i = 0; i < 3; i++) {
        lanes_store(b->p[i] + ray, r.position[i]);
        lanes_store(b->move[i] + ray, r.move[i]);
        lanes_store(b->inverse[i] + ray, inverse_of(r.move[i], f->skip));
    }
    lanes_store(b->left + ray, lanes_where(r.alive, r.left));
    lanes_store(b->samples + ray, r.left);
    if (f->lit.fog.on)
        add_fog_rays(f, b, ray, &r);
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
        uint32_t light = b->sun[0][ray];
        uint32_t transmittance = b->transmittance[ray];
        o->light = (mul_hi_floor(light << 2, f->albedo << 2) + 1u) >> 1;
        o->transmittance = (transmittance + 0x4000u) >> 15;
        o->depth = 0;
#if BRUME_WITH_COLOUR
        o->green = o->blue = 0;
#endif
        if (f->depth)
            o->depth = brume_mean_depth(f, b->t[ray], b->moment[ray],
                                        (1u << 31) - transmittance);
        if (f->lit.on && transmittance != 1u << 31)
            finish_lit(f, b, ray, o);
    }
}

/* Do the rays of four tiles, or what there is of them, all pass the pool by? */
static bool tiles_miss(const struct brume_frame *f, uint32_t x, uint32_t y,
                       uint32_t w, uint32_t h)
{
    for (uint32_t j = 0; j < TILE_HEIGHT && j < h; j++)
        if (!brume_rays_miss(f, x, y + j,
                             w < 4 * TILE_WIDTH ? w : 4 * TILE_WIDTH))
            return false;
    return true;
}

static void march_patch(const struct brume_frame *f, struct patch *b,
                        uint32_t x, uint32_t y, uint32_t w, uint32_t h,
                        struct brume_radiance *out, size_t stride)
{
    bool uniform = f->lit.on ? f->lit.light == BRUME_UNIFORM
                             : f->light_kind == BRUME_UNIFORM;
    const struct march_kernel *k = kernel_of(f, b->copy, f->lit.on ? 2u : 0);
    const struct march_kernel *light = kernel_of(f, b->copy, uniform ? 2u : 0);
    lanes column = lanes_count() % TILE_WIDTH, row = lanes_count() / TILE_WIDTH;
    uint32_t ray = 0;
    bool miss = false;
    b->light = light->light;
    b->sum_ways = k->sum_ways;
    b->count = b->queue.count = 0;
    for (uint32_t j = 0; j < h; j += TILE_HEIGHT)
        for (uint32_t i = 0; i < w; i += TILE_WIDTH, ray += WIDE_LANES) {
            lanes_mask wanted = mask_and(mask_less(column, lanes_of(w - i)),
                                         mask_less(row, lanes_of(h - j)));
            if (i % (4 * TILE_WIDTH) == 0)
                miss = tiles_miss(f, x + i, y + j, w - i, h - j);
            clear_rays(f, b, ray);
            if (!miss)
                add_rays(f, b, ray, column + (x + i), row + (y + j), wanted);
            while (b->count == LOOKUPS / AHEAD_VIEW)
                k->step(f, b);
        }
    while (b->count != 0)
        k->step(f, b);
    b->light(f, b, true);
    ray = 0;
    for (uint32_t j = 0; j < h; j += TILE_HEIGHT)
        for (uint32_t i = 0; i < w; i += TILE_WIDTH, ray += WIDE_LANES)
            store_rays(f, b, ray, w - i, h - j, out + j * stride + i, stride);
}

void WIDE_NAME(const struct wide_copy *copy, const struct brume_frame *frame,
               unsigned x, unsigned y, unsigned w, unsigned h,
               struct brume_radiance *out, size_t stride);
void WIDE_NAME(const struct wide_copy *copy, const struct brume_frame *frame,
               unsigned x, unsigned y, unsigned w, unsigned h,
               struct brume_radiance *out, size_t stride)
{
    struct patch b;
    b.copy = copy;
    b.sums = NULL;
    begin_lit(frame, &b);
    for (unsigned j = 0; j < h; j += PATCH_HEIGHT)
        for (unsigned i = 0; i < w; i += PATCH_WIDTH)
            march_patch(frame, &b, x + i, y + j,
                        w - i < PATCH_WIDTH ? w - i : PATCH_WIDTH,
                        h - j < PATCH_HEIGHT ? h - j : PATCH_HEIGHT,
                        out + j * stride + i, stride);
}

/// Sums ///

#define PASTED(a, b) a##b
#define SUMS_OF(name) PASTED(name, _sums)

void SUMS_OF(WIDE_NAME)(const struct wide_copy *copy,
                        const struct brume_frame *frame, const uint32_t from[3],
                        uint32_t step, uint32_t n, uint32_t *sums);
void SUMS_OF(WIDE_NAME)(const struct wide_copy *copy,
                        const struct brume_frame *frame, const uint32_t from[3],
                        uint32_t step, uint32_t n, uint32_t *sums)
{
    const struct march_kernel *k = kernel_of(frame, copy, 2u);
    uint32_t got ROOM(QUEUE);
    struct patch b;
    b.copy = copy;
    b.sums = got;
    for (uint32_t done = 0; done < n; done += b.queue.count) {
        b.queue.count = n - done < QUEUE ? n - done : QUEUE;
        for (uint32_t i = 0; i < b.queue.count; i += WIDE_LANES) {
            lanes_store(b.queue.p[0] + i,
                        from[0] + (lanes_count() + (done + i)) * step);
            lanes_store(b.queue.p[1] + i, lanes_of(from[1]));
            lanes_store(b.queue.p[2] + i, lanes_of(from[2]));
        }
        uint32_t count = b.queue.count;
        k->light(frame, &b, true);
        memcpy(sums + done, got, count * sizeof *sums);
        b.queue.count = count;
    }
}
