/* SPDX-License-Identifier: MIT */
/* The command line of brume-noise. */
#include "options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image.h"
#include "table_file.h"

const char options_help[] =
    "usage: brume-noise NAME [options]\n"
    "       brume-noise measure FILE.raw --size WxHxT [--values N]\n"
    "                           [--steady] [--bands] [--spectrum FILE.png]\n"
    "       brume-noise list\n"
    "\n"
    "Makes noise textures that tile in x, y and time. The same options give\n"
    "the same bytes on every machine and for every number of threads.\n"
    "`list` tells the names, `measure` judges any texture.\n"
    "\n"
    "  -o, --output FILE  .png (frames below each other), .raw (one byte per\n"
    "                     value, frame by frame) or .c (the core's table)\n"
    "  --size WxHxT       powers of two, 8x8x1 to 256x256x64\n"
    "                     (64x64x32; blue: 64x64x1)\n"
    "  --seed S           0 to 4294967295: another texture (1)\n"
    "  --bits 4|8         stored bits of a value; of 4, the lower half of the\n"
    "                     byte is Bayer's 4x4 matrix (8)\n"
    "  --measure          print how much error is left, relative to white\n"
    "  --steady           print the same after an endless history\n"
    "  --bands            print the error's energy in the filters' pass bands\n"
    "  --spectrum FILE    draw a frame and its spectra as .png\n"
    "  --threads N        1 to 64, for blue-slices (1)\n"
    "  --help             print this\n"
    "\n"
    "fast only:\n"
    "  --filter F         the picture's spatial filter: gauss1 box3 box5\n"
    "                     binomial3 binomial5 gauss:SIGMA none (gauss:0.8)\n"
    "  --time F           ema:ALPHA (endless history), ema:ALPHA,BETA (that\n"
    "                     is lost with probability BETA per frame),\n"
    "                     gauss:SIGMA, none (ema:0.15)\n"
    "  --combine C        product, separate:W (space + W time), hybrid:W,V\n"
    "                     (product + W time + V space) (hybrid:0.6,0.5)\n"
    "  --values N         a pixel reads N slices per frame, of which its "
    "estimate\n"
    "                     is the mean: 1 2 4 8 16, dividing T (1)\n"
    "  --from FILE.raw    start from these values, evenly spread (none)\n"
    "  --refine N         try N swaps per pixel (0)\n"
    "  --space S          scalar vec2 vec3 sphere hemisphere cosine (scalar)\n";

/* The texts of the filters that were given, for the command. */
struct texts {
    const char *filter, *time, *combine, *space, *size, *more;
};

/// Numbers ///

static bool number(const char *text, uint32_t low, uint32_t high,
                   uint32_t *value)
{
    uint64_t v = 0;

    if (!*text || strlen(text) > 10 ||
        strspn(text, "0123456789") != strlen(text))
        return false;
    for (; *text; text++)
        v = 10u * v + (uint64_t)(*text - '0');
    *value = (uint32_t)v;
    return v >= low && v <= high;
}

static bool is_side(uint32_t n, uint32_t low, uint32_t high)
{
    return n >= low && n <= high && !(n & (n - 1u));
}

static bool parse_size(const char *text, struct noise_job *job)
{
    unsigned w, h, t;
    char rest;

    if (strspn(text, "0123456789x") != strlen(text) || strlen(text) > 11 ||
        sscanf(text, "%ux%ux%u%c", &w, &h, &t, &rest) != 3)
        return false;
    job->width = w;
    job->height = h;
    job->frames = t;
    return is_side(w, 8, 256) && is_side(h, 8, 256) && is_side(t, 1, 64);
}

static bool parse_space(const char *text, enum noise_space *space)
{
    static const char *const names[] = {"scalar", "vec2",       "vec3",
                                        "sphere", "hemisphere", "cosine"};

    for (int i = 0; i < 6; i++)
        if (!strcmp(text, names[i])) {
            *space = (enum noise_space)i;
            return true;
        }
    return false;
}

/// Options ///

static int fail(char *err, size_t err_size, const char *what, const char *arg)
{
    snprintf(err, err_size, "%s'%s'; --help tells more", what, arg);
    return -1;
}

/* Options of `fast`. Returns 1 when it was one, 0 when not, -1 when bad. */
static int filter_option(struct options *o, struct texts *texts,
                         const char *name, const char *value)
{
    bool good;

    if (!strcmp(name, "--filter")) {
        texts->filter = value;
        good = kernel_parse_space(value, &o->job.kernel.space);
    } else if (!strcmp(name, "--time")) {
        texts->time = value;
        good = kernel_parse_time(value, &o->job.kernel.time);
    } else if (!strcmp(name, "--combine")) {
        texts->combine = value;
        good = kernel_parse_combine(value, &o->job.kernel);
    } else if (!strcmp(name, "--space")) {
        texts->space = value;
        good = parse_space(value, &o->job.space);
    } else if (!strcmp(name, "--from")) {
        texts->more = o->job.from = value;
        good = true;
    } else if (!strcmp(name, "--refine")) {
        texts->more = value;
        good = number(value, 0, 1000, &o->job.refine);
    } else {
        return 0;
    }
    return good ? 1 : -1;
}

/* The same for the others that have a value. */
static int value_option(struct options *o, struct texts *texts,
                        const char *name, const char *value)
{
    if (!strcmp(name, "-o") || !strcmp(name, "--output")) {
        o->output = value;
    } else if (!strcmp(name, "--spectrum")) {
        o->spectrum = value;
    } else if (!strcmp(name, "--size")) {
        texts->size = value;
        return parse_size(value, &o->job) ? 1 : -1;
    } else if (!strcmp(name, "--seed")) {
        return number(value, 0, UINT32_MAX, &o->job.seed) ? 1 : -1;
    } else if (!strcmp(name, "--threads")) {
        return number(value, 1, 64, &o->job.threads) ? 1 : -1;
    } else if (!strcmp(name, "--bits")) {
        return number(value, 4, 8, &o->bits) && !(o->bits & 3u) ? 1 : -1;
    } else if (!strcmp(name, "--values")) {
        return number(value, 1, 16, &o->job.kernel.values) &&
                       is_side(o->job.kernel.values, 1, 16)
                   ? 1
                   : -1;
    } else {
        return filter_option(o, texts, name, value);
    }
    return 1;
}

static bool flag_option(struct options *o, const char *name)
{
    if (!strcmp(name, "--measure"))
        return o->measure = true;
    if (!strcmp(name, "--steady"))
        return o->steady = true;
    if (!strcmp(name, "--bands"))
        return o->bands = true;
    return false;
}

static int parse_words(struct options *o, struct texts *texts, int argc,
                       char **argv, char *err, size_t err_size)
{
    for (int i = 1; i < argc; i++) {
        const char *name = argv[i];
        const char *value = i + 1 < argc ? argv[i + 1] : NULL;
        if (flag_option(o, name))
            continue;
        if (name[0] != '-') {
            if (o->action != ACTION_MEASURE || o->input)
                return fail(err, err_size, "unexpected argument ", name);
            o->input = name;
            continue;
        }
        int known = value_option(o, texts, name, value ? value : "");
        if (!known)
            return fail(err, err_size, "unknown option ", name);
        if (!value)
            return fail(err, err_size, "no value after ", name);
        if (known < 0) {
            snprintf(err, err_size, "%s cannot be '%s'; --help tells more",
                     name, value);
            return -1;
        }
        i++;
    }
    return 0;
}

/// What fits together ///

static int check_values(const struct options *o, char *err, size_t err_size)
{
    if (o->job.kernel.values <= o->job.frames)
        return 0;
    snprintf(err, err_size, "--values: %u of %u slices; --help tells more",
             o->job.kernel.values, o->job.frames);
    return -1;
}

/* Before the texture is made, which may take long. */
static int check_spectrum(const struct options *o, char *err, size_t err_size)
{
    enum image_format format;

    return o->spectrum ? image_format_of(o->spectrum, &format, err, err_size)
                       : 0;
}

static bool judged(const struct options *o)
{
    return o->measure || o->steady || o->bands || o->spectrum;
}

static int check_make(const struct options *o, const struct texts *texts,
                      char *err, size_t err_size)
{
    const struct noise_name *name = o->job.name;
    bool rooks = noise_is_rooks(&o->job);
    size_t length = o->output ? strlen(o->output) : 0;

    if (!name->filters &&
        (texts->filter || texts->time || texts->combine || texts->space ||
         texts->more || o->job.kernel.values > 1))
        return fail(err, err_size, "no option of fast goes with ", name->name);
    if (o->job.frames > name->max_frames)
        return fail(err, err_size, "--size: only one frame of ", name->name);
    if (!o->output && !judged(o))
        return fail(err, err_size,
                    "nothing to do without -o, --measure or another for ",
                    name->name);
    if (rooks &&
        (judged(o) || length < 2 || strcmp(o->output + length - 2, ".c")))
        return fail(err, err_size, "only -o FILE.c for ", name->name);
    if (o->job.space != NOISE_SCALAR &&
        (o->steady || o->bands || o->spectrum || o->bits == 4 || texts->more ||
         o->job.kernel.values > 1))
        return fail(
            err, err_size,
            "--bits 4, --steady, --bands, --spectrum, --values, --from and "
            "--refine are for scalars, not ",
            texts->space);
    if (o->job.from && length > 2 && !strcmp(o->output + length - 2, ".c"))
        return fail(err, err_size,
                    "no .c file, whose line 1 must tell all, from ",
                    o->job.from);
    if (check_values(o, err, err_size))
        return -1;
    if (o->output && table_file_check(o->output, o->job.space, err, err_size))
        return -1;
    return check_spectrum(o, err, err_size);
}

static int check_measure(const struct options *o, const struct texts *texts,
                         char *err, size_t err_size)
{
    if (!o->input)
        return fail(err, err_size, "no FILE.raw after ", "measure");
    if (!texts->size)
        return fail(err, err_size, "no --size for ", o->input);
    if (o->output || texts->filter || texts->time || texts->combine ||
        texts->space || texts->more)
        return fail(
            err, err_size,
            "only --size, --values, --steady, --bands, --spectrum after ",
            "measure");
    if (check_values(o, err, err_size))
        return -1;
    return check_spectrum(o, err, err_size);
}

static void spell(struct options *o, const struct texts *texts)
{
    int length = snprintf(o->command, sizeof o->command, "brume-noise %s",
                          o->job.name->name);
    size_t left = sizeof o->command - (size_t)length;
    char *end = o->command + length;

    if (noise_is_rooks(&o->job))
        return;
    length = snprintf(end, left, " --size %ux%ux%u --seed %u --bits %u",
                      o->job.width, o->job.height, o->job.frames, o->job.seed,
                      o->bits);
    if (o->job.name->filters)
        length += snprintf(
            end + length, left - (size_t)length,
            " --filter %.20s --time %.30s --combine %.30s --space %.12s",
            texts->filter ? texts->filter : NOISE_DEFAULT_FILTER,
            texts->time ? texts->time : NOISE_DEFAULT_TIME,
            texts->combine ? texts->combine : NOISE_DEFAULT_COMBINE,
            texts->space ? texts->space : "scalar");
    if (o->job.kernel.values > 1)
        length += snprintf(end + length, left - (size_t)length, " --values %u",
                           o->job.kernel.values);
    if (o->job.from)
        length += snprintf(end + length, left - (size_t)length, " --from %.60s",
                           o->job.from);
    if (o->job.refine)
        snprintf(end + length, left - (size_t)length, " --refine %u",
                 o->job.refine);
}

int options_parse(struct options *o, int argc, char **argv, char *err,
                  size_t err_size)
{
    struct texts texts = {.size = NULL};
    const char *first = argc > 1 ? argv[1] : "";

    *o = (struct options){.action = ACTION_MAKE, .bits = 8};
    o->job = (struct noise_job){
        .width = 64, .height = 64, .frames = 32, .seed = 1, .threads = 1};
    noise_default_kernel(&o->job.kernel);
    o->job.kernel.values = 1;
    for (int i = 1; i < argc; i++)
        if (!strcmp(argv[i], "--help") || !strcmp(argv[i], "-h")) {
            o->action = ACTION_HELP;
            return 0;
        }
    if (!*first)
        return fail(err, err_size, "no NAME given after ", "brume-noise");
    if (!strcmp(first, "list")) {
        o->action = ACTION_LIST;
        return argc > 2 ? fail(err, err_size, "unexpected argument ", argv[2])
                        : 0;
    }
    if (!strcmp(first, "measure"))
        o->action = ACTION_MEASURE;
    else if (!(o->job.name = noise_find(first)))
        return fail(err, err_size, "no noise is called ", first);
    else if (o->job.name->max_frames == 1)
        o->job.frames = 1;
    if (parse_words(o, &texts, argc - 1, argv + 1, err, err_size))
        return -1;
    if (o->action == ACTION_MEASURE)
        return check_measure(o, &texts, err, err_size);
    if (check_make(o, &texts, err, err_size))
        return -1;
    spell(o, &texts);
    return 0;
}
