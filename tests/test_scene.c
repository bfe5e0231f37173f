/* SPDX-License-Identifier: MIT */
/*
 * Scene files and --set, from text to the core's scene and back: what is
 * taken, what is refused and in which words, and where the camera ends up.
 */
#include "tap.h"

#include "brume_inner.h"
#include "noises.h"
#include "support/scene_text.h"

/// Keys ///

struct range {
    const char *key;
    int index;
    const char *low, *high, *below, *above;
    double min, max;
};

/* Keys of one number, with their ends and what is just beyond. */
static const struct range k_ranges[] = {
    {"fov", SCENE_FOV, "1", "160", "0.9999999", "160.00001", 1, 160},
    {"density_scale", SCENE_DENSITY_SCALE, "0", "4294967295", "-1e-9",
     "4294967296", 0, 4294967295.0},
    {"light_density_scale", SCENE_LIGHT_DENSITY_SCALE, "0", "4294967295",
     "-1e-9", "4294967296", 0, 4294967295.0},
    {"albedo", SCENE_ALBEDO, "0", "1", "-1e-9", "1.0000001", 0, 1},
    {"step", SCENE_STEP, "0.0625", "256", "0.0624999", "256.00001", 0.0625,
     256},
    {"min_density", SCENE_MIN_DENSITY, "0", "1e9", "-1e-9", "1000000001", 0,
     1e9},
    {"min_transmittance", SCENE_MIN_TRANSMITTANCE, "0", "1", "-1e-9",
     "1.0000001", 0, 1},
    {"max_density", SCENE_MAX_DENSITY, "0", "1e9", "-1e-9", "1000000001", 0,
     1e9},
    {"light_samples", SCENE_LIGHT_SAMPLES, "0", "4096", "-1", "4097", 0, 4096},
    {"light_step", SCENE_LIGHT_STEP, "0.0625", "256", "0.0624999", "256.00001",
     0.0625, 256},
    {"frame", SCENE_FRAME, "0", "4294967295", "-1", "4294967296", 0,
     4294967295.0},
    {"window", SCENE_WINDOW, "1", "16", "0", "17", 1, 16},
    {"alpha", SCENE_ALPHA, "0.015625", "1", "0.0156249", "1.0000001", 0.015625,
     1},
    {"gamma", SCENE_GAMMA, "0", "16", "-1e-9", "16.00001", 0, 16},
    {"edge_falloff", SCENE_EDGE_FALLOFF, "0", "1024", "-1e-9", "1024.0001", 0,
     1024},
    {"octaves", SCENE_OCTAVES, "1", "8", "0", "9", 1, 8},
    {"octave_a", SCENE_OCTAVE_A, "0", "1", "-1e-9", "1.0000001", 0, 1},
    {"octave_b", SCENE_OCTAVE_B, "0", "1", "-1e-9", "1.0000001", 0, 1},
    {"octave_c", SCENE_OCTAVE_C, "0", "1", "-1e-9", "1.0000001", 0, 1},
    {"exposure", SCENE_EXPOSURE, "0.00390625", "16", "0.0039062", "16.00001",
     0.00390625, 16},
    {"visibility_samples", SCENE_VISIBILITY_SAMPLES, "0", "16", "-1", "17", 0,
     16},
    {"visibility_step", SCENE_VISIBILITY_STEP, "0.0625", "256", "0.0624999",
     "256.00001", 0.0625, 256},
    {"sun_size", SCENE_SUN_SIZE, "0", "45", "-1e-9", "45.00001", 0, 45},
    {"haze", SCENE_HAZE, "0", "65535", "-1e-9", "65535.01", 0, 65535},
};

static void test_ranges(void)
{
    char text[128];
    for (size_t i = 0; i < COUNT(k_ranges); i++) {
        const struct range *r = &k_ranges[i];
        snprintf(text, sizeof text, "%s = %s", r->key, r->low);
        bool good = takes(text, r->index, r->min, 0, 0);
        snprintf(text, sizeof text, "%s=%s\n", r->key, r->high);
        good = takes(text, r->index, r->max, 0, 0) && good;
        snprintf(text, sizeof text, "%s = %s", r->key, r->below);
        good = refuses(text, 1, "outside") && good;
        snprintf(text, sizeof text, "%s = %s", r->key, r->above);
        good = refuses(text, 1, "outside") && good;
        tap_check(good, "%s: %s to %s, not %s, not %s", r->key, r->low, r->high,
                  r->below, r->above);
    }
}

static void test_size(void)
{
    tap_check(takes("size = 640x480", SCENE_SIZE, 640, 480, 0) &&
                  takes("size = 1 x 16384", SCENE_SIZE, 1, 16384, 0) &&
                  takes("size = 16384x1", SCENE_SIZE, 16384, 1, 0),
              "size: 1 to 16384 each way, spaces around the x");
    tap_check(refuses("size = 0x480", 1, "outside 1 to 16384") &&
                  refuses("size = 640x0", 1, "outside") &&
                  refuses("size = 16385x480", 1, "outside") &&
                  refuses("size = 640x16385", 1, "outside") &&
                  refuses("size = -640x480", 1, "outside"),
              "size: not 0, not 16385, not negative");
    tap_check(refuses("size = 640", 1, "two whole numbers WxH") &&
                  refuses("size = 640x", 1, "two whole numbers WxH") &&
                  refuses("size = x480", 1, "two whole numbers WxH") &&
                  refuses("size = 640x480x3", 1, "two whole numbers WxH") &&
                  refuses("size = 640.5x480", 1, "two whole numbers WxH") &&
                  refuses("size = 640X480", 1, "two whole numbers WxH"),
              "size: exactly two whole numbers");
}

static void test_vectors(void)
{
    static const struct {
        const char *name;
        int index;
    } k_vectors[] = {
        {"eye", SCENE_EYE}, {"target", SCENE_TARGET}, {"up", SCENE_UP}};
    char text[128];
    for (size_t i = 0; i < COUNT(k_vectors); i++) {
        static const char *const k_good[] = {
            "-1.5,2,300",   "-1.5 2 300",       " -1.5 , 2 ,300 ",
            "-1.5\t+2,3e2", "-15e-1, 2.0 300.", "-01.5,2,3.0E+2"};
        static const char *const k_bad[] = {"1,2", "1 2 3 4", "1,2,3,4", "7"};
        const char *name = k_vectors[i].name;
        bool good = true;
        for (size_t k = 0; k < COUNT(k_good); k++) {
            snprintf(text, sizeof text, "%s = %s", name, k_good[k]);
            good = takes(text, k_vectors[i].index, -1.5, 2, 300) && good;
        }
        tap_check(good, "%s: with commas, spaces, both, tabs", name);
        for (size_t k = 0; k < COUNT(k_bad); k++) {
            snprintf(text, sizeof text, "%s = %s", name, k_bad[k]);
            good = refuses(text, 1, "three numbers x,y,z") && good;
        }
        snprintf(text, sizeof text, "%s = 1e9,-1e9,0", name);
        good = takes(text, k_vectors[i].index, 1e9, -1e9, 0) && good;
        snprintf(text, sizeof text, "%s = 0,0,1.001e9", name);
        good = refuses(text, 1, "outside") && good;
        snprintf(text, sizeof text, "%s = 0,-1.001e9,0", name);
        good = refuses(text, 1, "outside") && good;
        tap_check(good, "%s: exactly three, from -1e9 to 1e9", name);
    }
}

static void test_sun_and_background(void)
{
    tap_check(takes("sun = -60 30", SCENE_SUN, -60, 30, 0) &&
                  takes("sun = 3600,-3600", SCENE_SUN, 3600, -3600, 0) &&
                  refuses("sun = 3600.1 0", 1, "outside") &&
                  refuses("sun = 0 -3600.1", 1, "outside"),
              "sun: two angles, -3600 to 3600");
    tap_check(refuses("sun = 1", 1, "two numbers, azimuth elevation") &&
                  refuses("sun = 1 2 3", 1, "two numbers, azimuth elevation"),
              "sun: exactly two");
    tap_check(takes("background = 0.25", SCENE_BACKGROUND, .25, .25, .25) &&
                  takes("background = 0,1,.5", SCENE_BACKGROUND, 0, 1, .5) &&
                  takes("background = 1 0 0", SCENE_BACKGROUND, 1, 0, 0),
              "background: a grey or three channels");
    tap_check(refuses("background = 0.1 0.2", 1, "one number, or three") &&
                  refuses("background = 0 0 0 0", 1, "one number, or three") &&
                  refuses("background = 1.001", 1, "outside 0 to 1") &&
                  refuses("background = 0,0,-0.001", 1, "outside 0 to 1"),
              "background: not two, not four, 0 to 1");
}

/* Tables that the program makes of others. */
static void test_made_noises(void)
{
    struct scene_settings set;
    struct brume_scene s;
    int wrong = 0, uneven = 0, histogram[256] = {0};
    memset(&set, 0, sizeof set);
    scene_set(&set, "noise = bayer8-golden", "test", err, sizeof err);
    noise_choose((unsigned)set.value[SCENE_NOISE][0], &s);
    for (uint32_t i = 0; i < 1024; i++) {
        uint32_t x = i % 32, y = i / 32;
        uint32_t j = brume_noise_value(s.noise, s.noise_table, x, y, 0, 0);
        uint32_t k = brume_noise_value(BRUME_NOISE_BAYER8, NULL, x, y, 0, 0);
        wrong += j >> 8 != k >> 8;
    }
    tap_check(wrong == 0, "bayer8-golden: frame 0 is bayer8, to 8 bits");
    scene_set(&set, "noise = nrooks", "test", err, sizeof err);
    noise_choose((unsigned)set.value[SCENE_NOISE][0], &s);
    for (uint32_t i = 0; i < 4096; i++) {
        uint32_t x = i % 64, y = i / 64;
        histogram[brume_noise_value(s.noise, s.noise_table, x, y, 7, 0) >> 8]++;
    }
    for (int i = 0; i < 256; i++)
        uneven += histogram[i] != 16;
    tap_check(uneven == 0 && s.noise_table->frames_log2 == 4,
              "nrooks: 16 frames, each with every value 16 times");
}

static const struct {
    const char *key;
    int index;
    const char *words[22];
} k_words[] = {
    {"filter", SCENE_FILTER, {"nearest", "trilinear", "stochastic"}},
    {"light", SCENE_LIGHT, {"log", "uniform", "none", "cone", "cache"}},
    {"jitter", SCENE_JITTER, {"none", "primary", "light", "both"}},
    {"noise",
     SCENE_NOISE,
     {"none",        "white",      "ign",        "bayer8",        "bayer4",
      "bayer16",     "ign-thesis", "rank1",      "white8",        "blue",
      "blue-slices", "stbn",       "stbn-small", "stbn-tiny",     "fast",
      "fast-small",  "fast-tiny",  "golden",     "bayer8-golden", "r2",
      "nrooks"}},
    {"output", SCENE_OUTPUT, {"linear", "srgb", "filmic"}},
    {"skip", SCENE_SKIP, {"off", "on"}},
    {"temporal", SCENE_TEMPORAL, {"none", "ema", "window", "taa"}},
    {"history_bits", SCENE_HISTORY_BITS, {"8", "16"}},
    {"fetch", SCENE_FETCH, {"bilinear", "catmull-rom"}},
    {"clamp", SCENE_CLAMP, {"none", "minmax", "variance"}},
    {"spatial",
     SCENE_SPATIAL,
     {"none", "box3", "box5", "gauss1", "binomial3", "binomial5",
      "bilateral15"}},
    {"resolution", SCENE_RESOLUTION, {"full", "half", "quarter"}},
    {"update", SCENE_UPDATE, {"all", "checker", "bayer4"}},
    {"upsample", SCENE_UPSAMPLE, {"bilinear", "aware"}},
    {"subpixel", SCENE_SUBPIXEL, {"off", "on"}},
    {"cut", SCENE_CUT, {"off", "on"}},
    {"ambient", SCENE_AMBIENT, {"none", "constant", "gradient", "cube"}},
    {"visibility", SCENE_VISIBILITY, {"open", "sampled", "baked"}},
    {"cache_spacing", SCENE_CACHE_SPACING, {"auto", "2", "4", "8"}},
    {"sky", SCENE_SKY, {"off", "on"}},
    {"dither", SCENE_DITHER, {"off", "on"}},
};

static void test_words(void)
{
    static const char *const k_bad[] = {"",        "n", "nonee", "On",
                                        "log ign", "1", "NONE",  "no ne"};
    char text[128];
    for (size_t i = 0; i < COUNT(k_words); i++) {
        bool good = true;
        for (int k = 0; k_words[i].words[k]; k++) {
            snprintf(text, sizeof text, "%s = %s", k_words[i].key,
                     k_words[i].words[k]);
            good = takes(text, k_words[i].index, k, 0, 0) && good;
        }
        for (size_t k = 0; k < COUNT(k_bad); k++) {
            snprintf(text, sizeof text, "%s = %s", k_words[i].key, k_bad[k]);
            good = refuses(text, 1, "is one of ") &&
                   strstr(err, k_words[i].words[0]) && good;
        }
        tap_check(good, "%s: each of its words, in lower case, no other",
                  k_words[i].key);
    }
}

/* What strtod or a careless reader would take. */
static void test_bad_numbers(void)
{
    static const char *const k_bad[] = {
        "",         "nan",   "-nan",          "NAN",   "inf",   "-inf",
        "infinity", "1e999", "0x10",          "0X1p3", "-0x1",  "0x",
        "1..2",     "1-2",   "1+1",           "--1",   "+",     ".",
        "e5",       "1e",    "1.2.3",         "abc",   "1a",    "1;2",
        "1,",       ",1",    "1,,2",          "1/2",   "1'000", "$",
        "\"1\"",    "(1)",   "1 000 000 000", "= 1"};
    char text[200], many[100];
    memset(many, '9', sizeof many - 1);
    many[sizeof many - 1] = '\0';
    for (size_t i = 0; i < COUNT(k_ranges); i++) {
        bool good = true;
        for (size_t k = 0; k < COUNT(k_bad); k++) {
            snprintf(text, sizeof text, "%s = %s", k_ranges[i].key, k_bad[k]);
            good = refuses(text, 1, k_ranges[i].key) && good;
        }
        snprintf(text, sizeof text, "%s = %s", k_ranges[i].key, many);
        good = refuses(text, 1, k_ranges[i].key) && good;
        tap_check(good, "%s: not nan, inf, hexadecimal, empty, two numbers...",
                  k_ranges[i].key);
    }
    tap_check(refuses("eye = 1,nan,2", 1, "three numbers") &&
                  refuses("up = 0 inf 0", 1, "three numbers") &&
                  refuses("sun = 1e999 0", 1, "two numbers") &&
                  refuses("size = 0x10x0x10", 1, "size") &&
                  refuses("size = 32x0x10", 1, "size") &&
                  refuses("eye = 1-2-3", 1, "three numbers") &&
                  refuses("sun = 1.2.3", 1, "two numbers") &&
                  refuses("background = 0x1", 1, "one number"),
              "the same within vectors");
    tap_check(refuses("frame = 1.5", 1, "a whole number") &&
                  refuses("light_samples = 2.5", 1, "a whole number") &&
                  takes("frame = 1e3", SCENE_FRAME, 1000, 0, 0),
              "frame and light_samples are whole");
}

/// Lines ///

static void test_lines(void)
{
    tap_check(read_text("") == 0 && read_text("\n\n# nothing\n  \t\n") == 0,
              "an empty file, blank lines and comments are fine");
    tap_check(takes("  fov\t=  20   # narrow = 1\n", SCENE_FOV, 20, 0, 0) &&
                  takes("fov=20#x", SCENE_FOV, 20, 0, 0),
              "spaces around all, and a comment behind");
    tap_check(takes("# CR LF\r\nfov = 20 \r\n\r\n", SCENE_FOV, 20, 0, 0) &&
                  takes("skip = on\r\n", SCENE_SKIP, 1, 0, 0),
              "lines that end as on DOS");
    tap_check(takes("fov = 30\nfov = 20\n", SCENE_FOV, 20, 0, 0),
              "the later line wins");
    tap_check(refuses("fov = 20\n\n# more\r\nfoo = 1\nfov = x\n", 4,
                      "unknown key 'foo'"),
              "the number of the first bad line, all lines counted");
    tap_check(refuses("Fov = 1", 1, "unknown key 'Fov'") &&
                  refuses("= 1", 1, "unknown key ''") &&
                  refuses("fo v = 1", 1, "unknown key") &&
                  refuses("fov2 = 1", 1, "unknown key") &&
                  refuses("fo = 1", 1, "unknown key"),
              "keys are whole and in lower case");
    tap_check(refuses("fov 20", 1, "no '='") && refuses("\nfov", 2, "no '='") &&
                  refuses("fov # = 20", 1, "no '='"),
              "a line without '='");
}

static void test_long_lines(void)
{
    enum { ROOM = 100000 };
    char *text = malloc(ROOM);
    if (text == NULL)
        exit(1);
    memset(text, ' ', ROOM);
    memcpy(text, "fov = 20", 8);
    text[511] = '\0';
    tap_check(takes(text, SCENE_FOV, 20, 0, 0), "a line of 511 bytes");
    text[511] = ' ';
    text[512] = '\0';
    tap_check(refuses(text, 1, "more than 511 bytes"), "not one of 512");
    memset(text, ' ', ROOM);
    memcpy(text + 2000, "fov = 20", 9);
    tap_check(refuses(text, 1, "more than 511 bytes"),
              "nor one that begins with 2000 spaces");
    memset(text, 'x', ROOM - 1);
    text[ROOM - 1] = '\0';
    bool name = refuses(text, 1, "more than 511 bytes");
    memcpy(text, "fov = ", 6);
    tap_check(name && refuses(text, 1, "more than 511 bytes"),
              "nor one of 100000");
    /* A comment of any length must not spill into a line of its own. */
    memset(text, '#', ROOM);
    for (int i = 200; i < ROOM - 200; i += 8)
        memcpy(text + i, " step=2 ", 8);
    memcpy(text, "fov = 20", 8);
    memcpy(text + ROOM - 100, "\nfoo = 1", 9);
    tap_check(refuses(text, 2, "unknown key 'foo'") &&
                  settings.set[SCENE_FOV] && !settings.set[SCENE_STEP],
              "but a comment may have 100000");
    free(text);
}

static void test_strange_bytes(void)
{
    static const char k_hidden[] = "fov = 2\0000\n";
    static const char k_first[] = "fov = 20\n\0step = -1\n";
    tap_check(is_refusal(read_bytes(k_hidden, sizeof k_hidden - 1), 1,
                         "control character") &&
                  is_refusal(read_bytes(k_first, sizeof k_first - 1), 2,
                             "control character"),
              "a zero byte neither hides a line nor ends it");
    tap_check(refuses("fov = 2\0330", 1, "control character") &&
                  refuses("f\010ov = 20", 1, "control character") &&
                  refuses("fov = 2\r0", 1, "control character"),
              "control characters are refused, and not repeated");
    tap_check(refuses("\303\251 = 1", 1, "unknown key '\303\251'") &&
                  refuses("fov = \377", 1, "fov is a number"),
              "other bytes are only unknown");
    tap_check(takes("# caf\303\251 \001\nfov = 20", SCENE_FOV, 20, 0, 0),
              "in comments anything goes");
}

static void test_files(void)
{
    char missing[160];
    snprintf(missing, sizeof missing, "%s/missing.scene", dir);
    tap_check(scene_read(&settings, missing, err, sizeof err) != 0 &&
                  strncmp(err, missing, strlen(missing)) == 0 &&
                  strstr(err, "No such file"),
              "a missing file, by name");
    tap_check(scene_read(&settings, dir, err, sizeof err) != 0 &&
                  strncmp(err, dir, strlen(dir)) == 0 &&
                  strstr(err, "directory"),
              "a directory, by name");
}

static void test_set(void)
{
    memset(&settings, 0, sizeof settings);
    bool good =
        scene_set(&settings, "fov=30", "--set", err, sizeof err) == 0 &&
        scene_set(&settings, " fov = 25 ", "--set", err, sizeof err) == 0;
    tap_check(good && settings.value[SCENE_FOV][0] == 25, "--set, twice");
    tap_check(scene_set(&settings, "fov=999", "--set", err, sizeof err) != 0 &&
                  strcmp(err, "--set: fov is 999, outside 1 to 160") == 0,
              "%s", err);
    tap_check(scene_set(&settings, "fov", "--set", err, sizeof err) != 0 &&
                  strcmp(err, "--set: no '=' in 'fov'") == 0,
              "%s", err);
    tap_check(scene_set(&settings, "", "--set", err, sizeof err) != 0 &&
                  scene_set(&settings, "fov=1\nskip=on", "--set", err,
                            sizeof err) != 0 &&
                  strchr(err, '\n') == NULL,
              "--set takes one line, and not none");
    char small[8] = "#######";
    tap_check(scene_set(&settings, "foo=1", "--set", small, 4) != 0 &&
                  strcmp(small, "--s") == 0 && small[4] == '#',
              "a message is cut to the room there is");
}

/// Spaces ///

static void test_points(const struct world *w, const char *name)
{
    static const double k_eye[3] = {3.5, -2.25, 100}, k_target[3] = {0, 0, 0};
    struct volume_file file = make_block(w);
    struct brume_scene scene;
    double eye[3], target[3], got[2][3];
    char text[300];
    world_of(w, k_eye, eye);
    world_of(w, k_target, target);
    snprintf(text, sizeof text,
             "eye = %.17g,%.17g,%.17g\ntarget = %.17g,%.17g,%.17g", eye[0],
             eye[1], eye[2], target[0], target[1], target[2]);
    bool good = apply_text(text, &file, &scene) == 0;
    for (int i = 0; i < 3; i++) {
        got[0][i] = scene.eye[i] / 65536.0;
        got[1][i] = scene.target[i] / 65536.0;
    }
    tap_check(good && is_near(got[0], k_eye, 1e-9) &&
                  is_near(got[1], k_target, 1e-9),
              "%s: eye and target go to pool space", name);
    free(file.data);
}

static void test_directions(const struct world *w, const char *name)
{
    const double degree = 3.14159265358979323846 / 180;
    const double a = 100 * degree, e = -35 * degree;
    const double sun[3] = {cos(e) * sin(a), sin(e), cos(e) * cos(a)};
    const double up[3] = {2 / 3.0, -1 / 3.0, 2 / 3.0}, y[3] = {0, 1, 0};
    struct volume_file file = make_block(w);
    struct brume_scene scene;
    double got[3];
    bool good = apply_text("sun = 100 -35\nup = 20 -10 20", &file, &scene) == 0;
    world_way(w, scene.sun, got);
    tap_check(good && is_near(got, sun, 1e-7), "%s: the sun in world axes",
              name);
    world_way(w, scene.up, got);
    tap_check(is_near(got, up, 1e-8), "%s: up in world axes, of any length",
              name);
    good = apply_text("", &file, &scene) == 0;
    world_way(w, scene.up, got);
    tap_check(good && is_near(got, y, 1e-8), "%s: up is the world's +Y", name);
    free(file.data);
}

static void test_default_view(const struct world *w, const char *name)
{
    const double degree = 3.14159265358979323846 / 180;
    const double a = 30 * degree, e = 10 * degree;
    const double away[3] = {cos(e) * sin(a), sin(e), cos(e) * cos(a)};
    const double s = -60 * degree, t = 30 * degree;
    const double sun[3] = {cos(t) * sin(s), sin(t), cos(t) * cos(s)};
    struct volume_file file = make_block(w);
    struct brume_scene scene;
    int32_t way[3];
    double got[3];
    bool good = apply_text("", &file, &scene) == 0;
    for (int i = 0; i < 3; i++)
        way[i] = scene.eye[i] - scene.target[i];
    world_way(w, way, got);
    tap_check(good && is_near(got, away, 1e-5),
              "%s: seen from azimuth 30, elevation 10 of the world", name);
    world_way(w, scene.sun, got);
    tap_check(is_near(got, sun, 1e-7), "%s: lit from -60 30 of the world",
              name);
    free(file.data);
}

static void test_reach(void)
{
    struct volume_file file = make_block(&k_plain);
    struct brume_scene scene;
    tap_check(apply_text("eye = 32766 -32766 0", &file, &scene) == 0 &&
                  scene.eye[0] == BRUME_MAX_COORDINATE &&
                  scene.eye[1] == -BRUME_MAX_COORDINATE,
              "an eye 32766 voxels off");
    tap_check(is_refusal(apply_text("\neye = 0 0 32766.1", &file, &scene), 2,
                         "eye is 32766 voxels") &&
                  is_refusal(apply_text("target = -40000 0 0", &file, &scene),
                             1, "target is 40000 voxels") &&
                  is_refusal(apply_text("eye = 1e9 0 0", &file, &scene), 1,
                             "at most 32766"),
              "farther ones are refused with file and line");
    tap_check(is_refusal(apply_text("target=5 6 7\neye=5 6 7", &file, &scene),
                         2, "eye and target are the same"),
              "eye == target is refused");
    apply_text("", &file, &scene);
    char text[200];
    snprintf(text, sizeof text, "\n\ntarget = %.9g %.9g %.9g",
             scene.eye[0] / 65536.0, scene.eye[1] / 65536.0,
             scene.eye[2] / 65536.0);
    tap_check(is_refusal(apply_text(text, &file, &scene), 3,
                         "eye and target are the same"),
              "also when one of them is the default");
    tap_check(is_refusal(apply_text("up = 0 0 0", &file, &scene), 1,
                         "up has no direction"),
              "an up of length 0 is refused");
    free(file.data);
}

/* Errors of applying come long after the file is closed. */
static void test_where_is_kept(void)
{
    struct volume_file file = make_block(&k_plain);
    struct brume_scene scene;
    snprintf(path, sizeof path, "%s/%0120d", dir, 0);
    tap_check(
        is_refusal(apply_text("\neye = 1e9 0 0\n", &file, &scene), 2, "eye is"),
        "a path of 150 bytes keeps its line number");
    remove(path);
    snprintf(path, sizeof path, "%s/test.scene", dir);
    free(file.data);
}

/// Light ///

static void test_light(void)
{
    struct volume_file file = make_block(&k_plain);
    struct brume_scene scene;
    tap_check(
        is_refusal(apply_text("light = log\nlight_samples = 17", &file, &scene),
                   2, "light_samples is 17, log takes up to 16") &&
            is_refusal(
                apply_text("light_samples = 17\nlight = log", &file, &scene), 1,
                "log takes up to 16"),
        "log takes no 17 samples, in either order");
    tap_check(
        apply_text("light = log\nlight_samples = 16", &file, &scene) == 0 &&
            scene.light_samples == 16 &&
            apply_text("light = uniform\nlight_samples = 17", &file, &scene) ==
                0 &&
            scene.light_samples == 17,
        "log takes 16, uniform 17");
    /* 38 x 26 x 14 voxels: a diagonal of 48.1. */
    bool good = apply_text("light = log", &file, &scene) == 0;
    tap_check(good && scene.light == BRUME_LOG && scene.light_step == 65536 &&
                  scene.light_samples == 6,
              "log by default: 2^6 steps of a voxel cross a box of 48");
    good = apply_text("light = log\nlight_step = 4", &file, &scene) == 0;
    tap_check(good && scene.light_step == 4 * 65536 && scene.light_samples == 4,
              "and 2^4 of four voxels");
    good = apply_text("light = log\nlight_step = 256", &file, &scene) == 0;
    tap_check(good && scene.light_samples == 1, "and one of 256");
    good = apply_text("light = none", &file, &scene) == 0;
    tap_check(good && scene.light == BRUME_NO_LIGHT, "light = none");
    free(file.data);
}

static void test_numbers(void)
{
    struct volume_file file = make_block(&k_plain);
    struct brume_scene s;
    bool good =
        apply_text("size = 320x200\nfov = 12.5\ndensity_scale = 0.75\n"
                   "light_density_scale = 4294967295\nalbedo = 0.5\n"
                   "step = 0.0625\nmin_density = 1e9\nmax_density = 0.25\n"
                   "min_transmittance = 1\nfilter = nearest\nlight = log\n"
                   "light_samples = 3\nlight_step = 256\njitter = both\n"
                   "noise = bayer8\nframe = 4294967295\noutput = linear\n"
                   "background = 0 0.5 1\nskip = off\n",
                   &file, &s) == 0;
    tap_check(good && s.width == 320 && s.height == 200 && s.fov == 0xc8000 &&
                  s.density_scale == 0xc0000000u &&
                  s.light_density_scale == (uint64_t)0xffffffffu << 32 &&
                  s.albedo == 0x8000 && s.step == BRUME_MIN_STEP &&
                  s.min_density == (uint64_t)1000000000 << 32 &&
                  s.max_density == 0x40000000u &&
                  s.min_transmittance == 0x10000 &&
                  s.light_step == BRUME_MAX_STEP && s.light_samples == 3 &&
                  s.frame == UINT32_MAX && s.background[0] == 0 &&
                  s.background[1] == 0x8000 && s.background[2] == 0x10000,
              "numbers reach the core in its own units");
    tap_check(s.filter == BRUME_NEAREST && s.light == BRUME_LOG &&
                  s.jitter == BRUME_JITTER_BOTH &&
                  s.noise == BRUME_NOISE_BAYER8 && s.output == BRUME_LINEAR &&
                  !s.skip,
              "words reach the core as its enums");
    struct brume_frame frame;
    tap_check(brume_begin_frame(&frame, &file.volume, &s) == BRUME_OK,
              "and the core takes the ends of every range");
    free(file.data);
}

/// Over time and over the image ///

static void test_passes(void)
{
    struct volume_file file = make_block(&k_plain);
    struct brume_scene s;
    bool good = apply_text("temporal = taa\nhistory_bits = 8\nwindow = 16\n"
                           "alpha = 0.25\nfetch = catmull-rom\nclamp = minmax\n"
                           "gamma = 2.5\nspatial = box5\nedge_falloff = 3\n"
                           "resolution = quarter\nupdate = bayer4\n"
                           "upsample = aware\nsubpixel = off\ncut = on\n",
                           &file, &s) == 0;
    tap_check(good && s.temporal == BRUME_TAA && s.history_bits == 8 &&
                  s.window == 16 && s.alpha == 0x4000 &&
                  s.fetch == BRUME_FETCH_CATMULL_ROM &&
                  s.clamp == BRUME_CLAMP_MINMAX && s.gamma == 0x28000 &&
                  s.spatial == BRUME_BOX5 && s.edge_falloff == 0x30000 &&
                  s.resolution == BRUME_QUARTER && s.update == BRUME_BAYER4 &&
                  s.upsample == BRUME_UPSAMPLE_AWARE && !s.subpixel && s.cut,
              "the keys of time and image reach the core");
    struct brume_frame frame;
    tap_check(brume_begin_frame(&frame, &file.volume, &s) == BRUME_OK,
              "and it takes them");
    free(file.data);
}

static void test_pass_defaults(void)
{
    struct volume_file file = make_block(&k_plain);
    struct brume_scene s;
    bool good = apply_text("", &file, &s) == 0;
    tap_check(good && s.temporal == BRUME_TEMPORAL_NONE &&
                  s.spatial == BRUME_SPATIAL_NONE &&
                  s.resolution == BRUME_FULL && s.update == BRUME_UPDATE_ALL &&
                  !s.subpixel && !s.cut && s.edge_falloff == 0,
              "nothing over time or image by default");
    tap_check(s.history_bits == 16 && s.window == 8 && s.alpha == 6554 &&
                  s.gamma == 0x8000 && s.clamp == BRUME_CLAMP_VARIANCE &&
                  s.fetch == BRUME_FETCH_CATMULL_ROM,
              "16 bits, 8 frames, alpha 0.1, half a deviation, Catmull-Rom");
    good = apply_text("temporal = window", &file, &s) == 0 && s.subpixel;
    good = good && apply_text("temporal = taa", &file, &s) == 0 && s.subpixel;
    good = good && apply_text("temporal = ema", &file, &s) == 0 && !s.subpixel;
    tap_check(good, "window and taa move rays within pixels, ema does not");
    good =
        apply_text("spatial = bilateral15", &file, &s) == 0 &&
        s.edge_falloff == 16 << 16 &&
        apply_text("spatial = bilateral15\nedge_falloff = 0", &file, &s) == 0 &&
        s.edge_falloff == 0 && apply_text("spatial = box3", &file, &s) == 0;
    tap_check(good && s.edge_falloff == 0,
              "bilateral15 minds edges unless told not to, box3 does not");
    free(file.data);
}

/// Framing ///

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] =
            a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* A pinhole in double: where a point of the pool falls, with the frame from
 * -1 to 1. False behind the eye. */
static bool project(const struct brume_scene *s, const double p[3],
                    double out[2])
{
    double ahead[3], up[3], right[3], top[3], to[3];
    for (int i = 0; i < 3; i++) {
        ahead[i] = (s->target[i] - (double)s->eye[i]) / 65536;
        up[i] = s->up[i];
        to[i] = p[i] - s->eye[i] / 65536.0;
    }
    cross(ahead, up, right);
    cross(right, ahead, top);
    double depth = dot(to, ahead) / sqrt(dot(ahead, ahead));
    double half = depth * tan(s->fov / 65536.0 * 3.14159265358979323846 / 360);
    out[0] =
        dot(to, right) / sqrt(dot(right, right)) / half * s->height / s->width;
    out[1] = dot(to, top) / sqrt(dot(top, top)) / half;
    return depth > 0;
}

/* Largest coordinate of the box's corners (of its voxels, not their centres)
 * on the screen, 1 being the frame's edge; huge behind the eye. */
static double reach_of(const struct brume_scene *s,
                       const struct brume_volume *v)
{
    double reach = 0;
    for (int k = 0; k < 8; k++) {
        double p[3], at[2];
        for (int i = 0; i < 3; i++)
            p[i] = k >> i & 1 ? v->box_max[i] + 0.5 : v->box_min[i] - 0.5;
        if (!project(s, p, at))
            return 1e9;
        reach = fmax(reach, fmax(fabs(at[0]), fabs(at[1])));
    }
    return reach;
}

static void test_framing(const struct world *w, const char *name)
{
    static const int k_sides[][3] = {
        {1, 1, 1},    {2, 1, 3},    {40, 40, 40}, {200, 8, 8}, {8, 200, 8},
        {8, 8, 200},  {90, 90, 2},  {2, 90, 90},  {90, 2, 90}, {30, 60, 90},
        {60, 90, 30}, {1, 3000, 1}, {3000, 1, 1}, {1, 1, 3000}};
    for (size_t i = 0; i < COUNT(k_sides); i++) {
        const int *n = k_sides[i], low[3] = {1, 1, 1};
        const int high[3] = {1 + n[0], 1 + n[1], 1 + n[2]};
        struct volume_file file = make_volume(w, low, high, 20000);
        struct brume_scene scene;
        struct brume_frame frame;
        int error = -100;
        double reach = 1e9;
        if (apply_text("", &file, &scene) == 0) {
            error = brume_begin_frame(&frame, &file.volume, &scene);
            reach = reach_of(&scene, &file.volume);
        }
        tap_check(error == BRUME_OK && reach <= 1 && reach > 0.15,
                  "%s: a box of %dx%dx%d fills %.0f %% of the frame, %s", name,
                  n[0], n[1], n[2], 100 * reach, brume_error_text(error));
        free(file.data);
    }
}

/* The longest volumes are longer than the eye can be away: it may be nearer
 * than it should, but on the right side. */
static void test_longest(void)
{
    static const double k_away[3] = {0.49240388, 0.17364818, 0.85286853};
    for (int axis = 0; axis < 3; axis++) {
        int low[3] = {1, 1, 1}, high[3] = {7, 7, 7};
        high[axis] = 8 * BRUME_MAX_CELLS - 1;
        struct volume_file file = make_volume(&k_plain, low, high, 20000);
        struct brume_scene scene;
        struct brume_frame frame;
        double way[3], length;
        bool good = apply_text("", &file, &scene) == 0 &&
                    brume_begin_frame(&frame, &file.volume, &scene) == BRUME_OK;
        for (int i = 0; i < 3; i++)
            way[i] = (scene.eye[i] - (double)scene.target[i]) / 65536;
        length = sqrt(dot(way, way));
        for (int i = 0; i < 3; i++)
            way[i] /= length;
        tap_check(good && is_near(way, k_away, 1e-3),
                  "32758 voxels along %c are seen from the right side",
                  'x' + axis);
        free(file.data);
    }
}

/// Printing ///

/* The name of the first field that differs, NULL when none does. */
static const char *difference(const struct brume_scene *a,
                              const struct brume_scene *b)
{
#define SAME(field) \
    if (memcmp(&a->field, &b->field, sizeof a->field) != 0) \
    return #field
    SAME(width);
    SAME(height);
    SAME(frame);
    SAME(eye);
    SAME(target);
    SAME(up);
    SAME(fov);
    SAME(sun);
    SAME(density_scale);
    SAME(light_density_scale);
    SAME(min_density);
    SAME(max_density);
    SAME(albedo);
    SAME(step);
    SAME(light_step);
    SAME(min_transmittance);
    SAME(background);
    SAME(light_samples);
    SAME(filter);
    SAME(light);
    SAME(jitter);
    SAME(noise);
    SAME(output);
    SAME(skip);
    SAME(temporal);
    SAME(history_bits);
    SAME(window);
    SAME(fetch);
    SAME(clamp);
    SAME(spatial);
    SAME(resolution);
    SAME(update);
    SAME(upsample);
    SAME(subpixel);
    SAME(cut);
    SAME(alpha);
    SAME(gamma);
    SAME(edge_falloff);
#undef SAME
    return NULL;
}

/* The same of what lies behind them. */
/* What lies behind the lighting of two scenes. */
static bool same_light(const struct brume_scene *a, const struct brume_scene *b)
{
    const struct brume_lighting *l = a->lighting, *m = b->lighting;
    struct brume_lighting copy;
    if (l == NULL || m == NULL)
        return l == m;
    if ((l->phase == NULL) != (m->phase == NULL) ||
        (l->phase != NULL &&
         memcmp(l->phase, m->phase, l->octaves * sizeof *l->phase) != 0))
        return false;
    copy = *m;
    copy.phase = l->phase;
    return memcmp(l, &copy, sizeof copy) == 0;
}

static void print_and_read(const struct volume_file *file, const char *text,
                           const char *name)
{
    static struct scene_light other;
    struct brume_scene first, second;
    bool good = apply_text(text, file, &first) == 0;
    FILE *f = fopen(path, "w");
    if (f == NULL)
        exit(1);
    scene_print(f, &first, &light, file);
    fclose(f);
    memset(&settings, 0, sizeof settings);
    memset(err, 0, sizeof err);
    good = good && scene_read(&settings, path, err, sizeof err) == 0 &&
           scene_apply(&settings, file, &second, &other, err, sizeof err) == 0;
    const char *field = good ? difference(&first, &second) : err;
    if (good && field == NULL && !same_light(&first, &second))
        field = "lighting";
    for (int i = 0; i < SCENE_KEYS; i++)
        good = good && settings.set[i];
    tap_check(good && field == NULL, "%s: printed and read back, the same%s%s",
              name, field ? " but for " : "", field ? field : "");
}

static void test_printing(const struct world *w, const char *name)
{
    static const char k_all[] =
        "size = 1001x7\neye = 12.3456789 -7.654321 99.87654321\n"
        "target = 1e-3 0.3333333333 7\nup = 0.1 -1 0.3\nfov = 33.333333\n"
        "sun = 123.456789 -12.3456789\ndensity_scale = 1234.56789012345\n"
        "light_density_scale = 3.00000000023\nalbedo = 0.123456789\n"
        "step = 3.14159265\nmin_density = 1e-9\nmax_density = 0.7777777777\n"
        "min_transmittance = 0.0123456\nfilter = nearest\nlight = log\n"
        "light_samples = 11\nlight_step = 0.3333333\njitter = light\n"
        "noise = white\nframe = 4000000001\nbackground = 0.1 0.2 0.3\n"
        "output = linear\nskip = off\ntemporal = taa\nhistory_bits = 8\n"
        "window = 3\nalpha = 0.123456789\nfetch = catmull-rom\n"
        "clamp = minmax\ngamma = 1.23456789\nspatial = bilateral15\n"
        "edge_falloff = 3.3333333\nresolution = half\nupdate = checker\n"
        "upsample = aware\nsubpixel = off\ncut = on\n"
        "phase = mix:0.123456789,12.3456789,-0.3333333333,0.987654321\n"
        "octaves = 5\noctave_a = 0.41\noctave_b = 0.77777777\n"
        "octave_c = 0.3333333333\nsun_colour = 1.1 1.0 0.9\n"
        "exposure = 1.23456789\nambient = cube\nambient_colour = 0.11\n"
        "ambient_top = 0.3 0.4 0.5\nambient_bottom = 0.2 0.1 0.3\n"
        "ambient_px = 0.1 0.2 0.3\nambient_nx = 0.4 0.5 0.6\n"
        "ambient_py = 0.7 0.8 0.9\nambient_ny = 1.1 1.2 1.3\n"
        "ambient_pz = 1.4 1.5 1.6\nambient_nz = 1.7 1.8 1.9\n"
        "visibility = sampled\nvisibility_samples = 3\n"
        "visibility_step = 3.3333333\ncache_spacing = 8\nsky = on\n"
        "sky_zenith = 0.1 0.2 0.4\nsky_horizon = 0.6 0.7 0.8\n"
        "sky_ground = 0.3 0.2 0.1\nsun_disc = 15 14 13\n"
        "sun_size = 0.7654321\nhaze = 1234.56789\ndither = on\n";
    char text[100];
    struct volume_file file = make_block(w);
    snprintf(text, sizeof text, "%s, defaults", name);
    print_and_read(&file, "", text);
    snprintf(text, sizeof text, "%s, every key set", name);
    print_and_read(&file, k_all, text);
    snprintf(text, sizeof text, "%s, noon", name);
    print_and_read(&file, "sun = 0 90", text);
    free(file.data);
}

/* A veil so thin that its scale has all of the 64 bits of Q32.32. */
static void test_thin_volume(void)
{
    struct volume_file file = make_block(&k_plain);
    struct brume_scene scene;
    file.volume.density_mean.e = -90;
    bool good = apply_text("", &file, &scene) == 0;
    FILE *f = fopen(path, "w");
    if (f == NULL)
        exit(1);
    scene_print(f, &scene, &light, &file);
    fclose(f);
    good = good && scene_read(&settings, path, err, sizeof err) == 0;
    tap_check(good, "the largest density_scale is read back too%s%s",
              good ? "" : ": ", good ? "" : err);
    free(file.data);
}

static void test_key_list(void)
{
    char text[16384];
    FILE *f = fopen(path, "w+");
    if (f == NULL)
        exit(1);
    scene_print_keys(f);
    rewind(f);
    text[fread(text, 1, sizeof text - 1, f)] = '\0';
    fclose(f);
    bool all = strstr(text, "\n  size ") || strncmp(text, "  size ", 7) == 0;
    for (size_t i = 0; i < COUNT(k_ranges); i++)
        all = all && strstr(text, k_ranges[i].key);
    for (size_t i = 0; i < COUNT(k_words); i++)
        for (int k = 0; k_words[i].words[k]; k++)
            all = all && strstr(text, k_words[i].words[k]);
    tap_check(all, "--help's list has every key and word");
}

int main(void)
{
    texts_begin();
    test_ranges();
    test_size();
    test_vectors();
    test_sun_and_background();
    test_made_noises();
    test_words();
    test_bad_numbers();
    test_lines();
    test_long_lines();
    test_strange_bytes();
    test_files();
    test_set();
    test_points(&k_plain, "plain");
    test_points(&k_turned, "turned");
    test_directions(&k_plain, "plain");
    test_directions(&k_turned, "turned");
    test_default_view(&k_plain, "plain");
    test_default_view(&k_turned, "turned");
    test_reach();
    test_where_is_kept();
    test_light();
    test_numbers();
    test_passes();
    test_pass_defaults();
    test_framing(&k_plain, "plain");
    test_framing(&k_turned, "turned");
    test_longest();
    test_printing(&k_plain, "plain");
    test_printing(&k_turned, "turned");
    test_thin_volume();
    test_key_list();
    texts_end();
    return tap_done();
}
