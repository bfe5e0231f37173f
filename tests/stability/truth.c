/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stability.h"

/* A noise that has one value everywhere moves every ray alike: over all 256 of
 * them, and with them over the 16 points of an N-rooks set, jitter and places
 * in the pixel are spread evenly, without noise. */
void truth_render(const struct brume_volume *volume,
                  const struct brume_scene *scene, int samples, picture_t out)
{
    static uint8_t values[64];
    static uint32_t sum[STABILITY_PIXELS];
    static struct brume_frame frame;
    const struct brume_noise_table table = {values, 3, 3, 0, 8};
    struct brume_scene s = *scene;
    const uint32_t n = (uint32_t)samples;
    s.temporal = BRUME_TEMPORAL_NONE;
    s.update = BRUME_UPDATE_ALL;
    s.resolution = BRUME_FULL;
    s.noise = BRUME_NOISE_TABLE;
    s.noise_table = &table;
    memset(sum, 0, sizeof sum);
    for (uint32_t k = 0; k < n; k++) {
        memset(values, (int)(k * 256 / n), sizeof values);
        s.frame = k * 7u & 15u;
        int error = brume_begin_frame(&frame, volume, &s);
        if (error == BRUME_OK)
            error = brume_render_rect(&frame, 0, 0, s.width, s.height,
                                      BRUME_L16, out, 2u * s.width);
        if (error != BRUME_OK) {
            fprintf(stderr, "truth: %s\n", brume_error_text(error));
            abort();
        }
        for (int i = 0; i < STABILITY_PIXELS; i++)
            sum[i] += out[i];
    }
    for (int i = 0; i < STABILITY_PIXELS; i++)
        out[i] = (uint16_t)((sum[i] + n / 2) / n);
}
