/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"
#include "deflate.h"
#include "image.h"
#include "render.h"
#include "scene_file.h"

static const char k_help[] =
    "usage: brume render VOLUME.brume [--scene FILE] [--set KEY=VALUE]...\n"
    "                    -o OUT.png|.ppm|.pgm|.pfm [--threads N] [--hash]\n"
    "\n"
    "Draws a baked volume. Without a scene the whole volume is shown.\n"
    "\n"
    "  --scene FILE      lines `key = value`, # starts a comment\n"
    "  --set KEY=VALUE   the same, said here; later ones win\n"
    "  --threads N       1 to 256 (all processors); same picture for any N\n"
    "  --hash            print the CRC-32 of the pixels, rows from the top\n"
    "  -o OUT            .pfm holds linear radiance, whatever `output` says\n"
    "\n"
    "Keys, with ranges and (defaults):\n";

struct options {
    const char *volume, *out;
    struct scene_settings settings;
    int threads;
    bool hash;
};

/* 0 to go on, else the exit status plus 1. */
static int usage(const char *what, const char *arg)
{
    fprintf(stderr, "brume render: %s%s; --help tells more\n", what, arg);
    return 3;
}

static bool takes_value(const char *name)
{
    static const char *const k_names[] = {"-o", "--scene", "--set",
                                          "--threads"};
    for (size_t i = 0; i < sizeof k_names / sizeof *k_names; i++)
        if (strcmp(name, k_names[i]) == 0)
            return true;
    return false;
}

static int read_option(struct options *o, const char *name, const char *value)
{
    char err[512], *end;
    int bad = 0;
    if (!takes_value(name))
        return usage("unknown option ", name);
    if (value == NULL)
        return usage("no value after ", name);
    if (strcmp(name, "-o") == 0) {
        o->out = value;
    } else if (strcmp(name, "--scene") == 0) {
        bad = scene_read(&o->settings, value, err, sizeof err);
    } else if (strcmp(name, "--set") == 0) {
        bad = scene_set(&o->settings, value, "--set", err, sizeof err);
    } else {
        long n = strtol(value, &end, 10);
        if (*value == '\0' || *end != '\0' || n < 1 || n > 256)
            return usage("--threads is 1 to 256, not ", value);
        o->threads = (int)n;
    }
    if (bad)
        fprintf(stderr, "brume render: %s\n", err);
    return bad ? 3 : 0;
}

static int read_options(struct options *o, int argc, char **argv)
{
    memset(o, 0, sizeof *o);
    o->threads = render_processors();
    for (int i = 1; i < argc; i++) {
        int result = 0;
        if (strcmp(argv[i], "--help") == 0) {
            fputs(k_help, stdout);
            scene_print_keys(stdout);
            return 1;
        }
        if (strcmp(argv[i], "--hash") == 0) {
            o->hash = true;
        } else if (argv[i][0] == '-' && argv[i][1] != '\0') {
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
    if (o->volume == NULL)
        return usage("no volume given", "");
    if (o->out == NULL && !o->hash)
        return usage("no -o OUT given", "");
    return 0;
}

/* Bytes of a 16-bit picture to floats, in which 65535 is 1. */
static void widen(const uint16_t *from, float *to, size_t n)
{
    for (size_t i = 0; i < n; i++)
        to[i] = (float)(from[i] / 65535.0);
}

/* Renders into an 8-bit picture, or through 16 bits into a float one. */
static int draw(const struct brume_frame *frame, bool is_float, bool grey,
                int threads, struct image *image, char *err, size_t err_size)
{
    bool progress = isatty(STDERR_FILENO) != 0;
    int w = frame->width, h = frame->height, channels = grey ? 1 : 3;
    if (!is_float) {
        if (image_new_u8(image, w, h, channels, err, err_size) != 0)
            return -1;
        render_frame(frame, grey ? BRUME_L8 : BRUME_RGB888, image->u8,
                     (size_t)w * (size_t)channels, threads, progress);
        return 0;
    }
    if (image_new_f32(image, w, h, channels, err, err_size) != 0)
        return -1;
    uint16_t *wide = malloc(image_samples(image) * sizeof *wide);
    if (wide == NULL) {
        snprintf(err, err_size, "not enough memory for %dx%d", w, h);
        image_free(image);
        return -1;
    }
    render_frame(frame, grey ? BRUME_L16 : BRUME_RGB161616, wide,
                 (size_t)w * (size_t)channels * sizeof *wide, threads,
                 progress);
    widen(wide, image->f32, image_samples(image));
    free(wide);
    return 0;
}

static int print_hash(const struct image *image, char *err, size_t err_size)
{
    uint32_t crc = deflate_crc32(0, image->u8, image_samples(image));
    printf("crc32=%08lx\n", (unsigned long)crc);
    if (fflush(stdout) == 0 && !ferror(stdout))
        return 0;
    snprintf(err, err_size, "cannot write the hash");
    return -1;
}

static int run(const struct options *o, char *err, size_t err_size)
{
    struct volume_file file;
    struct brume_scene scene;
    struct brume_frame frame;
    struct image image = {0};
    enum image_format format = IMAGE_PNG;
    if (o->out && image_format_of(o->out, &format, err, err_size) != 0)
        return 2;
    if (o->hash && format == IMAGE_PFM) {
        snprintf(err, err_size, "--hash is of 8-bit pictures, not of a .pfm");
        return 2;
    }
    if (volume_file_open(&file, o->volume, err, err_size) != 0)
        return 2;
    int result = scene_apply(&o->settings, &file, &scene, err, err_size);
    bool is_float = format == IMAGE_PFM;
    if (is_float)
        scene.output = BRUME_LINEAR;
    int error = result ? 0 : brume_begin_frame(&frame, &file.volume, &scene);
    if (error)
        snprintf(err, err_size, "%s", brume_error_text(error));
    bool grey = scene.background[0] == scene.background[1] &&
                scene.background[1] == scene.background[2];
    if (result || error ||
        draw(&frame, is_float, grey, o->threads, &image, err, err_size) != 0) {
        volume_file_close(&file);
        return 2;
    }
    volume_file_close(&file);
    result = o->hash ? print_hash(&image, err, err_size) : 0;
    if (result == 0 && o->out)
        result = image_write(o->out, &image, err, err_size);
    image_free(&image);
    return result ? 1 : 0;
}

int render_main(int argc, char **argv)
{
    struct options options;
    char err[512];
    int result = read_options(&options, argc, argv);
    if (result)
        return result - 1;
    result = run(&options, err, sizeof err);
    if (result)
        fprintf(stderr, "brume render: %s\n", err);
    return result;
}
