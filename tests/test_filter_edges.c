/* SPDX-License-Identifier: MIT */
/*
 * What edge-aware filters and upsampling are for: how far a cloud reaches into
 * the sky beside it, and how far images with noise or few rays are from the
 * mean of many frames. Rays are marched.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "brume_inner.h"
#include "support/asset_builder.h"
#include "tap.h"

#define W 240
#define H 180
#define PIXELS (W * H)

static const char *const k_name[] = {
    "none", "box3", "box5", "gauss1", "binomial3", "binomial5", "bilateral15"};
enum { KERNELS = 7 };

/* Returns the asset, to be freed. */
static uint8_t *open_volume(struct brume_volume *volume, struct asset_spec spec)
{
    size_t size;
    uint8_t *asset = asset_build(&spec, &size);
    if (brume_volume_open(volume, asset, size, 0) != BRUME_OK)
        abort();
    return asset;
}

/* With a hard edge, like that of a cumulus. */
static void scene_of(struct brume_scene *scene, const struct brume_volume *v)
{
    brume_scene_default(scene, v);
    scene->width = W;
    scene->height = H;
    scene->output = BRUME_LINEAR;
    scene->light_samples = 8;
    scene->density_scale *= 16;
    scene->light_density_scale *= 4;
    scene->jitter = BRUME_JITTER_NONE;
    for (int c = 0; c < 3; c++)
        scene->background[c] = 32768;
}

static void show(const struct brume_volume *v, const struct brume_scene *scene,
                 uint16_t *out)
{
    static uint32_t s_work[BRUME_WORK_BYTES(W) / 4 + 1];
    struct brume_frame f;
    if (brume_begin_frame(&f, v, scene) != BRUME_OK ||
        brume_show_rect(&f, NULL, 0, 0, W, H, BRUME_L16, out, 2 * W, s_work,
                        sizeof s_work) != BRUME_OK)
        abort();
}

/// Outline ///

/* Which rays meet nothing. */
static void find_sky(const struct brume_volume *v, struct brume_scene scene,
                     bool *sky)
{
    static struct brume_radiance s_rays[PIXELS];
    struct brume_frame f;
    scene.spatial = BRUME_BOX3; /* so that rays have depth */
    scene.edge_falloff = 1;
    if (brume_begin_frame(&f, v, &scene) != BRUME_OK ||
        brume_march_rect(&f, 0, 0, W, H, s_rays, W) != BRUME_OK)
        abort();
    for (int i = 0; i < PIXELS; i++)
        sky[i] = s_rays[i].depth == BRUME_NO_DEPTH;
}

/* Change of transmittance, in 1/255, of the rays of the sky that are at most
 * two columns beside the cloud: mean and most. */
struct reach {
    double mean, most;
};

static struct reach reach_of(const uint16_t *plain, const uint16_t *out,
                             const bool *sky)
{
    struct reach r = {0, 0};
    int count = 0;
    for (int i = 2; i < PIXELS - 2; i++) {
        if (!sky[i] || (sky[i - 2] && sky[i - 1] && sky[i + 1] && sky[i + 2]))
            continue;
        double change = abs(out[i] - plain[i]) / 257.;
        r.mean += change;
        r.most = fmax(r.most, change);
        count++;
    }
    r.mean /= count;
    return r;
}

/* A black volume before a white sky, under every kernel: plain, and edge-aware
 * with less than `share` of that; and
 * upsampled. */
static void test_outline(const char *name, const struct brume_volume *v,
                         double least, double share)
{
    static uint16_t s_unfiltered[PIXELS], s_out[PIXELS];
    static bool s_sky[PIXELS];
    struct brume_scene scene;
    struct reach r[2];

    scene_of(&scene, v);
    scene.albedo = 0;
    for (int c = 0; c < 3; c++)
        scene.background[c] = 0x10000;
    find_sky(v, scene, s_sky);
    show(v, &scene, s_unfiltered);
    for (int u = 1; u < 3; u++) {
        scene.resolution = (uint8_t)u;
        for (uint32_t e = 0; e < 2; e++) {
            scene.upsample = (uint8_t)e;
            show(v, &scene, s_out);
            r[e] = reach_of(s_unfiltered, s_out, s_sky);
        }
        tap_check(r[1].mean < r[0].mean,
                  "%s, 1/%d: the sky beside changes by %.2f/255, up to %.1f; "
                  "aware %.2f, up to %.2f",
                  name, 1 << u, r[0].mean, r[0].most, r[1].mean, r[1].most);
    }
    scene.resolution = BRUME_FULL;
    for (int k = 1; k < KERNELS; k++) {
        scene.spatial = (uint8_t)k;
        for (uint32_t e = 0; e < 2; e++) {
            scene.edge_falloff = e * 8 << 16;
            show(v, &scene, s_out);
            r[e] = reach_of(s_unfiltered, s_out, s_sky);
        }
        tap_check(r[0].most > least && r[1].most < share * r[0].most &&
                      r[1].mean < r[0].mean,
                  "%s, %s: the sky beside changes by %.2f/255, up to %.1f; "
                  "edge-aware %.2f, up to %.2f",
                  name, k_name[k], r[0].mean, r[0].most, r[1].mean, r[1].most);
    }
}

/// Truth ///

static double rms(const double *truth, const uint16_t *out)
{
    double sum = 0;
    for (int i = 0; i < PIXELS; i++)
        sum += (out[i] - truth[i]) * (out[i] - truth[i]);
    return sqrt(sum / PIXELS) / 257;
}

/* The mean of frames with other noise each. */
static void find_truth(const struct brume_volume *v, struct brume_scene scene,
                       double *truth)
{
    static uint16_t s_out[PIXELS];
    enum { FRAMES = 32 };
    memset(truth, 0, PIXELS * sizeof *truth);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        scene.frame = frame;
        show(v, &scene, s_out);
        for (int i = 0; i < PIXELS; i++)
            truth[i] += s_out[i] / (double)FRAMES;
    }
}

static void test_truth(const struct brume_volume *v)
{
    static double s_truth[PIXELS];
    static uint16_t s_out[PIXELS];
    struct brume_scene scene;
    double error[3];

    scene_of(&scene, v);
    scene.jitter = BRUME_JITTER_PRIMARY;
    scene.noise = BRUME_NOISE_WHITE;
    scene.step = 0x30000;
    find_truth(v, scene, s_truth);
    scene.frame = 1000;
    show(v, &scene, s_out);
    error[2] = rms(s_truth, s_out);
    for (int k = 1; k < KERNELS; k++) {
        scene.spatial = (uint8_t)k;
        for (uint32_t e = 0; e < 2; e++) {
            scene.edge_falloff = e * 16 << 16;
            show(v, &scene, s_out);
            error[e] = rms(s_truth, s_out);
        }
        tap_check(error[1] < error[0],
                  "%s: rms error %.3f/255, edge-aware %.3f, unfiltered %.3f",
                  k_name[k], error[0], error[1], error[2]);
    }
    scene.spatial = BRUME_SPATIAL_NONE;
    for (int r = 1; r < 3; r++) {
        scene.resolution = (uint8_t)r;
        for (int aware = 0; aware < 2; aware++) {
            scene.upsample = (uint8_t)aware;
            show(v, &scene, s_out);
            error[aware] = rms(s_truth, s_out);
        }
        tap_check(error[1] < 1.01 * error[0],
                  "1/%d: rms error %.3f/255, aware %.3f", 1 << r, error[0],
                  error[1]);
    }
}

int main(void)
{
    static const struct density_cloud k_cloud = {72, 5};
    static const struct density_box k_box = {{4, 4, 4}, {28, 20, 36}, 32768};
    struct brume_volume cloud, block;

    uint8_t *first = open_volume(
        &cloud, asset_spec_of(9, 9, 9, BRUME_U8, density_in_cloud, &k_cloud));
    uint8_t *second = open_volume(
        &block, asset_spec_of(4, 3, 5, BRUME_U8, density_in_box, &k_box));
    test_outline("cloud", &cloud, 6, .8);
    test_outline("block", &block, 60, .2);
    test_truth(&cloud);
    free(first);
    free(second);
    return tap_done();
}
