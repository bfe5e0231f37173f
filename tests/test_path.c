/* SPDX-License-Identifier: MIT */
/*
 * Paths of keyframes and numbered names: values against those computed by
 * hand, and every refusal with its file and line.
 */
#include "tap.h"

#include "path_file.h"
#include "pattern.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))

static char file[64];
static char err[512];
static struct scene_settings settings; /* of the last path_at */

static struct path *read_text(const char *text)
{
    FILE *f = fopen(file, "w");
    if (f == NULL || fputs(text, f) == EOF || fclose(f) != 0) {
        perror(file);
        exit(1);
    }
    memset(err, 0, sizeof err);
    return path_read(file, err, sizeof err);
}

static const double *value_at(const struct path *path, int key, uint32_t frame)
{
    memset(&settings, 0, sizeof settings);
    if (path != NULL)
        path_apply(path, frame, &settings);
    return settings.value[key];
}

static bool is_value(const struct path *path, int key, uint32_t frame,
                     double want)
{
    double got = value_at(path, key, frame)[0];
    bool good = settings.set[key] && fabs(got - want) <= 1e-12 * fabs(want);
    if (!good)
        printf("# frame %lu: %.17g, not %.17g\n", (unsigned long)frame, got,
               want);
    return good;
}

struct wanted {
    uint32_t frame;
    double value;
};

static void check_values(const char *text, int key, const struct wanted *want,
                         size_t count, const char *name)
{
    struct path *path = read_text(text);
    bool good = path != NULL;
    for (size_t i = 0; good && i < count; i++)
        good = is_value(path, key, want[i].frame, want[i].value) && good;
    tap_check(good, "%s%s%s", name, *err ? ": " : "", err);
    path_free(path);
}

/// Values ///

static void test_linear(void)
{
    static const struct wanted k_want[] = {
        {0, 10},  {4, 10},  {6, 15},  {8, 20},         {9, 25},
        {10, 30}, {11, 40}, {12, 50}, {4000000000, 50}};
    check_values("[4]\nfov = 10\n[8]\nfov=20\n[10]\nfov = 30\n[12]\nfov = 50\n",
                 SCENE_FOV, k_want, COUNT(k_want),
                 "linear between keyframes, held outside");
}

/* u^2 (3 - 2u) at quarters: 5/32, 1/2, 27/32 */
static void test_smooth(void)
{
    static const struct wanted k_want[] = {
        {0, 10}, {1, 10 + 32 * 5 / 32.0}, {2, 26}, {3, 37}, {4, 42}, {6, 52}};
    check_values("[0]\nease = smooth\nfov = 10\n[4]\nfov = 42\nease = linear\n"
                 "[8]\nfov = 62\n",
                 SCENE_FOV, k_want, COUNT(k_want),
                 "smooth stops at its keyframes, until ease says otherwise");
}

/* Catmull and Rom: with distances 2, between b and c of a, b, c, d the middle
 * is (9 (b + c) - a - d) / 16. */
static void test_spline(void)
{
    static const struct wanted k_want[] = {
        {2, 20}, {3, (9 * (20 + 60) - 10 - 70) / 16.0}, {4, 60}};
    check_values("[0]\nease = spline\nfov = 10\n[2]\nfov = 20\n[4]\nfov = 60\n"
                 "[6]\nfov = 70\n",
                 SCENE_FOV, k_want, COUNT(k_want),
                 "spline is Catmull and Rom's at equal distances");
    /* Distances 1 and 3 of a straight line: it stays one, ends included. */
    static const struct wanted k_line[] = {{0, 10}, {1, 20}, {2, 30},
                                           {3, 40}, {4, 50}, {9, 100}};
    check_values("[0]\nease = spline\nfov = 10\n[1]\nfov = 20\n[4]\nfov = 50\n"
                 "[9]\nfov = 100\n",
                 SCENE_FOV, k_line, COUNT(k_line),
                 "a spline through a line is the line, at any distances");
    /* x^2 between its points 1, 3 and 6 (with slopes by parabolas, exact
     * inside): at 4 of 3..6 the slopes are 2 * 3 and, at the end, the chord's
     * 9: h00 9 + h10 3*6 + h01 36 + h11 3*9 at u = 1/3. */
    static const struct wanted k_square[] = {
        {4, 20.0 / 27 * 9 + 4.0 / 27 * 18 + 7.0 / 27 * 36 - 2.0 / 27 * 27}};
    check_values("[1]\nease = spline\nfov = 1\n[3]\nfov = 9\n[6]\nfov = 36\n",
                 SCENE_FOV, k_square, COUNT(k_square),
                 "slopes of a spline at uneven distances");
    /* The swing below 0 is cut off. */
    struct path *path = read_text("[0]\nease = spline\nalbedo = 1\n"
                                  "[2]\nalbedo = 0\n[4]\nalbedo = 0\n");
    tap_check(is_value(path, SCENE_ALBEDO, 3, 0),
              "a spline stays inside the key's range");
    path_free(path);
}

static void test_vectors(void)
{
    struct path *path = read_text("[0]\neye = 0,10,-4\nsun = 350 10\n"
                                  "background = 1\n"
                                  "[4]\neye = 4,20,4\nsun = 370 20\n"
                                  "background = 0,0.5,1\n");
    const double *eye = value_at(path, SCENE_EYE, 1);
    tap_check(eye[0] == 1 && eye[1] == 12.5 && eye[2] == -2,
              "each component of a vector moves");
    const double *sun = value_at(path, SCENE_SUN, 2);
    tap_check(sun[0] == 360 && sun[1] == 15, "the sun's angles are numbers");
    const double *b = value_at(path, SCENE_BACKGROUND, 3);
    tap_check(b[0] == 0.25 && b[1] == 0.625 && b[2] == 1,
              "and so are colours, a grey one among them");
    tap_check(path_sets(path, SCENE_EYE) && !path_sets(path, SCENE_FOV) &&
                  !settings.set[SCENE_FOV],
              "keys that no keyframe sets are left alone");
    path_free(path);
}

/* Colours go beyond 1, phase functions hold. */
static void test_light(void)
{
    struct path *path =
        read_text("[0]\nsun_colour = 16,2,0\nphase = hg:0.5\nhaze = 100\n"
                  "octaves = 1\nsky = off\n"
                  "[4]\nsun_colour = 0,4,8\nphase = mix:0.5,2,0.1,0.9\n"
                  "haze = 300\noctaves = 8\nsky = on\n");
    const double *c = value_at(path, SCENE_SUN_COLOUR, 1);
    tap_check(path != NULL && c[0] == 12 && c[1] == 2.5 && c[2] == 2,
              "the sun's colour moves in three numbers");
    tap_check(is_value(path, SCENE_HAZE, 1, 150) &&
                  is_value(path, SCENE_OCTAVES, 1, 3) &&
                  is_value(path, SCENE_SKY, 3, 0),
              "so do haze and octaves, and a sky comes at once");
    bool good = true;
    for (uint32_t frame = 0; frame < 6; frame++) {
        static const double k_hg[SCENE_VALUES] = {1, 0.5};
        static const double k_mix[SCENE_VALUES] = {5, 0.5, 2, 0.1, 0.9};
        good = memcmp(value_at(path, SCENE_PHASE, frame),
                      frame < 4 ? k_hg : k_mix, sizeof k_hg) == 0 &&
               good;
    }
    tap_check(good, "a phase function holds until the next");
    path_free(path);
}

static void test_whole_and_words(void)
{
    static const struct wanted k_whole[] = {{0, 4}, {1, 5}, {2, 5}, {3, 6}};
    check_values("[0]\nlight_samples = 4\n[3]\nlight_samples = 6\n",
                 SCENE_LIGHT_SAMPLES, k_whole, COUNT(k_whole),
                 "whole numbers are rounded to the nearest");
    static const struct wanted k_word[] = {{0, 1}, {4, 1}, {5, 2}, {9, 2}};
    check_values("[2]\nlight = uniform\n[5]\nlight = none\n", SCENE_LIGHT,
                 k_word, COUNT(k_word), "words hold until the next");
}

static void test_cut(void)
{
    static const char k_text[] = "[0]\nfov = 10\nalbedo = 0\n[4]\ncut = on\n"
                                 "fov = 50\n[8]\nfov = 90\nalbedo = 1\n";
    static const struct wanted k_fov[] = {{0, 10}, {3, 10}, {4, 50}, {6, 70}};
    check_values(k_text, SCENE_FOV, k_fov, COUNT(k_fov),
                 "a cut holds the value before it, and jumps");
    static const struct wanted k_albedo[] = {{4, 0.5}, {6, 0.75}};
    check_values(k_text, SCENE_ALBEDO, k_albedo, COUNT(k_albedo),
                 "keys that are not set at the cut move on through it");
    /* Neither side of a cut takes its slope from the other. */
    static const struct wanted k_spline[] = {{2, 20}, {6, 60}, {10, 80}};
    check_values("[0]\nease = spline\nfov = 10\n[4]\nfov = 30\n[5]\nfov = 50\n"
                 "cut = on\n[7]\nfov = 70\n[8]\ncut=on\nfov = 80\n",
                 SCENE_FOV, k_spline, COUNT(k_spline), "splines end at cuts");
    struct path *path = read_text(k_text);
    bool good = true;
    for (uint32_t frame = 0; frame < 10; frame++) {
        value_at(path, SCENE_CUT, frame);
        good = good && settings.set[SCENE_CUT] == (frame == 4);
    }
    tap_check(good, "history is dropped in the frame of the cut alone");
    path_free(path);
    path = read_text("[7]\ncut = on");
    value_at(path, SCENE_CUT, 7);
    tap_check(settings.set[SCENE_CUT] && settings.value[SCENE_CUT][0] == 1,
              "a cut may stand by itself");
    path_free(path);
}

static void test_where(void)
{
    char want[100];
    struct path *path = read_text("# a path\n\n[0]\nfov = 20\n[5]\nfov = 30\n");
    value_at(path, SCENE_FOV, 7);
    snprintf(want, sizeof want, "%s:6", file);
    tap_check(strcmp(settings.where[SCENE_FOV], want) == 0,
              "a value's line is that of its keyframe");
    path_free(path);
}

/// Refusals ///

static const struct {
    const char *text;
    int line; /* 0: none */
    const char *says;
} k_bad[] = {
    {"", 0, "no keyframe"},
    {"# nothing\n", 0, "no keyframe"},
    {"fov = 40\n", 1, "before the first [FRAME]"},
    {"\n[0\n", 2, "a keyframe is [FRAME]"},
    {"[]\n", 1, "a keyframe is [FRAME]"},
    {"[-1]\n", 1, "whole number"},
    {"[1.5]\n", 1, "whole number"},
    {"[x]\n", 1, "whole number"},
    {"[0x10]\n", 1, "whole number"},
    {"[4294967296]\n", 1, "whole number"},
    {"[99999999999999999999999]\n", 1, "whole number"},
    {"[3]\nfov = 1\n[3]\n", 3, "keyframes go upwards"},
    {"[3]\n[2]\n", 2, "keyframes go upwards"},
    {"[0]\nfoo = 1\n", 2, "unknown key 'foo'"},
    {"[0]\nfov\n", 2, "no '='"},
    {"[0]\n\nfov = 200\n", 3, "fov is 200, outside 1 to 160"},
    {"[0]\nlight = bright\n", 2, "light is one of"},
    {"[0]\nfov = 20\nfov = 30\n", 3, "set twice"},
    {"[0]\nsize = 3x3\n", 2, "size and frame cannot change"},
    {"[0]\nframe = 3\n", 2, "size and frame cannot change"},
    {"[0]\nease = fast\n", 2, "ease is one of linear smooth spline"},
    {"[0]\nease =\n", 2, "ease is one of"},
    {"[0]\ncut = yes\n", 2, "cut is one of off on"},
    {"[0]\ncut = on off\n", 2, "cut is one of off on"},
    {"[0]\nnoise = none.8x8x1.raw\n", 2, "none.8x8x1.raw"},
    {"[0]\nfov = 4\x07\n", 2, "control character"},
};

static void test_refusals(void)
{
    char start[100];
    for (size_t i = 0; i < COUNT(k_bad); i++) {
        struct path *path = read_text(k_bad[i].text);
        snprintf(start, sizeof start, k_bad[i].line ? "%s:%d: " : "%s: ", file,
                 k_bad[i].line);
        tap_check(path == NULL && strncmp(err, start, strlen(start)) == 0 &&
                      strstr(err, k_bad[i].says) && !strchr(err, '\n'),
                  "refused: %s", k_bad[i].says);
        if (path != NULL || strstr(err, k_bad[i].says) == NULL)
            printf("# '%s'\n", err);
        path_free(path);
    }
    struct path *path = path_read("/nowhere/at.all", err, sizeof err);
    tap_check(path == NULL && strstr(err, "/nowhere/at.all: No such file"),
              "refused: a file that is not there");
}

/// Names ///

static bool is_name(const char *pattern, uint32_t frame, const char *want)
{
    char name[PATTERN_SIZE];
    if (pattern_check(pattern, err, sizeof err) != 0)
        return false;
    pattern_name(pattern, frame, name);
    if (strcmp(name, want) != 0)
        printf("# '%s'\n", name);
    return strcmp(name, want) == 0;
}

static void test_names(void)
{
    static const char *const k_none[] = {"out.png",
                                         "%",
                                         "%%",
                                         "%d%d",
                                         "%4d",
                                         "%-4d.png",
                                         "%x.png",
                                         "%s",
                                         "a%%d",
                                         "%d%",
                                         "%0d",
                                         "%04x",
                                         "%021d",
                                         "%0-4d",
                                         "%d%04d",
                                         "%00000d%n",
                                         "%.3d",
                                         "%ld",
                                         "%0999999999999999999999d"};
    bool good = true;
    tap_check(is_name("out_%04d.png", 7, "out_0007.png") &&
                  is_name("%d", 4294967295u, "4294967295") &&
                  is_name("a/%02d/b", 123, "a/123/b") &&
                  is_name("%020d", 5, "00000000000000000005"),
              "%%d and %%0Nd, and at least N digits");
    for (size_t i = 0; i < COUNT(k_none); i++) {
        bool refused = pattern_check(k_none[i], err, sizeof err) != 0;
        if (!refused)
            printf("# taken: %s\n", k_none[i]);
        good = good && refused && strstr(err, "one %d or %04d");
    }
    tap_check(good, "no other conversion, not two, not none");
    static char name[PATTERN_SIZE + 10];
    memset(name, 'x', sizeof name - 1);
    memcpy(name, "%d", 2);
    tap_check(pattern_check(name, err, sizeof err) != 0 &&
                  strstr(err, "too long"),
              "nor a name without an end");
}

int main(void)
{
    const char *tmp = getenv("TMPDIR");
    snprintf(file, sizeof file, "%.40s/brumeXXXXXX", tmp ? tmp : "/tmp");
    int fd = mkstemp(file);
    if (fd < 0) {
        perror(file);
        return 1;
    }
    close(fd);
    test_linear();
    test_smooth();
    test_spline();
    test_vectors();
    test_light();
    test_whole_and_words();
    test_cut();
    test_where();
    test_refusals();
    test_names();
    remove(file);
    return tap_done();
}
