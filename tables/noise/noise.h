/* SPDX-License-Identifier: MIT */
/* Noise textures in memory and on disk. */
#ifndef BRUME_TABLES_NOISE_H
#define BRUME_TABLES_NOISE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Toroidal in all three directions; sides are powers of two, 8x8x1 to
 * 256x256x64. A value stands for (byte + 1/2) / 256. */
struct noise_texture {
    uint32_t width, height, frames;
    uint32_t channels; /* bytes per texel: 1 scalar, 2 octahedral, 3 vectors */
    uint8_t *values;   /* [frame][y][x][channel] */
};

/* Zeroed texels; false when there is no memory. */
bool noise_texture_make(struct noise_texture *t, uint32_t width,
                        uint32_t height, uint32_t frames, uint32_t channels);
void noise_texture_free(struct noise_texture *t);

/* Bytes in a texture. */
size_t noise_texture_bytes(const struct noise_texture *t);

/* A .raw file is the texture's bytes and nothing else. Both return 0, or -1
 * with one line of text in err[0 .. err_size - 1]; then *t is empty, and no
 * partial file is left. The file must have exactly the bytes of the size. */
int noise_texture_read(struct noise_texture *t, const char *path,
                       uint32_t width, uint32_t height, uint32_t frames,
                       uint32_t channels, char *err, size_t err_size);
int noise_texture_write(const struct noise_texture *t, const char *path,
                        char *err, size_t err_size);

/* Writes any bytes the same way: a temporary file beside `path` replaces it
 * when complete; a path that is not a regular file is written directly. */
int noise_file_write(const char *path, const void *bytes, size_t size,
                     char *err, size_t err_size);

/* A bijection of 32 bits, lowbias32 of C. Wellons' hash prospector: every
 * random choice here is one of its values. */
uint32_t noise_hash(uint32_t h);

#endif
