/* SPDX-License-Identifier: MIT */
/*
 * The scenes that tests render over and over: of every kernel a few, on
 * volumes made here, and on real ones when their baked files are given. The
 * same list serves the golden hashes, tilings, threads, compilers and targets.
 * Needs the core alone: no libc, so targets compile it too (volumes.h does).
 */
#ifndef BRUME_TESTS_SCENES_H
#define BRUME_TESTS_SCENES_H

#include "brume.h"

#include "lighting.h"

/* What a scene adds to the frames' own rays. Its picture is the last of its
 * frames; the camera moves from frame to frame. */
struct test_sequence {
    uint8_t frames, temporal, history_bits, window;
    uint8_t fetch, clamp, spatial, resolution, update, upsample;
    bool subpixel;
    uint32_t edge_falloff; /* Q16.16 */
    int32_t move;          /* of the eye per frame, in 1/256 of the box */
};

struct test_scene {
    const char *name;
    const char *volume; /* of test_volume, or of a file */
    uint16_t width, height;
    uint8_t filter, light;
    uint16_t light_samples;
    uint8_t jitter, noise;
    uint32_t step; /* Q16.16 */
    uint32_t frame;
    uint8_t view;                         /* enum test_view */
    bool clamp;                           /* max_density at half the volume's */
    bool small;                           /* kept as a picture too */
    const struct test_sequence *sequence; /* or NULL: one frame by itself */
    const struct test_lighting *lighting; /* or NULL */
};

enum test_view {
    VIEW_FRONT,
    VIEW_INSIDE,  /* eye in the middle of the box */
    VIEW_GRAZING, /* eye on a face of the box, looking along it */
    VIEW_FAR,     /* the box a few pixels wide */
    VIEW_TOP,     /* straight down, up parallel to the view */
    VIEW_SUN      /* against the sun */
};

extern const struct test_scene test_scenes[];
extern const int test_scene_count;

/* Can this build draw it? Else what is filled in is another scene. */
bool test_scene_supported(const struct test_scene *scene);

/* The core's scene of a test scene. Every field is set here, none left to the
 * core's defaults. */
void test_scene_fill(struct brume_scene *out, const struct test_scene *scene,
                     const struct brume_volume *volume);

/* How many frames it has, and the core's scene of one of them. */
unsigned test_scene_frames(const struct test_scene *scene);
void test_scene_frame(struct brume_scene *out, const struct test_scene *scene,
                      const struct brume_volume *volume, unsigned frame);

/* CRC-32 of bytes, from 0. */
uint32_t test_crc32(const void *data, size_t size);

/* The same of bytes that follow those of `crc`. */
uint32_t test_crc32_more(uint32_t crc, const void *data, size_t size);

#endif
