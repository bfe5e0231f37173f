/* SPDX-License-Identifier: MIT */
/* What a frame makes of its fog, by height and of shapes: docs/light.md. */
#include "brume_inner.h"

#if BRUME_WITH_FOG

#define MOST_HALF (16384u << 16) /* of a shape, Q16.16 */
#define MOST_FAR (32766u << 16)

/// Checks ///

static bool shape_is_good(const struct brume_fog_shape *s)
{
    uint32_t sides = s->kind == BRUME_FOG_BOX ? 3 : 1;
    if (s->kind > BRUME_FOG_BOX || s->softness > 0x10000u)
        return false;
    for (uint32_t i = 0; i < sides; i++)
        if (s->half[i] < 0x10000u || s->half[i] > MOST_HALF)
            return false;
    for (int i = 0; i < 3; i++)
        if (magnitude(s->centre[i]) > BRUME_MAX_COORDINATE)
            return false;
    return true;
}

bool brume_fog_is_good(const struct brume_fog *fog)
{
    if ((fog->falloff != 0 && fog->falloff < 0x10000u) || fog->far < 0x10000u ||
        fog->far > MOST_FAR || fog->shape_count > BRUME_MAX_FOG_SHAPES ||
        (fog->shape_count > 0 && fog->shapes == NULL))
        return false;
    for (uint32_t i = 0; i < fog->shape_count; i++)
        if (!shape_is_good(&fog->shapes[i]))
            return false;
    return true;
}

/// Frame ///

/* Of a shape: what a way from its centre is of half its side, and what falls to
 * 0 within the softness s: 1 / (1 - (1 - s)^2) of 1 - way^2. */
static void set_shape(struct brume_lit_fog *fog, uint32_t i,
                      const struct brume_fog_shape *s)
{
    /* 1 where anything is left, for a hard edge */
    static const struct brume_number k_hard = {0x80000000u, 31};
    for (int axis = 0; axis < 3; axis++) {
        uint32_t half = s->half[s->kind == BRUME_FOG_BOX ? axis : 0];
        uint32_t shift = leading_zeros(half);
        fog->shape[i].shift[axis] = (uint8_t)shift;
        fog->shape[i].per_half[axis] = brume_reciprocal(half << shift);
    }
    fog->shape[i].edge = k_hard;
    if (s->softness == 0)
        return;
    struct brume_number edge = brume_number_inverse(
        brume_number_mul(brume_number_of(s->softness, -16),
                         brume_number_of(0x20000u - s->softness, -16)));
    edge.e += 2; /* Q30 to Q32 */
    fog->shape[i].edge = edge;
}

/* What fog by height does to the sun's light: its extinction where it is,
 * times a way. */
static void set_ways(struct brume_frame *f, const struct brume_fog *fog)
{
    struct brume_lit_fog *out = &f->lit.fog;
    int32_t rise = brume_dot(f->sun, f->lit.zenith);
    out->way = out->most_way = fog->far;
    out->per_rise = brume_number_of(0, 0);
    if (fog->falloff == 0 || rise <= 0)
        return;
    struct brume_number per_rise =
        brume_number_inverse(brume_number_of((uint32_t)rise, -30));
    uint32_t way = brume_number_floor(
        brume_number_mul(brume_number_of(fog->falloff, -16), per_rise), 16);
    out->way = way < fog->far ? way : fog->far;
    out->per_rise = per_rise;
    out->per_rise.e += 2;
}

/* The base along zenith, Q17.14, of positions that carry the frame's bias. */
static int32_t base_of(const struct brume_frame *f, const struct brume_scene *s)
{
    int32_t base = s->lighting->fog->base / 4;
    for (int i = 0; i < 3; i++)
        base +=
            mul_both_signed_round(f->lit.zenith[i], f->eye[i] - s->eye[i], 0);
    return base;
}

void brume_fog_begin(struct brume_frame *frame, const struct brume_scene *scene)
{
    /* 4 log2(e): octaves in Q16 of nats in Q14 */
    static const struct brume_number k_octaves = {0xb8aa3b29u, -29};
    struct brume_frame *f = frame;
    const struct brume_fog *fog = scene->lighting->fog;
    struct brume_lit_fog *out = &f->lit.fog;
    uint32_t zeros = leading_zeros(scene->step);
    out->on = true;
    out->step = scene->step << zeros;
    out->step_log2 = (int8_t)(16 - (int32_t)zeros);
    out->density = fog->density;
    out->base = base_of(f, scene);
    out->per_falloff = brume_number_of(0, 0);
    if (fog->falloff != 0)
        out->per_falloff = brume_number_mul(
            k_octaves,
            brume_number_inverse(brume_number_of(fog->falloff, -16)));
    set_ways(f, fog);
    for (int i = 0; i < 3; i++) {
        uint32_t speed = magnitude(f->sun[i]);
        out->pace[i] = brume_number_of(0, 0);
        if (speed != 0)
            out->pace[i] = brume_number_inverse(brume_number_of(speed, -30));
    }
    out->per_light_step =
        brume_number_inverse(brume_number_of(scene->light_step, 0));
    out->light_samples = scene->light_samples;
    out->shape_count = fog->shape_count;
    for (uint32_t i = 0; i < fog->shape_count; i++)
        set_shape(out, i, &fog->shapes[i]);
}

/// Sameness ///

static uint32_t mixed(uint32_t h, uint32_t word)
{
    return (h ^ word) * 16777619u;
}

uint32_t brume_fog_sameness(const struct brume_frame *frame)
{
    const struct brume_fog *fog = frame->lit.lighting->fog;
    uint32_t h = mixed(mixed(fog->density, (uint32_t)fog->base), fog->falloff);
    h = mixed(mixed(h, fog->far), fog->shape_count);
    for (uint32_t n = 0; n < fog->shape_count; n++) {
        const struct brume_fog_shape *s = &fog->shapes[n];
        h = mixed(mixed(mixed(h, s->kind), s->softness), s->density);
        for (int i = 0; i < 3; i++)
            h = mixed(mixed(h, (uint32_t)s->centre[i]), s->half[i]);
    }
    return h;
}

#endif
