/* SPDX-License-Identifier: MIT */
/*
 * What is read for `brume surface`: OBJ files, grey pictures of 16 bits, sun
 * maps; good, bad, cut short, and bytes that nobody meant.
 */
#include "tap.h"

#include "mesh.h"
#include "sun_map_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char err[400];
static struct volume_file world; /* whose voxels are half a unit */

static void make_world(void)
{
    static const double k_matrix[12] = {0.5, 0,  0, 10, 0,   0.5,
                                        0,   20, 0, 0,  0.5, 30};
    memcpy(world.world_from_index, k_matrix, sizeof k_matrix);
    world.voxel_size = 0.5;
    world.origin[0] = 4;
}

/* In a block of its own, so that a sanitizer sees any overrun. */
static int parse(struct mesh *mesh, const char *text, size_t size)
{
    char *copy = malloc(size + 1);
    memset(mesh, 0, sizeof *mesh);
    memcpy(copy, text, size);
    copy[size] = '\0';
    err[0] = '\0';
    int status =
        mesh_parse_obj(mesh, "m.obj", copy, size, &world, 7, err, sizeof err);
    free(copy);
    return status;
}

/// OBJ ///

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static void test_good(void)
{
    static const struct {
        const char *text;
        unsigned triangles;
    } k_good[] = {
        {SQUARE "f 1 2 3\n", 1},
        {SQUARE "f 1 2 3 4\n", 2},
        {SQUARE "f 1/1 2/2 3/3\nf 1//9 2//9 3//9\nf 1/1/1 2/1/1 3/1/-1\n", 3},
        {SQUARE "f -4 -3 -2 -1\n", 2},
        {SQUARE "f 1 2 3", 1},
        {SQUARE "f 1 \\\n 2 \\\r\n 3\n", 1},
        {"# hello\r\n\r\n" SQUARE "\tf 1 2 3 # here\r\n", 1},
        {"mtllib x y\no a\ng b c\nusemtl d\ns off\nvt 0 0\nvn 0 0 1\n" SQUARE
         "l 1 2\nf 1 2 3\n",
         1},
        {"v 0 0 0 1\nv 1 0 0 .5 .5 .5\nv +1.5e0 1E-1 -.5\nf 1 2 3\n", 1},
        {SQUARE "f 1 1 2\nf 1 2 1\nf 1 2 3\n", 1}, /* two without area */
        {SQUARE "v 2 0 0\nf 1 2 5\nf 1 2 3\n", 1}, /* one on a line */
    };
    for (size_t i = 0; i < sizeof k_good / sizeof *k_good; i++) {
        struct mesh mesh;
        int status = parse(&mesh, k_good[i].text, strlen(k_good[i].text));
        tap_check(status == 0 && mesh.triangles == k_good[i].triangles,
                  "good file %zu: %u triangles, not %u %s", i, mesh.triangles,
                  k_good[i].triangles, err);
        mesh_free(&mesh);
    }
}

static void test_space(void)
{
    struct mesh mesh;
    const char *text = "v 10 20 30\nv 11 20 30\nv 10 21 30.5\nf 1 2 3\n";
    parse(&mesh, text, strlen(text));
    const double *v = mesh.vertex[2];
    tap_check(v[0] == -4 && v[1] == 2 && v[2] == 1 && mesh.thing[0] == 7,
              "vertices are in pool space: %g %g %g", v[0], v[1], v[2]);
    mesh_free(&mesh);
}

static void test_bad(void)
{
    static const struct {
        const char *text, *message;
    } k_bad[] = {
        {"", "m.obj: no faces with an area"},
        {SQUARE, "m.obj: no faces with an area"},
        {SQUARE "f 1 1 1\n", "m.obj: no faces with an area"},
        {SQUARE "f 1 2\n", "m.obj:5: a face takes three vertices or more"},
        {SQUARE "f\n", "m.obj:5: a face takes three vertices or more"},
        {SQUARE "f 1 2 5\n", "m.obj:5: face with a vertex that is not there"},
        {SQUARE "f 1 2 -5\n", "m.obj:5: face with a vertex that is not there"},
        {"f 1 2 3\n" SQUARE, "m.obj:1: face with a vertex that is not there"},
        {SQUARE "f 0 1 2\n", "m.obj:5: a face takes vertices like"},
        {SQUARE "f 1 2 99999999999999999999\n", "m.obj:5: a face takes"},
        {SQUARE "f 1 2 3.5\n", "m.obj:5: a face takes vertices like"},
        {SQUARE "f 1/ 2/ 3/\n", "m.obj:5: a face takes vertices like"},
        {SQUARE "f 1/1/1/1 2 3\n", "m.obj:5: a face takes vertices like"},
        {SQUARE "f 1//0 2 3\n", "m.obj:5: a face takes vertices like"},
        {SQUARE "f +1 2 3\n", "m.obj:5: a face takes vertices like"},
        {SQUARE "f a b c\n", "m.obj:5: a face takes vertices like"},
        {"v 0 0\n", "m.obj:1: a vertex takes three numbers"},
        {"v 1 2 3 4 5 6 7 8\n", "m.obj:1: a vertex takes three numbers"},
        {"v 1 2 3 4 5 6 7 8 9\n", "m.obj:1: a vertex takes three numbers"},
        {"v nan 0 0\n", "m.obj:1: not a finite number"},
        {"v 0 inf 0\n", "m.obj:1: not a finite number"},
        {"v 0 1e999 0\n", "m.obj:1: not a finite number"},
        {"v 0 0x10 0\n", "m.obj:1: not a finite number"},
        {"v 0 1,5 0\n", "m.obj:1: not a finite number"},
        {"v 0 1e 0\n", "m.obj:1: not a finite number"},
        {"v 0 0 1e12\n", "m.obj:1: vertex more than 10^9 voxels away"},
        {"\n\ncurv 0 1\n", "m.obj:3: a line of no known kind"},
        {"\x89PNG\r\n", "m.obj:1: a line of no known kind"},
        {"v 0 0 \\\n x\n", "m.obj:2: not a finite number"},
    };
    for (size_t i = 0; i < sizeof k_bad / sizeof *k_bad; i++) {
        struct mesh mesh;
        int status = parse(&mesh, k_bad[i].text, strlen(k_bad[i].text));
        tap_check(status == -1 && strncmp(err, k_bad[i].message,
                                          strlen(k_bad[i].message)) == 0,
                  "bad file %zu: %s", i, err);
        mesh_free(&mesh);
    }
    struct mesh mesh;
    tap_check(parse(&mesh, "v 0 0 0\0\nf", 11) == -1 &&
                  strcmp(err, "m.obj:1: a byte of value 0") == 0,
              "a byte of value 0: %s", err);
    mesh_free(&mesh);
}

/* Cut short anywhere, and with any one byte changed: an error, or a mesh whose
 * triangles have vertices that are there. */
static void test_mangled(void)
{
    static const char k_text[] =
        "# a\n" SQUARE "vn 0 0 1\nf 1//1 2//1 \\\n 3//-1 4\nf -1 -2/3 -3/1/1\n";
    const size_t size = sizeof k_text - 1;
    unsigned tried = 0, sound = 0;
    for (size_t at = 0; at < size; at++)
        for (int byte = -1; byte < 256; byte++, tried++) {
            char text[sizeof k_text];
            struct mesh mesh;
            memcpy(text, k_text, sizeof text);
            if (byte >= 0)
                text[at] = (char)byte;
            int status = parse(&mesh, text, byte < 0 ? at : size);
            bool good = (status == 0) == (err[0] == '\0');
            for (uint32_t i = 0; i < 3 * mesh.triangles; i++)
                good = good && mesh.triangle[i / 3][i % 3] < mesh.vertices;
            sound += good;
            mesh_free(&mesh);
        }
    tap_check(sound == tried, "%u of %u mangled files are sound", sound, tried);
}

/// Ground ///

static void test_ground(void)
{
    uint16_t values[6] = {0, 65535, 0, 0, 0, 32768};
    struct grey16 heights = {3, 2, values, ""};
    struct mesh_ground ground = {20, {10, 30, 13, 34}, 2, NULL};
    struct mesh mesh = {0};
    int status = mesh_add_ground(&mesh, &ground, &world, 0, err, sizeof err);
    tap_check(status == 0 && mesh.triangles == 2 && mesh.vertices == 4,
              "a level ground is two triangles");
    mesh_free(&mesh);
    ground.heights = &heights;
    status = mesh_add_ground(&mesh, &ground, &world, 0, err, sizeof err);
    /* columns at 0, 1/6, 1/2, 5/6, 1 of 3 units: 0.5 .. 2.5; rows 1 and 3 */
    const double *v = mesh.vertex[1 * 5 + 2], *last = mesh.vertex[19];
    tap_check(status == 0 && mesh.triangles == 24 && mesh.vertices == 20,
              "hills of 3 x 2 heights are %u triangles", mesh.triangles);
    tap_check(v[0] == 1.5 * 2 - 4 && v[1] == 2 * 2 && v[2] == 1 * 2,
              "a height is at the middle of its texel: %g %g %g", v[0], v[1],
              v[2]);
    tap_check(last[0] == 3 * 2 - 4 && last[2] == 4 * 2 &&
                  fabs(last[1] - 2 * 32768 / 65535.0 * 2) < 1e-12,
              "the outermost heights go on to the edges");
    mesh_free(&mesh);
    ground.area[2] = ground.area[0];
    tap_check(mesh_add_ground(&mesh, &ground, &world, 0, err, sizeof err) != 0,
              "ground of no width: %s", err);
    mesh_free(&mesh);
}

/// Grey pictures ///

static void test_grey(void)
{
    struct grey16 a, b;
    struct image_file file;
    grey16_new(&a, 37, 5, err, sizeof err);
    for (unsigned i = 0; i < 37 * 5; i++)
        a.values[i] = (uint16_t)(i * 9377u);
    strcpy(a.note, " one\n two\n");
    grey16_encode(IMAGE_PGM, &a, &file, err, sizeof err);
    int status = grey16_pgm_decode(file.data, file.size, &b, err, sizeof err);
    tap_check(status == 0 && strcmp(a.note, b.note) == 0 &&
                  memcmp(a.values, b.values, 37 * 5 * 2) == 0,
              "a PGM comes back with its note");
    grey16_free(&b);
    unsigned refused = 0;
    for (size_t cut = 0; cut < file.size; cut++) {
        uint8_t *copy = malloc(cut + 1);
        memcpy(copy, file.data, cut);
        refused += grey16_pgm_decode(copy, cut, &b, err, sizeof err) != 0 &&
                   b.values == NULL;
        free(copy);
    }
    tap_check(refused == file.size, "a PGM cut short is refused: %u of %zu",
              refused, file.size);
    free(file.data);
    grey16_encode(IMAGE_PNG, &a, &file, err, sizeof err);
    status = grey16_png_decode(file.data, file.size, &b, err, sizeof err);
    tap_check(status == 0 && memcmp(a.values, b.values, 37 * 5 * 2) == 0,
              "a PNG comes back");
    grey16_free(&b);
    struct image image;
    tap_check(image_png_decode(file.data, file.size, &image, err, sizeof err) !=
                  0,
              "a PNG of 16 bits is no struct image: %s", err);
    free(file.data);
    grey16_free(&a);
}

static void test_pgm_heads(void)
{
    static const struct {
        const char *text;
        int value; /* of the first sample, -1: refused */
    } k_heads[] = {
        {"P5 1 1 255 \x80", 32896},
        {"P5\n1 1\n65535\n\x12\x34", 0x1234},
        {"P5 1 1 1 \x01", 65535},
        {"P5 1 1 255 ", -1},
        {"P5 1 1 100 \x65", -1},
        {"P5 0 1 255 x", -1},
        {"P5 1 1 65536 xx", -1},
        {"P5 99999 99999 65535 xx", -1},
        {"P5 65535 65535 65535 xx", -1},
        {"P5 -1 1 255 x", -1},
        {"P6 1 1 255 xyz", -1},
        {"P5 1 1 255", -1},
        {"P5 1 1 2x5 x", -1},
    };
    for (size_t i = 0; i < sizeof k_heads / sizeof *k_heads; i++) {
        struct grey16 p;
        const char *text = k_heads[i].text;
        int status = grey16_pgm_decode((const uint8_t *)text, strlen(text), &p,
                                       err, sizeof err);
        int value = status == 0 ? p.values[0] : -1;
        tap_check(value == k_heads[i].value, "PGM head %zu: %d %s", i, value,
                  status == 0 ? "" : err);
        grey16_free(&p);
    }
}

/// Sun maps ///

static char dir[] = "/tmp/brume_mesh_XXXXXX"; /* of this run */
static char path[64];                         /* of a file in it */

/* Through a file, with one line of it changed. */
static int read_map(const char *line, struct sun_map_file *map)
{
    static const char *const k_lines[] = {"brume-sun-map 1", "origin 1 2 3",
                                          "across 0.1 0 0",  "down 0 0 4e2",
                                          "range 8",         "bias 0.25"};
    FILE *f = fopen(path, "wb");
    size_t word = strcspn(line, " ");
    fputs("P5\n", f);
    for (size_t i = 0; i < sizeof k_lines / sizeof *k_lines; i++)
        fprintf(f, "# %s\n",
                strncmp(line, k_lines[i], word) == 0 ? line : k_lines[i]);
    fputs("1 1\n65535\nab", f);
    fclose(f);
    int status = sun_map_file_read(path, map, err, sizeof err);
    remove(path);
    return status;
}

static void test_sun_map(void)
{
    static const char *const k_bad[] = {
        "brume-sun-map 2", "origin 1 2",     "origin 1 2 3 4", "origin 1 2 nan",
        "across 0 0 0",    "across 0 0 inf", "down 1 2",       "down 0 -0 0",
        "range 0",         "range -1",       "range",          "bias -1",
        "bias 1 2",        "bias x",         "bias 1e999"};
    struct sun_map_file map;
    struct brume_sun_map core;
    tap_check(read_map("bias 0.5", &map) == 0 && map.bias == 0.5 &&
                  map.down[2] == 400 && map.texels.values[0] == 0x6162,
              "a sun map is read: %s", err);
    int status = sun_map_file_apply(&map, &world, &core, err, sizeof err);
    tap_check(status == 0 && core.range == 16 << 16 && core.bias == 1 << 16 &&
                  core.down[2] == 800 << 16 && core.width == 1 &&
                  core.origin[0] == (-18 - 4) * 65536 &&
                  core.origin[1] == -36 * 65536,
              "and put into the pool");
    map.range = 1e6;
    tap_check(sun_map_file_apply(&map, &world, &core, err, sizeof err) != 0,
              "a range out of reach: %s", err);
    map.range = 8;
    map.origin[1] = 1e6;
    tap_check(sun_map_file_apply(&map, &world, &core, err, sizeof err) != 0,
              "a corner out of reach: %s", err);
    sun_map_file_free(&map);
    for (size_t i = 0; i < sizeof k_bad / sizeof *k_bad; i++)
        tap_check(read_map(k_bad[i], &map) != 0 && map.texels.values == NULL,
                  "`%s': %s", k_bad[i], strchr(err, ':'));
}

static void test_sun_map_round(void)
{
    struct sun_map_file a = {.range = 1 / 3.0, .bias = 1e-300}, b;
    struct image_file file;
    for (int i = 0; i < 3; i++) {
        a.origin[i] = -1e6 / (i + 3);
        a.across[i] = 0.1 * (i + 1);
        a.down[i] = 1 / 7.0;
    }
    grey16_new(&a.texels, 3, 2, err, sizeof err);
    a.texels.values[4] = 54321;
    FILE *f = fopen(path, "wb");
    sun_map_file_encode(&a, &file, err, sizeof err);
    fwrite(file.data, 1, file.size, f);
    fclose(f);
    int status = sun_map_file_read(path, &b, err, sizeof err);
    tap_check(status == 0 && memcmp(a.origin, b.origin, sizeof a.origin) == 0 &&
                  memcmp(a.across, b.across, sizeof a.across) == 0 &&
                  memcmp(a.down, b.down, sizeof a.down) == 0 &&
                  a.range == b.range && a.bias == b.bias &&
                  b.texels.values[4] == 54321,
              "a sun map comes back to the last bit");
    remove(path);
    free(file.data);
    sun_map_file_free(&a);
    sun_map_file_free(&b);
}

int main(void)
{
    if (mkdtemp(dir) == NULL) {
        perror("test_mesh");
        return 1;
    }
    snprintf(path, sizeof path, "%s/map.pgm", dir);
    make_world();
    test_good();
    test_space();
    test_bad();
    test_mangled();
    test_ground();
    test_grey();
    test_pgm_heads();
    test_sun_map();
    test_sun_map_round();
    rmdir(dir);
    return tap_done();
}
