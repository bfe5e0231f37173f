/* SPDX-License-Identifier: MIT */
/* For grey displays and the smallest flash: 4-bit bricks, nearest lookup, no
 * colour, no jitter; frames up to 320 pixels, light rays of ten samples. */
#define BRUME_WITH_U8 0
#define BRUME_WITH_U8R 0
#define BRUME_WITH_APRON 0
#define BRUME_WITH_TRILINEAR 0
#define BRUME_WITH_UNIFORM 0
#define BRUME_WITH_MAX_DENSITY 0
#define BRUME_WITH_RGB 0
#define BRUME_WITH_NOISE 0
#define BRUME_MAX_SIZE 320
#define BRUME_MAX_LOG_SAMPLES 10
#define BRUME_SPAN 16
#define BRUME_WITH_SEQUENCES 0
#define BRUME_WITH_LIGHTING 0
