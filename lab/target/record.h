/* SPDX-License-Identifier: MIT */
/*
 * Scenes as a target reads them: brume-lab's command `pack` writes records,
 * one behind the other, and count.c draws them and counts. Little-endian words:
 *
 *   magic, bytes of the record, frames to draw, CRC-32 of the last picture in
 *   L16, the scene's fields in the order below, 1 if there is lighting and its
 *   fields, 1 if there is a noise table and its head and values
 *
 * A picture that is not the host's tells of a field that was forgotten.
 */
#ifndef BRUME_LAB_RECORD_H
#define BRUME_LAB_RECORD_H

#include "brume.h"

#define RECORD_MAGIC 0x54464c42u
#define RECORD_HEAD 4u   /* words */
#define RECORD_SCENE 128 /* words of scene and lighting, at most */

#define RECORD_SCENE_FIELDS(ONE, THREE, LONG) \
    ONE(width); \
    ONE(height); \
    ONE(frame); \
    THREE(eye); \
    THREE(target); \
    THREE(up); \
    ONE(fov); \
    THREE(sun); \
    LONG(density_scale); \
    LONG(light_density_scale); \
    LONG(min_density); \
    LONG(max_density); \
    ONE(albedo); \
    ONE(step); \
    ONE(light_step); \
    ONE(min_transmittance); \
    THREE(background); \
    ONE(light_samples); \
    ONE(filter); \
    ONE(light); \
    ONE(jitter); \
    ONE(noise); \
    ONE(output); \
    ONE(skip); \
    ONE(temporal); \
    ONE(history_bits); \
    ONE(window); \
    ONE(fetch); \
    ONE(clamp); \
    ONE(spatial); \
    ONE(resolution); \
    ONE(update); \
    ONE(upsample); \
    ONE(subpixel); \
    ONE(cut); \
    ONE(alpha); \
    ONE(gamma); \
    ONE(edge_falloff)

/* Of lighting what `light = cache` sets; anything else is refused. */
#define RECORD_LIGHT_FIELDS(ONE, THREE, LONG) \
    ONE(octaves); \
    ONE(octave_a); \
    ONE(octave_b); \
    ONE(exposure); \
    THREE(sun_colour); \
    THREE(zenith)

#define RECORD_NOISE_FIELDS(ONE, THREE, LONG) \
    ONE(width_log2); \
    ONE(height_log2); \
    ONE(frames_log2); \
    ONE(bits)

/* Bit by bit: no table, and a picture is small. From and to 0xffffffff. */
static inline uint32_t record_crc(const uint8_t *bytes, uint32_t size)
{
    uint32_t crc = 0xffffffffu;
    for (uint32_t i = 0; i < size; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (0xedb88320u & (0u - (crc & 1u)));
    }
    return crc;
}

#endif
