/* SPDX-License-Identifier: MIT */
#ifndef BRUME_TESTS_WIDE_RECT_H
#define BRUME_TESTS_WIDE_RECT_H

#include "brume.h"

/* As brume_render_rect and brume_trace_rect, by the generic wide kernel; up to
 * 1024 pixels, and so many in a row. */
int wide_render_rect(const struct brume_frame *frame, unsigned x, unsigned y,
                     unsigned w, unsigned h, int pixel_format, void *dst,
                     size_t stride);
int wide_trace_rect(const struct brume_frame *frame, struct brume_state *state,
                    unsigned x, unsigned y, unsigned w, unsigned h);

#endif
