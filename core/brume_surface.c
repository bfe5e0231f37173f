/* SPDX-License-Identifier: MIT */
/* What stands in the volume's world: a surface that rays end at, and a map of
 * what shades the sun. docs/light.md. */
#include "brume_inner.h"

#if BRUME_WITH_SURFACE

/// Surface ///

bool brume_surface_is_good(const struct brume_surface *surface, uint32_t width)
{
    return surface->depth != NULL && surface->stride >= width;
}

/* The smallest distance that has a depth code; nothing is nearer than that of
 * code 0. */
static uint32_t distance_of(uint32_t code)
{
    uint32_t high = code >> 11, m = (code & 0x7ffu) | 0x800u;
    if (code == 0)
        return 0;
    return high > 11 ? m << (high - 11u) : m >> (11u - high);
}

/* The pixel at a ray's middle: below and right of it, where it stands for an
 * even number; and the nearest, where that is not in the image. */
static uint32_t pixel_of(uint32_t ray, uint32_t resolution, uint32_t size)
{
    uint32_t pixel = (ray << resolution) + (1u << resolution >> 1);
    return pixel < size ? pixel : size - 1u;
}

uint32_t brume_surface_distance(const struct brume_frame *frame, uint32_t x,
                                uint32_t y)
{
    const struct brume_frame *f = frame;
    const struct brume_surface *s = f->lit.lighting->surface;
    if (s == NULL)
        return 0xffffffffu;
    uint32_t r = brume_resolution_of(f);
    uint32_t code = s->depth[pixel_of(y, r, f->height) * s->stride +
                             pixel_of(x, r, f->width)];
    return code == BRUME_NO_DEPTH ? 0xffffffffu : distance_of(code);
}

/// Sun map ///

bool brume_sun_map_is_good(const struct brume_sun_map *map)
{
    if (map->width < 1 || map->width > BRUME_MAX_SIZE || map->height < 1 ||
        map->height > BRUME_MAX_SIZE || map->range < 0x10000u ||
        map->range > 65535u << 16 || map->bias > map->range ||
        map->depth == NULL || map->stride < map->width)
        return false;
    for (int i = 0; i < 3; i++)
        for (unsigned corner = 0; corner < 4; corner++) {
            int64_t p = map->origin[i];
            p += corner & 1u ? map->across[i] : 0;
            p += corner & 2u ? map->down[i] : 0;
            if (p > BRUME_MAX_COORDINATE || p < -BRUME_MAX_COORDINATE)
                return false;
        }
    return true;
}

/* The unit vector along an edge, which must lie across the sun. */
static bool edge_of(int32_t out[3], const int32_t edge[3], const int32_t sun[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = edge[i];
    return brume_normalise(out) && magnitude(brume_dot(out, sun)) <= 1u << 22;
}

/* The axis along which `edge` alone counts, seen from the sun: across `other`
 * and the sun. And how many of the `size` texels, Q8, a way of Q13 along it
 * has. */
static bool set_texels(struct brume_lit_map *out, int n, const int32_t edge[3],
                       const int32_t other[3], const int32_t sun[3],
                       uint32_t size)
{
    int32_t *axis = out->axis[n];
    int32_t length = 0; /* Q17.15 */
    brume_cross(axis, other, sun);
    if (!brume_normalise(axis))
        return false;
    for (int i = 0; i < 3; i++)
        length += mul_both_signed_round(edge[i], axis[i], 1);
    for (int i = 0; length < 0 && i < 3; i++)
        axis[i] = -axis[i];
    if (length == 0)
        return false;
    out->scale[n] = brume_number_mul(
        brume_number_of(size, -5),
        brume_number_inverse(brume_number_of(magnitude(length), -15)));
    return true;
}

/* Down from the plane, and how many codes a way of Q13 has along the sun. */
static bool set_codes(struct brume_lit_map *out, const int32_t across[3],
                      const int32_t down[3], const int32_t sun[3],
                      uint32_t range)
{
    /* 1/64: edges that are nearly parallel are no plane */
    const uint32_t least = 1u << 24;
    int32_t *axis = out->axis[2];
    brume_cross(axis, across, down);
    if ((magnitude(axis[0]) | magnitude(axis[1]) | magnitude(axis[2])) <
            least ||
        !brume_normalise(axis))
        return false;
    int32_t along = brume_dot(axis, sun); /* nearly 1 or -1 */
    for (int i = 0; along > 0 && i < 3; i++)
        axis[i] = -axis[i];
    struct brume_number reach = brume_number_mul(
        brume_number_of(range, -16), brume_number_of(magnitude(along), -30));
    out->scale[2] = brume_number_mul(brume_number_of(65535u, -13),
                                     brume_number_inverse(reach));
    return true;
}

bool brume_sun_map_begin(struct brume_frame *frame,
                         const struct brume_scene *scene)
{
    const struct brume_sun_map *map = scene->lighting->sun_map;
    struct brume_lit_map *out = &frame->lit.map;
    const int32_t *sun = frame->sun;
    int32_t across[3], down[3];
    frame->lit.sun_map = map;
    out->bias = (int32_t)(map->bias >> 3);
    for (int i = 0; i < 3; i++)
        out->origin[i] = (map->origin[i] + frame->eye[i] - scene->eye[i]) / 2;
    return edge_of(across, map->across, sun) && edge_of(down, map->down, sun) &&
           set_codes(out, across, down, sun, map->range) &&
           set_texels(out, 0, map->across, down, sun, map->width) &&
           set_texels(out, 1, map->down, across, sun, map->height);
}

uint32_t brume_sun_map_sameness(const struct brume_frame *frame)
{
    const struct brume_sun_map *m = frame->lit.sun_map;
    uint32_t h = m->width | (uint32_t)m->height << 16;
    h = (h ^ m->range) * 16777619u ^ m->bias;
    for (int i = 0; i < 3; i++) {
        h = h * 16777619u ^ (uint32_t)m->origin[i];
        h = h * 16777619u ^ (uint32_t)m->across[i];
        h = h * 16777619u ^ (uint32_t)m->down[i];
    }
    return h;
}

#endif
