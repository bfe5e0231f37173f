/* SPDX-License-Identifier: MIT */
/*
 * test_golden check|update GOLDEN_DIR OUT_DIR [VOLUME=FILE.brume]...
 *
 * check: every scene's hash against GOLDEN_DIR/hashes.txt, and the small
 * scenes pixel by pixel against GOLDEN_DIR/NAME.png. What is missing fails.
 * A picture that differs is left in OUT_DIR with the difference, enlarged.
 *
 * update: writes all of them anew and prints what changed.
 */
#include <stdlib.h>
#include <string.h>

#include "metrics.h"
#include "image.h"
#include "render.h"
#include "support/volumes.h"
#include "tap.h"

#define HASH_LINES 128

struct hashes {
    int count;
    char name[HASH_LINES][40];
    unsigned long crc[HASH_LINES];
};

static void read_hashes(struct hashes *h, const char *directory)
{
    char path[512];
    h->count = 0;
    snprintf(path, sizeof path, "%s/hashes.txt", directory);
    FILE *f = fopen(path, "r");
    if (f == NULL)
        return;
    while (h->count < HASH_LINES &&
           fscanf(f, "%39s %lx", h->name[h->count], &h->crc[h->count]) == 2)
        h->count++;
    fclose(f);
}

static const unsigned long *find_hash(const struct hashes *h, const char *name)
{
    for (int i = 0; i < h->count; i++)
        if (strcmp(h->name[i], name) == 0)
            return &h->crc[i];
    return NULL;
}

static void render(struct image *image, const struct test_scene *t,
                   const struct brume_volume *v)
{
    struct brume_scene scene;
    struct brume_frame frame;
    char err[200];
    if (t->sequence != NULL) {
        int error;
        if (image_new_u8(image, t->width, t->height, 3, err, sizeof err) != 0)
            abort();
        uint8_t *pixels = test_scene_render(t, v, BRUME_RGB888, &error);
        if (pixels == NULL)
            abort();
        memcpy(image->u8, pixels, image_samples(image));
        free(pixels);
        return;
    }
    test_scene_fill(&scene, t, v);
    if (brume_begin_frame(&frame, v, &scene) != BRUME_OK ||
        image_new_u8(image, t->width, t->height, 3, err, sizeof err) != 0)
        abort();
    render_frame(&frame, BRUME_RGB888, image->u8, (size_t)t->width * 3, 2,
                 false);
}

/// Check ///

/* Leaves the picture and eight times the difference, around grey. */
static void leave_difference(const struct image *now, const struct image *old,
                             const char *name, const char *out)
{
    char path[512], err[200];
    snprintf(path, sizeof path, "%s/%s.actual.png", out, name);
    image_write(path, now, err, sizeof err);
    if (old->u8 == NULL || image_samples(old) != image_samples(now))
        return;
    for (size_t i = 0; i < image_samples(now); i++) {
        int d = 128 + 8 * (now->u8[i] - old->u8[i]);
        old->u8[i] = (uint8_t)(d < 0 ? 0 : d > 255 ? 255 : d);
    }
    snprintf(path, sizeof path, "%s/%s.difference.png", out, name);
    image_write(path, old, err, sizeof err);
}

static void check_picture(const struct image *now, const char *name,
                          const char *golden, const char *out)
{
    char path[512], err[300] = "";
    struct image old = {0};
    struct metrics_error r = {0};
    snprintf(path, sizeof path, "%s/%s.png", golden, name);
    bool good = image_read(path, &old, err, sizeof err) == 0 &&
                metrics_error(&old, now, &r, err, sizeof err) == 0;
    if (!tap_check(good && r.max == 0, "%s: picture (max %g) %s", name, r.max,
                   err))
        leave_difference(now, &old, name, out);
    image_free(&old);
}

static void check_scene(const struct test_scene *t,
                        const struct brume_volume *v, const struct hashes *h,
                        const char *golden, const char *out)
{
    const unsigned long *wanted = find_hash(h, t->name);
    struct image image;
    if (wanted == NULL) {
        tap_check(0, "%s: no golden hash in %s/hashes.txt", t->name, golden);
        return;
    }
    if (v == NULL) {
        tap_skip("%s: volume %s is not here", t->name, t->volume);
        return;
    }
    render(&image, t, v);
    unsigned long crc = test_crc32(image.u8, image_samples(&image));
    tap_check(crc == *wanted, "%s: hash %08lx, golden %08lx", t->name, crc,
              *wanted);
    if (t->small)
        check_picture(&image, t->name, golden, out);
    image_free(&image);
}

/// Update ///

static int update(const struct test_volumes *volumes, const char *golden)
{
    static struct hashes old;
    char path[512], err[300];
    read_hashes(&old, golden);
    snprintf(path, sizeof path, "%s/hashes.txt", golden);
    FILE *f = fopen(path, "w");
    if (f == NULL) {
        perror(path);
        return 1;
    }
    int failed = 0;
    for (int i = 0; i < test_scene_count; i++) {
        const struct test_scene *t = &test_scenes[i];
        const struct brume_volume *v = test_volume_of(volumes, t);
        const unsigned long *before = find_hash(&old, t->name);
        struct image image;
        if (v == NULL) {
            printf("%s: volume %s is not here, kept as it was\n", t->name,
                   t->volume);
            if (before)
                fprintf(f, "%s %08lx\n", t->name, *before);
            continue;
        }
        render(&image, t, v);
        unsigned long crc = test_crc32(image.u8, image_samples(&image));
        fprintf(f, "%s %08lx\n", t->name, crc);
        if (before == NULL)
            printf("%s: new, %08lx\n", t->name, crc);
        else if (*before != crc)
            printf("%s: %08lx -> %08lx\n", t->name, *before, crc);
        snprintf(path, sizeof path, "%s/%s.png", golden, t->name);
        if (t->small && image_write(path, &image, err, sizeof err) != 0) {
            fprintf(stderr, "%s\n", err);
            failed = 1;
        }
        image_free(&image);
    }
    return fclose(f) == 0 ? failed : 1;
}

int main(int argc, char **argv)
{
    static struct hashes h;
    struct test_volumes volumes;
    if (argc < 4 ||
        (strcmp(argv[1], "check") != 0 && strcmp(argv[1], "update") != 0)) {
        fputs("usage: test_golden check|update GOLDEN_DIR OUT_DIR "
              "[VOLUME=FILE.brume]...\n",
              stderr);
        return 2;
    }
    if (test_volumes_make(&volumes, argc - 3, argv + 3) != 0)
        return 1;
    if (strcmp(argv[1], "update") == 0) {
        int result = update(&volumes, argv[2]);
        test_volumes_free(&volumes);
        return result;
    }
    read_hashes(&h, argv[2]);
    for (int i = 0; i < test_scene_count; i++)
        check_scene(&test_scenes[i], test_volume_of(&volumes, &test_scenes[i]),
                    &h, argv[2], argv[3]);
    test_volumes_free(&volumes);
    return tap_done();
}
