/* SPDX-License-Identifier: MIT */
/* What the demos leave out, for their brume_config.h: all but nearest lookup
 * of u8 and u4r bricks and light of doubling steps. */
#define BRUME_WITH_U8R 0
#define BRUME_WITH_APRON 0
#define BRUME_WITH_TRILINEAR 0
#define BRUME_WITH_UNIFORM 0
#define BRUME_WITH_MAX_DENSITY 0
#define BRUME_WITH_SEQUENCES 0
#define BRUME_WITH_LIGHTING 0
