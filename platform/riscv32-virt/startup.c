/* SPDX-License-Identifier: MIT */
/* Start-up of rv32imac on QEMU's `virt`: stack, memory, traps, and minstret,
 * which counts instructions by itself. */
#include <stdint.h>

#include "semihosting.h"
#include "start.h"
#include "target.h"

/* Entry 0 of the physical memory protection: the 16 MiB at 0x80000000 that
 * board.ld takes for flash may be read and run, not written, in machine mode
 * too. They lie below the stack: too deep a one traps. */
#define PMP_FLASH ((0x80000000u >> 2) | ((16u << 20 >> 3) - 1u))
#define PMP_LOCKED_READ_RUN 0x9du /* power-of-two region */

void reset(void) __attribute__((noreturn, naked, section(".vectors")));
void start(void) __attribute__((noreturn, used));
void trap(void) __attribute__((noreturn, naked, aligned(4)));
void trap_report(void) __attribute__((noreturn, used));

void reset(void)
{
    __asm__ volatile("la sp, linker_stack_top\n\t"
                     "la t0, trap\n\t"
                     "csrw mtvec, t0\n\t"
                     "j start");
}

void start(void)
{
    __asm__ volatile("csrw pmpaddr0, %0" : : "r"(PMP_FLASH));
    __asm__ volatile("csrw pmpcfg0, %0" : : "r"(PMP_LOCKED_READ_RUN));
    start_memory();
    target_stack_paint();
    semihosting_exit(target_main());
}

/* Whatever became of the stack, reporting needs a good one. */
void trap(void)
{
    __asm__ volatile("la sp, linker_stack_top\n\t"
                     "j trap_report");
}

void trap_report(void)
{
    uint32_t cause, address;
    __asm__ volatile("csrr %0, mcause" : "=r"(cause));
    __asm__ volatile("csrr %0, mepc" : "=r"(address));
    start_fault("fault: trap ", cause, address);
}

uint64_t target_instructions(void)
{
    uint32_t high, low, again;
    do {
        __asm__ volatile("csrr %0, minstreth" : "=r"(high));
        __asm__ volatile("csrr %0, minstret" : "=r"(low));
        __asm__ volatile("csrr %0, minstreth" : "=r"(again));
    } while (high != again);
    return (uint64_t)high << 32 | low;
}
