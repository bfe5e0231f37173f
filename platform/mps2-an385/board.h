/* SPDX-License-Identifier: MIT */
/* Clock of SysTick: 25 MHz. */
#define BOARD_TICKS 1u
#define BOARD_NS 40u /* in which it counts BOARD_TICKS */
