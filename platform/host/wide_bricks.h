/* SPDX-License-Identifier: MIT */
/*
 * Densities at many positions: what core/brume_lookup.h defines, in passes
 * over arrays. A pass does one thing for all positions, so that its chains of
 * dependent instructions are short and many of them are under way at once; one
 * position after the other, a processor waits for loads most of the time.
 */
#ifndef BRUME_HOST_WIDE_BRICKS_H
#define BRUME_HOST_WIDE_BRICKS_H

#include "brume_lookup.h"
#include "wide.h"
#include "wide_gather.h"

/* A byte of every asset that is zero: the header's, at 26. */
#define ZERO_BYTE 26u

/* Groups of lanes that are looked up together. */
#define LOOKUPS 16u

/* at[g], voxel[g] and place[g] are set by want(); d[g], and cell[g] come from
 * look_up(). */
struct lookups {
    uint32_t at[LOOKUPS][WIDE_LANES];    /* cell number */
    uint32_t voxel[LOOKUPS][WIDE_LANES]; /* in its brick; or UNWANTED */
    uint32_t cell[LOOKUPS][WIDE_LANES];  /* its word, UNWANTED or'ed in */
    uint32_t d[LOOKUPS][WIDE_LANES];     /* 0 where there is none */
    uint32_t x[LOOKUPS][WIDE_LANES];     /* for trilinear */
    uint32_t y[LOOKUPS][WIDE_LANES];
    uint32_t z[LOOKUPS][WIDE_LANES];
    uint32_t weight[LOOKUPS][WIDE_LANES]; /* bytes, trilinear */
    /* Trilinear lookups between voxels of several bricks, close together: what
     * says where they are, and last their place in d. */
    uint32_t apart[4][(LOOKUPS + 1) * WIDE_LANES], apart_count;
} __attribute__((aligned(64)));

#define UNWANTED BRUME_CELL_EMPTY

/* Has memory changed behind the compiler's back? Not so, but it must load what
 * it stored word by word instead of taking vectors apart. */
#define FORGET(array) __asm__("" : "+m"(array))

/// Voxels ///

LANES_INLINE lanes cell_number(const struct brume_volume *v, lanes x, lanes y,
                               lanes z)
{
    uint32_t row = v->cell_count[0];
    uint32_t plane = row * v->cell_count[1];
    return (z >> 19) * plane + (y >> 19) * row + (x >> 19);
}

LANES_INLINE lanes voxel_number(lanes x, lanes y, lanes z, struct kernel k)
{
    if (k.side == 8)
        return (x >> 16 & 7u) | (y >> 13 & 56u) | (z >> 10 & 448u);
    return (x >> 16 & 7u) + (y >> 16 & 7u) * 9u + (z >> 16 & 7u) * 81u;
}

/* Bytes from the asset's start to voxel i of a brick; nibbles share one. */
LANES_INLINE lanes byte_of(const struct brume_volume *v, lanes brick, lanes i,
                           struct kernel k)
{
    uint32_t pool = (uint32_t)(v->pool - v->asset);
    if (k.format == BRUME_U4R)
        return brick * (k.side == 9 ? 368u : 256u) + (i >> 1) + pool;
    if (k.side == 9)
        return brick * 732u + i + pool;
    return (brick << 9) + i + pool;
}

LANES_INLINE lanes code_of(lanes byte, lanes i, struct kernel k)
{
    return k.format == BRUME_U4R ? byte >> ((i & 1u) << 2) & 15u : byte;
}

/* density_of_code, for bricks whose range was loaded. */
LANES_INLINE lanes density_of(lanes range, lanes code, uint32_t q,
                              struct kernel k)
{
    if (k.format == BRUME_U8)
        return q ? code : code << 8;
    lanes product = code * (range >> 16);
    return (range & 0xffffu) + (q ? (product + 128u) >> 8 : product);
}

LANES_INLINE lanes clamp_density(const struct brume_frame *f, lanes d,
                                 struct kernel k)
{
    return k.clamp ? lanes_min(d, lanes_of(f->max_density)) : d;
}

/// Nearest ///

LANES_INLINE void want_cell(struct lookups *l, uint32_t g,
                            const struct brume_frame *f, lanes x, lanes y,
                            lanes z, lanes_mask wanted, struct kernel k)
{
    lanes voxel = voxel_number(x, y, z, k);
    lanes_store(l->at[g], lanes_where(wanted, cell_number(f->volume, x, y, z)));
    lanes_store(l->voxel[g], lanes_select(wanted, voxel, lanes_of(UNWANTED)));
    if (k.trilinear) {
        lanes_store(l->x[g], x);
        lanes_store(l->y[g], y);
        lanes_store(l->z[g], z);
    }
}

LANES_INLINE void look_up_cells(struct lookups *l, uint32_t n,
                                const struct brume_frame *f)
{
    FORGET(l->at);
    for (uint32_t g = 0; g < n; g++)
        lanes_store(l->cell[g], gather_words_at(f->volume->cells, l->at[g]) |
                                    (lanes_load(l->voxel[g]) & UNWANTED));
}

/* From `at`, the bytes' places. */
LANES_INLINE void look_up_nearest(struct lookups *l, uint32_t n,
                                  const struct brume_frame *f, struct kernel k)
{
    const struct brume_volume *v = f->volume;
    FORGET(l->at);
    for (uint32_t g = 0; g < n; g++) {
        lanes voxel = lanes_load(l->voxel[g]);
        lanes cell = gather_words_at(v->cells, l->at[g]) | (voxel & UNWANTED);
        lanes at = byte_of(v, cell, voxel, k);
        lanes_store(l->cell[g], cell);
        lanes_store(l->at[g],
                    lanes_select(mask_high(cell), lanes_of(ZERO_BYTE), at));
    }
    FORGET(l->at);
    for (uint32_t g = 0; g < n; g++) {
        lanes code = gather_bytes_at(v->asset, l->at[g]);
        lanes cell = lanes_load(l->cell[g]);
        code = code_of(code, lanes_load(l->voxel[g]), k);
        if (is_narrow(k)) {
            lanes_store(l->d[g], code);
            continue;
        }
        /* Without a brick there may be no ranges, not even the first. */
        lanes_mask brick = mask_less(cell, lanes_of(BRUME_CELL_EMPTY));
        lanes range = lanes_of(0);
        if (k.format != BRUME_U8 && mask_any(brick))
            range = gather_words(v->ranges, lanes_where(brick, cell));
        lanes d = clamp_density(f, density_of(range, code, 0, k), k);
        lanes_store(l->d[g], lanes_where(brick, d));
    }
}

/// Trilinear ///

LANES_INLINE lanes mix_lanes(lanes a, lanes b, lanes w)
{
    return (a << 8) + (b - a) * w;
}

/* Codes of voxel i of bricks, for lanes that have one. */
LANES_INLINE lanes codes_at(const struct brume_volume *v, lanes brick, lanes i,
                            lanes_mask wanted, struct kernel k)
{
    lanes at =
        lanes_select(wanted, byte_of(v, brick, i, k), lanes_of(ZERO_BYTE));
    return code_of(gather_bytes(v->asset, at), i, k);
}

/* Weights of the upper voxels, bytes. */
LANES_INLINE lanes weights_of(lanes x, lanes y, lanes z)
{
    return (x >> 8 & 255u) | (y & 0xff00u) | (z << 8 & 0xff0000u);
}

/* Mean codes of cubes of voxels from number i of bricks on. */
LANES_INLINE lanes mean_codes(const struct brume_volume *v, lanes brick,
                              lanes i, lanes w, lanes_mask wanted,
                              struct kernel k)
{
    uint32_t side = k.side, at[WIDE_LANES] __attribute__((aligned(64)));
    if (k.format != BRUME_U4R) {
        i += brick * (side == 9 ? 732u : 512u);
        lanes_spill(at, lanes_where(wanted, i));
        return mean_of_cubes(v->pool, side, at, w);
    }
    lanes wx = w & 255u, wy = w >> 8 & 255u, plane[2];
    for (uint32_t n = 0; n < 2; n++, i += side * side) {
        lanes low = mix_lanes(codes_at(v, brick, i, wanted, k),
                              codes_at(v, brick, i + 1u, wanted, k), wx);
        lanes high =
            mix_lanes(codes_at(v, brick, i + side, wanted, k),
                      codes_at(v, brick, i + (side + 1u), wanted, k), wx);
        plane[n] = mix_lanes(low, high, wy);
    }
    return (mix_lanes(plane[0], plane[1], w >> 16) + 0x8000u) >> 16;
}

/* As trilinear_in_brick. */
LANES_INLINE lanes mix_in_bricks(const struct brume_frame *f, lanes brick,
                                 lanes x, lanes y, lanes z, lanes_mask wanted,
                                 struct kernel k)
{
    const struct brume_volume *v = f->volume;
    lanes range = lanes_of(0);
    lanes code = mean_codes(v, brick, voxel_number(x, y, z, k),
                            weights_of(x, y, z), wanted, k);
    if (k.format != BRUME_U8)
        range = gather_words(v->ranges, lanes_where(wanted, brick));
    return lanes_where(wanted, density_of(range, code, 8, k));
}

/* As voxel_density. */
LANES_INLINE lanes voxel_densities(const struct brume_frame *f, lanes x,
                                   lanes y, lanes z, lanes_mask wanted,
                                   struct kernel k)
{
    const struct brume_volume *v = f->volume;
    lanes at = lanes_where(wanted, cell_number(v, x, y, z));
    lanes cell = gather_words(v->cells, at), range = lanes_of(0);
    wanted = mask_less_those(wanted, mask_high(cell));
    if (!mask_any(wanted))
        return lanes_of(0);
    lanes code = codes_at(v, cell, voxel_number(x, y, z, k), wanted, k);
    if (k.format != BRUME_U8)
        range = gather_words(v->ranges, lanes_where(wanted, cell));
    lanes d = clamp_density(f, density_of(range, code, 0, k), k);
    return lanes_where(wanted, d);
}

/* As trilinear_anywhere. */
static inline lanes mix_anywhere(const struct brume_frame *f, lanes x, lanes y,
                                 lanes z, lanes_mask wanted, struct kernel k)
{
    lanes wx = x >> 8 & 255u, wy = y >> 8 & 255u, wz = z >> 8 & 255u;
    lanes plane[2], x1 = x + 0x10000u, y1 = y + 0x10000u;
    for (uint32_t n = 0; n < 2; n++, z += 0x10000u) {
        lanes low = mix_lanes(voxel_densities(f, x, y, z, wanted, k),
                              voxel_densities(f, x1, y, z, wanted, k), wx);
        lanes high = mix_lanes(voxel_densities(f, x, y1, z, wanted, k),
                               voxel_densities(f, x1, y1, z, wanted, k), wx);
        plane[n] = (mix_lanes(low, high, wy) + 128u) >> 8;
    }
    return (mix_lanes(plane[0], plane[1], wz) + 0x8000u) >> 16;
}

LANES_INLINE lanes_mask on_high_faces(lanes x, lanes y, lanes z)
{
    lanes last = lanes_of(7u << 16);
    return mask_or(
        mask_equal(x & last, last),
        mask_or(mask_equal(y & last, last), mask_equal(z & last, last)));
}

/* Group g's lookups of m are done later, by n words each. A third of them all
 * need voxels of several bricks, so that most vectors have some. */
LANES_INLINE void set_apart(struct lookups *l, uint32_t g, const lanes *word,
                            int n, lanes_mask m)
{
    uint32_t at = l->apart_count;
    for (int i = 0; i < n; i++)
        lanes_pack(l->apart[i] + at, word[i], m);
    lanes_pack(l->apart[3] + at, lanes_count() + g * WIDE_LANES, m);
    l->apart_count = at + (uint32_t)__builtin_popcount(mask_bits(m));
}

/* Densities of the n lookups from number `at` of those apart on. */
LANES_INLINE void put_apart(struct lookups *l, uint32_t at, uint32_t n,
                            lanes density)
{
    uint32_t d[WIDE_LANES] __attribute__((aligned(64))), *to = l->d[0];
    lanes_spill(d, density);
    for (uint32_t i = 0; i < n; i++)
        to[l->apart[3][at + i]] = d[i];
}

/* How many there are from number `at` on, at most a vector. */
LANES_INLINE uint32_t apart_from(const struct lookups *l, uint32_t at)
{
    uint32_t left = l->apart_count - at;
    return left < WIDE_LANES ? left : WIDE_LANES;
}

LANES_INLINE void look_up_trilinear(struct lookups *l, uint32_t n,
                                    const struct brume_frame *f,
                                    struct kernel k)
{
    look_up_cells(l, n, f);
    l->apart_count = 0;
    for (uint32_t g = 0; g < n; g++) {
        lanes x = lanes_load(l->x[g]), y = lanes_load(l->y[g]);
        lanes z = lanes_load(l->z[g]), cell = lanes_load(l->cell[g]);
        lanes_mask brick = mask_less(cell, lanes_of(BRUME_CELL_EMPTY));
        lanes d = lanes_of(0);
        if (k.side == 8 || k.clamp) {
            lanes_mask wanted =
                mask_less(lanes_load(l->voxel[g]), lanes_of(UNWANTED));
            lanes_mask face = mask_and(wanted, on_high_faces(x, y, z));
            lanes_mask near = mask_and(
                face, mask_less(cell, lanes_of(BRUME_CELL_EMPTY + 2u)));
            lanes_mask rest = k.clamp ? mask_or(brick, near) : near;
            brick = mask_less_those(brick, rest);
            if (mask_any(rest)) {
                set_apart(l, g, (const lanes[3]){x, y, z}, 3, rest);
                /* Leaps count from a cell without density. */
                lanes_store(l->cell[g], lanes_select(rest, lanes_of(0), cell));
            }
        }
        if (mask_any(brick))
            d = mix_in_bricks(f, cell, x, y, z, brick, k);
        lanes_store(l->d[g], d);
    }
    for (uint32_t at = 0; at < l->apart_count; at += WIDE_LANES) {
        uint32_t some = apart_from(l, at);
        put_apart(l, at, some,
                  mix_anywhere(f, lanes_load(l->apart[0] + at),
                               lanes_load(l->apart[1] + at),
                               lanes_load(l->apart[2] + at), mask_first(some),
                               k));
    }
}

#endif
