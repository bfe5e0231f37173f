/* SPDX-License-Identifier: MIT */
/* brume-noise: makes and judges noise textures. */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "image.h"
#include "measure.h"
#include "nrooks.h"
#include "options.h"
#include "spectrum.h"
#include "table_file.h"
#include "values.h"

#define ERROR_SIZE 512

/// Progress ///

static void show_progress(uint64_t done, uint64_t all)
{
    static unsigned last = 101;
    unsigned percent = all ? (unsigned)(100 * done / all) : 100;

    if (percent == last)
        return;
    last = percent;
    if (percent < 100)
        fprintf(stderr, "\r%3u %%", percent);
    else
        fputs("\r     \r", stderr);
}

/// Judging ///

static int draw_spectrum(const struct noise_texture *t, const char *path,
                         char *err)
{
    struct image image;

    if (noise_spectrum(t, &image, err, ERROR_SIZE))
        return -1;
    int result = image_write(path, &image, err, ERROR_SIZE);
    image_free(&image);
    return result;
}

/* From slices after each other and, when there are several values, from R2
 * offsets in one slice. */
static int print_steady(const struct noise_texture *t, const char *name,
                        uint32_t values, char *err)
{
    static const char *const sources[] = {"slices", "R2 offsets"};
    struct values_measures m;

    printf("| texture | values | from | RMSE, one frame | EMA | + gauss1 |\n"
           "|---|---|---|---|---|---|\n");
    for (int i = 0; i < (values > 1 ? 2 : 1); i++) {
        if (!values_measure(&m, t, values, (enum values_source)i)) {
            snprintf(err, ERROR_SIZE, "%s: not enough memory", name);
            return -1;
        }
        printf("| %s | %u | %s | %.3f | %.3f | %.3f |\n", name, values,
               sources[i], m.frame, m.ema, m.gauss);
    }
    return 0;
}

static int print_measures(const struct noise_texture *t, const char *name,
                          char *err)
{
    struct noise_measures m;

    if (!noise_measure(t, &m)) {
        snprintf(err, ERROR_SIZE, "%s: not enough memory", name);
        return -1;
    }
    noise_measure_head(stdout);
    noise_measure_row(stdout, name, &m);
    return 0;
}

static int print_bands(const struct noise_texture *t, const char *name,
                       char *err)
{
    double energy[MEASURE_FILTERS];

    if (!noise_pass_band(t, energy)) {
        snprintf(err, ERROR_SIZE, "%s: not enough memory", name);
        return -1;
    }
    printf("| texture | in the band of EMA | x gauss1 | x bin3 | x box3 | "
           "x box5 |\n|---|---|---|---|---|---|\n| %s |",
           name);
    for (int i = 0; i < MEASURE_FILTERS; i++)
        printf(" %.4f |", energy[i]);
    putchar('\n');
    return 0;
}

/* What was asked for, after -o; measures are for one value per pixel. */
static int judge(const struct noise_texture *t, const struct options *o,
                 const char *name, char *err)
{
    uint32_t values = o->job.kernel.values;
    bool measure = o->measure || o->action == ACTION_MEASURE;
    int result = 0;

    if (o->bands)
        result = print_bands(t, name, err);
    if (!result && o->spectrum)
        result = draw_spectrum(t, o->spectrum, err);
    if (!result && (o->steady || (measure && values > 1)))
        result = print_steady(t, name, values, err);
    if (!result && measure && values == 1)
        result = print_measures(t, name, err);
    return result;
}

static int measure_file(const struct options *o, char *err)
{
    struct noise_texture t;

    if (noise_texture_read(&t, o->input, o->job.width, o->job.height,
                           o->job.frames, 1, err, ERROR_SIZE))
        return -1;
    int result = judge(&t, o, o->input, err);
    noise_texture_free(&t);
    return result;
}

static int print_space_loss(const struct noise_texture *t,
                            const struct options *o, char *err)
{
    double loss;

    if (noise_space_measure(t, &o->job, &loss, err, ERROR_SIZE))
        return -1;
    printf("| texture | loss |\n|---|---|\n| %s | %.4f |\n",
           o->command + sizeof "brume-noise", loss);
    return 0;
}

/// Making ///

static int write_rooks(const struct options *o, char *err)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    int result = -1;

    if (!out || noise_nrooks_write(out, o->command) | fclose(out))
        snprintf(err, ERROR_SIZE, "%s: not enough memory", o->output);
    else
        result = noise_file_write(o->output, text, size, err, ERROR_SIZE);
    free(text);
    return result;
}

/* Four bits are stored; the others are Bayer's matrix of side 4 at the pixel,
 * by formula, the same in every frame. Without them 16 thresholds would be all
 * that a table can tell apart. */
static void quantise(struct noise_texture *t)
{
    for (size_t i = 0; i < noise_texture_bytes(t); i++) {
        uint32_t x = (uint32_t)i & (t->width - 1);
        uint32_t y = (uint32_t)(i / t->width) & (t->height - 1), d = x ^ y;
        uint32_t bayer =
            (d & 1u) << 3 | (y & 1u) << 2 | (d & 2u) | (y & 2u) >> 1;
        t->values[i] = (uint8_t)((t->values[i] & 0xf0u) | bayer);
    }
}

static int make(struct options *o, char *err)
{
    struct noise_texture t;
    int result = 0;

    if (isatty(STDERR_FILENO))
        o->job.progress = show_progress;
    if (noise_generate(&t, &o->job, err, ERROR_SIZE))
        return -1;
    if (o->bits == 4)
        quantise(&t);
    if (o->output)
        result = table_file_write(&t, o->job.space, o->output, o->bits,
                                  o->command, err, ERROR_SIZE);
    if (!result && t.channels == 1)
        result = judge(&t, o, o->command + sizeof "brume-noise", err);
    else if (!result && o->measure)
        result = print_space_loss(&t, o, err);
    noise_texture_free(&t);
    return result;
}

static int list(void)
{
    for (uint32_t i = 0; i < noise_name_count; i++)
        printf("%-14s %s\n", noise_names[i].name, noise_names[i].text);
    return 0;
}

static int run(struct options *o, char *err)
{
    switch (o->action) {
    case ACTION_HELP: return fputs(options_help, stdout) < 0 ? -1 : 0;
    case ACTION_LIST: return list();
    case ACTION_MEASURE: return measure_file(o, err);
    default:
        return noise_is_rooks(&o->job) ? write_rooks(o, err) : make(o, err);
    }
}

int main(int argc, char **argv)
{
    struct options o;
    char err[ERROR_SIZE] = "";

    if (options_parse(&o, argc, argv, err, sizeof err)) {
        fprintf(stderr, "brume-noise: %s\n", err);
        return 2;
    }
    int result = run(&o, err);
    if (!result && (fflush(stdout) || ferror(stdout))) {
        snprintf(err, sizeof err, "standard output: cannot write");
        result = -1;
    }
    if (!result)
        return 0;
    fprintf(stderr, "brume-noise: %s\n", err);
    return 1;
}
