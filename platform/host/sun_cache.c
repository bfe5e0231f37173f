/* SPDX-License-Identifier: MIT */
#include "sun_cache.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A baked cache is of this sun when their directions are so near: the cosine
 * of a quarter of a degree. */
#define SAME_SUN 0.99999048

/* The section's head, docs/SPEC.md. */
#define HEAD_SPACING 0
#define HEAD_DIRECTION 4

/// Baked ///

static double get_q30(const uint8_t *p)
{
    uint32_t bits = p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 |
                    (uint32_t)p[3] << 24;
    int32_t q;
    memcpy(&q, &bits, sizeof q);
    return q / 1073741824.0;
}

/* Is the volume's own for the scene's sun, and of the spacing that was asked
 * for (0: any)? */
static bool baked_fits(const struct brume_volume *volume,
                       const struct brume_scene *scene, unsigned spacing_log2)
{
    const uint8_t *head = volume->sun_cache;
    double dot = 0, square = 0;
    if (head == NULL ||
        (spacing_log2 > 0 && spacing_log2 != head[HEAD_SPACING]))
        return false;
    for (int i = 0; i < 3; i++) {
        double sun = scene->sun[i];
        dot += sun * get_q30(head + HEAD_DIRECTION + 4 * i);
        square += sun * sun;
    }
    return dot >= SAME_SUN * sqrt(square);
}

/// Computed ///

/* The frame whose light goes into the cache: of all the scene says, what
 * decides on depths towards the sun. */
static void light_scene(const struct brume_scene *scene,
                        struct brume_scene *out)
{
    static const struct brume_lighting k_white = {
        .sun_colour = {0x10000, 0x10000, 0x10000}};
    *out = *scene;
    out->lighting = &k_white;
    out->noise_table = NULL;
    out->width = out->height = 1;
    out->frame = 0;
    out->light = BRUME_UNIFORM;
    out->filter = BRUME_TRILINEAR;
    out->jitter = BRUME_JITTER_NONE;
    out->noise = BRUME_NOISE_NONE;
    out->output = BRUME_LINEAR;
    out->temporal = out->spatial = out->resolution = out->update = 0;
}

/* Is what was computed still good? */
static bool is_same(const struct sun_cache *c, const struct brume_scene *scene,
                    unsigned spacing_log2)
{
    const struct brume_scene *was = &c->scene;
    return c->codes != NULL && c->cache.spacing_log2 == spacing_log2 &&
           memcmp(was->sun, scene->sun, sizeof was->sun) == 0 &&
           was->light_samples == scene->light_samples &&
           was->light_step == scene->light_step &&
           was->max_density == scene->max_density;
}

static int compute(struct sun_cache *c, struct renderer *renderer,
                   const struct brume_volume *volume,
                   const struct brume_scene *scene, unsigned spacing_log2)
{
    struct brume_frame frame;
    sun_cache_free(c);
    light_scene(scene, &c->scene);
    int error = brume_begin_frame(&frame, volume, &c->scene);
    if (error)
        return error;
    size_t size = brume_cache_bytes(volume, spacing_log2);
    c->codes = size > 0 ? malloc(size) : NULL;
    if (c->codes == NULL)
        return BRUME_ERR_SIZE;
    error = brume_cache_begin(&c->cache, volume, spacing_log2, c->codes);
    if (!error)
        error = renderer_fill_cache(renderer, &c->cache, c->codes, &frame);
    if (error)
        sun_cache_free(c);
    return error;
}

int sun_cache_prepare(struct sun_cache *cache, struct renderer *renderer,
                      const struct brume_volume *volume,
                      const struct brume_scene *scene,
                      struct scene_light *light, char *err, size_t err_size)
{
    /* auto 2 4 8 */
    unsigned asked =
        (unsigned)light->value[SCENE_CACHE_SPACING - SCENE_LIGHT_FIRST][0];
    unsigned spacing = asked > 0 ? asked : 2;
    int error = BRUME_OK;
    if (scene->light != BRUME_CACHE)
        return 0;
    light->lighting.cache = &light->cache;
    if (baked_fits(volume, scene, asked))
        error = brume_cache_baked(&light->cache, volume);
    else if (!is_same(cache, scene, spacing))
        error = compute(cache, renderer, volume, scene, spacing);
    if (!error && !baked_fits(volume, scene, asked))
        light->cache = cache->cache;
    if (error)
        snprintf(err, err_size, "light = cache: %s", brume_error_text(error));
    return error ? -1 : 0;
}

void sun_cache_free(struct sun_cache *cache)
{
    free(cache->codes);
    memset(cache, 0, sizeof *cache);
}
