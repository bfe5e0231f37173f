/* SPDX-License-Identifier: MIT */
/* The least that renders a cloud with doubling light samples: u8 bricks,
 * nearest lookup. For small microcontrollers. */
#define BRUME_WITH_U8R 0
#define BRUME_WITH_U4R 0
#define BRUME_WITH_APRON 0
#define BRUME_WITH_TRILINEAR 0
#define BRUME_WITH_UNIFORM 0
#define BRUME_WITH_MAX_DENSITY 0
#define BRUME_WITH_SEQUENCES 0
#define BRUME_WITH_LIGHTING 0
