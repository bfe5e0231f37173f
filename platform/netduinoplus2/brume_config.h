/* SPDX-License-Identifier: MIT */
#include "demo/nearest.h"
