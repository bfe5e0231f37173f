/* SPDX-License-Identifier: MIT */
/* The best picture of a volume with a wide range: 8-bit bricks with ranges,
 * stored with an apron, trilinear lookup, both kinds of light. */
#define BRUME_WITH_U8 0
#define BRUME_WITH_U4R 0
#define BRUME_WITH_NEAREST 0
#define BRUME_WITH_MAX_DENSITY 0
#define BRUME_WITH_SEQUENCES 0
#define BRUME_WITH_LIGHTING 0
