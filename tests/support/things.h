/* SPDX-License-Identifier: MIT */
/*
 * A volume, a camera and solid things for tests of surfaces.
 */
#ifndef BRUME_TESTS_THINGS_H
#define BRUME_TESTS_THINGS_H

#include "surface.h"

extern char things_err[400];
extern struct volume_file things_volume; /* whose world is its pool */
/* 160x120, from (0, 10, -40) to (0, 8, 0), fov 50, the sun overhead. */
extern struct brume_scene things_scene;

/* Fills both; free(things_volume.data) is left to do. */
void things_begin(void);

void things_point(int32_t out[3], double x, double y, double z);

/* OBJ text that is good; a box from a to b; a sphere of n rings and 2 n
 * sectors. */
void things_obj(struct mesh *mesh, const char *text);
void things_box(struct mesh *mesh, const double a[3], const double b[3]);
void things_sphere(struct mesh *mesh, const double centre[3], double radius,
                   int n);

/* A surface of albedo 0.25 over a mesh, and the end of both. */
void things_surface(struct surface *s, const struct mesh *mesh);
void things_end(struct surface *s, struct mesh *mesh);

#endif
