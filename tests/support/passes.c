/* SPDX-License-Identifier: MIT */
#include "passes.h"

#include <stdio.h>
#include <stdlib.h>

static void must(int error, const char *what)
{
    if (error == BRUME_OK)
        return;
    fprintf(stderr, "%s: %s\n", what, brume_error_text(error));
    abort();
}

/* At least `size` bytes instead of *memory, or that itself. Returns whether
 * they are new. */
static int reserve(void **memory, size_t *have, size_t size)
{
    if (*memory != NULL && *have >= size)
        return 0;
    free(*memory);
    *memory = malloc(size);
    *have = size;
    if (*memory == NULL)
        abort();
    return 1;
}

void passes_begin(struct passes *passes, const struct brume_volume *volume,
                  const struct brume_scene *scene)
{
    struct passes *s = passes;
    void *state = s->state;
    must(brume_begin_frame(&s->frame, volume, scene), "brume_begin_frame");
    if (reserve(&state, &s->size, brume_state_bytes(scene)))
        must(brume_state_init(state, s->size), "brume_state_init");
    s->state = state;
    reserve(&s->work, &s->work_size,
            brume_work_bytes(&s->frame, s->frame.width));
    must(brume_begin_state(s->state, &s->frame), "brume_begin_state");
}

static void resolve(struct passes *s)
{
    if (s->frame.temporal == BRUME_TAA)
        must(brume_resolve_rect(&s->frame, s->state, 0, 0, s->frame.grid[0],
                                s->frame.grid[1]),
             "brume_resolve_rect");
}

void passes_trace(struct passes *passes)
{
    struct passes *s = passes;
    must(brume_trace_rect(&s->frame, s->state, 0, 0, s->frame.lattice[0],
                          s->frame.lattice[1]),
         "brume_trace_rect");
    resolve(s);
}

void passes_store(struct passes *passes, const struct brume_radiance *in)
{
    struct passes *s = passes;
    must(brume_store_rect(&s->frame, s->state, 0, 0, s->frame.lattice[0],
                          s->frame.lattice[1], in, s->frame.lattice[0]),
         "brume_store_rect");
    resolve(s);
}

void passes_show(struct passes *passes, int pixel_format, void *dst)
{
    struct passes *s = passes;
    size_t stride = (size_t)s->frame.width * brume_pixel_bytes(pixel_format);
    must(brume_show_rect(&s->frame, s->state, 0, 0, s->frame.width,
                         s->frame.height, pixel_format, dst, stride, s->work,
                         s->work_size),
         "brume_show_rect");
}

void passes_draw(struct passes *passes, const struct brume_volume *volume,
                 const struct brume_scene *scene, int pixel_format, void *dst)
{
    passes_begin(passes, volume, scene);
    passes_trace(passes);
    passes_show(passes, pixel_format, dst);
}

void passes_free(struct passes *passes)
{
    static const struct passes k_empty;
    free(passes->state);
    free(passes->work);
    *passes = k_empty;
}
