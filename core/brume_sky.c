/* SPDX-License-Identifier: MIT */
/* What is behind the volume: a sky that goes from the horizon to the zenith, a
 * ground below it, and the sun's disc; docs/light.md has the definition. */
#include "brume_inner.h"

#if BRUME_WITH_SKY

#define ONE 0x40000000u /* Q2.30 */

/* Colours of struct brume_lit. */
enum { ZENITH, HORIZON, GROUND, DISC };

/* exposure * colour: Q16.16, at most 256. 0 stands for an exposure of 1. */
static void expose(uint32_t out[3], const uint32_t colour[3], uint32_t exposure)
{
    uint32_t e = exposure != 0 ? exposure : 0x10000u;
    for (int c = 0; c < 3; c++) /* up to 2^20 each, with 4 bits to round */
        out[c] = (mul_hi_floor(colour[c] << 10, e << 10) + 8u) >> 4;
}

void brume_sky_begin(struct brume_frame *frame, const struct brume_scene *scene)
{
    const struct brume_lighting *l = scene->lighting;
    struct brume_lit *lit = &frame->lit;
    lit->sky = l != NULL && l->sky;
    lit->haze = 0;
    if (l == NULL)
        return;
    if (l->haze != 0)
        lit->haze = brume_number_floor(
            brume_number_inverse(brume_number_of(l->haze, -16)), 32);
    expose(lit->sky_colour[ZENITH], l->sky_zenith, l->exposure);
    expose(lit->sky_colour[HORIZON], l->sky_horizon, l->exposure);
    expose(lit->sky_colour[GROUND], l->sky_ground, l->exposure);
    expose(lit->sky_colour[DISC], l->sun_disc, l->exposure);
}
/* from + (to - from) * (1 - s)^4, s and the power in Q2.30 from 0 to 1. Error
 * of the power below 2^-28. */
static void gradient(uint32_t out[3], const uint32_t from[3],
                     const uint32_t to[3], uint32_t s)
{
    uint32_t u = s < ONE ? ONE - s : 0;
    uint32_t square = mul_hi_floor(u << 1, u << 1);
    uint32_t fourth = mul_hi_floor(square << 1, square << 1);
    for (int c = 0; c < 3; c++) /* differences are below 2^24 */
        out[c] =
            (uint32_t)((int32_t)from[c] +
                       mul_signed_round((int32_t)(to[c] - from[c]), fourth, 2));
}

void brume_sky_colour(const struct brume_frame *frame, uint32_t x, uint32_t y,
                      uint32_t out[3])
{
    const struct brume_lit *lit = &frame->lit;
    int32_t ray[3];
    brume_pixel_direction(frame, x, y, ray);
    brume_normalise(ray);
    int32_t s = brume_dot(ray, lit->zenith);
    bool disc = brume_one_minus_cos(ray, frame->sun) < lit->lighting->sun_size;
    for (int c = 0; c < 3; c++)
        out[c] = lit->sky_colour[GROUND][c];
    if (s >= 0)
        gradient(out, lit->sky_colour[ZENITH], lit->sky_colour[HORIZON],
                 (uint32_t)s);
    for (int c = 0; c < 3; c++) {
        out[c] += disc ? lit->sky_colour[DISC][c] : 0;
        out[c] = out[c] < BRUME_MAX_LIGHT ? out[c] : BRUME_MAX_LIGHT;
    }
}
#endif
