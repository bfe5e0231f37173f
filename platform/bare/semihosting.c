/* SPDX-License-Identifier: MIT */
/* Semihosting calls, for Cortex-M and 32-bit RISC-V; and target_write. */
#include "semihosting.h"

#include "target.h"

enum semihosting_operation {
    SYS_OPEN = 0x01,
    SYS_CLOSE = 0x02,
    SYS_WRITE = 0x05,
    SYS_REMOVE = 0x0e,
    SYS_GET_CMDLINE = 0x15,
    SYS_EXIT_EXTENDED = 0x20
};

#define MODE_WRITE 4u        /* "w" of fopen; of ":tt": standard output */
#define MODE_WRITE_BINARY 5u /* "wb" */
#define APPLICATION_EXIT 0x20026u

static int32_t call(enum semihosting_operation operation, const void *block)
{
#if defined(__riscv)
    register uintptr_t a0 __asm__("a0") = (uintptr_t)operation;
    register uintptr_t a1 __asm__("a1") = (uintptr_t)block;
    /* The three must be 4 bytes each and on one page. */
    __asm__ volatile(".balign 16\n\t"
                     ".option push\n\t"
                     ".option norvc\n\t"
                     "slli x0, x0, 0x1f\n\t"
                     "ebreak\n\t"
                     "srai x0, x0, 7\n\t"
                     ".option pop"
                     : "+r"(a0)
                     : "r"(a1)
                     : "memory");
    return (int32_t)a0;
#else
    register uintptr_t r0 __asm__("r0") = (uintptr_t)operation;
    register uintptr_t r1 __asm__("r1") = (uintptr_t)block;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return (int32_t)r0;
#endif
}

static uint32_t length_of(const char *text)
{
    uint32_t n = 0;
    while (text[n] != '\0')
        n++;
    return n;
}

static int open_as(const char *path, uint32_t mode)
{
    uintptr_t block[3] = {(uintptr_t)path, mode, length_of(path)};
    return (int)call(SYS_OPEN, block);
}

int semihosting_create(const char *path)
{
    return open_as(path, MODE_WRITE_BINARY);
}

bool semihosting_write(int handle, const void *data, uint32_t size)
{
    uintptr_t block[3] = {(uintptr_t)handle, (uintptr_t)data, size};
    return call(SYS_WRITE, block) == 0; /* bytes not written */
}

bool semihosting_close(int handle)
{
    uintptr_t block[1] = {(uintptr_t)handle};
    return call(SYS_CLOSE, block) == 0;
}

void semihosting_remove(const char *path)
{
    uintptr_t block[2] = {(uintptr_t)path, length_of(path)};
    call(SYS_REMOVE, block);
}

static bool command_line_has(const char *word)
{
    char line[128];
    uintptr_t block[2] = {(uintptr_t)line, sizeof line};
    uint32_t n = length_of(word), same = 0;
    if (call(SYS_GET_CMDLINE, block) != 0)
        return false;
    for (uint32_t i = 0; i < sizeof line && line[i] != '\0'; i++) {
        same = line[i] == word[same] ? same + 1u : line[i] == word[0];
        if (same == n)
            return true;
    }
    return false;
}

void semihosting_hold(const char *word)
{
    while (command_line_has(word))
        __asm__ volatile("wfi");
}

void semihosting_exit(int status)
{
    uintptr_t block[2] = {APPLICATION_EXIT, (uintptr_t)status};
    call(SYS_EXIT_EXTENDED, block);
    for (;;) { /* nobody listens */
    }
}

void target_write(const char *text)
{
    static int s_handle; /* 0: not opened yet */
    if (s_handle == 0)
        s_handle = open_as(":tt", MODE_WRITE);
    semihosting_write(s_handle, text, length_of(text));
}
