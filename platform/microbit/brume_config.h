/* SPDX-License-Identifier: MIT */
/* The smallest core: 4-bit bricks, grey. */
#include "demo/nearest.h"
#define BRUME_WITH_U8 0
#define BRUME_WITH_RGB 0
