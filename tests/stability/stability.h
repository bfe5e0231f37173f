/* SPDX-License-Identifier: MIT */
/*
 * How stable pictures are over time: scenarios, methods, the truth, measures.
 *
 *   scenario  what is seen and how camera, sun or volume change, frame by
 *             frame; a few of its frames are measured
 *   method    how frames are accumulated, and with which noise
 *   truth     the mean of 256 renders of a frame with nothing accumulated, all
 *             jitters and places in the pixel alike
 *
 * Pictures are L16, linear, over the scene's background: 16 bits per pixel.
 */
#ifndef BRUME_STABILITY_H
#define BRUME_STABILITY_H

#include "brume.h"

#define STABILITY_WIDTH 96
#define STABILITY_HEIGHT 54
#define STABILITY_PIXELS (STABILITY_WIDTH * STABILITY_HEIGHT)

typedef uint16_t picture_t[STABILITY_PIXELS];

/// Volumes (stage.c) ///

/* Opens NAME=FILE, to be found by that name. Returns -1 after a message. */
int stage_open(const char *argument);

/* One of those, or one that is made here; NULL when there is none. */
const struct brume_volume *stage_volume(const char *name);

void stage_close(void);

/// Scenarios (scenarios.c) ///

struct scenario {
    const char *name, *what;
    int frames;
    int last;   /* so many of them are measured, from an even number */
    bool fixed; /* all of those have the same truth */
    int period; /* rays repeat after so many frames; 0: they do not */
    void (*set)(struct brume_scene *scene, const struct brume_volume *volume,
                int frame);
    const char *methods; /* only these, separated by commas; NULL: all */
};
extern const struct scenario scenarios[];
extern const int scenario_count;
#define STABILITY_MOST 32 /* frames measured of a scenario */

/* The scene of a frame, without method. False when its volume is missing. */
bool scenario_scene(const struct scenario *scenario, int frame,
                    struct brume_scene *scene,
                    const struct brume_volume **volume);

/// Methods (methods.c) ///

struct method {
    const char *name;
    const char *noise; /* of noises.h */
    uint8_t temporal, bits, fetch, clamp, update, resolution;
    double alpha;
};
extern const struct method methods[];
extern const int method_count;

void method_set(const struct method *method, struct brume_scene *scene);

/// Truth (truth.c) ///

/* The mean of so many renders, up to 256, of the scene as it is, whatever its
 * noise and method. */
void truth_render(const struct brume_volume *volume,
                  const struct brume_scene *scene, int samples, picture_t out);

/// Measures (measure.c) ///

/* Those of metrics.h, which defines them; all but the last two in 1/255 of
 * white. */
struct measure {
    double ghosting;  /* mean |picture - truth| */
    double error;     /* root mean square of the same */
    double bias;      /* mean of the same, signed */
    double tile;      /* its root mean square in the worst 8x8 tile */
    double flicker;   /* mean |change - change of the truth|, per frame */
    double deviation; /* over time; where the truth is fixed */
    double sharpness; /* gradients of the picture along those of the truth */
    double lag;       /* frames that it is behind the truth */
};

/* Of `count` pictures of frames one after the other. */
struct measure measure_of(const picture_t *pictures, const picture_t *truths,
                          int count, bool fixed);

/// Runs (run.c) ///

/* Draws a scenario's frames by a method, and keeps those that are measured.
 * `fresh`: with a state of its own from the first of those on. */
void run_method(const struct scenario *scenario, const struct method *method,
                bool fresh, picture_t out[STABILITY_MOST]);

/* The truths of the frames that are measured: one when they are fixed. */
void run_truths(const struct scenario *scenario, int samples,
                picture_t out[STABILITY_MOST]);

#endif
