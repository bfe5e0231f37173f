/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "scene_light.h"
#include "volume_file.h"

static const char k_help[] =
    "usage: brume info VOLUME.brume [--scene]\n"
    "\n"
    "Checks a baked volume and prints what it holds, one name=value a line.\n"
    "--scene prints the scene that it is rendered with by default instead,\n"
    "as a scene file to start from.\n";

static double value_of(struct brume_number n)
{
    return ldexp((double)n.m, n.e);
}

static unsigned occupied_cells(const struct brume_volume *v, unsigned cells)
{
    const uint8_t *p = (const uint8_t *)v->cells;
    unsigned n = 0;
    for (unsigned i = 0; i < cells; i++)
        n += !(p[4 * i + 3] & 0x80);
    return n;
}

static void print_info(const struct volume_file *file)
{
    static const char *const k_format[] = {"", "u8", "u8r", "u4r"};
    const struct brume_volume *v = &file->volume;
    unsigned cells =
        (unsigned)v->cell_count[0] * v->cell_count[1] * v->cell_count[2];
    double first[3], last[3], low[3], high[3];
    for (int i = 0; i < 3; i++) {
        first[i] = v->box_min[i];
        last[i] = v->box_max[i];
    }
    volume_file_to_world(file, first, low);
    volume_file_to_world(file, last, high);
    printf("name=%s\n", file->name);
    printf("format=%s\n", k_format[v->format]);
    printf("apron=%s\n", v->side == 9 ? "yes" : "no");
    printf("bytes=%lu\n", (unsigned long)v->size);
    printf("cells=%dx%dx%d\n", v->cell_count[0], v->cell_count[1],
           v->cell_count[2]);
    printf("occupied_cells=%u\n", occupied_cells(v, cells));
    printf("bricks=%lu\n", (unsigned long)v->bricks);
    printf("pool_bytes=%lu\n", (unsigned long)v->bricks * v->brick_bytes);
    printf("voxels=%lu\n", (unsigned long)v->voxels);
    printf("box_voxels=%dx%dx%d\n", v->box_max[0] - v->box_min[0] + 1,
           v->box_max[1] - v->box_min[1] + 1,
           v->box_max[2] - v->box_min[2] + 1);
    printf("box_world=%.6g,%.6g,%.6g to %.6g,%.6g,%.6g\n", low[0], low[1],
           low[2], high[0], high[1], high[2]);
    printf("origin=%ld,%ld,%ld\n", (long)file->origin[0], (long)file->origin[1],
           (long)file->origin[2]);
    printf("voxel_size=%.9g\n", file->voxel_size);
    printf("density_max=%.9g\n", value_of(v->density_max));
    printf("density_mean=%.9g\n", value_of(v->density_mean));
    printf("mips=%s\n", v->mips != NULL ? "yes" : "no");
    printf("sun_cache=%d\n", v->sun_cache != NULL ? 1 << v->sun_cache[0] : 0);
    printf("sky_visibility=%s\n", v->sky != NULL ? "yes" : "no");
    printf("emission=%s\n", v->emission != NULL ? "yes" : "no");
    if (v->emission != NULL)
        printf("emission_max=%.9g\n", value_of(v->emission_max));
}

int info_main(int argc, char **argv)
{
    char err[512];
    const char *path = NULL;
    bool scene_wanted = false;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--help") == 0) {
            fputs(k_help, stdout);
            return 0;
        }
        if (strcmp(argv[i], "--scene") == 0) {
            scene_wanted = true;
        } else if (argv[i][0] == '-' || path != NULL) {
            fprintf(stderr, "brume info: unexpected '%s'\n", argv[i]);
            return 2;
        } else {
            path = argv[i];
        }
    }
    if (path == NULL) {
        fputs("brume info: no volume given; --help tells more\n", stderr);
        return 2;
    }
    struct volume_file file;
    static const struct scene_settings k_none;
    struct scene_light light;
    struct brume_scene scene;
    if (volume_file_open(&file, path, err, sizeof err) != 0 ||
        scene_apply(&k_none, &file, &scene, &light, err, sizeof err) != 0) {
        fprintf(stderr, "brume info: %s\n", err);
        return 2;
    }
    if (scene_wanted)
        scene_print(stdout, &scene, &light, &file);
    else
        print_info(&file);
    volume_file_close(&file);
    if (fflush(stdout) != 0 || ferror(stdout)) {
        fputs("brume info: cannot write the result\n", stderr);
        return 1;
    }
    return 0;
}
