/* SPDX-License-Identifier: MIT */
/*
 * brume: clouds, smoke and fog from baked OpenVDB data, in integers.
 *
 * CONVENTIONS
 *
 * Spaces   Everything here is in pool space: the volume's voxels, the centre
 *          of the first one at (0,0,0), right-handed axes parallel to index
 *          space. docs/SPEC.md says how it hangs on index and world space.
 * Camera   Pinhole. Row 0 is on top, a pixel's centre at (x+1/2, y+1/2).
 * Light    One sun at infinity; `sun` points towards it.
 * Samples  On a lattice fixed by the eye, t_k = (k + jitter) * step, k >= 0.
 *          So leaping over empty cells cannot change a pixel.
 * Fixed    Qm.n is an integer with n fraction bits (and m before them; the
 * point    sign included where the type has one). In this header:
 *
 *   Q16.16 int32_t   positions, lengths in voxels; uint32_t steps, degrees
 *   Q2.30  int32_t   unit vectors
 *   Q0.16  uint32_t  0 .. 65536, both ends included: albedo, transmittance,
 *                    grey levels
 *   Q32.32 uint64_t  densities and extinction per unit density per voxel
 *
 * Memory   The caller owns all of it. The library has no heap, no writable
 *          statics, no recursion, and needs at most 2.5 KiB of stack on
 *          32-bit processors, 3.8 KiB on others; without lighting and
 *          sequences 0.8 (optimised builds; the bound of each target is in
 *          docs/TARGETS.md).
 *          Structs may be copied; they point only at the asset (brume_volume),
 *          at the volume, at a noise table's values, at the lighting and what
 *          that points at (brume_frame).
 * Threads  Functions that take pointers to const may run at the same time:
 *          one brume_frame serves any number of brume_render_rect.
 * Errors   Functions returning int give BRUME_OK (0) or a negative
 *          enum brume_error. Nothing else can fail.
 */
#ifndef BRUME_H
#define BRUME_H

#ifdef BRUME_CONFIG /* -DBRUME_CONFIG='"my_config.h"' overrides what follows \
                     */
#include BRUME_CONFIG
#endif

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Version ///

/* Major: sources may need changes. Minor: additions. Patch: neither. */
#define BRUME_VERSION_MAJOR 0
#define BRUME_VERSION_MINOR 1
#define BRUME_VERSION_PATCH 0

/// Compile-time choices ///

/* What is compiled in, 1 or 0. Each costs code only: about 1 KiB of Thumb-2
 * (-Os) per combination of format, apron, lookup, light and clamp; nearest
 * lookup of one format with log light takes 1.7 KiB, all together 48 KiB. A
 * scene that asks for what is missing gets BRUME_ERR_FEATURE; what it does
 * render is the same image as with everything compiled in. */
#ifndef BRUME_WITH_U8
#define BRUME_WITH_U8 1
#endif
#ifndef BRUME_WITH_U8R
#define BRUME_WITH_U8R 1
#endif
#ifndef BRUME_WITH_U4R
#define BRUME_WITH_U4R 1
#endif
#ifndef BRUME_WITH_APRON /* assets whose bricks are stored with an apron */
#define BRUME_WITH_APRON 1
#endif
#ifndef BRUME_WITH_NEAREST
#define BRUME_WITH_NEAREST 1
#endif
#ifndef BRUME_WITH_TRILINEAR
#define BRUME_WITH_TRILINEAR 1
#endif
#ifndef BRUME_WITH_UNIFORM /* light = uniform; log is always there */
#define BRUME_WITH_UNIFORM 1
#endif
#ifndef BRUME_WITH_MAX_DENSITY /* max_density below the asset's maximum */
#define BRUME_WITH_MAX_DENSITY 1
#endif
#ifndef BRUME_WITH_RGB /* pixel formats with colour; 0.4 KiB */
#define BRUME_WITH_RGB 1
#endif
#ifndef BRUME_WITH_NOISE /* jitter; 0.6 KiB */
#define BRUME_WITH_NOISE 1
#endif
/* All of "Sequences" below, brume_march_rect and brume_pack_rect, or which of
 * it. Passes from rays to pixels take 1.7 KiB, and depth adds 40 bytes to each
 * kernel. */
#ifndef BRUME_WITH_SEQUENCES
#define BRUME_WITH_SEQUENCES 1
#endif
#ifndef BRUME_WITH_TEMPORAL /* ema, window, update, subpixel; 3.5 KiB */
#define BRUME_WITH_TEMPORAL BRUME_WITH_SEQUENCES
#endif
#ifndef BRUME_WITH_TAA /* taa; 2.4 KiB; needs the one above */
#define BRUME_WITH_TAA (BRUME_WITH_SEQUENCES && BRUME_WITH_TEMPORAL)
#endif
#ifndef BRUME_WITH_SPATIAL /* spatial filters; 0.7 KiB */
#define BRUME_WITH_SPATIAL BRUME_WITH_SEQUENCES
#endif
#ifndef BRUME_WITH_RESOLUTION /* half and quarter; 0.6 KiB */
#define BRUME_WITH_RESOLUTION BRUME_WITH_SEQUENCES
#endif
/* All of "Lighting" below, or which of it: struct brume_lighting with phase
 * functions and octaves of multiple scattering takes 5.7 KiB with one format
 * and lookup, all of it with everything 51. */
#ifndef BRUME_WITH_LIGHTING
#define BRUME_WITH_LIGHTING 1
#endif
#ifndef BRUME_WITH_AMBIENT /* light from the sky; 3.6 KiB */
#define BRUME_WITH_AMBIENT BRUME_WITH_LIGHTING
#endif
#ifndef BRUME_WITH_COLOUR /* coloured light; needs BRUME_WITH_RGB; 5.1 KiB */
#define BRUME_WITH_COLOUR (BRUME_WITH_LIGHTING && BRUME_WITH_RGB)
#endif
#ifndef BRUME_WITH_CONE /* light = cone: mips; 2.0 KiB */
#define BRUME_WITH_CONE BRUME_WITH_LIGHTING
#endif
#ifndef BRUME_WITH_CACHE /* light = cache; 1.9 KiB */
#define BRUME_WITH_CACHE BRUME_WITH_LIGHTING
#endif
#ifndef BRUME_WITH_STOCHASTIC /* filter = stochastic; 1.9 KiB */
#define BRUME_WITH_STOCHASTIC \
    (BRUME_WITH_LIGHTING && BRUME_WITH_NEAREST && BRUME_WITH_NOISE)
#endif
#ifndef BRUME_WITH_SKY /* sky, sun disc, haze; 0.8 KiB */
#define BRUME_WITH_SKY BRUME_WITH_LIGHTING
#endif
#ifndef BRUME_WITH_SHADOW /* the shadow on other things; 2.5 KiB */
#define BRUME_WITH_SHADOW BRUME_WITH_LIGHTING
#endif
#ifndef BRUME_WITH_TONE /* output = filmic; 1.1 KiB */
#define BRUME_WITH_TONE BRUME_WITH_LIGHTING
#endif
#ifndef BRUME_WITH_FOG /* fog by height, spheres and boxes of it; 7.0 KiB */
#define BRUME_WITH_FOG BRUME_WITH_LIGHTING
#endif
#ifndef BRUME_WITH_LAMPS /* point and spot lights; 5.5 KiB */
#define BRUME_WITH_LAMPS BRUME_WITH_LIGHTING
#endif
#ifndef BRUME_WITH_SURFACE /* depth buffers, the sun's map; 2.0 KiB */
#define BRUME_WITH_SURFACE BRUME_WITH_LIGHTING
#endif
/* fire: the asset's second grid; 3.2 KiB, and 2 of struct brume_frame */
#ifndef BRUME_WITH_EMISSION
#define BRUME_WITH_EMISSION BRUME_WITH_LIGHTING
#endif
#ifndef BRUME_WITH_DITHER /* pixels of few bits; needs noise; 0.5 KiB */
#define BRUME_WITH_DITHER (BRUME_WITH_LIGHTING && BRUME_WITH_NOISE)
#endif

#if !(BRUME_WITH_U8 || BRUME_WITH_U8R || BRUME_WITH_U4R)
#error "brume: no format: set BRUME_WITH_U8, BRUME_WITH_U8R or BRUME_WITH_U4R"
#endif
#if !(BRUME_WITH_NEAREST || BRUME_WITH_TRILINEAR)
#error "brume: no lookup: set BRUME_WITH_NEAREST or BRUME_WITH_TRILINEAR"
#endif

/* Rays have a mean depth when something uses it. */
#define BRUME_WITH_DEPTH \
    (BRUME_WITH_TAA || BRUME_WITH_SPATIAL || BRUME_WITH_RESOLUTION || \
     BRUME_WITH_SKY)
#if BRUME_WITH_TAA && !BRUME_WITH_TEMPORAL
#error "brume: BRUME_WITH_TAA needs BRUME_WITH_TEMPORAL"
#endif
#if !BRUME_WITH_LIGHTING && \
    (BRUME_WITH_AMBIENT || BRUME_WITH_COLOUR || BRUME_WITH_CONE || \
     BRUME_WITH_CACHE || BRUME_WITH_STOCHASTIC || BRUME_WITH_SKY || \
     BRUME_WITH_TONE || BRUME_WITH_DITHER || BRUME_WITH_SHADOW || \
     BRUME_WITH_FOG || BRUME_WITH_LAMPS || BRUME_WITH_SURFACE || \
     BRUME_WITH_EMISSION)
#error "brume: set BRUME_WITH_LIGHTING, and what of it is not wanted to 0"
#endif
#if BRUME_WITH_COLOUR && !BRUME_WITH_RGB
#error "brume: BRUME_WITH_COLOUR needs BRUME_WITH_RGB"
#endif
#if BRUME_WITH_STOCHASTIC && !(BRUME_WITH_NEAREST && BRUME_WITH_NOISE)
#error "brume: BRUME_WITH_STOCHASTIC needs nearest lookups and noise"
#endif
#if BRUME_WITH_DITHER && !BRUME_WITH_NOISE
#error "brume: BRUME_WITH_DITHER needs BRUME_WITH_NOISE"
#endif
#if !BRUME_WITH_SEQUENCES && (BRUME_WITH_TEMPORAL || BRUME_WITH_TAA || \
                              BRUME_WITH_SPATIAL || BRUME_WITH_RESOLUTION)
#error "brume: set BRUME_WITH_SEQUENCES, and what of it is not wanted to 0"
#endif

/* Light samples written out one by one: 1.8 KiB more per kernel with log
 * light, and an eighth fewer instructions on Cortex-M3 and above, where a
 * shift is free. Elsewhere a loop is as fast. */
#ifndef BRUME_UNROLL_LIGHT
#if defined(__thumb2__) && !defined(__OPTIMIZE_SIZE__)
#define BRUME_UNROLL_LIGHT 1
#else
#define BRUME_UNROLL_LIGHT 0
#endif
#endif

/// Limits ///

/* These may be lowered. */
#ifndef BRUME_MAX_SIZE /* pixels per side of a frame, 1 .. 16384 */
#define BRUME_MAX_SIZE 16384
#endif
#ifndef BRUME_MAX_LOG_SAMPLES /* light samples, doubling distance, 1 .. 16 */
#define BRUME_MAX_LOG_SAMPLES 16
#endif
#ifndef BRUME_MAX_OCTAVES /* of multiple scattering, 1 .. 8 */
#define BRUME_MAX_OCTAVES 8
#endif
#ifndef BRUME_MAX_LAMPS /* of a scene, 1 .. 64; more are refused */
#define BRUME_MAX_LAMPS 64
#endif
#ifndef BRUME_MAX_FOG_SHAPES /* of a scene, 1 .. 255; more are refused */
#define BRUME_MAX_FOG_SHAPES 16
#endif
#ifndef BRUME_MAX_UNIFORM_SAMPLES /* the same, equal distance, 1 .. 4096 */
#define BRUME_MAX_UNIFORM_SAMPLES 4096
#endif
/* Pixels that are marched before they are packed, 1 .. 64: up to 20 bytes
 * of stack each. Below 8 it costs time. */
#ifndef BRUME_SPAN
#define BRUME_SPAN 32
#endif
#if BRUME_MAX_SIZE < 1 || BRUME_MAX_SIZE > 16384
#error "brume: BRUME_MAX_SIZE is 1 .. 16384"
#endif
#if BRUME_MAX_LOG_SAMPLES < 1 || BRUME_MAX_LOG_SAMPLES > 16
#error "brume: BRUME_MAX_LOG_SAMPLES is 1 .. 16"
#endif
#if BRUME_MAX_UNIFORM_SAMPLES < 1 || BRUME_MAX_UNIFORM_SAMPLES > 4096
#error "brume: BRUME_MAX_UNIFORM_SAMPLES is 1 .. 4096"
#endif
#if BRUME_MAX_OCTAVES < 1 || BRUME_MAX_OCTAVES > 8
#error "brume: BRUME_MAX_OCTAVES is 1 .. 8"
#endif
#if BRUME_MAX_LAMPS < 1 || BRUME_MAX_LAMPS > 64
#error "brume: BRUME_MAX_LAMPS is 1 .. 64"
#endif
#if BRUME_MAX_FOG_SHAPES < 1 || BRUME_MAX_FOG_SHAPES > 255
#error "brume: BRUME_MAX_FOG_SHAPES is 1 .. 255"
#endif
#if BRUME_SPAN < 1 || BRUME_SPAN > 64
#error "brume: BRUME_SPAN is 1 .. 64"
#endif
/* These may not. */
#define BRUME_MAX_LIGHT 0x00080000u /* brightest radiance: 8, Q16.16 */
#define BRUME_MIN_STEP 0x00001000u  /* 1/16 voxel, Q16.16 */
#define BRUME_MAX_STEP 0x01000000u  /* 256 voxels, Q16.16 */
#define BRUME_MIN_FOV 0x00010000u   /* 1 degree, Q16.16 */
#define BRUME_MAX_FOV 0x00a00000u   /* 160 degrees, Q16.16 */
/* |eye| and |target| per axis, Q16.16: 32766 voxels. A ray that enters the
 * pool farther than 65000 voxels from the eye misses it. */
#define BRUME_MAX_COORDINATE 0x7ffe0000

/// Asset format (docs/SPEC.md is the definition) ///

#define BRUME_MAGIC 0x454d5242u /* "BRME", read little-endian */
#define BRUME_ASSET_MAJOR 1
#define BRUME_ASSET_MINOR 0
#define BRUME_HEADER_BYTES 176u
#define BRUME_SECTION_BYTES 16u /* one entry of the section table */
#define BRUME_SECTION_ALIGN 64u
#define BRUME_MAX_SECTIONS 32u
#define BRUME_MAX_CELLS 4095u /* per axis */
#define BRUME_SECTION_CELL 0x4c4c4543u
#define BRUME_SECTION_POOL 0x4c4f4f50u
#define BRUME_SECTION_RNGE 0x45474e52u
#define BRUME_SECTION_NAME 0x454d414eu
#define BRUME_SECTION_MIPS 0x5350494du
#define BRUME_SECTION_SUNC 0x434e5553u
#define BRUME_SECTION_AMBI 0x49424d41u
#define BRUME_SECTION_EMIT 0x54494d45u
#define BRUME_CELL_EMPTY 0x80000000u /* set: bits 0..7 are a distance */
#define BRUME_RANGE_TOP 65280u       /* largest base + top * scale */

/* Byte offsets of the header's fields. */
enum {
    BRUME_OFF_MAGIC = 0,
    BRUME_OFF_MAJOR = 4,
    BRUME_OFF_MINOR = 6,
    BRUME_OFF_SIZE = 8,
    BRUME_OFF_CRC = 12,
    BRUME_OFF_FORMAT = 16,
    BRUME_OFF_SIDE = 17,
    BRUME_OFF_SECTIONS = 18,
    BRUME_OFF_CELLS = 20,
    BRUME_OFF_ORIGIN = 28,
    BRUME_OFF_BOX_MIN = 40,
    BRUME_OFF_BOX_MAX = 46,
    BRUME_OFF_BRICKS = 52,
    BRUME_OFF_DENSITY_MAX = 56,
    BRUME_OFF_DENSITY_MEAN = 64,
    BRUME_OFF_VOXELS = 72,
    BRUME_OFF_WORLD = 80
};

enum brume_format { BRUME_U8 = 1, BRUME_U8R = 2, BRUME_U4R = 3 };

/// Errors ///

enum brume_error {
    BRUME_OK = 0,
    BRUME_ERR_NULL = -1,      /* a pointer is NULL */
    BRUME_ERR_ALIGN = -2,     /* asset not on a 4-byte boundary */
    BRUME_ERR_TRUNCATED = -3, /* fewer bytes than the header says */
    BRUME_ERR_MAGIC = -4,     /* not a brume asset */
    BRUME_ERR_VERSION = -5,   /* an asset of another major version */
    BRUME_ERR_CRC = -6,       /* checksum does not match */
    BRUME_ERR_HEADER = -7,    /* a header field is out of range */
    BRUME_ERR_SECTION = -8,   /* section table: bounds, missing, twice */
    BRUME_ERR_CELL = -9,      /* a cell names no brick, or a bad word */
    BRUME_ERR_DISTANCE = -10, /* a cell's distance could leap too far */
    BRUME_ERR_RANGE = -11,    /* a brick's range exceeds the format */
    BRUME_ERR_FEATURE = -12,  /* needs what was compiled out */
    BRUME_ERR_SIZE = -13,     /* frame size out of range */
    BRUME_ERR_CAMERA = -14,   /* eye, target or fov out of range */
    BRUME_ERR_SUN = -15,      /* sun is no direction */
    BRUME_ERR_STEP = -16,     /* step or light_step out of range */
    BRUME_ERR_SAMPLES = -17,  /* light_samples out of range */
    BRUME_ERR_SCENE = -18,    /* another scene field out of range */
    BRUME_ERR_RECT = -19,     /* rectangle not inside the frame, or stride */
    BRUME_ERR_STATE = -20     /* no state, too small, or not begun */
};

/* One line of English for an error code; never NULL. */
const char *brume_error_text(int error);

/// Volume ///

/* Words of the asset, which lie in memory of any declared type. */
#if defined(__GNUC__)
typedef uint32_t __attribute__((__may_alias__)) brume_word_t;
#else
typedef uint32_t brume_word_t;
#endif

/* value = m * 2^e, with m = 0 or m >= 2^31; -1024 <= e <= 991. */
struct brume_number {
    uint32_t m;
    int32_t e;
};

/* A checked view of an asset, which must stay in place. Read-only. */
struct brume_volume {
    const brume_word_t *cells;  /* cx * cy * cz, x fastest */
    const uint8_t *pool;        /* bricks */
    const brume_word_t *ranges; /* one per brick, or NULL (u8) */
    const uint8_t *asset;       /* the blob */
    uint32_t size;              /* its bytes, as its header says */
    uint32_t bricks;
    uint32_t brick_bytes;
    uint32_t voxels;                  /* non-zero ones */
    uint16_t cell_count[3];           /* cx cy cz */
    uint16_t box_min[3], box_max[3];  /* non-zero voxels, inclusive */
    struct brume_number density_max;  /* what the largest code means */
    struct brume_number density_mean; /* of the non-zero voxels */
    uint8_t format;                   /* enum brume_format */
    uint8_t side;                     /* 8, or 9 with an apron */
#if BRUME_WITH_CONE
    const uint8_t *mips; /* or NULL */
#endif
#if BRUME_WITH_CACHE
    const uint8_t *sun_cache; /* section SUNC, or NULL */
#endif
#if BRUME_WITH_AMBIENT
    const uint8_t *sky; /* visibility of the sky, one per cell; or NULL */
#endif
#if BRUME_WITH_EMISSION
    const uint8_t *emission;          /* 512 codes per brick, or NULL */
    struct brume_number emission_max; /* what code 255 means */
#endif
};

enum brume_open_flags {
    /* Do not compare the checksum (a tenth of a second per megabyte on a
     * small core). All that guards memory is checked all the same. */
    BRUME_OPEN_NO_CRC = 1
};

/* Checks `size` bytes at `asset` (4-byte aligned) for all that rendering will
 * follow, and fills *volume. Time: a pass over the bytes for the checksum, and
 * one over the cells. After BRUME_OK no lookup can leave the asset, whatever
 * its bytes. On an error *volume is all zero and must not be used. */
int brume_volume_open(struct brume_volume *volume, const void *asset,
                      size_t size, unsigned flags);

/* CRC-32 (polynomial 0xedb88320 reflected, as in PNG) of bytes 16 .. size-1
 * of an asset: what its header must hold at offset 12. size >= 16. */
uint32_t brume_asset_crc(const void *asset, uint32_t size);

/// Scene ///

enum brume_filter {
    BRUME_NEAREST = 0,
    BRUME_TRILINEAR = 1,
    /* one of the eight voxels of trilinear, at random by their weights */
    BRUME_STOCHASTIC = 2
};
enum brume_light {
    BRUME_LOG = 0,
    BRUME_UNIFORM = 1,
    BRUME_NO_LIGHT = 2,
    /* As log, but each sample sees its segment. Needs the asset's MIPS, which
     * max_density does not clamp. */
    BRUME_CONE = 3,
    BRUME_CACHE = 4 /* lighting->cache */
};
enum brume_jitter { /* bits: what is jittered */
                    BRUME_JITTER_NONE = 0,
                    BRUME_JITTER_PRIMARY = 1,
                    BRUME_JITTER_LIGHT = 2,
                    BRUME_JITTER_BOTH = 3
};
enum brume_noise { /* docs/noise.md says which to use when */
                   BRUME_NOISE_NONE = 0,
                   BRUME_NOISE_WHITE = 1,  /* integer hash of pixel and frame */
                   BRUME_NOISE_IGN = 2,    /* interleaved gradient noise */
                   BRUME_NOISE_BAYER8 = 3, /* ordered 8x8, in every frame */
                   BRUME_NOISE_BAYER4 = 4,
                   BRUME_NOISE_BAYER16 = 5,
                   BRUME_NOISE_IGN_THESIS = 6, /* with other frame offsets */
                   BRUME_NOISE_RANK1 = 7,      /* a lattice in x, y, frame */
                   /* noise_table, at pixel and frame modulo its size; */
                   BRUME_NOISE_TABLE = 8,
                   /* its first slice, plus the golden ratio per frame; */
                   BRUME_NOISE_TABLE_GOLDEN = 9,
                   /* its first slice, moved by the R2 sequence per frame */
                   BRUME_NOISE_TABLE_R2 = 10
};

/* Precomputed noise: 2^width_log2 x 2^height_log2 x 2^frames_log2 values, x
 * fastest. tables/ has some, and brume-noise makes any. Sides 8 to 256, 1 to
 * 64 frames. */
struct brume_noise_table {
    const uint8_t *values; /* 4 bits: two to a byte, the first one low */
    uint8_t width_log2, height_log2, frames_log2;
    uint8_t bits; /* 4 or 8 per value */
};

enum brume_output {
    BRUME_LINEAR = 0,
    BRUME_SRGB = 1,
    /* Narkowicz, "ACES Filmic Tone Mapping Curve", 2016, then sRGB */
    BRUME_FILMIC = 2
};

/* What frames before this one add; docs/temporal.md has the definitions. */
enum brume_temporal {
    BRUME_TEMPORAL_NONE = 0,
    BRUME_EMA = 1,    /* exponential moving average, pixel by pixel */
    BRUME_WINDOW = 2, /* mean of the last `window` frames */
    BRUME_TAA = 3     /* moving average along the motion of the camera */
};
enum brume_fetch { BRUME_FETCH_BILINEAR = 0, BRUME_FETCH_CATMULL_ROM = 1 };
enum brume_clamp { /* of taa's history, by the 3x3 samples around it, to */
                   BRUME_CLAMP_NONE = 0,
                   BRUME_CLAMP_MINMAX = 1,  /* their range */
                   BRUME_CLAMP_VARIANCE = 2 /* mean +- gamma deviations */
};
enum brume_spatial { /* separable kernels; edges of the image are repeated */
                     BRUME_SPATIAL_NONE = 0,
                     BRUME_BOX3 = 1,
                     BRUME_BOX5 = 2,
                     BRUME_GAUSS1 = 3,     /* sigma 1, 7 taps */
                     BRUME_BINOMIAL3 = 4,  /* 1 2 1 */
                     BRUME_BINOMIAL5 = 5,  /* 1 4 6 4 1 */
                     BRUME_BILATERAL15 = 6 /* sigma 1.5, 15 taps */
};
/* Rays per pixel: 1, 1/4, 1/16. The grid of rays is the image's size divided
 * by 2^resolution, rounded up. */
enum brume_resolution { BRUME_FULL = 0, BRUME_HALF = 1, BRUME_QUARTER = 2 };
enum brume_update { /* rays of the grid that a frame marches */
                    BRUME_UPDATE_ALL = 0,
                    BRUME_CHECKER = 1, /* every other one, then the others */
                    BRUME_BAYER4 = 2   /* one of 4x4, in Bayer's order */
};
enum brume_upsample {
    BRUME_UPSAMPLE_BILINEAR = 0,
    /* weights fall with the difference to the nearest ray's depth and
     * transmittance */
    BRUME_UPSAMPLE_AWARE = 1
};

/* A Q32.32 constant from a non-negative number below 2^32. The compiler
 * folds it, so firmware stays free of floating point. */
#define BRUME_Q32(x) ((uint64_t)((x)*4294967296.0))
#define BRUME_Q16(x) ((int32_t)((x)*65536.0 + ((x) < 0 ? -0.5 : 0.5)))

/// Lighting ///

/* What a cloud's light is made of beyond one white sun that is scattered once,
 * alike in all directions; docs/light.md has the definitions. A scene whose
 * `lighting` is NULL has none of it. */

/* Phase functions, relative to isotropic: 4 pi p, so their mean over all
 * directions is 1. */
enum brume_phase_kind {
    /* weight * Draine + (1 - weight) * Henyey-Greenstein: with weight 0 and
     * g 0 isotropic; Jendersie and d'Eon's droplets */
    BRUME_PHASE_MIX = 0,
    BRUME_PHASE_SCHLICK = 1 /* of g; k = 1.55 g - 0.55 g^3 */
};
struct brume_phase_model {
    uint8_t kind;          /* enum brume_phase_kind */
    int32_t g;             /* Q2.30, -0.999 .. 0.999 */
    int32_t draine_g;      /* Q2.30, the same */
    uint32_t draine_alpha; /* Q16.16, 0 .. 1024 */
    uint32_t weight;       /* Q0.16 */
};

/* A phase function over the angle, finest at its ends: by w, the smaller of 1 -
 * cos and 1 + cos, which has 16 steps from 0 to 2^-20, then 16 in each
 * octave up to 1, in the last one 32. Entry n <= 352 is that many steps from
 * cos = 1, entry 704 - n as many from cos = -1. Each is 1024 log2(4 pi p) +
 * 16384. */
#define BRUME_PHASE_CODES 705
struct brume_phase {
    uint16_t code[BRUME_PHASE_CODES];
};

/* Makes the table of octave `octave` of a model: g, draine_g and alpha are
 * multiplied by octave_c^octave (Q0.16). BRUME_ERR_SCENE when the model is out
 * of range. Tables may as well be made beforehand and kept in flash. */
int brume_phase_build(struct brume_phase *out,
                      const struct brume_phase_model *model, uint32_t octave,
                      uint32_t octave_c);

/* 4 pi p at 1 - cos = u, Q2.30, 0 .. 2. Within 0.3 % of
 * all models whose draine_alpha is at most 40; a pure Draine of 250 is off by
 * 1.5 %, of 1000 by 5 %, at a right angle, where its lobe has a cusp. */
struct brume_number brume_phase_value(const struct brume_phase *phase,
                                      uint32_t u);

enum brume_ambient {
    BRUME_AMBIENT_NONE = 0,
    BRUME_AMBIENT_CONSTANT = 1, /* ambient_colour[0] */
    /* from [1] at the lower end of the volume's box along zenith to [0] at its
     * upper end */
    BRUME_AMBIENT_GRADIENT = 2,
    /* six colours by direction: +x -x +y -y +z -z. Without directions
     * (visibility sampled) their mean. */
    BRUME_AMBIENT_CUBE = 3
};
enum brume_visibility { /* how much of the sky a sample sees */
                        BRUME_OPEN_SKY = 0, /* all */
                        /* what one ray lets through, in a direction of its own
                         * for each sample */
                        BRUME_SKY_SAMPLED = 1,
                        BRUME_SKY_BAKED = 2 /* the asset's AMBI section */
};

/* Directions of the upper hemisphere, +z its pole, as noise: 2^width_log2 x
 * 2^height_log2 x 2^frames_log2 triples x y z of Q1.7. Sides and frames as
 * struct brume_noise_table's. */
struct brume_direction_table {
    const int8_t *values;
    uint8_t width_log2, height_log2, frames_log2;
};

/* Optical depth towards the sun at the points of a grid, 2^spacing_log2 voxels
 * apart, the first one half of that from the pool's corner: `size` points, x
 * fastest. The depth of code q is unit * (2^(q/24) - 1) per unit of
 * light_density_scale. Between `from` and `to` it goes with blend, Q0.16. */
struct brume_cache {
    const uint8_t *from, *to;
    uint16_t size[3];
    uint8_t spacing_log2; /* 1, 2 or 3 */
    uint32_t blend;       /* 0 .. 65536 */
    struct brume_number unit;
};

/* Fog that scatters as the volume does, beside it in the same march. By
 * height h = p . zenith (Q16.16 voxels of pool space) its extinction per voxel
 * is density * exp(-(h - base) / falloff), below base density, and without a
 * falloff density everywhere; and shapes add theirs. */
enum brume_fog_kind { BRUME_FOG_SPHERE = 0, BRUME_FOG_BOX = 1 };
struct brume_fog_shape {
    uint8_t kind;      /* enum brume_fog_kind */
    int32_t centre[3]; /* Q16.16 */
    uint32_t half[3];  /* Q16.16: half the sides of a box along the pool's
                        * axes; a sphere's radius is the first. 1 .. 16384 */
    uint32_t softness; /* Q0.16: the share of that within which density falls
                        * to 0, with the square of the way; 0: a hard edge */
    uint32_t density;  /* Q0.32, extinction per voxel */
};
struct brume_fog {
    uint32_t density; /* Q0.32, extinction per voxel; 0: shapes alone */
    int32_t base;     /* Q16.16 */
    uint32_t falloff; /* Q16.16 voxels, >= 1; 0: none */
    uint32_t far;     /* Q16.16 voxels: where rays end, 1 .. 32766; they end at
                       * a coordinate of +-32767 too */
    const struct brume_fog_shape *shapes;
    uint32_t shape_count; /* 0 .. BRUME_MAX_FOG_SHAPES */
};

/* A lamp lights what is at distance r, less than its radius, by
 * colour * (size / max(r, size))^2 * (1 - (r / radius)^4)^2, in units of the
 * sun's light; a spot that times smoothstep from cos_outer to cos_inner of the
 * angle to its direction: 0 at cos_outer and outside, 1 within cos_inner. */
struct brume_lamp {
    int32_t position[3];  /* Q16.16, within BRUME_MAX_COORDINATE */
    uint32_t radius;      /* Q16.16 voxels, 1 .. 16384 */
    uint32_t size;        /* Q16.16 voxels, 1/16 .. radius */
    uint32_t colour[3];   /* Q16.16, 0 .. 256 */
    int32_t direction[3]; /* of a spot, any length > 0 */
    /* Q2.30, -1 .. 1, cos_outer <= cos_inner; cos_outer of -1: a point light,
     * whatever cos_inner and direction */
    int32_t cos_outer, cos_inner;
    /* Samples at equal distances between lamp and what it lights, jittered
     * with the light ray's noise; 0: no shadow. 0 .. 64 */
    uint8_t shadow_samples;
};

/* What a frame makes of a lamp. No user-visible fields. */
struct brume_lit_lamp {
    uint32_t position[3];      /* halved: with the bias, Q17.15, plus 2^30 */
    uint64_t radius_square;    /* of halves, Q30 */
    uint32_t per_radius, size; /* mantissas: of 1 over that; of size^2 */
    uint32_t colour[3];        /* Q12.20: albedo and exposure applied */
    uint8_t radius_shift, size_shift; /* zeros above those squares */
    bool plain; /* a point light without anything; size / radius >= 2^-16 */
    bool spot;
    int32_t direction[3]; /* Q2.30, unit */
    int32_t cos_outer, cos_inner;
    uint32_t slope; /* mantissa of 1 / (cos_inner - cos_outer) */
    uint8_t slope_shift, shadow_samples;
    uint32_t per_sample; /* Q0.32: 1 / shadow_samples */
    /* Of the clusters: beyond `reach`, Q16.16, nothing counts as within the
     * radius; depth as struct brume_clusters.end; tiles, both ends included;
     * `before` is of use while those are found. */
    uint32_t reach, depth;
    uint8_t from[2], to[2];
    bool before;
};

/* Which lamps reach which part of the view: a word of bits for each of
 * BRUME_CLUSTER_SIDE^2 tiles of the frame's grid of rays and
 * BRUME_CLUSTER_SLICES slices of depth. The caller's memory, 22 KiB with the
 * limits below; brume_begin_frame fills it for one frame, so it stays as it is
 * until that frame's last ray. There is a bit for every lamp, so a cluster
 * cannot overflow. */
#ifndef BRUME_CLUSTER_SIDE /* 1 .. 64 */
#define BRUME_CLUSTER_SIDE 16
#endif
#ifndef BRUME_CLUSTER_SLICES /* 1 .. 32 */
#define BRUME_CLUSTER_SLICES 8
#endif
#if BRUME_CLUSTER_SIDE < 1 || BRUME_CLUSTER_SIDE > 64
#error "brume: BRUME_CLUSTER_SIDE is 1 .. 64"
#endif
#if BRUME_CLUSTER_SLICES < 1 || BRUME_CLUSTER_SLICES > 32
#error "brume: BRUME_CLUSTER_SLICES is 1 .. 32"
#endif
#define BRUME_LAMP_WORDS ((BRUME_MAX_LAMPS + 31) / 32)
struct brume_clusters {
    struct brume_lit_lamp lamp[BRUME_MAX_LAMPS];
    /* lamp n is in word n / 32, from its highest bit down */
    uint32_t lamps[BRUME_CLUSTER_SLICES][BRUME_CLUSTER_SIDE][BRUME_CLUSTER_SIDE]
                  [BRUME_LAMP_WORDS];
    /* Where slices end, Q16.16, by the largest of the three coordinates'
     * distances from the eye */
    uint32_t end[BRUME_CLUSTER_SLICES];
};

/* Where rays end: for each pixel of the image a distance from the eye along its
 * ray, as brume_radiance.depth (brume_depth_of); 65535: nowhere. No sample lies
 * at or behind it. A ray that stands for several pixels takes that of the pixel
 * at its middle. */
struct brume_surface {
    const uint16_t *depth;
    size_t stride; /* from row to row, in values */
};

/* What shades the sun besides the volume: a picture of it as the sun sees it,
 * orthographic. Texels as those of struct brume_shadow_map: (x, y) is at origin
 * + (x + 1/2) / width * across + (y + 1/2) / height * down, a plane across the
 * sun's direction (to 1 part in 256); its value is how far below that plane,
 * away from the sun, it is dark: value * range / 65535, 65535: nowhere. Outside
 * of the map it is light. */
struct brume_sun_map {
    uint16_t width, height;                /* texels, 1 .. BRUME_MAX_SIZE */
    int32_t origin[3], across[3], down[3]; /* Q16.16 */
    uint32_t range;                        /* Q16.16, 1 .. 65535 voxels */
    uint32_t bias; /* Q16.16: what is darkened less deep than that is light */
    const uint16_t *depth;
    size_t stride; /* from row to row, in values */
};

struct brume_lighting {
    /* Multiple scattering (Wrenninge et al., "Oz: The Great and Volumetric",
     * 2013): the sum over i < octaves of b^i phase[i] exp(-a^i tau). */
    const struct brume_phase *phase; /* one per octave; NULL: isotropic */
    uint32_t octaves;                /* 0 (as 1) .. BRUME_MAX_OCTAVES */
    uint32_t octave_a, octave_b;     /* Q0.16 */
    uint32_t sun_colour[3];          /* Q16.16, 0 .. 16; 1: as without */
    uint32_t exposure;               /* Q16.16, 1/256 .. 16; 0: 1 */

    uint8_t ambient;            /* enum brume_ambient */
    uint8_t visibility;         /* enum brume_visibility */
    uint8_t visibility_samples; /* doubling distance, 0 .. 16 */
    uint32_t visibility_step;   /* Q16.16 voxels, as light_step */
    const struct brume_direction_table *directions; /* of BRUME_SKY_SAMPLED */
    uint32_t ambient_colour[6][3];                  /* Q16.16, 0 .. 16 */
    int32_t zenith[3]; /* up in the world, any length; zero: +Y */

    const struct brume_cache *cache; /* of BRUME_CACHE */

    /* Behind the volume, in place of the scene's background: from the horizon
     * to the zenith the colour is zenith + (horizon - zenith) (1 - s)^4, s the
     * sine of the elevation; below it is the ground's. */
    bool sky;
    uint32_t sky_zenith[3], sky_horizon[3], sky_ground[3]; /* Q16.16, 0 .. 16 */
    uint32_t sun_disc[3]; /* the sun's, added; Q16.16, 0 .. 16 */
    uint32_t sun_size;    /* 1 - cos of its radius, Q2.30; 0: none */
    uint32_t haze; /* Q16.16: distance in voxels, >= 1, at which 1/e of the
                    * volume is left before the background; 0: none */
    bool dither;   /* pixels of fewer than 8 bits */

    const struct brume_fog *fog; /* or NULL */
    const struct brume_lamp *lamps;
    /* 0 .. BRUME_MAX_LAMPS; more get BRUME_ERR_SCENE, none is left out */
    uint32_t lamp_count;
    struct brume_clusters *clusters;     /* when there are lamps */
    const struct brume_surface *surface; /* or NULL */
    const struct brume_sun_map *sun_map; /* or NULL */
    /* Light of the asset's EMIT section, by its code: 256 colours, Q16.16, 0 ..
     * 16, and between codes between theirs; NULL: none. And extinction per
     * voxel and unit of it, Q32.32. */
    const uint32_t (*emission_colour)[3];
    uint64_t emission_scale;
};

#if BRUME_WITH_CACHE
/* The cache that was baked into the volume, its section SUNC, for the sun of
 * that bake. BRUME_ERR_SECTION when there is none. */
int brume_cache_baked(struct brume_cache *out,
                      const struct brume_volume *volume);

/* A cache that is made on the device. Bytes of its codes, 0 when they are too
 * many; then its head for codes at `codes`; then its codes, any rows of points
 * (row = y + z * size[1], row < size[1] * size[2]) at a time, with the light of
 * `frame`, which has lighting and another light than cache, best uniform.
 *
 * While the sun moves: codes of three suns, one being made, and blend going
 * from the older to the newer of the two others meanwhile; so nothing pops. */
size_t brume_cache_bytes(const struct brume_volume *volume,
                         unsigned spacing_log2);
int brume_cache_begin(struct brume_cache *cache,
                      const struct brume_volume *volume, unsigned spacing_log2,
                      const uint8_t *codes);
#endif

/* What to draw. Fill with brume_scene_default, then change what you like. */
struct brume_scene {
    uint16_t width, height; /* pixels, 1 .. BRUME_MAX_SIZE */
    uint32_t frame;         /* frame number: moves the noise */

    int32_t eye[3], target[3]; /* Q16.16; must differ */
    int32_t up[3];             /* any length; see brume_begin_frame */
    uint32_t fov;              /* vertical, degrees, Q16.16 */

    int32_t sun[3]; /* towards the sun, any length > 0 */
    /* Extinction per unit density per voxel, Q32.32, on view rays and on light
     * rays. For 1e-4 to 1000 per voxel an RMSE of at most 0.6/255 to double
     * precision was measured, up to 1 of 0.05 (lab/atlas, extinction_lit).
     * Nearest lookups go on to any value; trilinear ones are wrong at outlines
     * beyond 1000, where less density than they can tell from none
     * (density_max / 65280, 1/256 voxel) is opaque. */
    uint64_t density_scale;
    uint64_t light_density_scale;
    uint64_t min_density; /* Q32.32; not above: no sample */
    /* Q32.32; clamps voxels; 0: none. Counted in density_max / 65280, rounded
     * down: less than one of them is BRUME_ERR_SCENE, n of them are up to
     * 1 / (n + 1) too low. */
    uint64_t max_density;
    uint32_t albedo;            /* Q0.16 */
    uint32_t step;              /* Q16.16 voxels */
    uint32_t light_step;        /* Q16.16 voxels */
    uint32_t min_transmittance; /* Q0.16: below, the ray ends */
    uint32_t background[3];     /* Q0.16 red, green, blue */

    uint16_t light_samples; /* 0 .. limit of the kind of light */
    uint8_t filter;         /* enum brume_filter */
    uint8_t light;          /* enum brume_light */
    uint8_t jitter;         /* enum brume_jitter */
    uint8_t noise;          /* enum brume_noise */
    uint8_t output;         /* enum brume_output */
    bool skip;              /* leap over empty cells; same image */

    const struct brume_noise_table *noise_table; /* or NULL; see noise */

    /* Over time and over the image. All zero: brume_render_rect alone draws
     * the frame. Else see brume_trace_rect. */
    uint8_t temporal;     /* enum brume_temporal */
    uint8_t history_bits; /* 8 or 16 per quantity; 0: 16 */
    uint8_t window;       /* frames of BRUME_WINDOW, 1 .. 16 */
    uint8_t fetch;        /* enum brume_fetch */
    uint8_t clamp;        /* enum brume_clamp */
    uint8_t spatial;      /* enum brume_spatial */
    uint8_t resolution;   /* enum brume_resolution */
    uint8_t update;       /* enum brume_update */
    uint8_t upsample;     /* enum brume_upsample */
    bool subpixel;        /* move each ray within its pixel, frame by frame */
    bool cut;             /* forget the frames before this one */
    uint32_t alpha;       /* Q0.16, weight of the new frame, 1/64 .. 1 */
    uint32_t gamma;       /* Q16.16, of BRUME_CLAMP_VARIANCE, 0 .. 16 */
    /* Edge-aware spatial filters: weights fall by e for each 1/edge_falloff
     * octave of depth. Q16.16, 0 .. 1024; 0: plain. */
    uint32_t edge_falloff;

#if BRUME_WITH_LIGHTING
    const struct brume_lighting *lighting; /* or NULL */
#endif
};

/* A scene that shows any volume: 640x480, camera on the box of its non-zero
 * voxels, sun from the side, extinction from its mean density, a blue sky,
 * sRGB out; trilinear and uniform light where these are compiled in. */
void brume_scene_default(struct brume_scene *scene,
                         const struct brume_volume *volume);

/* Unit vector Q2.30 of an azimuth and an elevation, Q16.16 degrees, |.| <=
 * 32767: (cos e sin a, sin e, cos e cos a). Error below 2^-26 per axis. */
void brume_direction(int32_t out[3], int32_t azimuth, int32_t elevation);

/// Frame ///

/* Samples at equal distances. */
struct brume_line {
    int32_t move[3];     /* from one to the next, Q16.16 */
    uint32_t inverse[3]; /* floor((2^32 - 1) / |move|); 0: do not leap */
};

/* From a lit sample towards the sun. */
struct brume_light_ray {
    int32_t first[3]; /* to its first sample, Q16.16 */
    uint32_t samples;
};

/* A line of the pool's outline as the eye sees it: rays of direction d with
 * d[i] * b < d[j] * a pass outside. a and b in Q18.13. */
struct brume_outline {
    uint8_t i, j; /* axes */
    int32_t a, b;
};

/* The camera, as reprojection needs it. */
struct brume_view {
    int32_t eye[3];                    /* Q16.16 */
    int32_t ahead[3], right[3], up[3]; /* Q2.30, unit */
    struct brume_number focal;         /* pixels of the image at distance 1 */
};

/* Light sums to optical depth: tau * 2^13 is the high word of
 * (sum << shift) * m; sums above the limit are black. */
struct brume_tau {
    uint32_t m, shift, limit;
};

#if BRUME_WITH_FOG
/* What a frame makes of its fog. */
struct brume_lit_fog {
    bool on;
    int8_t step_log2;                /* the march's step is step / 2^32 times */
    uint32_t step;                   /* 2^step_log2, with the highest bit set */
    uint32_t density;                /* Q0.32 */
    int32_t base;                    /* along zenith, Q17.14 */
    struct brume_number per_falloff; /* octaves, Q16, of a height in Q14 */
    /* Towards the sun: what the density at a place above the base counts for;
     * that of the way up to the base, Q16 of a height in Q14; and at most.
     * Q16.16 voxels. */
    uint32_t way, most_way;
    struct brume_number per_rise;
    struct brume_number pace[3];        /* 1 / |sun| */
    struct brume_number per_light_step; /* light samples of a way in Q16 */
    uint32_t light_samples;
    uint32_t extinction[BRUME_MAX_OCTAVES]; /* a^i, as weight */
    uint32_t shape_count;
    struct {
        uint32_t per_half[3]; /* 2^63 over half << shift */
        uint8_t shift[3];
        struct brume_number edge; /* Q32 of a rest in Q30 */
    } shape[BRUME_MAX_FOG_SHAPES];
};
#endif

#if BRUME_WITH_SURFACE
/* What a frame makes of its sun map: columns, rows and how deep, each along an
 * axis from the origin and in units of its own. */
struct brume_lit_map {
    int32_t origin[3];            /* Q17.15, as positions of the frame */
    int32_t axis[3][3];           /* Q2.30, unit */
    struct brume_number scale[3]; /* texels Q8, texels Q8, codes, of Q13 */
    int32_t bias;                 /* Q18.13 */
};
#endif

#if BRUME_WITH_LIGHTING
/* What a frame makes of its lighting. */
struct brume_lit {
    const struct brume_lighting *lighting; /* or NULL */
    bool on;                               /* is it marched by brume_lit.c? */
    uint8_t light_log2; /* samples keep light / 2^light_log2 */
    uint8_t light;      /* enum brume_light */
    bool stochastic;
    int8_t cone_level; /* of the mip for a segment of a light step */
    uint32_t octaves;  /* >= 1 */
    struct brume_tau tau[BRUME_MAX_OCTAVES];
    uint32_t weight[BRUME_MAX_OCTAVES]; /* b^i, Q0.32, all ones for 1 */
    uint32_t sun[3];  /* Q16.16: albedo, colour of the sun, exposure */
    uint8_t headroom; /* of a sum of octaves: it is Q29 - headroom */
#if BRUME_WITH_COLOUR
    bool colour; /* three channels, else all is in the first */
#endif
#if BRUME_WITH_AMBIENT
    uint8_t ambient, visibility;
    uint32_t sky_samples;
    int32_t sky_axis[3][3]; /* of directions, times their step; Q16.16 */
    struct brume_tau sky_tau;
    uint32_t ambient_colour[6][3]; /* as sun */
    /* Along zenith, Q17.14: the low end of the box, its height; and 1 over
     * that. */
    int32_t low;
    uint32_t height;
    struct brume_number per_height;
#endif
#if BRUME_WITH_CACHE
    struct brume_number sun_unit; /* depth of 1 of a sum of light, per unit of
                                   * light_density_scale */
    struct brume_cache cache;
#endif
#if BRUME_WITH_AMBIENT || BRUME_WITH_SKY || BRUME_WITH_FOG
    int32_t zenith[3]; /* Q2.30, unit */
#endif
#if BRUME_WITH_LAMPS
    const struct brume_clusters *clusters; /* NULL: no lamp in sight */
    uint32_t tile[2]; /* tiles per ray of the grid, Q16.16 */
    bool lamp_shadows;
    struct brume_number lamp_depth; /* optical depth of a code and voxel */
#endif
#if BRUME_WITH_FOG
    struct brume_lit_fog fog;
#endif
#if BRUME_WITH_SURFACE
    const struct brume_sun_map *sun_map; /* or NULL */
    struct brume_lit_map map;
#endif
#if BRUME_WITH_SKY
    bool sky;
    uint32_t haze; /* Q0.32: 2^16 / distance; 0: none */
    /* zenith, horizon, ground, disc; Q16.16, exposure applied */
    uint32_t sky_colour[4][3];
#endif
#if BRUME_WITH_DITHER
    bool dither;
#endif
#if BRUME_WITH_EMISSION
    bool emits;
    uint32_t exposure; /* Q16.16, of what glows */
    /* Two halves of transmittance of a sample, Q0.32, by the bytes of the
     * second grid's value in 1/256 of a code. */
    uint32_t emission[512];
#endif
};
#endif

/* All that is computed once a frame. For users: grid and lattice; and
 * background, which may be changed between rectangles, as far up as 1, with
 * lighting as BRUME_MAX_LIGHT: so a picture lies behind, pixel by pixel. */
struct brume_frame {
    const struct brume_volume *volume;
    /* Loss of transmittance per sample, Q0.32, by 8-bit density; or two
     * halves of transmittance by the bytes of a 16-bit density. */
    uint32_t table[512];
    int32_t eye[3];             /* Q16.16, plus the lookup's bias */
    int32_t ahead[3];           /* ray of the middle, Q1.31, < 1 long */
    int32_t per_x[3], per_y[3]; /* its change per half pixel, Q1.31 */
    struct brume_noise_table noise_table; /* when noise is one */
    struct brume_outline outline[6];
    uint32_t outlines;
    uint32_t limit[3];            /* positions inside are below, Q16.16 */
    int32_t sun[3];               /* Q2.30, unit */
    struct brume_line light_line; /* uniform light */
    struct brume_light_ray light; /* when it is not jittered */
    uint32_t leap_margin;         /* Q16.16, see leap in brume_march.c */
    uint32_t min_density;         /* in codes of the kernel */
    uint32_t max_density;         /* in 16-bit codes */
    struct brume_tau tau;         /* of light sums */
    uint32_t min_transmittance;   /* Q1.31 */
    uint32_t albedo;              /* Q0.16 */
    uint32_t background[3];       /* Q0.16 */
    uint32_t step, light_step;    /* Q16.16 */
    uint32_t frame;
    uint16_t width, height;
    uint16_t grid[2];    /* rays of the whole image, across and down */
    uint16_t lattice[2]; /* those of this frame: what is marched */
    uint16_t light_samples;
    uint8_t kernel; /* which march, see brume_march.c */
    uint8_t light_kind, jitter, noise, output;
    bool skip, cut;
#if BRUME_WITH_DEPTH
    bool depth; /* does anything use it? */
#endif
#if BRUME_WITH_RESOLUTION
    uint8_t resolution, upsample;
#endif
#if BRUME_WITH_SPATIAL
    uint8_t spatial;
    uint32_t edge_falloff; /* Q16.16 */
#endif
#if BRUME_WITH_TEMPORAL
    uint8_t temporal, history_bits, window, update;
    uint8_t cell_log2[2], place[2]; /* of the lattice in the grid, its ray */
    bool subpixel;
    uint32_t noise_frame;     /* frames that a ray has seen */
    uint32_t point[2];        /* Q0.16, where in the pixel */
    uint32_t stratum, strata; /* Q0.16: jitter = stratum + strata * noise */
    uint32_t alpha;           /* Q0.16 */
#endif
#if BRUME_WITH_TAA
    uint8_t fetch, clamp;
    uint32_t gamma; /* Q16.16 */
    uint32_t same;  /* changes when the scene does, but for its frame */
    struct brume_view view;
#endif
#if BRUME_WITH_LIGHTING
    struct brume_lit lit;
#endif
};

/* Checks the scene, and prepares *frame to render it. The volume must outlive
 * the frame. An `up` that is zero or parallel to the view is replaced by +Z,
 * or by +Y when that is parallel too.
 * Time: like that of about 100 pixels. Returns BRUME_OK, or the error of the
 * first bad field; then *frame must not be used. */
int brume_begin_frame(struct brume_frame *frame,
                      const struct brume_volume *volume,
                      const struct brume_scene *scene);

#if BRUME_WITH_CACHE
/* Codes of `rows` rows of a cache, from row `row` on; see struct brume_cache.
 * BRUME_ERR_RECT beyond the last one, BRUME_ERR_SIZE for a cache of another
 * volume, BRUME_ERR_SCENE for a frame that has no light to make it with. */
int brume_cache_rows(const struct brume_cache *cache, uint8_t *codes,
                     const struct brume_frame *frame, uint32_t row,
                     uint32_t rows);
#endif

/// Pixels ///

enum brume_pixel_format {
    BRUME_L8 = 0,             /* 1 byte: grey */
    BRUME_RGB888 = 1,         /* 3 bytes: red, green, blue */
    BRUME_RGB565 = 2,         /* 2 bytes, native word: rrrrrggg gggbbbbb */
    BRUME_RGB565_SWAPPED = 3, /* the same, bytes swapped (SPI panels) */
    BRUME_XRGB8888 = 4,       /* 4 bytes, native word 0x00rrggbb */
    BRUME_L16 = 5,            /* 2 bytes, native word: grey, for measuring */
    BRUME_RGB161616 = 6,      /* 3 native words of 16 bits */
    /* With BRUME_WITH_DITHER. Pixel i of a row is in the highest bits of what
     * is left of byte i * bits / 8; rectangles of L4, L2 and L1 begin at a
     * multiple of 8 pixels. */
    BRUME_RGB332 = 7, /* 1 byte rrrgggbb */
    BRUME_L4 = 8,     /* 4 bits: grey, two pixels to a byte */
    BRUME_L2 = 9,     /* 2 bits */
    BRUME_L1 = 10,    /* 1 bit */
    /* Light without a background, and 255 (1 - transmittance): dst = rgb +
     * dst * (255 - a) / 255. 4 bytes: red, green, blue, alpha */
    BRUME_RGBA8888 = 11
};

/* Bytes per pixel of a format, 0 when there is no such format or it has less
 * than one; and bytes of a row of w pixels. */
unsigned brume_pixel_bytes(int pixel_format);
size_t brume_row_bytes(int pixel_format, unsigned w);

/* Renders the w x h pixels at (x, y) of the frame into dst, whose first byte
 * is pixel (x, y) and whose rows are `stride` bytes apart. dst must be aligned
 * for the format's word. Any cutting of a frame into rectangles gives the same
 * pixels. Grey formats take red, or the luma of coloured
 * light. Returns BRUME_OK (also for
 * empty rectangles), BRUME_ERR_NULL, BRUME_ERR_RECT, BRUME_ERR_FEATURE for a
 * pixel format that was compiled out, or BRUME_ERR_STATE for a scene that takes
 * the passes of "Sequences"; then dst is untouched. */
int brume_render_rect(const struct brume_frame *frame, unsigned x, unsigned y,
                      unsigned w, unsigned h, int pixel_format, void *dst,
                      size_t stride);

#if BRUME_WITH_LIGHTING
/* The code of a distance, Q16.16, rounded down: brume_radiance.depth,
 * brume_surface.depth. */
uint32_t brume_depth_of(uint32_t distance);
#endif

/* What a ray brings back, before the background. */
struct brume_radiance {
    uint32_t light; /* Q16.16, albedo applied, 1.0 = the sun's; at most 1,
                     * with lighting BRUME_MAX_LIGHT */
    uint32_t transmittance; /* Q0.16 */
#if BRUME_WITH_DEPTH
    /* Mean distance, weighted by the loss of transmittance, on a logarithmic
     * scale: 2048 codes an octave, 0 for 2^-16 voxels and less. 65535: nothing
     * there. 0 when the scene has no use for it. */
    uint32_t depth;
#endif
#if BRUME_WITH_COLOUR
    /* Like light, which is then red; 0 when the scene's light has no colour. */
    uint32_t green, blue;
#endif
};

/* The two halves of brume_render_rect, for those who do something between: the
 * w x h rays at (x, y) of the frame's lattice into `out`, rows `stride` rays
 * apart; and rays over the background into the w x h pixels at (x, y), where
 * that tells. Errors as there. */
int brume_march_rect(const struct brume_frame *frame, unsigned x, unsigned y,
                     unsigned w, unsigned h, struct brume_radiance *out,
                     size_t stride);
int brume_pack_rect(const struct brume_frame *frame,
                    const struct brume_radiance *in, size_t in_stride,
                    unsigned x, unsigned y, unsigned w, unsigned h,
                    int pixel_format, void *dst, size_t stride);

/// Sequences ///

/* With temporal, spatial, resolution or update set, a frame has three passes,
 * each over any cutting into rectangles, in any order and by any number of
 * threads, one pass after the other:
 *
 *     brume_begin_frame(&frame, &volume, &scene);
 *     brume_begin_state(state, &frame);
 *     brume_trace_rect    over frame.lattice: marches, and stores
 *     brume_resolve_rect  over frame.grid: reprojects; for taa alone
 *     brume_show_rect     over the image: filters, upsamples, packs
 *
 * The state is the caller's memory. It holds no pointers: a copy of it goes on
 * as the original would. Without `temporal` no state is needed:
 * brume_show_rect(state = NULL) marches the rays that it needs. */
#define BRUME_MAX_WINDOW 16

/* Head of the state's memory. No user-visible fields. */
struct brume_state {
    uint32_t size;   /* of the memory, bytes */
    uint32_t layout; /* what the planes were laid out for; 0: nothing */
    uint16_t image[2];
    uint32_t samples; /* offsets of the planes, in bytes from the head */
    uint32_t values[2], depth[2], sums;
    uint32_t frames; /* before this one, since the cut */
    uint32_t same;   /* scene of the frame before */
    uint8_t now;     /* which plane this frame writes */
    bool at_rest;    /* the camera did not move since the frame before, */
    bool still;      /* nor anything else */
#if BRUME_WITH_TAA
    struct brume_view view; /* of this frame, for the next */
    /* The camera of the frame before: right, up, ahead; from its eye to this
     * one's, Q18.13; and its pixels at distance 1. */
    int32_t axes[3][3], moved[3];
    struct brume_number focal;
#endif
};

/* Bytes of state. `grid` and `lattice` count rays: BRUME_RAYS(width, height,
 * resolution), and that over 1, 2 or 16 for update (rounded up: per side).
 *
 *   per ray of the grid    none 0, ema BRUME_EMA_BYTES, window
 *                          BRUME_WINDOW_BYTES, taa BRUME_TAA_BYTES
 *   per ray of the lattice none and taa BRUME_SAMPLE_BYTES, others 0
 *
 * The same with _RGB when light has colour. `bits` is history_bits; `depth` is
 * 1 when edge_falloff or BRUME_UPSAMPLE_AWARE ask for it, else 0. */
#define BRUME_RAYS(width, height, resolution) \
    ((uint32_t)(((width) + (1u << (resolution)) - 1u) >> (resolution)) * \
     (((height) + (1u << (resolution)) - 1u) >> (resolution)))
#define BRUME_EMA_BYTES(bits, depth) ((bits) / 4u + 2u * (depth))
#define BRUME_WINDOW_BYTES(bits, window, depth) \
    ((bits) / 4u * (window) + (bits) / 2u + 2u * (depth))
#define BRUME_TAA_BYTES(bits) ((bits) / 2u + 4u)
#define BRUME_SAMPLE_BYTES 6u
#define BRUME_EMA_BYTES_RGB(bits, depth) ((bits) / 2u + 2u * (depth))
#define BRUME_WINDOW_BYTES_RGB(bits, window, depth) \
    ((bits) / 2u * (window) + (bits) + 2u * (depth))
#define BRUME_TAA_BYTES_RGB(bits) ((bits) + 4u)
#define BRUME_SAMPLE_BYTES_RGB 12u
#define BRUME_STATE_BYTES(grid, grid_bytes, lattice, lattice_bytes) \
    (sizeof(struct brume_state) + 32u + (uint32_t)(grid) * (grid_bytes) + \
     (uint32_t)(lattice) * (lattice_bytes))

/* The same for a scene, exactly; 0 when it is out of range. */
size_t brume_state_bytes(const struct brume_scene *scene);

/* Makes `size` bytes, 4-byte aligned, an empty state. */
int brume_state_init(struct brume_state *state, size_t size);

/* Once a frame, before its passes. History is dropped when frame.cut says so,
 * and when size, resolution, update or kind of history change, light gets or
 * loses colour, or output becomes BRUME_FILMIC or another. Returns
 * BRUME_ERR_STATE when the memory is too small: then it is as before. */
int brume_begin_state(struct brume_state *state,
                      const struct brume_frame *frame);

/* Marches the w x h rays at (x, y) of the lattice into the state. */
int brume_trace_rect(const struct brume_frame *frame, struct brume_state *state,
                     unsigned x, unsigned y, unsigned w, unsigned h);

/* The same with rays that were marched by other means: rows of `in` are
 * `stride` rays apart. */
int brume_store_rect(const struct brume_frame *frame, struct brume_state *state,
                     unsigned x, unsigned y, unsigned w, unsigned h,
                     const struct brume_radiance *in, size_t stride);

/* The w x h rays at (x, y) of the grid: history along the camera's motion. */
int brume_resolve_rect(const struct brume_frame *frame,
                       struct brume_state *state, unsigned x, unsigned y,
                       unsigned w, unsigned h);

/* The w x h pixels at (x, y) of the image, as brume_render_rect. `work` is
 * scratch memory of brume_work_bytes(frame, w) bytes, 4-byte aligned; one for
 * each thread. Without a state (NULL) the rays are marched here; those beyond
 * the rectangle that its filter needs, too. */
int brume_show_rect(const struct brume_frame *frame,
                    const struct brume_state *state, unsigned x, unsigned y,
                    unsigned w, unsigned h, int pixel_format, void *dst,
                    size_t stride, void *work, size_t work_size);
size_t brume_work_bytes(const struct brume_frame *frame, unsigned w);

/* At most that many, known when compiling: with a kernel of so many taps (1
 * for none; 13 for bilateral15, whose outermost two weigh less than half of
 * 2^-16 and are left out), and with any; and when light has colour. */
#define BRUME_WORK_BYTES_OF(w, taps) \
    (BRUME_SPAN * sizeof(struct brume_radiance) + \
     BRUME_SAMPLE_BYTES * ((taps) + 2u) * ((size_t)(w) + (taps) + 1u))
#define BRUME_WORK_BYTES(w) BRUME_WORK_BYTES_OF(w, 13u)
#define BRUME_WORK_BYTES_RGB(w, taps) \
    (BRUME_SPAN * sizeof(struct brume_radiance) + \
     BRUME_SAMPLE_BYTES_RGB * ((taps) + 2u) * ((size_t)(w) + (taps) + 1u))

/// Shadow ///

#if BRUME_WITH_SHADOW
/* The shadow that the volume throws on the user's ground, sea or sprites: how
 * much of the sun comes through to the texels of a map that lies anywhere in
 * pool space, flat or over a height field. Light shafts below the volume use
 * the same map: a point in the air is shaded by the texel on its way from the
 * sun. docs/light.md has the definition.
 *
 * Texel (x, y) is at
 *
 *     origin + (x + 1/2) / width * across + (y + 1/2) / height * down
 *            + heights[y * heights_stride + x] / 65536 * rise
 *
 * whichever way the edges point; all corners within BRUME_MAX_COORDINATE. */
struct brume_shadow_map {
    uint16_t width, height; /* texels, 1 .. BRUME_MAX_SIZE */
    /* Q16.16: a corner, the edges from there, and the way up to 65536. */
    int32_t origin[3], across[3], down[3], rise[3];
    const uint16_t *heights; /* or NULL */
    size_t heights_stride;   /* from row to row, in values */
    /* Q16.16 voxels, as brume_scene.step; at most 65535 samples may lie on a
     * ray through the pool. */
    uint32_t step;
};

/* Distances from a texel towards the sun, as brume_radiance.depth: where
 * density begins, and its mean. 65535: there is none. */
struct brume_shadow_depth {
    uint16_t front, mean;
};

/* All that is computed once. No user-visible fields. */
struct brume_shadow {
    struct brume_frame frame;
    struct brume_shadow_map map;
    struct brume_number pace[3]; /* time per distance along an axis */
    uint32_t per_texel[2];
    uint32_t black; /* sums above are 0 in 8 bits */
    uint8_t shift[2];
};

/* Of the scene, its sun, light_density_scale, max_density, filter (stochastic
 * as trilinear) and skip are used. The volume and the heights must outlive
 * *shadow. Returns BRUME_OK, BRUME_ERR_SCENE for a map out of reach,
 * BRUME_ERR_STEP for too many samples, or what brume_begin_frame does; then
 * *shadow must not be used. */
int brume_shadow_begin(struct brume_shadow *shadow,
                       const struct brume_volume *volume,
                       const struct brume_scene *scene,
                       const struct brume_shadow_map *map);

/* The w x h texels at (x, y): 255 times the sun's transmittance, rounded, rows
 * `stride` bytes apart; and, where `depth` is not NULL, depths, rows
 * `depth_stride` of them apart, which takes longer where it is dark. Any
 * cutting of a map into rectangles gives the same bytes. BRUME_ERR_NULL and
 * BRUME_ERR_RECT as in brume_render_rect. */
int brume_shadow_rect(const struct brume_shadow *shadow, unsigned x, unsigned y,
                      unsigned w, unsigned h, uint8_t *transmittance,
                      size_t stride, struct brume_shadow_depth *depth,
                      size_t depth_stride);

/* What comes through to a point in or above the volume, `distance` (Q16.16)
 * from a texel towards the sun: Q0.16, from the texel's own values, as if
 * density were the same from front to 2 mean - front. */
uint32_t brume_shadow_at(uint8_t transmittance,
                         const struct brume_shadow_depth *depth,
                         uint32_t distance);
#endif

#ifdef __cplusplus
}
#endif

#endif
