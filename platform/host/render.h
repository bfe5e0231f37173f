/* SPDX-License-Identifier: MIT */
/* A whole frame on a host: threads over tiles of the core's rectangles. */
#ifndef BRUME_HOST_RENDER_H
#define BRUME_HOST_RENDER_H

#include "brume.h"

/* Processors that are online, at least 1. */
int render_processors(void);

/* Renders the frame into dst, whose rows are `stride` bytes apart, with
 * `threads` threads (1 .. 256). The bytes do not depend on their number. With
 * `progress` a bar is drawn on stderr. Threads that cannot be made are done
 * without. */
void render_frame(const struct brume_frame *frame, int pixel_format, void *dst,
                  size_t stride, int threads, bool progress);

#endif
