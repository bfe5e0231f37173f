/* SPDX-License-Identifier: MIT */
/* The core's scene as text. */
#include "scene_file.h"

#include <math.h>
#include <string.h>

#include "noises.h"
#include "scene_keys.h"
#include "scene_light.h"

static void print_point(FILE *to, const char *name, const int32_t q[3],
                        const struct volume_file *file)
{
    double pool[3], world[3];
    for (int i = 0; i < 3; i++)
        pool[i] = q[i] / 65536.0;
    volume_file_to_world(file, pool, world);
    fprintf(to, "%s = %.17g,%.17g,%.17g\n", name, world[0], world[1], world[2]);
}

static void print_q32(FILE *to, int key, uint64_t value)
{
    fprintf(to, "%s = %.17g\n", scene_keys[key].name,
            fmin((double)value / 4294967296.0, scene_keys[key].max));
}

static void print_word(FILE *to, int key, unsigned value)
{
    fprintf(to, "%s = ", scene_keys[key].name);
    scene_print_word(to, scene_keys[key].words, value);
    fputc('\n', to);
}

/* A direction turned from pool to world axes. */
static void world_direction(const struct volume_file *file, const int32_t q[3],
                            double out[3])
{
    const double *m = file->world_from_index;
    for (int i = 0; i < 3; i++)
        out[i] = (m[4 * i] * q[0] + m[4 * i + 1] * q[1] + m[4 * i + 2] * q[2]) /
                 (file->voxel_size * 1073741824.0);
}

/* Over time and over the image. */
static void print_passes(FILE *to, const struct brume_scene *s)
{
    print_word(to, SCENE_TEMPORAL, s->temporal);
    print_word(to, SCENE_HISTORY_BITS, s->history_bits != 8);
    fprintf(to, "window = %d\n", s->window);
    fprintf(to, "alpha = %.9g\n", s->alpha / 65536.0);
    print_word(to, SCENE_FETCH, s->fetch);
    print_word(to, SCENE_CLAMP, s->clamp);
    fprintf(to, "gamma = %.9g\n", s->gamma / 65536.0);
    print_word(to, SCENE_SPATIAL, s->spatial);
    fprintf(to, "edge_falloff = %.9g\n", s->edge_falloff / 65536.0);
    print_word(to, SCENE_RESOLUTION, s->resolution);
    print_word(to, SCENE_UPDATE, s->update);
    print_word(to, SCENE_UPSAMPLE, s->upsample);
    print_word(to, SCENE_SUBPIXEL, s->subpixel);
    print_word(to, SCENE_CUT, s->cut);
}

void scene_print(FILE *to, const struct brume_scene *scene,
                 const struct scene_light *light,
                 const struct volume_file *file)
{
    const struct brume_scene *s = scene;
    const double degrees = 180 / 3.14159265358979323846;
    double v[3];
    fprintf(to, "size = %dx%d\n", s->width, s->height);
    print_point(to, "eye", s->eye, file);
    print_point(to, "target", s->target, file);
    world_direction(file, s->up, v);
    fprintf(to, "up = %.17g,%.17g,%.17g\n", v[0], v[1], v[2]);
    fprintf(to, "fov = %.9g\n", s->fov / 65536.0);
    world_direction(file, s->sun, v);
    fprintf(to, "sun = %.9g %.9g\n", atan2(v[0], v[2]) * degrees,
            atan2(v[1], sqrt(v[0] * v[0] + v[2] * v[2])) * degrees);
    print_q32(to, SCENE_DENSITY_SCALE, s->density_scale);
    print_q32(to, SCENE_LIGHT_DENSITY_SCALE, s->light_density_scale);
    fprintf(to, "albedo = %.9g\n", s->albedo / 65536.0);
    fprintf(to, "step = %.9g\n", s->step / 65536.0);
    print_q32(to, SCENE_MIN_DENSITY, s->min_density);
    fprintf(to, "min_transmittance = %.9g\n", s->min_transmittance / 65536.0);
    print_q32(to, SCENE_MAX_DENSITY, s->max_density);
    print_word(to, SCENE_FILTER, s->filter);
    print_word(to, SCENE_LIGHT, s->light);
    fprintf(to, "light_samples = %d\n", s->light_samples);
    fprintf(to, "light_step = %.9g\n", s->light_step / 65536.0);
    print_word(to, SCENE_JITTER, s->jitter);
    print_word(to, SCENE_NOISE, noise_number(s));
    fprintf(to, "frame = %lu\n", (unsigned long)s->frame);
    fprintf(to, "background = %.9g,%.9g,%.9g\n", s->background[0] / 65536.0,
            s->background[1] / 65536.0, s->background[2] / 65536.0);
    print_word(to, SCENE_OUTPUT, s->output);
    print_word(to, SCENE_SKIP, s->skip);
    print_passes(to, s);
    scene_light_print(to, light);
}
