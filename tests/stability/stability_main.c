/* SPDX-License-Identifier: MIT */
/*
 * brume-stability: measures how stable pictures are where methods fail, and
 * checks the bounds that are promised.
 */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image.h"
#include "stability.h"
#include "tap.h"

#define MOST_SCENARIOS 32
#define MOST_METHODS 32

static const char k_usage[] =
    "usage: brume-stability [option]... [NAME=VOLUME.brume]...\n"
    "\n"
    "Draw scenarios frame by frame with several methods, and compare the last\n"
    "frames with the mean of 256 renders each. In 1/255 of white, linear:\n"
    "ghost: mean |error|; rmse; bias; tile: rmse of the worst 8x8 pixels;\n"
    "flicker: mean |change - true change|; sd: deviation over time. sharp: of\n"
    "gradients, 1 is as sharp as the truth.\n"
    "\n"
    "  --scenario LIST  only these, separated by commas\n"
    "  --method LIST    only these\n"
    "  --samples N      renders of the truth, 16 to 256 (default 256)\n"
    "  --check          test the bounds; needs all scenarios and methods\n"
    "  --write DIR      also write pictures: DIR/SCENARIO-METHOD.png, of the\n"
    "                   last frame; -error: eight times the error; and\n"
    "                   DIR/SCENARIO-truth.png\n"
    "  --list           list scenarios and methods\n"
    "  --help           this text\n"
    "\n"
    "Volumes: disney, and fire0 to fire4 for one after the other. Scenarios\n"
    "whose volume is not given are skipped.\n";

struct options {
    const char *scenarios, *methods, *dir;
    int samples;
    bool check;
};

static picture_t s_truths[STABILITY_MOST], s_pictures[STABILITY_MOST];
static struct measure s_measures[MOST_SCENARIOS][MOST_METHODS];

/// Names ///

/* Is the name in the list, or no list given? */
static bool is_wanted(const char *list, const char *name)
{
    size_t n = strlen(name);
    if (list == NULL)
        return true;
    while (*list) {
        size_t length = strcspn(list, ",");
        if (length == n && strncmp(list, name, n) == 0)
            return true;
        list += length + (list[length] == ',');
    }
    return false;
}

static int scenario_number(const char *name)
{
    for (int i = 0; i < scenario_count; i++)
        if (strcmp(scenarios[i].name, name) == 0)
            return i;
    abort();
}

static const struct measure *of(const char *scenario, const char *method)
{
    for (int i = 0; i < method_count; i++)
        if (strcmp(methods[i].name, method) == 0)
            return &s_measures[scenario_number(scenario)][i];
    abort();
}

static bool is_there(const char *scenario)
{
    struct brume_scene s;
    const struct brume_volume *v;
    return scenario_scene(&scenarios[scenario_number(scenario)], 0, &s, &v);
}

static void list_names(void)
{
    for (int i = 0; i < scenario_count; i++)
        printf("%-12s %s\n", scenarios[i].name, scenarios[i].what);
    printf("\n");
    for (int i = 0; i < method_count; i++)
        printf("%s\n", methods[i].name);
}

/* Has the list a word that is no name? */
static bool is_unknown(const char *list, const char *(*name_of)(int), int count)
{
    for (const char *word = list; word != NULL && *word;) {
        size_t length = strcspn(word, ",");
        int i = 0;
        while (i < count && (strlen(name_of(i)) != length ||
                             strncmp(name_of(i), word, length) != 0))
            i++;
        if (i == count)
            return true;
        word += length + (word[length] == ',');
    }
    return false;
}

static const char *scenario_name(int i)
{
    return scenarios[i].name;
}

static const char *method_name(int i)
{
    return methods[i].name;
}

/// Pictures ///

static int write_grey(const struct options *o, const char *scenario,
                      const char *name, const picture_t a, const uint16_t *b)
{
    struct image image;
    char path[512], err[512];
    if (image_new_u8(&image, STABILITY_WIDTH, STABILITY_HEIGHT, 1, err,
                     sizeof err) != 0) {
        fprintf(stderr, "brume-stability: %s\n", err);
        return -1;
    }
    for (int i = 0; i < STABILITY_PIXELS; i++) {
        int v = b ? 128 + 8 * (a[i] - b[i]) / 257 : (a[i] + 128) / 257;
        image.u8[i] = (uint8_t)(v < 0 ? 0 : v > 255 ? 255 : v);
    }
    snprintf(path, sizeof path, "%s/%s-%s%s.png", o->dir, scenario, name,
             b ? "-error" : "");
    int bad = image_write(path, &image, err, sizeof err);
    image_free(&image);
    if (bad)
        fprintf(stderr, "brume-stability: %s\n", err);
    return bad;
}

static int write_pictures(const struct options *o, const struct scenario *s,
                          const struct method *m)
{
    const uint16_t *last = s_pictures[s->last - 1];
    const uint16_t *truth = s_truths[s->fixed ? 0 : s->last - 1];
    if (o->dir == NULL)
        return 0;
    if (m == NULL)
        return write_grey(o, s->name, "truth", truth, NULL);
    return write_grey(o, s->name, m->name, last, NULL) ||
                   write_grey(o, s->name, m->name, last, truth)
               ? -1
               : 0;
}

/// Measuring ///

static int measure_scenario(const struct options *o, int i)
{
    const struct scenario *s = &scenarios[i];
    run_truths(s, o->samples, s_truths);
    int bad = write_pictures(o, s, NULL);
    for (int k = 0; k < method_count && !bad; k++) {
        struct measure *m = &s_measures[i][k];
        if (!is_wanted(o->methods, methods[k].name) ||
            !is_wanted(s->methods, methods[k].name))
            continue;
        run_method(s, &methods[k], false, s_pictures);
        *m = measure_of(s_pictures, s_truths, s->last, s->fixed);
        printf("# %-10s %-12s %7.3f %7.3f %+7.3f %7.2f %7.3f %6.3f %6.3f\n",
               s->name, methods[k].name, m->ghosting, m->error, m->bias,
               m->tile, m->flicker, m->deviation, m->sharpness);
        fflush(stdout);
        bad = write_pictures(o, s, &methods[k]);
    }
    return bad;
}

static int measure_all(const struct options *o)
{
    printf("# %-10s %-12s %7s %7s %7s %7s %7s %6s %6s\n", "scenario", "method",
           "ghost", "rmse", "bias", "tile", "flicker", "sd", "sharp");
    for (int i = 0; i < scenario_count; i++) {
        if (!is_wanted(o->scenarios, scenarios[i].name))
            continue;
        if (!is_there(scenarios[i].name)) {
            printf("# %s: no volume\n", scenarios[i].name);
            continue;
        }
        if (measure_scenario(o, i) != 0)
            return -1;
    }
    return 0;
}

/// Bounds ///

static void check_still(const char *method)
{
    double d = of("still", method)->deviation;
    tap_check(d < 1, "still, %s: deviation over 32 frames %.3f, below 1",
              method, d);
}

/* After the cut, frames are those of a state that begins there. */
static void check_cut(void)
{
    static picture_t fresh[STABILITY_MOST];
    const struct scenario *s = &scenarios[scenario_number("cut")];
    for (int k = 0; k < method_count; k++) {
        run_method(s, &methods[k], false, s_pictures);
        run_method(s, &methods[k], true, fresh);
        tap_check(
            memcmp(fresh, s_pictures, sizeof fresh[0] * (size_t)s->last) == 0,
            "cut, %s: no trace of the frames before", methods[k].name);
    }
}

static void check_ghosts(const char *scenario)
{
    double ema = of(scenario, "ema")->ghosting;
    double taa = of(scenario, "taa")->ghosting;
    tap_check(3 * taa <= ema,
              "%s: taa ghosts %.2f, at most a third of ema's %.2f", scenario,
              taa, ema);
}

/* The still image is one in which nothing was accumulated: taa may lose by
 * motion what accumulation gained, but not more. */
static void check_blur(const char *scenario)
{
    const struct measure *taa = of(scenario, "taa");
    double still = of("still", "none")->error;
    tap_check(taa->error <= 1.5 * still,
              "%s: taa's error %.2f, at most 1.5 of the still image's %.2f",
              scenario, taa->error, still);
    tap_check(taa->ghosting <= of(scenario, "none")->ghosting,
              "%s: taa is nearer to the truth than single frames", scenario);
}

/* Where little moves, history must be worth something. */
static void check_drift(void)
{
    double none = of("drift", "none")->ghosting;
    double taa = of("drift", "taa")->ghosting;
    tap_check(2 * taa <= none, "drift: taa leaves %.2f of %.2f, at most half",
              taa, none);
}

/* 10,000 frames are as good as 64. */
static void check_long(const char *method)
{
    const struct measure *m = of("long", method), *still = of("still", method);
    tap_check(m->error <= still->error + 0.05 && fabs(m->bias) < 0.1,
              "10,000 frames, %s: error %.3f, after 64 it was %.3f; bias %+.3f",
              method, m->error, still->error, m->bias);
}

static void check_bounds(void)
{
    static const char *const motion[] = {"pan", "rotation", "dolly", "enter"};
    static const char *const steady[] = {"ema", "ema-8bit", "taa", "taa-8bit",
                                         "window8"};
    check_ghosts("edge");
    if (!is_there("fire"))
        tap_skip("stability: the fire's volumes are not there");
    if (!is_there("still")) {
        tap_skip("stability: the Disney cloud is not there");
        return;
    }
    check_still("ema");
    check_still("taa");
    check_still("ema-stbn");
    check_still("taa-stbn");
    check_cut();
    for (size_t i = 0; i < sizeof motion / sizeof motion[0]; i++) {
        check_ghosts(motion[i]);
        check_blur(motion[i]);
    }
    check_drift();
    for (size_t i = 0; i < sizeof steady / sizeof steady[0]; i++)
        check_long(steady[i]);
}

/// Options ///

static int bad_usage(const char *text, const char *word)
{
    fprintf(stderr, "brume-stability: %s%s; see --help\n", text, word);
    return 2;
}

static int parse_samples(const char *text)
{
    char *end;
    errno = 0;
    long n = strtol(text, &end, 10);
    return errno || end == text || *end || n < 16 || n > 256 ? -1 : (int)n;
}

/* Returns -1 to go on, else the exit status. */
static int parse(struct options *o, int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        const char *arg = argv[i], *value = i + 1 < argc ? argv[i + 1] : NULL;
        const char **text = strcmp(arg, "--scenario") == 0 ? &o->scenarios
                            : strcmp(arg, "--method") == 0 ? &o->methods
                            : strcmp(arg, "--write") == 0  ? &o->dir
                                                           : NULL;
        if (strcmp(arg, "--help") == 0) {
            fputs(k_usage, stdout);
            return 0;
        } else if (strcmp(arg, "--list") == 0) {
            list_names();
            return 0;
        } else if (strcmp(arg, "--check") == 0) {
            o->check = true;
        } else if (text != NULL || strcmp(arg, "--samples") == 0) {
            if (value == NULL)
                return bad_usage("no value after ", arg);
            if (text != NULL)
                *text = value;
            else if ((o->samples = parse_samples(value)) < 0)
                return bad_usage("not 16 to 256 samples: ", value);
            i++;
        } else if (arg[0] == '-') {
            return bad_usage("no such option: ", arg);
        } else if (stage_open(arg) != 0) {
            return 2;
        }
    }
    if (o->check && (o->scenarios != NULL || o->methods != NULL))
        return bad_usage("--check needs all scenarios and methods", "");
    if (is_unknown(o->scenarios, scenario_name, scenario_count))
        return bad_usage("no such scenario in ", o->scenarios);
    if (is_unknown(o->methods, method_name, method_count))
        return bad_usage("no such method in ", o->methods);
    return -1;
}

int main(int argc, char **argv)
{
    struct options o = {NULL, NULL, NULL, 256, false};
    int status = parse(&o, argc, argv);
    if (status < 0) {
        status = measure_all(&o) != 0;
        if (o.check && status == 0) {
            check_bounds();
            status = tap_done();
        }
    }
    stage_close();
    return status;
}
