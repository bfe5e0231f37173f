/* SPDX-License-Identifier: MIT */
/*
 * The march over many rays at once, for hosts. The core's scalar march is the
 * definition; these give the same bytes.
 *
 *     struct wide_copy copy;
 *     wide_copy_init(&copy, &volume, WIDE_COPY_MOST);
 *     wide_copy_prepare(&copy, &frame, pool);   once a frame
 *     wide_march_copy_rect(kernel, &copy, &frame, ...);     any threads
 *     wide_copy_free(&copy);
 */
#ifndef BRUME_HOST_WIDE_H
#define BRUME_HOST_WIDE_H

#include "brume.h"

struct pool;

enum wide_kernel {
    WIDE_SCALAR = 0, /* the core's */
    WIDE_AVX2 = 1,   /* 8 rays side by side */
    WIDE_AVX512 = 2, /* 16 rays */
    WIDE_GENERIC = 3 /* 4 rays, by the compiler's vectors (NEON) */
};
#define WIDE_KERNELS 4

/* The fastest kernel that this processor has. */
enum wide_kernel wide_best(void);

/* Is it compiled in, and does this processor have what it needs? */
bool wide_has(enum wide_kernel kernel);

/* "scalar", "avx2", "avx512", "generic". */
const char *wide_name(enum wide_kernel kernel);

/* The kernel of a name; false when there is none. */
bool wide_by_name(const char *name, enum wide_kernel *kernel);

/* As brume_march_rect, and the same bytes in out. A kernel that wide_has
 * denies is replaced by the scalar one. */
int wide_march_rect(enum wide_kernel kernel, const struct brume_frame *frame,
                    unsigned x, unsigned y, unsigned w, unsigned h,
                    struct brume_radiance *out, size_t stride);

/* A volume once more, in orders in which a lookup takes one load. Each is in
 * pages that are zero where the volume is empty, and that a host with virtual
 * memory gives no memory until they are written. Per occupied page:
 *
 *   bytes    1 byte a voxel, pages of 16^3    nearest, u8
 *   halves   2 bytes, pages of 16^3           nearest, u8r and u4r
 *   aprons   1 byte, 9^3 a cell               trilinear
 *   emission the same of the second grid      trilinear, of frames that emit
 *   half     2 bytes, 9^3 a cell              trilinear, where a lookup needs
 *   aprons                                    ranges of several bricks, or a
 *                                             clamp
 */
#define WIDE_COPIES 6
#define WIDE_APRON 729u /* voxels of a cell's */
struct wide_copy {
    const struct brume_volume *volume;
    size_t most;        /* bytes of address space that may still be taken */
    size_t bytes_size, halves_size, aprons_size, half_aprons_size;
    const uint8_t *bytes, *aprons, *emission;
    const uint16_t *halves, *half_aprons;
    const uint32_t *ranges; /* of the brick of each cell, else 0 */
    void *memory[WIDE_COPIES];
};

/* Address space that copies may take: that of one lookup is enough for 1.4
 * million cells (half aprons) to 4 million (bytes). */
#define WIDE_COPY_MOST ((size_t)1 << 31)

/* No copies yet; `most` bytes of them, 0 for none. */
void wide_copy_init(struct wide_copy *copy, const struct brume_volume *volume,
                    size_t most);

/* Makes what the frame's lookup reads, when it is not there and fits. `pool` is
 * whose threads do it, or NULL. */
void wide_copy_prepare(struct wide_copy *copy, const struct brume_frame *frame,
                       struct pool *pool);

/* As wide_march_rect, by the copies, if what is needed was prepared. */
int wide_march_copy_rect(enum wide_kernel kernel, const struct wide_copy *copy,
                         const struct brume_frame *frame, unsigned x,
                         unsigned y, unsigned w, unsigned h,
                         struct brume_radiance *out, size_t stride);

/* As brume_cache_rows, and the same codes, by the copies if what the frame needs
 * was prepared. Frames of uniform light are done in lanes. */
int wide_cache_rows(enum wide_kernel kernel, const struct wide_copy *copy,
                    const struct brume_cache *cache, uint8_t *codes,
                    const struct brume_frame *frame, uint32_t row,
                    uint32_t rows);

void wide_copy_free(struct wide_copy *copy);

#endif
