/* SPDX-License-Identifier: MIT */
/*
 * A sun map (struct brume_sun_map) as a file: binary PGM of 16 bits, with where
 * it lies in the world in comments of its header, so that any viewer shows it,
 * and any volume of the same world takes it:
 *
 *     P5
 *     # brume-sun-map 1
 *     # origin X Y Z      corner of texel (0,0), farthest towards the sun
 *     # across X Y Z      edge along a row, whole
 *     # down X Y Z        edge along a column, whole
 *     # range R           distance from the plane that 65535 stands for
 *     # bias B            what is darkened less deep than that is light
 *     WIDTH HEIGHT
 *     65535
 *
 * all of them in world units, as decimals that give the same doubles back.
 * Values and texels are those of struct brume_sun_map; away from the sun is
 * -(the plane's normal): the map holds no direction of its own, and a scene
 * whose sun is not across it is refused by the core.
 *
 * Errors: as in image.h.
 */
#ifndef BRUME_HOST_SUN_MAP_FILE_H
#define BRUME_HOST_SUN_MAP_FILE_H

#include "grey16.h"
#include "volume_file.h"

struct sun_map_file {
    double origin[3], across[3], down[3];
    double range, bias;
    struct grey16 texels;
};

/* Reads and checks it: all lines are there and finite, sides are edges with a
 * length, range > 0, bias >= 0. Messages start with the path. On failure *map
 * is empty; sun_map_file_free of an empty one is fine. */
int sun_map_file_read(const char *path, struct sun_map_file *map, char *err,
                      size_t err_size);
void sun_map_file_free(struct sun_map_file *map);

/* The file's bytes; the receiver frees file->data. */
int sun_map_file_encode(const struct sun_map_file *map, struct image_file *file,
                        char *err, size_t err_size);

/* The core's map for a volume's pool. It points at the texels of *map, which
 * must outlive it. Fails when it is out of the core's reach: then the message
 * says what of the map is. */
int sun_map_file_apply(const struct sun_map_file *map,
                       const struct volume_file *file,
                       struct brume_sun_map *out, char *err, size_t err_size);

#endif
