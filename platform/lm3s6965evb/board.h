/* SPDX-License-Identifier: MIT */
/* Clock of SysTick: 12.5 MHz, after reset. */
#define BOARD_TICKS 1u
#define BOARD_NS 80u /* in which it counts BOARD_TICKS */
