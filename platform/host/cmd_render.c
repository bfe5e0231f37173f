/* SPDX-License-Identifier: MIT */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "panel.h"
#include "sequence.h"

static const char k_help[] =
    "usage: brume render VOLUME.brume [--scene FILE] [--set KEY=VALUE]...\n"
    "                    -o OUT.png|.ppm|.pgm|.pfm [OPTIONS]\n"
    "       brume render VOLUME.brume --frames A:B [--path FILE] ...\n"
    "                    -o OUT_%04d.png|OUT.apng|OUT.y4m|- [OPTIONS]\n"
    "\n"
    "Draws a baked volume. Without a scene the whole volume is shown.\n"
    "\n"
    "  --scene FILE      lines `key = value`, # starts a comment\n"
    "  --set KEY=VALUE   the same, said here; later ones win\n"
    "  --threads N       1 to 256 (all processors); same picture for any N\n"
    "  --kernel NAME     auto scalar avx2 avx512 generic: what marches "
    "(auto);\n"
    "                    same picture for any\n"
    "  --hash            print the CRC-32 of the pixels, rows from the top\n"
    "  --profile         print milliseconds by pass to stderr: processor time\n"
    "                    of all threads, the clock, the march's share\n"
    "  --pixels FORMAT   what a panel shows: drawn in rgb888 rgb565 rgb332 l8 "
    "l4\n"
    "                    l2 l1 or rgba8888, then widened to 8 bits; see the "
    "key\n"
    "                    dither. rgba8888, light over a clear background, "
    "goes\n"
    "                    into .png and .apng\n"
    "  --over PICTURE    what is behind, in place of background and sky: of "
    "the\n"
    "                    scene's size, .png .ppm .pgm in sRGB or .pfm, "
    "linear;\n"
    "                    light and transmittance are composed in linear "
    "light\n"
    "  -o OUT            .pfm holds linear radiance, whatever `output` says\n"
    "\n"
    "Sequences:\n"
    "  --frames A:B      frames A to B, each after those before it; `frame` "
    "is\n"
    "                    set to their numbers. VOLUME may have a %d or %04d\n"
    "                    in its name: a volume for each frame\n"
    "  --path FILE       values of keys at keyframes: a line `[FRAME]`, then\n"
    "                    `key = value` for any key but size and frame. "
    "Numbers\n"
    "                    move from one keyframe that sets them to the next,\n"
    "                    words hold. `ease = linear|smooth|spline`, from here\n"
    "                    on. `cut = on`: what is set here jumps to its value,\n"
    "                    and earlier frames are forgotten\n"
    "  --fps N[/M]       of films (25)\n"
    "  -o OUT            a name with one %d or %04d: a picture each; .apng: "
    "an\n"
    "                    animated PNG; .y4m, or - for stdout: YUV4MPEG2, "
    "4:4:4\n"
    "\n"
    "Keys, with ranges and (defaults):\n";

struct options {
    struct sequence sequence;
    struct scene_settings settings;
    const char *path;
};

/* 0 to go on, else the exit status plus 1. */
static int usage(const char *what, const char *arg)
{
    fprintf(stderr, "brume render: %s%s; --help tells more\n", what, arg);
    return 3;
}

/// Values ///

/* A whole number from min to max, and nothing behind it. */
static bool read_whole(const char *text, uint64_t min, uint64_t max,
                       uint64_t *out)
{
    char *end;
    errno = 0;
    unsigned long long n = strtoull(text, &end, 10);
    *out = n;
    return *text >= '0' && *text <= '9' && *end == '\0' && errno == 0 &&
           n >= min && n <= max;
}

/* Two of them, `by` between; the second may be missing when it has a
 * default. */
static bool read_pair(const char *text, char by, uint64_t min, uint64_t max,
                      uint64_t pair[2], bool both)
{
    char first[24];
    const char *second = strchr(text, by);
    size_t n = second ? (size_t)(second - text) : strlen(text);
    if (n >= sizeof first || (both && second == NULL))
        return false;
    memcpy(first, text, n);
    first[n] = '\0';
    return read_whole(first, min, max, &pair[0]) &&
           (second == NULL || read_whole(second + 1, min, max, &pair[1]));
}

static int read_threads(struct sequence *s, const char *value)
{
    uint64_t n;
    if (!read_whole(value, 1, POOL_MAX, &n))
        return usage("--threads is 1 to 256, not ", value);
    s->threads = (int)n;
    return 0;
}

static int read_frames(struct sequence *s, const char *value)
{
    uint64_t pair[2];
    if (!read_pair(value, ':', 0, UINT32_MAX, pair, true))
        return usage("--frames is A:B, two frame numbers, not ", value);
    if (pair[0] > pair[1] || pair[1] - pair[0] >= INT32_MAX)
        return usage("--frames A:B goes from the first to the last, not ",
                     value);
    s->many = true;
    s->first = (uint32_t)pair[0];
    s->last = (uint32_t)pair[1];
    return 0;
}

static int read_rate(struct sequence *s, const char *value)
{
    uint64_t pair[2] = {0, 1};
    if (!read_pair(value, '/', 1, 65535, pair, false))
        return usage("--fps is N or N/M, each 1 to 65535, not ", value);
    s->rate[0] = (unsigned)pair[0];
    s->rate[1] = (unsigned)pair[1];
    return 0;
}

static int read_kernel(struct sequence *s, const char *value)
{
    if (strcmp(value, "auto") == 0)
        s->kernel = wide_best();
    else if (!wide_by_name(value, &s->kernel))
        return usage("--kernel is one of auto scalar avx2 avx512 generic, not ",
                     value);
    else if (!wide_has(s->kernel))
        return usage("this machine or build has no --kernel ", value);
    return 0;
}

static int read_pixels(struct sequence *s, const char *value)
{
    char what[128];
    s->pixels = panel_format(value);
    snprintf(what, sizeof what, "--pixels is one of %s, not ", panel_names);
    return s->pixels < 0 ? usage(what, value) : 0;
}

/// Options ///

static bool takes_value(const char *name)
{
    static const char *const k_names[] = {
        "-o",       "--scene", "--set",    "--threads", "--path",
        "--frames", "--fps",   "--kernel", "--pixels",  "--over"};
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
    if (strcmp(name, "--threads") == 0)
        return read_threads(&o->sequence, value);
    if (strcmp(name, "--frames") == 0)
        return read_frames(&o->sequence, value);
    if (strcmp(name, "--fps") == 0)
        return read_rate(&o->sequence, value);
    if (strcmp(name, "--kernel") == 0)
        return read_kernel(&o->sequence, value);
    if (strcmp(name, "--pixels") == 0)
        return read_pixels(&o->sequence, value);
    if (strcmp(name, "-o") == 0)
        o->sequence.out = value;
    else if (strcmp(name, "--over") == 0)
        o->sequence.over = value;
    else if (strcmp(name, "--path") == 0)
        o->path = value;
    else
        return scene_option("render", &o->settings, name, value);
    return 0;
}

/* One argument, or an option and its value: how many there were is added to
 * *i. */
static int read_argument(struct options *o, char **argv, int *i)
{
    struct sequence *s = &o->sequence;
    const char *arg = argv[*i];
    if (strcmp(arg, "--help") == 0) {
        fputs(k_help, stdout);
        scene_print_keys(stdout);
        return 1;
    }
    if (strcmp(arg, "--hash") == 0) {
        s->hash = true;
    } else if (strcmp(arg, "--profile") == 0) {
        s->profile = true;
    } else if (arg[0] == '-' && arg[1] != '\0') {
        (*i)++;
        return read_option(o, arg, argv[*i]);
    } else if (s->volume == NULL) {
        s->volume = arg;
    } else {
        return usage("unexpected argument ", arg);
    }
    return 0;
}

static int read_options(struct options *o, int argc, char **argv)
{
    memset(o, 0, sizeof *o);
    o->sequence.settings = &o->settings;
    o->sequence.threads = pool_processors();
    o->sequence.kernel = wide_best();
    o->sequence.rate[0] = 25;
    o->sequence.rate[1] = 1;
    o->sequence.pixels = -1;
    for (int i = 1; i < argc; i++) {
        int result = read_argument(o, argv, &i);
        if (result)
            return result;
    }
    if (o->sequence.volume == NULL)
        return usage("no volume given", "");
    if (o->sequence.out == NULL && !o->sequence.hash)
        return usage("no -o OUT given", "");
    if (o->path != NULL && !o->sequence.many)
        return usage("--path needs --frames A:B", "");
    return 0;
}

static int run(struct options *o, char *err, size_t err_size)
{
    struct path *path = NULL;
    if (o->path != NULL && (path = path_read(o->path, err, err_size)) == NULL)
        return 2;
    o->sequence.path = path;
    int status = sequence_run(&o->sequence, err, err_size);
    path_free(path);
    return status;
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
