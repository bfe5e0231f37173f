/* SPDX-License-Identifier: MIT */
/*
 * What the core's files share. A file calls only files above it:
 *
 *   brume_fixed   maths              brume_camera  rays
 *   brume_tables  exp, sRGB          brume_march   the march
 *   brume_noise   jitter             brume_output  pixels
 *   brume_asset   checking           brume         frames
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

/// brume_noise.c ///

/* J of docs/SPEC.md, Q0.16, for a pixel, frame and channel. The table is read
 * by BRUME_NOISE_TABLE and those after it alone. */
uint32_t brume_noise_value(int noise, const struct brume_noise_table *values,
                           uint32_t x, uint32_t y, uint32_t frame,
                           uint32_t channel);

/* Is there such a noise, and has it the table that it needs? */
bool brume_noise_usable(int noise, const struct brume_noise_table *table);

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
};

/* Basis of the camera into frame->eye, ahead, per_x and per_y. */
int brume_camera_begin(struct brume_frame *frame,
                       const struct brume_scene *scene);

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

/* Radiance of the volume and transmittance to the background. */
struct brume_radiance {
    uint32_t light;         /* Q16.16, albedo applied, 1.0 = the sun's */
    uint32_t transmittance; /* Q0.16 */
};

/* Chooses the kernel and fills the tables of density and light. */
int brume_march_begin(struct brume_frame *frame,
                      const struct brume_scene *scene);

/* n <= BRUME_SPAN pixels from (x, y) to the right. */
void brume_march_span(const struct brume_frame *frame, uint32_t x, uint32_t y,
                      uint32_t n, struct brume_radiance *out);

/// brume_output.c ///

/* Composes n pixels over the background and packs them. */
void brume_pack_span(const struct brume_frame *frame,
                     const struct brume_radiance *in, uint32_t n,
                     int pixel_format, void *dst);

#endif
