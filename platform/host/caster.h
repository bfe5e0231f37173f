/* SPDX-License-Identifier: MIT */
/*
 * Rays against a mesh: a tree of boxes over its triangles, and the watertight
 * test of Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", 2013.
 *
 * In doubles, compiled without contraction, and with no function but sqrt: the
 * same answer on every host whose doubles are IEEE's. A ray through an edge or
 * a corner that triangles share meets at least one of them.
 */
#ifndef BRUME_HOST_CASTER_H
#define BRUME_HOST_CASTER_H

#include "mesh.h"

struct caster;

struct ray_hit {
    double distance;
    uint32_t triangle;
};

/* The mesh must stay as it is. NULL without memory. */
struct caster *caster_new(const struct mesh *mesh);
void caster_free(struct caster *caster);

/* The nearest triangle at a distance from 0 to `far` along a unit vector; of
 * those equally near the one of the lowest number. */
bool caster_nearest(const struct caster *caster, const double origin[3],
                    const double unit[3], double far, struct ray_hit *hit);
/* Is there any? */
bool caster_meets(const struct caster *caster, const double origin[3],
                  const double unit[3], double far);

#endif
