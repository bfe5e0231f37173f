/* SPDX-License-Identifier: MIT */
#include "backdrop.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "brume.h"
#include "image_codec.h"
#include "srgb.h"

static uint32_t q16(double linear)
{
    double most = BRUME_MAX_LIGHT;
    return (uint32_t)fmin(fmax(floor(linear * 65536 + 0.5), 0), most);
}

int backdrop_read(const char *path, struct backdrop *backdrop, char *err,
                  size_t err_size)
{
    struct image image;
    uint32_t of_code[256];
    memset(backdrop, 0, sizeof *backdrop);
    if (image_read(path, &image, err, err_size) != 0)
        return -1;
    size_t n = (size_t)image.width * (size_t)image.height;
    size_t channels = (size_t)image.channels;
    for (int i = 0; i < 256; i++)
        of_code[i] = q16(srgb_linear(i));
    backdrop->width = image.width;
    backdrop->height = image.height;
    backdrop->linear = malloc(n * sizeof *backdrop->linear);
    for (size_t i = 0; backdrop->linear != NULL && i < 3 * n; i++) {
        size_t from = i / 3 * channels + (channels > 1 ? i % 3 : 0);
        backdrop->linear[i / 3][i % 3] = image.u8 != NULL
                                             ? of_code[image.u8[from]]
                                             : q16((double)image.f32[from]);
    }
    image_free(&image);
    return backdrop->linear != NULL
               ? 0
               : image_error(err, err_size, "%s: not enough memory", path);
}

void backdrop_free(struct backdrop *backdrop)
{
    free(backdrop->linear);
    memset(backdrop, 0, sizeof *backdrop);
}
