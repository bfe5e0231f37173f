/* SPDX-License-Identifier: MIT */
/* Clock of SysTick: 168 MHz. */
#define BOARD_TICKS 21u
#define BOARD_NS 125u /* in which it counts BOARD_TICKS */
