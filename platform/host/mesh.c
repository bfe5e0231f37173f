/* SPDX-License-Identifier: MIT */
#include "mesh.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/// Growing ///

void mesh_free(struct mesh *mesh)
{
    free(mesh->vertex);
    free(mesh->triangle);
    free(mesh->thing);
    memset(mesh, 0, sizeof *mesh);
}

static uint32_t more_room(uint32_t room)
{
    return room == 0 ? 1024 : room < MESH_MAX / 2 ? 2 * room : MESH_MAX;
}

/* Each returns NULL, or what is wrong. */
static const char *add_vertex(struct mesh *mesh, const double world[3],
                              const struct volume_file *file)
{
    if (mesh->vertices == mesh->vertex_room) {
        uint32_t room = more_room(mesh->vertex_room);
        void *more = mesh->vertices == MESH_MAX
                         ? NULL
                         : realloc(mesh->vertex, room * sizeof *mesh->vertex);
        if (more == NULL)
            return mesh->vertices == MESH_MAX ? "more than 2^27 vertices"
                                              : "not enough memory";
        mesh->vertex = more;
        mesh->vertex_room = room;
    }
    double *out = mesh->vertex[mesh->vertices];
    volume_file_to_pool(file, world, out);
    for (int i = 0; i < 3; i++)
        if (!(fabs(out[i]) <= MESH_FAR))
            return "vertex more than 10^9 voxels away";
    mesh->vertices++;
    return NULL;
}

static bool grow_triangles(struct mesh *mesh)
{
    uint32_t room = more_room(mesh->triangle_room);
    void *more = realloc(mesh->triangle, room * sizeof *mesh->triangle);
    if (more == NULL)
        return false;
    mesh->triangle = more;
    more = realloc(mesh->thing, room);
    if (more == NULL)
        return false;
    mesh->thing = more;
    mesh->triangle_room = room;
    return true;
}

static bool has_area(const double *a, const double *b, const double *c)
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        if ((b[i] - a[i]) * (c[j] - a[j]) != (b[j] - a[j]) * (c[i] - a[i]))
            return true;
    }
    return false;
}

static const char *add_triangle(struct mesh *mesh, uint32_t a, uint32_t b,
                                uint32_t c, uint8_t thing)
{
    if (!has_area(mesh->vertex[a], mesh->vertex[b], mesh->vertex[c]))
        return NULL;
    if (mesh->triangles == MESH_MAX)
        return "more than 2^27 triangles";
    if (mesh->triangles == mesh->triangle_room && !grow_triangles(mesh))
        return "not enough memory";
    uint32_t *out = mesh->triangle[mesh->triangles];
    out[0] = a;
    out[1] = b;
    out[2] = c;
    mesh->thing[mesh->triangles++] = thing;
    return NULL;
}

/// OBJ ///

struct obj {
    struct mesh *mesh;
    const struct volume_file *file;
    const char *at;     /* the text ends with a 0 */
    unsigned long line; /* from 1 */
    uint32_t base;      /* the mesh's vertices before this file's */
    uint8_t thing;
    const char *bad; /* of this line, when something is */
};

/* Blanks, and ends of lines behind a backslash. */
static void skip_blanks(struct obj *o)
{
    for (;; o->at++) {
        size_t end = o->at[0] != '\\'                       ? 0
                     : o->at[1] == '\n'                     ? 1
                     : o->at[1] == '\r' && o->at[2] == '\n' ? 2
                                                            : 0;
        o->line += end > 0;
        o->at += end;
        if (end == 0 && *o->at != ' ' && *o->at != '\t' && *o->at != '\r')
            return;
    }
}

static bool at_end(const struct obj *o)
{
    return *o->at == '\n' || *o->at == '\0' || *o->at == '#';
}

static bool is_end_of_word(char c)
{
    return c == '\0' || strchr(" \t\r\n#\\", c) != NULL;
}

static bool take_number(struct obj *o, double *out)
{
    size_t length = strspn(o->at, "+-.0123456789eE");
    char *end;
    if (length == 0 || !is_end_of_word(o->at[length])) {
        o->bad = "not a finite number";
        return false;
    }
    *out = strtod(o->at, &end);
    if (end != o->at + length || !isfinite(*out)) {
        o->bad = "not a finite number";
        return false;
    }
    o->at = end;
    skip_blanks(o);
    return true;
}

/* v x y z, and perhaps a weight or a colour, which are left out. */
static void take_vertex(struct obj *o)
{
    double v[8];
    int n = 0;
    while (n < 8 && !at_end(o))
        if (!take_number(o, &v[n++]))
            return;
    if (n < 3 || n > 7)
        o->bad = "a vertex takes three numbers";
    else
        o->bad = add_vertex(o->mesh, v, o->file);
}

/* A whole number that is not 0, |.| at most MESH_MAX. */
static bool take_index(struct obj *o, long *out)
{
    const char *digits = o->at + (*o->at == '-');
    char *end;
    if (*digits < '0' || *digits > '9')
        return false;
    errno = 0;
    *out = strtol(o->at, &end, 10);
    o->at = end;
    return errno == 0 && *out != 0 && *out <= (long)MESH_MAX &&
           *out >= -(long)MESH_MAX;
}

/* v, v/vt, v//vn or v/vt/vn; the vertex as a number of the mesh. */
static bool take_corner(struct obj *o, uint32_t *out)
{
    long v, unused, count = (long)(o->mesh->vertices - o->base);
    bool good = take_index(o, &v);
    if (good && *o->at == '/') {
        o->at++;
        good = *o->at == '/' || take_index(o, &unused);
        if (good && *o->at == '/') {
            o->at++;
            good = take_index(o, &unused);
        }
    }
    if (!good || !is_end_of_word(*o->at)) {
        o->bad = "a face takes vertices like 1, 1/2, 1//3, 1/2/3 or -1";
        return false;
    }
    v = v > 0 ? v - 1 : count + v;
    if (v < 0 || v >= count) {
        o->bad = "face with a vertex that is not there (yet)";
        return false;
    }
    *out = o->base + (uint32_t)v;
    skip_blanks(o);
    return true;
}

/* A fan around the first corner. */
static void take_face(struct obj *o)
{
    uint32_t first = 0, last = 0, corner, n = 0;
    for (; !at_end(o) && o->bad == NULL; n++) {
        if (!take_corner(o, &corner))
            return;
        if (n == 0)
            first = corner;
        if (n >= 2)
            o->bad = add_triangle(o->mesh, first, last, corner, o->thing);
        last = corner;
    }
    if (o->bad == NULL && n < 3)
        o->bad = "a face takes three vertices or more";
}

/* Is the line's word of length n one that says nothing of faces? */
static bool is_passed_over(const char *word, size_t n)
{
    static const char *const k_words[] = {"vt", "vn", "vp", "g",      "o",
                                          "s",  "l",  "p",  "mtllib", "usemtl"};
    for (size_t i = 0; i < sizeof k_words / sizeof *k_words; i++)
        if (strlen(k_words[i]) == n && memcmp(k_words[i], word, n) == 0)
            return true;
    return false;
}

/* One line, up to its end. */
static void take_line(struct obj *o)
{
    skip_blanks(o);
    const char *word = o->at;
    size_t n = strcspn(word, " \t\r\n#\\");
    o->at += n;
    skip_blanks(o);
    if (n == 1 && *word == 'v')
        take_vertex(o);
    else if (n == 1 && *word == 'f')
        take_face(o);
    else if (n > 0 && !is_passed_over(word, n))
        o->bad = "a line of no known kind";
    while (o->bad == NULL && *o->at != '\n' && *o->at != '\0') {
        o->at++; /* what is passed over, and comments */
        skip_blanks(o);
    }
}

int mesh_parse_obj(struct mesh *mesh, const char *name, const char *text,
                   size_t size, const struct volume_file *file, uint8_t thing,
                   char *err, size_t err_size)
{
    struct obj o = {.mesh = mesh,
                    .file = file,
                    .at = text,
                    .line = 1,
                    .base = mesh->vertices,
                    .thing = thing};
    uint32_t before = mesh->triangles;
    for (; o.at < text + size; o.line++, o.at++) {
        take_line(&o);
        if (o.bad == NULL && *o.at == '\0' && o.at < text + size)
            o.bad = "a byte of value 0";
        if (o.bad != NULL)
            return image_error(err, err_size, "%s:%lu: %s", name, o.line,
                               o.bad);
    }
    if (mesh->triangles == before)
        return image_error(err, err_size, "%s: no faces with an area", name);
    return 0;
}

int mesh_read_obj(struct mesh *mesh, const char *path,
                  const struct volume_file *file, uint8_t thing, char *err,
                  size_t err_size)
{
    struct image_file bytes;
    char what[256];
    char *text = NULL;
    int status = -1;
    if (image_get(path, &bytes, what, sizeof what) != 0)
        image_error(err, err_size, "%s: %s", path, what);
    else if ((text = realloc(bytes.data, bytes.size + 1)) == NULL)
        image_error(err, err_size, "%s: not enough memory", path);
    if (text != NULL) {
        text[bytes.size] = '\0';
        status = mesh_parse_obj(mesh, path, text, bytes.size, file, thing, err,
                                err_size);
        free(text);
    } else {
        free(bytes.data);
    }
    return status;
}

/// Ground ///

/* Of columns (or rows) 0 .. n + 1: the rectangle's edges, and between them the
 * middles of n texels. From 0 to 1. */
static double place_of(int i, int n)
{
    return i == 0 ? 0 : i > n ? 1 : (i - 0.5) / n;
}

static double height_at(const struct mesh_ground *ground, int x, int y)
{
    const struct grey16 *h = ground->heights;
    if (h == NULL)
        return ground->plane;
    x = x < 1 ? 0 : x > h->width ? h->width - 1 : x - 1;
    y = y < 1 ? 0 : y > h->height ? h->height - 1 : y - 1;
    return ground->plane +
           ground->rise * h->values[(size_t)y * (size_t)h->width + (size_t)x] /
               65535.0;
}

int mesh_add_ground(struct mesh *mesh, const struct mesh_ground *ground,
                    const struct volume_file *file, uint8_t thing, char *err,
                    size_t err_size)
{
    const struct grey16 *h = ground->heights;
    const double *a = ground->area;
    int w = h == NULL ? 0 : h->width, d = h == NULL ? 0 : h->height;
    uint32_t base = mesh->vertices, before = mesh->triangles;
    uint32_t across = (uint32_t)w + 2;
    const char *bad = NULL;
    for (int y = 0; y < d + 2; y++)
        for (int x = 0; x < w + 2 && bad == NULL; x++) {
            const double p[3] = {a[0] + (a[2] - a[0]) * place_of(x, w),
                                 height_at(ground, x, y),
                                 a[1] + (a[3] - a[1]) * place_of(y, d)};
            bad = add_vertex(mesh, p, file);
        }
    for (uint32_t y = 0; y < (uint32_t)d + 1; y++)
        for (uint32_t x = 0; x < across - 1 && bad == NULL; x++) {
            uint32_t v = base + y * across + x, below = v + across;
            bad = add_triangle(mesh, v, below, v + 1, thing);
            if (bad == NULL)
                bad = add_triangle(mesh, v + 1, below, below + 1, thing);
        }
    if (bad == NULL && mesh->triangles == before)
        bad = "no area";
    return bad == NULL ? 0 : image_error(err, err_size, "ground: %s", bad);
}
