/* SPDX-License-Identifier: MIT */
/* Settings to the core's scene, in pool space and fixed point. */
#include "scene_file.h"

#include <math.h>
#include <string.h>

#include "noises.h"
#include "scene_keys.h"
#include "scene_light.h"

/* Nats per octave, when bilateral15 is chosen and nothing else said: surfaces
 * a sixteenth of an octave apart (4 % of their distance) count for 1/e. */
#define BILATERAL_FALLOFF 16

static uint64_t q32(double v)
{
    return (uint64_t)floor(v * 4294967296.0 + 0.5);
}

static uint32_t q16(double v)
{
    return (uint32_t)floor(v * 65536.0 + 0.5);
}

/* The words of history_bits. */
static uint8_t history_bits(double word)
{
    return word > 0 ? 16 : 8;
}

static int apply_point(const struct scene_settings *s, int key,
                       const struct volume_file *file, int32_t out[3],
                       char *err, size_t err_size)
{
    double pool[3];
    if (!s->set[key])
        return 0;
    volume_file_to_pool(file, s->value[key], pool);
    for (int i = 0; i < 3; i++) {
        if (!(fabs(pool[i]) <= BRUME_MAX_COORDINATE / 65536.0)) {
            snprintf(err, err_size,
                     "%s: %s is %.0f voxels from the volume's corner, at most "
                     "%d can be reached",
                     s->where[key], scene_keys[key].name, fabs(pool[i]),
                     BRUME_MAX_COORDINATE >> 16);
            return -1;
        }
        out[i] = (int32_t)floor(pool[i] * 65536.0 + 0.5);
    }
    return 0;
}

int scene_direction(const struct volume_file *file, const double v[3],
                    int32_t out[3])
{
    double pool[3];
    volume_file_direction(file, v, pool);
    double length =
        sqrt(pool[0] * pool[0] + pool[1] * pool[1] + pool[2] * pool[2]);
    if (!(length > 0) || !isfinite(length))
        return -1;
    for (int i = 0; i < 3; i++)
        out[i] = (int32_t)floor(pool[i] / length * 1073741824.0 + 0.5);
    return 0;
}

bool scene_is_rotated(const struct volume_file *file)
{
    const double *m = file->world_from_index;
    return m[1] != 0 || m[2] != 0 || m[4] != 0 || m[6] != 0 || m[8] != 0 ||
           m[9] != 0 || !(m[0] > 0 && m[5] > 0 && m[10] > 0);
}

/* The sun's angles are in world axes: the core's own direction, unless the
 * volume is turned. */
static int apply_sun(const struct scene_settings *s,
                     const struct volume_file *file, struct brume_scene *out)
{
    const double *a = s->value[SCENE_SUN];
    int32_t angles[2] = {-60 * 65536, 30 * 65536}, q30[3];
    double v[3];
    if (s->set[SCENE_SUN])
        for (int i = 0; i < 2; i++)
            angles[i] = (int32_t)floor(a[i] * 65536.0 + 0.5);
    brume_direction(q30, angles[0], angles[1]);
    if (!scene_is_rotated(file)) {
        memcpy(out->sun, q30, sizeof q30);
        return 0;
    }
    for (int i = 0; i < 3; i++)
        v[i] = q30[i];
    return scene_direction(file, v, out->sun);
}

/* Nothing said, and axes like the world's: the core's own default, to the
 * bit. */
static int apply_up(const struct scene_settings *s,
                    const struct volume_file *file, struct brume_scene *out,
                    char *err, size_t err_size)
{
    static const double k_up[3] = {0, 1, 0};
    const double *up = s->set[SCENE_UP] ? s->value[SCENE_UP] : k_up;
    if ((!s->set[SCENE_UP] && !scene_is_rotated(file)) ||
        scene_direction(file, up, out->up) == 0)
        return 0;
    snprintf(err, err_size, "%s: up has no direction", s->where[SCENE_UP]);
    return -1;
}

/* The default camera is set in pool axes; in a turned volume it is moved so
 * that it looks the same way in world axes, from where a sphere around the box
 * fits 40 degrees, or as far as the core's limits allow. */
static void turn_camera(const struct volume_file *file, struct brume_scene *s)
{
    double from[3], away[3], length = 0, square = 0;
    for (int i = 0; i < 3; i++) {
        double side = file->volume.box_max[i] - file->volume.box_min[i] + 2;
        from[i] = s->eye[i] - (double)s->target[i];
        length += from[i] * from[i];
        square += side * side;
    }
    volume_file_direction(file, from, away);
    /* 1 / sin 20 degrees, and half of the diagonal */
    double scale = sqrt(square / length) * 65536.0 * 2.93 / 2;
    scale *= file->voxel_size; /* which volume_file_direction divides by */
    for (int i = 0; i < 3; i++) {
        double room =
            BRUME_MAX_COORDINATE - (away[i] < 0 ? -1.0 : 1.0) * s->target[i];
        if (fabs(away[i]) * scale > room)
            scale = room / fabs(away[i]);
    }
    for (int i = 0; i < 3; i++)
        s->eye[i] = s->target[i] + (int32_t)floor(away[i] * scale);
}

/* Does the distance of its light samples double? */
static bool doubles(const struct brume_scene *scene)
{
    return scene->light == BRUME_LOG || scene->light == BRUME_CONE;
}

/* How many light steps n samples reach: docs/light.md. */
static double reach_of(const struct brume_scene *scene, int n)
{
    if (scene->light != BRUME_CONE)
        return ldexp(1, n);
    return n < 3 ? 4 * n : ldexp(n % 2 ? 4 : 5, (n + 1) / 2);
}

/* The core's default light is uniform; doubling steps start from a voxel and
 * go on until the distance passes the box's diagonal. */
static void default_light(const struct scene_settings *s,
                          const struct volume_file *file,
                          struct brume_scene *out)
{
    double square = 0;
    if (!s->set[SCENE_LIGHT] || !doubles(out))
        return;
    if (!s->set[SCENE_LIGHT_STEP])
        out->light_step = q16(1);
    for (int i = 0; i < 3; i++) {
        double side = file->volume.box_max[i] - file->volume.box_min[i] + 1;
        square += side * side;
    }
    double steps = sqrt(square) * 65536.0 / out->light_step;
    int n = 1;
    while (n < BRUME_MAX_LOG_SAMPLES && reach_of(out, n) < steps)
        n++;
    if (!s->set[SCENE_LIGHT_SAMPLES])
        out->light_samples = (uint16_t)n;
}

/* What the choice of one key says about others that were not set. */
static void default_passes(const struct scene_settings *s,
                           struct brume_scene *out)
{
    bool moves = out->temporal == BRUME_WINDOW || out->temporal == BRUME_TAA;
    if (!s->set[SCENE_HISTORY_BITS])
        out->history_bits = 16;
    if (!s->set[SCENE_SUBPIXEL])
        out->subpixel = moves;
    if (!s->set[SCENE_EDGE_FALLOFF] && out->spatial == BRUME_BILATERAL15)
        out->edge_falloff = q16(BILATERAL_FALLOFF);
}

static void apply_numbers(const struct scene_settings *s,
                          struct brume_scene *out)
{
#define SET(key, field, value_of) \
    if (s->set[key]) \
    out->field = value_of(s->value[key][0])
    SET(SCENE_FOV, fov, q16);
    SET(SCENE_DENSITY_SCALE, density_scale, q32);
    SET(SCENE_LIGHT_DENSITY_SCALE, light_density_scale, q32);
    SET(SCENE_ALBEDO, albedo, q16);
    SET(SCENE_STEP, step, q16);
    SET(SCENE_MIN_DENSITY, min_density, q32);
    SET(SCENE_MIN_TRANSMITTANCE, min_transmittance, q16);
    SET(SCENE_MAX_DENSITY, max_density, q32);
    SET(SCENE_FILTER, filter, (uint8_t));
    SET(SCENE_LIGHT, light, (uint8_t));
    SET(SCENE_LIGHT_SAMPLES, light_samples, (uint16_t));
    SET(SCENE_LIGHT_STEP, light_step, q16);
    SET(SCENE_JITTER, jitter, (uint8_t));
    SET(SCENE_FRAME, frame, (uint32_t));
    SET(SCENE_OUTPUT, output, (uint8_t));
    SET(SCENE_SKIP, skip, (bool));
    SET(SCENE_TEMPORAL, temporal, (uint8_t));
    SET(SCENE_HISTORY_BITS, history_bits, history_bits);
    SET(SCENE_WINDOW, window, (uint8_t));
    SET(SCENE_ALPHA, alpha, q16);
    SET(SCENE_FETCH, fetch, (uint8_t));
    SET(SCENE_CLAMP, clamp, (uint8_t));
    SET(SCENE_GAMMA, gamma, q16);
    SET(SCENE_SPATIAL, spatial, (uint8_t));
    SET(SCENE_EDGE_FALLOFF, edge_falloff, q16);
    SET(SCENE_RESOLUTION, resolution, (uint8_t));
    SET(SCENE_UPDATE, update, (uint8_t));
    SET(SCENE_UPSAMPLE, upsample, (uint8_t));
    SET(SCENE_SUBPIXEL, subpixel, (bool));
    SET(SCENE_CUT, cut, (bool));
#undef SET
    if (s->set[SCENE_NOISE] && s->noise_file == NULL)
        noise_choose((unsigned)s->value[SCENE_NOISE][0], out);
    if (s->set[SCENE_NOISE] && s->noise_file != NULL) {
        out->noise = BRUME_NOISE_TABLE;
        out->noise_table = s->noise_file;
    }
    if (s->set[SCENE_SIZE]) {
        out->width = (uint16_t)s->value[SCENE_SIZE][0];
        out->height = (uint16_t)s->value[SCENE_SIZE][1];
    }
    for (int i = 0; s->set[SCENE_BACKGROUND] && i < 3; i++)
        out->background[i] = q16(s->value[SCENE_BACKGROUND][i]);
}

/* For callers that keep no memory for lighting. */
static int refuse_light(const struct scene_settings *s, char *err,
                        size_t err_size)
{
    for (int key = SCENE_LIGHT_FIRST; key < SCENE_KEYS; key++)
        if (s->set[key]) {
            snprintf(err, err_size, "%s: no %s here", s->where[key],
                     scene_keys[key].name);
            return -1;
        }
    return 0;
}

/* What the core counts as no density at all, with the name of the key. A clamp
 * that Q32.32 rounds to 0 would even be none. */
static int check_clamp(const struct scene_settings *s,
                       const struct volume_file *file,
                       const struct brume_scene *scene, char *err,
                       size_t err_size)
{
    const struct brume_number most = file->volume.density_max;
    double limit = s->value[SCENE_MAX_DENSITY][0];
    double code = ldexp(most.m, most.e) / BRUME_RANGE_TOP;
    if (!s->set[SCENE_MAX_DENSITY] || limit == 0 ||
        (limit >= code && scene->max_density != 0))
        return 0;
    snprintf(err, err_size,
             "%s: max_density is %g, and must be 0 or at least 1/65280 of "
             "the volume's largest density, %g",
             s->where[SCENE_MAX_DENSITY], limit, code);
    return -1;
}

int scene_apply(const struct scene_settings *settings,
                const struct volume_file *file, struct brume_scene *scene,
                struct scene_light *light, char *err, size_t err_size)
{
    const struct scene_settings *s = settings;
    brume_scene_default(scene, &file->volume);
    apply_numbers(s, scene);
    default_light(s, file, scene);
    default_passes(s, scene);
    if (scene_is_rotated(file))
        turn_camera(file, scene);
    if (apply_point(s, SCENE_EYE, file, scene->eye, err, err_size) != 0 ||
        apply_point(s, SCENE_TARGET, file, scene->target, err, err_size) != 0 ||
        apply_up(s, file, scene, err, err_size) != 0 ||
        apply_sun(s, file, scene) != 0 ||
        check_clamp(s, file, scene, err, err_size) != 0)
        return -1;
    if (doubles(scene) && scene->light_samples > BRUME_MAX_LOG_SAMPLES) {
        snprintf(err, err_size, "%s: light_samples is %d, %s takes up to %d",
                 s->where[SCENE_LIGHT_SAMPLES], scene->light_samples,
                 scene->light == BRUME_LOG ? "log" : "cone",
                 BRUME_MAX_LOG_SAMPLES);
        return -1;
    }
    if (memcmp(scene->eye, scene->target, sizeof scene->eye) == 0) {
        const int key = s->set[SCENE_EYE] ? SCENE_EYE : SCENE_TARGET;
        snprintf(err, err_size, "%s: eye and target are the same",
                 s->where[key]);
        return -1;
    }
    if (light == NULL)
        return refuse_light(s, err, err_size);
    return scene_light_apply(s, file, scene, light, err, err_size);
}
