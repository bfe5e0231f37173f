/* SPDX-License-Identifier: MIT */
/*
 * Lamps: their light at a sample against docs/light.md in double, its sum along
 * rays, shadows, extremes, and what is refused. test_lamp_clusters.c has their
 * culling.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/lit.h"
#include "tap.h"

#define ONE 0x10000u
#define Q30 1073741824.0
#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

enum { W = 48, H = 36, RAYS = W * H };

static struct brume_frame frame;
static struct brume_radiance first[RAYS], second[RAYS];
static struct brume_clusters clusters;
static struct brume_lamp lamps[BRUME_MAX_LAMPS + 1];

/// Definition ///

static double smoothstep(double from, double to, double x)
{
    if (x <= from || x >= to)
        return x > from;
    x = (x - from) / (to - from);
    return x * x * (3 - 2 * x);
}

/* What a lamp gives to p per unit of its colour. */
static double fall_at(const struct brume_lamp *lamp, const double p[3])
{
    double r = 0, along = 0, length = 0, size = lamp->size / 65536.0;
    double radius = lamp->radius / 65536.0;
    for (int i = 0; i < 3; i++) {
        double way = p[i] - lamp->position[i] / 65536.0;
        r += way * way;
        along += way * lamp->direction[i];
        length += (double)lamp->direction[i] * lamp->direction[i];
    }
    r = sqrt(r);
    if (r >= radius)
        return 0;
    double near = size / fmax(r, size), window = 1 - pow(r / radius, 4);
    double light = near * near * window * window;
    if (lamp->cos_outer == -(1 << 30) || r == 0)
        return light;
    return light * smoothstep(lamp->cos_outer / Q30, lamp->cos_inner / Q30,
                              along / (r * sqrt(length)));
}

/// One sample ///

static struct lit_volume block_of(uint32_t d)
{
    const int cells[3] = {8, 8, 8}, low[3] = {0, 0, 0}, high[3] = {64, 64, 64};
    return lit_block(cells, low, high, d);
}

/* Lighting of lamps alone. */
static struct brume_lighting lit_by(uint32_t count)
{
    struct brume_lighting l = {
        .lamps = lamps, .lamp_count = count, .clusters = &clusters};
    return l;
}

/* In the middle of what lit_one_sample sees, which is 22 x 17 voxels. */
static struct brume_lamp plain_lamp(double radius, double size)
{
    struct brume_lamp lamp = {.cos_outer = -(1 << 30)};
    for (int i = 0; i < 3; i++) {
        lamp.position[i] = 32 * (int32_t)ONE;
        lamp.colour[i] = ONE;
    }
    lamp.radius = (uint32_t)lrint(radius * ONE);
    lamp.size = (uint32_t)lrint(size * ONE);
    return lamp;
}

/* The largest error of all rays, in units of 2^-12 of what is right, plus two
 * of the result's own, plus 2^-20 per lamp, which its share is cut to: 1 is
 * good. The reciprocal is 2^-16 too low, the window and places of samples 2^-14
 * off. */
static double worst_of(const struct brume_scene *s, uint32_t count,
                       const struct brume_radiance *rays)
{
    double worst = 0;
    for (int i = 0; i < RAYS; i++) {
        double p[3], want = 0;
        lit_sample_position(s, i % W, i / W, p);
        for (uint32_t n = 0; n < count; n++)
            want += fall_at(&lamps[n], p) * lamps[n].colour[0] / 65536.0;
        double error = fabs(rays[i].light / 65536.0 - fmin(want, 8));
        worst = fmax(worst,
                     error / (want / 4096 + 2 / 65536.0 + count / 1048576.0));
    }
    return worst;
}

static void check_one(const struct lit_volume *v, uint32_t count,
                      const char *name)
{
    struct brume_lighting l = lit_by(count);
    struct brume_scene s = lit_one_sample(v, W, H, &l);
    uint32_t brightest = 0, dark = 0;
    lit_march(&frame, v, &s, first);
    for (int i = 0; i < RAYS; i++) {
        brightest = first[i].light > brightest ? first[i].light : brightest;
        dark += first[i].light == 0;
    }
    double worst = worst_of(&s, count, first);
    tap_check(worst <= 1 && brightest > 0,
              "%s: error %.2f of its bound, brightest %.3f, %lu rays dark",
              name, worst, brightest / 65536.0, (unsigned long)dark);
}

static void test_falls(const struct lit_volume *v)
{
    static const struct {
        double radius, size, off;
        const char *name;
    } k_falls[] = {
        {1000, 2, 0, "inverse squares far from the window"},
        {9, 2, 0, "a window that ends in sight"},
        {9, 9, 0, "radius = size: the window alone"},
        {12, 0.0625, 3, "the smallest size"},
        {16384, 16384, 0, "the largest radius, and size"},
        {16384, 0.0625, 1, "the largest radius, the smallest size"},
        {1, 1, 0.25, "the smallest radius"},
        {5, 0.5, 4, "a lamp beside what is seen"},
    };
    for (int i = 0; i < COUNT(k_falls); i++) {
        lamps[0] = plain_lamp(k_falls[i].radius, k_falls[i].size);
        lamps[0].position[1] += (int32_t)lrint(k_falls[i].off * ONE);
        for (int c = 0; c < 3; c++)
            lamps[0].colour[c] = k_falls[i].size < 1 ? 200 * ONE : ONE;
        check_one(v, 1, k_falls[i].name);
    }
}

static void test_spots(const struct lit_volume *v)
{
    static const struct {
        double outer, inner;
        int32_t direction[3];
        const char *name;
    } k_spots[] = {
        {0.5, 0.9, {-3, 2, -5}, "a spot's smoothstep"},
        {-0.9, 0.2, {1, 0, 0}, "a spot wider than a half space"},
        {0.99, 0.999, {480, -360, -800}, "a narrow spot along the view"},
        {-0.5, 1, {INT32_MAX, INT32_MIN, 7}, "a spot of the longest direction"},
        {0, 0.5, {0, -1, 0}, "a spot of the shortest direction"},
    };
    for (int i = 0; i < COUNT(k_spots); i++) {
        lamps[0] = plain_lamp(30, 4);
        lamps[0].position[0] += BRUME_Q16(-2.3);
        lamps[0].position[2] += BRUME_Q16(4.1);
        lamps[0].cos_outer = (int32_t)lrint(k_spots[i].outer * Q30);
        lamps[0].cos_inner = (int32_t)lrint(k_spots[i].inner * Q30);
        memcpy(lamps[0].direction, k_spots[i].direction,
               sizeof lamps[0].direction);
        check_one(v, 1, k_spots[i].name);
    }
}

/* Both cones the same: all or nothing, and both are there. */
static void test_hard_spot(const struct lit_volume *v)
{
    struct brume_lighting l = lit_by(1);
    struct brume_scene s = lit_one_sample(v, W, H, &l);
    int wrong = 0, lit = 0;
    lamps[0] = plain_lamp(30, 30);
    lamps[0].position[0] += 3 * (int32_t)ONE;
    lamps[0].cos_outer = lamps[0].cos_inner = 1 << 29;
    lamps[0].direction[0] = -1;
    lit_march(&frame, v, &s, first);
    lamps[0].cos_outer = -(1 << 30);
    lit_march(&frame, v, &s, second);
    for (int i = 0; i < RAYS; i++) {
        lit += first[i].light != 0;
        wrong += first[i].light != 0 && first[i].light != second[i].light;
    }
    tap_check(wrong == 0 && lit > RAYS / 20 && lit < RAYS - RAYS / 20,
              "both cones equal: lit or not, %d of %d rays are", lit, RAYS);
}

/* Many, some of them in one place, some dark. */
static void test_many(const struct lit_volume *v)
{
    uint32_t seed = 5;
    for (int i = 0; i < BRUME_MAX_LAMPS; i++) {
        lamps[i] = plain_lamp(lit_between(&seed, 1, 25), 1);
        for (int k = 0; k < 3; k++) {
            lamps[i].position[k] += lit_between(&seed, -9, 9) * (int32_t)ONE;
            lamps[i].colour[k] = i % 5 == 0 ? 0 : ONE / 4;
        }
    }
    check_one(v, BRUME_MAX_LAMPS, "as many lamps as may be");
    for (int i = 0; i < BRUME_MAX_LAMPS; i++) {
        lamps[i] = plain_lamp(20, 2);
        for (int c = 0; c < 3; c++)
            lamps[i].colour[c] = ONE / 16;
    }
    check_one(v, BRUME_MAX_LAMPS, "all in the same place");
    for (int i = 0; i < BRUME_MAX_LAMPS; i++)
        for (int c = 0; c < 3; c++)
            lamps[i].colour[c] = 256 * ONE;
    check_one(v, BRUME_MAX_LAMPS, "all of the brightest colour: light is 8");
}

/// Phase and shadow ///

/* The sample is the lamp's own place: no direction, so phase function and spot
 * are left out. */
static void test_own_place(const struct lit_volume *v)
{
    static struct brume_phase phase;
    const struct brume_phase_model m = {.g = 900000000};
    struct brume_lighting l = lit_by(1);
    struct brume_scene s = lit_one_sample(v, W, H, &l);
    brume_phase_build(&phase, &m, 0, 0);
    l.phase = &phase;
    /* an even number of pixels has none in the middle */
    s.width = s.height = 1;
    lamps[0] = plain_lamp(5, 1);
    lamps[0].cos_outer = 1 << 29;
    lamps[0].cos_inner = 1 << 29;
    lamps[0].direction[2] = 1;
    lamps[0].shadow_samples = 4;
    /* where the core has it */
    double p[3];
    lit_sample_position(&s, 0, 0, p);
    bool found = false;
    for (int n = 0; n < 27 && !found; n++) {
        int32_t step[3] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
        for (int i = 0; i < 3; i++)
            lamps[0].position[i] = (int32_t)lrint(p[i] * ONE) + step[i];
        lit_march(&frame, v, &s, first);
        found = first[0].light == ONE;
    }
    tap_check(found, "on a sample exactly: its colour, whatever its direction");
}

/* Where all is equally dense a shadow is exp(-extinction * distance), whatever
 * the number of samples and their jitter. */
static void test_shadows(const struct lit_volume *v, int filter)
{
    static const uint8_t k_samples[] = {1, 2, 7, 64};
    double worst = 0;
    lamps[0] = plain_lamp(40, 3);
    lamps[0].position[2] += 5 * (int32_t)ONE;
    for (int n = 0; n < COUNT(k_samples); n++) {
        struct brume_lighting l = lit_by(1);
        struct brume_scene s = lit_one_sample(v, W, H, &l);
        lamps[0].shadow_samples = k_samples[n];
        s.filter = (uint8_t)filter;
        s.jitter = n & 1 ? BRUME_JITTER_LIGHT : BRUME_JITTER_NONE;
        s.noise = BRUME_NOISE_WHITE;
        lit_march(&frame, v, &s, first);
        for (int i = 0; i < RAYS; i++) {
            double p[3], r = 0;
            lit_sample_position(&s, i % W, i / W, p);
            for (int k = 0; k < 3; k++)
                r += pow(p[k] - lamps[0].position[k] / 65536.0, 2);
            double want =
                fall_at(&lamps[0], p) *
                exp(-(double)s.light_density_scale / 4294967296.0 * sqrt(r));
            worst = fmax(worst, fabs(first[i].light / 65536.0 - want));
        }
    }
    /* tau is rounded to 1/4096, the light to 1/65536 */
    tap_check(worst <= 1 / 8192.0 + 2 / 65536.0,
              "shadows in a block, lookup %d: error %.6f", filter, worst);
}

/* Henyey and Greenstein's of the angle between ray and lamp. */
static void test_phase(const struct lit_volume *v)
{
    static struct brume_phase phase;
    const double g = 0.7;
    const struct brume_phase_model m = {.g = (int32_t)lrint(g * Q30)};
    struct brume_lighting l = lit_by(1);
    struct brume_scene s = lit_one_sample(v, W, H, &l);
    double worst = 0;
    brume_phase_build(&phase, &m, 0, 0);
    l.phase = &phase;
    lamps[0] = plain_lamp(60, 6);
    lit_march(&frame, v, &s, first);
    for (int i = 0; i < RAYS; i++) {
        double p[3], ray[3], r = 0, cosine = 0;
        lit_sample_position(&s, i % W, i / W, p);
        lit_ray(&s, i % W, i / W, ray);
        for (int k = 0; k < 3; k++) {
            double way = lamps[0].position[k] / 65536.0 - p[k];
            r += way * way;
            cosine += way * ray[k];
        }
        cosine /= sqrt(r);
        double want = fall_at(&lamps[0], p) * (1 - g * g) /
                      pow(1 + g * g - 2 * g * cosine, 1.5);
        worst = fmax(worst, fabs(first[i].light / 65536.0 / want - 1));
    }
    tap_check(worst <= 0.003, "phase function of the lamp: %.5f of it off",
              worst);
}

/// Along rays ///

/* A thin block: the sum over its samples in double. */
static void test_sum(const struct lit_volume *v)
{
    struct brume_lighting l = lit_by(1);
    struct brume_scene s = lit_scene(v, W, H, &l);
    const double extinction = 0.004, step = 0.75;
    double worst = 0, brightest = 0;
    s.density_scale = BRUME_Q32(0.004);
    s.step = BRUME_Q16(0.75);
    lamps[0] = plain_lamp(25, 3);
    lamps[0].position[0] = BRUME_Q16(20.5);
    for (int c = 0; c < 3; c++)
        lamps[0].colour[c] = 20 * ONE;
    lit_march(&frame, v, &s, first);
    for (int i = 0; i < RAYS; i++) {
        double ray[3], p[3], left = 1, want = 0;
        lit_ray(&s, i % W, i / W, ray);
        for (double t = 0; t < 400; t += step) {
            bool inside = true;
            for (int k = 0; k < 3; k++) {
                p[k] = s.eye[k] / 65536.0 + t * ray[k];
                inside = inside && p[k] >= -0.5 && p[k] < 63.5;
            }
            if (!inside)
                continue;
            double lost = left * -expm1(-extinction * step);
            want += 20 * lost * fall_at(&lamps[0], p);
            left -= lost;
        }
        worst = fmax(worst, fabs(first[i].light / 65536.0 - want));
        brightest = fmax(brightest, want);
    }
    /* a face may have a sample more or less: 20 * 0.003 of a fall there */
    tap_check(worst <= 0.002 && brightest > 0.1,
              "sum over a thin block: error %.6f of up to %.3f", worst,
              brightest);
}

/* The eye in the block, the lamp at the eye: no sample is nearer. */
static void test_at_eye(const struct lit_volume *v)
{
    struct brume_lighting l = lit_by(1);
    struct brume_scene s = lit_scene(v, W, H, &l);
    double lost = 1 - exp(-0.25), want = 0, left = 1;
    int wrong = 0;
    for (int i = 0; i < 3; i++) {
        s.eye[i] = 20 * (int32_t)ONE;
        s.target[i] = i == 2 ? 40 * (int32_t)ONE : s.eye[i];
    }
    s.fov = 10 * ONE;
    s.density_scale = BRUME_Q32(0.25);
    lamps[0] = plain_lamp(16, 1);
    memcpy(lamps[0].position, s.eye, sizeof s.eye);
    for (int t = 0; t < 16; t++, left *= 1 - lost) {
        double p[3] = {20, 20, 20 + t};
        want += left * lost * fall_at(&lamps[0], p);
    }
    lit_march(&frame, v, &s, first);
    for (int i = 0; i < RAYS; i++)
        wrong += fabs(first[i].light / 65536.0 - want) > want / 4096;
    tap_check(wrong == 0, "a lamp at the eye, in all directions the same: %.5f",
              want);
}

/// Colours ///

static void test_colours(const struct lit_volume *v)
{
    struct brume_lighting l = lit_by(2);
    struct brume_scene s = lit_one_sample(v, W, H, &l);
    int wrong = 0, grey = 0;
    for (int i = 0; i < 2; i++)
        lamps[i] = plain_lamp(20, 2);
    lamps[0].position[0] += 4 * (int32_t)ONE;
    lit_march(&frame, v, &s, first);
    for (int i = 0; i < RAYS; i++)
        grey += (first[i].green | first[i].blue) == 0;
    lamps[1].colour[0] = 0;
    lamps[1].colour[2] = 2 * ONE;
    lit_march(&frame, v, &s, second);
    for (int i = 0; i < RAYS; i++) {
        double p[3];
        lit_sample_position(&s, i % W, i / W, p);
        double a = fall_at(&lamps[0], p), b = fall_at(&lamps[1], p);
        const double want[3] = {a, a + b, a + 2 * b};
        const uint32_t is[3] = {second[i].light, second[i].green,
                                second[i].blue};
        for (int c = 0; c < 3; c++)
            wrong +=
                fabs(is[c] / 65536.0 - want[c]) > want[c] / 4096 + 2 / 65536.0;
    }
    tap_check(grey == RAYS, "grey lamps: light has one channel");
    tap_check(wrong == 0, "colours of lamps: three");
}

/* Exposure and albedo are of lamps, too, and their product may be 4096. */
static void test_exposure(const struct lit_volume *v)
{
    struct brume_lighting l = lit_by(1);
    struct brume_scene s = lit_one_sample(v, W, H, &l);
    double worst = 0;
    lamps[0] = plain_lamp(16384, 0.0625);
    lamps[0].position[1] += 3000 * (int32_t)ONE;
    for (int c = 0; c < 3; c++)
        lamps[0].colour[c] = 256 * ONE;
    l.exposure = 16 * ONE;
    s.albedo = ONE / 2;
    lit_march(&frame, v, &s, first);
    for (int i = 0; i < RAYS; i++) {
        double p[3];
        lit_sample_position(&s, i % W, i / W, p);
        double want = 256 * 16 * 0.5 * fall_at(&lamps[0], p);
        worst = fmax(worst, fabs(first[i].light / 65536.0 - want));
    }
    tap_check(worst <= 2 / 65536.0, "exposure 16, albedo 0.5, colour 256: %.7f",
              worst);
}

/// Refusals ///

static int begin(const struct lit_volume *v, const struct brume_lighting *l)
{
    struct brume_scene s = lit_one_sample(v, W, H, l);
    return brume_begin_frame(&frame, &v->volume, &s);
}

static void test_counts(const struct lit_volume *v)
{
    struct brume_lighting l = lit_by(0), none = lit_by(0);
    struct brume_scene s = lit_one_sample(v, W, H, &l);
    for (int i = 0; i <= BRUME_MAX_LAMPS; i++)
        lamps[i] = plain_lamp(10, 1);
    none.lamps = NULL;
    none.clusters = NULL;
    s.lighting = &none;
    lit_march(&frame, v, &s, first);
    s.lighting = &l;
    lit_march(&frame, v, &s, second);
    tap_check(lit_differing(first, second, RAYS) == 0, "no lamps: none");
    l.lamp_count = BRUME_MAX_LAMPS;
    tap_check(begin(v, &l) == BRUME_OK, "as many lamps as may be");
    l.lamp_count = BRUME_MAX_LAMPS + 1;
    tap_check(begin(v, &l) == BRUME_ERR_SCENE, "one more is refused");
    l.lamp_count = UINT32_MAX;
    s.lighting = &l;
    tap_check(begin(v, &l) == BRUME_ERR_SCENE && brume_state_bytes(&s) > 0,
              "so are 2^32 - 1, and no lamp is read beyond the limit");
    l.lamp_count = 1;
    l.clusters = NULL;
    tap_check(begin(v, &l) == BRUME_ERR_NULL, "no clusters");
    l = lit_by(1);
    l.lamps = NULL;
    tap_check(begin(v, &l) == BRUME_ERR_NULL, "no lamps where there are some");
    for (int c = 0; c < 3; c++)
        lamps[0].colour[c] = 0;
    l = lit_by(1);
    s.lighting = &l;
    lit_march(&frame, v, &s, second);
    tap_check(lit_differing(first, second, RAYS) == 0, "a black lamp: as none");
}

/* A lamp that is changed so is refused; and its neighbour by one unit is
 * not. */
static void check_field(const struct lit_volume *v, const char *name,
                        struct brume_lamp good, struct brume_lamp bad)
{
    struct brume_lighting l = lit_by(2);
    lamps[0] = plain_lamp(10, 1);
    lamps[1] = good;
    int taken = begin(v, &l);
    lamps[1] = bad;
    tap_check(taken == BRUME_OK && begin(v, &l) == BRUME_ERR_SCENE,
              "%s: taken at its limit, refused beyond", name);
}

static void test_fields(const struct lit_volume *v)
{
#define FIELD(name, field, at, beyond) \
    do { \
        struct brume_lamp good = base, bad = base; \
        good.field = (at); \
        bad.field = (beyond); \
        check_field(v, name, good, bad); \
    } while (0)
    struct brume_lamp base = plain_lamp(10, 1);
    base.cos_outer = 0;
    base.cos_inner = 1 << 29;
    base.direction[1] = -5;
    FIELD("radius, small", radius, ONE, ONE - 1);
    FIELD("radius, large", radius, 16384 * ONE, 16384 * ONE + 1);
    FIELD("size, small", size, ONE / 16, ONE / 16 - 1);
    FIELD("size, large", size, 10 * ONE, 10 * ONE + 1);
    FIELD("colour", colour[2], 256 * ONE, 256 * ONE + 1);
    FIELD("position", position[0], BRUME_MAX_COORDINATE,
          BRUME_MAX_COORDINATE + 1);
    FIELD("position below", position[1], -BRUME_MAX_COORDINATE,
          -BRUME_MAX_COORDINATE - 1);
    FIELD("shadow samples", shadow_samples, 64, 65);
    FIELD("outer cosine, large", cos_outer, 1 << 29, (1 << 29) + 1);
    FIELD("outer cosine, small", cos_outer, -(1 << 30), -(1 << 30) - 1);
    FIELD("inner cosine", cos_inner, 1 << 30, (1 << 30) + 1);
    FIELD("direction of a spot", direction[1], 1, 0);
    base.cos_outer = -(1 << 30);
    base.direction[1] = 0;
    base.cos_inner = INT32_MIN;
    struct brume_lighting l = lit_by(1);
    lamps[0] = base;
    tap_check(begin(v, &l) == BRUME_OK,
              "a point light has no direction and no inner cosine");
#undef FIELD
}

/// Sameness ///

/* Taa at rest must know: is the scene the same but for its lamp? */
static uint32_t same_of(const struct lit_volume *v, int32_t eye)
{
    struct brume_lighting l = lit_by(1);
    struct brume_scene s = lit_one_sample(v, W, H, &l);
    s.temporal = BRUME_TAA;
    s.alpha = ONE / 4;
    s.spatial = 0;
    s.eye[0] += eye;
    if (brume_begin_frame(&frame, &v->volume, &s) != BRUME_OK)
        abort();
    return frame.same;
}

static void test_sameness(const struct lit_volume *v)
{
    lamps[0] = plain_lamp(10, 1);
    lamps[0].direction[0] = 7;
    const struct brume_lamp was = lamps[0];
    uint32_t same = same_of(v, 0);
    bool tells = same_of(v, 5000) == same;
#define CHANGE(field, value) \
    lamps[0] = was; \
    lamps[0].field = (value); \
    tells = tells && same_of(v, 0) != same
    CHANGE(position[2], 5);
    CHANGE(radius, 11 * ONE);
    CHANGE(size, 2 * ONE);
    CHANGE(colour[1], 2 * ONE);
    CHANGE(direction[0], 8);
    CHANGE(cos_outer, 0);
    CHANGE(cos_inner, 1);
    CHANGE(shadow_samples, 1);
#undef CHANGE
    tap_check(tells, "taa at rest: each field of a lamp tells, the eye not");
}

int main(void)
{
    struct lit_volume v = block_of(65280);
    test_falls(&v);
    test_spots(&v);
    test_hard_spot(&v);
    test_many(&v);
    test_own_place(&v);
    test_shadows(&v, BRUME_NEAREST);
    test_shadows(&v, BRUME_TRILINEAR);
    test_shadows(&v, BRUME_STOCHASTIC);
    test_phase(&v);
    test_sum(&v);
    test_at_eye(&v);
    test_colours(&v);
    test_exposure(&v);
    test_counts(&v);
    test_fields(&v);
    test_sameness(&v);
    lit_volume_free(&v);
    return tap_done();
}
