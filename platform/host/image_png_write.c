/* SPDX-License-Identifier: MIT */
/*
 * The PNG writer: 8-bit grey, RGB or RGBA, one IDAT chunk, a filter per row.
 */
#include "image_codec.h"

#include "png_pack.h"

#include <stdlib.h>

/* Returns -1 without memory. */
static int put_file(const struct png_pixels *pixels,
                    const struct image_file *idat, struct image_file *file)
{
    uint8_t *p;

    file->size =
        PNG_SIGNATURE_BYTES + 3 * PNG_CHUNK_BYTES + PNG_IHDR_BYTES + idat->size;
    if (!(p = file->data = malloc(file->size)))
        return -1;
    p = png_put_start(p, pixels->width, pixels->height, pixels->channels);
    p = png_put_chunk(p, "IDAT", idat->data, idat->size);
    png_put_chunk(p, "IEND", NULL, 0);
    return 0;
}

/* Every third sample: an RGB image that is grey, as grey. */
static uint8_t *drop_colour(const struct image *image)
{
    size_t pixels = image_samples(image) / 3;
    uint8_t *grey = malloc(pixels);

    for (size_t i = 0; grey && i < pixels; i++)
        grey[i] = image->u8[3 * i];
    return grey;
}

int image_png_encode_with(struct pool *pool, const struct image *image,
                          struct image_file *file, char *err, size_t err_size)
{
    size_t channels = image_is_grey(image) ? 1 : (size_t)image->channels;
    size_t width = (size_t)image->width, height = (size_t)image->height;
    struct png_pixels p = {image->u8, width, height, channels,
                           width * channels};
    struct image_file idat = {NULL, 0};
    uint8_t *grey = NULL;
    int status = -1;

    file->data = NULL;
    if (image->channels == 3 && channels == 1)
        p.data = grey = drop_colour(image);
    if (p.data && png_pack(pool, &p, &idat) == 0)
        status = put_file(&p, &idat, file);
    free(idat.data);
    free(grey);
    return status ? image_error(err, err_size, "no memory for the PNG") : 0;
}

int image_png_encode(const struct image *image, struct image_file *file,
                     char *err, size_t err_size)
{
    return image_png_encode_with(NULL, image, file, err, err_size);
}
