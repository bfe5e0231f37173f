/* SPDX-License-Identifier: MIT */
/* A viewer of any baked volume: every format, nearest lookup, one light. */
#define BRUME_WITH_APRON 1
#define BRUME_WITH_TRILINEAR 0
#define BRUME_WITH_UNIFORM 0
#define BRUME_WITH_MAX_DENSITY 0
#define BRUME_WITH_SEQUENCES 0
#define BRUME_WITH_LIGHTING 0
