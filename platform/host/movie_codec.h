/* SPDX-License-Identifier: MIT */
/*
 * The two film formats, as bytes in memory. Private to movie*.c and the tests.
 * Encoders fail for want of memory only: then they return -1.
 */
#ifndef BRUME_HOST_MOVIE_CODEC_H
#define BRUME_HOST_MOVIE_CODEC_H

#include "image_codec.h"
#include "movie.h"

/* Animated PNG (APNG specification 1.0, in PNG third edition): all frames are
 * IDAT or fdAT of one size or less, drawn over what was there before. */
struct apng {
    uint32_t sequence; /* of the next fcTL or fdAT */
    struct image last; /* frame before, empty at first */
};

/* All before the first frame. */
int apng_start(const struct movie_format *format, struct image_file *out);
/* fcTL, and IDAT or fdAT of what changed since the frame before. */
int apng_frame(struct apng *apng, const struct movie_format *format,
               struct pool *pool, const struct image *image,
               struct image_file *out);
int apng_end(struct image_file *out);
void apng_free(struct apng *apng);

/* Y4M with C444: planes Y', Cb, Cr of ITU-R BT.601 in 16..235 and 16..240,
 * rounded to the nearest. */
void y4m_from_rgb(const uint8_t rgb[3], uint8_t ycc[3]);
int y4m_start(const struct movie_format *format, struct image_file *out);
int y4m_frame(struct pool *pool, const struct image *image,
              struct image_file *out);

#endif
