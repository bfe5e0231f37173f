/* SPDX-License-Identifier: MIT */
/*
 * What targets need of Linux, for the native machine and for emulators of user
 * programs: assets from NAME=FILE arguments, text to standard output. Runs the
 * program on a stack of its own, which can be painted whole.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <ucontext.h>

#include "target.h"

#define ASSETS_MAX 16
#define STACK_BYTES (1024 * 1024) /* -O0 keeps every kernel's frame */
#define PAINT 0xa5

static struct target_asset s_assets[ASSETS_MAX];
static _Alignas(64) uint8_t s_stack[STACK_BYTES]; /* grows downwards */
static uint8_t *s_painted;                        /* its end */
static ucontext_t s_back, s_program;
static int s_status;

const struct target_asset *target_assets = s_assets;
int target_asset_count;

void target_write(const char *text)
{
    fputs(text, stdout);
}

/* Neither the emulators of Debian nor an unprivileged process count. */
uint64_t target_instructions(void)
{
    return 0;
}

/// Stack ///

/* What lies below the caller's frame. Paints down to the last byte, from where
 * no function called here reaches. */
void target_stack_paint(void)
{
    s_painted = __builtin_frame_address(0);
    for (volatile uint8_t *p = s_stack; p + 256 < s_painted; p++)
        *p = PAINT;
}

uint32_t target_stack_used(void)
{
    const uint8_t *p = s_stack;
    while (p < s_painted && *p == PAINT)
        p++;
    return (uint32_t)(s_painted - p);
}

/// Files ///

static int fail(const char *what, const char *name)
{
    fprintf(stderr, "%s: %s\n", name, what);
    return 1;
}

static int add_asset(char *argument)
{
    char *path = strchr(argument, '=');
    struct target_asset *asset = &s_assets[target_asset_count];
    if (path == NULL || target_asset_count == ASSETS_MAX)
        return fail("not NAME=FILE, or too many", argument);
    *path++ = '\0';
    FILE *f = fopen(path, "rb");
    if (f == NULL || fseek(f, 0, SEEK_END) != 0)
        return fail("cannot be read", path);
    long size = ftell(f);
    void *bytes = size > 0 ? malloc((size_t)size) : NULL;
    if (bytes == NULL || fseek(f, 0, SEEK_SET) != 0 ||
        fread(bytes, 1, (size_t)size, f) != (size_t)size)
        return fail("cannot be read", path);
    fclose(f);
    asset->name = argument;
    asset->bytes = bytes;
    asset->size = (uint32_t)size;
    target_asset_count++;
    return 0;
}

static void program(void)
{
    s_status = target_main();
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--help") == 0) {
        puts("usage: targets [NAME=FILE.brume]...\n"
             "Prints the hash of each test scene of these volumes.");
        return 0;
    }
    for (int i = 1; i < argc; i++)
        if (add_asset(argv[i]) != 0)
            return 2;
    if (getcontext(&s_program) != 0)
        return fail("getcontext failed", argv[0]);
    s_program.uc_stack.ss_sp = s_stack;
    s_program.uc_stack.ss_size = sizeof s_stack;
    s_program.uc_link = &s_back;
    makecontext(&s_program, program, 0);
    if (swapcontext(&s_back, &s_program) != 0)
        return fail("swapcontext failed", argv[0]);
    return fflush(stdout) == 0 ? s_status : 1;
}
