/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"
#include "image_codec.h"
#include "numbers.h"
#include "out_set.h"
#include "pool.h"
#include "scene_light.h"
#include "shadow_map.h"

static const char k_help[] =
    "usage: brume shadow VOLUME.brume [--scene FILE] [--set KEY=VALUE]...\n"
    "                    -o MAP.png|.pgm [OPTIONS]\n"
    "\n"
    "Draws the shadow that a baked volume throws: a grey map of the sun's\n"
    "transmittance, 255 where all of it comes through. Of the scene, the sun,\n"
    "light_density_scale, max_density, filter, step and skip are used.\n"
    "\n"
    "  --scene FILE      lines `key = value`, # starts a comment\n"
    "  --set KEY=VALUE   the same, said here; later ones win\n"
    "  --plane Y         height of the map in the world (below the volume by\n"
    "                    the volume's height)\n"
    "  --area X0,Z0,X1,Z1  what the map covers in the world, from its first\n"
    "                    column and row to its last (all of the shadow)\n"
    "  --size WxH        texels, each 1 to 16384 (one to a voxel, at most "
    "1024\n"
    "                    a side)\n"
    "  --heights FILE    a grey picture .png or .pgm, of the map's size: the\n"
    "                    map lies on hills\n"
    "  --rise H          from the plane to what is white in it\n"
    "  --depth FILE.pgm  16 bits: mean distance of density from the texel\n"
    "                    towards the sun, as struct brume_shadow_depth has "
    "it\n"
    "  --front FILE.pgm  the same, where density begins\n"
    "  --threads N       1 to 256 (all processors); same map for any N\n"
    "\n"
    "Prints where the map lies: plane, area and size.\n";

struct options {
    struct scene_settings settings;
    struct shadow_place place;
    bool has_rise;
    const char *volume, *out, *heights, *depth, *front;
    int threads;
};

/* 0 to go on, else the exit status plus 1. */
static int usage(const char *what, const char *arg)
{
    fprintf(stderr, "brume shadow: %s%s; --help tells more\n", what, arg);
    return 3;
}

/// Values ///

static int read_number(const char *name, const char *value, double *out)
{
    char what[64];
    snprintf(what, sizeof what, "%s is a number, not ", name);
    return numbers_read(value, 1, out) ? 0 : usage(what, value);
}

static int read_area(struct shadow_place *p, const char *value)
{
    p->has_area = numbers_read(value, 4, p->area);
    if (!p->has_area)
        return usage("--area is X0,Z0,X1,Z1, four numbers, not ", value);
    return 0;
}

static int read_size(struct shadow_place *p, const char *value)
{
    p->has_size = numbers_size(value, BRUME_MAX_SIZE, p->size);
    if (!p->has_size)
        return usage("--size is WxH, each 1 to 16384, not ", value);
    return 0;
}

static int read_threads(struct options *o, const char *value)
{
    unsigned n;
    if (numbers_whole(value, POOL_MAX, '\0', &n) == NULL)
        return usage("--threads is 1 to 256, not ", value);
    o->threads = (int)n;
    return 0;
}

/// Options ///

/* Where the path of an option goes, NULL for options without one. */
static const char **path_of(struct options *o, const char *name)
{
    return strcmp(name, "-o") == 0          ? &o->out
           : strcmp(name, "--heights") == 0 ? &o->heights
           : strcmp(name, "--depth") == 0   ? &o->depth
           : strcmp(name, "--front") == 0   ? &o->front
                                            : NULL;
}

static bool takes_value(const char *name)
{
    static const char *const k_names[] = {
        "-o",     "--heights", "--depth", "--front", "--scene",  "--set",
        "--area", "--size",    "--plane", "--rise",  "--threads"};
    for (size_t i = 0; i < sizeof k_names / sizeof *k_names; i++)
        if (strcmp(name, k_names[i]) == 0)
            return true;
    return false;
}

static int read_option(struct options *o, const char *name, const char *value)
{
    if (!takes_value(name))
        return usage("unknown option ", name);
    if (value == NULL)
        return usage("no value after ", name);
    const char **path = path_of(o, name);
    if (path != NULL) {
        *path = value;
        return 0;
    }
    if (strcmp(name, "--area") == 0)
        return read_area(&o->place, value);
    if (strcmp(name, "--size") == 0)
        return read_size(&o->place, value);
    if (strcmp(name, "--threads") == 0)
        return read_threads(o, value);
    if (strcmp(name, "--plane") == 0) {
        o->place.has_plane = true;
        return read_number(name, value, &o->place.plane);
    }
    if (strcmp(name, "--rise") == 0) {
        o->has_rise = true;
        return read_number(name, value, &o->place.rise);
    }
    return scene_option("shadow", &o->settings, name, value);
}

static int check_options(const struct options *o)
{
    if (o->volume == NULL)
        return usage("no volume given", "");
    if (o->out == NULL)
        return usage("no -o OUT given", "");
    if ((o->heights != NULL) != o->has_rise)
        return usage("--heights and --rise go together", "");
    if (o->heights != NULL && o->place.has_size)
        return usage("the size of the map is that of --heights, not --size",
                     "");
    return 0;
}

static int read_options(struct options *o, int argc, char **argv)
{
    memset(o, 0, sizeof *o);
    o->threads = pool_processors();
    for (int i = 1; i < argc; i++) {
        int result = 0;
        if (strcmp(argv[i], "--help") == 0) {
            fputs(k_help, stdout);
            return 1;
        }
        if (argv[i][0] == '-' && argv[i][1] != '\0') {
            result = read_option(o, argv[i], argv[i + 1]);
            i++;
        } else if (o->volume == NULL) {
            o->volume = argv[i];
        } else {
            result = usage("unexpected argument ", argv[i]);
        }
        if (result)
            return result;
    }
    return check_options(o);
}

/// Files ///

/* The map, its mean depths and its fronts; those not asked for are empty. */
enum { FILES = 3 };

static int read_heights(struct options *o, char *err, size_t err_size)
{
    struct image image;
    if (image_read(o->heights, &image, err, err_size) != 0)
        return -1;
    size_t n = image_samples(&image);
    uint16_t *heights = NULL;
    if (image.u8 == NULL || image.channels != 1 ||
        image.width > BRUME_MAX_SIZE || image.height > BRUME_MAX_SIZE)
        snprintf(err, err_size,
                 "%s: heights are a grey picture of 8 bits, up to %dx%d",
                 o->heights, BRUME_MAX_SIZE, BRUME_MAX_SIZE);
    else if ((heights = malloc(n * sizeof *heights)) == NULL)
        snprintf(err, err_size, "not enough memory");
    for (size_t i = 0; heights != NULL && i < n; i++)
        heights[i] = (uint16_t)(image.u8[i] * 257);
    o->place.heights = heights;
    o->place.size[0] = (unsigned)image.width;
    o->place.size[1] = (unsigned)image.height;
    o->place.has_size = true;
    image_free(&image);
    return heights == NULL ? -1 : 0;
}

/* One of each pair of depths as binary PGM of 16 bits. */
static int encode_depth(const struct brume_shadow_map *map,
                        const struct brume_shadow_depth *depth, bool front,
                        struct image_file *file)
{
    size_t n = (size_t)map->width * map->height;
    char head[32];
    int start = snprintf(head, sizeof head, "P5\n%d %d\n65535\n", map->width,
                         map->height);
    file->size = (size_t)start + 2 * n;
    file->data = malloc(file->size);
    if (file->data == NULL)
        return -1;
    memcpy(file->data, head, (size_t)start);
    for (size_t i = 0; i < n; i++) {
        unsigned code = front ? depth[i].front : depth[i].mean;
        file->data[(size_t)start + 2 * i] = (uint8_t)(code >> 8);
        file->data[(size_t)start + 2 * i + 1] = (uint8_t)code;
    }
    return 0;
}

/// Command ///

/* The extensions, before any work is done. */
static int check_paths(const struct options *o, enum image_format *format,
                       char *err, size_t err_size)
{
    const char *const depth[] = {o->depth, o->front};
    if (image_format_of(o->out, format, err, err_size) != 0)
        return -1;
    if (*format != IMAGE_PNG && *format != IMAGE_PGM) {
        snprintf(err, err_size, "%s: a map is a .png or a .pgm", o->out);
        return -1;
    }
    for (int i = 0; i < 2; i++) {
        enum image_format pgm;
        if (depth[i] == NULL)
            continue;
        if (image_format_of(depth[i], &pgm, err, err_size) != 0 ||
            pgm != IMAGE_PGM) {
            snprintf(err, err_size, "%s: depths are a .pgm", depth[i]);
            return -1;
        }
    }
    return 0;
}

static int write_map(const struct options *o, enum image_format format,
                     const struct brume_shadow_map *map,
                     const struct image *image,
                     const struct brume_shadow_depth *depth, char *err,
                     size_t err_size)
{
    const char *const path[FILES] = {o->out, o->depth, o->front};
    struct image_file file[FILES] = {{NULL, 0}, {NULL, 0}, {NULL, 0}};
    int status = image_encode(format, image, NULL, &file[0], err, err_size);
    for (int i = 1; i < FILES && status == 0; i++)
        if (path[i] != NULL && encode_depth(map, depth, i == 2, &file[i]) != 0)
            status = image_error(err, err_size, "not enough memory");
    if (status == 0)
        status = out_set_write(FILES, path, file, err, err_size);
    for (int i = 0; i < FILES; i++)
        free(file[i].data);
    return status;
}

/* The exit status: 1 when a file cannot be made, 2 for a bad map. */
static int render_and_write(const struct options *o, enum image_format format,
                            const struct brume_shadow_map *map,
                            const struct volume_file *file,
                            const struct brume_scene *scene, char *err,
                            size_t err_size)
{
    struct image image;
    struct brume_shadow_depth *depth = NULL;
    bool bar = isatty(STDERR_FILENO) != 0;
    int status = 1;
    if (image_new_u8(&image, map->width, map->height, 1, err, err_size) != 0)
        return status;
    if (o->depth != NULL || o->front != NULL)
        depth = malloc(image_samples(&image) * sizeof *depth);
    if (depth == NULL && (o->depth != NULL || o->front != NULL))
        image_error(err, err_size, "not enough memory");
    else if (shadow_map_render(map, &file->volume, scene, o->threads, bar,
                               image.u8, depth, err, err_size) != 0)
        status = 2;
    else if (write_map(o, format, map, &image, depth, err, err_size) == 0)
        status = 0;
    free(depth);
    image_free(&image);
    return status;
}

static int run(struct options *o, char *err, size_t err_size)
{
    struct volume_file file;
    struct scene_light light;
    struct brume_scene scene;
    struct brume_shadow_map map;
    enum image_format format;
    const struct shadow_place *p = &o->place;
    if (check_paths(o, &format, err, err_size) != 0 ||
        volume_file_open(&file, o->volume, err, err_size) != 0)
        return 2;
    int status = 2;
    if ((o->heights == NULL || read_heights(o, err, err_size) == 0) &&
        scene_apply(&o->settings, &file, &scene, &light, err, err_size) == 0 &&
        shadow_map_place(&o->place, &map, &file, &scene, err, err_size) == 0)
        status =
            render_and_write(o, format, &map, &file, &scene, err, err_size);
    if (status == 0)
        printf("plane=%.9g\narea=%.9g,%.9g,%.9g,%.9g\nsize=%ux%u\n", p->plane,
               p->area[0], p->area[1], p->area[2], p->area[3], p->size[0],
               p->size[1]);
    if (status == 0 && (fflush(stdout) != 0 || ferror(stdout))) {
        snprintf(err, err_size, "cannot write the result");
        status = 1;
    }
    volume_file_close(&file);
    free((void *)(uintptr_t)p->heights);
    return status;
}

int shadow_main(int argc, char **argv)
{
    static struct options options;
    char err[512];
    int result = read_options(&options, argc, argv);
    if (result)
        return result - 1;
    result = run(&options, err, sizeof err);
    if (result)
        fprintf(stderr, "brume shadow: %s\n", err);
    return result;
}
