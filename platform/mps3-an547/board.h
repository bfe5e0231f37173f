/* SPDX-License-Identifier: MIT */
/* Clock of SysTick: 32 MHz. */
#define BOARD_TICKS 4u
#define BOARD_NS 125u /* in which it counts BOARD_TICKS */
