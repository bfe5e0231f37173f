/* SPDX-License-Identifier: MIT */
/* Phase functions: text, values, models. */
#include "scene_phase.h"

#include <math.h>
#include <string.h>

#include "droplet.h"
#include "scene_keys.h"

enum phase { ISOTROPIC, HG, SCHLICK, DRAINE, DROPLET, MIX, PHASES };

/* A parameter: its name and range. */
struct parameter {
    const char *name;
    double min, max;
};
#define G \
    { \
        "G", -0.999, 0.999 \
    }
#define ALPHA \
    { \
        "ALPHA", 0, 1024 \
    }

const char scene_phase_words[] =
    "isotropic hg:G schlick:G draine:ALPHA,G droplet:MICROMETRES "
    "mix:WEIGHT,ALPHA,G_DRAINE,G";

static const struct {
    const char *name;
    int count;
    struct parameter parameter[SCENE_VALUES - 1];
} k_phase[PHASES] = {
    {"isotropic", 0, {{NULL, 0, 0}}},
    {"hg", 1, {G}},
    {"schlick", 1, {G}},
    {"draine", 2, {ALPHA, G}},
    {"droplet", 1, {{"MICROMETRES", DROPLET_MIN, DROPLET_MAX}}},
    {"mix", 4, {{"WEIGHT", 0, 1}, ALPHA, {"G_DRAINE", -0.999, 0.999}, G}},
};

/// Text ///

static int phase_of(const char *name, size_t length)
{
    for (int i = 0; i < PHASES; i++)
        if (strlen(k_phase[i].name) == length &&
            strncmp(k_phase[i].name, name, length) == 0)
            return i;
    return -1;
}

static int check_range(int phase, const double *value, const char *where,
                       char *err, size_t err_size)
{
    for (int i = 0; i < k_phase[phase].count; i++) {
        const struct parameter *p = &k_phase[phase].parameter[i];
        if (value[i] >= p->min && value[i] <= p->max)
            continue;
        snprintf(err, err_size, "%s: phase: %s of %s is %g, outside %g to %g",
                 where, p->name, k_phase[phase].name, value[i], p->min, p->max);
        return -1;
    }
    return 0;
}

int scene_phase_read(const char *text, double out[SCENE_VALUES],
                     const char *where, char *err, size_t err_size)
{
    double value[SCENE_VALUES] = {0};
    size_t length = strcspn(text, ":");
    int phase = phase_of(text, length);
    bool good = phase >= 0;
    if (good && k_phase[phase].count > 0)
        good =
            text[length] == ':' &&
            scene_read_numbers(text + length + 1, value + 1, SCENE_VALUES - 1,
                               '\0') == k_phase[phase].count;
    else if (good)
        good = text[length] == '\0';
    if (!good) {
        snprintf(err, err_size, "%s: phase is one of %s, not '%.40s'", where,
                 scene_phase_words, text);
        return -1;
    }
    if (check_range(phase, value + 1, where, err, err_size) != 0)
        return -1;
    value[0] = phase;
    memcpy(out, value, sizeof value);
    return 0;
}

void scene_phase_print(FILE *to, const double value[SCENE_VALUES])
{
    int phase = (int)value[0];
    fputs(k_phase[phase].name, to);
    for (int i = 0; i < k_phase[phase].count; i++) {
        fputc(i == 0 ? ':' : ',', to);
        scene_print_number(to, value[1 + i]);
    }
}

/// Models ///

bool scene_phase_is_isotropic(const double value[SCENE_VALUES])
{
    return (int)value[0] == ISOTROPIC;
}

static int32_t q30(double g)
{
    return (int32_t)floor(g * 1073741824.0 + 0.5);
}

static uint32_t q16(double v)
{
    return (uint32_t)floor(v * 65536.0 + 0.5);
}

static void mix(struct brume_phase_model *out, double weight, double alpha,
                double draine_g, double g)
{
    out->kind = BRUME_PHASE_MIX;
    out->weight = q16(weight);
    out->draine_alpha = q16(alpha);
    out->draine_g = q30(draine_g);
    out->g = q30(g);
}

bool scene_phase_model(const double value[SCENE_VALUES],
                       struct brume_phase_model *out)
{
    const double *p = value + 1;
    memset(out, 0, sizeof *out);
    switch ((enum phase)(int)value[0]) {
    case HG: mix(out, 0, 0, 0, p[0]); return true;
    case DRAINE: mix(out, 1, p[0], p[1], 0); return true;
    case MIX: mix(out, p[0], p[1], p[2], p[3]); return true;
    case SCHLICK:
        out->kind = BRUME_PHASE_SCHLICK;
        out->g = q30(p[0]);
        return true;
    case DROPLET: {
        struct droplet fit = droplet_fit(p[0]);
        mix(out, fit.weight, fit.alpha, fit.g_draine, fit.g_hg);
        return true;
    }
    default: return false;
    }
}
