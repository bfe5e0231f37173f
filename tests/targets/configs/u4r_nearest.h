/* SPDX-License-Identifier: MIT */
/* The largest volume in the least flash: 4-bit bricks, nearest lookup. */
#define BRUME_WITH_U8 0
#define BRUME_WITH_U8R 0
#define BRUME_WITH_APRON 0
#define BRUME_WITH_TRILINEAR 0
#define BRUME_WITH_UNIFORM 0
#define BRUME_WITH_MAX_DENSITY 0
#define BRUME_WITH_SEQUENCES 0
#define BRUME_WITH_LIGHTING 0
