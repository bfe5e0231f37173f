/* SPDX-License-Identifier: MIT */
/*
 * Density at a position of the pool: the one question the march asks. Inlined
 * into each kernel, where `k` is a constant.
 *
 * Positions are Q16.16 with the lookup's bias and inside the pool
 * (brume_frame.limit), and brume_volume_open has checked all that is followed
 * here: so nothing is checked.
 */
#ifndef BRUME_LOOKUP_H
#define BRUME_LOOKUP_H

#include "brume_inner.h"

/* What a kernel is compiled for. */
struct kernel {
    uint32_t format; /* enum brume_format */
    uint32_t side;   /* 8, or 9 with an apron */
    bool trilinear;
    bool uniform; /* light */
    bool clamp;   /* max_density */
#if BRUME_WITH_LIGHTING
    /* Not NULL: lookups are those of brume_lit_density, which knows the rest
     * at run time; moved by this. */
    const uint32_t *moved;
#endif
};

/* Does this kernel count density in codes of 8 bits (in units of density_max /
 * 255), or of 16 bits (density_max / 65280)? */
BRUME_INLINE bool is_narrow(struct kernel k)
{
    return k.format == BRUME_U8 && !k.trilinear && !k.clamp;
}

#define KERNEL_OF(f, a, t, u, c) \
    { \
        .format = (f), .side = 8 + (a), .trilinear = (t), .uniform = (u), \
        .clamp = (c) \
    }

/* Number of a kernel, and whether it is compiled in. */
#define KERNEL_ID(format, apron, tri, uni, clamp) \
    ((format) << 4 | (apron) << 3 | (tri) << 2 | (uni) << 1 | (clamp))
#define KERNEL_HAS(format, apron, tri, uni, clamp) \
    (((format) == BRUME_U8    ? BRUME_WITH_U8 \
      : (format) == BRUME_U8R ? BRUME_WITH_U8R \
                              : BRUME_WITH_U4R) && \
     (BRUME_WITH_APRON || !(apron)) && \
     ((tri) ? BRUME_WITH_TRILINEAR : BRUME_WITH_NEAREST) && \
     (BRUME_WITH_UNIFORM || !(uni)) && (BRUME_WITH_MAX_DENSITY || !(clamp)))

BRUME_INLINE uint32_t cell_at(const struct brume_volume *v, uint32_t x,
                              uint32_t y, uint32_t z)
{
    uint32_t row = (z >> 19) * v->cell_count[1] + (y >> 19);
    return le32(v->cells[row * v->cell_count[0] + (x >> 19)]);
}

/* Code of voxel number i of a brick. Brick * bytes < size < 2^32. */
BRUME_INLINE uint32_t code_at(const struct brume_volume *v, uint32_t brick,
                              uint32_t i, struct kernel k)
{
    if (k.format == BRUME_U4R) {
        uint32_t bytes = k.side == 9 ? 368 : 256;
        uint32_t pair = v->pool[brick * bytes + (i >> 1)];
        return pair >> ((i & 1u) << 2) & 15u;
    }
    return v->pool[brick * (k.side == 9 ? 732u : 512u) + i];
}

/* Number of the voxel within its brick. */
BRUME_INLINE uint32_t voxel_of(uint32_t x, uint32_t y, uint32_t z,
                               struct kernel k)
{
    return (x >> 16 & 7u) + k.side * ((y >> 16 & 7u) + k.side * (z >> 16 & 7u));
}

/* Density of a code, or of a mean of codes with `q` fraction bits (0 or 8),
 * in 16-bit codes. code * scale < 2^24. */
BRUME_INLINE uint32_t density_of_code(const struct brume_volume *v,
                                      uint32_t brick, uint32_t code, uint32_t q,
                                      struct kernel k)
{
    if (k.format == BRUME_U8)
        return q ? code : code << 8;
    uint32_t range = le32(v->ranges[brick]);
    uint32_t product = code * (range >> 16);
    return (range & 0xffffu) + (q ? (product + 128u) >> 8 : product);
}

BRUME_INLINE uint32_t clamped(const struct brume_frame *f, uint32_t d,
                              struct kernel k)
{
    return k.clamp && d > f->max_density ? f->max_density : d;
}

/// Nearest ///

BRUME_INLINE uint32_t nearest(const struct brume_frame *f, uint32_t brick,
                              uint32_t x, uint32_t y, uint32_t z,
                              struct kernel k)
{
    const struct brume_volume *v = f->volume;
    uint32_t code = code_at(v, brick, voxel_of(x, y, z, k), k);
    if (is_narrow(k))
        return code;
    return clamped(f, density_of_code(v, brick, code, 0, k), k);
}

/// Trilinear ///

/* Between a and b by w / 256: adds 8 fraction bits. */
BRUME_INLINE uint32_t mix_of(uint32_t a, uint32_t b, uint32_t w)
{
    return a * (256u - w) + b * w;
}

/* Eight codes in one brick, blended exactly: 8 + 24 bits, < 2^32 - 2^15; one
 * range then serves the blend. */
BRUME_INLINE uint32_t trilinear_in_brick(const struct brume_frame *f,
                                         uint32_t brick, uint32_t x, uint32_t y,
                                         uint32_t z, struct kernel k)
{
    const struct brume_volume *v = f->volume;
    uint32_t i = voxel_of(x, y, z, k), side = k.side;
    uint32_t wx = x >> 8 & 255u, wy = y >> 8 & 255u, wz = z >> 8 & 255u;
    uint32_t plane[2];
    for (uint32_t n = 0; n < 2; n++, i += side * side) {
        uint32_t low =
            mix_of(code_at(v, brick, i, k), code_at(v, brick, i + 1, k), wx);
        uint32_t high = mix_of(code_at(v, brick, i + side, k),
                               code_at(v, brick, i + side + 1, k), wx);
        plane[n] = mix_of(low, high, wy);
    }
    uint32_t code = (mix_of(plane[0], plane[1], wz) + 0x8000u) >> 16;
    return density_of_code(v, brick, code, 8, k);
}

/* One voxel, in 16-bit codes; z, y, x its position. */
BRUME_INLINE uint32_t voxel_density(const struct brume_frame *f, uint32_t x,
                                    uint32_t y, uint32_t z, struct kernel k)
{
    const struct brume_volume *v = f->volume;
    uint32_t cell = cell_at(v, x, y, z);
    if (cell & BRUME_CELL_EMPTY)
        return 0;
    uint32_t code = code_at(v, cell, voxel_of(x, y, z, k), k);
    return clamped(f, density_of_code(v, cell, code, 0, k), k);
}

/* Eight voxels wherever they lie. Not inlined: it is the rare case. Planes
 * are rounded back to 24 bits, which for u8 is exact, so that a brick with
 * and without an apron gives the same. */
static inline uint32_t trilinear_anywhere(const struct brume_frame *f,
                                          uint32_t x, uint32_t y, uint32_t z,
                                          struct kernel k)
{
    uint32_t wx = x >> 8 & 255u, wy = y >> 8 & 255u, wz = z >> 8 & 255u;
    uint32_t one = 0x10000u, plane[2];
    for (uint32_t n = 0; n < 2; n++, z += one) {
        uint32_t low = mix_of(voxel_density(f, x, y, z, k),
                              voxel_density(f, x + one, y, z, k), wx);
        uint32_t high = mix_of(voxel_density(f, x, y + one, z, k),
                               voxel_density(f, x + one, y + one, z, k), wx);
        plane[n] = (mix_of(low, high, wy) + 128u) >> 8;
    }
    return (mix_of(plane[0], plane[1], wz) + 0x8000u) >> 16;
}

/* Does a trilinear lookup here need a voxel beyond its cell? */
BRUME_INLINE bool on_high_face(uint32_t x, uint32_t y, uint32_t z)
{
    const uint32_t last = 7u << 16;
    return (x & last) == last || (y & last) == last || (z & last) == last;
}

/// Both ///

/* True, and *d set, when the lookup may find density. Else the position is in
 * a cell that holds none, whose distance is the low byte of *d. */
BRUME_INLINE bool density_at(const struct brume_frame *f, uint32_t x,
                             uint32_t y, uint32_t z, uint32_t *d,
                             struct kernel k)
{
    uint32_t cell = cell_at(f->volume, x, y, z);
    *d = cell;
    if (k.trilinear && (k.side == 8 || k.clamp)) {
        bool face = on_high_face(x, y, z);
        if (cell & BRUME_CELL_EMPTY) {
            if ((cell & 255u) > 1 || !face)
                return false;
        } else if (!face && !k.clamp) {
            *d = trilinear_in_brick(f, cell, x, y, z, k);
            return true;
        }
        *d = trilinear_anywhere(f, x, y, z, k);
        return true;
    }
    if (cell & BRUME_CELL_EMPTY)
        return false;
    *d = k.trilinear ? trilinear_in_brick(f, cell, x, y, z, k)
                     : nearest(f, cell, x, y, z, k);
    return true;
}

/* The same wherever the kernel is known. */
BRUME_INLINE bool find_density(const struct brume_frame *f, uint32_t x,
                               uint32_t y, uint32_t z, uint32_t *d,
                               struct kernel k)
{
#if BRUME_WITH_LIGHTING
    if (k.moved != NULL)
        return brume_lit_density(f, x, y, z, d, k.moved);
#endif
    return density_at(f, x, y, z, d, k);
}

#endif
