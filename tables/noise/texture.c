/* SPDX-License-Identifier: MIT */
/* Noise textures in memory and as .raw files. */
#include "noise.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

uint32_t noise_hash(uint32_t h)
{
    h ^= h >> 16;
    h *= 0x7feb352du;
    h ^= h >> 15;
    h *= 0x846ca68bu;
    return h ^ h >> 16;
}

bool noise_texture_make(struct noise_texture *t, uint32_t width,
                        uint32_t height, uint32_t frames, uint32_t channels)
{
    *t = (struct noise_texture){width, height, frames, channels, NULL};
    t->values = calloc(noise_texture_bytes(t), 1);
    if (t->values)
        return true;
    *t = (struct noise_texture){0, 0, 0, 0, NULL};
    return false;
}

void noise_texture_free(struct noise_texture *t)
{
    free(t->values);
    *t = (struct noise_texture){0, 0, 0, 0, NULL};
}

size_t noise_texture_bytes(const struct noise_texture *t)
{
    return (size_t)t->width * t->height * t->frames * t->channels;
}

static int fail(char *err, size_t err_size, const char *path, const char *what)
{
    snprintf(err, err_size, "%s: %s", path, what);
    return -1;
}

int noise_texture_read(struct noise_texture *t, const char *path,
                       uint32_t width, uint32_t height, uint32_t frames,
                       uint32_t channels, char *err, size_t err_size)
{
    *t = (struct noise_texture){0, 0, 0, 0, NULL};
    FILE *file = fopen(path, "rb");
    if (!file)
        return fail(err, err_size, path, strerror(errno));
    int result = -1;
    if (!noise_texture_make(t, width, height, frames, channels)) {
        fail(err, err_size, path, "not enough memory");
    } else {
        size_t size = noise_texture_bytes(t);
        size_t got = fread(t->values, 1, size, file);
        if (ferror(file))
            fail(err, err_size, path, strerror(errno));
        else if (got < size || fgetc(file) != EOF)
            snprintf(err, err_size, "%s: %s than the %zu bytes of %ux%ux%u",
                     path, got < size ? "fewer" : "more", size, width, height,
                     frames);
        else
            result = 0;
    }
    fclose(file);
    if (result)
        noise_texture_free(t);
    return result;
}

static int write_all(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    if (!file)
        return -1;
    size_t wrote = fwrite(bytes, 1, size, file);
    int error = wrote < size ? errno : 0;
    if (fclose(file) && !error)
        error = errno;
    errno = error;
    return error ? -1 : 0;
}

int noise_file_write(const char *path, const void *bytes, size_t size,
                     char *err, size_t err_size)
{
    struct stat info;
    char temporary[4096];

    if (!lstat(path, &info) && !S_ISREG(info.st_mode)) {
        if (write_all(path, bytes, size))
            return fail(err, err_size, path, strerror(errno));
        return 0;
    }
    int length = snprintf(temporary, sizeof temporary, "%s.tmp%ld", path,
                          (long)getpid());
    if (length < 0 || (size_t)length >= sizeof temporary)
        return fail(err, err_size, path, strerror(ENAMETOOLONG));
    if (!write_all(temporary, bytes, size) && !rename(temporary, path))
        return 0;
    fail(err, err_size, path, strerror(errno));
    remove(temporary);
    return -1;
}

int noise_texture_write(const struct noise_texture *t, const char *path,
                        char *err, size_t err_size)
{
    return noise_file_write(path, t->values, noise_texture_bytes(t), err,
                            err_size);
}
