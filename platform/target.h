/* SPDX-License-Identifier: MIT */
/*
 * Between the programs of the targets (tests/targets, board demos) and what
 * each platform gives them. Freestanding: nothing here needs a C library.
 */
#ifndef BRUME_TARGET_H
#define BRUME_TARGET_H

#include <stdint.h>

/* An asset at hand: linked in, or read from a file before the program runs. */
struct target_asset {
    const char *name;  /* as in tests/support/scenes.c: "wdas_u8" */
    const void *bytes; /* 4-byte aligned */
    uint32_t size;
};

/* Given by the platform. */
extern const struct target_asset *target_assets;
extern int target_asset_count;

/* Writes a text to where the emulator's user sees it. */
void target_write(const char *text);

/* Instructions retired since the start; 0 for ever where nothing counts. */
uint64_t target_instructions(void);

/* Fills the unused stack with a pattern; then, deepest use in bytes since. 0
 * where it cannot be told. */
void target_stack_paint(void);
uint32_t target_stack_used(void);

/* Given by the program: its exit status. */
int target_main(void);

#endif
