/* SPDX-License-Identifier: MIT */
/*
 * hash_scenes [VOLUME=FILE.brume]...: a line per test scene, its name and the
 * CRC-32 of its RGB888 pixels; `feature` when the core was compiled without
 * what it needs, `absent` when its volume was not given. Compiled by itself
 * with the core, by every compiler and for every target.
 */
#include <stdio.h>
#include <stdlib.h>

#include "support/scenes.h"

static void print_scene(const struct test_volumes *volumes,
                        const struct test_scene *t)
{
    const struct brume_volume *v = test_volume_of(volumes, t);
    static struct brume_frame frame;
    struct brume_scene scene;
    if (v == NULL) {
        printf("%s absent\n", t->name);
        return;
    }
    test_scene_fill(&scene, t, v);
    int error = brume_begin_frame(&frame, v, &scene);
    if (error) {
        printf("%s %s\n", t->name,
               error == BRUME_ERR_FEATURE ? "feature"
                                          : brume_error_text(error));
        return;
    }
    size_t stride = (size_t)t->width * 3;
    uint8_t *pixels = malloc(stride * t->height);
    if (pixels == NULL ||
        brume_render_rect(&frame, 0, 0, t->width, t->height, BRUME_RGB888,
                          pixels, stride) != BRUME_OK)
        abort();
    printf("%s %08lx\n", t->name,
           (unsigned long)test_crc32(pixels, stride * t->height));
    free(pixels);
}

int main(int argc, char **argv)
{
    struct test_volumes volumes;
    if (test_volumes_make(&volumes, argc, argv) != 0)
        return 1;
    for (int i = 0; i < test_scene_count; i++)
        print_scene(&volumes, &test_scenes[i]);
    test_volumes_free(&volumes);
    return 0;
}
