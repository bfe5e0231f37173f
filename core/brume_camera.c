/* SPDX-License-Identifier: MIT */
/* From the scene's camera to how directions change from pixel to pixel, and to
 * the pool's outline. */
#include "brume_inner.h"

/// Camera ///

/* The unit vector right of `ahead`; false when up is parallel to it (to
 * 2^-16 radians) or zero. */
static bool right_of(int32_t right[3], const int32_t ahead[3],
                     const int32_t up[3])
{
    int32_t unit[3] = {up[0], up[1], up[2]};
    if (!brume_normalise(unit))
        return false;
    brume_cross(right, ahead, unit);
    if ((magnitude(right[0]) | magnitude(right[1]) | magnitude(right[2])) <
        1u << 14)
        return false;
    return brume_normalise(right);
}

static bool in_bounds(const int32_t p[3])
{
    for (int i = 0; i < 3; i++)
        if (magnitude(p[i]) > BRUME_MAX_COORDINATE)
            return false;
    return true;
}

/* Unit vector from a to b; false when they are equal. */
static bool unit_between(int32_t out[3], const int32_t a[3], const int32_t b[3])
{
    int64_t d[3];
    bool wide = false;
    for (int i = 0; i < 3; i++) {
        d[i] = (int64_t)b[i] - a[i]; /* |d| < 2^32 */
        wide = wide || d[i] > INT32_MAX || d[i] < -INT32_MAX;
    }
    for (int i = 0; i < 3; i++)
        out[i] = (int32_t)(wide ? d[i] / 2 : d[i]);
    return brume_normalise(out);
}

/* out = v * k: Q2.30 times a number below 1 -> Q1.31. */
static void scale(int32_t out[3], const int32_t v[3], struct brume_number k)
{
    /* v m 2^(e+1) = (v m / 2^31) / 2^(-32-e), and e <= -32. */
    uint32_t down = (uint32_t)(-32 - k.e);
    BRUME_CHECK(k.e <= -32);
    for (int i = 0; i < 3; i++) {
        uint32_t r = magnitude(mul_signed_round(v[i], k.m, 1));
        if (down > 0)
            r = down > 31 ? 0 : ((r >> (down - 1)) + 1u) >> 1;
        out[i] = with_sign(r, v[i] < 0);
    }
}

/* Bits from lattice to grid. */
static uint32_t cell_log2(const struct brume_frame *f, int axis)
{
#if BRUME_WITH_TEMPORAL
    return f->cell_log2[axis];
#else
    (void)f;
    (void)axis;
    return 0;
#endif
}

/* The largest |u| or |v| of the lattice's rays, which may lie beyond the
 * image: at most 31 more than `size`. */
static uint32_t reach_of(const struct brume_frame *f, int axis, uint32_t size)
{
    uint32_t rays = (uint32_t)f->lattice[axis] << cell_log2(f, axis);
    return (rays << (brume_resolution_of(f) + 1u)) - size;
}

/* The ray of a pixel, any length: with a half field of view of angle f,
 *   cos f ahead + sin f (u right + v up) / h,  u = 2x+1-w,  v = h-1-2y,
 * all divided by a bound of its length, so that it stays below 1. */
static void project(struct brume_frame *f, const int32_t ahead[3],
                    const int32_t right[3], uint32_t fov)
{
    uint32_t h = f->height;
    uint32_t across = reach_of(f, 0, f->width), down = reach_of(f, 1, h);
    int32_t sine, cosine, up[3];
    /* fov / 2 in turns: times 2^16 / 720 = 91.0222... */
    brume_sincos(fov * 91u + mul_hi_floor(fov, 95443718u), &sine, &cosine);
    uint32_t s = (uint32_t)sine, c = (uint32_t)cosine;
    /* (c h + s down + s across) 2^14 in integers, rounded up: < 2^31 */
    uint32_t bound = ((c >> 16) + 1u) * h + ((s >> 16) + 1u) * (down + across);
    struct brume_number inverse =
        brume_number_inverse(brume_number_of(bound, -14));
    struct brume_number per_pixel =
        brume_number_mul(brume_number_of(s, -30), inverse);
    struct brume_number centre = brume_number_mul(
        brume_number_mul(brume_number_of(c, -30), brume_number_of(h, 0)),
        inverse);
    brume_cross(up, right, ahead);
    scale(f->ahead, ahead, centre);
    scale(f->per_x, right, per_pixel);
    scale(f->per_y, up, per_pixel);
#if BRUME_WITH_TAA
    /* h / (2 tan f) */
    f->view.focal = brume_number_mul(
        brume_number_mul(brume_number_of(c, -31), brume_number_of(h, 0)),
        brume_number_inverse(brume_number_of(s, -30)));
    for (int i = 0; i < 3; i++) {
        f->view.ahead[i] = ahead[i];
        f->view.right[i] = right[i];
        f->view.up[i] = up[i];
    }
#endif
}

/// Outline ///

/* How far outside of the pool a ray must pass to be told apart from those
 * that rounding may move into it: 1/16 voxel. A position is off its ray by
 * less than 2^-9 voxels where it enters. */
#define OUTLINE_MARGIN 0x1000

/* Of the pool seen along the third axis, from the eye at (0, 0), in Q18.13:
 * the rectangle's corners that touch the outline. `c` holds the ends of both
 * sides. A corner is the first counterclockwise when no other is clockwise of
 * it. */
static void outline_of(struct brume_outline out[2], int32_t c[2][2])
{
    int32_t first[2] = {c[0][0], c[1][0]}, last[2] = {c[0][0], c[1][0]};
    for (int n = 1; n < 4; n++) {
        int32_t a = c[0][n & 1], b = c[1][n >> 1];
        if (product_less(first[0], b, first[1], a)) {
            first[0] = a;
            first[1] = b;
        }
        if (product_less(a, last[1], b, last[0])) {
            last[0] = a;
            last[1] = b;
        }
    }
    out[0].a = -first[0];
    out[0].b = -first[1];
    out[1].a = last[0];
    out[1].b = last[1];
}

/* From outside the pool, two lines for each pair of axes: the ray passes
 * between them or misses. A pair in which the eye is inside has none. */
static void set_outline(struct brume_frame *f)
{
    int32_t ends[3][2];
    f->outlines = 0;
    for (int i = 0; i < 3; i++) {
        /* Both fit: |eye| < 2^31, limit < 2^31. Rounded outwards. */
        int64_t low = -(int64_t)f->eye[i] - OUTLINE_MARGIN;
        int64_t high = (int64_t)f->limit[i] - f->eye[i] + OUTLINE_MARGIN;
        ends[i][0] = (int32_t)(low / 8) - 1;
        ends[i][1] = (int32_t)(high / 8) + 1;
    }
    for (uint8_t i = 0; i < 3; i++) {
        uint8_t j = (uint8_t)((i + 1) % 3);
        int32_t c[2][2] = {{ends[i][0], ends[i][1]}, {ends[j][0], ends[j][1]}};
        if (c[0][0] < 0 && c[0][1] > 0 && c[1][0] < 0 && c[1][1] > 0)
            continue;
        struct brume_outline *out = &f->outline[f->outlines];
        outline_of(out, c);
        out[0].i = out[1].i = i;
        out[0].j = out[1].j = j;
        f->outlines += 2;
    }
}

int brume_camera_begin(struct brume_frame *frame,
                       const struct brume_scene *scene)
{
    static const int32_t k_z[3] = {0, 0, 1}, k_y[3] = {0, 1, 0};
    int32_t ahead[3], right[3];
    if (!in_bounds(scene->eye) || !in_bounds(scene->target) ||
        scene->fov < BRUME_MIN_FOV || scene->fov > BRUME_MAX_FOV ||
        !unit_between(ahead, scene->eye, scene->target))
        return BRUME_ERR_CAMERA;
    if (!right_of(right, ahead, scene->up) && !right_of(right, ahead, k_z))
        right_of(right, ahead, k_y);
    project(frame, ahead, right, scene->fov);
    int32_t bias = scene->filter == BRUME_TRILINEAR ? 0x80 : 0x8000;
#if BRUME_WITH_STOCHASTIC
    if (scene->filter == BRUME_STOCHASTIC) /* lookups are moved by 0 .. 1 */
        bias = 0;
#endif
    for (int i = 0; i < 3; i++) {
        frame->eye[i] = scene->eye[i] + bias;
#if BRUME_WITH_TAA
        frame->view.eye[i] = scene->eye[i];
#endif
    }
    set_outline(frame);
    return BRUME_OK;
}
