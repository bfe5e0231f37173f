/* SPDX-License-Identifier: MIT */
/*
 * Looks into an asset for tests/test_bake.sh, by docs/SPEC.md alone: nothing
 * of core/ or convert/ is included.
 *
 *     section_dump section FILE ID      the bytes of a section, to stdout
 *     section_dump header FILE          name=value lines
 *     section_dump verify FILE [DUMP]   distances by brute force, empty outer
 *                                       layer, box; errors against a float
 *                                       dump are printed, as multiples of
 *                                       density_max
 *     section_dump json FILE            is it JSON?
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint8_t *blob;
static size_t blob_bytes;

static void die(const char *what)
{
    fprintf(stderr, "section_dump: %s\n", what);
    exit(1);
}

static uint8_t *load(const char *path, size_t *bytes)
{
    FILE *f = fopen(path, "rb");
    uint8_t *p;
    long n;

    if (!f || fseek(f, 0, SEEK_END) || (n = ftell(f)) < 0)
        die("cannot read the file");
    rewind(f);
    p = malloc((size_t)n + 1);
    if (!p || fread(p, 1, (size_t)n, f) != (size_t)n)
        die("cannot read the file");
    p[n] = 0;
    fclose(f);
    *bytes = (size_t)n;
    return p;
}

static uint32_t u16(size_t at)
{
    return blob[at] | (uint32_t)blob[at + 1] << 8;
}

static uint32_t u32(size_t at)
{
    return u16(at) | u16(at + 2) << 16;
}

static double number(size_t at)
{
    return ldexp(u32(at), (int32_t)u32(at + 4));
}

/* The offset of a section, 0 when there is none. */
static size_t find(const char *id, size_t *bytes)
{
    unsigned i;

    for (i = 0; i < u16(18); i++) {
        size_t e = 176 + 16 * (size_t)i;
        if (!memcmp(blob + e, id, 4)) {
            *bytes = u32(e + 8);
            return u32(e + 4);
        }
    }
    return 0;
}

static void print_header(void)
{
    size_t i;

    printf("format=%d\nside=%d\n", blob[16], blob[17]);
    printf("cells=%u,%u,%u\n", u16(20), u16(22), u16(24));
    printf("origin=%d,%d,%d\n", (int32_t)u32(28), (int32_t)u32(32),
           (int32_t)u32(36));
    printf("box_min=%u,%u,%u\n", u16(40), u16(42), u16(44));
    printf("box_max=%u,%u,%u\n", u16(46), u16(48), u16(50));
    printf("bricks=%u\n", u32(52));
    printf("density_max=%.9g\ndensity_mean=%.9g\n", number(56), number(64));
    printf("voxels=%u\n", u32(72));
    printf("world=");
    for (i = 0; i < 12; i++) {
        uint64_t bits = u32(80 + 8 * i) | (uint64_t)u32(84 + 8 * i) << 32;
        double v;
        memcpy(&v, &bits, 8);
        printf("%s%.9g", i ? "," : "", v);
    }
    printf("\n");
}

static int cell_axis(int a)
{
    return (int)u16(20 + 2 * (size_t)a);
}

/* The word of a cell; outside the grid, empty. */
static uint32_t cell(int x, int y, int z)
{
    size_t bytes, at = find("CELL", &bytes);
    int nx = cell_axis(0), ny = cell_axis(1), nz = cell_axis(2);

    if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz)
        return 0x800000ffu;
    return u32(at + 4 * ((size_t)x + (size_t)nx *
                         ((size_t)y + (size_t)ny * (size_t)z)));
}

/* Density of voxel (x,y,z), 0..8, of a brick, in 1/65280 of density_max. */
static unsigned density(uint32_t brick, int x, int y, int z)
{
    size_t bytes, pool = find("POOL", &bytes), ranges = find("RNGE", &bytes);
    size_t side = blob[17], n = side * side * side;
    size_t size = ((blob[16] == 3 ? (n + 1) / 2 : n) + 3) / 4 * 4;
    size_t i = (size_t)x + side * ((size_t)y + side * (size_t)z);
    const uint8_t *p = blob + pool + size * brick;

    if (blob[16] == 1)
        return 256u * p[i];
    return u16(ranges + 4 * (size_t)brick) +
           u16(ranges + 4 * (size_t)brick + 2) *
               (blob[16] == 2 ? p[i] : p[i / 2] >> (i % 2 * 4) & 15u);
}

static unsigned voxel(int x, int y, int z)
{
    uint32_t c = cell(x >> 3, y >> 3, z >> 3);

    return c >> 31 ? 0 : density(c, x & 7, y & 7, z & 7);
}

/* Is `claimed` the distance to the nearest occupied cell? Shells of growing
 * radius are searched. */
static int distance_holds(int x, int y, int z, int claimed)
{
    int r, i, j, k, most = cell_axis(0);

    most = cell_axis(1) > most ? cell_axis(1) : most;
    most = cell_axis(2) > most ? cell_axis(2) : most;
    for (r = 1; r <= most && r < 255; r++)
        for (k = -r; k <= r; k++)
            for (j = -r; j <= r; j++)
                for (i = -r; i <= r;
                     i += abs(j) == r || abs(k) == r ? 1 : 2 * r)
                    if (!(cell(x + i, y + j, z + k) >> 31))
                        return r == claimed;
    return claimed == 255;
}

static void verify_distances(void)
{
    int x, y, z;

    for (z = 0; z < cell_axis(2); z++)
        for (y = 0; y < cell_axis(1); y++)
            for (x = 0; x < cell_axis(0); x++) {
                uint32_t c = cell(x, y, z);
                if (c >> 31 && !distance_holds(x, y, z, (int)(c & 0xff)))
                    die("a distance is wrong");
                if (!(c >> 31) && c >= u32(52))
                    die("a cell names no brick");
            }
}

static void verify_box(void)
{
    int n[3], p[3], a;

    for (a = 0; a < 3; a++)
        n[a] = 8 * cell_axis(a);
    for (p[2] = 0; p[2] < n[2]; p[2]++)
        for (p[1] = 0; p[1] < n[1]; p[1]++)
            for (p[0] = 0; p[0] < n[0]; p[0]++)
                for (a = 0; a < 3; a++)
                    if ((p[a] < (int)u16(40 + 2 * (size_t)a) ||
                         p[a] > (int)u16(46 + 2 * (size_t)a)) &&
                        voxel(p[0], p[1], p[2]))
                        die("a voxel outside the box");
    for (a = 0; a < 3; a++)
        if (u16(40 + 2 * (size_t)a) == 0 ||
            (int)u16(46 + 2 * (size_t)a) >= n[a] - 1)
            die("the outer layer is not empty");
}

/* The apron of every brick against the next cells, exact in u8 only. */
static void verify_apron(void)
{
    int x, y, z;

    for (z = 0; z < 8 * cell_axis(2) && blob[16] == 1; z++)
        for (y = 0; y < 8 * cell_axis(1); y++)
            for (x = 7; x < 8 * cell_axis(0); x += 8) {
                uint32_t c = cell(x >> 3, y >> 3, z >> 3);
                unsigned next = voxel(x + 1, y, z);
                unsigned own = c >> 31 ? 0 : density(c, 8, y & 7, z & 7);
                if (own != next)
                    die("an apron differs from the next brick");
            }
}

static void compare_dump(const char *path)
{
    size_t bytes, at, count, i, used = 0;
    uint8_t *dump = load(path, &bytes);
    const char *end = strstr((char *)dump, "data float32le\n");
    int nx = 8 * cell_axis(0), ny = 8 * cell_axis(1), nz = 8 * cell_axis(2);
    int sx, sy, sz;
    double squared = 0, worst = 0, max = number(56);

    if (!end || sscanf((char *)dump, "brume-float 1\nsize %d %d %d", &sx,
                       &sy, &sz) != 3 || sx != nx || sy != ny || sz != nz)
        die("the dump's head is wrong");
    at = (size_t)(end - (char *)dump) + 15;
    count = (size_t)nx * (size_t)ny * (size_t)nz;
    if (bytes != at + 4 * count)
        die("the dump's size is wrong");
    for (i = 0; i < count; i++) {
        uint32_t bits = dump[at + 4 * i] | dump[at + 4 * i + 1] << 8 |
                        dump[at + 4 * i + 2] << 16 |
                        (uint32_t)dump[at + 4 * i + 3] << 24;
        float d;
        double e;
        memcpy(&d, &bits, 4);
        e = fabs(voxel((int)(i % (size_t)nx),
                       (int)(i / (size_t)nx % (size_t)ny),
                       (int)(i / (size_t)nx / (size_t)ny)) *
                     (max / 65280) - d);
        if (d == 0 && e != 0)
            die("an empty voxel is not exactly zero");
        used += d > 0;
        squared += e * e;
        worst = e > worst ? e : worst;
    }
    if (used != u32(72))
        die("the count of voxels is wrong");
    printf("rmse=%.6g\nmax=%.6g\n", sqrt(squared / (double)used) / max,
           worst / max);
    free(dump);
}

/* A recursive-descent check of RFC 8259, without numbers' finer points. */
static const char *json_value(const char *p);

static const char *json_space(const char *p)
{
    return p + strspn(p, " \t\r\n");
}

static const char *json_string(const char *p)
{
    if (*p != '"')
        die("JSON: a string is missing");
    for (p++; *p != '"'; p++) {
        if ((unsigned char)*p < 0x20)
            die("JSON: a bare control character");
        if (*p == '\\' && !strchr("\"\\/bfnrtu", *++p))
            die("JSON: a bad escape");
    }
    return p + 1;
}

static const char *json_list(const char *p, char close, int keys)
{
    p = json_space(p + 1);
    if (*p == close)
        return p + 1;
    for (;;) {
        if (keys) {
            p = json_space(json_string(json_space(p)));
            if (*p++ != ':')
                die("JSON: a colon is missing");
        }
        p = json_space(json_value(json_space(p)));
        if (*p == close)
            return p + 1;
        if (*p++ != ',')
            die("JSON: a comma is missing");
    }
}

static const char *json_value(const char *p)
{
    static const char *const words[] = {"true", "false", "null"};
    char *end;
    size_t i;

    if (*p == '{')
        return json_list(p, '}', 1);
    if (*p == '[')
        return json_list(p, ']', 0);
    if (*p == '"')
        return json_string(p);
    for (i = 0; i < 3; i++)
        if (!strncmp(p, words[i], strlen(words[i])))
            return p + strlen(words[i]);
    if (*p != '-' && (*p < '0' || *p > '9'))
        die("JSON: no value");
    strtod(p, &end);
    return end;
}

int main(int count, char **args)
{
    size_t bytes = 0, at;

    if (count < 3)
        die("see the head of tests/section_dump.c");
    blob = load(args[2], &blob_bytes);
    if (!strcmp(args[1], "json")) {
        const char *end = json_value(json_space((char *)blob));
        return *json_space(end) != 0;
    }
    if (blob_bytes < 176 || memcmp(blob, "BRME", 4) || u32(8) != blob_bytes)
        die("not a whole asset");
    if (!strcmp(args[1], "section") && count > 3) {
        at = find(args[3], &bytes);
        return at == 0 || fwrite(blob + at, 1, bytes, stdout) != bytes;
    }
    if (!strcmp(args[1], "header"))
        print_header();
    if (!strcmp(args[1], "verify")) {
        verify_distances();
        verify_box();
        if (blob[17] == 9)
            verify_apron();
        if (count > 3)
            compare_dump(args[3]);
    }
    free(blob);
    return 0;
}
