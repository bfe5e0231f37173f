/* SPDX-License-Identifier: MIT */
/*
 * Frames one after the other, on a machine with a heap: the state and the
 * scratch memory that a scene needs, and its passes over the whole image.
 * Aborts with a line of text when the core refuses: tests of errors call the
 * core themselves.
 */
#ifndef BRUME_TESTS_PASSES_H
#define BRUME_TESTS_PASSES_H

#include "brume.h"

/* All zero is an empty one. */
struct passes {
    struct brume_frame frame;
    struct brume_state *state;
    size_t size;
    void *work;
    size_t work_size;
};

/* The frame, and a state that is large enough. One that has to grow is
 * empty. */
void passes_begin(struct passes *passes, const struct brume_volume *volume,
                  const struct brume_scene *scene);

/* After passes_begin: marches, resolves. */
void passes_trace(struct passes *passes);

/* The same with rays that were marched before: those of the lattice. */
void passes_store(struct passes *passes, const struct brume_radiance *in);

/* After one of these: the image, rows without gaps. */
void passes_show(struct passes *passes, int pixel_format, void *dst);

/* All four. */
void passes_draw(struct passes *passes, const struct brume_volume *volume,
                 const struct brume_scene *scene, int pixel_format, void *dst);

void passes_free(struct passes *passes);

#endif
