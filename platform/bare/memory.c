/* SPDX-License-Identifier: MIT */
/*
 * memcpy and memset, which a compiler may call on its own: all that the core
 * asks of a C library. Words where both ends are aligned. The empty assembly
 * keeps compilers from seeing a memcpy in the loops of memcpy.
 */
#include <stddef.h>
#include <stdint.h>

typedef uint32_t __attribute__((__may_alias__)) word_t;

void *memcpy(void *restrict to, const void *restrict from, size_t size);
void *memset(void *to, int value, size_t size);

void *memcpy(void *restrict to, const void *restrict from, size_t size)
{
    uint8_t *d = to;
    const uint8_t *s = from;
    if ((((uintptr_t)d | (uintptr_t)s) & 3u) == 0)
        for (; size >= 4; size -= 4, d += 4, s += 4) {
            *(word_t *)(void *)d = *(const word_t *)(const void *)s;
            __asm__ volatile("");
        }
    for (; size > 0; size--) {
        *d++ = *s++;
        __asm__ volatile("");
    }
    return to;
}

void *memset(void *to, int value, size_t size)
{
    uint8_t *d = to;
    uint32_t word = (uint8_t)value * 0x01010101u;
    if (((uintptr_t)d & 3u) == 0)
        for (; size >= 4; size -= 4, d += 4) {
            *(word_t *)(void *)d = word;
            __asm__ volatile("");
        }
    for (; size > 0; size--) {
        *d++ = (uint8_t)word;
        __asm__ volatile("");
    }
    return to;
}
