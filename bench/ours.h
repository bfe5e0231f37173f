/* SPDX-License-Identifier: MIT */
/* brume's own march for the benchmark: scalar or wide, by tiles. */
#ifndef BRUME_BENCH_OURS_H
#define BRUME_BENCH_OURS_H

#include "brume.h"
#include "volume_file.h"
#include "wide.h"

enum ours_order { OURS_LINEAR, OURS_MORTON, OURS_HILBERT };

struct ours_job {
    const struct brume_frame *frame;
    enum wide_kernel kernel;
    const struct wide_copy *copy; /* of the volume, or NULL: without */
    unsigned tile_width, tile_height;
    enum ours_order order; /* in which tiles are taken */
    unsigned part;         /* every part-th strip of 16 rows, as in view.hpp */
    int threads;           /* 1 .. 64 */
    struct brume_radiance *out; /* the whole frame, row by row */
};

/* The kernel of a name of wide.h's, or of that and "-copy", which marches a
 * copy of the volume; false when it is unknown or this machine has it not. */
bool ours_kernel(const char *name, enum wide_kernel *kernel, bool *copy);

/* The frame of a volume and of n settings, key=value each. Returns 0 or -1
 * with a message as in image.h. */
int ours_frame(struct brume_frame *frame, const struct volume_file *file,
               const char *const *settings, size_t n, char *err,
               size_t err_size);

void ours_render(const struct ours_job *job);

/* What the march looks up in a frame: every density it asks for, once, after
 * leaping over what is empty and ending light rays where the pool ends. */
struct lookup_count {
    uint64_t rays, view, lit, light;
    uint64_t in_bricks; /* lookups that were not in an empty cell */
};

void ours_count(const struct ours_job *job, struct lookup_count *count);

/* The places of those lookups in their order: number of the cell << 9 | voxel
 * within it. For u8 without an apron, below 2^23 cells. */
struct ours_places {
    const struct brume_volume *volume;
    uint32_t *place; /* the caller's, room for view + light of the count */
    size_t count;
    uint32_t rows;     /* words of a brick that a lookup reads: 1, or 4 */
    uint32_t *axis[3]; /* or NULL: instead of places, positions, Q16.16 */
};

void ours_record(const struct ours_job *job, struct ours_places *places);

/* Their loads alone, by so many lanes: 1, 8 or 16. */
bool ours_can_replay(int lanes);
void ours_replay(const struct ours_places *places, int lanes);

#endif
