/* SPDX-License-Identifier: MIT */
#include "scenes.h"

#define ONE 0x10000u
#define NEAR BRUME_NEAREST
#define TRI BRUME_TRILINEAR
#define J_NONE BRUME_JITTER_NONE
#define J_PRIM BRUME_JITTER_PRIMARY
#define J_LIGHT BRUME_JITTER_LIGHT
#define J_BOTH BRUME_JITTER_BOTH

/* Any values, and so few that a table fits every target. */
static const uint8_t k_noise[64] = {
    13,  180, 91,  2,   169, 80,  247, 158, 69,  236, 147, 58,  225,
    136, 47,  214, 125, 36,  203, 114, 25,  192, 103, 14,  181, 92,
    3,   170, 81,  248, 159, 70,  237, 148, 59,  226, 137, 48,  215,
    126, 37,  204, 115, 26,  193, 104, 15,  182, 93,  4,   171, 82,
    249, 160, 71,  238, 149, 60,  227, 138, 49,  216, 127, 38,
};
static const struct brume_noise_table k_noise_table = {k_noise, 3, 3, 1, 4};

/* Of a noise, on a volume that fits everywhere. */
#define BLOCK(name, noise) \
    { \
        name, "block_u8", 160, 120, NEAR, BRUME_LOG, 6, J_BOTH, noise, \
            2 * ONE, 5, VIEW_FRONT, false, false, NULL, NULL \
    }

/* A sequence on the same volume. Frames are numbered from 15 on: the turns of
 * Bayer's order begin anew in the second. */
#define SEQUENCE(name, ...) \
    { \
        name, "block_u8", 64, 48, NEAR, BRUME_LOG, 4, J_BOTH, \
            BRUME_NOISE_RANK1, 2 * ONE, 15, VIEW_FRONT, false, false, \
            &(const struct test_sequence){__VA_ARGS__}, NULL \
    }

/* Lighting on volumes that have mips, a cache and the sky's visibility. */
#define LIT(name, volume, filter, light, samples, view, ...) \
    { \
        name, volume, 96, 72, filter, light, samples, J_BOTH, \
            BRUME_NOISE_RANK1, ONE + ONE / 4, 9, view, false, false, NULL, \
            &(const struct test_lighting) \
        { \
            __VA_ARGS__ \
        } \
    }

/* The same with fog, a surface or a sun map. */
#define AIR(name, volume, filter, light, samples, view, ...) \
    { \
        name, volume, 48, 36, filter, light, samples, J_BOTH, \
            BRUME_NOISE_RANK1, 2 * ONE, 9, view, false, false, NULL, \
            &(const struct test_lighting) \
        { \
            __VA_ARGS__ \
        } \
    }
#define AIR_SEQUENCE(name, frames, temporal, bits, resolution, ...) \
    { \
        name, "lit_u8", 48, 36, NEAR, BRUME_LOG, 8, J_BOTH, BRUME_NOISE_RANK1, \
            2 * ONE, 15, VIEW_FRONT, false, false, \
            &(const struct test_sequence){frames, \
                                          temporal, \
                                          bits, \
                                          3, \
                                          BRUME_FETCH_CATMULL_ROM, \
                                          BRUME_CLAMP_VARIANCE, \
                                          0, \
                                          resolution, \
                                          0, \
                                          BRUME_UPSAMPLE_AWARE, \
                                          true, \
                                          0, \
                                          4}, \
            &(const struct test_lighting) \
        { \
            __VA_ARGS__ \
        } \
    }

/* The same over time. */
#define LIT_SEQUENCE(name, frames, temporal, bits, resolution) \
    { \
        name, "lit_u8", 64, 48, NEAR, BRUME_CONE, 8, J_BOTH, \
            BRUME_NOISE_RANK1, 2 * ONE, 15, VIEW_FRONT, false, false, \
            &(const struct test_sequence){frames, \
                                          temporal, \
                                          bits, \
                                          3, \
                                          BRUME_FETCH_CATMULL_ROM, \
                                          BRUME_CLAMP_VARIANCE, \
                                          BRUME_BINOMIAL3, \
                                          resolution, \
                                          0, \
                                          BRUME_UPSAMPLE_AWARE, \
                                          true, \
                                          0, \
                                          4}, \
            &(const struct test_lighting) \
        { \
            .phase = 2, .octaves = 3, .ambient = BRUME_AMBIENT_GRADIENT, \
            .colour = true, .sky = true, .filmic = true \
        } \
    }

const struct test_scene test_scenes[] = {
    /* name, volume, size, lookup, light, n, jitter, noise, step, frame, view,
     * clamp, small */
    {"block_u8", "block_u8", 320, 240, NEAR, BRUME_LOG, 6, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, false, NULL, NULL},
    {"cloud_u8", "cloud_u8", 640, 480, NEAR, BRUME_LOG, 10, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, false, NULL, NULL},
    {"white", "cloud_u8", 320, 240, NEAR, BRUME_LOG, 8, J_BOTH,
     BRUME_NOISE_WHITE, 2 * ONE, 7, VIEW_FRONT, false, false, NULL, NULL},
    {"ign", "cloud_u8", 320, 240, NEAR, BRUME_LOG, 8, J_PRIM, BRUME_NOISE_IGN,
     3 * ONE, 65, VIEW_FRONT, false, false, NULL, NULL},
    {"bayer8", "cloud_u8", 320, 240, NEAR, BRUME_LOG, 8, J_LIGHT,
     BRUME_NOISE_BAYER8, ONE + ONE / 3, 1, VIEW_SUN, false, false, NULL, NULL},
    {"trilinear_u8", "cloud_u8", 320, 240, TRI, BRUME_LOG, 8, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, false, NULL, NULL},
    {"trilinear_u8_apron", "cloud_u8_apron", 320, 240, TRI, BRUME_LOG, 8,
     J_NONE, 0, ONE, 0, VIEW_FRONT, false, false, NULL, NULL},
    {"cloud_u8r", "cloud_u8r", 320, 240, NEAR, BRUME_LOG, 8, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, false, NULL, NULL},
    {"uniform_u8r", "cloud_u8r", 200, 150, TRI, BRUME_UNIFORM, 40, J_PRIM,
     BRUME_NOISE_IGN, ONE, 3, VIEW_FRONT, false, false, NULL, NULL},
    {"cloud_u4r", "cloud_u4r", 320, 240, NEAR, BRUME_LOG, 8, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, false, NULL, NULL},
    {"clamp_u4r_apron", "cloud_u4r_apron", 160, 120, TRI, BRUME_LOG, 8, J_NONE,
     0, ONE, 0, VIEW_FRONT, true, false, NULL, NULL},
    {"clamp_u8", "cloud_u8", 320, 240, NEAR, BRUME_UNIFORM, 40, J_NONE, 0, ONE,
     0, VIEW_FRONT, true, false, NULL, NULL},
    {"inside", "cloud_u8r_apron", 320, 240, TRI, BRUME_LOG, 8, J_BOTH,
     BRUME_NOISE_WHITE, ONE / 2, 0, VIEW_INSIDE, false, false, NULL, NULL},
    {"grazing", "cloud_u8", 320, 240, NEAR, BRUME_LOG, 8, J_NONE, 0, ONE, 0,
     VIEW_GRAZING, false, false, NULL, NULL},
    {"far", "cloud_u8", 161, 97, NEAR, BRUME_LOG, 16, J_PRIM, BRUME_NOISE_IGN,
     16 * ONE, 0, VIEW_FAR, false, false, NULL, NULL},
    {"top", "cloud_u4r", 97, 161, NEAR, BRUME_NO_LIGHT, 0, J_PRIM,
     BRUME_NOISE_BAYER8, 4 * ONE, 0, VIEW_TOP, false, false, NULL, NULL},
    {"hd_nearest", "cloud_u8", 1920, 1080, NEAR, BRUME_LOG, 8, J_PRIM,
     BRUME_NOISE_IGN, 2 * ONE, 0, VIEW_FRONT, false, false, NULL, NULL},
    {"hd_trilinear", "cloud_u8r_apron", 1920, 1080, TRI, BRUME_LOG, 6, J_BOTH,
     BRUME_NOISE_BAYER8, 3 * ONE, 0, VIEW_FRONT, false, false, NULL, NULL},
    {"small_cloud", "cloud_u8", 128, 96, NEAR, BRUME_LOG, 8, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, true, NULL, NULL},
    {"small_trilinear", "cloud_u8r", 128, 96, TRI, BRUME_UNIFORM, 40, J_NONE, 0,
     ONE, 0, VIEW_FRONT, false, true, NULL, NULL},
    {"small_jitter", "cloud_u8", 128, 96, NEAR, BRUME_LOG, 8, J_BOTH,
     BRUME_NOISE_IGN, 4 * ONE, 0, VIEW_FRONT, false, true, NULL, NULL},
    {"small_u4r", "cloud_u4r_apron", 128, 96, TRI, BRUME_LOG, 8, J_NONE, 0, ONE,
     0, VIEW_SUN, false, true, NULL, NULL},
    {"disney", "wdas_u8", 960, 540, NEAR, BRUME_LOG, 10, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, false, NULL, NULL},
    {"disney_hd", "wdas_u8", 1920, 1080, TRI, BRUME_LOG, 10, J_BOTH,
     BRUME_NOISE_IGN, 2 * ONE, 0, VIEW_FRONT, false, false, NULL, NULL},
    {"smoke", "smoke_u8r", 960, 540, NEAR, BRUME_LOG, 10, J_PRIM,
     BRUME_NOISE_WHITE, ONE, 0, VIEW_FRONT, false, false, NULL, NULL},
    {"smoke_u4r", "smoke_u4r", 320, 240, NEAR, BRUME_LOG, 10, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, false, NULL, NULL},
    /* For targets, where the largest frames are too slow: */
    {"disney_160", "wdas_u8", 160, 120, NEAR, BRUME_LOG, 10, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, false, NULL, NULL},
    {"disney_160_unlit", "wdas_u8", 160, 120, NEAR, BRUME_NO_LIGHT, 0, J_NONE,
     0, ONE, 0, VIEW_FRONT, false, false, NULL, NULL},
    {"disney_320", "wdas_u8", 320, 240, NEAR, BRUME_LOG, 10, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, false, NULL, NULL},
    {"disney_u4r", "wdas_u4r", 160, 120, NEAR, BRUME_LOG, 10, J_NONE, 0, ONE, 0,
     VIEW_FRONT, false, false, NULL, NULL},
    {"disney_u4r_unlit", "wdas_u4r", 160, 120, NEAR, BRUME_NO_LIGHT, 0, J_NONE,
     0, ONE, 0, VIEW_FRONT, false, false, NULL, NULL},
    {"disney_lod1", "wdas1_u8", 160, 120, NEAR, BRUME_LOG, 10, J_NONE, 0, ONE,
     0, VIEW_FRONT, false, false, NULL, NULL},
    {"disney_lod1_unlit", "wdas1_u8", 160, 120, NEAR, BRUME_NO_LIGHT, 0, J_NONE,
     0, ONE, 0, VIEW_FRONT, false, false, NULL, NULL},
    BLOCK("block_none", BRUME_NOISE_NONE),
    BLOCK("block_white", BRUME_NOISE_WHITE),
    BLOCK("block_ign", BRUME_NOISE_IGN),
    BLOCK("block_bayer8", BRUME_NOISE_BAYER8),
    BLOCK("block_bayer4", BRUME_NOISE_BAYER4),
    BLOCK("block_bayer16", BRUME_NOISE_BAYER16),
    BLOCK("block_ign_thesis", BRUME_NOISE_IGN_THESIS),
    BLOCK("block_rank1", BRUME_NOISE_RANK1),
    BLOCK("block_table", BRUME_NOISE_TABLE),
    BLOCK("block_table_golden", BRUME_NOISE_TABLE_GOLDEN),
    BLOCK("block_table_r2", BRUME_NOISE_TABLE_R2),
    /* frames, temporal, bits, window, fetch, clamp, spatial, resolution,
     * update, upsample, sub-pixel, falloff, move */
    SEQUENCE("seq_none", 1, 0, 16, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0),
    SEQUENCE("seq_ema", 3, BRUME_EMA, 16, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4),
    SEQUENCE("seq_ema8", 3, BRUME_EMA, 8, 0, 0, 0, 0, 0, 0, 0, 1, 0, 4),
    SEQUENCE("seq_window", 5, BRUME_WINDOW, 16, 3, 0, 0, 0, 0, 0, 0, 1, 0, 4),
    SEQUENCE("seq_window8", 5, BRUME_WINDOW, 8, 4, 0, 0, 0, 0, 0, 0, 1, 0, 4),
    SEQUENCE("seq_taa", 3, BRUME_TAA, 16, 0, BRUME_FETCH_CATMULL_ROM,
             BRUME_CLAMP_VARIANCE, 0, 0, 0, 0, 1, 0, 4),
    SEQUENCE("seq_taa_linear", 3, BRUME_TAA, 8, 0, BRUME_FETCH_BILINEAR,
             BRUME_CLAMP_MINMAX, 0, 0, 0, 0, 0, 0, 4),
    SEQUENCE("seq_taa_still", 3, BRUME_TAA, 16, 0, BRUME_FETCH_CATMULL_ROM,
             BRUME_CLAMP_VARIANCE, 0, 0, 0, 0, 1, 0, 0),
    SEQUENCE("seq_checker", 4, BRUME_EMA, 16, 0, 0, 0, 0, 0, BRUME_CHECKER, 0,
             0, 0, 4),
    SEQUENCE("seq_bayer", 18, BRUME_TAA, 16, 0, BRUME_FETCH_CATMULL_ROM,
             BRUME_CLAMP_VARIANCE, 0, 0, BRUME_BAYER4, 0, 0, 0, 1),
    SEQUENCE("seq_half", 1, 0, 16, 0, 0, 0, 0, BRUME_HALF, 0,
             BRUME_UPSAMPLE_BILINEAR, 0, 0, 0),
    SEQUENCE("seq_half_aware", 2, BRUME_TAA, 16, 0, BRUME_FETCH_BILINEAR,
             BRUME_CLAMP_VARIANCE, BRUME_BINOMIAL3, BRUME_HALF, 0,
             BRUME_UPSAMPLE_AWARE, 1, 8 * ONE, 4),
    SEQUENCE("seq_quarter", 1, 0, 16, 0, 0, 0, 0, BRUME_QUARTER, 0,
             BRUME_UPSAMPLE_AWARE, 0, 0, 0),
    SEQUENCE("seq_box3", 1, 0, 16, 0, 0, 0, BRUME_BOX3, 0, 0, 0, 0, 0, 0),
    SEQUENCE("seq_box5", 1, 0, 16, 0, 0, 0, BRUME_BOX5, 0, 0, 0, 0, 0, 0),
    SEQUENCE("seq_gauss1", 1, 0, 16, 0, 0, 0, BRUME_GAUSS1, 0, 0, 0, 0, 0, 0),
    SEQUENCE("seq_binomial3", 1, 0, 16, 0, 0, 0, BRUME_BINOMIAL3, 0, 0, 0, 0, 0,
             0),
    SEQUENCE("seq_binomial5", 1, 0, 16, 0, 0, 0, BRUME_BINOMIAL5, 0, 0, 0, 0, 0,
             0),
    SEQUENCE("seq_gauss15", 1, 0, 16, 0, 0, 0, BRUME_BILATERAL15, 0, 0, 0, 0, 0,
             0),
    SEQUENCE("seq_bilateral15", 1, 0, 16, 0, 0, 0, BRUME_BILATERAL15, 0, 0, 0,
             0, 16 * ONE, 0),
    SEQUENCE("seq_gauss1_edge", 1, 0, 16, 0, 0, 0, BRUME_GAUSS1, 0, 0, 0, 0,
             16 * ONE, 0),
    LIT("lit_nothing", "lit_u8", NEAR, BRUME_LOG, 8, VIEW_FRONT, .octaves = 0),
    LIT("lit_phase", "lit_u8", NEAR, BRUME_LOG, 8, VIEW_SUN, .phase = 1,
        .octaves = 1),
    LIT("lit_back", "lit_u8", TRI, BRUME_LOG, 8, VIEW_FRONT, .phase = 3,
        .octaves = 2),
    LIT("lit_octaves", "lit_u4r_apron", TRI, BRUME_UNIFORM, 40, VIEW_SUN,
        .phase = 2, .octaves = 4),
    LIT("lit_constant", "lit_u8", NEAR, BRUME_NO_LIGHT, 0, VIEW_FRONT,
        .ambient = BRUME_AMBIENT_CONSTANT, .visibility = BRUME_SKY_BAKED,
        .colour = true),
    LIT("lit_gradient", "lit_u4r_apron", NEAR, BRUME_LOG, 8, VIEW_FRONT,
        .octaves = 2, .ambient = BRUME_AMBIENT_GRADIENT, .colour = true),
    LIT("lit_sampled", "lit_u8", TRI, BRUME_LOG, 8, VIEW_FRONT, .octaves = 1,
        .ambient = BRUME_AMBIENT_GRADIENT, .visibility = BRUME_SKY_SAMPLED),
    LIT("lit_cube", "lit_u8", NEAR, BRUME_LOG, 8, VIEW_TOP, .octaves = 1,
        .ambient = BRUME_AMBIENT_CUBE, .visibility = BRUME_SKY_SAMPLED,
        .colour = true),
    LIT("lit_cone", "lit_u8", NEAR, BRUME_CONE, 10, VIEW_FRONT, .octaves = 1),
    LIT("lit_cone_u4r", "lit_u4r_apron", TRI, BRUME_CONE, 16, VIEW_FRONT,
        .phase = 1, .octaves = 2),
    LIT("lit_cache", "lit_u8", NEAR, BRUME_CACHE, 0, VIEW_FRONT, .octaves = 2),
    LIT("lit_cache_blend", "lit_u4r_apron", TRI, BRUME_CACHE, 0, VIEW_FRONT,
        .phase = 1, .blend = 100),
    LIT("lit_stochastic", "lit_u8", BRUME_STOCHASTIC, BRUME_LOG, 8, VIEW_FRONT,
        .octaves = 1),
    LIT("lit_stochastic_cache", "lit_u4r_apron", BRUME_STOCHASTIC, BRUME_CACHE,
        0, VIEW_FRONT, .phase = 2, .octaves = 3,
        .ambient = BRUME_AMBIENT_CONSTANT, .visibility = BRUME_SKY_SAMPLED,
        .colour = true),
    LIT("lit_sky", "lit_u8", TRI, BRUME_CONE, 8, VIEW_SUN, .phase = 2,
        .octaves = 3, .ambient = BRUME_AMBIENT_GRADIENT,
        .visibility = BRUME_SKY_BAKED, .colour = true, .sky = true,
        .filmic = true),
    LIT_SEQUENCE("seq_lit_ema", 3, BRUME_EMA, 16, 0),
    LIT_SEQUENCE("seq_lit_window8", 5, BRUME_WINDOW, 8, 0),
    LIT_SEQUENCE("seq_lit_taa", 3, BRUME_TAA, 16, 0),
    LIT_SEQUENCE("seq_lit_half", 2, BRUME_TAA, 16, BRUME_HALF),
    /* As lit_nothing, with lamps: docs/light.md has what they cost. */
    LIT("lamps_64", "lit_u8", NEAR, BRUME_LOG, 8, VIEW_FRONT, .lamps = 64),
    LIT("lamps_colours", "lit_u8", NEAR, BRUME_LOG, 8, VIEW_FRONT, .lamps = 12,
        .colour = true),
    LIT("lamps_spots", "lit_u4r_apron", TRI, BRUME_LOG, 8, VIEW_INSIDE,
        .phase = 1, .octaves = 2, .lamps = 20, .spots = true, .colour = true),
    LIT("lamps_stochastic", "lit_u8", BRUME_STOCHASTIC, BRUME_CACHE, 0,
        VIEW_TOP, .phase = 3, .lamps = 40, .spots = true),
    AIR("air_fog", "lit_u8", NEAR, BRUME_LOG, 8, VIEW_FRONT, .octaves = 2,
        .air = AIR_FOG),
    AIR("air_shapes", "lit_u4r_apron", TRI, BRUME_CONE, 10, VIEW_SUN,
        .phase = 1, .octaves = 3, .ambient = BRUME_AMBIENT_GRADIENT,
        .visibility = BRUME_SKY_BAKED, .colour = true,
        .air = AIR_FOG | AIR_SHAPES),
    AIR("air_cache", "lit_u4r_apron", BRUME_STOCHASTIC, BRUME_CACHE, 6,
        VIEW_TOP, .octaves = 2, .air = AIR_SHAPES),
    AIR("air_inside", "lit_u8", TRI, BRUME_UNIFORM, 20, VIEW_INSIDE,
        .ambient = BRUME_AMBIENT_CUBE, .visibility = BRUME_SKY_SAMPLED,
        .air = AIR_FOG | AIR_SHAPES),
    AIR("air_surface", "lit_u8", TRI, BRUME_LOG, 8, VIEW_FRONT, .octaves = 1,
        .air = AIR_SURFACE),
    AIR("air_sun_map", "lit_u4r_apron", NEAR, BRUME_LOG, 8, VIEW_FRONT,
        .octaves = 2, .air = AIR_SUN_MAP),
    AIR("air_all", "lit_u8", NEAR, BRUME_LOG, 8, VIEW_FRONT, .phase = 2,
        .octaves = 2, .colour = true, .sky = true,
        .air = AIR_FOG | AIR_SHAPES | AIR_SURFACE | AIR_SUN_MAP),
    AIR_SEQUENCE("seq_air_taa", 3, BRUME_TAA, 16, 0, .air = AIR_FOG),
    AIR_SEQUENCE("seq_air_window", 3, BRUME_WINDOW, 16, 0,
                 .air = AIR_FOG | AIR_SHAPES),
    AIR_SEQUENCE("seq_air_half", 2, BRUME_EMA, 8, BRUME_HALF,
                 .air = AIR_FOG | AIR_SURFACE | AIR_SUN_MAP),
    LIT("lit_glow", "glow_u8", NEAR, BRUME_LOG, 8, VIEW_FRONT, .octaves = 1,
        .emission = true),
    LIT("lit_glow_apron", "glow_u4r_apron", TRI, BRUME_NO_LIGHT, 0, VIEW_FRONT,
        .colour = true, .emission = true, .filmic = true),
    LIT("lit_glow_stochastic", "glow_u8", BRUME_STOCHASTIC, BRUME_LOG, 8,
        VIEW_SUN, .phase = 1, .octaves = 2, .colour = true, .emission = true),
    LIT("lit_glow_inside", "glow_u8", TRI, BRUME_LOG, 8, VIEW_INSIDE,
        .octaves = 2, .colour = true, .emission = true),
};

const int test_scene_count = sizeof test_scenes / sizeof test_scenes[0];

/* Eye and target from the box; in the box's own size. */
static void place_camera(struct brume_scene *s, int view,
                         const struct brume_volume *v)
{
    int32_t size[3], most = 0;
    for (int i = 0; i < 3; i++) {
        size[i] = v->box_max[i] - v->box_min[i] + 1;
        most = size[i] > most ? size[i] : most;
        s->target[i] = (v->box_min[i] + v->box_max[i]) * 32768;
        s->eye[i] = s->target[i];
    }
    switch (view) {
    case VIEW_INSIDE:
        s->target[0] -= 3 * 65536;
        s->target[2] += 65536;
        break;
    case VIEW_GRAZING:
        s->eye[1] = s->target[1] = v->box_max[1] * 65536;
        s->eye[2] += most * 90000;
        break;
    case VIEW_FAR:
        s->eye[0] += 20000 * 65536;
        s->eye[1] -= 3000 * 65536;
        s->fov = BRUME_MIN_FOV;
        break;
    case VIEW_TOP: s->eye[1] += most * 110000; break;
    default:
        s->eye[0] += most * 45000;
        s->eye[1] += most * 20000;
        s->eye[2] += most * 90000;
        break;
    }
}

bool test_scene_supported(const struct test_scene *scene)
{
    return scene->lighting == NULL || TEST_LIGHTING;
}

/* Its number among those that have lighting. */
static unsigned slot_of(const struct test_scene *scene)
{
    unsigned slot = 0;
    for (const struct test_scene *t = test_scenes; t != scene; t++)
        slot += t->lighting != NULL;
    return slot;
}

void test_scene_fill(struct brume_scene *out, const struct test_scene *scene,
                     const struct brume_volume *volume)
{
    static const struct brume_scene k_zero;
    struct brume_scene *s = out;
    uint64_t scale = BRUME_Q32(0.25); /* at the largest density, per voxel */
    *s = k_zero;
    s->width = scene->width;
    s->height = scene->height;
    s->frame = scene->frame;
    s->fov = 45u << 16;
    s->up[1] = 1;
    place_camera(s, scene->view, volume);
    s->sun[0] = scene->view == VIEW_SUN ? -5 : -4;
    s->sun[1] = scene->view == VIEW_SUN ? 1 : 3;
    s->sun[2] = scene->view == VIEW_SUN ? -10 : 2;
    s->density_scale = scale;
    s->light_density_scale = scale / 4;
    s->albedo = 62000;
    s->step = scene->step;
    s->light_step = scene->light == BRUME_UNIFORM ? 5 * ONE / 2 : ONE;
    s->min_transmittance = 655;
    s->min_density = BRUME_Q32(0.01);
    s->max_density = scene->clamp ? BRUME_Q32(0.5) : 0;
    s->background[0] = 6000;
    s->background[1] = 14000;
    s->background[2] = 30000;
    s->light_samples = scene->light_samples;
    s->filter = scene->filter;
    s->light = scene->light;
    s->jitter = scene->jitter;
    s->noise = scene->noise;
    s->noise_table = &k_noise_table;
    s->output = BRUME_SRGB;
    s->skip = true;
    if (scene->lighting != NULL)
        test_lighting_fill(s, scene->lighting, slot_of(scene), volume);
}

unsigned test_scene_frames(const struct test_scene *scene)
{
    return scene->sequence == NULL ? 1 : scene->sequence->frames;
}

void test_scene_frame(struct brume_scene *out, const struct test_scene *scene,
                      const struct brume_volume *volume, unsigned frame)
{
    const struct test_sequence *q = scene->sequence;
    test_scene_fill(out, scene, volume);
    if (q == NULL)
        return;
    out->frame += frame;
    out->eye[0] += (int32_t)frame * q->move * 256 *
                   (volume->box_max[0] - volume->box_min[0] + 1);
    out->temporal = q->temporal;
    out->history_bits = q->history_bits;
    out->window = q->window;
    out->fetch = q->fetch;
    out->clamp = q->clamp;
    out->spatial = q->spatial;
    out->resolution = q->resolution;
    out->update = q->update;
    out->upsample = q->upsample;
    out->subpixel = q->subpixel;
    out->edge_falloff = q->edge_falloff;
    out->alpha = 6554;
    out->gamma = ONE;
}

uint32_t test_crc32_more(uint32_t crc, const void *data, size_t size)
{
    const uint8_t *p = data;
    crc = ~crc;
    for (size_t i = 0; i < size; i++) {
        crc ^= p[i];
        for (int k = 0; k < 8; k++)
            crc = crc >> 1 ^ (0xedb88320u & (0u - (crc & 1u)));
    }
    return ~crc;
}

uint32_t test_crc32(const void *data, size_t size)
{
    return test_crc32_more(0, data, size);
}
