/* SPDX-License-Identifier: MIT */
/*
 * A .brume file in memory, and what the core leaves to hosts: the world
 * transform and the grid's name.
 *
 * Errors: as in image.h.
 */
#ifndef BRUME_HOST_VOLUME_FILE_H
#define BRUME_HOST_VOLUME_FILE_H

#include "brume.h"

struct volume_file {
    struct brume_volume volume;
    void *data;        /* the mapped file */
    size_t size;       /* its bytes */
    int32_t origin[3]; /* index-space coordinates of pool voxel (0,0,0) */
    double world_from_index[12]; /* rows of a 3x4 matrix */
    double voxel_size;           /* world units per voxel, > 0 */
    char name[256];              /* of the grid; empty when not stored */
};

/* Map a file and check it. On failure *file is empty. */
int volume_file_open(struct volume_file *file, const char *path, char *err,
                     size_t err_size);
void volume_file_close(struct volume_file *file);

/* From world space to pool space, in voxels: a position, and a direction
 * (whose length becomes that in voxels). */
void volume_file_to_pool(const struct volume_file *file, const double world[3],
                         double pool[3]);
void volume_file_direction(const struct volume_file *file,
                           const double world[3], double pool[3]);
/* And back. */
void volume_file_to_world(const struct volume_file *file, const double pool[3],
                          double world[3]);

#endif
