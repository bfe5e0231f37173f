/* SPDX-License-Identifier: MIT */
/*
 * The sections for light of assets made by tests: MIPS, SUNC and AMBI, in
 * integers, so that their bytes are the same everywhere. Written from
 * docs/SPEC.md.
 */
#ifndef BRUME_TESTS_ASSET_LIGHT_H
#define BRUME_TESTS_ASSET_LIGHT_H

#include "asset_builder.h"

struct asset_light {
    bool mips;
    int spacing_log2; /* of SUNC: 1, 2 or 3; 0: none */
    bool sky;
};

/* Adds sections at the end of a blob of asset_build, which has none of them,
 * and returns it where it is then. MIPS and SUNC are as SPEC.md says, SUNC for
 * a sun along +y; AMBI falls with the cell's own density only, for there is no
 * exp in integers here. */
uint8_t *asset_add_light(uint8_t *asset, size_t *size,
                         const struct asset_light *what);

/* Adds EMIT, with codes from a hash of brick and voxel, a quarter of them 0,
 * and code 255 for value_m * 2^value_e. */
uint8_t *asset_add_emission(uint8_t *asset, size_t *size, uint32_t value_m,
                            int32_t value_e);

/* Bytes of a section, 0 when there is none. */
uint32_t asset_section_bytes(const uint8_t *asset, uint32_t id);

#endif
