/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "noises.h"
#include "stability.h"

#define NONE BRUME_TEMPORAL_NONE
#define EMA BRUME_EMA
#define WINDOW BRUME_WINDOW
#define TAA BRUME_TAA
#define LINEAR BRUME_FETCH_BILINEAR
#define CUBIC BRUME_FETCH_CATMULL_ROM
#define FREE BRUME_CLAMP_NONE
#define MINMAX BRUME_CLAMP_MINMAX
#define VARIANCE BRUME_CLAMP_VARIANCE

/* Those with the same noise, update and resolution follow each other: their
 * rays are the same, and are marched once. */
const struct method methods[] = {
    /* name, noise, temporal, bits, fetch, clamp, update, resolution, alpha */
    {"none", "fast", NONE, 16, 0, 0, 0, 0, 1},
    {"ema", "fast", EMA, 16, 0, 0, 0, 0, 0.1},
    {"ema-8bit", "fast", EMA, 8, 0, 0, 0, 0, 0.1},
    {"ema-64th", "fast", EMA, 16, 0, 0, 0, 0, 1 / 64.0},
    {"ema-1", "fast", EMA, 16, 0, 0, 0, 0, 1},
    {"taa", "fast", TAA, 16, CUBIC, VARIANCE, 0, 0, 0.1},
    {"taa-8bit", "fast", TAA, 8, CUBIC, VARIANCE, 0, 0, 0.1},
    {"taa-64th", "fast", TAA, 16, CUBIC, VARIANCE, 0, 0, 1 / 64.0},
    {"taa-linear", "fast", TAA, 16, LINEAR, VARIANCE, 0, 0, 0.1},
    {"taa-minmax", "fast", TAA, 16, CUBIC, MINMAX, 0, 0, 0.1},
    {"taa-free", "fast", TAA, 16, CUBIC, FREE, 0, 0, 0.1},
    {"window8", "fast", WINDOW, 16, 0, 0, 0, 0, 1},
    {"taa-checker", "fast", TAA, 16, CUBIC, VARIANCE, BRUME_CHECKER, 0, 0.1},
    {"taa-bayer4", "fast", TAA, 16, CUBIC, VARIANCE, BRUME_BAYER4, 0, 0.1},
    {"taa-half", "fast", TAA, 16, CUBIC, VARIANCE, 0, BRUME_HALF, 0.1},
    {"ema-stbn", "stbn", EMA, 16, 0, 0, 0, 0, 0.1},
    {"taa-stbn", "stbn", TAA, 16, CUBIC, VARIANCE, 0, 0, 0.1},
    {"ema-rank1", "rank1", EMA, 16, 0, 0, 0, 0, 0.1},
    {"taa-rank1", "rank1", TAA, 16, CUBIC, VARIANCE, 0, 0, 0.1},
    {"ema-golden", "golden", EMA, 16, 0, 0, 0, 0, 0.1},
    {"taa-golden", "golden", TAA, 16, CUBIC, VARIANCE, 0, 0, 0.1},
};
const int method_count = sizeof methods / sizeof methods[0];

static unsigned number_of(const char *noise)
{
    unsigned number = 0;
    for (const char *w = noise_words; *w; number++) {
        size_t length = strcspn(w, " ");
        if (length == strlen(noise) && strncmp(w, noise, length) == 0)
            break;
        w += length;
        w += strspn(w, " ");
    }
    return number;
}

/* Rays move within their pixels with every method, none included: all have
 * the same truth. */
void method_set(const struct method *method, struct brume_scene *scene)
{
    const struct method *m = method;
    scene->temporal = m->temporal;
    scene->history_bits = m->bits;
    scene->window = 8;
    scene->fetch = m->fetch;
    scene->clamp = m->clamp;
    scene->update = m->update;
    scene->resolution = m->resolution;
    scene->upsample = BRUME_UPSAMPLE_AWARE;
    scene->subpixel = true;
    scene->alpha = (uint32_t)lround(m->alpha * 65536);
    noise_choose(number_of(m->noise), scene);
}
