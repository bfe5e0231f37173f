/* SPDX-License-Identifier: MIT */
/* Scene checks, the order of passes, defaults. */
#include "brume_inner.h"

/// Scene ///

void brume_direction(int32_t out[3], int32_t azimuth, int32_t elevation)
{
    int32_t sine[2], cosine[2], angle[2] = {azimuth, elevation};
    for (int i = 0; i < 2; i++) {
        /* Degrees to turns: 2^16 / 360 = 182.0444..., modulo 2^32 */
        uint32_t m = magnitude(angle[i]);
        uint32_t turn = m * 182u + mul_hi_floor(m, 190887435u);
        brume_sincos(angle[i] < 0 ? 0u - turn : turn, &sine[i], &cosine[i]);
    }
    out[0] = mul_both_signed_round(cosine[1], sine[0], 2);
    out[1] = sine[1];
    out[2] = mul_both_signed_round(cosine[1], cosine[0], 2);
}

/* A number as Q32.32, at most 2^64 - 1. */
static uint64_t q32_of(struct brume_number n)
{
    uint32_t high = brume_number_floor(n, 0);
    int32_t e = n.e + 32;
    if (n.m == 0 || e <= -32)
        return 0;
    if (e >= 32)
        return UINT64_MAX;
    /* Below the point: what the high word's shift drops. */
    uint32_t low = e <= 0 ? n.m >> (uint32_t)-e : n.m << (uint32_t)e;
    return (uint64_t)high << 32 | low;
}

/* Optical depth of a path of `voxels` through the mean density should be
 * `depth`: density_scale = depth / (mean * voxels). */
static uint64_t default_scale(const struct brume_volume *v, uint32_t depth,
                              uint32_t voxels)
{
    if (v->density_mean.m == 0)
        return (uint64_t)1 << 32;
    struct brume_number path =
        brume_number_mul(v->density_mean, brume_number_of(voxels, 0));
    return q32_of(brume_number_mul(brume_number_of(depth, 0),
                                   brume_number_inverse(path)));
}

/* How far from the middle of the box, in voxels, the camera must be for all
 * corners to be seen within 40 degrees in a 4:3 frame, and a little more. A
 * corner at (x, y) across and z towards the camera needs
 *     z + |y| / tan 20,  z + |x| / (4/3 tan 20). */
static uint32_t framing_distance(const struct brume_volume *v)
{
    /* Axes of the camera at azimuth 30, elevation 10, in Q15. */
    static const int32_t k_right[3] = {28378, 0, -16384};
    static const int32_t k_up[3] = {-2845, 32270, -4928};
    static const int32_t k_towards[3] = {16135, 5690, 27947};
    uint32_t most = 0;
    for (unsigned corner = 0; corner < 8; corner++) {
        int32_t x = 0, y = 0, z = 0; /* < 2^30: three of 2^14 * 2^15 */
        for (int i = 0; i < 3; i++) {
            int32_t half = (v->box_max[i] - v->box_min[i] + 2) / 2;
            half = corner >> i & 1u ? half : -half;
            x += half * k_right[i];
            y += half * k_up[i];
            z += half * k_towards[i];
        }
        /* voxels; 2.06 and 2.75 in Q8 */
        uint32_t across = (magnitude(x) >> 15) * 528u >> 8;
        uint32_t along = (magnitude(y) >> 15) * 704u >> 8;
        uint32_t wide = across > along ? across : along;
        if (z < 0) /* the corner opposite needs more */
            continue;
        wide += (uint32_t)z >> 15;
        most = wide > most ? wide : most;
    }
    return most + (most >> 4) + 2u;
}

/* Camera: towards the middle of the box from azimuth 30, elevation 10, at the
 * distance that frames it, or as near to that as the eye's limits allow. */
static void default_camera(struct brume_scene *s, const struct brume_volume *v)
{
    int32_t away[3];
    uint32_t distance = framing_distance(v);
    brume_direction(away, 30 << 16, 10 << 16);
    for (int i = 0; i < 3; i++)
        s->target[i] = (v->box_min[i] + v->box_max[i]) * 32768;
    for (int i = 0; i < 3; i++) { /* all components of `away` are positive */
        uint32_t room = (uint32_t)(BRUME_MAX_COORDINATE - s->target[i]);
        /* (room / 2^16) / (away / 2^30), away rounded up */
        uint32_t most = room / (((uint32_t)away[i] >> 14) + 1u);
        distance = distance < most ? distance : most;
    }
    for (int i = 0; i < 3; i++)
        s->eye[i] = s->target[i] + mul_signed_round(away[i], distance << 16, 2);
    s->up[1] = 1 << 30;
    s->fov = 40u << 16;
}

/* Length of the box's diagonal in voxels, up to 17 % more: longest side plus
 * three eighths of the two others, rounded up. */
static uint32_t diagonal_of(const struct brume_volume *v)
{
    uint32_t sum = 0, most = 0;
    for (int i = 0; i < 3; i++) {
        uint32_t n = v->box_max[i] - v->box_min[i] + 1u;
        most = n > most ? n : most;
        sum += n;
    }
    return most + (((sum - most) * 3u + 7u) >> 3);
}

/* Light rays that cross the box: 64 samples spread over the diagonal, or, when
 * only doubling steps are compiled in, from one voxel on. */
static void default_light(struct brume_scene *s, uint32_t diagonal)
{
    if (BRUME_WITH_UNIFORM) {
        s->light = BRUME_UNIFORM;
        s->light_samples =
            BRUME_MAX_UNIFORM_SAMPLES < 64 ? BRUME_MAX_UNIFORM_SAMPLES : 64;
        s->light_step = diagonal << 10; /* 2^26 at most */
        if (s->light_step < BRUME_MIN_STEP)
            s->light_step = BRUME_MIN_STEP;
        if (s->light_step > BRUME_MAX_STEP)
            s->light_step = BRUME_MAX_STEP;
        return;
    }
    s->light = BRUME_LOG;
    s->light_step = 0x10000u;
    for (s->light_samples = 1; s->light_samples < BRUME_MAX_LOG_SAMPLES &&
                               1u << s->light_samples < diagonal;)
        s->light_samples++;
}

void brume_scene_default(struct brume_scene *scene,
                         const struct brume_volume *volume)
{
    static const struct brume_scene k_zero;
    uint32_t diagonal = diagonal_of(volume);
    struct brume_scene *s = scene;
    *s = k_zero;
    s->width = BRUME_MAX_SIZE < 640 ? BRUME_MAX_SIZE : 640;
    s->height = BRUME_MAX_SIZE < 480 ? BRUME_MAX_SIZE : 480;
    default_camera(s, volume);
    brume_direction(s->sun, -60 * 65536, 30 << 16);
    s->density_scale = default_scale(volume, 16, diagonal);
    s->light_density_scale = default_scale(volume, 7, diagonal);
    s->albedo = 0x10000u;
    /* a voxel; in large volumes 1/256 of the way, up to 4 voxels */
    s->step = diagonal > 256 ? diagonal << 8 : 0x10000u;
    s->step = s->step < 0x40000u ? s->step : 0x40000u;
    default_light(s, diagonal);
    s->min_transmittance = 655;
    s->filter = BRUME_WITH_TRILINEAR ? BRUME_TRILINEAR : BRUME_NEAREST;
    s->jitter = BRUME_WITH_NOISE ? BRUME_JITTER_PRIMARY : BRUME_JITTER_NONE;
    s->noise = BRUME_NOISE_IGN;
    s->background[0] = 7864; /* 0.12, 0.25, 0.5: a clear sky */
    s->background[1] = 16384;
    s->background[2] = 32768;
    s->output = BRUME_SRGB;
    s->skip = true;
    s->alpha = 6554; /* 0.1 */
    s->window = 8;
    s->clamp = BRUME_CLAMP_VARIANCE;
    s->fetch = BRUME_FETCH_CATMULL_ROM;
    s->gamma = 0x8000;
}

/// Frame ///

/* The last of each kind that there may be. */
#if BRUME_WITH_LIGHTING
enum {
    LAST_LIGHT = BRUME_CACHE,
    LAST_FILTER = BRUME_STOCHASTIC,
    LAST_OUTPUT = BRUME_FILMIC
};
#else
enum {
    LAST_LIGHT = BRUME_NO_LIGHT,
    LAST_FILTER = BRUME_TRILINEAR,
    LAST_OUTPUT = BRUME_SRGB
};
#endif

/* Does the scene ask for what was compiled out, as far as the march does not
 * find that? */
static bool is_missing(const struct brume_scene *s)
{
#if BRUME_WITH_LIGHTING
    if ((!BRUME_WITH_CONE && s->light == BRUME_CONE) ||
        (!BRUME_WITH_CACHE && s->light == BRUME_CACHE) ||
        (!BRUME_WITH_STOCHASTIC && s->filter == BRUME_STOCHASTIC) ||
        (!BRUME_WITH_TONE && s->output == BRUME_FILMIC))
        return true;
#endif
    return !BRUME_WITH_NOISE && s->jitter != 0 && s->noise != BRUME_NOISE_NONE;
}

static int check_scene(const struct brume_scene *s)
{
    if (s->width < 1 || s->width > BRUME_MAX_SIZE || s->height < 1 ||
        s->height > BRUME_MAX_SIZE)
        return BRUME_ERR_SIZE;
    if (s->step < BRUME_MIN_STEP || s->step > BRUME_MAX_STEP ||
        s->light_step < BRUME_MIN_STEP || s->light_step > BRUME_MAX_STEP)
        return BRUME_ERR_STEP;
    if (s->light > LAST_LIGHT ||
        ((s->light == BRUME_LOG || s->light == BRUME_CONE) &&
         s->light_samples > BRUME_MAX_LOG_SAMPLES) ||
        s->light_samples > BRUME_MAX_UNIFORM_SAMPLES)
        return BRUME_ERR_SAMPLES;
    if (s->filter > LAST_FILTER || s->jitter > BRUME_JITTER_BOTH ||
        !brume_noise_usable(s->noise, s->noise_table) ||
        s->output > LAST_OUTPUT || s->albedo > 0x10000u ||
        s->min_transmittance > 0x10000u)
        return BRUME_ERR_SCENE;
    for (int c = 0; c < 3; c++)
        if (s->background[c] > 0x10000u)
            return BRUME_ERR_SCENE;
    return is_missing(s) ? BRUME_ERR_FEATURE : BRUME_OK;
}

static void copy_scene(struct brume_frame *f, const struct brume_scene *s)
{
    uint32_t beyond = s->filter != BRUME_NEAREST ? 1 : 0;
    f->width = s->width;
    f->height = s->height;
    f->frame = s->frame;
    f->step = s->step;
    f->albedo = s->albedo;
    f->min_transmittance = s->min_transmittance << 15;
    f->jitter = s->jitter;
    f->noise = s->noise;
    if (s->noise >= BRUME_NOISE_TABLE)
        f->noise_table = *s->noise_table;
    f->output = s->output;
    for (int i = 0; i < 3; i++) {
        f->background[i] = s->background[i];
        /* Lookups but the nearest read one voxel beyond. */
        f->limit[i] = (8u * f->volume->cell_count[i] - beyond) << 16;
        f->sun[i] = s->sun[i];
    }
}

#if BRUME_WITH_TAA
/* A word that changes with what rays see, but not with noise or camera. Half
 * of the table is enough, and all that a narrow kernel has. */
static uint32_t sameness(const struct brume_frame *f)
{
    const uint32_t part[] = {
        (uint32_t)f->sun[0],
        (uint32_t)f->sun[1],
        (uint32_t)f->sun[2],
        f->min_density,
        f->max_density,
        f->tau.m,
        f->tau.shift,
        f->min_transmittance,
        f->albedo,
        f->step,
        f->light_step,
        f->light_samples,
        f->kernel,
        le32(*(const brume_word_t *)(const void *)(f->volume->asset +
                                                   BRUME_OFF_CRC))};
    uint32_t h = 0;
    for (uint32_t i = 0; i < 256; i++)
        h = h * 16777619u ^ f->table[i];
    for (uint32_t i = 0; i < sizeof part / sizeof *part; i++)
        h = (h ^ h >> 15) * 2246822519u ^ part[i];
#if BRUME_WITH_LIGHTING
    if (f->lit.on)
        h = (h ^ h >> 15) * 2246822519u ^ brume_lit_sameness(f);
#endif
#if BRUME_WITH_LAMPS
    if (f->lit.on)
        h = (h ^ h >> 15) * 2246822519u ^ brume_lamps_sameness(f);
#endif
    return h;
}
#endif

int brume_begin_frame(struct brume_frame *frame,
                      const struct brume_volume *volume,
                      const struct brume_scene *scene)
{
    if (frame == NULL || volume == NULL || scene == NULL ||
        volume->cells == NULL)
        return BRUME_ERR_NULL;
    int err = check_scene(scene);
    if (err == BRUME_OK)
        err = brume_lattice_check(scene);
#if BRUME_WITH_LIGHTING
    if (err == BRUME_OK)
        err = brume_lit_check(scene);
#endif
#if BRUME_WITH_LAMPS
    if (err == BRUME_OK)
        err = brume_lamps_check(scene);
#endif
    if (err)
        return err;
    frame->volume = volume;
    copy_scene(frame, scene);
    brume_lattice_begin(frame, scene);
    err = brume_camera_begin(frame, scene);
    if (err)
        return err;
    if (!brume_normalise(frame->sun))
        return BRUME_ERR_SUN;
    err = brume_march_begin(frame, scene);
#if BRUME_WITH_SKY
    if (err == BRUME_OK)
        brume_sky_begin(frame, scene);
#endif
#if BRUME_WITH_TAA
    if (err == BRUME_OK && frame->temporal == BRUME_TAA)
        frame->same = sameness(frame);
#endif
    return err;
}

/// Pixels ///

/* Does brume_render_rect alone give the frame? */
static bool is_plain(const struct brume_frame *f)
{
#if BRUME_WITH_SPATIAL
    if (f->spatial != BRUME_SPATIAL_NONE)
        return false;
#endif
#if BRUME_WITH_TEMPORAL
    if (f->temporal != BRUME_TEMPORAL_NONE)
        return false;
#endif
    return f->lattice[0] == f->width && f->lattice[1] == f->height;
}

int brume_render_rect(const struct brume_frame *frame, unsigned x, unsigned y,
                      unsigned w, unsigned h, int pixel_format, void *dst,
                      size_t stride)
{
    struct brume_radiance row[BRUME_SPAN];
    if (frame == NULL || dst == NULL)
        return BRUME_ERR_NULL;
    int err = brume_pixels_check(pixel_format, x, w, h, stride);
    if (err)
        return err;
    if (!is_plain(frame))
        return BRUME_ERR_STATE;
    if (!brume_rect_fits(frame->lattice, x, y, w, h))
        return BRUME_ERR_RECT;
    for (unsigned j = 0; j < h; j++) {
        uint8_t *to = (uint8_t *)dst + j * stride;
        for (unsigned i = 0; i < w; i += BRUME_SPAN) {
            unsigned n = w - i < BRUME_SPAN ? w - i : BRUME_SPAN;
            brume_march_span(frame, x + i, y + j, n, row);
            brume_pack_span(frame, x + i, y + j, row, n, pixel_format,
                            to + brume_pixel_offset(pixel_format, i));
        }
    }
    return BRUME_OK;
}

#if BRUME_WITH_SEQUENCES
int brume_march_rect(const struct brume_frame *frame, unsigned x, unsigned y,
                     unsigned w, unsigned h, struct brume_radiance *out,
                     size_t stride)
{
    if (frame == NULL || out == NULL)
        return BRUME_ERR_NULL;
    if (!brume_rect_fits(frame->lattice, x, y, w, h) || (h > 1 && stride < w))
        return BRUME_ERR_RECT;
    for (unsigned j = 0; j < h; j++, out += stride)
        for (unsigned i = 0; i < w; i += BRUME_SPAN)
            brume_march_span(frame, x + i, y + j,
                             w - i < BRUME_SPAN ? w - i : BRUME_SPAN, out + i);
    return BRUME_OK;
}

int brume_pack_rect(const struct brume_frame *frame,
                    const struct brume_radiance *in, size_t in_stride,
                    unsigned x, unsigned y, unsigned w, unsigned h,
                    int pixel_format, void *dst, size_t stride)
{
    if (frame == NULL || in == NULL || dst == NULL)
        return BRUME_ERR_NULL;
    const uint16_t image[2] = {frame->width, frame->height};
    int err = brume_pixels_check(pixel_format, x, w, h, stride);
    if (err)
        return err;
    if (!brume_rect_fits(image, x, y, w, h) || (h > 1 && in_stride < w))
        return BRUME_ERR_RECT;
    for (unsigned j = 0; j < h; j++)
        brume_pack_span(frame, x, y + j, in + j * in_stride, w, pixel_format,
                        (uint8_t *)dst + j * stride);
    return BRUME_OK;
}

#endif

/// Sequences ///

#if BRUME_WITH_TEMPORAL
static int check_state(const struct brume_frame *frame,
                       const struct brume_state *state)
{
    if (frame == NULL || state == NULL)
        return BRUME_ERR_NULL;
    return brume_state_fits(state, frame) ? BRUME_OK : BRUME_ERR_STATE;
}

int brume_store_rect(const struct brume_frame *frame, struct brume_state *state,
                     unsigned x, unsigned y, unsigned w, unsigned h,
                     const struct brume_radiance *in, size_t stride)
{
    int err = in == NULL ? BRUME_ERR_NULL : check_state(frame, state);
    if (err)
        return err;
    if (!brume_rect_fits(frame->lattice, x, y, w, h) || (h > 1 && stride < w))
        return BRUME_ERR_RECT;
    for (unsigned j = 0; j < h; j++)
        brume_store_span(frame, state, x, y + j, w, in + j * stride);
    return BRUME_OK;
}

int brume_trace_rect(const struct brume_frame *frame, struct brume_state *state,
                     unsigned x, unsigned y, unsigned w, unsigned h)
{
    struct brume_radiance row[BRUME_SPAN];
    int err = check_state(frame, state);
    if (err)
        return err;
    if (!brume_rect_fits(frame->lattice, x, y, w, h))
        return BRUME_ERR_RECT;
    for (unsigned j = 0; j < h; j++)
        for (unsigned i = 0; i < w; i += BRUME_SPAN) {
            unsigned n = w - i < BRUME_SPAN ? w - i : BRUME_SPAN;
            brume_march_span(frame, x + i, y + j, n, row);
            brume_store_span(frame, state, x + i, y + j, n, row);
        }
    return BRUME_OK;
}

int brume_resolve_rect(const struct brume_frame *frame,
                       struct brume_state *state, unsigned x, unsigned y,
                       unsigned w, unsigned h)
{
    int err = check_state(frame, state);
    if (err)
        return err;
    if (!brume_rect_fits(frame->grid, x, y, w, h))
        return BRUME_ERR_RECT;
#if BRUME_WITH_TAA
    for (unsigned j = 0; frame->temporal == BRUME_TAA && j < h; j++)
        brume_resolve_span(frame, state, x, y + j, w);
#endif
    return BRUME_OK;
}
#endif
