/* SPDX-License-Identifier: MIT */
/* What the demos of the boards share: the asset that is linked in, a scene
 * that suits it, and the line of figures at the end. */
#ifndef BRUME_DEMO_H
#define BRUME_DEMO_H

#include "brume.h"

/* Exit statuses. After DEMO_FAILED a line has been printed. */
enum { DEMO_OK = 0, DEMO_FAILED = 1 };

/* Opens the only asset. */
int demo_open(struct brume_volume *volume);

/* The default view of a volume, somewhat nearer: nearest lookup, ten light
 * samples of doubling distance, the sun at an azimuth in degrees. */
void demo_scene(struct brume_scene *scene, const struct brume_volume *volume,
                unsigned width, unsigned height, int sun);

/* Starts a frame. `instructions` becomes what that took. */
int demo_begin(struct brume_frame *frame, const struct brume_volume *volume,
               const struct brume_scene *scene, uint64_t *instructions);

/* Renders whole rows y .. y + rows - 1 into a strip; adds what that took. */
int demo_strip(const struct brume_frame *frame, unsigned y, unsigned rows,
               int pixel_format, void *strip, uint64_t *instructions);

/* Prints "<what>: <n> instructions, <m> bytes of stack": rendering alone, but
 * the stack of the whole program. */
void demo_print(const char *what, uint64_t instructions);

/* A picture file by semihosting, PGM (1 channel) or PPM (3) of 8 bits, written
 * from top to bottom. It is removed when something fails. */
struct demo_picture {
    const char *path;
    int handle;
};
int demo_picture_begin(struct demo_picture *picture, const char *path,
                       unsigned channels, unsigned width, unsigned height);
int demo_picture_add(struct demo_picture *picture, const void *bytes,
                     uint32_t size);
int demo_picture_end(struct demo_picture *picture);

#endif
