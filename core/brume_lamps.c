/* SPDX-License-Identifier: MIT */
/*
 * Which lamps reach which part of the view: clusters of tiles and slices
 * (Olsson, Billeter and Assarsson, "Clustered Deferred and Forward Shading",
 * 2012). A lamp gives exactly nothing beyond its radius, and a cluster may hold
 * more lamps than reach it but never fewer: so clusters cannot be seen.
 *
 * Rays of a column of tiles lie between two planes through the eye, and so do
 * those of a row; depth is the largest of the three coordinates' distances from
 * the eye, which for a ray is that of one axis.
 */
#include "brume_inner.h"

#if BRUME_WITH_LAMPS

#define ONE_Q30 (1 << 30)
#define TILES BRUME_CLUSTER_SIDE
#define SLICES BRUME_CLUSTER_SLICES

/// Checking ///

static bool spot_is_good(const struct brume_lamp *p)
{
    return p->cos_outer == -ONE_Q30 ||
           (p->cos_outer > -ONE_Q30 && p->cos_outer <= p->cos_inner &&
            p->cos_inner <= ONE_Q30 &&
            (p->direction[0] | p->direction[1] | p->direction[2]) != 0);
}

static bool lamp_is_good(const struct brume_lamp *p)
{
    for (int i = 0; i < 3; i++)
        if (p->position[i] < -BRUME_MAX_COORDINATE ||
            p->position[i] > BRUME_MAX_COORDINATE || p->colour[i] > 256u << 16)
            return false;
    return p->radius >= 0x10000u && p->radius <= 16384u << 16 &&
           p->size >= 0x1000u && p->size <= p->radius &&
           p->shadow_samples <= 64 && spot_is_good(p);
}

int brume_lamps_check(const struct brume_scene *scene)
{
    const struct brume_lighting *l = scene->lighting;
    if (l == NULL || l->lamp_count == 0)
        return BRUME_OK;
    if (l->lamp_count > BRUME_MAX_LAMPS)
        return BRUME_ERR_SCENE;
    if (l->lamps == NULL || l->clusters == NULL)
        return BRUME_ERR_NULL;
    for (uint32_t i = 0; i < l->lamp_count; i++)
        if (!lamp_is_good(&l->lamps[i]))
            return BRUME_ERR_SCENE;
    return BRUME_OK;
}

/// Lamps ///

static void set_spot(struct brume_lit_lamp *out, const struct brume_lamp *in)
{
    out->spot = in->cos_outer != -ONE_Q30;
    out->cos_outer = in->cos_outer;
    out->cos_inner = in->cos_inner;
    if (!out->spot)
        return;
    for (int i = 0; i < 3; i++)
        out->direction[i] = in->direction[i];
    brume_normalise(out->direction);
    uint32_t range = (uint32_t)in->cos_inner - (uint32_t)in->cos_outer;
    if (range == 0)
        return;
    out->slope_shift = (uint8_t)leading_zeros(range);
    out->slope = brume_reciprocal(range << out->slope_shift);
}

/* The highest 32 bits of a square, and how many zeros are above them. */
static uint32_t mantissa_of(uint64_t square, uint8_t *zeros)
{
    uint32_t high = (uint32_t)(square >> 32), low = (uint32_t)square;
    uint32_t n = high != 0 ? leading_zeros(high) : 32u + leading_zeros(low);
    *zeros = (uint8_t)n;
    for (; n >= 32; n -= 32) {
        high = low;
        low = 0;
    }
    return high << n | low >> 1 >> (31u - n);
}

static void set_lengths(struct brume_lit_lamp *out, const struct brume_lamp *in)
{
    uint64_t square = brume_square((int32_t)(in->radius >> 1));
    out->radius_square = square;
    /* 2^63 / mantissa; one less, so that no quotient reaches 1 */
    out->per_radius =
        brume_reciprocal(mantissa_of(square, &out->radius_shift)) - 1u;
    out->size =
        mantissa_of(brume_square((int32_t)(in->size >> 1)), &out->size_shift);
}

/* The largest of the coordinates' distances from the eye, Q16.16. */
static uint32_t depth_of(const struct brume_frame *f,
                         const struct brume_lit_lamp *l)
{
    uint32_t most = 0;
    for (int i = 0; i < 3; i++) {
        uint32_t a = l->position[i], b = brume_halved((uint32_t)f->eye[i]);
        uint32_t m = a > b ? a - b : b - a;
        most = m > most ? m : most;
    }
    return most << 1;
}

static uint32_t sum_of(uint32_t a, uint32_t b)
{
    return a + b < a ? 0xffffffffu : a + b;
}

/* Farther than that from a lamp, Q16.16, no sample is that counts as within
 * its radius. Positions are off their ray by a quarter voxel at most where it
 * begins, and by half a unit per axis more with each sample since. */
static uint32_t reach_of(const struct brume_frame *f,
                         const struct brume_lit_lamp *l, uint32_t radius)
{
    uint32_t far = sum_of(l->depth, radius), reach = radius + 0x4000u;
    return reach + 2u * (far / f->step + 1u);
}

static void set_lamp(struct brume_lit_lamp *out, const struct brume_frame *f,
                     const struct brume_scene *s, const struct brume_lamp *in)
{
    static const struct brume_lit_lamp k_none;
    *out = k_none;
    for (int i = 0; i < 3; i++)
        out->position[i] =
            brume_halved((uint32_t)in->position[i] + (uint32_t)f->eye[i] -
                         (uint32_t)s->eye[i]);
    brume_lit_colour(out->colour, s, in->colour);
    for (int c = 0; c < 3; c++)
        out->colour[c] =
            out->colour[c] < 1u << 28 ? out->colour[c] << 4 : 0xffffffffu;
    set_lengths(out, in);
    set_spot(out, in);
    out->shadow_samples = in->shadow_samples;
    if (in->shadow_samples != 0)
        out->per_sample = 0xffffffffu / in->shadow_samples;
    out->plain = !out->spot && in->shadow_samples == 0 &&
                 s->lighting->phase == NULL &&
                 out->size_shift <= out->radius_shift + 32;
    out->depth = depth_of(f, out);
    out->reach = reach_of(f, out, in->radius);
}

/// Tiles ///

/* How far in front of a plane through the eye a lamp is, Q18.13. |normal| is
 * 1: so is |result| < 2^30, as coordinates are up to 65535 voxels apart. */
static int32_t before_plane(const struct brume_frame *f,
                            const struct brume_lit_lamp *l,
                            const int32_t normal[3])
{
    int32_t sum = 0;
    for (int i = 0; i < 3; i++) {
        uint32_t a = l->position[i], b = brume_halved((uint32_t)f->eye[i]);
        sum += mul_both_signed_round(as_signed(a - b), normal[i], 0);
    }
    return sum;
}

/* a x b of unit vectors across each other to within 10 degrees, as a unit
 * vector that points to the side where `side` does. */
static void normal_of(int32_t out[3], const int32_t a[3], const int32_t b[3],
                      const int32_t side[3])
{
    int32_t along = 0; /* Q2.29 of unit vectors */
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = mul_both_signed_round(a[j], b[k], 1) -
                 mul_both_signed_round(a[k], b[j], 1);
    }
    brume_normalise(out);
    for (int i = 0; i < 3; i++)
        along += mul_both_signed_round(out[i], side[i], 1);
    for (int i = 0; i < 3 && along < 0; i++)
        out[i] = -out[i];
}

/* Rays of the grid along an axis, with those that the lattice has beyond it:
 * at most 3. */
static uint32_t rays_of(const struct brume_frame *f, int axis)
{
    uint32_t rays = f->lattice[axis];
#if BRUME_WITH_TEMPORAL
    rays <<= f->cell_log2[axis];
#endif
    return rays;
}

/* The first ray of the grid that is in tile n of an axis, or one after the
 * last. */
static uint32_t first_of(const struct brume_frame *f, int axis, uint32_t n)
{
    uint32_t rays = rays_of(f, axis), per = f->lit.tile[axis];
    uint32_t x = ((n << 16) + per - 1u) / per;
    return x < rays ? x : rays;
}

/* The plane between tiles n - 1 and n: all rays at the cell's edge. Its normal
 * is to the side of tile n. */
static void plane_of(int32_t normal[3], const struct brume_frame *f, int axis,
                     uint32_t n)
{
    uint32_t edge = first_of(f, axis, n) << (brume_resolution_of(f) + 1u);
    int32_t size = axis ? f->height : f->width;
    const int32_t *per = axis ? f->per_y : f->per_x;
    int32_t u = (int32_t)edge - size, ray[3], along[3], side[3];
    for (int i = 0; i < 3; i++) { /* row 0 is on top */
        side[i] = axis ? -per[i] : per[i];
        ray[i] = f->ahead[i] + u * side[i];
        along[i] = axis ? f->per_x[i] : f->per_y[i];
    }
    brume_normalise(ray);
    brume_normalise(along);
    brume_normalise(side);
    normal_of(normal, ray, along, side);
}

/* Narrows down the lamps' tiles along an axis, by all planes between them. */
static void set_tiles(const struct brume_frame *f, struct brume_clusters *c,
                      uint32_t count, int axis)
{
    for (uint32_t i = 0; i < count; i++) {
        c->lamp[i].from[axis] = TILES;
        c->lamp[i].to[axis] = 0;
    }
    for (uint32_t n = 0; n <= TILES; n++) {
        int32_t normal[3];
        plane_of(normal, f, axis, n);
        for (uint32_t i = 0; i < count; i++) {
            struct brume_lit_lamp *l = &c->lamp[i];
            int32_t way = before_plane(f, l, normal);
            int32_t most = (int32_t)(l->reach >> 3) + 1;
            if (n > 0 && l->before && way <= most) {
                uint8_t tile = (uint8_t)(n - 1u);
                l->from[axis] = l->from[axis] < tile ? l->from[axis] : tile;
                l->to[axis] = tile;
            }
            l->before = way >= -most;
        }
    }
}

/* Is it lit, and not all behind the eye? */
static bool is_in_sight(const struct brume_frame *f,
                        const struct brume_lit_lamp *l)
{
    int32_t ahead[3] = {f->ahead[0], f->ahead[1], f->ahead[2]};
    if ((l->colour[0] | l->colour[1] | l->colour[2]) == 0)
        return false;
    brume_normalise(ahead);
    return before_plane(f, l, ahead) >= -(int32_t)(l->reach >> 3) - 1;
}

/// Slices ///

/* From the nearest to the farthest light, each as many times as deep as the
 * one before; the first begins at 1/64 of the last's end at least. */
static void set_slices(struct brume_clusters *c, uint32_t near, uint32_t far)
{
    near = near > far >> 6 ? near : (far >> 6) + 1u;
    uint32_t from = (uint32_t)brume_log2(brume_number_of(near, 0));
    uint32_t to = (uint32_t)brume_log2(brume_number_of(far, 0));
    for (uint32_t i = 1; i < SLICES; i++) {
        uint32_t y = from + (to - from) * i / SLICES; /* < 2^21 * 2^5 */
        c->end[i - 1u] = brume_number_floor(brume_exp2(y), 0);
    }
    c->end[SLICES - 1] = 0xffffffffu;
}

/* Where a lamp's light begins and ends, in depth. */
static uint32_t nearest_of(const struct brume_lit_lamp *l)
{
    return l->depth > l->reach ? l->depth - l->reach : 0;
}

static uint32_t farthest_of(const struct brume_lit_lamp *l)
{
    return sum_of(l->depth, l->reach);
}

static void add_lamp(struct brume_clusters *c, uint32_t n)
{
    const struct brume_lit_lamp *l = &c->lamp[n];
    uint32_t bit = 0x80000000u >> (n & 31u);
    for (uint32_t s = 0; s < SLICES; s++) {
        if (c->end[s] <= nearest_of(l) ||
            (s > 0 && c->end[s - 1u] > farthest_of(l)))
            continue;
        for (uint32_t y = l->from[1]; y <= l->to[1]; y++)
            for (uint32_t x = l->from[0]; x <= l->to[0]; x++)
                c->lamps[s][y][x][n >> 5] |= bit;
    }
}

static void clear_clusters(struct brume_clusters *c)
{
    for (uint32_t s = 0; s < SLICES; s++)
        for (uint32_t y = 0; y < TILES; y++)
            for (uint32_t x = 0; x < TILES; x++)
                for (uint32_t i = 0; i < BRUME_LAMP_WORDS; i++)
                    c->lamps[s][y][x][i] = 0;
}

void brume_lamps_begin(struct brume_frame *frame,
                       const struct brume_scene *scene)
{
    struct brume_frame *f = frame;
    const struct brume_lighting *l = scene->lighting;
    struct brume_clusters *c = l != NULL ? l->clusters : NULL;
    uint32_t near = 0xffffffffu, far = 0;
    f->lit.clusters = NULL;
    f->lit.lamp_shadows = false;
    if (c == NULL || l->lamp_count == 0)
        return;
    for (int i = 0; i < 2; i++)
        f->lit.tile[i] = ((uint32_t)TILES << 16) / rays_of(f, i);
    for (uint32_t i = 0; i < l->lamp_count; i++) {
        struct brume_lit_lamp *p = &c->lamp[i];
        set_lamp(p, f, scene, &l->lamps[i]);
        if (!is_in_sight(f, p))
            continue;
        near = nearest_of(p) < near ? nearest_of(p) : near;
        far = farthest_of(p) > far ? farthest_of(p) : far;
        f->lit.clusters = c;
        f->lit.lamp_shadows = f->lit.lamp_shadows || p->shadow_samples != 0;
    }
    if (f->lit.clusters == NULL)
        return;
    clear_clusters(c);
    set_slices(c, near, far);
    set_tiles(f, c, l->lamp_count, 0);
    set_tiles(f, c, l->lamp_count, 1);
    for (uint32_t i = 0; i < l->lamp_count; i++)
        if (is_in_sight(f, &c->lamp[i]))
            add_lamp(c, i);
}

uint32_t brume_lamps_sameness(const struct brume_frame *frame)
{
    const struct brume_lighting *l = frame->lit.lighting;
    uint32_t h = l != NULL ? l->lamp_count : 0;
    for (uint32_t n = 0; l != NULL && n < l->lamp_count; n++) {
        const struct brume_lamp *p = &l->lamps[n];
        h = h * 16777619u ^ p->radius;
        h = h * 16777619u ^ p->size;
        h = h * 16777619u ^ (uint32_t)p->cos_outer;
        h = h * 16777619u ^ (uint32_t)p->cos_inner;
        h = h * 16777619u ^ p->shadow_samples;
        for (int i = 0; i < 3; i++) {
            h = h * 16777619u ^ (uint32_t)p->position[i];
            h = h * 16777619u ^ (uint32_t)p->direction[i];
            h = h * 16777619u ^ p->colour[i];
        }
    }
    return h;
}

#endif
