/* SPDX-License-Identifier: MIT */
#include "compare_options.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image.h"
#include "metrics.h"
#include "pattern.h"

const char *const compare_names[METRICS] = {
    "rmse",    "mean",      "psnr",     "max",       "worst_tile",
    "ssim",    "flip",      "flip_max", "sharpness", "ghosting",
    "flicker", "deviation", "lag",      "tpsnr"};

const char compare_usage[] =
    "usage: brume compare A B [OPTIONS]\n"
    "       brume compare A_%03d.png B_%03d.png --frames N:M [OPTIONS]\n"
    "\n"
    "Compares a picture B with a reference A of the same size (.png .ppm .pgm\n"
    ".pfm; 255 is 1.0 of a float) and prints, one name=value a line,\n"
    "  rmse        root mean square difference\n"
    "  mean        mean of B - A\n"
    "  psnr        in dB, inf when identical\n"
    "  max         largest absolute difference\n"
    "  worst_tile  largest rmse of an 8x8 tile\n"
    "  ssim        structural similarity of luma (Wang et al. 2004): 1 is\n"
    "              identical, nan below 11x11 pixels\n"
    "  flip        mean of LDR-FLIP (Andersson et al. 2020): 0 to 1\n"
    "  flip_max    its largest value\n"
    "  sharpness   gradients of B along those of A: 1 as sharp, 0 flat\n"
    "and of sequences, besides means (max, worst_tile, flip_max: the largest)\n"
    "of these, with e = B - A and d a change from the frame before,\n"
    "  ghosting    mean |e|: what B shows that is not the frame\n"
    "  flicker     mean |dB - dA|\n"
    "  deviation   of e over time: root of the mean variance\n"
    "  lag         frames that B is behind: -sum(e dA) / sum(dA dA)\n"
    "  tpsnr       psnr of dB against dA\n"
    "in 1/255 of full scale except psnr, tpsnr, ssim, flip, sharpness and "
    "lag.\n"
    "\n"
    "  --frames N:M   frames N to M, of names with one %d or %03d; a name\n"
    "                 without is a picture that all frames are compared with\n"
    "  --metrics LIST only these, separated by commas; others cost no time\n"
    "  --csv FILE     also a line for each frame; - is stdout\n"
    "  --max-rmse X   exit with status 1 when rmse is above X\n"
    "  --heat FILE.png  the mean absolute difference of each pixel, in the\n"
    "                 colours of magma: black is 0, pale yellow the most\n"
    "  --heat-max X   what is palest, in 1/255 (the largest there is)\n"
    "  --flip FILE.png  FLIP of each pixel in the same colours, 0 to 1\n"
    "  --linear       FLIP takes samples as linear light, not as sRGB codes\n"
    "  --ppd X        FLIP's pixels per degree, 1 to 200 (67.0206)\n"
    "  --help         print this\n"
    "\n"
    "Exit status: 0, 1 above --max-rmse, 2 on bad usage or files.\n";

int compare_complain(const char *fmt, ...)
{
    va_list ap;

    fputs("brume compare: ", stderr);
    va_start(ap, fmt);
    vfprintf(stderr, fmt, ap);
    va_end(ap);
    fputc('\n', stderr);
    return -1;
}

/// Options ///

static int parse_number(const char *name, const char *text, double min,
                        double max, double *number)
{
    char *end;

    *number = strtod(text, &end);
    if (end == text || *end || !isfinite(*number) || *number < min)
        return compare_complain("%s %s: must be a number from %g up", name,
                                text, min);
    if (*number > max)
        return compare_complain("%s %s: must be at most %g", name, text, max);
    return 0;
}

static int parse_frames(struct compare_options *o, const char *text)
{
    char *end;
    unsigned long long first, last;

    errno = 0;
    first = strtoull(text, &end, 10);
    if (*text < '0' || *text > '9' || *end != ':' || end[1] < '0' ||
        end[1] > '9')
        return compare_complain("--frames %s: must be N:M, two frame numbers",
                                text);
    last = strtoull(end + 1, &end, 10);
    if (*end || errno || last > UINT32_MAX || first > last)
        return compare_complain(
            "--frames %s: must be N:M, from the first frame to "
            "the last",
            text);
    o->many = true;
    o->first = (uint32_t)first;
    o->last = (uint32_t)last;
    return 0;
}

static int parse_metrics(struct compare_options *o, const char *list)
{
    memset(o->wanted, 0, sizeof o->wanted);
    for (const char *word = list;; word++) {
        size_t length = strcspn(word, ",");
        int m = 0;
        while (m < METRICS && (strlen(compare_names[m]) != length ||
                               strncmp(compare_names[m], word, length) != 0))
            m++;
        if (m == METRICS)
            return compare_complain(
                "--metrics %s: no metric '%.*s'; see --help", list, (int)length,
                word);
        o->wanted[m] = true;
        word += length;
        if (!*word)
            return 0;
    }
}

static int parse_option(struct compare_options *o, const char *name,
                        const char *value)
{
    static const char *const known[] = {"--max-rmse", "--heat-max", "--ppd",
                                        "--frames",   "--metrics",  "--heat",
                                        "--flip",     "--csv"};
    size_t k = 0;

    while (k < sizeof known / sizeof *known && strcmp(name, known[k]) != 0)
        k++;
    if (k == sizeof known / sizeof *known)
        return compare_complain("unknown option %s; see --help", name);
    if (!value)
        return compare_complain("%s needs a %s", name,
                                k < 3    ? "number"
                                : k == 3 ? "range N:M"
                                : k == 4 ? "list of names"
                                         : "file name");
    switch (k) {
    case 0: return parse_number(name, value, 0, HUGE_VAL, &o->max_rmse);
    case 1: return parse_number(name, value, 1e-6, HUGE_VAL, &o->heat_max);
    case 2: return parse_number(name, value, 1, 200, &o->degree);
    case 3: return parse_frames(o, value);
    case 4: return parse_metrics(o, value);
    case 5: o->heat = value; return 0;
    case 6: o->flip = value; return 0;
    default: o->csv = value; return 0;
    }
}

static int check_png(const char *name, const char *path)
{
    enum image_format format;
    char err[MESSAGE_SIZE];

    if (!path)
        return 0;
    if (image_format_of(path, &format, err, sizeof err))
        return compare_complain("%s %s", name, err);
    if (format != IMAGE_PNG)
        return compare_complain("%s %s: must end in .png", name, path);
    return 0;
}

static int check_options(const struct compare_options *o, int paths)
{
    char err[MESSAGE_SIZE];

    if (paths < 2)
        return compare_complain("needs two pictures; see --help");
    if (check_png("--heat", o->heat) || check_png("--flip", o->flip))
        return -1;
    if (o->heat_max > 0 && !o->heat)
        return compare_complain("--heat-max needs --heat");
    if (!o->many)
        return o->csv ? compare_complain("--csv needs --frames") : 0;
    if (o->heat || o->flip)
        return compare_complain("%s is of a pair of pictures, not of --frames",
                                o->heat ? "--heat" : "--flip");
    if (!pattern_is(o->path[0]) && !pattern_is(o->path[1]))
        return compare_complain("--frames needs a name with %%d in it: %s",
                                o->path[1]);
    for (int i = 0; i < 2; i++)
        if (pattern_is(o->path[i]) &&
            pattern_check(o->path[i], err, sizeof err))
            return compare_complain("%s", err);
    return 0;
}

int compare_parse(int argc, char **argv, struct compare_options *o)
{
    int paths = 0, literal = 0;

    memset(o, 0, sizeof *o);
    o->max_rmse = -1;
    o->degree = METRICS_FLIP_DEGREE;
    for (int m = 0; m < METRICS; m++)
        o->wanted[m] = true;
    for (int i = 1; i < argc; i++) {
        const char *arg = argv[i];
        if (literal || arg[0] != '-') {
            if (paths == 2)
                return compare_complain("more than two pictures: %s", arg);
            o->path[paths++] = arg;
        } else if (strcmp(arg, "--help") == 0) {
            o->help = true;
            return 0;
        } else if (strcmp(arg, "--") == 0) {
            literal = 1;
        } else if (strcmp(arg, "--linear") == 0) {
            o->linear = true;
        } else {
            i++;
            if (parse_option(o, arg, i < argc ? argv[i] : NULL))
                return -1;
        }
    }
    return check_options(o, paths);
}
