/* SPDX-License-Identifier: MIT */
/* What start-up code of all boards shares. Symbols are of sections.ld. */
#include "start.h"

#include "print.h"
#include "semihosting.h"
#include "target.h"

#define FAULT_STATUS 70

extern uint32_t linker_data[], linker_data_end[], linker_bss[],
    linker_bss_end[];
extern const uint32_t linker_data_load[];

void start_memory(void)
{
    const uint32_t *from = linker_data_load;
    for (volatile uint32_t *p = linker_data; p != linker_data_end; p++)
        *p = *from++;
    for (volatile uint32_t *p = linker_bss; p != linker_bss_end; p++)
        *p = 0;
}

void start_fault(const char *what, uint32_t cause, uint32_t address)
{
    target_write(what);
    print_number(cause);
    target_write(" at ");
    print_hex(address);
    target_write("\n");
    semihosting_exit(FAULT_STATUS);
}
