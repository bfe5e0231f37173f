/* SPDX-License-Identifier: MIT */
/* What metrics*.c share. Private to them. */
#ifndef BRUME_HOST_METRICS_INNER_H
#define BRUME_HOST_METRICS_INNER_H

#include "metrics.h"

/* Channel c, 0 to 2, of pixel i in 1/255. */
static inline double metrics_sample(const struct image *image, size_t i, int c)
{
    size_t at = i * (size_t)image->channels;

    if (c < image->channels)
        at += (size_t)c;
    return image->u8 ? image->u8[at] : 255.0 * (double)image->f32[at];
}

/* Channels of an image without alpha: 1 or 3. */
static inline int metrics_channels(const struct image *image)
{
    return image->channels == 1 ? 1 : 3;
}

static inline size_t metrics_pixels(const struct image *image)
{
    return (size_t)image->width * (size_t)image->height;
}

/* Fails, with both sizes in the message, when they differ. */
int metrics_check(const struct image *a, const struct image *b, char *err,
                  size_t err_size);

/* `count` doubles that are 0, or NULL with a message. */
double *metrics_plane(size_t count, char *err, size_t err_size);

#endif
