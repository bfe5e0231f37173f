/* SPDX-License-Identifier: MIT */
/*
 * A board's demo on a host, with the whole core: what it draws must be what
 * the board draws. Takes the place of start-up, semihosting and assets.
 */
#include <stdio.h>
#include <stdlib.h>

#include "semihosting.h"
#include "target.h"

static struct target_asset s_asset = {"cloud", NULL, 0};
const struct target_asset *target_assets = &s_asset;
int target_asset_count = 1;

static FILE *s_file; /* the demos write one at a time */

int semihosting_create(const char *path)
{
    s_file = fopen(path, "wb");
    return s_file != NULL ? 0 : -1;
}

bool semihosting_write(int handle, const void *data, uint32_t size)
{
    (void)handle;
    return fwrite(data, 1, size, s_file) == size;
}

bool semihosting_close(int handle)
{
    (void)handle;
    return fclose(s_file) == 0;
}

void semihosting_remove(const char *path)
{
    remove(path);
}

void semihosting_hold(const char *word)
{
    (void)word;
}

void target_write(const char *text)
{
    fputs(text, stdout);
}

uint64_t target_instructions(void)
{
    return 0;
}

void target_stack_paint(void)
{
}

uint32_t target_stack_used(void)
{
    return 0;
}

static int load(const char *path)
{
    FILE *f = fopen(path, "rb");
    long size = -1;
    if (f != NULL && fseek(f, 0, SEEK_END) == 0)
        size = ftell(f);
    void *bytes = size > 0 ? malloc((size_t)size) : NULL;
    int status = EXIT_FAILURE;
    if (bytes != NULL && fseek(f, 0, SEEK_SET) == 0 &&
        fread(bytes, 1, (size_t)size, f) == (size_t)size) {
        s_asset.bytes = bytes;
        s_asset.size = (uint32_t)size;
        status = EXIT_SUCCESS;
    } else {
        fprintf(stderr, "cannot read %s\n", path);
        free(bytes);
    }
    if (f != NULL)
        fclose(f);
    return status;
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: %s CLOUD.brume\n", argv[0]);
        return 2;
    }
    return load(argv[1]) == EXIT_SUCCESS ? target_main() : EXIT_FAILURE;
}
