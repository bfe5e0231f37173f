/* SPDX-License-Identifier: MIT */
/*
 * What targets need of WebAssembly without a system. The loader (run.mjs)
 * puts assets into the memory behind the program, then calls target_main.
 */
#include <stddef.h>

#include "target.h"

#define ASSETS_MAX 16
#define EXPORT(name) __attribute__((export_name(#name)))

static struct target_asset s_assets[ASSETS_MAX];

const struct target_asset *target_assets = s_assets;
int target_asset_count;

__attribute__((import_module("env"), import_name("write"))) void
import_write(const char *text, uint32_t size);

extern uint8_t __heap_base; /* of wasm-ld: the first free byte */

EXPORT(first_free) const uint8_t *wasm_first_free(void)
{
    return &__heap_base;
}

/* False when there are too many. */
EXPORT(add_asset)
int wasm_add_asset(const char *name, const void *bytes, uint32_t size)
{
    if (target_asset_count == ASSETS_MAX)
        return 0;
    struct target_asset *asset = &s_assets[target_asset_count++];
    asset->name = name;
    asset->bytes = bytes;
    asset->size = size;
    return 1;
}

EXPORT(run) int wasm_run(void)
{
    return target_main();
}

void target_write(const char *text)
{
    uint32_t size = 0;
    while (text[size] != '\0')
        size++;
    import_write(text, size);
}

/* Nothing counts instructions, and locals are not in memory. */
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

/// What the compiler may call ///

void *memcpy(void *restrict to, const void *restrict from, size_t size);
void *memset(void *to, int value, size_t size);

/* Not loops of their own into calls of themselves. */
__attribute__((no_builtin)) void *memcpy(void *restrict to,
                                         const void *restrict from, size_t size)
{
    uint8_t *d = to;
    const uint8_t *s = from;
    for (size_t i = 0; i < size; i++)
        d[i] = s[i];
    return to;
}

__attribute__((no_builtin)) void *memset(void *to, int value, size_t size)
{
    uint8_t *d = to;
    for (size_t i = 0; i < size; i++)
        d[i] = (uint8_t)value;
    return to;
}
