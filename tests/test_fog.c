/* SPDX-License-Identifier: MIT */
/*
 * Fog, surfaces and sun maps (core/brume_lit.c) by closed forms and at their
 * extremes: in a pool that is empty but for one cell, so that fog is all that
 * a ray meets; and together with a cloud, where nothing may depend on how it is
 * marched.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/lit.h"
#include "tap.h"

#define ONE 0x10000u
#define Q30 (1 << 30)

enum { W = 24, H = 18, RAYS = W * H };

static struct brume_frame frame;
static struct brume_radiance first[RAYS], second[RAYS];
static uint16_t depths[RAYS], texels[64];

static uint32_t q32(double v)
{
    return (uint32_t)floor(v * 4294967296.0 + 0.5);
}

static uint32_t q16(double v)
{
    return (uint32_t)floor(v * 65536.0 + 0.5);
}

static struct brume_fog fog_of(double density, double falloff, double far)
{
    struct brume_fog fog = {
        .density = q32(density), .falloff = q16(falloff), .far = q16(far)};
    return fog;
}

/* One ray in a direction from a point, through fog alone: the volume does not
 * count. */
static struct brume_scene ray_scene(const struct lit_volume *v,
                                    const struct brume_lighting *l,
                                    const double from[3], const double way[3])
{
    struct brume_scene s = lit_scene(v, 1, 1, l);
    for (int i = 0; i < 3; i++) {
        s.eye[i] = BRUME_Q16(from[i]);
        s.target[i] = BRUME_Q16(from[i] + 64 * way[i]);
    }
    s.fov = ONE;
    s.density_scale = s.light_density_scale = 0;
    s.light = BRUME_NO_LIGHT;
    return s;
}

/* What the ray leaves, 0 .. 1. */
static double through(const struct lit_volume *v, const struct brume_scene *s)
{
    struct brume_radiance out;
    lit_march(&frame, v, s, &out);
    return out.transmittance / 65536.0;
}

/// Closed forms ///

/* Rounded to 2^-16, and 2^-14 of the depth by the tables. */
static bool is_near(double is, double should)
{
    return fabs(is - should) <= 2.0 / 65536;
}

static const double k_eye[3] = {-200, 10, -150}, k_along[3] = {0.6, 0, 0.8},
                    k_up[3] = {0, 1, 0};

static void check_uniform(const struct lit_volume *v)
{
    static const double k_density[] = {1e-6, 1e-4, 0.003, 0.05, 0.7};
    static const uint32_t k_step[] = {BRUME_MIN_STEP, ONE, 10 * ONE,
                                      BRUME_MAX_STEP};
    double worst = 0;
    for (int d = 0; d < 5; d++)
        for (int n = 0; n < 4; n++) {
            struct brume_lighting l = lit_white();
            double far = k_density[d] < 0.01 ? 5120 : 256;
            struct brume_fog fog = fog_of(k_density[d], 0, far);
            l.fog = &fog;
            struct brume_scene s = ray_scene(v, &l, k_eye, k_along);
            s.step = k_step[n];
            double should = exp(-k_density[d] * far);
            double off = fabs(through(v, &s) - should);
            /* the result's rounding, the table's, and of each sample a loss
             * that ends at 2^-31, of an opacity that lost 2^-31 */
            double most = 1.5 / 65536 + far / (k_step[n] / 65536.0) * 0x1p-30;
            worst = fmax(worst, off / most);
        }
    tap_check(worst <= 1,
              "uniform fog leaves exp(-density far) for steps of 1/16 to 256 "
              "(off by %.2f of the bound)",
              worst);
}

/* The lattice's sum of a geometric series is exact. */
static void check_height(const struct lit_volume *v)
{
    const double d = 0.02, falloff = 25, far = 400;
    struct brume_lighting l = lit_white();
    struct brume_fog fog = fog_of(d, falloff, far);
    l.fog = &fog;
    fog.base = BRUME_Q16(-40);
    struct brume_scene s = ray_scene(v, &l, k_eye, k_along);
    double should = exp(-d * exp(-50 / falloff) * far);
    double is = through(v, &s);
    tap_check(is_near(is, should), "fog by height, level: %.6f, %.6f", is,
              should);
    s = ray_scene(v, &l, k_eye, k_up);
    double sum = d * exp(-50 / falloff) * (1 - exp(-far / falloff)) /
                 (1 - exp(-1 / falloff));
    is = through(v, &s);
    tap_check(is_near(is, exp(-sum)), "fog by height, straight up: %.6f, %.6f",
              is, exp(-sum));
    fog.base = BRUME_Q16(60); /* 50 samples below it, then thinner */
    sum = d * (50 + (1 - exp(-(far - 50) / falloff)) / (1 - exp(-1 / falloff)));
    is = through(v, &s);
    tap_check(is_near(is, exp(-sum)), "from below its base: %.6f, %.6f", is,
              exp(-sum));
}

/* Chords of a sphere, hard and soft; steps are small to be an integral. */
static void check_sphere(const struct lit_volume *v)
{
    const double radius = 40, off = 24; /* half a chord is 32 */
    struct brume_lighting l = lit_white();
    struct brume_fog_shape shape = {.kind = BRUME_FOG_SPHERE};
    struct brume_fog fog = fog_of(0, 0, 1000);
    l.fog = &fog;
    fog.shapes = &shape;
    fog.shape_count = 1;
    shape.half[0] = q16(radius);
    shape.density = q32(0.01);
    for (int i = 0; i < 3; i++)
        shape.centre[i] = BRUME_Q16(k_eye[i] + 300 * k_along[i]);
    shape.centre[1] += BRUME_Q16(off);
    struct brume_scene s = ray_scene(v, &l, k_eye, k_along);
    s.step = ONE / 8;
    double is = through(v, &s);
    tap_check(fabs(is - exp(-0.01 * 64)) <= 0.01 / 8 * is,
              "a chord of 64 voxels of a hard sphere: %.5f, %.5f", is,
              exp(-0.01 * 64));
    shape.softness = ONE;
    /* 1 - (x^2 + off^2) / r^2 over the chord */
    double sum = 64 * (1 - off * off / radius / radius) -
                 2 * pow(32, 3) / 3 / radius / radius;
    is = through(v, &s);
    tap_check(is_near(is, exp(-0.01 * sum)),
              "of one that is soft all through: %.5f, %.5f", is,
              exp(-0.01 * sum));
    shape.softness = 0;
    shape.kind = BRUME_FOG_BOX;
    shape.half[1] = shape.half[2] = shape.half[0];
    is = through(v, &s);
    tap_check(fabs(is - exp(-0.01 * 100)) <= 0.01 / 8 * is,
              "through a box: %.5f, %.5f", is, exp(-0.01 * 100));
    for (int i = 0; i < 3; i++)
        s.eye[i] = shape.centre[i];
    for (int i = 0; i < 3; i++)
        s.target[i] = s.eye[i] + BRUME_Q16(64 * k_along[i]);
    is = through(v, &s);
    tap_check(fabs(is - exp(-0.01 * 50)) <= 0.01 / 8 * is,
              "from its middle: %.5f, %.5f", is, exp(-0.01 * 50));
}

/* Sunlight in fog by height: one sample of opaque thickness far up. */
static void check_sun(const struct lit_volume *v)
{
    struct brume_lighting l = lit_white();
    struct brume_fog fog = fog_of(0.01, 50, 300);
    l.fog = &fog;
    for (int below = 0; below < 2; below++) {
        struct brume_scene s = ray_scene(v, &l, k_eye, k_along);
        struct brume_radiance out;
        s.light = BRUME_LOG;
        s.sun[0] = 3;
        s.sun[1] = below ? -4 : 4;
        s.sun[2] = 0;
        /* density at height 10 above 0, along a rise of 0.8; or of far */
        double density = 0.01 * exp(-10 / 50.0);
        double depth = below ? density * 300 : density * 50 / 0.8;
        double lost = 1 - exp(-density * 300);
        lit_march(&frame, v, &s, &out);
        double is = out.light / 65536.0, should = lost * exp(-depth);
        tap_check(fabs(is - should) <= 4e-4 * should + 2.0 / 65536,
                  "light in fog, sun %s the horizon: %.5f, %.5f",
                  below ? "below" : "above", is, should);
    }
}

/// Surface ///

/* Rays of a cloud in fog that end by code. */
static int rays_ended(const struct lit_volume *v, struct brume_scene *s,
                      struct brume_lighting *l, uint16_t code)
{
    struct brume_surface surface = {depths, W};
    int clear = 0;
    for (int i = 0; i < RAYS; i++)
        depths[i] = code;
    l->surface = NULL;
    lit_march(&frame, v, s, first);
    l->surface = &surface;
    lit_march(&frame, v, s, second);
    l->surface = NULL;
    for (int i = 0; i < RAYS; i++)
        clear += second[i].transmittance == ONE && second[i].light == 0;
    return clear;
}

static void check_surface(const struct lit_volume *v, const struct brume_fog *f)
{
    struct brume_lighting l = lit_white();
    struct brume_scene s = lit_scene(v, W, H, &l);
    l.fog = f;
    const char *what = f != NULL ? "in fog" : "alone";
    tap_check(rays_ended(v, &s, &l, 0) == RAYS, "%s, all near: nothing is seen",
              what);
    rays_ended(v, &s, &l, 65535);
    tap_check(lit_differing(first, second, RAYS) == 0,
              "%s, all far: as without a surface", what);
    rays_ended(v, &s, &l, 65534);
    tap_check(lit_differing(first, second, RAYS) == 0,
              "%s, at the largest distance: the same", what);
}

/* Samples at whole distances 0, 1, 2...: those nearer than the surface. */
static void check_surface_edge(const struct lit_volume *v)
{
    struct brume_lighting l = lit_white();
    struct brume_fog fog = fog_of(0.01, 0, 300);
    struct brume_surface surface = {depths, 1};
    int bad = 0;
    l.fog = &fog;
    l.surface = &surface;
    for (uint32_t t = 1; t < 256; t++) {
        struct brume_scene s = ray_scene(v, &l, k_eye, k_along);
        depths[0] = (uint16_t)brume_depth_of(t * ONE);
        bad += !is_near(through(v, &s), exp(-0.01 * t));
        depths[0]++; /* behind sample t */
        bad += !is_near(through(v, &s), exp(-0.01 * (t + 1)));
    }
    tap_check(bad == 0, "no sample lies at a surface or behind it (%d do)",
              bad);
}

/// Sun map ///

/* A map across +y, 8x8 texels of 16 voxels, plane at y = 100. */
static struct brume_sun_map map_of(uint16_t value)
{
    struct brume_sun_map m = {.width = 8,
                              .height = 8,
                              .origin = {-64 * 65536, 100 * 65536, -64 * 65536},
                              .across = {128 * 65536, 0, 0},
                              .down = {0, 0, 128 * 65536},
                              .range = 200 * ONE,
                              .depth = texels,
                              .stride = 8};
    for (int i = 0; i < 64; i++)
        texels[i] = value;
    return m;
}

/* Light of a ray in thin uniform fog along x at height y. */
static uint32_t light_at(const struct lit_volume *v,
                         const struct brume_sun_map *map, double x, double y,
                         double far)
{
    const double from[3] = {x, y, 0.5}, way[3] = {1, 0, 0};
    struct brume_lighting l = lit_white();
    struct brume_fog fog = fog_of(0.01, 0, far);
    struct brume_radiance out;
    l.fog = &fog;
    l.sun_map = map;
    struct brume_scene s = ray_scene(v, &l, from, way);
    s.sun[0] = s.sun[2] = 0;
    s.sun[1] = 1;
    lit_march(&frame, v, &s, &out);
    return out.light;
}

static void check_sun_map(const struct lit_volume *v)
{
    struct brume_sun_map dark = map_of(0);
    uint32_t lit = light_at(v, NULL, -30, 10, 40);
    tap_check(lit > 0 && light_at(v, &dark, -30, 10, 40) == 0,
              "a map that is all dark: none of %u", lit);
    tap_check(light_at(v, &dark, -30, 101, 40) == lit,
              "above its plane it is light");
    tap_check(light_at(v, &dark, 80, 10, 40) == lit, "outside of it, too");
    struct brume_sun_map light = map_of(65535);
    tap_check(light_at(v, &light, -30, 10, 40) == lit, "all light: all");
    /* dark below y = 50, and 10 voxels of bias below that */
    struct brume_sun_map half = map_of(16384);
    half.bias = 10 * ONE;
    tap_check(light_at(v, &half, -30, 40.1, 40) == lit &&
                  light_at(v, &half, -30, 39.9, 40) == 0,
              "depth and bias say where the dark begins");
    /* Columns 0 .. 3 dark: between the middles of 3 and 4, x = -8 .. 8, the
     * share of light is (x + 8) / 16. */
    struct brume_sun_map edge = map_of(65535);
    for (int i = 0; i < 64; i++)
        texels[i] = i % 8 < 4 ? 0 : 65535;
    double whole = light_at(v, NULL, -30, 10, 1), worst = 0;
    for (int x = -12; x <= 12; x++) {
        double share = fmin(fmax((x + 8) / 16.0, 0), 1);
        double is = light_at(v, &edge, x, 10, 1) / whole;
        worst = fmax(worst, fabs(is - share));
    }
    tap_check(worst < 0.01, "between texels light is mixed by distance (%.4f)",
              worst);
}

/// However it is marched ///

static void march_tiles(struct brume_radiance *out, unsigned w, unsigned h)
{
    memset(out, 0x5a, RAYS * sizeof *out);
    for (unsigned y = 0; y < H; y += h)
        for (unsigned x = 0; x < W; x += w)
            if (brume_march_rect(&frame, x, y, W - x < w ? W - x : w,
                                 H - y < h ? H - y : h, out + y * W + x,
                                 W) != BRUME_OK)
                abort();
}

static void check_cut(const struct lit_volume *v, int light)
{
    static const char *const k_name[] = {"log", "uniform", "none", "cone",
                                         "cache"};
    struct brume_lighting l = lit_white();
    struct brume_fog fog = fog_of(0.004, 30, 200);
    struct brume_cache cache;
    struct brume_fog_shape shape = {.half = {12 * ONE, 9 * ONE, 7 * ONE},
                                    .kind = BRUME_FOG_BOX,
                                    .softness = ONE / 3,
                                    .density = 90000000};
    fog.shapes = &shape;
    fog.shape_count = 1;
    l.fog = &fog;
    if (brume_cache_baked(&cache, &v->volume) != BRUME_OK)
        abort();
    l.cache = &cache;
    struct brume_scene s = lit_scene(v, W, H, &l);
    s.light = (uint8_t)light;
    s.jitter = BRUME_JITTER_BOTH;
    s.noise = BRUME_NOISE_WHITE;
    s.step = 3 * ONE / 2;
    for (int i = 0; i < 3; i++)
        shape.centre[i] = s.target[i] + (int32_t)(15 * ONE);
    lit_march(&frame, v, &s, first);
    march_tiles(second, W, 1);
    int rows = lit_differing(first, second, RAYS);
    march_tiles(second, 5, 7);
    int tiles = lit_differing(first, second, RAYS);
    s.skip = false;
    lit_march(&frame, v, &s, second);
    tap_check(rows == 0 && tiles == 0 &&
                  lit_differing(first, second, RAYS) == 0,
              "%s, light %s: whole == rows == tiles, skip on == off", v->name,
              k_name[light]);
    /* The volume's own samples are where they are without fog. */
    fog.density = shape.density = 0;
    fog.far = 32766 * ONE;
    lit_march(&frame, v, &s, first);
    l.fog = NULL;
    lit_march(&frame, v, &s, second);
    int differ = 0;
    for (int i = 0; i < RAYS; i++)
        differ += first[i].light != second[i].light ||
                  first[i].transmittance != second[i].transmittance;
    tap_check(differ == 0, "%s, light %s: fog of density 0 is none", v->name,
              k_name[light]);
}

/// What is refused, and what is not ///

#define EXPECT(change, error) \
    do { \
        l = good; \
        fog = good_fog; \
        shape = good_shape; \
        map = good_map; \
        s = lit_scene(v, 8, 6, &l); \
        s.sun[0] = s.sun[2] = 0; \
        s.sun[1] = 1; \
        change; \
        tap_check(brume_begin_frame(&frame, &v->volume, &s) == (error), \
                  "%s gives " #error, #change); \
    } while (0)

static void check_ranges(const struct lit_volume *v)
{
    static struct brume_fog_shape many[BRUME_MAX_FOG_SHAPES + 1];
    struct brume_lighting good = lit_white(), l;
    struct brume_fog good_fog = fog_of(0.1, 10, 100), fog;
    struct brume_fog_shape good_shape = {.half = {ONE, ONE, ONE}}, shape;
    struct brume_sun_map good_map = map_of(0), map;
    struct brume_surface surface = {depths, 8};
    struct brume_scene s;
    good_fog.shapes = &shape;
    good_fog.shape_count = 1;
    good.fog = &fog;
    good.surface = &surface;
    good.sun_map = &map;
    for (int i = 0; i <= BRUME_MAX_FOG_SHAPES; i++)
        many[i] = good_shape;
    EXPECT(fog.falloff = 0, BRUME_OK);
    EXPECT(fog.falloff = ONE, BRUME_OK);
    EXPECT(fog.falloff = ONE - 1, BRUME_ERR_SCENE);
    EXPECT(fog.falloff = 0xffffffff, BRUME_OK);
    EXPECT(fog.density = 0xffffffff, BRUME_OK);
    EXPECT(fog.base = INT32_MIN, BRUME_OK);
    EXPECT(fog.far = ONE - 1, BRUME_ERR_SCENE);
    EXPECT(fog.far = 32766 * ONE, BRUME_OK);
    EXPECT(fog.far = 32766 * ONE + 1, BRUME_ERR_SCENE);
    EXPECT(fog.shapes = NULL, BRUME_ERR_SCENE);
    EXPECT((fog.shapes = many, fog.shape_count = BRUME_MAX_FOG_SHAPES),
           BRUME_OK);
    EXPECT((fog.shapes = many, fog.shape_count = BRUME_MAX_FOG_SHAPES + 1),
           BRUME_ERR_SCENE);
    EXPECT(fog.shape_count = 0xffffffff, BRUME_ERR_SCENE);
    EXPECT(shape.kind = BRUME_FOG_BOX, BRUME_OK);
    EXPECT(shape.kind = BRUME_FOG_BOX + 1, BRUME_ERR_SCENE);
    EXPECT(shape.half[1] = 0, BRUME_OK); /* a sphere has one */
    EXPECT((shape.kind = 1, shape.half[1] = 0), BRUME_ERR_SCENE);
    EXPECT(shape.half[0] = ONE - 1, BRUME_ERR_SCENE);
    EXPECT(shape.half[0] = 16384 * ONE, BRUME_OK);
    EXPECT(shape.half[0] = 16384 * ONE + 1, BRUME_ERR_SCENE);
    EXPECT(shape.softness = ONE, BRUME_OK);
    EXPECT(shape.softness = ONE + 1, BRUME_ERR_SCENE);
    EXPECT(shape.centre[2] = -BRUME_MAX_COORDINATE, BRUME_OK);
    EXPECT(shape.centre[2] = BRUME_MAX_COORDINATE + 1, BRUME_ERR_SCENE);
    EXPECT(shape.centre[0] = INT32_MIN, BRUME_ERR_SCENE);
    EXPECT(surface.depth = NULL, BRUME_ERR_SCENE);
    surface.depth = depths;
    EXPECT(surface.stride = 7, BRUME_ERR_SCENE);
    surface.stride = 8;
    EXPECT(map.width = 0, BRUME_ERR_SCENE);
    EXPECT((map.width = 9), BRUME_ERR_SCENE); /* stride */
    EXPECT(map.height = BRUME_MAX_SIZE, BRUME_OK);
    EXPECT(map.height = BRUME_MAX_SIZE + 1, BRUME_ERR_SCENE);
    EXPECT(map.depth = NULL, BRUME_ERR_SCENE);
    EXPECT(map.range = ONE - 1, BRUME_ERR_SCENE);
    EXPECT(map.range = 65535 * ONE, BRUME_OK);
    EXPECT(map.range = 65535 * ONE + 1, BRUME_ERR_SCENE);
    EXPECT(map.bias = 0xffffffff, BRUME_ERR_SCENE);
    EXPECT(map.origin[0] = BRUME_MAX_COORDINATE, BRUME_ERR_SCENE);
    EXPECT(map.across[0] = 0, BRUME_ERR_SCENE);
    EXPECT((map.down[0] = 1 << 23, map.down[2] = 0), BRUME_ERR_SCENE);
    EXPECT(map.down[1] = 1 << 14, BRUME_OK);
    EXPECT(map.down[1] = 1 << 16, BRUME_ERR_SCENE);
    EXPECT(s.sun[0] = 1, BRUME_ERR_SCENE); /* not across it */
    EXPECT(s.sun[1] = -1, BRUME_OK);
}

int main(void)
{
    struct brume_fog thin = fog_of(0.002, 40, 300);
    struct lit_volume v = lit_middle_cell();
    check_uniform(&v);
    check_height(&v);
    check_sphere(&v);
    check_sun(&v);
    check_surface_edge(&v);
    check_sun_map(&v);
    lit_volume_free(&v);
    for (int i = 0; i < LIT_CLOUDS; i++) {
        v = lit_cloud(i);
        for (int light = 0; light <= BRUME_CACHE; light++)
            check_cut(&v, light);
        if (i == 1) {
            check_surface(&v, NULL);
            check_surface(&v, &thin);
            check_ranges(&v);
        }
        lit_volume_free(&v);
    }
    return tap_done();
}
