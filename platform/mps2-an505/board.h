/* SPDX-License-Identifier: MIT */
/* Clock of SysTick: 20 MHz. */
#define BOARD_TICKS 1u
#define BOARD_NS 50u /* in which it counts BOARD_TICKS */
