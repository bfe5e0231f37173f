/* SPDX-License-Identifier: MIT */
#include "grey16.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "png_pack.h"

#define HEADER_SIZE 64

/* Of a PGM's header. */
struct reader {
    const uint8_t *data;
    size_t size, pos;
    struct grey16 *picture; /* whose note grows */
    char *err;
    size_t err_size;
};

/// Pictures ///

int grey16_new(struct grey16 *picture, int width, int height, char *err,
               size_t err_size)
{
    memset(picture, 0, sizeof *picture);
    if (width < 1 || height < 1 || width > IMAGE_MAX_SIDE ||
        height > IMAGE_MAX_SIDE ||
        (uint64_t)width * (uint64_t)height * 2 > IMAGE_MAX_BYTES)
        return image_error(err, err_size,
                           "size %d x %d: each side must be 1 to %d, and all "
                           "below 2^31 bytes",
                           width, height, IMAGE_MAX_SIDE);
    picture->values =
        calloc((size_t)width * (size_t)height, sizeof *picture->values);
    if (picture->values == NULL)
        return image_error(err, err_size, "no memory for %d x %d values", width,
                           height);
    picture->width = width;
    picture->height = height;
    return 0;
}

void grey16_free(struct grey16 *picture)
{
    free(picture->values);
    memset(picture, 0, sizeof *picture);
}

/// PGM ///

static bool is_space(int c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* From behind a # to behind the end of its line. */
static void take_comment(struct reader *r)
{
    char *note = r->picture->note;
    size_t start = r->pos, used = strlen(note);
    while (r->pos < r->size && r->data[r->pos] != '\n')
        r->pos++;
    size_t length = r->pos - start;
    r->pos += r->pos < r->size;
    if (length + 1 >= GREY16_NOTE_SIZE - used ||
        memchr(r->data + start, 0, length) != NULL)
        return;
    memcpy(note + used, r->data + start, length);
    note[used + length] = '\n';
    note[used + length + 1] = '\0';
}

/* The next number of the header, 1 .. 65535, and the one white space behind
 * it. */
static int take_number(struct reader *r, const char *what, int *out)
{
    int n = 0;
    while (r->pos < r->size &&
           (is_space(r->data[r->pos]) || r->data[r->pos] == '#'))
        if (r->data[r->pos++] == '#')
            take_comment(r);
    size_t start = r->pos;
    for (; r->pos < r->size && n <= 65535; r->pos++) {
        int c = r->data[r->pos];
        if (c < '0' || c > '9')
            break;
        n = n * 10 + (c - '0');
    }
    if (r->pos == r->size)
        return image_error(r->err, r->err_size, "header truncated at its %s",
                           what);
    if (r->pos == start || n < 1 || n > 65535 || !is_space(r->data[r->pos]))
        return image_error(r->err, r->err_size,
                           "%s at byte %lu must be 1 to 65535", what,
                           (unsigned long)start);
    r->pos++;
    *out = n;
    return 0;
}

static int take_samples(struct reader *r, int maxval)
{
    struct grey16 *p = r->picture;
    size_t n = (size_t)p->width * (size_t)p->height;
    const uint8_t *at = r->data + r->pos;
    unsigned most = (unsigned)maxval;
    for (size_t i = 0; i < n; i++) {
        unsigned v = most > 255 ? at[2 * i] * 256u + at[2 * i + 1] : at[i];
        if (v > most)
            return image_error(
                r->err, r->err_size, "row %lu: sample %u above maxval %d",
                (unsigned long)(i / (size_t)p->width), v, maxval);
        p->values[i] = (uint16_t)((v * 65535u + most / 2) / most);
    }
    return 0;
}

static int decode_pgm(struct reader *r)
{
    int width = 0, height = 0, maxval = 0;
    char note[GREY16_NOTE_SIZE];
    if (r->size < 3 || memcmp(r->data, "P5", 2) != 0)
        return image_error(r->err, r->err_size, "does not start with P5");
    r->pos = 2;
    if (take_number(r, "width", &width) || take_number(r, "height", &height) ||
        take_number(r, "maxval", &maxval))
        return -1;
    uint64_t need =
        (uint64_t)width * (uint64_t)height * (maxval > 255 ? 2u : 1u);
    if (need > r->size - r->pos)
        return image_error(r->err, r->err_size,
                           "truncated: %llu bytes of samples, %llu needed",
                           (unsigned long long)(r->size - r->pos),
                           (unsigned long long)need);
    memcpy(note, r->picture->note, sizeof note);
    if (grey16_new(r->picture, width, height, r->err, r->err_size))
        return -1;
    memcpy(r->picture->note, note, sizeof note);
    return take_samples(r, maxval);
}

int grey16_pgm_decode(const uint8_t *data, size_t size, struct grey16 *picture,
                      char *err, size_t err_size)
{
    struct reader r = {data, size, 0, picture, err, err_size};
    memset(picture, 0, sizeof *picture);
    if (decode_pgm(&r) == 0)
        return 0;
    grey16_free(picture);
    return -1;
}

/* "# " and the line, for each of the note. Returns the bytes written. */
static size_t put_note(const char *note, char *out)
{
    size_t n = 0;
    for (const char *end; *note != '\0'; note = end) {
        end = note + strcspn(note, "\n");
        end += *end == '\n';
        out[n++] = '#';
        memcpy(out + n, note, (size_t)(end - note));
        n += (size_t)(end - note);
    }
    return n;
}

static int encode_pgm(const struct grey16 *p, struct image_file *file,
                      char *err, size_t err_size)
{
    size_t n = (size_t)p->width * (size_t)p->height, at = 3;
    /* Each line of the note has at least its newline, so # doubles it at
     * most. */
    file->data = malloc(2 * n + 2 * strlen(p->note) + HEADER_SIZE);
    if (file->data == NULL)
        return image_error(err, err_size, "no memory for the file");
    memcpy(file->data, "P5\n", at);
    at += put_note(p->note, (char *)file->data + at);
    at += (size_t)snprintf((char *)file->data + at, HEADER_SIZE - 4,
                           "%d %d\n65535\n", p->width, p->height);
    for (size_t i = 0; i < n; i++) {
        file->data[at + 2 * i] = (uint8_t)(p->values[i] >> 8);
        file->data[at + 2 * i + 1] = (uint8_t)p->values[i];
    }
    file->size = at + 2 * n;
    return 0;
}

/// PNG ///

/* As png_put_start, but for 16 bits. */
static uint8_t *put_start(uint8_t *p, const struct grey16 *picture)
{
    static const uint8_t k_signature[PNG_SIGNATURE_BYTES] = {
        0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    uint8_t ihdr[PNG_IHDR_BYTES] = {[8] = 16}; /* bits; colour type 0: grey */
    memcpy(p, k_signature, sizeof k_signature);
    png_put_be32(ihdr, (uint32_t)picture->width);
    png_put_be32(ihdr + 4, (uint32_t)picture->height);
    return png_put_chunk(p + sizeof k_signature, "IHDR", ihdr, sizeof ihdr);
}

/* Filters look back by whole pixels of two bytes, as those of two channels of
 * 8 bits do. */
static int encode_png(const struct grey16 *picture, struct image_file *file,
                      char *err, size_t err_size)
{
    size_t n = (size_t)picture->width * (size_t)picture->height;
    struct png_pixels pixels = {NULL, (size_t)picture->width,
                                (size_t)picture->height, 2,
                                (size_t)picture->width * 2};
    struct image_file idat = {NULL, 0};
    uint8_t *bytes = malloc(2 * n);
    pixels.data = bytes;
    for (size_t i = 0; bytes != NULL && i < n; i++) {
        bytes[2 * i] = (uint8_t)(picture->values[i] >> 8);
        bytes[2 * i + 1] = (uint8_t)picture->values[i];
    }
    if (bytes != NULL && png_pack(NULL, &pixels, &idat) == 0) {
        file->size = PNG_SIGNATURE_BYTES + 3 * PNG_CHUNK_BYTES +
                     PNG_IHDR_BYTES + idat.size;
        file->data = malloc(file->size);
    }
    if (file->data != NULL) {
        uint8_t *p = put_start(file->data, picture);
        p = png_put_chunk(p, "IDAT", idat.data, idat.size);
        png_put_chunk(p, "IEND", NULL, 0);
    }
    free(idat.data);
    free(bytes);
    return file->data != NULL
               ? 0
               : image_error(err, err_size, "no memory for the PNG");
}

/// Files ///

int grey16_read(const char *path, struct grey16 *picture, char *err,
                size_t err_size)
{
    enum image_format format;
    struct image_file file;
    char what[256];
    memset(picture, 0, sizeof *picture);
    if (image_format_of(path, &format, err, err_size) != 0)
        return -1;
    if (format != IMAGE_PGM && format != IMAGE_PNG)
        return image_error(err, err_size, "%s: neither a .pgm nor a .png",
                           path);
    int status = image_get(path, &file, what, sizeof what);
    if (status == 0)
        status = (format == IMAGE_PGM ? grey16_pgm_decode : grey16_png_decode)(
            file.data, file.size, picture, what, sizeof what);
    free(file.data);
    return status == 0 ? 0 : image_error(err, err_size, "%s: %s", path, what);
}

int grey16_encode(enum image_format format, const struct grey16 *picture,
                  struct image_file *file, char *err, size_t err_size)
{
    file->data = NULL;
    if (format == IMAGE_PGM)
        return encode_pgm(picture, file, err, err_size);
    if (format == IMAGE_PNG)
        return encode_png(picture, file, err, err_size);
    return image_error(err, err_size, "16 bits go into a .pgm or a .png");
}
