/* SPDX-License-Identifier: MIT */
/*
 * hash_scenes [--grey] [VOLUME=FILE.brume]...: a line per test scene, its name
 * and the CRC-32 of its RGB888 (or L8) pixels; `feature` when the core was
 * compiled without what it needs, `absent` when its volume was not given.
 * Compiled by itself with the core, by every compiler and for every target.
 *
 * hash_scenes --write DIR: the volumes made here as DIR/NAME.brume, for targets
 * that have no heap to make them in.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/volumes.h"

static void print_scene(const struct test_volumes *volumes,
                        const struct test_scene *t, int format)
{
    const struct brume_volume *v = test_volume_of(volumes, t);
    if (v == NULL) {
        printf("%s absent\n", t->name);
        return;
    }
    int error;
    uint8_t *pixels = test_scene_render(t, v, format, &error);
    size_t size = (size_t)t->width * t->height * brume_pixel_bytes(format);
    /* A configuration may allow only small frames or few samples. */
    bool feature = error == BRUME_ERR_FEATURE ||
                   (error == BRUME_ERR_SIZE && t->width > BRUME_MAX_SIZE) ||
                   (error == BRUME_ERR_SAMPLES &&
                    t->light_samples > BRUME_MAX_LOG_SAMPLES);
    if (error)
        printf("%s %s\n", t->name,
               feature ? "feature" : brume_error_text(error));
    else
        printf("%s %08lx\n", t->name, (unsigned long)test_crc32(pixels, size));
    free(pixels);
}

static int write_volumes(const struct test_volumes *volumes, const char *folder)
{
    for (int i = 0; i < volumes->count; i++) {
        const struct test_volume *v = &volumes->item[i];
        char path[512];
        snprintf(path, sizeof path, "%s/%s.brume", folder, v->name);
        FILE *f = fopen(path, "wb");
        if (f == NULL ||
            fwrite(v->asset, 1, v->volume.size, f) != v->volume.size ||
            fclose(f) != 0) {
            perror(path);
            return 1;
        }
    }
    return 0;
}

int main(int argc, char **argv)
{
    struct test_volumes volumes;
    bool writes = argc == 3 && strcmp(argv[1], "--write") == 0;
    int grey = argc > 1 && strcmp(argv[1], "--grey") == 0;
    int status = 0;
    if (test_volumes_make(&volumes, writes ? 1 : argc - grey, argv + grey) != 0)
        return 1;
    for (int i = 0; !writes && i < test_scene_count; i++)
        print_scene(&volumes, &test_scenes[i], grey ? BRUME_L8 : BRUME_RGB888);
    if (writes)
        status = write_volumes(&volumes, argv[2]);
    test_volumes_free(&volumes);
    return status;
}
