/* SPDX-License-Identifier: MIT */
/* Light from lamps at a sample of a lit march. For brume_lit.c. */
#ifndef BRUME_LAMP_LIGHT_H
#define BRUME_LAMP_LIGHT_H

#include "brume_lamps.h"

#if BRUME_WITH_LAMPS

/* A sample, and what it receives of lamps, Q12.20. */
struct lamp_sample {
    const struct brume_frame *frame;
    const int32_t *ray; /* its direction, Q2.30 */
    const uint32_t *p;
    const struct kernel *kernel;
    uint32_t jitter; /* Q0.16 */
    uint32_t at[3];  /* p, brume_halved */
    uint32_t sum[3];
};

/* What is left of `fall` by spot, shadow and phase function, times 2^*up. */
static inline uint32_t lamp_rest(const struct lamp_sample *s,
                                 const struct brume_lit_lamp *l,
                                 const struct lamp_way *w, uint32_t fall,
                                 int32_t *up)
{
    const struct brume_phase *phase = s->frame->lit.lighting->phase;
    int32_t unit[3];
    uint32_t r = lamp_unit(w, unit);
    if (l->spot)
        fall = mul_hi_floor(fall, lamp_spot(l, unit));
    if (fall == 0)
        return 0;
    if (l->shadow_samples != 0)
        fall = mul_hi_floor(fall, lamp_through(s->frame, l, w, r, s->jitter,
                                               s->p, s->kernel))
               << 2;
    if (phase != NULL && (unit[0] | unit[1] | unit[2]) != 0) {
        struct brume_number n =
            brume_phase_value(phase, brume_one_minus_cos(s->ray, unit));
        fall = mul_hi_floor(fall, n.m);
        *up = n.e + 32;
    }
    return fall;
}

/* Adds a lamp within whose radius the sample is: any lamp, at any distance. */
BRUME_APART void add_any_lamp(struct lamp_sample *s,
                              const struct brume_lit_lamp *l)
{
    struct lamp_way w;
    uint64_t square = lamp_square(w.d, l, s->at);
    uint32_t high = (uint32_t)(square >> 32), low = (uint32_t)square | 1u;
    w.zeros = high != 0 ? leading_zeros(high) : 32u + leading_zeros(low);
    w.square = high != 0 ? high << w.zeros | low >> 1 >> (31u - w.zeros)
                         : low << (w.zeros - 32u);
    uint32_t fall = 0xffffffffu;
    int32_t up = 0;
    if (w.zeros - l->radius_shift < 32)
        fall = lamp_window(l, w.square, w.zeros);
    bool far = l->size_shift > w.zeros + 32u;
    fall = far ? 0 : mul_hi_floor(fall, lamp_fall(l, w.square, w.zeros));
    if (l->spot || l->shadow_samples != 0 ||
        s->frame->lit.lighting->phase != NULL)
        fall = lamp_rest(s, l, &w, fall, &up);
    for (int c = 0; c < 3; c++)
        s->sum[c] = lamp_sum(s->sum[c],
                             lamp_times(mul_hi_floor(fall, l->colour[c]), up));
}

/* Adds lamps to the sample's sums: of 32 those whose bits are set. A function
 * of its own, so that the registers are its own; what it needs seldom is in
 * another. */
BRUME_INLINE void add_lamps_of(struct lamp_sample *s,
                               const struct brume_lit_lamp *lamps,
                               uint32_t bits, bool colour)
{
    const uint32_t at[3] = {s->at[0], s->at[1], s->at[2]};
    uint32_t sum[3] = {0};
    while (bits != 0) {
        uint32_t i = leading_zeros(bits);
        const struct brume_lit_lamp *l = lamps + i;
        int32_t d[3];
        bits -= 0x80000000u >> i;
        BRUME_OPAQUE(l); /* else each field's address is worked out */
        uint64_t square = lamp_square(d, l, at);
        if (square >= l->radius_square)
            continue;
        uint32_t high = (uint32_t)(square >> 32), low = (uint32_t)square;
        if (high == 0 || !l->plain) { /* two voxels, or more to do */
            add_any_lamp(s, l);
            continue;
        }
        uint32_t zeros = leading_zeros(high);
        high = high << zeros | low >> 1 >> (31u - zeros);
        uint32_t fall = mul_hi_floor(lamp_window(l, high, zeros),
                                     lamp_fall(l, high, zeros));
        sum[0] = lamp_sum(sum[0], mul_hi_floor(fall, l->colour[0]));
        if (colour) {
            sum[1] = lamp_sum(sum[1], mul_hi_floor(fall, l->colour[1]));
            sum[2] = lamp_sum(sum[2], mul_hi_floor(fall, l->colour[2]));
        }
    }
    for (int c = 0; c < (colour ? 3 : 1); c++)
        s->sum[c] = lamp_sum(s->sum[c], sum[c]);
}

BRUME_APART void add_grey_lamps(struct lamp_sample *s,
                                const struct brume_lit_lamp *lamps,
                                uint32_t bits)
{
    add_lamps_of(s, lamps, bits, false);
}

#if BRUME_WITH_COLOUR
BRUME_APART void add_coloured_lamps(struct lamp_sample *s,
                                    const struct brume_lit_lamp *lamps,
                                    uint32_t bits)
{
    add_lamps_of(s, lamps, bits, true);
}
#else
#define add_coloured_lamps add_grey_lamps
#endif

/* The lamps' light at a sample, which scatters `lost` of it, Q1.31. */
BRUME_APART void add_lamps(const struct brume_frame *f, struct gathered *g,
                           const struct brume_ray *ray, const uint32_t p[3],
                           uint32_t lost, const struct kernel *k)
{
    const struct brume_lit_lamp *lamps = f->lit.clusters->lamp;
    const uint32_t *words = lamps_near(f, ray, p);
    struct lamp_sample s = {f, ray->unit, p, k, lamp_jitter(f, ray), {0}, {0}};
    for (int i = 0; i < 3; i++)
        s.at[i] = brume_halved(p[i]);
    for (uint32_t n = 0; n < BRUME_LAMP_WORDS; n++) {
        if (brume_has_colour(f))
            add_coloured_lamps(&s, lamps + 32u * n, words[n]);
        else
            add_grey_lamps(&s, lamps + 32u * n, words[n]);
    }
    for (int i = 0; i < 3; i++) {
        /* Q31 * Q20 -> Q29 */
        uint32_t high = mul_hi_floor(lost, s.sum[i]), low = lost * s.sum[i];
        uint32_t a = high >> 22 ? 0xffffffffu : high << 10 | low >> 22;
        g->lamp[i] = lamp_sum(g->lamp[i], a);
    }
}

#endif

#endif
