/* SPDX-License-Identifier: MIT */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lab.h"
#include "panel.h"
#include "scene_keys.h"

static const char k_usage[] =
    "usage: brume-lab sequence VOLUME.brume [--scene FILE] [--set "
    "KEY=VALUE]...\n"
    "                 [--frames A:B] [--reference NAME=FILE]... [OPTION]...\n"
    "       brume-lab picture FILE --reference NAME=FILE... [--region ...]\n"
    "                 [--column ...]\n"
    "       brume-lab pack VOLUME.brume [--scene FILE] [--set KEY=VALUE]...\n"
    "                 [--frames 0:B]\n"
    "\n"
    "Draws frames in memory and prints how far each is from each reference, "
    "in\n"
    "the whole picture and in regions, as CSV. White is 1.\n"
    "`picture` does so with a picture that is there. `pack` writes the scene "
    "and a\n"
    "checksum of its last frame for lab/target/count.c.\n"
    "\n"
    "  --scene FILE, --set KEY=VALUE, --path FILE, --kernel NAME\n"
    "                    as of brume render\n"
    "  --frames A:B      frames A to B, in a row (0:0)\n"
    "  --from N          rows begin at frame N (A)\n"
    "  --only N          rows of frame N, and of others so named\n"
    "  --reference NAME=FILE\n"
    "                    a picture to compare with (.pfm .png); with %d in "
    "its\n"
    "                    name one for each frame\n"
    "  --region NAME=X,Y,W,H\n"
    "                    a part of the picture, in fractions of its sides;\n"
    "                    `all` is always there\n"
    "  --column NAME=VALUE\n"
    "                    a column in front, the same in every row\n"
    "  --pixels FORMAT   linear, or codes as a panel shows them, as of brume "
    "render\n"
    "  --flip            a column flip: the mean of LDR-FLIP\n"
    "  --time            a column ms: processor time of the frame\n"
    "  --cycle N         frame F is drawn with the noise of frame F modulo N\n"
    "  --cumulative      rows are of the mean of all frames so far\n"
    "  --spectrum BASE   also write BASE.png and BASE.csv: power by frequency "
    "of\n"
    "                    the error to the first reference, in the middle of "
    "the\n"
    "                    last region, over frames from --from on\n"
    "  --mean FILE       also write the mean of all frames (.pfm)\n"
    "  --picture FILE    also write the last frame (.pfm; of a panel .png)\n"
    "  --threads N       1 to 256 (1)\n"
    "  --help            this text\n"
    "\n"
    "Exit status: 0, 1 when writing failed, 2 on bad usage or input. On "
    "errors\n"
    "nothing is printed on stdout.\n";

static int usage(const char *what, const char *word)
{
    fprintf(stderr, "brume-lab: %s%s; --help tells more\n", what, word);
    return 2;
}

/// Values ///

/* NAME=VALUE: the name copied, the value where it is. NULL when there is
 * none, or a name that would upset a CSV. */
static const char *read_name(const char *text, char name[LAB_NAME])
{
    const char *equals = strchr(text, '=');
    size_t n = equals ? (size_t)(equals - text) : 0;
    if (n == 0 || n >= LAB_NAME || equals[1] == '\0' ||
        strpbrk(text, ",\"\n") != NULL)
        return NULL;
    memcpy(name, text, n);
    name[n] = '\0';
    return equals + 1;
}

static bool read_whole(const char *text, char **end, uint32_t *out)
{
    errno = 0;
    unsigned long long n = strtoull(text, end, 10);
    *out = (uint32_t)n;
    return *text >= '0' && *text <= '9' && errno == 0 && n <= UINT32_MAX;
}

static int read_frames(struct lab_options *o, const char *text)
{
    char *end;
    if (!read_whole(text, &end, &o->first) || *end != ':' ||
        !read_whole(end + 1, &end, &o->last) || *end != '\0' ||
        o->first > o->last || o->last - o->first >= INT32_MAX)
        return usage("--frames is A:B, from the first to the last, not ", text);
    return -1;
}

static int read_number(const char *option, const char *text, uint32_t min,
                       uint32_t max, uint32_t *out)
{
    char *end;
    if (read_whole(text, &end, out) && *end == '\0' && *out >= min &&
        *out <= max)
        return -1;
    fprintf(stderr, "brume-lab: %s is %lu to %lu, not %s\n", option,
            (unsigned long)min, (unsigned long)max, text);
    return 2;
}

static int read_region(struct lab_options *o, const char *text)
{
    struct lab_region *r = &o->regions[o->region_count];
    double v[4];
    char copy[SCENE_LINE_SIZE];
    const char *equals = strchr(text, '=');
    size_t n = equals ? (size_t)(equals - text) : 0;
    if (o->region_count == LAB_MOST)
        return usage("more than 15 regions: ", text);
    if (n == 0 || n >= LAB_NAME || strlen(text) >= sizeof copy ||
        memchr(text, ',', n) != NULL ||
        scene_read_numbers(equals + 1, v, 4, ',') != 4)
        return usage("--region is NAME=X,Y,W,H, not ", text);
    for (int i = 0; i < 4; i++)
        if (!(v[i] >= 0 && v[i] <= 1))
            return usage("--region: fractions from 0 to 1, not ", text);
    memcpy(r->name, text, n);
    r->x = v[0];
    r->y = v[1];
    r->w = v[2];
    r->h = v[3];
    o->region_count++;
    return -1;
}

static int read_kernel(struct lab_options *o, const char *text)
{
    if (strcmp(text, "auto") == 0)
        o->kernel = wide_best();
    else if (!wide_by_name(text, &o->kernel) || !wide_has(o->kernel))
        return usage("this machine or build has no --kernel ", text);
    return -1;
}

static int read_pixels(struct lab_options *o, const char *text)
{
    o->pixels = panel_format(text);
    if (o->pixels < 0 && strcmp(text, "linear") != 0)
        return usage("--pixels is linear or a format of brume render, not ",
                     text);
    return -1;
}

static int read_reference(struct lab_options *o, const char *text)
{
    struct lab_reference *r = &o->references[o->reference_count];
    if (o->reference_count == LAB_MOST)
        return usage("more than 16 references: ", text);
    if ((r->path = read_name(text, r->name)) == NULL)
        return usage("--reference is NAME=FILE, not ", text);
    o->reference_count++;
    return -1;
}

static int read_column(struct lab_options *o, const char *text)
{
    struct lab_column *c = &o->columns[o->column_count];
    if (o->column_count == LAB_MOST)
        return usage("more than 16 columns: ", text);
    if ((c->value = read_name(text, c->name)) == NULL)
        return usage("--column is NAME=VALUE, without commas, not ", text);
    o->column_count++;
    return -1;
}

static int read_scene(struct lab_options *o, bool file, const char *text)
{
    char err[LAB_ERROR];
    int bad = file ? scene_read(&o->settings, text, err, sizeof err)
                   : scene_set(&o->settings, text, "--set", err, sizeof err);
    if (bad)
        fprintf(stderr, "brume-lab: %s\n", err);
    return bad ? 2 : -1;
}

/// Options ///

static int read_count(struct lab_options *o, const char *name,
                      const char *value)
{
    uint32_t n;
    int status = -1;
    if (strcmp(name, "--from") == 0)
        return read_number(name, value, 0, UINT32_MAX, &o->from);
    if (strcmp(name, "--only") == 0) {
        if (o->only_count == LAB_MOST)
            return usage("more than 16 frames: ", value);
        return read_number(name, value, 0, UINT32_MAX,
                           &o->only[o->only_count++]);
    }
    if (strcmp(name, "--cycle") == 0)
        return read_number(name, value, 1, UINT32_MAX, &o->cycle);
    if (strcmp(name, "--threads") == 0) {
        status = read_number(name, value, 1, POOL_MAX, &n);
        o->threads = (int)n;
        return status;
    }
    return usage("unknown option ", name);
}

static int read_option(struct lab_options *o, const char *name,
                       const char *value)
{
    if (strcmp(name, "--scene") == 0 || strcmp(name, "--set") == 0)
        return read_scene(o, name[3] == 'c', value);
    if (strcmp(name, "--frames") == 0)
        return read_frames(o, value);
    if (strcmp(name, "--reference") == 0)
        return read_reference(o, value);
    if (strcmp(name, "--region") == 0)
        return read_region(o, value);
    if (strcmp(name, "--column") == 0)
        return read_column(o, value);
    if (strcmp(name, "--kernel") == 0)
        return read_kernel(o, value);
    if (strcmp(name, "--pixels") == 0)
        return read_pixels(o, value);
    if (strcmp(name, "--path") == 0)
        o->path = value;
    else if (strcmp(name, "--mean") == 0)
        o->mean = value;
    else if (strcmp(name, "--picture") == 0)
        o->picture = value;
    else if (strcmp(name, "--spectrum") == 0)
        o->spectrum = value;
    else
        return read_count(o, name, value);
    return -1;
}

static bool takes_value(const char *name)
{
    static const char *const names[] = {
        "--scene",  "--set",     "--frames", "--reference",
        "--region", "--kernel",  "--column", "--path",
        "--mean",   "--picture", "--from",   "--threads",
        "--pixels", "--only",    "--cycle",  "--spectrum"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(name, names[i]) == 0)
            return true;
    return false;
}

static int check(const struct lab_options *o)
{
    if (o->volume == NULL)
        return usage(o->is_picture ? "no picture given" : "no volume given",
                     "");
    if (!o->is_pack && o->reference_count == 0 && o->mean == NULL &&
        o->picture == NULL)
        return usage("no --reference, --mean or --picture given", "");
    if ((o->cumulative || o->spectrum != NULL) && o->pixels >= 0)
        return usage("--cumulative and --spectrum are of linear pixels", "");
    if (o->spectrum != NULL && (o->reference_count == 0 || o->is_picture))
        return usage("--spectrum is of a sequence with a --reference", "");
    if (o->from > o->last)
        return usage("--from is behind the last frame", "");
    return -1;
}

int lab_read_options(struct lab_options *o, int argc, char **argv)
{
    memset(o, 0, sizeof *o);
    o->threads = 1;
    o->pixels = -1;
    o->kernel = wide_best();
    o->regions[0] = (struct lab_region){"all", 0, 0, 1, 1};
    o->region_count = 1;
    if (argc > 1 && strcmp(argv[1], "--help") == 0)
        return fputs(k_usage, stdout) < 0;
    o->is_picture = argc > 1 && strcmp(argv[1], "picture") == 0;
    o->is_pack = argc > 1 && strcmp(argv[1], "pack") == 0;
    if (!o->is_picture && !o->is_pack &&
        (argc < 2 || strcmp(argv[1], "sequence") != 0))
        return usage("the commands are sequence, picture and pack, not ",
                     argc < 2 ? "nothing" : argv[1]);
    for (int i = 2; i < argc; i++) {
        int status = -1;
        if (strcmp(argv[i], "--help") == 0)
            return fputs(k_usage, stdout) < 0;
        if (strcmp(argv[i], "--time") == 0)
            o->time = true;
        else if (strcmp(argv[i], "--flip") == 0)
            o->flip = true;
        else if (strcmp(argv[i], "--cumulative") == 0)
            o->cumulative = true;
        else if (takes_value(argv[i]) && i + 1 < argc)
            status = read_option(o, argv[i], argv[i + 1]), i++;
        else if (takes_value(argv[i]))
            return usage("no value after ", argv[i]);
        else if (argv[i][0] == '-')
            return usage("unknown option ", argv[i]);
        else if (o->volume != NULL)
            return usage("unexpected argument ", argv[i]);
        else
            o->volume = argv[i];
        if (status >= 0)
            return status;
    }
    return check(o);
}
