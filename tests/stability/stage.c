/* SPDX-License-Identifier: MIT */
/* The volumes: files, and those made here. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stability.h"
#include "support/asset_builder.h"
#include "volume_file.h"

#define FULL 65280u /* density_max */

/// Made here ///

/* Strands a voxel thick and 12 apart, along all axes and askew. */
static uint32_t in_filaments(int x, int y, int z, const void *context)
{
    (void)context;
    int inside = x >= 4 && x < 68 && y >= 4 && y < 68 && z >= 4 && z < 68;
    int strands = (x % 12 == 6 && (y + z) % 12 == 6) ||
                  (y % 12 == 6 && (x + 2 * z) % 24 == 3) ||
                  (z % 12 == 6 && (2 * x + y) % 24 == 9);
    return inside && strands ? FULL : 0;
}

/* Balls three voxels wide, one in 56 each way, at uneven places. */
static uint32_t in_puffs(int x, int y, int z, const void *context)
{
    (void)context;
    int i = x / 56, j = y / 56;
    int dx = x % 56 - 20 - (i * 7 + j * 3) % 13;
    int dy = y % 56 - 20 - (i * 5 + j * 11) % 13;
    int dz = z - 12;
    return 4 * (dx * dx + dy * dy + dz * dz) <= 9 ? FULL : 0;
}

static uint32_t in_wall(int x, int y, int z, const void *context)
{
    (void)context;
    return x >= 8 && x < 40 && y >= 4 && y < 84 && z >= 4 && z < 12 ? FULL : 0;
}

static const struct {
    const char *name;
    int cells[3];
    density_fn *density;
} k_made[] = {{"filaments", {9, 9, 9}, in_filaments},
              {"puffs", {70, 42, 3}, in_puffs},
              {"wall", {6, 11, 2}, in_wall}};
#define MADE (sizeof k_made / sizeof k_made[0])

static const struct brume_volume *made(const char *name)
{
    static struct brume_volume volumes[MADE];
    static uint8_t *assets[MADE];
    for (size_t i = 0; i < MADE; i++) {
        if (strcmp(k_made[i].name, name) != 0)
            continue;
        if (assets[i] == NULL) {
            const int *n = k_made[i].cells;
            size_t size;
            struct asset_spec spec = asset_spec_of(n[0], n[1], n[2], BRUME_U8,
                                                   k_made[i].density, NULL);
            assets[i] = asset_build(&spec, &size);
            if (brume_volume_open(&volumes[i], assets[i], size, 0) != BRUME_OK)
                abort();
        }
        return &volumes[i];
    }
    return NULL;
}

/// Files ///

#define FILES 16
static struct {
    char name[24];
    struct volume_file file;
} s_files[FILES];
static int s_count;

int stage_open(const char *argument)
{
    const char *path = strchr(argument, '=');
    char err[512];
    if (path == NULL || s_count == FILES ||
        (size_t)(path - argument) >= sizeof s_files[0].name) {
        fprintf(stderr, "brume-stability: not NAME=FILE, or too many: %s\n",
                argument);
        return -1;
    }
    memcpy(s_files[s_count].name, argument, (size_t)(path - argument));
    if (volume_file_open(&s_files[s_count].file, path + 1, err, sizeof err)) {
        fprintf(stderr, "brume-stability: %s\n", err);
        return -1;
    }
    s_count++;
    return 0;
}

const struct brume_volume *stage_volume(const char *name)
{
    for (int i = 0; i < s_count; i++)
        if (strcmp(s_files[i].name, name) == 0)
            return &s_files[i].file.volume;
    return made(name);
}

void stage_close(void)
{
    while (s_count > 0)
        volume_file_close(&s_files[--s_count].file);
}
