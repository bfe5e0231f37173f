/* SPDX-License-Identifier: MIT */
/*
 * A picture that a volume is drawn over, in place of the scene's background:
 *
 *     pixel = encode(light + transmittance * linear(picture))
 *
 * in linear light, with the core's own radiance before it is encoded, so that a
 * tone curve sees the sum and no 8-bit step is in between: the bytes are those
 * of the core with that background at that pixel. (dst = rgb + dst * (255 - a)
 * / 255 of BRUME_RGBA8888 is for those who have nothing but bytes: it composes
 * exactly where both are linear, which 8 bits of linear light are too coarse
 * for in the dark.) What is encoded once and composed nowhere comes back as it
 * was: at a transmittance of 1 and output = srgb, to the code.
 *
 * Errors: as in image.h.
 */
#ifndef BRUME_HOST_BACKDROP_H
#define BRUME_HOST_BACKDROP_H

#include "image.h"

struct backdrop {
    int width, height;
    /* Q16.16, 0 to BRUME_MAX_LIGHT; red, green, blue. NULL: none. */
    uint32_t (*linear)[3];
};

/* .png, .ppm and .pgm are sRGB; .pfm is linear, cut to what the core can. */
int backdrop_read(const char *path, struct backdrop *backdrop, char *err,
                  size_t err_size);
void backdrop_free(struct backdrop *backdrop);

#endif
