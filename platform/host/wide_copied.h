/* SPDX-License-Identifier: MIT */
/*
 * Densities from copies of the volume, see wide.h, in lanes: a load for each
 * lane, or a few for all eight voxels of a trilinear lookup.
 */
#ifndef BRUME_HOST_WIDE_COPIED_H
#define BRUME_HOST_WIDE_COPIED_H

#include "wide_bricks.h"

/* In the word of a cell: the cube has voxels of other cells. */
#define SEVERAL_BRICKS 0x80000000u

/* What a lookup by copies reads, taken out of the loops: stores to lookups
 * might change it for all that the compiler knows. */
struct copied {
    const uint8_t *bytes, *aprons;
    const uint16_t *halves, *half_aprons;
    const uint32_t *ranges;
    lanes row, plane, end; /* elements from page to page; of the zero one */
    lanes max_density;
};

/* Does a trilinear lookup read half aprons, or aprons first? */
LANES_INLINE bool reads_half_aprons(struct kernel k)
{
    return k.trilinear && k.clamp;
}

/* Does it need ranges, and for cubes of several bricks half aprons? */
LANES_INLINE bool needs_ranges(struct kernel k)
{
    return k.trilinear && !k.clamp && k.format != BRUME_U8;
}

LANES_INLINE bool sets_apart(struct kernel k)
{
    return needs_ranges(k) && k.side == 8;
}

LANES_INLINE struct copied copied_of(const struct brume_frame *f,
                                     const struct wide_copy *c, struct kernel k)
{
    struct copied r;
    const uint16_t *n = f->volume->cell_count;
    size_t end = reads_half_aprons(k)   ? c->half_aprons_size
                 : k.trilinear          ? c->aprons_size
                 : k.format == BRUME_U8 ? c->bytes_size
                                        : c->halves_size;
    uint32_t page = 4096, across = (n[0] + 1u) / 2u, down = (n[1] + 1u) / 2u;
    if (k.trilinear) { /* numbers of cells */
        page = 1;
        across = n[0];
        down = n[1];
    }
    r.bytes = c->bytes;
    r.halves = c->halves;
    r.aprons = c->aprons;
    r.half_aprons = c->half_aprons;
    r.ranges = c->ranges;
    r.max_density = lanes_of(f->max_density);
    r.end = lanes_of((uint32_t)end);
    r.row = lanes_of(across * page);
    r.plane = lanes_of(across * down * page);
    return r;
}

/* Voxels in pages of 16^3. */
LANES_INLINE lanes x_in_pages(lanes x)
{
    return (x >> 16 & 15u) | (x >> 8 & 0xfffff000u);
}

LANES_INLINE lanes y_in_pages(lanes y, lanes row)
{
    return (y >> 12 & 240u) + (y >> 20) * row;
}

LANES_INLINE lanes z_in_pages(lanes z, lanes plane)
{
    return (z >> 8 & 3840u) + (z >> 20) * plane;
}

/* Voxel at a position of a cell, in the aprons of all. */
LANES_INLINE lanes number_in_aprons(lanes cell, lanes x, lanes y, lanes z)
{
    static const struct kernel k = KERNEL_OF(BRUME_U8, 1, true, false, false);
    return cell * WIDE_APRON + voxel_number(x, y, z, k);
}

/* Cubes of eight voxels in aprons; of those with ranges the cell, too, and
 * whether the cube is of several bricks. */
LANES_INLINE void want_cube(struct lookups *l, uint32_t g,
                            const struct copied *c, lanes x, lanes y, lanes z,
                            lanes_mask wanted, struct kernel k)
{
    lanes cell = (z >> 19) * c->plane + (y >> 19) * c->row + (x >> 19);
    lanes at = number_in_aprons(cell, x, y, z);
    lanes_store(l->at[g], lanes_select(wanted, at, c->end));
    lanes_store(l->weight[g], weights_of(x, y, z));
    if (!needs_ranges(k))
        return;
    cell = lanes_where(wanted, cell);
    if (sets_apart(k)) {
        lanes_mask face = mask_and(wanted, on_high_faces(x, y, z));
        cell |= lanes_where(face, lanes_of(SEVERAL_BRICKS));
    }
    lanes_store(l->cell[g], cell);
}

LANES_INLINE void want_copied(struct lookups *l, uint32_t g,
                              const struct copied *c, lanes x, lanes y, lanes z,
                              lanes_mask wanted, struct kernel k)
{
    if (k.trilinear) {
        want_cube(l, g, c, x, y, z, wanted, k);
        return;
    }
    lanes at = x_in_pages(x) + y_in_pages(y, c->row) + z_in_pages(z, c->plane);
    lanes_store(l->at[g], lanes_select(wanted, at, c->end));
}

/* As trilinear_anywhere of the core, from half aprons; w: weights. */
LANES_INLINE lanes mix_halves(const struct copied *c, const uint32_t *at,
                              lanes w, struct kernel k)
{
    lanes wx = w & 255u, wy = w >> 8 & 255u, wz = w >> 16, plane[2];
    for (uint32_t z = 0; z < 2; z++) {
        lanes row[2];
        for (uint32_t y = 0; y < 2; y++) {
            lanes two = gather_pairs_at(c->half_aprons + 81 * z + 9 * y, at);
            lanes a = two & 0xffffu, b = two >> 16;
            if (k.clamp) {
                a = lanes_min(a, c->max_density);
                b = lanes_min(b, c->max_density);
            }
            row[y] = mix_lanes(a, b, wx);
        }
        plane[z] = (mix_lanes(row[0], row[1], wy) + 128u) >> 8;
    }
    return (mix_lanes(plane[0], plane[1], wz) + 0x8000u) >> 16;
}

/* From aprons; but where these need the ranges of several bricks, from half
 * aprons: apart. */
LANES_INLINE lanes trilinear_copied(struct lookups *l, uint32_t g,
                                    const struct copied *c, struct kernel k)
{
    lanes w = lanes_load(l->weight[g]);
    lanes d = mean_of_cubes(c->aprons, 9, l->at[g], w);
    if (!needs_ranges(k))
        return d;
    lanes cell = lanes_load(l->cell[g]), at = lanes_load(l->at[g]);
    lanes range = gather_words(c->ranges, cell & ~SEVERAL_BRICKS);
    if (sets_apart(k) && mask_any(mask_high(cell)))
        set_apart(l, g, (const lanes[2]){at, w}, 2, mask_high(cell));
    return lanes_where(mask_less(at, c->end), density_of(range, d, 8, k));
}

LANES_INLINE void copied_apart(struct lookups *l, const struct copied *c,
                               struct kernel k)
{
    for (uint32_t n = 0; n < l->apart_count; n += WIDE_LANES) {
        uint32_t at[WIDE_LANES] __attribute__((aligned(64)));
        uint32_t some = apart_from(l, n);
        lanes_spill(at,
                    lanes_where(mask_first(some), lanes_load(l->apart[0] + n)));
        put_apart(l, n, some,
                  mix_halves(c, at, lanes_load(l->apart[1] + n), k));
    }
}

/* Density of group g. */
LANES_INLINE lanes density_copied(struct lookups *l, uint32_t g,
                                  const struct copied *c, struct kernel k)
{
    lanes d;
    if (reads_half_aprons(k))
        return mix_halves(c, l->at[g], lanes_load(l->weight[g]), k);
    if (k.trilinear)
        return trilinear_copied(l, g, c, k);
    if (k.format == BRUME_U8) {
        d = gather_bytes_at(c->bytes, l->at[g]);
        return k.clamp ? lanes_min(d << 8, c->max_density) : d;
    }
    d = gather_halves_at(c->halves, l->at[g]);
    return lanes_min(d, c->max_density);
}

#endif
