/* SPDX-License-Identifier: MIT */
/*
 * Frames on a host: threads over tiles of the core's rectangles, pass by pass,
 * and the state that goes from frame to frame.
 *
 * Errors: as in image.h.
 */
#ifndef BRUME_HOST_RENDER_H
#define BRUME_HOST_RENDER_H

#include "brume.h"
#include "pool.h"
#include "profile.h"
#include "wide.h"

struct renderer;

/* Where pixels go: rows `stride` bytes apart. And what is behind, in place of
 * the scene's background, of the image's size (see backdrop.h); the scene must
 * have no sky then, and a pixel at least 8 bits. NULL: nothing. */
struct render_target {
    int pixel_format;
    void *dst;
    size_t stride;
    const uint32_t (*over)[3];
};

/* `threads` is 1 .. POOL_MAX; the bytes do not depend on it, nor on the kernel
 * that marches. NULL without memory. */
struct renderer *renderer_new(int threads, enum wide_kernel kernel);
void renderer_free(struct renderer *renderer);

/* Its threads, for other work between frames. */
struct pool *renderer_pool(struct renderer *renderer);

/* Where times are added from now on; NULL: they are not taken. */
void renderer_profile(struct renderer *renderer, struct profile *profile);

/* A bar on stderr over the next `frames` frames; 0: none. */
void renderer_progress(struct renderer *renderer, unsigned frames);
/* Removes a bar that has not reached its end. */
void renderer_hush(struct renderer *renderer);

/* What frames show from now on. It must stay where it is until the next call.
 * The wide kernels make copies of it when they first need them. */
void renderer_volume(struct renderer *renderer,
                     const struct brume_volume *volume);

/* Where its voxel (0,0,0) lies, in voxels from any fixed place, so that frames
 * of volumes whose pools were cut from one grid at different places go
 * together. (0,0,0) at first. */
void renderer_anchor(struct renderer *renderer, const int32_t voxels[3]);

/* The codes of a cache of the volume, by the light of a frame of it (see
 * brume_cache_rows). A code of enum brume_error. */
int renderer_fill_cache(struct renderer *renderer,
                        const struct brume_cache *cache, uint8_t *codes,
                        const struct brume_frame *light);

/* One frame, after those before it. */
int renderer_draw(struct renderer *renderer, const struct brume_scene *scene,
                  const struct render_target *target, char *err,
                  size_t err_size);

/* A frame that needs no state, marched by the scalar kernel. */
void render_frame(const struct brume_frame *frame, int pixel_format, void *dst,
                  size_t stride, int threads, bool progress);

#endif
