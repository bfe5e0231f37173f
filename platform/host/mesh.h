/* SPDX-License-Identifier: MIT */
/*
 * Solid things: triangles in pool space (see brume.h), from Wavefront OBJ files
 * and fields of heights. Both sides of a triangle are solid.
 *
 * Errors: as in image.h. After one the mesh may hold more or less than before;
 * mesh_free is all that is left to do with it.
 */
#ifndef BRUME_HOST_MESH_H
#define BRUME_HOST_MESH_H

#include "grey16.h"
#include "volume_file.h"

#define MESH_MAX (1u << 27) /* vertices, and triangles */
/* |coordinate| of a vertex, voxels: far beyond what any depth reaches, near
 * enough for sums and products of doubles. */
#define MESH_FAR 1e9

/* All zero: empty. */
struct mesh {
    double (*vertex)[3];
    uint32_t (*triangle)[3]; /* vertices, counterclockwise where that tells */
    uint8_t *thing;          /* of each triangle: the caller's number */
    uint32_t vertices, triangles;
    uint32_t vertex_room, triangle_room;
};

void mesh_free(struct mesh *mesh);

/* Adds a file's faces, world space. Lines v and f count, f of three or more
 * vertices, a convex polygon, each v, v/vt, v//vn or v/vt/vn, numbered from 1
 * or, negative, back from the last one. Those of looks, groups and lines are
 * passed over, all others refused. A face without area is nothing. Messages
 * start with FILE:LINE. */
int mesh_read_obj(struct mesh *mesh, const char *path,
                  const struct volume_file *file, uint8_t thing, char *err,
                  size_t err_size);
/* The same of `size` bytes; `name` is for messages. text[size] is 0. */
int mesh_parse_obj(struct mesh *mesh, const char *name, const char *text,
                   size_t size, const struct volume_file *file, uint8_t thing,
                   char *err, size_t err_size);

/* A level rectangle of the world at height `plane`, or hills on it: heights
 * are at the middles of texels, as in struct brume_shadow_map, 65535 being
 * `rise` above the plane, and stay the same from the outermost ones to the
 * rectangle's edges. */
struct mesh_ground {
    double plane;
    double area[4]; /* x0 z0 x1 z1 */
    double rise;
    const struct grey16 *heights; /* or NULL */
};
int mesh_add_ground(struct mesh *mesh, const struct mesh_ground *ground,
                    const struct volume_file *file, uint8_t thing, char *err,
                    size_t err_size);

#endif
