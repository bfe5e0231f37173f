/* SPDX-License-Identifier: MIT */
/*
 * The keys of light, from text to the core's struct brume_lighting: what is
 * taken, what is refused, and what reaches the core, by the formulas of
 * docs/light.md.
 */
#include "tap.h"

#include "brume_noise_tables.h"
#include "support/scene_text.h"

/// Texts ///

static void test_light_colours(void)
{
    static const struct {
        const char *key;
        int index;
    } k_colours[] = {
        {"sun_colour", SCENE_SUN_COLOUR},
        {"ambient_colour", SCENE_AMBIENT_COLOUR},
        {"ambient_top", SCENE_AMBIENT_TOP},
        {"ambient_bottom", SCENE_AMBIENT_BOTTOM},
        {"ambient_px", SCENE_AMBIENT_PX},
        {"ambient_nx", SCENE_AMBIENT_NX},
        {"ambient_py", SCENE_AMBIENT_PY},
        {"ambient_ny", SCENE_AMBIENT_NY},
        {"ambient_pz", SCENE_AMBIENT_PZ},
        {"ambient_nz", SCENE_AMBIENT_NZ},
        {"sky_zenith", SCENE_SKY_ZENITH},
        {"sky_horizon", SCENE_SKY_HORIZON},
        {"sky_ground", SCENE_SKY_GROUND},
        {"sun_disc", SCENE_SUN_DISC},
    };
    char text[128];
    for (size_t i = 0; i < COUNT(k_colours); i++) {
        const char *key = k_colours[i].key;
        snprintf(text, sizeof text, "%s = 0.25", key);
        bool good = takes(text, k_colours[i].index, .25, .25, .25);
        snprintf(text, sizeof text, "%s = 0, 16,0.5", key);
        good = takes(text, k_colours[i].index, 0, 16, .5) && good;
        snprintf(text, sizeof text, "%s = 0,0,16.001", key);
        good = refuses(text, 1, "outside 0 to 16") && good;
        snprintf(text, sizeof text, "%s = -0.001", key);
        good = refuses(text, 1, "outside 0 to 16") && good;
        snprintf(text, sizeof text, "%s = 1,2", key);
        good = refuses(text, 1, "one number, or three") && good;
        tap_check(good, "%s: a grey or three channels, 0 to 16", key);
    }
}

/* A phase function with its parameters, and nothing else. */
static bool takes_phase(const char *text, double kind, double a, double b,
                        double c, double d)
{
    const double want[SCENE_VALUES] = {kind, a, b, c, d};
    char line[128];
    snprintf(line, sizeof line, "phase = %s", text);
    return read_text(line) == 0 &&
           memcmp(settings.value[SCENE_PHASE], want, sizeof want) == 0;
}

static void test_phase_texts(void)
{
    static const char *const k_none[] = {
        "",       "hg",       "hg:",         "hg:0.5,0.5", "hg 0.5",
        "HG:0.5", "draine:1", "isotropic:0", "mix:1,2,0",  "mix:1,2,0,0,0",
        "hg:nan", "hg:0x1",   "droplet:",    "rayleigh",   "droplet:10um"};
    static const char *const k_outside[] = {
        "hg:0.9991",      "hg:-0.9991",       "schlick:1",
        "draine:-1,0",    "draine:1024.01,0", "draine:1,-0.9991",
        "droplet:0.049",  "droplet:50.01",    "mix:1.01,1,0,0",
        "mix:-0.01,1,0,0"};
    char text[128];
    bool good = true;
    tap_check(takes_phase("isotropic", 0, 0, 0, 0, 0) &&
                  takes_phase("hg:-0.999", 1, -.999, 0, 0, 0) &&
                  takes_phase("schlick:0.5", 2, .5, 0, 0, 0) &&
                  takes_phase("draine:1024, -0.5", 3, 1024, -.5, 0, 0) &&
                  takes_phase("droplet:0.05", 4, .05, 0, 0, 0) &&
                  takes_phase("droplet:50", 4, 50, 0, 0, 0) &&
                  takes_phase("mix:0.25,20,0.5,0.999", 5, .25, 20, .5, .999),
              "phase: each of its words, with their numbers");
    for (size_t i = 0; i < COUNT(k_none); i++) {
        snprintf(text, sizeof text, "phase = %s", k_none[i]);
        good = refuses(text, 1, "phase is one of isotropic hg:G") && good;
    }
    tap_check(good, "phase: no other word, and no other count of numbers");
    good = true;
    for (size_t i = 0; i < COUNT(k_outside); i++) {
        snprintf(text, sizeof text, "phase = %s", k_outside[i]);
        good = refuses(text, 1, "outside") && good;
    }
    tap_check(good, "phase: each number has its range");
}

/// Lighting ///

static void test_no_lighting(void)
{
    static const char k_said[] =
        "phase = isotropic\noctaves = 1\noctave_a = 0.1\nsun_colour = 1\n"
        "exposure = 1\nambient = none\nambient_top = 1\n"
        "visibility = sampled\nsky = off\nsky_zenith = 1\nhaze = 0\n"
        "dither = off\n";
    struct volume_file file = make_block(&k_plain);
    struct brume_scene s;
    tap_check(apply_text("", &file, &s) == 0 && s.lighting == NULL,
              "no lighting by default");
    tap_check(apply_text(k_said, &file, &s) == 0 && s.lighting == NULL,
              "nor where its keys say what a scene without them is");
    static const char *const k_each[] = {
        "phase = hg:0",       "octaves = 2", "sun_colour = 1,1,0.99",
        "exposure = 1.01",    "sky = on",    "haze = 1",
        "ambient = constant", "dither = on", "light = cache"};
    int without = 0;
    for (size_t i = 0; i < COUNT(k_each); i++)
        without += apply_text(k_each[i], &file, &s) != 0 || s.lighting == NULL;
    tap_check(without == 0, "each of the others makes one (%d do not)",
              without);
    memset(&settings, 0, sizeof settings);
    read_text("fov = 30");
    bool good = scene_apply(&settings, &file, &s, NULL, err, sizeof err) == 0;
    read_text("fov = 30\nhaze = 7");
    tap_check(good && is_refusal(scene_apply(&settings, &file, &s, NULL, err,
                                             sizeof err),
                                 2, "no haze here"),
              "without memory for lighting its keys are refused");
    free(file.data);
}

static bool is_colour(const uint32_t got[3], uint32_t r, uint32_t g, uint32_t b)
{
    return got[0] == r && got[1] == g && got[2] == b;
}

static void test_lighting(void)
{
    struct volume_file file = make_block(&k_plain);
    struct brume_scene s;
    struct brume_frame frame;
    bool good = apply_text("octaves = 8\noctave_a = 0.25\noctave_b = 0.75\n"
                           "sun_colour = 16,0.5,0\nexposure = 2\nhaze = 100.5\n"
                           "ambient = gradient\nambient_top = 1,2,3\n"
                           "ambient_bottom = 0.25\nvisibility = sampled\n"
                           "visibility_samples = 5\nvisibility_step = 1.5\n"
                           "output = filmic\ndither = on\n",
                           &file, &s) == 0;
    const struct brume_lighting *l = s.lighting;
    tap_check(good && l->octaves == 8 && l->octave_a == 0x4000 &&
                  l->octave_b == 0xc000 && l->exposure == 0x20000 &&
                  is_colour(l->sun_colour, 0x100000, 0x8000, 0) &&
                  l->phase == NULL && l->haze == 0x648000 && !l->sky &&
                  l->dither && s.output == BRUME_FILMIC,
              "sun, octaves and the rest reach the core in its own units");
    tap_check(good && l->ambient == BRUME_AMBIENT_GRADIENT &&
                  is_colour(l->ambient_colour[0], 0x10000, 0x20000, 0x30000) &&
                  is_colour(l->ambient_colour[1], 0x4000, 0x4000, 0x4000) &&
                  l->visibility == BRUME_SKY_SAMPLED &&
                  l->visibility_samples == 5 && l->visibility_step == 0x18000 &&
                  l->directions == &brume_noise_hemisphere,
              "so does ambient light");
    tap_check(brume_begin_frame(&frame, &file.volume, &s) == BRUME_OK,
              "and it takes them");
    /* 38 x 26 x 14 voxels: a diagonal of 48.1. */
    good = apply_text("ambient = constant\nambient_colour = 0.5", &file, &s) ==
               0 &&
           s.lighting->visibility_samples == 5 &&
           s.lighting->visibility_step == 0x20000;
    tap_check(good && is_colour(s.lighting->ambient_colour[0], 0x8000, 0x8000,
                                0x8000),
              "2^5 steps of two voxels to the sky, by default");
    free(file.data);
}

/* 4 pi p of a scene's octave, in double. */
static double phase_at(const struct brume_scene *s, int octave, double cosine)
{
    uint32_t u = (uint32_t)floor((1 - cosine) * 1073741824.0 + 0.5);
    struct brume_number n = brume_phase_value(&s->lighting->phase[octave], u);
    return ldexp((double)n.m, n.e);
}

static double hg(double g, double cosine)
{
    return (1 - g * g) / pow(1 + g * g - 2 * g * cosine, 1.5);
}

static double draine(double alpha, double g, double cosine)
{
    return hg(g, cosine) * (1 + alpha * cosine * cosine) /
           (1 + alpha * (1 + 2 * g * g) / 3);
}

/* docs/light.md, for the kinds of the tests below. */
static double phase_of(int kind, double scale, double cosine)
{
    double k = 1.55 * 0.6 * scale - 0.55 * pow(0.6 * scale, 3);
    switch (kind) {
    case 0: return hg(0.8 * scale, cosine);
    case 1: return (1 - k * k) / pow(1 - k * cosine, 2);
    case 2: return draine(12 * scale, -0.4 * scale, cosine);
    case 3:
        return 0.3 * draine(20 * scale, 0.5 * scale, cosine) +
               0.7 * hg(0.95 * scale, cosine);
    default: /* 10 um: see test_droplet.c */
        return 0.481955 * draine(21.995521 * scale, 0.555671 * scale, cosine) +
               (1 - 0.481955) * hg(0.988177 * scale, cosine);
    }
}

static void test_phases(void)
{
    static const char *const k_text[] = {"hg:0.8", "schlick:0.6",
                                         "draine:12,-0.4",
                                         "mix:0.3,20,0.5,0.95", "droplet:10"};
    struct volume_file file = make_block(&k_plain);
    char text[128];
    for (int kind = 0; kind < (int)COUNT(k_text); kind++) {
        struct brume_scene s;
        double worst = 0;
        snprintf(text, sizeof text,
                 "phase = %s\noctaves = 3\noctave_c = 0.75\n", k_text[kind]);
        bool good =
            apply_text(text, &file, &s) == 0 && s.lighting->phase != NULL;
        for (int octave = 0; good && octave < 3; octave++)
            for (double c = -1; c <= 1; c += 0.01) {
                double want = phase_of(kind, pow(0.75, octave), c);
                worst = fmax(worst, fabs(phase_at(&s, octave, c) / want - 1));
            }
        tap_check(good && worst < 0.003,
                  "phase = %s: 3 octaves as the formula to %.2f %%",
                  k_text[kind], 100 * worst);
    }
    free(file.data);
}

static void test_sky(void)
{
    struct volume_file file = make_block(&k_plain);
    struct brume_scene s;
    bool good = apply_text("sky = on\nsky_zenith = 1,2,4\nsky_horizon = 0.5\n"
                           "sky_ground = 0,16,0\nsun_disc = 8,4,2\n"
                           "sun_size = 30\n",
                           &file, &s) == 0;
    const struct brume_lighting *l = s.lighting;
    tap_check(good && l->sky &&
                  is_colour(l->sky_zenith, 0x10000, 0x20000, 0x40000) &&
                  is_colour(l->sky_horizon, 0x8000, 0x8000, 0x8000) &&
                  is_colour(l->sky_ground, 0, 0x100000, 0) &&
                  is_colour(l->sun_disc, 0x80000, 0x40000, 0x20000),
              "the sky's colours reach the core");
    /* 1 - cos 30 degrees, and of the sun's 0.27 */
    tap_check(good && l->sun_size == 143854127,
              "the disc's radius of 30 degrees is %lu",
              (unsigned long)l->sun_size);
    good = apply_text("sky = on", &file, &s) == 0;
    tap_check(good && s.lighting->sun_size == 11922, "the sun's own is %lu",
              (unsigned long)s.lighting->sun_size);
    good = apply_text("sky = on\nsun_size = 0", &file, &s) == 0;
    tap_check(good && s.lighting->sun_size == 0, "0 is no disc");
    tap_check(s.lighting->zenith[0] == 0 && s.lighting->zenith[1] == 1 << 30 &&
                  s.lighting->zenith[2] == 0,
              "up is +Y");
    free(file.data);
    file = make_block(&k_turned);
    double up[3], y[3] = {0, 1, 0};
    good = apply_text("sky = on", &file, &s) == 0;
    world_way(&k_turned, s.lighting->zenith, up);
    tap_check(good && is_near(up, y, 1e-8), "also in a turned volume");
    free(file.data);
}

/* The colour that the core's six give in a direction of the pool. */
static double cube_in(const struct brume_lighting *l, const double u[3])
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += u[i] * u[i] * l->ambient_colour[2 * i + (u[i] < 0)][0] / 65536.0;
    return sum;
}

static void test_cube(void)
{
    static const char k_text[] =
        "ambient = cube\nambient_px = 1,0,0\nambient_nx = 2\n"
        "ambient_py = 3\nambient_ny = 4\nambient_pz = 5\nambient_nz = 6\n";
    struct volume_file file = make_block(&k_plain);
    struct brume_scene s;
    bool good = apply_text(k_text, &file, &s) == 0 &&
                is_colour(s.lighting->ambient_colour[0], 0x10000, 0, 0);
    for (uint32_t i = 1; good && i < 6; i++) {
        uint32_t v = (i + 1) << 16;
        good = is_colour(s.lighting->ambient_colour[i], v, v, v);
    }
    tap_check(good, "the cube's six colours are those of +x -x +y -y +z -z");
    free(file.data);
    /* Two colours opposite each other keep their sum in any axes, and a cube
     * of one colour is that one. */
    file = make_block(&k_turned);
    double sum = 0, least = 9, most = 0;
    good = apply_text(k_text, &file, &s) == 0;
    for (int i = 0; good && i < 6; i++)
        sum += s.lighting->ambient_colour[i][1] / 65536.0;
    tap_check(good && fabs(sum - 20) < 1e-3,
              "turned: six colours add up to what they did, %.4f", sum);
    good = apply_text("ambient = cube\nambient_px = 2\nambient_nx = 2\n"
                      "ambient_py = 2\nambient_ny = 2\nambient_pz = 2\n"
                      "ambient_nz = 2\n",
                      &file, &s) == 0;
    for (int k = 0; good && k < 8; k++) {
        const double a = sqrt(1 / 3.0);
        const double u[3] = {k & 1 ? a : -a, k & 2 ? a : -a, k & 4 ? a : -a};
        double v = cube_in(s.lighting, u);
        least = fmin(least, v);
        most = fmax(most, v);
    }
    tap_check(good && fabs(least - 2) < 1e-4 && fabs(most - 2) < 1e-4,
              "turned: one colour is the same from everywhere");
    free(file.data);
}

static void test_lighting_limits(void)
{
    static const uint8_t k_mips[1];
    struct volume_file file = make_block(&k_plain);
    struct brume_scene s;
    tap_check(is_refusal(apply_text("fov = 30\nlight = cone", &file, &s), 2,
                         "light = cone needs a volume that was baked with "
                         "--mips"),
              "cone without mips is refused by its line");
    tap_check(is_refusal(apply_text("ambient = constant\nvisibility = baked",
                                    &file, &s),
                         2, "visibility = baked needs"),
              "so is a baked visibility that is not there");
    tap_check(
        is_refusal(apply_text("light_samples = 17\nlight = cone", &file, &s), 1,
                   "light_samples is 17, cone takes up to 16"),
        "cone takes no 17 samples");
    file.volume.mips = k_mips; /* whatever is in them */
    bool good = apply_text("light = cone", &file, &s) == 0 &&
                s.light_samples == 7 && s.light_step == 65536;
    good = apply_text("light = cone\nlight_step = 4", &file, &s) == 0 && good;
    tap_check(good && s.light_samples == 3,
              "cone crosses the box of 48 by 7 samples, by 3 of four voxels");
    free(file.data);
}

int main(void)
{
    texts_begin();
    test_light_colours();
    test_phase_texts();
    test_no_lighting();
    test_lighting();
    test_phases();
    test_sky();
    test_cube();
    test_lighting_limits();
    texts_end();
    return tap_done();
}
