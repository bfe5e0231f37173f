/* SPDX-License-Identifier: MIT */
/*
 * Lookups of layouts.h in lanes, for processors that LAYOUTS_RUN is compiled
 * for. Passes over batches, as those of the kernel: places, words, densities.
 */
#include "layouts.h"

#include "layouts_octets.h"
#include "wide_lookup.h"

struct batch {
    uint32_t at[LAYOUT_GROUPS][WIDE_LANES];    /* cell, then element */
    uint32_t voxel[LAYOUT_GROUPS][WIDE_LANES]; /* in it; or element above */
    uint32_t weight[LAYOUT_GROUPS][WIDE_LANES];
} __attribute__((aligned(64)));

/// Products ///

/* Two vectors of four codes: of the lower and the upper plane, x first. Sums of
 * eight products of weights, of whose 24 fraction bits 16 are rounded off. */
LANES_INLINE lanes mean_by_32(const lanes four[2], lanes w)
{
    lanes wx = w & 255u, wy = w >> 8 & 255u, wz = w >> 16, plane[2];
    for (int n = 0; n < 2; n++) {
        lanes v = four[n];
        plane[n] = mix_lanes(mix_lanes(v & 255u, v >> 8 & 255u, wx),
                             mix_lanes(v >> 16 & 255u, v >> 24, wx), wy);
    }
    return (mix_lanes(plane[0], plane[1], wz) + 0x8000u) >> 16;
}

/// Loads ///

LANES_INLINE int load_four(const uint8_t *p)
{
    uint32_t v;
    memcpy(&v, p, sizeof v);
    return (int)v;
}

LANES_INLINE lanes gather_fours(const uint8_t *p, const uint32_t *i)
{
    __m128i quad[LANES_QUADS];
    for (int n = 0; n < LANES_QUADS; n++, i += 4) {
        __m128i v = _mm_cvtsi32_si128(load_four(p + 4 * (size_t)i[0]));
        v = _mm_insert_epi32(v, load_four(p + 4 * (size_t)i[1]), 1);
        v = _mm_insert_epi32(v, load_four(p + 4 * (size_t)i[2]), 2);
        quad[n] = _mm_insert_epi32(v, load_four(p + 4 * (size_t)i[3]), 3);
    }
    return lanes_join(quad);
}

/* Octets, and their lower and upper planes in vectors of their own. */
LANES_INLINE void gather_octets(const uint64_t *p, const uint32_t *i,
                                lanes four[2])
{
    __m128i pair[WIDE_LANES / 2];
    for (int n = 0; n < WIDE_LANES / 2; n++)
        pair[n] = load_octets(p, i[2 * n], i[2 * n + 1]);
    /* Words 0 2 of two pairs are four lower planes, words 1 3 upper ones. */
    __m128i low[LANES_QUADS], high[LANES_QUADS];
    for (int n = 0; n < LANES_QUADS; n++) {
        __m128 a = _mm_castsi128_ps(pair[2 * n]);
        __m128 b = _mm_castsi128_ps(pair[2 * n + 1]);
        low[n] = _mm_castps_si128(_mm_shuffle_ps(a, b, 0x88));
        high[n] = _mm_castps_si128(_mm_shuffle_ps(a, b, 0xdd));
    }
    four[0] = lanes_join(low);
    four[1] = lanes_join(high);
}

/// Batches ///

LANES_INLINE lanes word_weights(lanes x, lanes y, lanes z)
{
    return (x >> 8 & 255u) | (y & 0xff00u) | (z << 8 & 0xff0000u);
}

/* Places of a batch from position n on. */
LANES_INLINE void place_batch(const struct layouts *l, struct batch *b,
                              size_t n, enum layout kind)
{
    const struct brume_volume *v = l->frame->volume;
    const struct kernel k =
        KERNEL_OF(BRUME_U8, HAS_APRON(kind) ? 1u : 0u, true, false, false);
    for (uint32_t g = 0; g < LAYOUT_GROUPS; g++, n += WIDE_LANES) {
        lanes x = lanes_load(l->axis[0] + n), y = lanes_load(l->axis[1] + n);
        lanes z = lanes_load(l->axis[2] + n);
        lanes cell = cell_number(v, x, y, z), voxel = voxel_number(x, y, z, k);
        lanes_store(b->weight[g], word_weights(x, y, z));
        if (kind == LAYOUT_QUAD_PAGES) {
            lanes up = z + 0x10000u;
            lanes_store(b->at[g], (cell << 9) + voxel);
            lanes_store(b->voxel[g], (cell_number(v, x, y, up) << 9) +
                                         voxel_number(x, y, up, k));
        } else if (kind == LAYOUT_APRON_PAGES) {
            lanes_store(b->at[g], cell * BRICK_ELEMENTS(kind) + voxel);
        } else {
            lanes_store(b->at[g], cell);
            lanes_store(b->voxel[g], voxel);
        }
    }
}

/* Cells to elements, by their words. */
LANES_INLINE void number_batch(const struct layouts *l, struct batch *b,
                               enum layout kind)
{
    const brume_word_t *word = l->word[kind];
    FORGET(b->at);
    for (uint32_t g = 0; g < LAYOUT_GROUPS; g++)
        lanes_store(b->at[g],
                    gather_words_at(word, b->at[g]) * BRICK_ELEMENTS(kind) +
                        lanes_load(b->voxel[g]));
}

/* Where neighbours have a part in it: lanes, one by one. */
static void patch_faces(const struct layouts *l, size_t n, lanes four[2])
{
    const struct brume_volume *v = l->frame->volume;
    lanes x = lanes_load(l->axis[0] + n), y = lanes_load(l->axis[1] + n);
    lanes z = lanes_load(l->axis[2] + n);
    uint32_t out[2][WIDE_LANES];
    unsigned bits = mask_bits(on_high_faces(x, y, z));
    lanes_store(out[0], four[0]);
    lanes_store(out[1], four[1]);
    for (; bits != 0; bits &= bits - 1u) {
        size_t i = (size_t)__builtin_ctz(bits);
        uint32_t vx = l->axis[0][n + i] >> 16, vy = l->axis[1][n + i] >> 16;
        uint32_t vz = l->axis[2][n + i] >> 16;
        for (uint32_t plane = 0; plane < 2; plane++)
            out[plane][i] = layouts_voxel(v, vx, vy, vz + plane) |
                            layouts_voxel(v, vx + 1, vy, vz + plane) << 8 |
                            layouts_voxel(v, vx, vy + 1, vz + plane) << 16 |
                            layouts_voxel(v, vx + 1, vy + 1, vz + plane) << 24;
    }
    four[0] = lanes_load(out[0]);
    four[1] = lanes_load(out[1]);
}

/* The codes of group g, whose first position is n. */
LANES_INLINE void load_codes(const struct layouts *l, const struct batch *b,
                             uint32_t g, size_t n, enum layout kind,
                             lanes four[2])
{
    const uint8_t *data = l->data[kind];
    switch (kind) {
    case LAYOUT_BRICKS:
        four[0] = gather_rows(data, b->at[g], 8);
        four[1] = gather_rows(data + 64, b->at[g], 8);
        patch_faces(l, n, four);
        break;
    case LAYOUT_APRON:
    case LAYOUT_APRON_PAGES:
        four[0] = gather_rows(data, b->at[g], 9);
        four[1] = gather_rows(data + 81, b->at[g], 9);
        break;
    case LAYOUT_QUADS:
        four[0] = gather_fours(data, b->at[g]);
        four[1] = gather_fours(data + (size_t)4 * 64, b->at[g]);
        break;
    case LAYOUT_QUAD_PAGES:
        four[0] = gather_fours(data, b->at[g]);
        four[1] = gather_fours(data, b->voxel[g]);
        break;
    case LAYOUT_OCTETS:
        gather_octets((const uint64_t *)(const void *)data, b->at[g], four);
        break;
    default: four[0] = four[1] = lanes_of(0); break;
    }
}

/* A batch's densities, into the hash of each lane. */
LANES_INLINE lanes hash_batch(const struct layouts *l, const struct batch *b,
                              size_t n, enum layout kind,
                              enum products products, lanes hash)
{
    const uint64_t *octets = (const uint64_t *)(const void *)l->data[kind];
    for (uint32_t g = 0; g < LAYOUT_GROUPS; g++, n += WIDE_LANES) {
        lanes w = lanes_load(b->weight[g]), d, four[2];
        if (products == PRODUCTS_NONE) {
            d = w + lanes_load(b->at[g]);
        } else if (products == PRODUCTS_OCTETS) {
            d = mean_of_octets(octets, b->at[g], w);
        } else {
            load_codes(l, b, g, n, kind, four);
            d = products == PRODUCTS_32 ? mean_by_32(four, w)
                                        : mean_of_planes(four, w);
        }
        hash = (hash << 1 | hash >> 31) ^ d;
    }
    return hash;
}

/// Kinds ///

LANES_INLINE lanes run(const struct layouts *l, enum layout kind,
                       enum products products)
{
    struct batch b;
    lanes hash = lanes_of(0);
    for (size_t n = 0; n < l->count; n += LAYOUT_GROUPS * WIDE_LANES) {
        place_batch(l, &b, n, kind);
        if (kind != LAYOUT_NONE && HAS_WORDS(kind))
            number_batch(l, &b, kind);
        FORGET(b.at);
        FORGET(b.voxel);
        hash = hash_batch(l, &b, n, kind, products, hash);
    }
    return hash;
}

/* The kernel's own lookup. */
LANES_INLINE lanes run_kernel(const struct layouts *l, bool copied)
{
    const struct wide_copy *copy = copied ? l->copy : NULL;
    if (copied && copy == NULL)
        __builtin_unreachable(); /* as the kernel knows its copies */

    const struct kernel k = KERNEL_OF(BRUME_U8, 0, true, false, false);
    const struct source s = source_of(l->frame, copy, false, k);
    struct lookups batch;
    lanes hash = lanes_of(0);
    for (size_t n = 0; n < l->count; n += LOOKUPS * WIDE_LANES) {
        for (uint32_t g = 0; g < LOOKUPS; g++) {
            size_t i = n + (size_t)g * WIDE_LANES;
            const lanes p[3] = {lanes_load(l->axis[0] + i),
                                lanes_load(l->axis[1] + i),
                                lanes_load(l->axis[2] + i)};
            want(&batch, g, &s, p, mask_first(WIDE_LANES), k);
        }
        look_up(&batch, LOOKUPS, &s, k);
        for (uint32_t g = 0; g < LOOKUPS; g++)
            hash = (hash << 1 | hash >> 31) ^ lanes_load(batch.d[g]);
    }
    return hash;
}

/* Each kind compiled by itself. */
#define OWN_RUN(name, layout, products) \
    static lanes name(const struct layouts *l) \
    { \
        return run(l, layout, products); \
    }
OWN_RUN(run_none, LAYOUT_NONE, PRODUCTS_NONE)
OWN_RUN(run_bricks_32, LAYOUT_BRICKS, PRODUCTS_32)
OWN_RUN(run_bricks_16, LAYOUT_BRICKS, PRODUCTS_16)
OWN_RUN(run_apron_32, LAYOUT_APRON, PRODUCTS_32)
OWN_RUN(run_apron_16, LAYOUT_APRON, PRODUCTS_16)
OWN_RUN(run_quads_32, LAYOUT_QUADS, PRODUCTS_32)
OWN_RUN(run_quads_16, LAYOUT_QUADS, PRODUCTS_16)
OWN_RUN(run_octets_32, LAYOUT_OCTETS, PRODUCTS_32)
OWN_RUN(run_octets_16, LAYOUT_OCTETS, PRODUCTS_OCTETS)
OWN_RUN(run_apron_pages_32, LAYOUT_APRON_PAGES, PRODUCTS_32)
OWN_RUN(run_apron_pages_16, LAYOUT_APRON_PAGES, PRODUCTS_16)
OWN_RUN(run_quad_pages_32, LAYOUT_QUAD_PAGES, PRODUCTS_32)
OWN_RUN(run_quad_pages_16, LAYOUT_QUAD_PAGES, PRODUCTS_16)

static lanes run_asset(const struct layouts *l)
{
    return run_kernel(l, false);
}

static lanes run_copy(const struct layouts *l)
{
    return run_kernel(l, true);
}

uint32_t LAYOUTS_RUN(const struct layouts *l, int kind)
{
    static lanes (*const k_run[LAYOUT_KINDS])(const struct layouts *) = {
        run_none,          run_asset,          run_bricks_32,
        run_bricks_16,     run_apron_32,       run_apron_16,
        run_quads_32,      run_quads_16,       run_octets_32,
        run_octets_16,     run_apron_pages_32, run_apron_pages_16,
        run_quad_pages_32, run_quad_pages_16,  run_copy};
    lanes hash = k_run[kind](l);
    uint32_t sum = 0;
    for (unsigned i = 0; i < WIDE_LANES; i++)
        sum = sum * 31u + hash[i];
    return sum;
}
