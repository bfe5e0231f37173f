/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "numbers.h"
#include "out_set.h"
#include "scene_light.h"
#include "srgb.h"
#include "surface.h"

static const char k_help[] =
    "usage: brume surface VOLUME.brume [--scene FILE] [--set KEY=VALUE]...\n"
    "                     THINGS [OPTIONS] OUTPUTS\n"
    "\n"
    "Solid things in the volume's world, as the scene's camera and sun see\n"
    "them, for `brume render`: how far they are, how they look, what they\n"
    "shade. Of the scene, size, camera, sun, sky and the light's colours are\n"
    "used.\n"
    "\n"
    "Things:\n"
    "  --albedo A        of those named after it: a number or R,G,B (0.2)\n"
    "  --mesh FILE.obj   Wavefront OBJ: its lines v and f; may be repeated\n"
    "  --area X0,Z0,X1,Z1  a level ground in the world\n"
    "  --plane Y         its height (0)\n"
    "  --heights FILE    hills on it: a grey .pgm or .png; its first row is "
    "at\n"
    "                    Z0, its first column at X0\n"
    "  --rise H          from the plane to what is white in it\n"
    "\n"
    "Light:\n"
    "  --sky A           radiance of the sky on things: a number or R,G,B\n"
    "                    (the scene's ambient light from above, else 0.1)\n"
    "  --shadow MAP      the volume's shadow, as `brume shadow` draws it on "
    "the\n"
    "                    --plane of the level ground; things above it get it, "
    "too\n"
    "  --shadow-area X0,Z0,X1,Z1  where it says that the map is (--area)\n"
    "  --samples N       rays across a pixel and down, of --colour: 1 to 16 "
    "(1)\n"
    "\n"
    "Outputs:\n"
    "  --depth FILE      .pgm or .png of 16 bits: distances from the eye, as\n"
    "                    struct brume_surface has them; 65535: nothing\n"
    "  --colour FILE     .png or .ppm, sRGB; .pfm: linear, not clipped; with\n"
    "                    the scene's sky behind\n"
    "  --sun-map FILE.pgm  16 bits: what the sun sees, and where that is\n"
    "  --size WxH        of the sun map, each 1 to 16384 (1024x1024)\n"
    "  --cover X0,Y0,Z0,X1,Y1,Z1  the box of the world that the sun map\n"
    "                    covers (all things and the volume)\n"
    "  --bias B          of the sun map, in the world (a texel's diagonal)\n"
    "\n"
    "  --threads N       1 to 256 (all processors); same files for any N\n"
    "\n"
    "Prints the number of triangles.\n";

enum { DEPTH, COLOUR, SUN_MAP, OUTPUTS };

struct options {
    struct scene_settings settings;
    struct mesh_ground ground;
    const char *volume, *heights, *shadow;
    const char *out[OUTPUTS];
    const char *mesh[SURFACE_THINGS]; /* of a thing; NULL: the ground */
    double albedo[SURFACE_THINGS][3];
    int things;
    double next_albedo[3]; /* of the next thing */
    double sky[3], cover[6], shadow_area[4], bias;
    bool has_shadow_area, has_area, has_plane, has_rise, has_sky, has_cover;
    unsigned size[2], samples, threads;
};

/* 0 to go on, else the exit status plus 1. */
static int usage(const char *what, const char *arg)
{
    fprintf(stderr, "brume surface: %s%s; --help tells more\n", what, arg);
    return 3;
}

/// Values ///

/* A or R,G,B, none below 0 or above `most`. */
static bool read_colour(const char *text, double most, double out[3])
{
    if (numbers_read(text, 1, out))
        out[1] = out[2] = out[0];
    else if (!numbers_read(text, 3, out))
        return false;
    for (int c = 0; c < 3; c++)
        if (!(out[c] >= 0 && out[c] <= most))
            return false;
    return true;
}

static int read_albedo(struct options *o, const char *value)
{
    return read_colour(value, 1, o->next_albedo)
               ? 0
               : usage("--albedo is A or R,G,B, 0 to 1, not ", value);
}

static int read_sky(struct options *o, const char *value)
{
    o->has_sky = read_colour(value, 16, o->sky);
    return o->has_sky ? 0 : usage("--sky is A or R,G,B, 0 to 16, not ", value);
}

static int add_thing(struct options *o, const char *path)
{
    if (o->things == SURFACE_THINGS)
        return usage("more than 32 things: no room for ", path ? path : "");
    o->mesh[o->things] = path;
    memcpy(o->albedo[o->things++], o->next_albedo, sizeof o->next_albedo);
    return 0;
}

static int read_area(struct options *o, const char *value)
{
    if (o->has_area)
        return usage("--area is said twice: ", value);
    o->has_area = numbers_read(value, 4, o->ground.area);
    if (!o->has_area)
        return usage("--area is X0,Z0,X1,Z1, four numbers, not ", value);
    return add_thing(o, NULL);
}

static int read_cover(struct options *o, const char *value)
{
    o->has_cover = numbers_read(value, 6, o->cover);
    return o->has_cover ? 0
                        : usage("--cover is X0,Y0,Z0,X1,Y1,Z1, not ", value);
}

static int read_shadow_area(struct options *o, const char *value)
{
    const double *a = o->shadow_area;
    o->has_shadow_area =
        numbers_read(value, 4, o->shadow_area) && a[0] != a[2] && a[1] != a[3];
    return o->has_shadow_area
               ? 0
               : usage("--shadow-area is X0,Z0,X1,Z1, with an area, not ",
                       value);
}

static int read_size(struct options *o, const char *value)
{
    return numbers_size(value, BRUME_MAX_SIZE, o->size)
               ? 0
               : usage("--size is WxH, each 1 to 16384, not ", value);
}

static int read_number(struct options *o, const char *name, const char *value)
{
    char what[64];
    bool plane = strcmp(name, "--plane") == 0, rise = name[2] == 'r';
    double *out = plane ? &o->ground.plane : rise ? &o->ground.rise : &o->bias;
    snprintf(what, sizeof what, "%s is a number, not ", name);
    if (!numbers_read(value, 1, out))
        return usage(what, value);
    o->has_plane = o->has_plane || plane;
    o->has_rise = o->has_rise || rise;
    if (!plane && !rise && !(o->bias >= 0))
        return usage("--bias is 0 or more, not ", value);
    return 0;
}

static int read_count(const char *name, unsigned long most, const char *value,
                      unsigned *out)
{
    char what[64];
    snprintf(what, sizeof what, "%s is 1 to %lu, not ", name, most);
    return numbers_whole(value, most, '\0', out) ? 0 : usage(what, value);
}

/// Options ///

/* Where the path of an option goes, NULL for options without one. */
static const char **path_of(struct options *o, const char *name)
{
    return strcmp(name, "--depth") == 0     ? &o->out[DEPTH]
           : strcmp(name, "--colour") == 0  ? &o->out[COLOUR]
           : strcmp(name, "--sun-map") == 0 ? &o->out[SUN_MAP]
           : strcmp(name, "--heights") == 0 ? &o->heights
           : strcmp(name, "--shadow") == 0  ? &o->shadow
                                            : NULL;
}

static bool takes_value(const char *name)
{
    static const char *const k_names[] = {
        "--depth", "--colour",  "--sun-map", "--heights",    "--shadow",
        "--scene", "--set",     "--mesh",    "--albedo",     "--area",
        "--plane", "--rise",    "--bias",    "--sky",        "--cover",
        "--size",  "--samples", "--threads", "--shadow-area"};
    for (size_t i = 0; i < sizeof k_names / sizeof *k_names; i++)
        if (strcmp(name, k_names[i]) == 0)
            return true;
    return false;
}

static int read_value(struct options *o, const char *name, const char *value)
{
    const char **path = path_of(o, name);
    if (path != NULL) {
        *path = value;
        return 0;
    }
    if (strcmp(name, "--mesh") == 0)
        return add_thing(o, value);
    if (strcmp(name, "--albedo") == 0)
        return read_albedo(o, value);
    if (strcmp(name, "--area") == 0)
        return read_area(o, value);
    if (strcmp(name, "--shadow-area") == 0)
        return read_shadow_area(o, value);
    if (strcmp(name, "--sky") == 0)
        return read_sky(o, value);
    if (strcmp(name, "--cover") == 0)
        return read_cover(o, value);
    if (strcmp(name, "--size") == 0)
        return read_size(o, value);
    if (strcmp(name, "--samples") == 0)
        return read_count(name, SURFACE_SAMPLES, value, &o->samples);
    if (strcmp(name, "--threads") == 0)
        return read_count(name, POOL_MAX, value, &o->threads);
    if (strcmp(name, "--scene") == 0 || strcmp(name, "--set") == 0)
        return scene_option("surface", &o->settings, name, value);
    return read_number(o, name, value);
}

static int check_options(const struct options *o)
{
    if (o->volume == NULL)
        return usage("no volume given", "");
    if (o->things == 0)
        return usage("no things given: --mesh or --area", "");
    if (!o->out[DEPTH] && !o->out[COLOUR] && !o->out[SUN_MAP])
        return usage("no output given: --depth, --colour or --sun-map", "");
    for (int i = 0; i < OUTPUTS; i++)
        for (int j = 0; j < i; j++)
            if (o->out[i] && o->out[j] && strcmp(o->out[i], o->out[j]) == 0)
                return usage("two outputs in one file: ", o->out[i]);
    if ((o->heights != NULL) != o->has_rise)
        return usage("--heights and --rise go together", "");
    if (!o->has_area && (o->has_plane || o->heights || o->shadow))
        return usage("--plane, --heights and --shadow are of a ground: say "
                     "its --area",
                     "");
    if (o->has_shadow_area && o->shadow == NULL)
        return usage("--shadow-area without --shadow", "");
    if (o->shadow != NULL && o->heights != NULL)
        return usage("--shadow lies on a level ground, not on --heights", "");
    return 0;
}

static int read_options(struct options *o, int argc, char **argv)
{
    memset(o, 0, sizeof *o);
    o->threads = (unsigned)pool_processors();
    o->samples = 1;
    o->size[0] = o->size[1] = 1024;
    o->bias = -1;
    for (int c = 0; c < 3; c++)
        o->next_albedo[c] = 0.2;
    for (int i = 1; i < argc; i++) {
        const char *arg = argv[i];
        int result = 0;
        if (strcmp(arg, "--help") == 0) {
            fputs(k_help, stdout);
            return 1;
        }
        if (arg[0] == '-' && arg[1] != '\0') {
            const char *value = argv[++i];
            result = !takes_value(arg) ? usage("unknown option ", arg)
                     : value == NULL   ? usage("no value after ", arg)
                                       : read_value(o, arg, value);
        } else if (o->volume == NULL) {
            o->volume = arg;
        } else {
            result = usage("unexpected argument ", arg);
        }
        if (result)
            return result;
    }
    return check_options(o);
}

/// Input ///

/* All that a run holds; all zero at first. */
struct run {
    struct options *o;
    enum image_format format[OUTPUTS];
    struct volume_file file;
    struct scene_light light;
    struct brume_scene scene;
    struct grey16 heights;
    struct image shadow;
    struct mesh mesh;
    struct surface surface;
    struct pool *pool;
    struct image_file out[OUTPUTS];
};

/* The extensions, before any work is done. */
static int check_paths(struct run *r, char *err, size_t err_size)
{
    static const struct {
        bool format[4]; /* by enum image_format */
        const char *what;
    } k_kind[OUTPUTS] = {
        {{[IMAGE_PNG] = true, [IMAGE_PGM] = true},
         "depths are a .pgm or a .png"},
        {{[IMAGE_PNG] = true, [IMAGE_PPM] = true, [IMAGE_PFM] = true},
         "a picture is a .png, a .ppm or a .pfm"},
        {{[IMAGE_PGM] = true}, "a sun map is a .pgm"}};
    for (int i = 0; i < OUTPUTS; i++) {
        const char *path = r->o->out[i];
        if (path == NULL)
            continue;
        if (image_format_of(path, &r->format[i], err, err_size) != 0)
            return -1;
        if (!k_kind[i].format[r->format[i]])
            return image_error(err, err_size, "%s: %s", path, k_kind[i].what);
    }
    return 0;
}

static int read_things(struct run *r, char *err, size_t err_size)
{
    struct options *o = r->o;
    if (o->heights != NULL) {
        if (grey16_read(o->heights, &r->heights, err, err_size) != 0)
            return -1;
        o->ground.heights = &r->heights;
    }
    for (int i = 0; i < o->things; i++) {
        const char *path = o->mesh[i];
        uint8_t thing = (uint8_t)i;
        memcpy(r->surface.albedo[i], o->albedo[i], sizeof o->albedo[i]);
        if (path == NULL ? mesh_add_ground(&r->mesh, &o->ground, &r->file,
                                           thing, err, err_size) != 0
                         : mesh_read_obj(&r->mesh, path, &r->file, thing, err,
                                         err_size) != 0)
            return -1;
    }
    return 0;
}

static int read_shadow(struct run *r, char *err, size_t err_size)
{
    struct surface_shade *shade = &r->surface.shade;
    const char *path = r->o->shadow;
    if (path == NULL)
        return 0;
    if (image_read(path, &r->shadow, err, err_size) != 0)
        return -1;
    if (r->shadow.u8 == NULL || r->shadow.channels != 1)
        return image_error(err, err_size,
                           "%s: a shadow is a grey picture of 8 bits", path);
    shade->map = &r->shadow;
    shade->plane = r->o->ground.plane;
    memcpy(shade->area,
           r->o->has_shadow_area ? r->o->shadow_area : r->o->ground.area,
           sizeof shade->area);
    return 0;
}

/// Output ///

static int make_depth(struct run *r, char *err, size_t err_size)
{
    struct grey16 depth;
    int status = surface_depth(&r->surface, r->pool, &depth, err, err_size);
    if (status == 0)
        status = grey16_encode(r->format[DEPTH], &depth, &r->out[DEPTH], err,
                               err_size);
    grey16_free(&depth);
    return status;
}

static int make_colour(struct run *r, char *err, size_t err_size)
{
    struct image linear, codes;
    const struct image *image = &linear;
    memset(&codes, 0, sizeof codes);
    int status = surface_colour(&r->surface, r->pool, r->o->samples, &linear,
                                err, err_size);
    if (status == 0 && r->format[COLOUR] != IMAGE_PFM) {
        status =
            image_new_u8(&codes, linear.width, linear.height, 3, err, err_size);
        if (status == 0)
            srgb_encode(linear.f32, codes.u8, image_samples(&linear));
        image = &codes;
    }
    if (status == 0)
        status = image_encode(r->format[COLOUR], image, r->pool,
                              &r->out[COLOUR], err, err_size);
    image_free(&linear);
    image_free(&codes);
    return status;
}

static int make_sun_map(struct run *r, char *err, size_t err_size)
{
    struct sun_map_file map;
    struct brume_sun_map core;
    const struct options *o = r->o;
    int status = surface_sun_map(&r->surface, r->pool, o->size,
                                 o->has_cover ? o->cover : NULL, o->bias, &map,
                                 err, err_size);
    /* One that the core could not take is no use. */
    if (status == 0)
        status = sun_map_file_apply(&map, &r->file, &core, err, err_size);
    if (status == 0)
        status = sun_map_file_encode(&map, &r->out[SUN_MAP], err, err_size);
    sun_map_file_free(&map);
    return status;
}

/* The exit status: 1 when a file cannot be made. */
static int make_and_write(struct run *r, char *err, size_t err_size)
{
    const struct options *o = r->o;
    r->surface.mesh = &r->mesh;
    r->surface.file = &r->file;
    struct caster *caster = caster_new(&r->mesh);
    r->surface.caster = caster;
    r->pool = o->threads > 1 ? pool_new((int)o->threads) : NULL;
    int status = 0;
    if (caster == NULL)
        status = image_error(err, err_size, "not enough memory");
    if (status == 0)
        status = surface_begin(&r->surface, &r->scene,
                               o->has_sky ? o->sky : NULL, err, err_size);
    if (status == 0 && o->out[DEPTH] != NULL)
        status = make_depth(r, err, err_size);
    if (status == 0 && o->out[COLOUR] != NULL)
        status = make_colour(r, err, err_size);
    if (status == 0 && o->out[SUN_MAP] != NULL)
        status = make_sun_map(r, err, err_size);
    pool_free(r->pool);
    caster_free(caster);
    if (status != 0)
        return 2;
    return out_set_write(OUTPUTS, o->out, r->out, err, err_size) != 0;
}

static int run_all(struct run *r, char *err, size_t err_size)
{
    int status = 2;
    if (check_paths(r, err, err_size) != 0 ||
        volume_file_open(&r->file, r->o->volume, err, err_size) != 0)
        return 2;
    if (scene_apply(&r->o->settings, &r->file, &r->scene, &r->light, err,
                    err_size) == 0 &&
        read_things(r, err, err_size) == 0 &&
        read_shadow(r, err, err_size) == 0)
        status = make_and_write(r, err, err_size);
    if (status == 0)
        printf("triangles=%lu\n", (unsigned long)r->mesh.triangles);
    if (status == 0 && (fflush(stdout) != 0 || ferror(stdout))) {
        snprintf(err, err_size, "cannot write the result");
        status = 1;
    }
    return status;
}

int surface_main(int argc, char **argv)
{
    static struct options options;
    static struct run run;
    char err[512];
    int result = read_options(&options, argc, argv);
    if (result)
        return result - 1;
    run.o = &options;
    result = run_all(&run, err, sizeof err);
    if (result)
        fprintf(stderr, "brume surface: %s\n", err);
    for (int i = 0; i < OUTPUTS; i++)
        free(run.out[i].data);
    grey16_free(&run.heights);
    image_free(&run.shadow);
    mesh_free(&run.mesh);
    volume_file_close(&run.file);
    return result;
}
