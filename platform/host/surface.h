/* SPDX-License-Identifier: MIT */
/*
 * Solid things as a scene's camera and sun see them: depths for struct
 * brume_surface, a picture, and a map for struct brume_sun_map. Everything is
 * in pool space, with the core's own rays, in doubles (see caster.h).
 *
 * Errors: as in image.h.
 */
#ifndef BRUME_HOST_SURFACE_H
#define BRUME_HOST_SURFACE_H

#include "caster.h"
#include "pool.h"
#include "sun_map_file.h"

#define SURFACE_THINGS 32
#define SURFACE_SAMPLES 16 /* of a picture, across a pixel and down */

/* The volume's shadow: a map of `brume shadow` on a level plane. */
struct surface_shade {
    const struct image *map; /* grey; or NULL: none */
    double plane, area[4];   /* world, as struct shadow_place */
};

struct surface {
    const struct mesh *mesh;
    const struct caster *caster;
    const struct volume_file *file;
    struct surface_shade shade;
    double albedo[SURFACE_THINGS][3]; /* of things, linear */
    /* From here on: see surface_begin. */
    struct brume_scene scene; /* the camera's, and no more */
    struct brume_lighting lighting;
    struct brume_frame frame;
    double eye[3], sun[3], zenith[3]; /* pool; unit vectors */
    double world_sun[3];
    double sun_light[3], sky_light[3]; /* radiance of a white thing */
    double exposure;
    const struct brume_lamp *lamps;
    uint32_t lamp_count;
};

/* Takes camera, sun and light of a scene of scene_apply. `sky` is the constant
 * sky's radiance, NULL for that of the scene's ambient light, or 0.1. */
int surface_begin(struct surface *surface, const struct brume_scene *scene,
                  const double sky[3], char *err, size_t err_size);

/* The unit vector of a ray u half pixels right of the middle and v above: the
 * core's, which is linear in both. */
void surface_ray(const struct surface *surface, double u, double v,
                 double out[3]);

/* The code of a distance, as brume_radiance.depth: rounded down. */
uint16_t surface_depth_code(double voxels);

/* Depth of every pixel. `pool` or NULL. */
int surface_depth(const struct surface *surface, struct pool *pool,
                  struct grey16 *out, char *err, size_t err_size);

/* Linear radiance with the scene's exposure, 1 to 8 and more not clipped:
 * floats, RGB. samples^2 rays a pixel, evenly spaced. What things leave free
 * is the scene's background or sky.
 *
 *   albedo * (4 * sun_colour * cos * what comes through
 *             + sky * (1 + n . zenith) / 2 + 4 * lamps * cos)
 *
 * In the core's unit, the radiance of a particle of albedo 1 that scatters in
 * all directions alike, a white wall that faces the sun has 4: irradiance
 * 4 pi over pi. The sky's share is that which a facet sees of it. */
int surface_colour(const struct surface *surface, struct pool *pool,
                   unsigned samples, struct image *out, char *err,
                   size_t err_size);

/* The sun's view of the things. It covers these and the volume's box or, where
 * `cover` is not NULL, the box of the world from its first three numbers to its
 * last. bias < 0: one texel's diagonal, plus what rounding takes. */
int surface_sun_map(const struct surface *surface, struct pool *pool,
                    const unsigned size[2], const double *cover, double bias,
                    struct sun_map_file *out, char *err, size_t err_size);

#endif
