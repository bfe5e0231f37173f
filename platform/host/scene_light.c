/* SPDX-License-Identifier: MIT */
/* Keys of light to the core's struct brume_lighting. */
#include "scene_light.h"

#include <math.h>
#include <string.h>

#include "brume_noise_tables.h"
#include "scene_air.h"
#include "scene_emission.h"
#include "scene_files.h"
#include "scene_keys.h"
#include "scene_lamps.h"
#include "scene_phase.h"

/// Values ///

/* What a key is when nobody says; 0 where it is not listed. */
#define GREY(v) \
    { \
        v, v, v \
    }
#define DEFAULT(key) [(key)-SCENE_LIGHT_FIRST]
static const double k_default[SCENE_LIGHT_KEYS][3] = {
    DEFAULT(SCENE_OCTAVES) = {1},
    DEFAULT(SCENE_OCTAVE_A) = {0.5},
    DEFAULT(SCENE_OCTAVE_B) = {0.5},
    DEFAULT(SCENE_OCTAVE_C) = {0.5},
    DEFAULT(SCENE_SUN_COLOUR) = GREY(1),
    DEFAULT(SCENE_EXPOSURE) = {1},
    DEFAULT(SCENE_AMBIENT_COLOUR) = GREY(0.3),
    DEFAULT(SCENE_AMBIENT_TOP) = GREY(0.3),
    DEFAULT(SCENE_AMBIENT_BOTTOM) = GREY(0.1),
    DEFAULT(SCENE_AMBIENT_PX) = GREY(0.2),
    DEFAULT(SCENE_AMBIENT_NX) = GREY(0.2),
    DEFAULT(SCENE_AMBIENT_PY) = GREY(0.3),
    DEFAULT(SCENE_AMBIENT_NY) = GREY(0.1),
    DEFAULT(SCENE_AMBIENT_PZ) = GREY(0.2),
    DEFAULT(SCENE_AMBIENT_NZ) = GREY(0.2),
    DEFAULT(SCENE_VISIBILITY_STEP) = {2},
    DEFAULT(SCENE_SKY_ZENITH) = {0.1, 0.22, 0.5},
    DEFAULT(SCENE_SKY_HORIZON) = {0.45, 0.55, 0.65},
    DEFAULT(SCENE_SKY_GROUND) = {0.12, 0.12, 0.11},
    DEFAULT(SCENE_SUN_DISC) = GREY(8),
    DEFAULT(SCENE_SUN_SIZE) = {0.27},
};

static const double *value_of(const struct scene_light *l, int key)
{
    return l->value[key - SCENE_LIGHT_FIRST];
}

static double diagonal_of(const struct volume_file *file)
{
    double square = 0;
    for (int i = 0; i < 3; i++) {
        double side = file->volume.box_max[i] - file->volume.box_min[i] + 1;
        square += side * side;
    }
    return sqrt(square);
}

/* Samples of doubling distance until it passes the box's diagonal. */
static double samples_across(const struct volume_file *file, double step)
{
    double n = ceil(log2(diagonal_of(file) / step));
    return fmin(fmax(n, 1), scene_keys[SCENE_VISIBILITY_SAMPLES].max);
}

/* An optical depth of 16 across the box of a quarter of the second grid's
 * largest value; 1 where it has none. */
static double scale_across(const struct volume_file *file)
{
    const struct brume_number most = file->volume.emission_max;
    double value = ldexp(most.m, most.e), scale;
    if (!(value > 0))
        return 1;
    scale = 16 / (value / 4 * diagonal_of(file));
    return fmin(scale, scene_keys[SCENE_EMISSION_SCALE].max);
}

static void fill_values(const struct scene_settings *s,
                        const struct volume_file *file, struct scene_light *l)
{
    for (int i = 0; i < SCENE_LIGHT_KEYS; i++) {
        int key = SCENE_LIGHT_FIRST + i;
        memset(l->value[i], 0, sizeof l->value[i]);
        if (s->set[key])
            memcpy(l->value[i], s->value[key], sizeof l->value[i]);
        else
            memcpy(l->value[i], k_default[i], sizeof k_default[i]);
    }
    if (!s->set[SCENE_VISIBILITY_SAMPLES])
        l->value[SCENE_VISIBILITY_SAMPLES - SCENE_LIGHT_FIRST][0] =
            samples_across(file, value_of(l, SCENE_VISIBILITY_STEP)[0]);
    if (!s->set[SCENE_EMISSION_SCALE])
        l->value[SCENE_EMISSION_SCALE - SCENE_LIGHT_FIRST][0] =
            scale_across(file);
    l->emission_file = s->emission_file;
    memcpy(l->file, s->file, sizeof l->file);
}

/* Do they say more than a scene without them? */
static bool says_something(const struct scene_light *l)
{
    static const int k_on[] = {SCENE_AMBIENT, SCENE_SKY,   SCENE_HAZE,
                               SCENE_DITHER,  SCENE_LAMPS, SCENE_EMISSION};
    const double *sun = value_of(l, SCENE_SUN_COLOUR);
    for (size_t i = 0; i < sizeof k_on / sizeof k_on[0]; i++)
        if (value_of(l, k_on[i])[0] > 0)
            return true;
    if (scene_air_says_something(l))
        return true;
    return !scene_phase_is_isotropic(value_of(l, SCENE_PHASE)) ||
           value_of(l, SCENE_OCTAVES)[0] > 1 ||
           value_of(l, SCENE_EXPOSURE)[0] != 1 || sun[0] != 1 || sun[1] != 1 ||
           sun[2] != 1;
}

/// Lighting ///

static uint32_t q16(double v)
{
    return (uint32_t)floor(v * 65536.0 + 0.5);
}

static uint32_t number_of(const struct scene_light *l, int key)
{
    return q16(value_of(l, key)[0]);
}

static void colour_of(const struct scene_light *l, int key, uint32_t out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = q16(value_of(l, key)[c]);
}

static int make_phase(struct scene_light *l, const char *where, char *err,
                      size_t err_size)
{
    struct brume_phase_model model;
    int error = BRUME_OK;
    l->lighting.phase = NULL;
    if (!scene_phase_model(value_of(l, SCENE_PHASE), &model))
        return 0;
    l->lighting.phase = l->phase;
    for (uint32_t i = 0; i < l->lighting.octaves && !error; i++)
        error = brume_phase_build(&l->phase[i], &model, i,
                                  number_of(l, SCENE_OCTAVE_C));
    if (error)
        snprintf(err, err_size, "%s: phase: %s", where,
                 brume_error_text(error));
    return error ? -1 : 0;
}

/* The six colours are said for the world's axes; the core's are the pool's. In
 * a turned volume an axis of the pool sees a mix of them, as a sample does. */
static void make_cube(const struct volume_file *file, struct scene_light *l)
{
    for (int axis = 0; axis < 3; axis++)
        for (int c = 0; c < 6; c++) {
            double sum = 0;
            for (int j = 0; j < 3; j++) {
                double u = file->world_from_index[4 * j + axis] /
                           file->voxel_size * (c < 3 ? 1 : -1);
                sum += u * u *
                       value_of(l, SCENE_AMBIENT_PX + 2 * j + (u < 0))[c % 3];
            }
            l->lighting.ambient_colour[2 * axis + c / 3][c % 3] =
                q16(fmin(sum, scene_keys[SCENE_AMBIENT_PX].max));
        }
}

static void make_ambient(const struct volume_file *file, struct scene_light *l)
{
    struct brume_lighting *out = &l->lighting;
    out->ambient = (uint8_t)value_of(l, SCENE_AMBIENT)[0];
    out->visibility = (uint8_t)value_of(l, SCENE_VISIBILITY)[0];
    out->visibility_samples = (uint8_t)value_of(l, SCENE_VISIBILITY_SAMPLES)[0];
    out->visibility_step = number_of(l, SCENE_VISIBILITY_STEP);
    out->directions = &brume_noise_hemisphere;
    if (out->ambient == BRUME_AMBIENT_CONSTANT)
        colour_of(l, SCENE_AMBIENT_COLOUR, out->ambient_colour[0]);
    if (out->ambient == BRUME_AMBIENT_GRADIENT) {
        colour_of(l, SCENE_AMBIENT_TOP, out->ambient_colour[0]);
        colour_of(l, SCENE_AMBIENT_BOTTOM, out->ambient_colour[1]);
    }
    if (out->ambient == BRUME_AMBIENT_CUBE)
        make_cube(file, l);
}

static void make_sky(struct scene_light *l)
{
    const double degree = 3.14159265358979323846 / 180;
    struct brume_lighting *out = &l->lighting;
    double half = sin(value_of(l, SCENE_SUN_SIZE)[0] * degree / 2);
    out->sky = value_of(l, SCENE_SKY)[0] > 0;
    colour_of(l, SCENE_SKY_ZENITH, out->sky_zenith);
    colour_of(l, SCENE_SKY_HORIZON, out->sky_horizon);
    colour_of(l, SCENE_SKY_GROUND, out->sky_ground);
    colour_of(l, SCENE_SUN_DISC, out->sun_disc);
    /* 1 - cos a = 2 sin^2 (a / 2), exact for small angles */
    out->sun_size = (uint32_t)floor(2 * half * half * 1073741824.0 + 0.5);
    out->haze = number_of(l, SCENE_HAZE);
    out->dither = value_of(l, SCENE_DITHER)[0] > 0;
}

static int make_lamps(const struct volume_file *file, struct scene_light *l,
                      char *err, size_t err_size)
{
    int count = scene_lamps_make(value_of(l, SCENE_LAMPS), file, l->lamps, err,
                                 err_size);
    if (count <= 0)
        return count;
    l->lighting.lamps = l->lamps;
    l->lighting.lamp_count = (uint32_t)count;
    l->lighting.clusters = &l->clusters;
    return 0;
}

/// Scenes ///

static void make_emission(struct scene_light *l)
{
    struct brume_lighting *out = &l->lighting;
    bool glows = scene_emission_colours(value_of(l, SCENE_EMISSION),
                                        l->emission_file, l->emission);
    double scale = value_of(l, SCENE_EMISSION_SCALE)[0];
    if (!glows)
        return;
    out->emission_colour = (const uint32_t(*)[3])l->emission;
    out->emission_scale = (uint64_t)floor(scale * 4294967296.0 + 0.5);
}

/* What the volume must hold for a word that was said. */
static int check_sections(const struct scene_settings *s,
                          const struct volume_file *file,
                          const struct brume_scene *scene,
                          const struct scene_light *l, char *err,
                          size_t err_size)
{
    bool baked = value_of(l, SCENE_VISIBILITY)[0] == BRUME_SKY_BAKED;
    if (scene->light == BRUME_CONE && file->volume.mips == NULL) {
        snprintf(err, err_size,
                 "%s: light = cone needs a volume that was baked with --mips",
                 s->where[SCENE_LIGHT]);
        return -1;
    }
    if (value_of(l, SCENE_EMISSION)[0] > 0 && file->volume.emission == NULL) {
        snprintf(err, err_size,
                 "%s: emission needs a volume that was baked with --emission",
                 s->where[SCENE_EMISSION]);
        return -1;
    }
    if (baked && value_of(l, SCENE_AMBIENT)[0] > 0 &&
        file->volume.sky == NULL) {
        snprintf(err, err_size,
                 "%s: visibility = baked needs a volume that was baked with "
                 "--sky-visibility",
                 s->where[SCENE_VISIBILITY]);
        return -1;
    }
    return 0;
}

int scene_light_apply(const struct scene_settings *settings,
                      const struct volume_file *file, struct brume_scene *scene,
                      struct scene_light *light, char *err, size_t err_size)
{
    static const double k_up[3] = {0, 1, 0};
    struct brume_lighting *out = &light->lighting;
    fill_values(settings, file, light);
    memset(out, 0, sizeof *out);
    scene->lighting = NULL;
    if (check_sections(settings, file, scene, light, err, err_size) != 0)
        return -1;
    if (!says_something(light) && scene->light != BRUME_CACHE)
        return 0;
    scene->lighting = out;
    out->octaves = (uint32_t)value_of(light, SCENE_OCTAVES)[0];
    out->octave_a = number_of(light, SCENE_OCTAVE_A);
    out->octave_b = number_of(light, SCENE_OCTAVE_B);
    out->exposure = number_of(light, SCENE_EXPOSURE);
    colour_of(light, SCENE_SUN_COLOUR, out->sun_colour);
    make_ambient(file, light);
    make_sky(light);
    make_emission(light);
    scene_direction(file, k_up, out->zenith);
    if (make_lamps(file, light, err, err_size) != 0 ||
        scene_air_apply(settings, file, scene, light, err, err_size) != 0)
        return -1;
    return make_phase(light, settings->where[SCENE_PHASE], err, err_size);
}

static bool is_grey(const uint32_t colour[3])
{
    return colour[0] == colour[1] && colour[1] == colour[2];
}

bool scene_light_has_colour(const struct scene_light *light)
{
    const struct brume_lighting *l = &light->lighting;
    bool grey = is_grey(l->sun_colour);
    for (int i = 0; i < 6; i++)
        grey = grey && is_grey(l->ambient_colour[i]);
    for (uint32_t i = 0; i < l->lamp_count; i++)
        grey = grey && is_grey(l->lamps[i].colour);
    for (int i = 0; i < 256 && l->emission_colour != NULL; i++)
        grey = grey && is_grey(l->emission_colour[i]);
    if (l->sky)
        grey = grey && is_grey(l->sky_zenith) && is_grey(l->sky_horizon) &&
               is_grey(l->sky_ground) &&
               (l->sun_size == 0 || is_grey(l->sun_disc));
    return !grey;
}

void scene_light_print(FILE *to, const struct scene_light *light)
{
    for (int key = SCENE_LIGHT_FIRST; key < SCENE_KEYS; key++) {
        const double *v = value_of(light, key);
        fprintf(to, "%s = ", scene_keys[key].name);
        switch (scene_keys[key].kind) {
        case SCENE_IS_PHASE: scene_phase_print(to, v); break;
        case SCENE_IS_LAMPS: scene_lamps_print(to, v); break;
        case SCENE_IS_FILE: {
            const struct scene_file_data *data =
                light->file[key - SCENE_FILE_FIRST];
            fputs(data != NULL ? data->path : "none", to);
            break;
        }
        case SCENE_IS_EMISSION:
            scene_emission_print(to, v, light->emission_file);
            break;
        case SCENE_IS_COLOUR:
            for (int c = 0; c < 3; c++) {
                fputs(c > 0 ? "," : "", to);
                scene_print_number(to, v[c]);
            }
            break;
        case SCENE_IS_WORD:
            scene_print_word(to, scene_keys[key].words, (unsigned)v[0]);
            break;
        default: scene_print_number(to, v[0]);
        }
        fputc('\n', to);
    }
}
