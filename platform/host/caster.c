/* SPDX-License-Identifier: MIT */
#include "caster.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LEAF 4u
/* Below this depth triangles are halved by number, not by place, so that no
 * mesh makes the tree deeper than this and 27 more. */
#define SPLIT_DEPTH 40
#define STACK 80

/* Boxes are in one array, a node's first child behind it. */
struct node {
    double low[3], high[3];
    uint32_t first;  /* of a leaf: in `order` */
    uint32_t count;  /* of a leaf, else 0 */
    uint32_t second; /* the other child */
    int axis;        /* that it was split along */
};

struct caster {
    const struct mesh *mesh;
    struct node *nodes;
    uint32_t node_count;
    uint32_t *order; /* triangles, those of a leaf together */
};

/// Tree ///

/* Twice the middle of a triangle's box would do as well as any point. */
static double middle_of(const struct mesh *m, uint32_t triangle, int axis)
{
    const uint32_t *t = m->triangle[triangle];
    double a = m->vertex[t[0]][axis], b = m->vertex[t[1]][axis];
    double c = m->vertex[t[2]][axis];
    return fmin(a, fmin(b, c)) + fmax(a, fmax(b, c));
}

static void bound(const struct caster *c, struct node *n, uint32_t first,
                  uint32_t count)
{
    for (int i = 0; i < 3; i++) {
        n->low[i] = INFINITY;
        n->high[i] = -INFINITY;
    }
    for (uint32_t k = 0; k < 3 * count; k++) {
        const uint32_t *t = c->mesh->triangle[c->order[first + k / 3]];
        const double *v = c->mesh->vertex[t[k % 3]];
        for (int i = 0; i < 3; i++) {
            n->low[i] = fmin(n->low[i], v[i]);
            n->high[i] = fmax(n->high[i], v[i]);
        }
    }
}

/* Puts those whose middles are in the lower half of the middles' longest side
 * first; returns how many they are. */
static uint32_t split(const struct caster *c, struct node *n, uint32_t first,
                      uint32_t count)
{
    double low[3], high[3];
    for (int i = 0; i < 3; i++) {
        low[i] = INFINITY;
        high[i] = -INFINITY;
        for (uint32_t k = 0; k < count; k++) {
            double p = middle_of(c->mesh, c->order[first + k], i);
            low[i] = fmin(low[i], p);
            high[i] = fmax(high[i], p);
        }
    }
    n->axis = 0;
    for (int i = 1; i < 3; i++)
        if (high[i] - low[i] > high[n->axis] - low[n->axis])
            n->axis = i;
    double at = low[n->axis] + (high[n->axis] - low[n->axis]) / 2;
    uint32_t left = 0;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t triangle = c->order[first + k];
        if (middle_of(c->mesh, triangle, n->axis) > at)
            continue;
        c->order[first + k] = c->order[first + left];
        c->order[first + left++] = triangle;
    }
    return left;
}

/* The depth is at most SPLIT_DEPTH + 27. Returns the node's number. */
static uint32_t build(struct caster *c, uint32_t first, uint32_t count,
                      int depth)
{
    uint32_t number = c->node_count++;
    struct node *n = &c->nodes[number];
    bound(c, n, first, count);
    n->first = first;
    n->count = count;
    if (count <= LEAF)
        return number;
    uint32_t left = split(c, n, first, count);
    if (left == 0 || left == count || depth >= SPLIT_DEPTH)
        left = count / 2;
    n->count = 0;
    build(c, first, left, depth + 1);
    n->second = build(c, first + left, count - left, depth + 1);
    return number;
}

struct caster *caster_new(const struct mesh *mesh)
{
    struct caster *c = calloc(1, sizeof *c);
    if (c == NULL)
        return NULL;
    size_t n = mesh->triangles;
    c->mesh = mesh;
    c->order = malloc((n + 1) * sizeof *c->order);
    c->nodes = calloc(2 * n + 1, sizeof *c->nodes); /* leaves hold >= 1 */
    if (c->order == NULL || c->nodes == NULL) {
        caster_free(c);
        return NULL;
    }
    for (uint32_t i = 0; i < n; i++)
        c->order[i] = i;
    if (n > 0)
        build(c, 0, (uint32_t)n, 0);
    return c;
}

void caster_free(struct caster *caster)
{
    if (caster == NULL)
        return;
    free(caster->nodes);
    free(caster->order);
    free(caster);
}

/// Rays ///

/* A ray, and the shear that turns it into the axis z of a system whose x and y
 * are axes of the pool: unit[kz] is its largest. */
struct ray {
    const double *origin, *unit;
    double inverse[3];
    int kx, ky, kz;
    double sx, sy, sz;
    double far;
};

static void begin(struct ray *r, const double origin[3], const double unit[3],
                  double far)
{
    r->origin = origin;
    r->unit = unit;
    r->far = far;
    r->kz = 0;
    for (int i = 0; i < 3; i++) {
        r->inverse[i] = 1 / unit[i];
        if (fabs(unit[i]) > fabs(unit[r->kz]))
            r->kz = i;
    }
    r->kx = (r->kz + 1) % 3;
    r->ky = (r->kz + 2) % 3;
    r->sx = unit[r->kx] / unit[r->kz];
    r->sy = unit[r->ky] / unit[r->kz];
    r->sz = 1 / unit[r->kz];
}

/* 0 / 0 where a ray lies in a face's plane compares false: the box stays. The
 * far end gets what rounding may have taken. */
static bool meets_box(const struct ray *r, const struct node *n)
{
    double near = 0, far = r->far;
    for (int i = 0; i < 3; i++) {
        bool back = r->inverse[i] < 0;
        double in =
            ((back ? n->high : n->low)[i] - r->origin[i]) * r->inverse[i];
        double out =
            ((back ? n->low : n->high)[i] - r->origin[i]) * r->inverse[i];
        out += fabs(out) * 1e-15;
        if (in > near)
            near = in;
        if (out < far)
            far = out;
    }
    return !(near > far);
}

/* The shared edge of two triangles has the same products with another sign in
 * both, so that no ray passes between them. False for edges seen end on. */
static bool meets_triangle(const struct ray *r, const struct mesh *m,
                           const uint32_t *t, double *distance)
{
    double x[3], y[3], z[3], e[3];
    for (int i = 0; i < 3; i++) {
        const double *v = m->vertex[t[i]];
        double depth = v[r->kz] - r->origin[r->kz];
        x[i] = (v[r->kx] - r->origin[r->kx]) - r->sx * depth;
        y[i] = (v[r->ky] - r->origin[r->ky]) - r->sy * depth;
        z[i] = r->sz * depth;
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        e[i] = x[k] * y[j] - y[k] * x[j];
    }
    if ((e[0] < 0 || e[1] < 0 || e[2] < 0) &&
        (e[0] > 0 || e[1] > 0 || e[2] > 0))
        return false;
    double area = e[0] + e[1] + e[2];
    if (area == 0)
        return false;
    *distance = (e[0] * z[0] + e[1] * z[1] + e[2] * z[2]) / area;
    return *distance >= 0 && *distance <= r->far;
}

/* The nearest of a leaf; r->far becomes its distance. */
static bool meets_leaf(const struct caster *c, struct ray *r,
                       const struct node *n, struct ray_hit *hit)
{
    bool any = false;
    for (uint32_t k = n->first; k < n->first + n->count; k++) {
        uint32_t triangle = c->order[k];
        double t;
        if (!meets_triangle(r, c->mesh, c->mesh->triangle[triangle], &t) ||
            (t == hit->distance && triangle > hit->triangle))
            continue;
        hit->distance = r->far = t;
        hit->triangle = triangle;
        any = true;
    }
    return any;
}

static bool cast(const struct caster *c, struct ray *r, bool first_is_enough,
                 struct ray_hit *hit)
{
    uint32_t stack[STACK], depth = 0;
    bool any = false;
    hit->distance = INFINITY;
    hit->triangle = UINT32_MAX;
    if (c->node_count > 0)
        stack[depth++] = 0;
    while (depth > 0 && !(any && first_is_enough)) {
        uint32_t number = stack[--depth];
        const struct node *n = &c->nodes[number];
        if (!meets_box(r, n))
            continue;
        if (n->count > 0) {
            any = meets_leaf(c, r, n, hit) || any;
            continue;
        }
        bool back = r->unit[n->axis] < 0; /* the nearer one is popped first */
        stack[depth++] = back ? number + 1 : n->second;
        stack[depth++] = back ? n->second : number + 1;
    }
    return any;
}

bool caster_nearest(const struct caster *caster, const double origin[3],
                    const double unit[3], double far, struct ray_hit *hit)
{
    struct ray r;
    begin(&r, origin, unit, far);
    return cast(caster, &r, false, hit);
}

bool caster_meets(const struct caster *caster, const double origin[3],
                  const double unit[3], double far)
{
    struct ray r;
    struct ray_hit hit;
    begin(&r, origin, unit, far);
    return cast(caster, &r, true, &hit);
}
