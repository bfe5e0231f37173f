/* SPDX-License-Identifier: MIT */
/*
 * Links assets in. TARGET_ASSETS names a file with a line for each:
 *
 *     ASSET(wdas_u8, "volumes/wdas_u8.brume")
 *
 * The paths are looked for from the compiler's folder and its -I folders.
 */
/* Bytes, name, and a struct target_asset of both. */
#define ASSET(name, path) \
    .section .assets, "a"; \
    .balign 4; \
    1: .incbin path; \
    2: .section .rodata.asset_names, "a"; \
    3: .asciz #name; \
    .section .rodata.asset_list, "a"; \
    .word 3b, 1b, 2b - 1b

    .section .rodata.asset_list, "a"
    .balign 4
list:
#include TARGET_ASSETS
    .section .rodata.asset_list, "a"
list_end:

    .section .rodata, "a"
    .balign 4
    .globl target_assets
target_assets:
    .word list
    .globl target_asset_count
target_asset_count:
    .word (list_end - list) / 12
