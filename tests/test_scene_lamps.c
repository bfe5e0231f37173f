/* SPDX-License-Identifier: MIT */
/*
 * Lamps of scenes, from the lines of a file to the core's, in a volume that is
 * scaled and moved; and every refusal with its file and line.
 */
#include "tap.h"

#include "scene_lamps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char file[64];
static char err[512];
static struct brume_lamp lamps[BRUME_MAX_LAMPS];

/* Two world units a voxel; pool voxel (0,0,0) at (10,20,30). */
static const struct volume_file k_volume = {
    .world_from_index = {2, 0, 0, 10, 0, 2, 0, 20, 0, 0, 2, 30},
    .voxel_size = 2};

/* How many lamps a text is, or -1. */
static int lamps_of(const char *text)
{
    double value[SCENE_VALUES] = {0};
    FILE *f = fopen(file, "w");
    if (f == NULL || fputs(text, f) == EOF || fclose(f) != 0) {
        perror(file);
        exit(1);
    }
    memset(err, 0, sizeof err);
    if (scene_lamps_read(file, value, "here", err, sizeof err) != 0)
        return -1;
    return scene_lamps_make(value, &k_volume, lamps, err, sizeof err);
}

static bool is_near(int32_t is, double want, double unit)
{
    return fabs(is - want * unit) <= 1;
}

static void test_taken(void)
{
    int n = lamps_of("# two\n10,20,30 8 2 0.5\n\n"
                     "12,24,20 100 3 1,2,256 shadow 64 spot 0,-3,0 60 90\n");
    const struct brume_lamp *a = &lamps[0], *b = &lamps[1];
    tap_check(n == 2, "two lamps: %d %s", n, err);
    tap_check(a->position[0] == 0 && a->position[1] == 0 &&
                  a->position[2] == 0 && a->radius == 4 * 65536 &&
                  a->size == 65536 && a->colour[0] == 32768 &&
                  a->colour[2] == 32768 && a->cos_outer == -(1 << 30) &&
                  a->shadow_samples == 0,
              "a point light, in voxels");
    tap_check(is_near(b->position[0], 1, 65536) &&
                  is_near(b->position[1], 2, 65536) &&
                  is_near(b->position[2], -5, 65536) &&
                  b->colour[2] == 256 * 65536 && b->shadow_samples == 64,
              "another, beside the pool");
    tap_check(b->direction[0] == 0 && b->direction[1] < 0 &&
                  is_near(b->cos_outer, 0, 1 << 30) &&
                  is_near(b->cos_inner, 0.5, 1 << 30),
              "a spot's direction and angles");
    double none[SCENE_VALUES] = {5};
    tap_check(scene_lamps_read("none", none, "here", err, sizeof err) == 0 &&
                  scene_lamps_make(none, &k_volume, lamps, err, sizeof err) ==
                      0,
              "none");
}

static void test_refused(void)
{
    static const struct {
        const char *text, *says;
    } k_bad[] = {
        {"1,2 3 1 1", ":1: position is three numbers x,y,z, not '1,2'"},
        {"\n1,2,3", ":2: radius is a number, not the line's end"},
        {"1,2,3 9 1 1,2", ":1: colour is three numbers x,y,z, not '1,2'"},
        {"1,2,3 9 1 257", ":1: colour is 257, outside 0 to 256"},
        {"1,2,3 1.9 1 1", ":1: radius is 0.95 voxels, outside 1 to 16384"},
        {"1,2,3 9 9.1 1", ":1: size is 4.55 voxels, outside 0.0625 to 4.5"},
        {"1,2,3 9 1 1 spt",
         ":1: after the colour is spot or shadow, not 'spt'"},
        {"1,2,3 9 1 1 spot 0,0,0 1 2", ":1: direction has a length, not "},
        {"1,2,3 9 1 1 spot 0,1,0 5 4", ":1: outer angle is not below the "},
        {"1,2,3 9 1 1 spot 0,1,0 5 180", ":1: outer angle is 180, outside 0 "},
        {"1,2,3 9 1 1 spot 0,1,0 1 2 spot 0,1,0 1 2", ":1: spot is said once"},
        {"1,2,3 9 1 1 shadow 1.5", ":1: shadow is a whole number, not '1.5'"},
        {"1,2,3 9 1 1 shadow 65", ":1: shadow is 65, outside 0 to 64"},
        {"1,2,3e6 9 1 1", ":1: position is 1499985 voxels from the volume's"},
    };
    for (size_t i = 0; i < sizeof k_bad / sizeof *k_bad; i++) {
        int n = lamps_of(k_bad[i].text);
        const char *at = strstr(err, file);
        bool says = at != NULL && strncmp(at + strlen(file), k_bad[i].says,
                                          strlen(k_bad[i].says)) == 0;
        tap_check(n == -1 && says, "refused: %s%s", k_bad[i].says,
                  says ? "" : err);
    }
}

static void test_limit(void)
{
    static char text[BRUME_MAX_LAMPS * 12 + 100];
    for (int i = 0; i < BRUME_MAX_LAMPS; i++)
        strcat(text, "1,2,3 9 1 1\n");
    int n = lamps_of(text);
    tap_check(n == BRUME_MAX_LAMPS, "as many lamps as may be: %s", err);
    strcat(text, "1,2,3 9 1 1\n");
    tap_check(lamps_of(text) == -1 && strstr(err, "more than 64 lamps"),
              "one more: %s", err);
}

int main(void)
{
    const char *tmp = getenv("TMPDIR");
    snprintf(file, sizeof file, "%.40s/brumeXXXXXX", tmp ? tmp : "/tmp");
    int handle = mkstemp(file);
    if (handle < 0) {
        perror(file);
        return 1;
    }
    close(handle);
    test_taken();
    test_refused();
    test_limit();
    unlink(file);
    return tap_done();
}
