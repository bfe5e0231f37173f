/* SPDX-License-Identifier: MIT */
/*
 * The keys of emission, from text to the core's struct brume_lighting: what is
 * taken, what is refused; and black bodies against Planck's law in double.
 */
#include "tap.h"

#include "scene_emission.h"
#include "support/asset_light.h"
#include "support/scene_text.h"

static char colours_path[300]; /* a file beside the scene's */

static struct volume_file make_glowing(void)
{
    struct volume_file file = make_block(&k_plain);
    file.data = asset_add_emission(file.data, &file.size, 0xc0000000u, -31);
    if (brume_volume_open(&file.volume, file.data, file.size, 0) != BRUME_OK)
        abort();
    return file;
}

/* A file of `lines` colours, the last of which may be another text. */
static void put_colours(int lines, const char *last)
{
    FILE *f = fopen(colours_path, "w");
    if (f == NULL)
        exit(1);
    fprintf(f, "# red green blue\n\n");
    for (int i = 0; i + 1 < lines; i++)
        fprintf(f, "%g, %g %g # %d\n", i / 100.0, i / 200.0, i / 16.0, i);
    fprintf(f, "%s\n", last);
    fclose(f);
}

/* Colours of a black body as the core gets them. */
static bool blackbody(const char *text, uint32_t out[256][3])
{
    char line[100];
    struct volume_file file = make_glowing();
    struct brume_scene s;
    snprintf(line, sizeof line, "emission = blackbody:%s", text);
    bool good = apply_text(line, &file, &s) == 0 && s.lighting != NULL &&
                s.lighting->emission_colour != NULL;
    if (good)
        memcpy(out, s.lighting->emission_colour, 256 * sizeof *out);
    free(file.data);
    return good;
}

/// Texts ///

static void test_texts(void)
{
    static const char *const k_bad[] = {"blackbody",
                                        "blackbody:",
                                        "blackbody:1000",
                                        "blackbody:1,2",
                                        "blackbody:499,900,1",
                                        "blackbody:900,12001,1",
                                        "blackbody:9,8,1",
                                        "blackbody:900,800,1",
                                        "blackbody:900,2000,17",
                                        "",
                                        "blackbody:9e2,2e3,-1"};
    char line[100];
    bool good = true;
    tap_check(
        takes("emission = none", SCENE_EMISSION, 0, 0, 0) &&
            takes("emission = blackbody:500, 12000,16", SCENE_EMISSION, 1, 500,
                  12000) &&
            settings.value[SCENE_EMISSION][3] == 16 &&
            takes("emission_scale = 0.25", SCENE_EMISSION_SCALE, .25, 0, 0),
        "none, a black body with its numbers, a scale");
    for (size_t i = 0; i < COUNT(k_bad); i++) {
        snprintf(line, sizeof line, "fov = 9\nemission = %s", k_bad[i]);
        good = refuses(line, 2, "emission") && good;
    }
    tap_check(good, "other words, counts and numbers are refused");
    tap_check(refuses("emission_scale = -1", 1, "emission_scale is -1"),
              "so is a negative scale");
}

static void test_files(void)
{
    char line[400];
    snprintf(line, sizeof line, "emission = %s", colours_path);
    struct volume_file file = make_glowing();
    struct brume_scene s;
    put_colours(256, "16 0 1e-5");
    bool good = apply_text(line, &file, &s) == 0 && s.lighting != NULL;
    const uint32_t(*c)[3] = good ? s.lighting->emission_colour : NULL;
    tap_check(good && c[100][0] == 65536 && c[100][1] == 32768 &&
                  c[100][2] == 409600 && c[255][0] == 16 * 65536 &&
                  c[255][2] == 1,
              "256 lines of a file are the colours");
    put_colours(255, "1 1 1");
    good = refuses(line, 1, "255 colours, not 256");
    put_colours(257, "1 1 1");
    good = refuses(line, 1, ":259: more than 256 colours") && good;
    put_colours(256, "1 1");
    good = refuses(line, 1, ":258: not three numbers from 0 to 16") && good;
    put_colours(256, "1 1 16.1");
    good = refuses(line, 1, ":258: not three numbers") && good;
    put_colours(256, "1 1 -1");
    good = refuses(line, 1, ":258: not three numbers") && good;
    put_colours(256, "1 1 inf");
    good = refuses(line, 1, ":258: not three numbers") && good;
    remove(colours_path);
    good = refuses(line, 1, "No such file") && good;
    tap_check(good, "other files are refused with file and line");
    free(file.data);
}

/// To the core ///

static void test_applied(void)
{
    struct volume_file file = make_glowing(), plain = make_block(&k_plain);
    struct brume_scene s;
    bool good =
        apply_text("emission = none\nemission_scale = 3", &file, &s) == 0 &&
        s.lighting == NULL;
    tap_check(good, "none is a scene without lighting");
    good = apply_text("emission = blackbody:900,2000,1\nemission_scale = 0.75",
                      &file, &s) == 0 &&
           s.lighting->emission_scale == 3ull << 30;
    tap_check(good, "the scale in Q32.32");
    /* value 1.5, box of 38 x 26 x 14: 16 / (1.5 / 4 * 48.1) */
    good = apply_text("emission = blackbody:900,2000,1", &file, &s) == 0 &&
           fabs((double)s.lighting->emission_scale / 4294967296.0 -
                16 / (0.375 * sqrt(38 * 38 + 26 * 26 + 14 * 14))) < 1e-9;
    tap_check(good, "by default a depth of 16 across the box at a quarter");
    tap_check(is_refusal(apply_text("fov = 9\nemission = blackbody:900,2000,1",
                                    &plain, &s),
                         2, "emission needs a volume that was baked with"),
              "a volume without a second grid is refused by its line");
    free(file.data);
    free(plain.data);
}

static void test_printed(void)
{
    static const char k_text[] = "emission = blackbody:777.125,1234.5,0.3\n"
                                 "emission_scale = 0.123456789012345";
    struct volume_file file = make_glowing();
    struct brume_scene s;
    uint32_t before[256][3];
    bool good = apply_text(k_text, &file, &s) == 0;
    memcpy(before, light.emission, sizeof before);
    uint64_t scale = s.lighting->emission_scale;
    FILE *f = fopen(path, "w");
    if (f == NULL)
        exit(1);
    scene_print(f, &s, &light, &file);
    fclose(f);
    memset(&settings, 0, sizeof settings);
    good = good && scene_read(&settings, path, err, sizeof err) == 0 &&
           scene_apply(&settings, &file, &s, &light, err, sizeof err) == 0;
    tap_check(good && memcmp(before, light.emission, sizeof before) == 0 &&
                  s.lighting->emission_scale == scale,
              "printed and read back, the same");
    free(file.data);
}

/// Black bodies ///

static double luminance(const uint32_t c[3])
{
    return (0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]) / 65536;
}

/* Planck's law in green light, where the eye sees most: of two temperatures,
 * and with eyes that are that simple, within a fifth. */
static void test_blackbody(void)
{
    uint32_t c[256][3];
    bool good = blackbody("1000,2000,2", c), rises = true, warm = true;
    tap_check(good && fabs(luminance(c[255]) - 2) < 1e-3,
              "the hottest has the luminance asked for: %.5f",
              luminance(c[255]));
    for (int i = 1; i < 256; i++) {
        /* the coolest are a few steps of 2^-16, each rounded */
        rises = rises && luminance(c[i]) >= luminance(c[i - 1]) - 2e-5 &&
                (i < 128 || luminance(c[i]) > luminance(c[i - 1]));
        warm = warm && c[i][0] >= c[i][1] && c[i][1] >= c[i][2] &&
               (i < 128 || c[i][0] > c[i][1]);
    }
    tap_check(rises && warm, "brighter with heat, and redder than blue");
    double ratio = luminance(c[255]) / luminance(c[102]); /* 1400 K */
    double wien = 14387.8 / 0.58 * (1 / 1400.0 - 1 / 2000.0);
    tap_check(fabs(log(ratio) / wien - 1) < 0.05,
              "2000 K to 1400 K: a factor of %.1f, by Wien's law %.1f", ratio,
              exp(wien));
    good = blackbody("6500,6500,1", c);
    tap_check(good && memcmp(c[0], c[255], sizeof c[0]) == 0 &&
                  fabs(c[0][0] / 65536.0 - 1) < 0.06 &&
                  fabs(c[0][1] / 65536.0 - 1) < 0.06 &&
                  fabs(c[0][2] / 65536.0 - 1) < 0.06,
              "6500 K is nearly white: %.3f %.3f %.3f", c[0][0] / 65536.0,
              c[0][1] / 65536.0, c[0][2] / 65536.0);
    good = blackbody("500,12000,16", c);
    tap_check(good && c[255][2] == 16 * 65536 && c[255][0] < c[255][2] &&
                  luminance(c[0]) == 0,
              "12000 K is blue, and ends at 16; 500 K is dark beside it");
    good = blackbody("500,500,1", c);
    tap_check(good && c[0][0] > 4 * 65536 && c[0][2] == 0,
              "500 K by itself is red");
    good = blackbody("900,2300,0", c);
    tap_check(good && luminance(c[255]) == 0, "brightness 0 is black");
}

int main(void)
{
    texts_begin();
    snprintf(colours_path, sizeof colours_path, "%s/colours.txt", dir);
    test_texts();
    test_files();
    test_applied();
    test_printed();
    test_blackbody();
    texts_end();
    return tap_done();
}
