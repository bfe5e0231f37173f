/* SPDX-License-Identifier: MIT */
/* Y4M: a line for the film, a line for each frame, and planes. */
#include "movie_codec.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BAND_PIXELS 16384u /* of a task */

static const char k_frame[] = "FRAME\n";

/* In 1/65536: 219/255 (0.299, 0.587, 0.114) for Y'; 224/255 (B - Y') / 1.772
 * and 224/255 (R - Y') / 1.402 for Cb and Cr. The rows add up to 219/255 and
 * to 0, so that greys stay grey and white is 235. Sums are below 2^24. */
void y4m_from_rgb(const uint8_t rgb[3], uint8_t ycc[3])
{
    const int32_t r = rgb[0], g = rgb[1], b = rgb[2];
    const int32_t half = 1 << 15, middle = 128 << 16;
    ycc[0] =
        (uint8_t)((16829 * r + 33039 * g + 6416 * b + (16 << 16) + half) >> 16);
    ycc[1] =
        (uint8_t)((-9714 * r - 19070 * g + 28784 * b + middle + half) >> 16);
    ycc[2] =
        (uint8_t)((28784 * r - 24103 * g - 4681 * b + middle + half) >> 16);
}

int y4m_start(const struct movie_format *format, struct image_file *out)
{
    char line[128];
    int n = snprintf(line, sizeof line,
                     "YUV4MPEG2 W%d H%d F%u:%u Ip A1:1 C444 "
                     "XCOLORRANGE=LIMITED\n",
                     format->width, format->height, format->rate[0],
                     format->rate[1]);
    out->size = (size_t)n;
    out->data = malloc(out->size);
    if (out->data == NULL)
        return -1;
    memcpy(out->data, line, out->size);
    return 0;
}

struct planes {
    const struct image *image;
    size_t pixels;
    uint8_t *to;
};

static void convert_band(void *arg, unsigned task, unsigned worker)
{
    const struct planes *p = arg;
    size_t i = (size_t)task * BAND_PIXELS, end = i + BAND_PIXELS;
    size_t channels = (size_t)p->image->channels;
    (void)worker;
    for (; i < end && i < p->pixels; i++) {
        const uint8_t *from = p->image->u8 + i * channels;
        const uint8_t rgb[3] = {from[0], from[channels / 2],
                                from[channels - 1]};
        uint8_t ycc[3];
        y4m_from_rgb(rgb, ycc);
        for (int c = 0; c < 3; c++)
            p->to[(size_t)c * p->pixels + i] = ycc[c];
    }
}

int y4m_frame(struct pool *pool, const struct image *image,
              struct image_file *out)
{
    struct planes p = {image, (size_t)image->width * (size_t)image->height,
                       NULL};
    out->size = sizeof k_frame - 1 + 3 * p.pixels;
    out->data = malloc(out->size);
    if (out->data == NULL)
        return -1;
    memcpy(out->data, k_frame, sizeof k_frame - 1);
    p.to = out->data + sizeof k_frame - 1;
    pool_run(pool, convert_band, &p,
             (unsigned)((p.pixels + BAND_PIXELS - 1) / BAND_PIXELS));
    return 0;
}
