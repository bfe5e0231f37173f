/* SPDX-License-Identifier: MIT */
/* Clock of SysTick: 16 MHz. */
#define BOARD_TICKS 2u
#define BOARD_NS 125u /* in which it counts BOARD_TICKS */
