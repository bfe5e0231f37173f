/* SPDX-License-Identifier: MIT */
/*
 * Densities from copies of the volume, see wide.h, in lanes: a load for each
 * lane, or a few for all eight voxels of a trilinear lookup.
 */
#ifndef BRUME_HOST_WIDE_COPIED_H
#define BRUME_HOST_WIDE_COPIED_H

#include "wide_bricks.h"

/* What a lookup by copies reads, taken out of the loops: stores to lookups
 * might change it for all that the compiler knows. */
struct copied {
    const uint8_t *bytes, *aprons;
    const uint16_t *halves, *half_aprons;
    const uint64_t *octets;
    const uint32_t *ranges;
    lanes row, plane, end; /* elements from page to page; of the zero one */
    lanes max_density;
};

/* What a kernel's lookup reads, or reads first, if it is trilinear. */
LANES_INLINE bool reads_half_aprons(struct kernel k)
{
    return k.trilinear && k.clamp;
}

LANES_INLINE bool reads_aprons(struct kernel k)
{
    return k.trilinear && !k.clamp && k.format == BRUME_U8 && k.side == 8;
}

LANES_INLINE bool reads_octets(struct kernel k)
{
    return k.trilinear && !k.clamp && !reads_aprons(k);
}

LANES_INLINE struct copied copied_of(const struct brume_frame *f,
                                     const struct wide_copy *c, struct kernel k)
{
    struct copied r;
    const uint16_t *n = f->volume->cell_count;
    size_t end = reads_octets(k)        ? c->octets_size
                 : reads_aprons(k)      ? c->aprons_size
                 : reads_half_aprons(k) ? c->half_aprons_size
                 : k.format == BRUME_U8 ? c->bytes_size
                                        : c->halves_size;
    r.bytes = c->bytes;
    r.halves = c->halves;
    r.aprons = c->aprons;
    r.half_aprons = c->half_aprons;
    r.octets = c->octets;
    r.ranges = c->ranges;
    r.max_density = lanes_of(f->max_density);
    r.end = lanes_of((uint32_t)end);
    uint32_t page = 4096, across = (n[0] + 1u) / 2u, down = (n[1] + 1u) / 2u;
    if (k.trilinear) {
        page = reads_octets(k) ? 512u : WIDE_APRON;
        across = n[0];
        down = n[1];
    }
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

/* Octets in pages of 8^3, or aprons, cell by cell. */
LANES_INLINE lanes number_in_cells(lanes x, lanes y, lanes z,
                                   const struct copied *c, struct kernel k)
{
    lanes cell = (z >> 19) * c->plane + (y >> 19) * c->row;
    if (!reads_octets(k))
        return cell + (x >> 19) * WIDE_APRON + (x >> 16 & 7u) +
               (y >> 16 & 7u) * 9u + (z >> 16 & 7u) * 81u;
    lanes voxel = (x >> 16 & 7u) | (y >> 13 & 56u) | (z >> 10 & 448u);
    return cell + ((x >> 10 & 0xfffffe00u) | voxel);
}

LANES_INLINE void want_copied(struct lookups *l, uint32_t g,
                              const struct copied *c, lanes x, lanes y, lanes z,
                              lanes_mask wanted, struct kernel k)
{
    lanes at;
    if (k.trilinear) {
        at = number_in_cells(x, y, z, c, k);
        lanes_store(l->weight[g], weights_of(x, y, z));
    } else {
        at = x_in_pages(x) + y_in_pages(y, c->row) + z_in_pages(z, c->plane);
    }
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

/* From octets; but where these need the ranges of several bricks, from half
 * aprons: apart. */
LANES_INLINE lanes trilinear_copied(struct lookups *l, uint32_t g,
                                    const struct copied *c, struct kernel k)
{
    lanes at = lanes_load(l->at[g]), w = lanes_load(l->weight[g]);
    lanes d = mean_of_octets(c->octets, l->at[g], w);
    if (k.format == BRUME_U8)
        return d;
    lanes cell = at >> 9;
    d = density_of(gather_words(c->ranges, cell), d, 8, k);
    if (k.side == 9)
        return d;
    lanes x = at & 7u, y = at >> 3 & 7u, z = at >> 6 & 7u, last = lanes_of(7);
    lanes_mask face = mask_or(
        mask_equal(x, last), mask_or(mask_equal(y, last), mask_equal(z, last)));
    face = mask_and(face, mask_less(at, c->end));
    if (mask_any(face))
        set_apart(l, g, cell * WIDE_APRON + x + y * 9u + z * 81u, w, w, face);
    return d;
}

LANES_INLINE void copied_apart(struct lookups *l, const struct copied *c,
                               struct kernel k)
{
    for (uint32_t n = 0; n < l->apart_count; n += WIDE_LANES) {
        uint32_t at[WIDE_LANES] __attribute__((aligned(64)));
        lanes p[3];
        uint32_t some = apart_at(l, n, p);
        lanes_spill(at, lanes_where(mask_first(some), p[0]));
        put_apart(l, n, some, mix_halves(c, at, p[1], k));
    }
}

/* Density of group g. */
LANES_INLINE lanes density_copied(struct lookups *l, uint32_t g,
                                  const struct copied *c, struct kernel k)
{
    lanes d;
    if (reads_half_aprons(k))
        return mix_halves(c, l->at[g], lanes_load(l->weight[g]), k);
    if (reads_aprons(k))
        return mean_of_cubes(c->aprons, 9, l->at[g], lanes_load(l->weight[g]));
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
