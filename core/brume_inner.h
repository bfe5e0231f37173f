/* SPDX-License-Identifier: MIT */
/*
 * What the core's files share. A file calls only files above it:
 *
 *   brume_fixed    maths                brume_lit      the lit march
 *   brume_tables   exp, sRGB, filmic    brume_sky      behind the volume
 *   brume_nrooks   N-rooks sets         brume_march    the march
 *   brume_noise    jitter               brume_cache    the sun's cache
 *   brume_phase    phase functions      brume_temporal history
 *   brume_asset    checking             brume_resolve  reprojection
 *   brume_lattice  which rays           brume_output   pixels
 *   brume_surface  surface, sun's map   brume_filter   space (brume_filter.h)
 *   brume_camera   the view             brume_upsample resolution
 *   brume_ray      rays                 brume_show     rows to pixels
 *   brume_fog      fog of a frame       brume          frames
 *   brume_lighting lighting of a frame  brume_shadow   the shadow outwards
 *   brume_lamps    which lamps reach what
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

#if BRUME_WITH_LIGHTING
/* floor(a n / 2^down), at most 2^32 - 1; exact for n = 1. */
BRUME_INLINE uint32_t brume_times(uint32_t a, uint32_t down,
                                  struct brume_number n)
{
    uint32_t high = mul_hi_floor(a, n.m), low = a * n.m;
    int32_t up = n.e + 32 - (int32_t)down; /* 1 has m = 2^31, e = -31 */
    if (up <= 0)
        return up > -32 ? high >> (uint32_t)-up : 0;
    if (up > 31 || high >> (32u - (uint32_t)up) != 0)
        return high | low ? 0xffffffffu : 0;
    return high << (uint32_t)up | low >> (32u - (uint32_t)up);
}
#endif

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

/* Where the search for a code begins: codes of 0, 2^8 .. 2^12, then 2^10 apart
 * up to 2^14, then 2^12 apart up to 2^16. 41 bytes. */
extern const uint8_t brume_srgb_start[41];

#if BRUME_WITH_TONE
/* The same of BRUME_FILMIC, Q16.16. 1020 bytes. */
extern const uint32_t brume_filmic_threshold[255];
#endif

#if BRUME_WITH_DITHER
/* Linear values of 64, 32 and 16 levels equally far apart in sRGB, Q0.16, as
 * of_sample reads them. 224 bytes. */
extern const uint16_t brume_srgb_level63[64];
extern const uint16_t brume_srgb_level31[32];
extern const uint16_t brume_srgb_level15[16];
#endif

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

/// brume_phase.c ///

#if BRUME_WITH_LIGHTING
/* The sum, truncated. */
struct brume_number brume_number_plus(struct brume_number a,
                                      struct brume_number b);

/* log2(a) with 16 fraction bits; a > 0. Error < 2^-14. */
int32_t brume_log2(struct brume_number a);

/* 1 - cos of the angle between two unit vectors, all Q2.30, as half the square
 * of their difference: exact where they are nearly the same. */
uint32_t brume_one_minus_cos(const int32_t a[3], const int32_t b[3]);

/* 2^y, y in Q16.16. Relative error < 2^-12. */
struct brume_number brume_exp2(uint32_t y);
#endif

#if BRUME_WITH_STOCHASTIC
/* Axis i of point n of the R3 sequence, the powers of 1 / x for x^4 = x + 1,
 * modulo 1 in Q0.16 and whole steps above (M. Roberts, "The Unreasonable
 * Effectiveness of Quasirandom Sequences", 2018). */
BRUME_INLINE uint32_t brume_r3(uint32_t n, uint32_t i)
{
    return n * (i == 0 ? 53685u : i == 1 ? 43978u : 36025u);
}
#endif

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

/* The frame number that noise sees. */
BRUME_INLINE uint32_t brume_noise_frame(const struct brume_frame *f)
{
#if BRUME_WITH_TEMPORAL
    return f->noise_frame;
#else
    return f->frame;
#endif
}

BRUME_INLINE bool brume_scene_has_haze(const struct brume_scene *s)
{
#if BRUME_WITH_SKY
    return s->lighting != NULL && s->lighting->haze != 0;
#else
    (void)s;
    return false;
#endif
}

/* Does anything use the depth of the scene's rays? */
BRUME_INLINE bool brume_scene_has_depth(const struct brume_scene *s)
{
    return s->temporal == BRUME_TAA ||
           (s->spatial != BRUME_SPATIAL_NONE && s->edge_falloff > 0) ||
           (s->resolution != BRUME_FULL &&
            s->upsample == BRUME_UPSAMPLE_AWARE) ||
           brume_scene_has_haze(s);
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

/// brume_surface.c ///

#if BRUME_WITH_SURFACE
bool brume_surface_is_good(const struct brume_surface *surface, uint32_t width);
bool brume_sun_map_is_good(const struct brume_sun_map *map);

/* Of a checked scene that has a sun map. False when it does not lie across the
 * sun, or is no plane. */
bool brume_sun_map_begin(struct brume_frame *frame,
                         const struct brume_scene *scene);
uint32_t brume_sun_map_sameness(const struct brume_frame *frame);

BRUME_INLINE bool brume_has_surface(const struct brume_frame *f)
{
    return f->lit.lighting != NULL && f->lit.lighting->surface != NULL;
}

/* How far from the eye the surface is that ray (x, y) of the grid meets,
 * Q16.16: samples from there on are behind it. All ones: none. */
uint32_t brume_surface_distance(const struct brume_frame *frame, uint32_t x,
                                uint32_t y);
#endif

/* How many of the samples at t, t + step, ... are nearer than `end`, Q16.16;
 * all that there can be for an end of all ones. */
BRUME_INLINE uint32_t brume_samples_before(uint32_t end, uint32_t t,
                                           uint32_t step)
{
    if (end == 0xffffffffu)
        return end;
    return end > t ? (end - t - 1u) / step + 1u : 0;
}

/// brume_camera.c ///

/* Is there fog, so that rays have samples outside of the pool? */
BRUME_INLINE bool brume_has_fog(const struct brume_frame *f)
{
#if BRUME_WITH_FOG
    return f->lit.fog.on;
#else
    (void)f;
    return false;
#endif
}

/* out = a x b, of vectors of at most unit length, Q2.30. */
static inline void brume_cross(int32_t out[3], const int32_t a[3],
                               const int32_t b[3])
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = mul_both_signed_round(a[j], b[k], 2) -
                 mul_both_signed_round(a[k], b[j], 2);
    }
}

/* Basis of the camera into frame->eye, ahead, per_x and per_y. */
int brume_camera_begin(struct brume_frame *frame,
                       const struct brume_scene *scene);

/// brume_ray.c ///

#define BRUME_RAY_HAS_T \
    (BRUME_WITH_DEPTH || BRUME_WITH_FOG || BRUME_WITH_SURFACE)

/* The lattice of one ray inside the pool. Positions carry the lookup's bias
 * (brume_frame.eye): 1/2 voxel for nearest, so that truncation finds the
 * voxel, and half of 1/256 for trilinear, so that truncating the weights
 * rounds them. */
struct brume_ray {
    uint32_t position[3]; /* first sample in the pool, Q16.16 */
    struct brume_line line;
    uint32_t count; /* samples in the pool */
    struct brume_light_ray light;
#if BRUME_RAY_HAS_T
    uint32_t t; /* distance of the first sample from the eye, Q16.16 */
#endif
#if BRUME_WITH_FOG
    /* With fog the first sample is that of the eye, number 0: this many lie
     * before those in the pool, and this many are there in all. */
    uint32_t before, samples;
#endif
#if BRUME_WITH_LIGHTING /* when frame.lit.on */
    int32_t unit[3];    /* direction, Q2.30 */
    uint32_t x, y;      /* of the grid */
    uint32_t noise[3];  /* Q0.16, three more values */
#endif
};

/* The middle of pixel (x, y) of the image, of any length, Q1.31. */
void brume_pixel_direction(const struct brume_frame *frame, uint32_t x,
                           uint32_t y, int32_t out[3]);

/* The middle of ray (x, y) of the grid, of any length, Q1.31. */
void brume_grid_direction(const struct brume_frame *frame, uint32_t x,
                          uint32_t y, int32_t out[3]);

#if BRUME_WITH_AMBIENT || BRUME_WITH_SKY || BRUME_WITH_FOG || BRUME_WITH_SURFACE
/* Q2.30 . Q2.30, of two unit vectors: -1 .. 1. */
BRUME_INLINE int32_t brume_dot(const int32_t a[3], const int32_t b[3])
{
    int32_t sum = 0;
    for (int i = 0; i < 3; i++)
        sum += mul_both_signed_round(a[i], b[i], 2);
    return sum;
}
#endif

/* Do the rays of all n pixels from (x, y) to the right pass the pool by? Says
 * no when in doubt. */
bool brume_rays_miss(const struct brume_frame *frame, uint32_t x, uint32_t y,
                     uint32_t n);

/* The ray of pixel (x, y). False when it has no sample: none in the pool, or
 * with fog anywhere. */
bool brume_ray_begin(struct brume_ray *ray, const struct brume_frame *frame,
                     uint32_t x, uint32_t y);

/* The position at distance t, Q16.16, in a direction; modulo 2^32. */
static inline void brume_ray_place(const struct brume_frame *f,
                                   const int32_t unit[3], uint32_t t,
                                   uint32_t out[3])
{
    for (int i = 0; i < 3; i++) {
        uint32_t m = magnitude(unit[i]);
        /* Q30 * Q16 -> Q16, rounded */
        uint32_t way =
            (mul_hi_floor(m, t) << 2 | (m * t) >> 30) + ((m * t) >> 29 & 1u);
        out[i] = (uint32_t)f->eye[i] + (unit[i] < 0 ? 0u - way : way);
    }
}

#if BRUME_WITH_CONE
/* What sample i of a cone's n stands for: the `length` light steps, at least
 * 2^log2 of them, from before + length on. So with a light ray whose first
 * sample is 1 + j steps away, that of the segment's part j is length times as
 * far, and `before` steps. From eight steps on each octave has two segments,
 * and the last one is twice as long: docs/light.md. */
struct brume_segment {
    uint32_t length, log2, before;
};
BRUME_INLINE struct brume_segment brume_segment_of(uint32_t i, uint32_t n)
{
    struct brume_segment s = {3, 1, 0u - 2u};
    if (i == 0)
        return s;
    s.log2 = (i >> 1) + (i == 1 ? 2u : 1u);
    s.before = i == 1 ? 0 : (1u + (i & 1u)) << s.log2;
    if (i > 1 && i == n - 1u) {
        s.before -= 1u << s.log2;
        s.log2++;
    }
    s.length = 1u << s.log2;
    return s;
}
#endif

/* The light ray of a jitter in Q0.16; frame has its sun and light steps. */
void brume_light_begin(struct brume_light_ray *light,
                       const struct brume_frame *frame, uint32_t jitter);

/* floor((2^32 - 1) / |move|), all ones for no move. */
uint32_t brume_inverse_of_move(int32_t move);

/// brume_fog.c ///

#if BRUME_WITH_FOG
/* Is that a fog that a frame can have? */
bool brume_fog_is_good(const struct brume_fog *fog);

/* Of a checked scene that has fog; sun, zenith and camera are known. */
void brume_fog_begin(struct brume_frame *frame,
                     const struct brume_scene *scene);

/* A word that changes with it. */
uint32_t brume_fog_sameness(const struct brume_frame *frame);
#endif

/// brume_lighting.c ///

#if BRUME_WITH_LIGHTING
BRUME_INLINE bool brume_is_grey(const uint32_t c[3])
{
    return c[0] == c[1] && c[1] == c[2];
}

BRUME_INLINE uint32_t brume_ambient_colours(uint32_t ambient)
{
    return ambient == BRUME_AMBIENT_NONE       ? 0
           : ambient == BRUME_AMBIENT_CONSTANT ? 1u
           : ambient == BRUME_AMBIENT_GRADIENT ? 2u
                                               : 6u;
}

/* Has the light of the scene colours? Behind the volume they do not count. */
BRUME_INLINE bool brume_scene_has_colour(const struct brume_scene *s)
{
    const struct brume_lighting *l = s->lighting;
    if (l == NULL)
        return false;
    bool grey = brume_is_grey(l->sun_colour);
    for (uint32_t j = 0; j < brume_ambient_colours(l->ambient); j++)
        grey = grey && brume_is_grey(l->ambient_colour[j]);
    /* also of scenes that nobody has checked yet */
    uint32_t lamps = l->lamps != NULL ? l->lamp_count : 0;
    for (uint32_t i = 0; i < lamps && i < BRUME_MAX_LAMPS; i++)
        grey = grey && brume_is_grey(l->lamps[i].colour);
    for (uint32_t i = 0;
         BRUME_WITH_EMISSION && l->emission_colour != NULL && grey && i < 256;
         i++)
        grey = brume_is_grey(l->emission_colour[i]);
    return !grey;
}

/* Is the scene marched by brume_lit.c? */
BRUME_INLINE bool brume_scene_is_lit(const struct brume_scene *s)
{
    return s->lighting != NULL || s->filter == BRUME_STOCHASTIC ||
           s->light > BRUME_NO_LIGHT;
}

/* Checks the scene's lighting. */
int brume_lit_check(const struct brume_scene *scene);

/* Colours, weights and directions, of a checked scene and a volume that has
 * what it needs; the sun is known. BRUME_ERR_SECTION when the volume lacks
 * it. */
int brume_lit_begin(struct brume_frame *frame, const struct brume_scene *scene);

/* albedo * colour * exposure, Q16.16, each channel; colour <= 256. */
void brume_lit_colour(uint32_t out[3], const struct brume_scene *scene,
                      const uint32_t colour[3]);

/* Mips of light = cone: of a segment of 2^m voxels' length that of level m +
 * this. Measured: docs/light.md. */
#define BRUME_CONE_LEVEL (-1)

#if BRUME_WITH_AMBIENT || BRUME_WITH_FOG
/* A position along zenith, Q17.14: anywhere within +-32768 voxels. */
BRUME_INLINE int32_t brume_along_zenith(const struct brume_frame *f,
                                        const uint32_t p[3])
{
    int32_t sum = 0; /* three of at most 2^29 */
    for (int i = 0; i < 3; i++)
        sum += mul_both_signed_round(f->lit.zenith[i], as_signed(p[i]), 0);
    return sum;
}
#endif

/* A word that changes with the light. */
uint32_t brume_lit_sameness(const struct brume_frame *frame);

/// brume_lamps.c ///

#if BRUME_WITH_LAMPS
/* Checks the scene's lamps. */
int brume_lamps_check(const struct brume_scene *scene);

/* Fills the clusters of a checked scene; camera and lighting are known. */
void brume_lamps_begin(struct brume_frame *frame,
                       const struct brume_scene *scene);

/* A coordinate, Q16.16, in two's complement, as lamps have it: halved, so that
 * differences of any two are signed words; plus 2^30, so that none is below
 * 0. */
BRUME_INLINE uint32_t brume_halved(uint32_t p)
{
    return (p + 0x80000000u) >> 1;
}

BRUME_INLINE uint64_t brume_square(int32_t a)
{
#if BRUME_MUL64
    return (uint64_t)((int64_t)a * a);
#else
    uint32_t m = magnitude(a);
    return (uint64_t)mul_hi_floor(m, m) << 32 | m * m;
#endif
}

/* A word that changes with the lamps, wherever the camera is. */
uint32_t brume_lamps_sameness(const struct brume_frame *frame);
#endif

/// brume_lit.c ///

/* Density at a position, as brume_lookup.h's density_at. */
bool brume_lit_density(const struct brume_frame *frame, uint32_t x, uint32_t y,
                       uint32_t z, uint32_t *d, const uint32_t moved[3]);

/* Half a voxel less the bias that positions of the frame carry, Q16.16. */
BRUME_INLINE uint32_t brume_half_voxel(const struct brume_frame *f)
{
    return f->lit.stochastic ? 0x8000u : f->kernel & 4u ? 0x8000u - 128u : 0;
}

#if BRUME_WITH_CACHE
/* Density towards the sun from a position in the pool, in units of
 * lit.sun_unit. */
uint32_t brume_lit_sun_sum(const struct brume_frame *frame,
                           const uint32_t p[3]);
#endif

/* The march of a lit frame. */
void brume_lit_march(const struct brume_frame *frame,
                     const struct brume_ray *ray, struct brume_radiance *out);

/* The end of a ray that gathered that (brume_ambient.h) in direction `unit`,
 * Q2.30, and has a transmittance in Q1.31 left: sums to light, phase, colours,
 * haze. out->depth is set already. For marches other than the one above. */
struct gathered;
void brume_lit_finish(const struct brume_frame *frame, const struct gathered *g,
                      const int32_t unit[3], uint32_t transmittance,
                      struct brume_radiance *out);
#endif

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
 * brume_radiance; light is divided by 2^lit.light_log2.
 *
 * Where light has colour, each ray has two of these: red, transmittance, depth
 * in layer 0; green, blue, nothing in layer 1. A layer is a plane (a line) of
 * its own, behind the other: so passes do to layer 0 what they do to a ray
 * without colour, and then the same to layer 1, where light and transmittance
 * are treated alike. What decides (edges, motion, turns) is in layer 0.
 * Functions have a `layer` that is constant where they are inlined. */
#if defined(__GNUC__)
struct __attribute__((__may_alias__)) brume_sample {
#else
struct brume_sample {
#endif
    uint16_t light, transmittance, depth;
};

#define BRUME_LAYERS (BRUME_WITH_COLOUR ? 2 : 1) /* at most */
BRUME_INLINE bool brume_has_colour(const struct brume_frame *f)
{
#if BRUME_WITH_COLOUR
    return f->lit.colour;
#else
    (void)f;
    return false;
#endif
}

BRUME_INLINE uint16_t sample_of(uint32_t q16)
{
    return (uint16_t)(q16 - (q16 >> 16));
}

BRUME_INLINE uint32_t of_sample(uint32_t code)
{
    return code + ((code + 1u) >> 16);
}

/* log2 of what a frame's light is divided by. */
BRUME_INLINE uint32_t brume_light_log2(const struct brume_frame *f)
{
#if BRUME_WITH_LIGHTING
    return f->lit.light_log2;
#else
    (void)f;
    return 0;
#endif
}

/* Light as it is kept, rounded to the nearest; what is too bright, as the
 * brightest. */
BRUME_INLINE uint16_t sample_of_light(uint32_t light, uint32_t log2)
{
#if BRUME_WITH_LIGHTING
    const uint32_t most = 0x10000u << log2;
    light = ((light < most ? light : most) + (1u << log2 >> 1)) >> log2;
#else
    (void)log2;
#endif
    return sample_of(light);
}

BRUME_INLINE uint32_t light_of_sample(uint32_t code, uint32_t log2)
{
    return of_sample(code) << log2;
}

BRUME_INLINE struct brume_sample
brume_sample_from(const struct brume_radiance *in, uint32_t light_log2,
                  uint32_t layer)
{
#if BRUME_WITH_COLOUR
    if (layer == 1) {
        struct brume_sample more = {sample_of_light(in->green, light_log2),
                                    sample_of_light(in->blue, light_log2), 0};
        return more;
    }
#endif
    struct brume_sample s = {sample_of_light(in->light, light_log2),
                             sample_of(in->transmittance), 0};
    (void)layer;
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
brume_sample_at(const struct brume_frame *frame,
                const struct brume_state *state, uint32_t i, uint32_t layer)
{
    return (struct brume_sample *)(void *)((uint8_t *)(uintptr_t)state +
                                           state->samples) +
           layer * frame->lattice[0] * frame->lattice[1] + i;
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

/* The same for layer 1, with colour; brume_store_span does both. */
void brume_colours_get(const struct brume_frame *frame,
                       const struct brume_state *state, uint32_t plane,
                       uint32_t i, struct brume_sample *out);
void brume_colours_put(const struct brume_frame *frame,
                       struct brume_state *state, uint32_t plane, uint32_t x,
                       uint32_t y, const struct brume_sample *old,
                       const struct brume_sample *in, uint32_t alpha);
void brume_colours_row(const struct brume_frame *frame,
                       const struct brume_state *state, uint32_t x, uint32_t y,
                       uint32_t n, struct brume_sample *out);

/* Either, of a layer that is known when compiling. */
BRUME_INLINE void brume_layer_get(const struct brume_frame *f,
                                  const struct brume_state *s, uint32_t plane,
                                  uint32_t i, struct brume_sample *out,
                                  uint32_t layer)
{
    if (BRUME_WITH_COLOUR && layer == 1)
        brume_colours_get(f, s, plane, i, out);
    else
        brume_history_get(f, s, plane, i, out);
}

BRUME_INLINE void brume_layer_put(const struct brume_frame *f,
                                  struct brume_state *s, uint32_t plane,
                                  uint32_t x, uint32_t y,
                                  const struct brume_sample *old,
                                  const struct brume_sample *in, uint32_t alpha,
                                  uint32_t layer)
{
    if (BRUME_WITH_COLOUR && layer == 1)
        brume_colours_put(f, s, plane, x, y, old, in, alpha);
    else
        brume_history_put(f, s, plane, x, y, old, in, alpha);
}
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

/// brume_sky.c ///

#if BRUME_WITH_SKY
/* Sets what is behind the volume, of a checked scene. */
void brume_sky_begin(struct brume_frame *frame,
                     const struct brume_scene *scene);

/* The sky at pixel (x, y), Q16.16, at most BRUME_MAX_LIGHT. */
void brume_sky_colour(const struct brume_frame *frame, uint32_t x, uint32_t y,
                      uint32_t out[3]);
#endif

/// brume_output.c ///

/* Are the w x h at (x, y) inside of a width and a height? */
BRUME_INLINE bool brume_rect_fits(const uint16_t size[2], unsigned x,
                                  unsigned y, unsigned w, unsigned h)
{
    return x <= size[0] && w <= size[0] - x && y <= size[1] && h <= size[1] - y;
}

#if BRUME_WITH_LIGHTING
/* Bits per pixel of a format, 0 when there is no such format. */
unsigned brume_pixel_bits(int pixel_format);
#endif

/* Bytes from the first pixel of a row to that of pixel i. */
BRUME_INLINE size_t brume_pixel_offset(int pixel_format, uint32_t i)
{
#if BRUME_WITH_LIGHTING
    return (size_t)i * brume_pixel_bits(pixel_format) >> 3;
#else
    return (size_t)i * brume_pixel_bytes(pixel_format);
#endif
}

/* Is there room for w x h pixels, and is their format compiled in? */
int brume_room_check(int pixel_format, unsigned w, unsigned h, size_t stride);

/* The same of a rectangle that begins in column x: bytes are not shared. */
BRUME_INLINE int brume_pixels_check(int pixel_format, unsigned x, unsigned w,
                                    unsigned h, size_t stride)
{
#if BRUME_WITH_DITHER
    if ((x & 7u) != 0 && brume_pixel_bytes(pixel_format) == 0)
        return BRUME_ERR_RECT;
#else
    (void)x;
#endif
    return brume_room_check(pixel_format, w, h, stride);
}

#if BRUME_WITH_TONE
/* x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14), at most 1: Q16.16 -> Q0.16,
 * any x. Error below 0.7 of 2^-16. */
uint32_t brume_filmic(uint32_t x);
#endif

/* Composes n pixels, those from (x, y) of the image to the right, over the
 * background and packs them. `dst` is the byte in which the first one is. */
void brume_pack_span(const struct brume_frame *frame, uint32_t x, uint32_t y,
                     const struct brume_radiance *in, uint32_t n,
                     int pixel_format, void *dst);

#endif
