/* SPDX-License-Identifier: MIT */
/*
 * Semihosting: the debugger or emulator that runs the program writes its
 * texts and files. Numbers and calling as in Arm's "Semihosting for AArch32
 * and AArch64" and the RISC-V semihosting specification.
 */
#ifndef BRUME_SEMIHOSTING_H
#define BRUME_SEMIHOSTING_H

#include <stdbool.h>
#include <stdint.h>

/* Creates, or empties, a file: its handle, or -1. */
int semihosting_create(const char *path);

/* Both are false when the file did not take it all. */
bool semihosting_write(int handle, const void *data, uint32_t size);
bool semihosting_close(int handle);

void semihosting_remove(const char *path);

/* Sleeps for ever when the command line of the program contains a word. */
void semihosting_hold(const char *word);

/* Ends the program with an exit status of 0 to 255. */
void semihosting_exit(int status) __attribute__((noreturn));

#endif
