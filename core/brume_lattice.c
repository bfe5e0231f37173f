/* SPDX-License-Identifier: MIT */
/*
 * Which rays a frame marches, and where in pixel and step their samples lie:
 * the image is divided into the grid's rays (resolution), of which a frame
 * marches the lattice (update).
 */
#include "brume_inner.h"

/// Checking ///

/* Does the scene ask for what is not compiled in? */
static bool is_missing(const struct brume_scene *s)
{
    return (!BRUME_WITH_TEMPORAL &&
            (s->temporal | s->update | s->subpixel) != 0) ||
           (!BRUME_WITH_TAA && s->temporal == BRUME_TAA) ||
           (!BRUME_WITH_SPATIAL && s->spatial != 0) ||
           (!BRUME_WITH_RESOLUTION && s->resolution != 0);
}

#if BRUME_WITH_TEMPORAL
static bool history_is_good(const struct brume_scene *s)
{
    if (s->temporal == BRUME_TEMPORAL_NONE)
        return true;
    if (s->history_bits != 0 && s->history_bits != 8 && s->history_bits != 16)
        return false;
    if (s->temporal == BRUME_WINDOW)
        return s->window >= 1 && s->window <= BRUME_MAX_WINDOW;
    return s->alpha >= 0x400u && s->alpha <= 0x10000u;
}
#endif

int brume_lattice_check(const struct brume_scene *scene)
{
    const struct brume_scene *s = scene;
#if BRUME_WITH_TEMPORAL
    if (s->temporal > BRUME_TAA || s->update > BRUME_BAYER4 ||
        !history_is_good(s))
        return BRUME_ERR_SCENE;
#endif
#if BRUME_WITH_TAA
    if (s->fetch > BRUME_FETCH_CATMULL_ROM || s->clamp > BRUME_CLAMP_VARIANCE ||
        s->gamma > 16u << 16)
        return BRUME_ERR_SCENE;
#endif
#if BRUME_WITH_SPATIAL
    if (s->spatial > BRUME_BILATERAL15 || s->edge_falloff > 1024u << 16)
        return BRUME_ERR_SCENE;
#endif
#if BRUME_WITH_RESOLUTION
    if (s->resolution > BRUME_QUARTER || s->upsample > BRUME_UPSAMPLE_AWARE)
        return BRUME_ERR_SCENE;
#endif
    return is_missing(s) ? BRUME_ERR_FEATURE : BRUME_OK;
}

/// Lattice ///

#if BRUME_WITH_TEMPORAL
static void set_lattice(struct brume_frame *f)
{
    /* Bayer's matrix 4x4: 4 y + x of the ray that turn n marches. */
    static const uint8_t k_bayer_place[16] = {0, 10, 2, 8, 5, 15, 7, 13,
                                              1, 11, 3, 9, 4, 14, 6, 12};
    uint8_t place = k_bayer_place[f->frame & 15u];
    f->place[0] = f->place[1] = 0;
    if (f->update == BRUME_CHECKER) {
        f->place[0] = f->frame & 1u;
    } else if (f->update == BRUME_BAYER4) {
        f->place[0] = place & 3u;
        f->place[1] = place >> 2;
    }
    for (uint32_t i = 0; i < 2; i++) {
        f->cell_log2[i] = (uint8_t)brume_cell_log2(f->update, i);
        f->lattice[i] = (uint16_t)brume_rays(f->grid[i], f->cell_log2[i]);
    }
    f->noise_frame = f->frame >> brume_period_log2(f->update);
}

/* Place in the pixel, from N-rooks sets; and in the step: turn k of n samples
 * the k-th n-th of it. */
static void set_strata(struct brume_frame *f)
{
    bool window = f->temporal == BRUME_WINDOW;
    uint32_t n = window ? f->window : BRUME_MAX_WINDOW;
    uint32_t k = f->noise_frame % n, rook = brume_nrooks[n - 1u][k];
    f->point[0] = (((rook & 15u) << 1 | 1u) << 15) / n;
    f->point[1] = (((rook >> 4) << 1 | 1u) << 15) / n;
    f->stratum = window ? (k << 16) / n : 0;
    f->strata = window ? 0x10000u / n : 0x10000u;
}

static void set_temporal(struct brume_frame *f, const struct brume_scene *s)
{
    f->temporal = s->temporal;
    f->update = s->update;
    f->history_bits = s->history_bits == 8 ? 8 : 16;
    f->window = s->temporal == BRUME_WINDOW ? s->window : 1;
    f->alpha = s->alpha;
    f->subpixel = s->subpixel;
    set_lattice(f);
    set_strata(f);
}
#endif

void brume_lattice_begin(struct brume_frame *frame,
                         const struct brume_scene *scene)
{
    struct brume_frame *f = frame;
    const struct brume_scene *s = scene;
    f->cut = s->cut;
    for (int i = 0; i < 2; i++) {
        uint32_t size = i ? s->height : s->width;
        f->grid[i] =
            (uint16_t)brume_rays(size, BRUME_WITH_RESOLUTION * s->resolution);
        f->lattice[i] = f->grid[i];
    }
#if BRUME_WITH_DEPTH
    f->depth = brume_scene_has_depth(s);
#endif
#if BRUME_WITH_SPATIAL
    f->spatial = s->spatial;
    f->edge_falloff = s->edge_falloff;
#endif
#if BRUME_WITH_RESOLUTION
    f->resolution = s->resolution;
    f->upsample = s->upsample;
#endif
#if BRUME_WITH_TEMPORAL
    set_temporal(f, s);
#endif
#if BRUME_WITH_TAA
    f->fetch = s->fetch;
    f->clamp = s->clamp;
    f->gamma = s->gamma;
#endif
}
