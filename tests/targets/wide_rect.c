/* SPDX-License-Identifier: MIT */
/*
 * Of targets with TARGET_WIDE: rays as hosts march them, by lanes of the
 * compiler's own vectors, where there is neither AVX2 nor AVX-512. Every other
 * rectangle is marched by copies of the volume, so one hash is of both ways.
 */
#include "wide_rect.h"

#include "host/wide.h"

#define RAYS_MAX 1024

static struct brume_radiance s_rays[RAYS_MAX];
static struct wide_copy s_copy;
static const void *s_asset; /* that s_copy is of */
static unsigned s_rects;

static int march(const struct brume_frame *frame, unsigned x, unsigned y,
                 unsigned w, unsigned h)
{
    bool by_copies = s_rects++ % 2 != 0;
    if (w * h > RAYS_MAX)
        return BRUME_ERR_RECT;
    if (s_asset != frame->volume->asset) {
        wide_copy_free(&s_copy);
        wide_copy_init(&s_copy, frame->volume, WIDE_COPY_MOST);
        s_asset = frame->volume->asset;
    }
    if (by_copies)
        wide_copy_prepare(&s_copy, frame, NULL);
    return wide_march_copy_rect(WIDE_GENERIC, by_copies ? &s_copy : NULL, frame,
                                x, y, w, h, s_rays, w);
}

int wide_render_rect(const struct brume_frame *frame, unsigned x, unsigned y,
                     unsigned w, unsigned h, int pixel_format, void *dst,
                     size_t stride)
{
    int error = march(frame, x, y, w, h);
    if (!error)
        error = brume_pack_rect(frame, s_rays, w, x, y, w, h, pixel_format, dst,
                                stride);
    return error;
}

int wide_trace_rect(const struct brume_frame *frame, struct brume_state *state,
                    unsigned x, unsigned y, unsigned w, unsigned h)
{
    int error = BRUME_OK;
    for (unsigned end = y + h; y < end && !error; y++) {
        error = march(frame, x, y, w, 1);
        if (!error)
            error = brume_store_rect(frame, state, x, y, w, 1, s_rays, w);
    }
    return error;
}
