/* SPDX-License-Identifier: MIT */
/* The host's metrics (metrics.h) of pictures of the stage. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "metrics.h"
#include "stability.h"

/* Sizes are the same and memory is there: else it is no use to go on. */
static void must(int bad, const char *err)
{
    if (bad) {
        fprintf(stderr, "brume-stability: %s\n", err);
        abort();
    }
}

static void image_of(struct image *image, const picture_t picture)
{
    for (int i = 0; i < STABILITY_PIXELS; i++)
        image->f32[i] = (float)(picture[i] / 65535.0);
}

/* The frame's share of the means over `count` frames. */
static void add_picture(struct measure *m, const struct image *truth,
                        const struct image *picture, int count)
{
    struct metrics_error e;
    double sharpness;
    char err[128];
    must(metrics_error(truth, picture, &e, err, sizeof err), err);
    must(metrics_sharpness(truth, picture, &sharpness, err, sizeof err), err);
    m->error += e.rmse * e.rmse / count;
    m->bias += e.mean / count;
    m->tile = fmax(m->tile, e.worst_tile);
    m->sharpness += sharpness / count;
}

struct measure measure_of(const picture_t *pictures, const picture_t *truths,
                          int count, bool fixed)
{
    struct measure m = {0};
    struct metrics_sequence sequence = {0};
    struct metrics_time over_time;
    struct image a, b;
    char err[128];
    must(image_new_f32(&a, STABILITY_WIDTH, STABILITY_HEIGHT, 1, err,
                       sizeof err) ||
             image_new_f32(&b, STABILITY_WIDTH, STABILITY_HEIGHT, 1, err,
                           sizeof err),
         err);
    for (int k = 0; k < count; k++) {
        image_of(&a, truths[fixed ? 0 : k]);
        image_of(&b, pictures[k]);
        add_picture(&m, &a, &b, count);
        must(metrics_add(&sequence, &a, &b, err, sizeof err), err);
    }
    metrics_finish(&sequence, &over_time);
    metrics_free(&sequence);
    image_free(&a);
    image_free(&b);
    m.error = sqrt(m.error);
    m.ghosting = over_time.ghosting;
    m.flicker = over_time.flicker;
    m.lag = over_time.lag;
    if (fixed)
        m.deviation = over_time.deviation;
    return m;
}
