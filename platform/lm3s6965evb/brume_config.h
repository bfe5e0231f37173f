/* SPDX-License-Identifier: MIT */
/* For a grey display. */
#include "demo/nearest.h"
#define BRUME_WITH_RGB 0
