/* SPDX-License-Identifier: MIT */
/*
 * The volumes of the test scenes, on a machine with files and a heap: some made
 * here, others read from baked files.
 */
#ifndef BRUME_TESTS_VOLUMES_H
#define BRUME_TESTS_VOLUMES_H

#include "scenes.h"

/* They live until test_volumes_free. */
struct test_volume {
    char name[24];
    uint8_t *asset;
    struct brume_volume volume;
};
#define TEST_VOLUMES 24
struct test_volumes {
    int count;
    struct test_volume item[TEST_VOLUMES];
};

/* Makes the synthetic volumes, and opens `name=path` arguments. Prints what
 * is wrong and returns -1 when one of them cannot be had. */
int test_volumes_make(struct test_volumes *volumes, int argc, char **argv);
void test_volumes_free(struct test_volumes *volumes);

/* The volume of a scene, or NULL. */
const struct brume_volume *test_volume_of(const struct test_volumes *volumes,
                                          const struct test_scene *scene);

/* The pixels of the last of a scene's frames, by the core's own functions and
 * in a malloc of width * height * bytes; or NULL and *error. */
uint8_t *test_scene_render(const struct test_scene *scene,
                           const struct brume_volume *volume, int pixel_format,
                           int *error);

#endif
