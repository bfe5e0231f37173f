/* SPDX-License-Identifier: MIT */
/*
 * Several files of one command, all or none: nothing is put in its place before
 * all are written.
 *
 * Errors: as in image.h; messages start with the path.
 */
#ifndef BRUME_HOST_OUT_SET_H
#define BRUME_HOST_OUT_SET_H

#include "image_codec.h"

#define OUT_SET_MOST 4

/* Paths that are NULL are passed over. count <= OUT_SET_MOST. */
int out_set_write(int count, const char *const *path,
                  const struct image_file *file, char *err, size_t err_size);

#endif
