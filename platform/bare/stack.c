/* SPDX-License-Identifier: MIT */
/* The painted stack: what has lost its paint was used. The stack lies at the
 * low end of RAM (sections.ld), so that one too deep faults at once instead of
 * writing over data. */
#include "target.h"

#define PAINT 0x5ca1ab1eu

extern uint32_t linker_stack_bottom[];

static uintptr_t s_painted; /* the caller's stack pointer when painted */

static uintptr_t stack_pointer(void)
{
    uintptr_t sp;
#if defined(__riscv)
    __asm__ volatile("mv %0, sp" : "=r"(sp));
#else
    __asm__ volatile("mov %0, sp" : "=r"(sp));
#endif
    return sp;
}

/* Not inlined, so that the canonical frame address is the caller's stack
 * pointer. Below its own stack pointer nothing is in use. */
__attribute__((noinline)) void target_stack_paint(void)
{
    volatile uint32_t *p = linker_stack_bottom;
    s_painted = (uintptr_t)__builtin_dwarf_cfa();
    while ((uintptr_t)p < stack_pointer())
        *p++ = PAINT;
}

uint32_t target_stack_used(void)
{
    const volatile uint32_t *p = linker_stack_bottom;
    if (s_painted == 0)
        return 0;
    while ((uintptr_t)p < s_painted && *p == PAINT)
        p++;
    return (uint32_t)(s_painted - (uintptr_t)p);
}
