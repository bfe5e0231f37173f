/* SPDX-License-Identifier: MIT */
/*
 * What the core's files share. A file calls only files above it:
 *
 *   brume_fixed   maths              brume_camera    rays
 *   brume_tables  exp, sRGB          brume_march     the march
 *   brume_nrooks  N-rooks sets       brume_temporal  history
 *   brume_noise   jitter             brume_resolve   reprojection
 *   brume_asset   checking           brume_output    pixels
 *   brume_lattice which rays         brume_filter    space (brume_filter.h)
 *                                    brume_upsample  resolution
 *                                    brume_show      rows to pixels
 *                                    brume           frames
 */
#ifndef BRUME_INNER_H
#define BRUME_INNER_H

#include "brume.h"

#include "brume_fixed.h"

/// brume_fixed.c ///

/* 1 / sqrt(x): x in Q0.32, 2^-32 < x < 1 -> *shift, and m in Q1.31, so that
 * the result is m * 2^shift, 1 <= m / 2^31 < 2. Relative error < 2^-26. */
uint32_t brume_rsqrt(uint32_t x, unsigned *shift);

/* 2^63 / d for d >= 2^31, in (2^31, 2^32): Q0.32 -> Q1.31. Error below 4
 * units. Division by 32-bit words only, one of them. */
uint32_t brume_reciprocal(uint32_t d);

/* Makes v a unit vector in Q2.30, keeping its direction to 2^-26 and with a
 * length of 1 to 2^-26. v in any Q; false, and v untouched, when it is zero. */
bool brume_normalise(int32_t v[3]);

/* Sine and cosine of an angle in turns, Q0.32 -> Q2.30, error < 2^-28. */
void brume_sincos(uint32_t turn, int32_t *sine, int32_t *cosine);

/* Numbers m * 2^e (struct brume_number): always normalised. _of is exact; _q32
 * and _mul truncate, so they are at most 2^-31 (relative) too low. */
struct brume_number brume_number_of(uint32_t m, int32_t e);
struct brume_number brume_number_q32(uint64_t q32_32);
struct brume_number brume_number_mul(struct brume_number a,
                                     struct brume_number b);
/* 1 / a; a > 0. Relative error < 2^-29. */
struct brume_number brume_number_inverse(struct brume_number a);
/* floor(a * 2^q), at most 2^32 - 1. */
uint32_t brume_number_floor(struct brume_number a, int32_t q);

/* 1 - exp(-x) in Q0.32, x >= 0. Relative error < 2^-22, absolute < 2^-32
 * where that is more. */
uint32_t brume_one_minus_exp(struct brume_number x);

/// brume_tables.c (generated) ///

/* exp(-i / 16) and exp(-i / 4096) in Q1.15, rounded. 512 bytes each. */
extern const uint16_t brume_exp_coarse[256];
extern const uint16_t brume_exp_fine[256];

/* The lowest linear value in Q0.16 that rounds to code i + 1 in sRGB
 * (IEC 61966-2-1). 510 bytes. */
extern const uint16_t brume_srgb_threshold[255];

/// brume_nrooks.c (generated) ///

/* N-rooks sets of 1 .. 16 points in their order of use: 16 row + column. 256
 * bytes. */
extern const uint8_t brume_nrooks[16][16];

/// brume_noise.c ///

/* J of docs/SPEC.md, Q0.16, for a pixel, frame and channel. The table is read
 * by BRUME_NOISE_TABLE and those after it alone. */
uint32_t brume_noise_value(int noise, const struct brume_noise_table *values,
                           uint32_t x, uint32_t y, uint32_t frame,
                           uint32_t channel);

/* Is there such a noise, and has it the table that it needs? */
bool brume_noise_usable(int noise, const struct brume_noise_table *table);

/// brume_lattice.c ///

/* size / 2^log2, rounded up. */
BRUME_INLINE uint32_t brume_rays(uint32_t size, uint32_t log2)
{
    return (size + (1u << log2) - 1u) >> log2;
}

/* log2 of the image's pixels across a ray. */
BRUME_INLINE uint32_t brume_resolution_of(const struct brume_frame *f)
{
#if BRUME_WITH_RESOLUTION
    return f->resolution;
#else
    (void)f;
    return 0;
#endif
}

/* log2 of a cell's width (axis 0) or height, in rays of the grid. */
BRUME_INLINE uint32_t brume_cell_log2(uint32_t update, uint32_t axis)
{
    return update == BRUME_BAYER4    ? 2u
           : update == BRUME_CHECKER ? 1u - axis
                                     : 0;
}

/* Does anything use the depth of the scene's rays? */
BRUME_INLINE bool brume_scene_has_depth(const struct brume_scene *s)
{
    return s->temporal == BRUME_TAA ||
           (s->spatial != BRUME_SPATIAL_NONE && s->edge_falloff > 0) ||
           (s->resolution != BRUME_FULL && s->upsample == BRUME_UPSAMPLE_AWARE);
}

/* log2 of the frames after which every ray of the grid had its turn. */
BRUME_INLINE uint32_t brume_period_log2(uint32_t update)
{
    return update == BRUME_CHECKER ? 1u : update == BRUME_BAYER4 ? 4u : 0u;
}

/* Checks the scene's fields of time and space. */
int brume_lattice_check(const struct brume_scene *scene);

/* Sets grid, lattice, strata and the place in the pixel, of a checked scene. */
void brume_lattice_begin(struct brume_frame *frame,
                         const struct brume_scene *scene);

/// brume_camera.c ///

/* The lattice of one ray inside the pool. Positions carry the lookup's bias
 * (brume_frame.eye): 1/2 voxel for nearest, so that truncation finds the
 * voxel, and half of 1/256 for trilinear, so that truncating the weights
 * rounds them. */
struct brume_ray {
    uint32_t position[3]; /* first sample in the pool, Q16.16 */
    struct brume_line line;
    uint32_t count; /* samples in the pool */
    struct brume_light_ray light;
#if BRUME_WITH_DEPTH
    uint32_t t; /* distance of the first sample from the eye, Q16.16 */
#endif
};

/* Basis of the camera into frame->eye, ahead, per_x and per_y. */
int brume_camera_begin(struct brume_frame *frame,
                       const struct brume_scene *scene);

/* The middle of ray (x, y) of the grid, of any length, Q1.31. */
void brume_grid_direction(const struct brume_frame *frame, uint32_t x,
                          uint32_t y, int32_t out[3]);

/* Do the rays of all n pixels from (x, y) to the right pass the pool by? Says
 * no when in doubt. */
bool brume_rays_miss(const struct brume_frame *frame, uint32_t x, uint32_t y,
                     uint32_t n);

/* The ray of pixel (x, y). False when no sample falls in the pool. */
bool brume_ray_begin(struct brume_ray *ray, const struct brume_frame *frame,
                     uint32_t x, uint32_t y);

/* The light ray of a jitter in Q0.16; frame has its sun and light steps. */
void brume_light_begin(struct brume_light_ray *light,
                       const struct brume_frame *frame, uint32_t jitter);

/* floor((2^32 - 1) / |move|), all ones for no move. */
uint32_t brume_inverse_of_move(int32_t move);

/// brume_march.c ///

/* Depths are codes on a logarithmic scale, 2048 an octave, rounded down; 0 for
 * distances, Q16.16, of up to 2^-16 voxels. */
#define BRUME_NO_DEPTH 0xffffu
BRUME_INLINE uint32_t brume_depth_code(uint32_t distance)
{
    uint32_t high = distance == 0 ? 0 : 31u - leading_zeros(distance);
    uint32_t mantissa =
        high > 11 ? distance >> (high - 11u) : distance << (11u - high);
    return high << 11 | (mantissa & 0x7ffu);
}

#if BRUME_WITH_DEPTH
/* The code of a mean distance: t + step * moment / lost, t in Q16.16, moment
 * in units of 2^20 times those of lost. From 2^16 - 2^5 voxels on the largest
 * code stands for all; BRUME_NO_DEPTH when nothing was lost. */
uint32_t brume_mean_depth(const struct brume_frame *frame, uint32_t t,
                          uint32_t moment, uint32_t lost);
#endif

/* Chooses the kernel and fills the tables of density and light. */
int brume_march_begin(struct brume_frame *frame,
                      const struct brume_scene *scene);

/* n <= BRUME_SPAN pixels from (x, y) to the right. */
void brume_march_span(const struct brume_frame *frame, uint32_t x, uint32_t y,
                      uint32_t n, struct brume_radiance *out);

/// brume_temporal.c ///

/* A ray as it is kept. 65535 stands for 65536, else the values of struct
 * brume_radiance. */
#if defined(__GNUC__)
struct __attribute__((__may_alias__)) brume_sample {
#else
struct brume_sample {
#endif
    uint16_t light, transmittance, depth;
};

BRUME_INLINE uint16_t sample_of(uint32_t q16)
{
    return (uint16_t)(q16 - (q16 >> 16));
}

BRUME_INLINE uint32_t of_sample(uint32_t code)
{
    return code + ((code + 1u) >> 16);
}

BRUME_INLINE struct brume_sample
brume_sample_from(const struct brume_radiance *in)
{
    struct brume_sample s = {sample_of(in->light), sample_of(in->transmittance),
                             0};
#if BRUME_WITH_DEPTH
    s.depth = (uint16_t)in->depth;
#endif
    return s;
}

#if BRUME_WITH_TEMPORAL
/* A word for all that decides on the planes but the image's size; never 0. */
uint32_t brume_state_layout(const struct brume_frame *frame);

/* Was the state begun with this frame, or one of the same planes? */
BRUME_INLINE bool brume_state_fits(const struct brume_state *state,
                                   const struct brume_frame *frame)
{
    return state->layout == brume_state_layout(frame) &&
           state->image[0] == frame->width && state->image[1] == frame->height;
}

/* The frame's rays of the lattice, row after row. */
BRUME_INLINE struct brume_sample *
brume_sample_at(const struct brume_state *state, uint32_t i)
{
    return (struct brume_sample *)(void *)((uint8_t *)(uintptr_t)state +
                                           state->samples) +
           i;
}

/* Frames since ray (x, y) of the grid had its turn to be marched: 0 when it is
 * now. */
uint32_t brume_age_of(const struct brume_frame *frame, uint32_t x, uint32_t y);

/* Number of the lattice's ray in whose cell ray (x, y) of the grid is. */
uint32_t brume_lattice_index(const struct brume_frame *frame, uint32_t x,
                             uint32_t y);

/* Puts n rays of the lattice, from (x, y) to the right. */
void brume_store_span(const struct brume_frame *frame,
                      struct brume_state *state, uint32_t x, uint32_t y,
                      uint32_t n, const struct brume_radiance *in);

/* Ray number i of the grid in a plane of history, in 16 bits; depth 0 when the
 * scene has no use for it. */
void brume_history_get(const struct brume_frame *frame,
                       const struct brume_state *state, uint32_t plane,
                       uint32_t i, struct brume_sample *out);

/* Writes old + alpha (in - old) as ray (x, y) of a plane, in its bits, rounded
 * without bias. */
void brume_history_put(const struct brume_frame *frame,
                       struct brume_state *state, uint32_t plane, uint32_t x,
                       uint32_t y, const struct brume_sample *old,
                       const struct brume_sample *in, uint32_t alpha);

/* n rays of the grid from (x, y), as history has them after this frame. */
void brume_history_row(const struct brume_frame *frame,
                       const struct brume_state *state, uint32_t x, uint32_t y,
                       uint32_t n, struct brume_sample *out);
#endif

/// brume_resolve.c ///

#if BRUME_WITH_TAA
/* The camera's motion since the state's frame, and whether anything moved. */
void brume_motion_begin(struct brume_state *state,
                        const struct brume_frame *frame);

/* n rays of the grid from (x, y) to the right. */
void brume_resolve_span(const struct brume_frame *frame,
                        struct brume_state *state, uint32_t x, uint32_t y,
                        uint32_t n);
#endif

/// brume_output.c ///

/* Are the w x h at (x, y) inside of a width and a height? */
BRUME_INLINE bool brume_rect_fits(const uint16_t size[2], unsigned x,
                                  unsigned y, unsigned w, unsigned h)
{
    return x <= size[0] && w <= size[0] - x && y <= size[1] && h <= size[1] - y;
}

/* Is there room for w x h pixels, and is their format compiled in? */
int brume_pixels_check(int pixel_format, unsigned w, unsigned h, size_t stride);

/* Composes n pixels over the background and packs them. */
void brume_pack_span(const struct brume_frame *frame,
                     const struct brume_radiance *in, uint32_t n,
                     int pixel_format, void *dst);

#endif
