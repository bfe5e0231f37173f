/* SPDX-License-Identifier: MIT */
#include "noises.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "brume_noise_tables.h"

/// Names ///

const char noise_words[] =
    "none white ign bayer8 bayer4 bayer16 ign-thesis rank1 white8 blue "
    "blue-slices stbn stbn-small stbn-tiny fast fast-small fast-tiny golden "
    "bayer8-golden r2 nrooks";

static const struct {
    uint8_t noise;
    const struct brume_noise_table *table;
} k_noise[] = {
    {BRUME_NOISE_NONE, NULL},
    {BRUME_NOISE_WHITE, NULL},
    {BRUME_NOISE_IGN, NULL},
    {BRUME_NOISE_BAYER8, NULL},
    {BRUME_NOISE_BAYER4, NULL},
    {BRUME_NOISE_BAYER16, NULL},
    {BRUME_NOISE_IGN_THESIS, NULL},
    {BRUME_NOISE_RANK1, NULL},
    {BRUME_NOISE_TABLE, &brume_noise_white8},
    {BRUME_NOISE_TABLE, &brume_noise_blue},
    {BRUME_NOISE_TABLE, &brume_noise_blue_slices},
    {BRUME_NOISE_TABLE, &brume_noise_stbn},
    {BRUME_NOISE_TABLE, &brume_noise_stbn_small},
    {BRUME_NOISE_TABLE, &brume_noise_stbn_tiny},
    {BRUME_NOISE_TABLE, &brume_noise_fast},
    {BRUME_NOISE_TABLE, &brume_noise_fast_small},
    {BRUME_NOISE_TABLE, &brume_noise_fast_tiny},
    {BRUME_NOISE_TABLE_GOLDEN, &brume_noise_blue},
    {BRUME_NOISE_TABLE_GOLDEN, &brume_noise_bayer8},
    {BRUME_NOISE_TABLE_R2, &brume_noise_blue},
};
#define NOISES (sizeof k_noise / sizeof k_noise[0])

/* The last name: the blue table, frame f moved to point f of the 16 N-rooks
 * points, in sixteenths of its sides. Made when it is chosen. */
static uint8_t s_nrooks_values[64 * 64 * 16];
static const struct brume_noise_table k_nrooks = {s_nrooks_values, 6, 6, 4, 8};

static void make_nrooks(void)
{
    for (unsigned i = 0; i < sizeof s_nrooks_values; i++) {
        unsigned point = brume_nrooks[15][i >> 12];
        unsigned x = (i + 4 * (point & 15)) & 63;
        unsigned y = ((i >> 6) + 4 * (point >> 4)) & 63;
        s_nrooks_values[i] = brume_noise_blue.values[y * 64 + x];
    }
}

void noise_choose(unsigned number, struct brume_scene *scene)
{
    if (number < NOISES) {
        scene->noise = k_noise[number].noise;
        scene->noise_table = k_noise[number].table;
        return;
    }
    make_nrooks();
    scene->noise = BRUME_NOISE_TABLE;
    scene->noise_table = &k_nrooks;
}

unsigned noise_number(const struct brume_scene *scene)
{
    for (unsigned i = 0; i < NOISES; i++)
        if (k_noise[i].noise == scene->noise &&
            (scene->noise < BRUME_NOISE_TABLE ||
             k_noise[i].table == scene->noise_table))
            return i;
    return scene->noise_table == &k_nrooks ? NOISES : 0;
}

/// Files ///

bool noise_is_file(const char *text)
{
    size_t n = strlen(text);
    return n > 4 && strcmp(text + n - 4, ".raw") == 0;
}

/* The logarithm of a side, or -1. */
static int log2_of(unsigned long side)
{
    for (int i = 0; i <= 8; i++)
        if (side == 1ul << i)
            return i;
    return -1;
}

/* The size in NAME.WxHxT.raw. */
static bool read_size(const char *path, struct brume_noise_table *t)
{
    size_t n = strlen(path) - 4;
    while (n > 0 && path[n - 1] != '.' && path[n - 1] != '/')
        n--;
    unsigned long side[3];
    char *end;
    for (int i = 0; i < 3; i++) {
        const char *from = i == 0 ? path + n : end + 1;
        if (*from < '1' || *from > '9')
            return false;
        side[i] = strtoul(from, &end, 10);
        if (*end != (i < 2 ? 'x' : '.'))
            return false;
    }
    int w = log2_of(side[0]), h = log2_of(side[1]), f = log2_of(side[2]);
    t->width_log2 = (uint8_t)w;
    t->height_log2 = (uint8_t)h;
    t->frames_log2 = (uint8_t)f;
    t->bits = 8;
    return w >= 3 && h >= 3 && f >= 0 && f <= 6;
}

const struct brume_noise_table *noise_read(const char *path, char *err,
                                           size_t err_size)
{
    struct brume_noise_table *t = calloc(1, sizeof *t);
    uint8_t *values = NULL;
    FILE *f = NULL;
    if (t == NULL || !read_size(path, t)) {
        snprintf(err, err_size,
                 "%.200s: noise files are called NAME.WxHxT.raw, W and H "
                 "powers of two from 8 to 256, T from 1 to 64",
                 path);
        goto fail;
    }
    size_t size = (size_t)1
                  << (t->width_log2 + t->height_log2 + t->frames_log2);
    values = malloc(size);
    f = fopen(path, "rb");
    if (f == NULL || values == NULL) {
        snprintf(err, err_size, "%.200s: %s", path, strerror(errno));
        goto fail;
    }
    if (fread(values, 1, size, f) != size || getc(f) != EOF) {
        snprintf(err, err_size, "%.200s: not %zu bytes, as its name says", path,
                 size);
        goto fail;
    }
    fclose(f);
    t->values = values;
    return t;
fail:
    if (f != NULL)
        fclose(f);
    free(values);
    free(t);
    return NULL;
}
