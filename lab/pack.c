/* SPDX-License-Identifier: MIT */
/* A scene, and the picture of its last frame, for a target to repeat. */
#include <stdlib.h>
#include <string.h>

#include "lab.h"
#include "sun_cache.h"
#include "target/record.h"

struct words {
    uint32_t word[RECORD_HEAD + RECORD_SCENE];
    size_t count;
};

static void put(struct words *to, uint32_t word)
{
    to->word[to->count++] = word;
}

#define PUT_ONE(field) put(w, (uint32_t)from->field)
#define PUT_THREE(field) \
    for (int i = 0; i < 3; i++) \
    put(w, (uint32_t)from->field[i])
#define PUT_LONG(field) \
    put(w, (uint32_t)from->field), put(w, (uint32_t)(from->field >> 32))

static void put_scene(struct words *w, const struct brume_scene *from)
{
    RECORD_SCENE_FIELDS(PUT_ONE, PUT_THREE, PUT_LONG);
}

static void put_light(struct words *w, const struct brume_lighting *from)
{
    put(w, from != NULL);
    if (from == NULL)
        return;
    RECORD_LIGHT_FIELDS(PUT_ONE, PUT_THREE, PUT_LONG);
}

/* The table's head; how many bytes of values follow the words. */
static size_t put_noise(struct words *w, const struct brume_noise_table *from)
{
    put(w, from != NULL);
    if (from == NULL)
        return 0;
    RECORD_NOISE_FIELDS(PUT_ONE, PUT_THREE, PUT_LONG);
    const unsigned log2 =
        (unsigned)from->width_log2 + from->height_log2 + from->frames_log2;
    return ((size_t)1 << log2) * from->bits / 8;
}

static bool can_pack(const struct brume_scene *scene)
{
    const struct brume_lighting *l = scene->lighting;
    return l == NULL || (scene->light == BRUME_CACHE && l->phase == NULL &&
                         l->ambient == BRUME_AMBIENT_NONE && !l->sky &&
                         !l->dither && l->haze == 0 && l->fog == NULL &&
                         l->lamp_count == 0 && l->surface == NULL &&
                         l->sun_map == NULL && l->emission_colour == NULL);
}

static int write_record(const struct brume_scene *scene, uint32_t frames,
                        uint32_t crc, char *err, size_t err_size)
{
    static const uint8_t padding[4];
    struct words w = {{RECORD_MAGIC, 0, frames, crc}, RECORD_HEAD};
    put_scene(&w, scene);
    put_light(&w, scene->lighting);
    const size_t noise = put_noise(&w, scene->noise_table);
    const size_t head = w.count * sizeof *w.word, pad = -noise & 3u;
    w.word[1] = (uint32_t)(head + noise + pad);
    if (fwrite(w.word, 1, head, stdout) == head &&
        (noise == 0 ||
         fwrite(scene->noise_table->values, 1, noise, stdout) == noise) &&
        fwrite(padding, 1, pad, stdout) == pad && fflush(stdout) == 0)
        return 0;
    snprintf(err, err_size, "cannot write the record");
    return 1;
}

/// Frames ///

struct packed {
    struct volume_file file;
    struct scene_light light;
    struct sun_cache sun;
    struct renderer *renderer;
    uint8_t *picture;
};

static int draw(struct packed *p, const struct lab_options *o, uint32_t frame,
                struct brume_scene *scene, char *err, size_t err_size)
{
    struct scene_settings settings = o->settings;
    settings.set[SCENE_FRAME] = true;
    settings.value[SCENE_FRAME][0] = frame;
    if (scene_apply(&settings, &p->file, scene, &p->light, err, err_size) != 0)
        return 2;
    scene->output = BRUME_LINEAR;
    const size_t row = brume_row_bytes(BRUME_L16, scene->width);
    if (p->picture == NULL)
        p->picture = malloc(row * scene->height);
    if (p->picture == NULL) {
        snprintf(err, err_size, "not enough memory");
        return 2;
    }
    const struct render_target target = {BRUME_L16, p->picture, row, NULL};
    if (sun_cache_prepare(&p->sun, p->renderer, &p->file.volume, scene,
                          &p->light, err, err_size) != 0 ||
        renderer_draw(p->renderer, scene, &target, err, err_size) != 0)
        return 2;
    return 0;
}

/* Frames from 0 on: o->last is the last one. */
static int pack(struct packed *p, const struct lab_options *o, char *err,
                size_t err_size)
{
    struct brume_scene scene = {0};
    int status = 0;
    if (volume_file_open(&p->file, o->volume, err, err_size) != 0)
        return 2;
    p->renderer = renderer_new(1, o->kernel);
    if (p->renderer == NULL) {
        snprintf(err, err_size, "not enough memory");
        return 2;
    }
    renderer_volume(p->renderer, &p->file.volume);
    for (uint32_t f = 0; f <= o->last && status == 0; f++)
        status = draw(p, o, f, &scene, err, err_size);
    if (status != 0)
        return status;
    if (!can_pack(&scene)) {
        snprintf(err, err_size, "a scene with this lighting is not packed");
        return 2;
    }
    return write_record(
        &scene, o->last + 1,
        record_crc(
            p->picture,
            (uint32_t)(brume_row_bytes(BRUME_L16, scene.width) * scene.height)),
        err, err_size);
}

int lab_pack(const struct lab_options *o, char *err, size_t err_size)
{
    struct packed *p = calloc(1, sizeof *p);
    if (p == NULL) {
        snprintf(err, err_size, "not enough memory");
        return 2;
    }
    int status = pack(p, o, err, err_size);
    renderer_free(p->renderer);
    sun_cache_free(&p->sun);
    volume_file_close(&p->file);
    free(p->picture);
    free(p);
    return status;
}
