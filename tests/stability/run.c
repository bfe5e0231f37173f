/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stability.h"
#include "support/passes.h"

/// Rays ///

/* A frame's rays, which do not depend on what is done with them but for the
 * window's strata: marched for the first method that needs them, and kept for
 * those after it. */
#define FRAMES 64
static struct {
    const struct scenario *scenario;
    const char *noise;
    uint8_t update, resolution;
    bool window, made[FRAMES];
    struct brume_radiance rays[FRAMES][STABILITY_PIXELS];
} s_cache;

static void use_cache(const struct scenario *scenario, const struct method *m)
{
    bool window = m->temporal == BRUME_WINDOW;
    if (s_cache.scenario == scenario && s_cache.noise == m->noise &&
        s_cache.update == m->update && s_cache.resolution == m->resolution &&
        s_cache.window == window)
        return;
    memset(s_cache.made, 0, sizeof s_cache.made);
    s_cache.scenario = scenario;
    s_cache.noise = m->noise;
    s_cache.update = m->update;
    s_cache.resolution = m->resolution;
    s_cache.window = window;
}

/* With depths, which taa needs and the others leave. */
static const struct brume_radiance *rays_of(const struct brume_volume *volume,
                                            const struct brume_scene *scene,
                                            int frame)
{
    static struct brume_frame f;
    struct brume_scene s = *scene;
    struct brume_radiance *rays = s_cache.rays[frame];
    if (s_cache.made[frame])
        return rays;
    if (s.temporal != BRUME_WINDOW)
        s.temporal = BRUME_TAA;
    int error = brume_begin_frame(&f, volume, &s);
    if (error == BRUME_OK)
        error = brume_march_rect(&f, 0, 0, f.lattice[0], f.lattice[1], rays,
                                 f.lattice[0]);
    if (error != BRUME_OK) {
        fprintf(stderr, "stability: %s\n", brume_error_text(error));
        abort();
    }
    s_cache.made[frame] = true;
    return rays;
}

/// Runs ///

void run_method(const struct scenario *scenario, const struct method *method,
                bool fresh, picture_t out[STABILITY_MOST])
{
    const int first = scenario->frames - scenario->last;
    struct passes p = {0};
    struct brume_scene s;
    const struct brume_volume *v;
    use_cache(scenario, method);
    for (int f = fresh ? first : 0; f < scenario->frames; f++) {
        scenario_scene(scenario, f, &s, &v);
        method_set(method, &s);
        int slot = scenario->period ? f % scenario->period : f;
        const struct brume_radiance *rays = rays_of(v, &s, slot);
        passes_begin(&p, v, &s);
        passes_store(&p, rays);
        if (f >= first)
            passes_show(&p, BRUME_L16, out[f - first]);
    }
    passes_free(&p);
}

/* Do rays of both see the same, noise aside? */
static bool is_same_view(const struct brume_scene *a,
                         const struct brume_scene *b)
{
    return memcmp(a->eye, b->eye, sizeof a->eye) == 0 &&
           memcmp(a->target, b->target, sizeof a->target) == 0 &&
           memcmp(a->sun, b->sun, sizeof a->sun) == 0 && a->fov == b->fov;
}

void run_truths(const struct scenario *scenario, int samples,
                picture_t out[STABILITY_MOST])
{
    /* The last fixed one, which scenarios share. */
    static picture_t truth;
    static struct brume_scene seen;
    static const struct brume_volume *volume;
    const int first = scenario->frames - scenario->last;
    struct brume_scene s;
    const struct brume_volume *v;
    for (int k = 0; k < (scenario->fixed ? 1 : scenario->last); k++) {
        scenario_scene(scenario, first + k, &s, &v);
        method_set(&methods[0], &s);
        if (!scenario->fixed || volume != v || !is_same_view(&s, &seen))
            truth_render(v, &s, samples, out[k]);
        else
            memcpy(out[k], truth, sizeof truth);
    }
    if (scenario->fixed) {
        memcpy(truth, out[0], sizeof truth);
        seen = s;
        volume = v;
    }
}
