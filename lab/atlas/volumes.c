/* SPDX-License-Identifier: MIT */
/*
 * The volumes of the atlas: simple, so that the truth is plain, and each made
 * to break a method. As an asset, and as a float dump (docs/SPEC.md) for the
 * reference. World space is the pool's, in voxels.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "atlas.h"
#include "out_file.h"

#define FULL 65280u /* density 1 */
#define OF_255(k) \
    ((k)*256u) /* density k / 255, exact in all formats but u4r \
                */

/// Densities ///

static int within(int v, int low, int high)
{
    return v >= low && v < high;
}

static uint32_t box(int x, int y, int z, const int low[3], const int high[3])
{
    return within(x, low[0], high[0]) && within(y, low[1], high[1]) &&
                   within(z, low[2], high[2])
               ? FULL
               : 0;
}

static uint32_t in_block(int x, int y, int z, const void *context)
{
    static const int low[3] = {8, 8, 8}, high[3] = {56, 56, 56};
    (void)context;
    return box(x, y, z, low, high);
}

static uint32_t in_cloud(int x, int y, int z, const void *context)
{
    static const struct density_cloud cloud = {64, 7};
    (void)context;
    return OF_255(density_in_cloud(x, y, z, &cloud) / 256);
}

/* One voxel thick, facing z. */
static uint32_t in_sheet(int x, int y, int z, const void *context)
{
    static const int low[3] = {4, 4, 17}, high[3] = {60, 60, 18};
    (void)context;
    return box(x, y, z, low, high);
}

/* Single voxels, one in eight each way, at depths that differ. */
static uint32_t in_dots(int x, int y, int z, const void *context)
{
    (void)context;
    int at = (x / 8 * 5 + y / 8 * 3) % 32;
    return x % 8 == 4 && y % 8 == 4 && z == 16 + at ? FULL : 0;
}

/* A ground, and a roof far above it whose shadow falls on its middle. */
static uint32_t in_roof(int x, int y, int z, const void *context)
{
    static const int ground[2][3] = {{2, 2, 2}, {62, 8, 62}};
    static const int roof[2][3] = {{20, 31, 20}, {44, 35, 44}};
    (void)context;
    return box(x, y, z, ground[0], ground[1]) | box(x, y, z, roof[0], roof[1]);
}

/* Faint all through: density k / 255, k = 1 .. 9 by its name. */
static uint32_t in_veil(int x, int y, int z, const void *context)
{
    static const int low[3] = {4, 4, 4}, high[3] = {60, 60, 252};
    const int *k = context;
    return box(x, y, z, low, high) ? OF_255((uint32_t)*k) : 0;
}

/* Long and thin, along z. */
static uint32_t in_beam(int x, int y, int z, const void *context)
{
    static const int low[3] = {2, 2, 1}, high[3] = {22, 22, 3999};
    (void)context;
    return box(x, y, z, low, high);
}

/* A smooth slope along x, thin enough to see through. */
static uint32_t in_slope(int x, int y, int z, const void *context)
{
    (void)context;
    if (!within(x, 4, 60) || !within(y, 4, 60) || !within(z, 20, 44))
        return 0;
    return (uint32_t)(1000 + 1000 * x);
}

/* The same, with a dense voxel in every other brick: the range of a brick's
 * codes is then all of it, its neighbours' a sixth. */
static uint32_t in_spikes(int x, int y, int z, const void *context)
{
    int odd = (x / 8 + y / 8 + z / 8) % 2;
    (void)context;
    if (!within(x, 4, 60) || !within(y, 4, 60) || !within(z, 20, 44))
        return 0;
    if (odd && x % 8 == 4 && y % 8 == 4 && z % 8 == 4)
        return FULL;
    return (uint32_t)(4000 + 100 * x);
}

/* Low and long, for a sun near the horizon along z. */
static uint32_t in_plain(int x, int y, int z, const void *context)
{
    static const int low[3] = {4, 4, 4}, high[3] = {44, 20, 252};
    (void)context;
    return box(x, y, z, low, high);
}

/* Strands two voxels thick, 16 apart, that lead away from the eye. */
static uint32_t in_strands(int x, int y, int z, const void *context)
{
    (void)context;
    return within(x, 4, 60) && within(y, 4, 60) && x % 16 >= 7 && x % 16 < 9 &&
                   within(z - 8 - y / 2, 0, 2)
               ? FULL
               : 0;
}

/* A ball of radius 12 at the far end of the longest pool there is, or at its
 * beginning: what is near the eye is the same. */
static uint32_t ball(int x, int y, int z)
{
    int d = (x - 16) * (x - 16) + (y - 16) * (y - 16) + (z - 16) * (z - 16);
    return d < 144 ? OF_255((uint32_t)(255 * (144 - d) / 144)) : 0;
}

static uint32_t in_ball(int x, int y, int z, const void *context)
{
    (void)context;
    return ball(x, y, z);
}

#define FAR (8 * 4095 - 32) /* voxels from the pool's corner */

static uint32_t in_far_ball(int x, int y, int z, const void *context)
{
    (void)context;
    return ball(x, y, z - FAR);
}

static const int k_k[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};

static const struct {
    const char *name;
    int cells[3];
    density_fn *density;
    const int *context;
} k_volumes[] = {
    {"block", {8, 8, 8}, in_block, NULL},
    {"cloud", {8, 8, 8}, in_cloud, NULL},
    {"sheet", {8, 8, 5}, in_sheet, NULL},
    {"dots", {8, 8, 8}, in_dots, NULL},
    {"roof", {8, 8, 8}, in_roof, NULL},
    {"veil1", {8, 8, 32}, in_veil, &k_k[1]},
    {"veil2", {8, 8, 32}, in_veil, &k_k[2]},
    {"veil3", {8, 8, 32}, in_veil, &k_k[3]},
    {"veil4", {8, 8, 32}, in_veil, &k_k[4]},
    {"beam", {3, 3, 500}, in_beam, NULL},
    {"slope", {8, 8, 8}, in_slope, NULL},
    {"spikes", {8, 8, 8}, in_spikes, NULL},
    {"plain", {6, 3, 32}, in_plain, NULL},
    {"strands", {8, 8, 8}, in_strands, NULL},
    {"ball", {4, 4, 4}, in_ball, NULL},
    {"farball", {4, 4, 4095}, in_far_ball, NULL},
};
#define VOLUMES (sizeof k_volumes / sizeof k_volumes[0])

/// Files ///

static int write_file(const char *path, const void *a, size_t a_size,
                      const void *b, size_t b_size)
{
    struct out_file out;
    char err[300];
    if (out_open(&out, path, err, sizeof err) == 0) {
        if (out_write(&out, a, a_size, err, sizeof err) == 0 &&
            (b_size == 0 || out_write(&out, b, b_size, err, sizeof err) == 0) &&
            out_close(&out, err, sizeof err) == 0)
            return 0;
        out_abandon(&out);
    }
    fprintf(stderr, "brume-atlas: %s: %s\n", path, err);
    return 1;
}

static void put_float(uint8_t *p, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    asset_put32(p, bits);
}

static int write_dump(const char *path, size_t i)
{
    const int *c = k_volumes[i].cells;
    char head[200];
    size_t n = 512 * (size_t)c[0] * (size_t)c[1] * (size_t)c[2];
    uint8_t *voxels = malloc(4 * n), *p = voxels;
    if (voxels == NULL) {
        fprintf(stderr, "brume-atlas: no memory for the dump\n");
        return 1;
    }
    for (int z = 0; z < 8 * c[2]; z++)
        for (int y = 0; y < 8 * c[1]; y++)
            for (int x = 0; x < 8 * c[0]; x++, p += 4)
                put_float(p, (float)k_volumes[i].density(x, y, z,
                                                         k_volumes[i].context) /
                                 FULL);
    snprintf(head, sizeof head,
             "brume-float 1\nsize %d %d %d\norigin 0 0 0\n"
             "world_from_index 1 0 0 0 0 1 0 0 0 0 1 0\ndata float32le\n",
             8 * c[0], 8 * c[1], 8 * c[2]);
    int bad = write_file(path, head, strlen(head), voxels, 4 * n);
    free(voxels);
    return bad;
}

static struct asset_spec spec_of(size_t i, int format)
{
    const int *c = k_volumes[i].cells;
    return asset_spec_of(c[0], c[1], c[2], format, k_volumes[i].density,
                         k_volumes[i].context);
}

static int find(const char *name, size_t *i)
{
    for (*i = 0; *i < VOLUMES; (*i)++)
        if (strcmp(k_volumes[*i].name, name) == 0)
            return 0;
    fprintf(stderr, "brume-atlas: no volume '%s'\n", name);
    return 2;
}

int atlas_volume(int argc, char **argv)
{
    static const char *const formats[] = {"u8", "u8r", "u4r"};
    int format = 0;
    size_t i, size;
    if (argc < 4 || argc > 5) {
        fprintf(stderr, "brume-atlas: volume NAME u8|u8r|u4r OUT.brume "
                        "[OUT.float]\n");
        return 2;
    }
    while (format < 3 && strcmp(formats[format], argv[2]) != 0)
        format++;
    if (format == 3) {
        fprintf(stderr, "brume-atlas: no format '%s'\n", argv[2]);
        return 2;
    }
    if (find(argv[1], &i) != 0)
        return 2;
    struct asset_spec spec = spec_of(i, BRUME_U8 + format);
    uint8_t *asset = asset_build(&spec, &size);
    int bad = write_file(argv[3], asset, size, NULL, 0);
    free(asset);
    return bad || (argc == 5 && write_dump(argv[4], i));
}

double atlas_density(size_t i, const double p[3])
{
    const int *c = k_volumes[i].cells;
    int v[3];
    for (int k = 0; k < 3; k++) {
        if (!(p[k] >= -0.5 && p[k] < 8 * c[k] - 0.5))
            return 0;
        v[k] = (int)(p[k] + 0.5);
    }
    return (double)k_volumes[i].density(v[0], v[1], v[2],
                                        k_volumes[i].context) /
           FULL;
}

int atlas_find(const char *name, size_t *i)
{
    return find(name, i);
}
