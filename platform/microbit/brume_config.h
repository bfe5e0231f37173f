/* SPDX-License-Identifier: MIT */
/* The smallest core: one format, nearest lookup, light of doubling steps. */
#define BRUME_WITH_U8 0
#define BRUME_WITH_U8R 0
#define BRUME_WITH_U4R 1
#define BRUME_WITH_APRON 0
#define BRUME_WITH_TRILINEAR 0
#define BRUME_WITH_UNIFORM 0
#define BRUME_WITH_MAX_DENSITY 0
#define BRUME_WITH_RGB 0
