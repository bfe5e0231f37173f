/* SPDX-License-Identifier: MIT */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lab.h"
#include "panel.h"
#include "pattern.h"
#include "profile.h"
#include "scene_light.h"
#include "sun_cache.h"

/* While it is drawn. Pictures of two frames are kept, for what changes. */
struct run {
    const struct lab_options *options;
    struct volume_file file;
    struct path *path;
    struct scene_light light;
    struct sun_cache sun;
    struct renderer *renderer;
    int format; /* enum brume_pixel_format */
    void *packed;
    struct image pictures[2], truths[LAB_MOST][2];
    struct image sum; /* of all frames, for --mean */
    double *sums;
    struct lab_spectrum spectrum;
    double ms;
    FILE *rows;
    char *err;
    size_t err_size;
};

static int fail(struct run *r, const char *what)
{
    snprintf(r->err, r->err_size, "%s", what);
    return 2;
}

/// Scenes ///

static int scene_of(struct run *r, uint32_t frame, struct brume_scene *scene)
{
    struct scene_settings settings = r->options->settings;
    settings.set[SCENE_FRAME] = true;
    settings.value[SCENE_FRAME][0] =
        r->options->cycle ? frame % r->options->cycle : frame;
    if (r->path != NULL)
        path_apply(r->path, frame, &settings);
    if (scene_apply(&settings, &r->file, scene, &r->light, r->err,
                    r->err_size) != 0)
        return 2;
    if (r->options->pixels < 0)
        scene->output = BRUME_LINEAR;
    return 0;
}

static bool has_colour(const struct run *r, const struct brume_scene *scene)
{
    const uint32_t *b = scene->background;
    if (scene->lighting != NULL && scene_light_has_colour(&r->light))
        return true;
    return !(scene->lighting != NULL && scene->lighting->sky) &&
           (b[0] != b[1] || b[1] != b[2]);
}

/// Pictures ///

static int new_pictures(struct run *r, const struct brume_scene *scene)
{
    const int panel = r->options->pixels;
    const bool colour = has_colour(r, scene);
    const int w = scene->width, h = scene->height;
    int channels = panel < 0 ? (colour ? 3 : 1) : panel_channels(panel);
    r->format = panel >= 0 ? panel : colour ? BRUME_RGB161616 : BRUME_L16;
    for (int i = 0; i < 2; i++)
        if (panel < 0 ? image_new_f32(&r->pictures[i], w, h, channels, r->err,
                                      r->err_size) != 0
                      : image_new_u8(&r->pictures[i], w, h, channels, r->err,
                                     r->err_size) != 0)
            return 2;
    r->packed = malloc(brume_row_bytes(r->format, scene->width) *
                       (size_t)scene->height);
    if (r->options->mean != NULL || r->options->cumulative) {
        if (image_new_f32(&r->sum, w, h, channels, r->err, r->err_size) != 0)
            return 2;
        r->sums = calloc(image_samples(&r->sum), sizeof *r->sums);
    }
    if (r->packed == NULL || (r->sum.f32 != NULL && r->sums == NULL))
        return fail(r, "not enough memory");
    return 0;
}

static int draw(struct run *r, const struct brume_scene *scene,
                struct image *to)
{
    const struct render_target target = {
        r->format, r->packed, brume_row_bytes(r->format, scene->width), NULL};
    const uint16_t *wide = r->packed;
    double start = profile_process();
    if (scene->width != to->width || scene->height != to->height)
        return fail(r, "a path cannot change the size");
    if (sun_cache_prepare(&r->sun, r->renderer, &r->file.volume, scene,
                          &r->light, r->err, r->err_size) != 0 ||
        renderer_draw(r->renderer, scene, &target, r->err, r->err_size) != 0)
        return 2;
    r->ms = 1000 * (profile_process() - start);
    if (r->options->pixels >= 0)
        panel_expand(r->format, r->packed, to);
    else
        for (size_t i = 0; i < image_samples(to); i++)
            to->f32[i] = (float)(wide[i] / 65535.0);
    for (size_t i = 0; r->sums != NULL && i < image_samples(to); i++)
        r->sums[i] += to->f32 ? (double)to->f32[i] : to->u8[i] / 255.0;
    return 0;
}

/* In place of the frame, the mean of all so far. */
static void accumulate(struct run *r, uint32_t frame)
{
    struct image *to = &r->pictures[frame & 1];
    const double n = (double)(frame - r->options->first) + 1;
    for (size_t i = 0; i < image_samples(to); i++)
        to->f32[i] = (float)(r->sums[i] / n);
}

/* The truth of a frame; one that stays is read once. */
static int read_truth(struct run *r, int i, uint32_t frame)
{
    const struct lab_reference *ref = &r->options->references[i];
    const struct image *picture = &r->pictures[0];
    struct image *to = &r->truths[i][frame & 1];
    char name[PATTERN_SIZE];
    const char *path = ref->path;
    if (pattern_is(path)) {
        pattern_name(path, frame, name);
        path = name;
    } else if (to->f32 != NULL || to->u8 != NULL) {
        return 0;
    }
    return lab_read_truth(path, picture, to, r->err, r->err_size);
}

/// Rows ///

static int print_row(struct run *r, uint32_t frame, int ref, int region)
{
    const struct lab_options *o = r->options;
    const unsigned now = frame & 1, then = now ^ 1;
    const bool first = frame == o->first;
    const struct lab_pair pair = {&r->pictures[now], &r->truths[ref][now],
                                  first ? NULL : &r->pictures[then],
                                  first ? NULL : &r->truths[ref][then],
                                  o->flip};
    return lab_print_row(o, r->rows, frame, ref, region, &pair, r->ms, r->err,
                         r->err_size);
}

static bool has_rows(const struct lab_options *o, uint32_t frame)
{
    bool wanted = o->only_count == 0;
    for (int i = 0; i < o->only_count; i++)
        wanted |= o->only[i] == frame;
    return wanted && frame >= o->from;
}

static int add_spectrum(struct run *r, uint32_t frame)
{
    const struct lab_options *o = r->options;
    const struct lab_pair pair = {&r->pictures[frame & 1],
                                  &r->truths[0][frame & 1], NULL, NULL, false};
    if (o->spectrum == NULL || frame < o->from)
        return 0;
    if (lab_spectrum_add(&r->spectrum, &o->regions[o->region_count - 1],
                         &pair) != 0)
        return fail(r, "not enough memory");
    return 0;
}

static int one_frame(struct run *r, uint32_t frame)
{
    const struct lab_options *o = r->options;
    struct brume_scene scene;
    int status = scene_of(r, frame, &scene);
    if (status == 0)
        status = draw(r, &scene, &r->pictures[frame & 1]);
    if (status == 0 && o->cumulative)
        accumulate(r, frame);
    for (int i = 0; status == 0 && i < o->reference_count; i++) {
        status = read_truth(r, i, frame);
        if (!has_rows(o, frame))
            continue;
        for (int k = 0; status == 0 && k < o->region_count; k++)
            status = print_row(r, frame, i, k);
    }
    if (status == 0)
        status = add_spectrum(r, frame);
    return status;
}

/// Sequences ///

static int write_pictures(struct run *r)
{
    const struct lab_options *o = r->options;
    const double n = (double)(o->last - o->first) + 1;
    if (o->picture != NULL && image_write(o->picture, &r->pictures[o->last & 1],
                                          r->err, r->err_size) != 0)
        return 1;
    if (o->spectrum != NULL &&
        lab_spectrum_write(&r->spectrum, o, r->err, r->err_size) != 0)
        return 1;
    if (o->mean == NULL)
        return 0;
    for (size_t i = 0; i < image_samples(&r->sum); i++)
        r->sum.f32[i] = (float)(r->sums[i] / n);
    return image_write(o->mean, &r->sum, r->err, r->err_size) != 0;
}

static int prepare(struct run *r)
{
    const struct lab_options *o = r->options;
    struct brume_scene scene;
    for (int i = 0; i < o->reference_count; i++)
        if (pattern_is(o->references[i].path) &&
            pattern_check(o->references[i].path, r->err, r->err_size) != 0)
            return 2;
    if (volume_file_open(&r->file, o->volume, r->err, r->err_size) != 0)
        return 2;
    if (o->path != NULL &&
        (r->path = path_read(o->path, r->err, r->err_size)) == NULL)
        return 2;
    int status = scene_of(r, o->first, &scene);
    if (status == 0)
        status = new_pictures(r, &scene);
    if (status != 0)
        return status;
    r->renderer = renderer_new(o->threads, o->kernel);
    if (r->renderer == NULL)
        return fail(r, "not enough memory");
    renderer_volume(r->renderer, &r->file.volume);
    return 0;
}

static void clear(struct run *r)
{
    renderer_free(r->renderer);
    sun_cache_free(&r->sun);
    volume_file_close(&r->file);
    path_free(r->path);
    for (int i = 0; i < 2; i++) {
        image_free(&r->pictures[i]);
        for (int k = 0; k < LAB_MOST; k++)
            image_free(&r->truths[k][i]);
    }
    image_free(&r->sum);
    free(r->sums);
    free(r->spectrum.power);
    free(r->packed);
}

/* Rows are held back until the last frame is drawn: none are partial. */
int lab_sequence(const struct lab_options *o, char *err, size_t err_size)
{
    struct run *r = calloc(1, sizeof *r);
    char *text = NULL;
    size_t size = 0;
    FILE *rows = open_memstream(&text, &size);
    int status = 2;
    if (r == NULL || rows == NULL) {
        snprintf(err, err_size, "not enough memory");
    } else {
        r->options = o;
        r->rows = rows;
        r->err = err;
        r->err_size = err_size;
        status = prepare(r);
        lab_print_head(o, r->rows);
        for (uint32_t f = o->first; status == 0; f++) {
            status = one_frame(r, f);
            if (f == o->last)
                break;
        }
        if (status == 0)
            status = write_pictures(r);
        clear(r);
    }
    free(r);
    return lab_finish(rows, &text, &size, status, o->reference_count > 0, err,
                      err_size);
}
