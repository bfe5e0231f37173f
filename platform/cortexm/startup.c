/* SPDX-License-Identifier: MIT */
/*
 * Start-up of all Cortex-M boards: vectors, memory, SysTick as a counter of
 * instructions, faults. board.h says how long a tick is.
 *
 * Under `qemu-system-arm -icount shift=0` an instruction takes 1 ns of the
 * emulated time that SysTick counts, so ticks are instructions, to a tick
 * (6 to 80 instructions). Each wrap interrupts for about 10 more. On silicon
 * the same numbers are nanoseconds, if the clock is what board.h says.
 */
#include <stdint.h>

#include "board.h"
#include "semihosting.h"
#include "start.h"
#include "target.h"

/// SysTick (Arm Architecture Reference Manuals, v6-M to v8-M) ///

#define SYST_CSR (*(volatile uint32_t *)0xe000e010u)
#define SYST_RVR (*(volatile uint32_t *)0xe000e014u)
#define SYST_CVR (*(volatile uint32_t *)0xe000e018u)
#define ICSR (*(volatile uint32_t *)0xe000ed04u)

#define CSR_ENABLE_INTERRUPT_CPU_CLOCK 7u
#define ICSR_PENDSTSET (1u << 26)

/* BOARD_TICKS ticks take BOARD_NS ns. The counter wraps after the largest
 * multiple of a power of two in 24 bits, so after a whole number of ns. */
#define WRAP_TICKS \
    ((BOARD_TICKS & (BOARD_TICKS - 1)) == 0 ? 1u << 24 : BOARD_TICKS << 19)
#define WRAP_NS (WRAP_TICKS / BOARD_TICKS * BOARD_NS)

_Static_assert(BOARD_TICKS < 32, "24 bits");
_Static_assert(BOARD_NS <= 255, "a wrap's ticks * BOARD_NS < 2^32");

static volatile uint32_t s_wraps;

static void systick(void)
{
    s_wraps++;
}

static void start_systick(void)
{
    SYST_RVR = WRAP_TICKS - 1u;
    SYST_CVR = 0;
    SYST_CSR = CSR_ENABLE_INTERRUPT_CPU_CLOCK;
}

/* The counter runs down to 0, where it interrupts, and then restarts. A wrap
 * that is pending is not yet in s_wraps: read again. 2^32 wraps take 8 years
 * at the least. */
uint64_t target_instructions(void)
{
    uint32_t wraps, left, pending;
    do {
        wraps = s_wraps;
        left = SYST_CVR;
        pending = ICSR & ICSR_PENDSTSET;
    } while (pending != 0 || wraps != s_wraps);
    uint32_t ticks = left == 0 ? 0 : WRAP_TICKS - left;
    return (uint64_t)wraps * WRAP_NS + ticks * BOARD_NS / BOARD_TICKS;
}

/// Start and faults ///

extern uint32_t linker_stack_top[];

void reset(void) __attribute__((noreturn));
void fault_report(const uint32_t *frame) __attribute__((noreturn, used));

void reset(void)
{
    start_memory();
    target_stack_paint();
    start_systick();
    semihosting_exit(target_main());
}

/* The frame that an exception pushes: r0-r3, r12, lr, pc, xpsr. */
void fault_report(const uint32_t *frame)
{
    uint32_t ipsr;
    __asm__ volatile("mrs %0, ipsr" : "=r"(ipsr));
    start_fault("fault: exception ", ipsr & 0x1ffu, frame[6]);
}

__attribute__((naked)) static void fault(void)
{
    __asm__ volatile("mov r0, sp\n\t"
                     "bl fault_report");
}

struct vectors {
    uint32_t *stack_top;
    void (*handlers[15])(void);
};

static const struct vectors k_vectors
    __attribute__((section(".vectors"), used)) = {
        linker_stack_top,
        {reset, fault, fault, fault, fault, fault, fault, fault, fault, fault,
         fault, fault, fault, fault, systick}};
