/* SPDX-License-Identifier: MIT */
/*
 * Densities in lanes, from the asset or from its copies; and the cells to leap
 * from.
 */
#ifndef BRUME_HOST_WIDE_LOOKUP_H
#define BRUME_HOST_WIDE_LOOKUP_H

#include "wide_copied.h"

/* What lookups read: the asset, or its copies when there are such. */
struct source {
    const struct brume_frame *frame;
    const struct wide_copy *copy;
    struct copied copied;
    bool stochastic; /* lookups are moved: see want_moved */
};

/* `lit`: may lookups be stochastic? */
LANES_INLINE struct source source_of(const struct brume_frame *f,
                                     const struct wide_copy *c, bool lit,
                                     struct kernel k)
{
    struct source s;
    s.frame = f;
    s.copy = c;
    s.stochastic = lit && !k.trilinear && f->lit.stochastic;
    if (c != NULL)
        s.copied = copied_of(f, c, k);
    return s;
}

/* Wants the density at p in group g; 0 where not wanted. */
LANES_INLINE void want(struct lookups *l, uint32_t g, const struct source *s,
                       const lanes p[3], lanes_mask wanted, struct kernel k)
{
    if (s->copy != NULL)
        want_copied(l, g, &s->copied, p[0], p[1], p[2], wanted, k);
    else
        want_cell(l, g, s->frame, p[0], p[1], p[2], wanted, k);
}

/* The same beside p, where stochastic lookups look. The cells that are looked
 * up then are not those to leap from. */
LANES_INLINE void want_moved(struct lookups *l, uint32_t g,
                             const struct source *s, const lanes p[3],
                             const lanes moved[3], lanes_mask wanted,
                             struct kernel k)
{
    lanes at[3];
    for (int i = 0; i < 3; i++)
        at[i] = p[i] + moved[i];
    want(l, g, s, at, wanted, k);
}

/* Densities of the first n groups. */
LANES_INLINE void look_up(struct lookups *l, uint32_t n, const struct source *s,
                          struct kernel k)
{
    if (s->copy != NULL) {
        FORGET(l->at);
        l->apart_count = 0;
        for (uint32_t g = 0; g < n; g++)
            lanes_store(l->d[g], density_copied(l, g, &s->copied, k));
        if (sets_apart(k))
            copied_apart(l, &s->copied, k);
    } else if (k.trilinear) {
        look_up_trilinear(l, n, s->frame, k);
    } else {
        look_up_nearest(l, n, s->frame, k);
    }
}

/* After look_up: the words of group g's cells. The high bit is set where they
 * are empty and may be leapt over; copies know only of lanes with a density of
 * 0, the others have 0. */
LANES_INLINE lanes cells_to_leap(const struct lookups *l, uint32_t g,
                                 const struct source *s, const lanes p[3],
                                 lanes_mask wanted, struct kernel k)
{
    const struct brume_frame *f = s->frame;
    if (s->copy == NULL && !s->stochastic)
        return lanes_load(l->cell[g]);
    wanted = mask_and(wanted, mask_equal(lanes_load(l->d[g]), lanes_of(0)));
    if (!f->skip || !mask_any(wanted))
        return lanes_of(0);
    lanes at = lanes_where(wanted, cell_number(f->volume, p[0], p[1], p[2]));
    lanes cell = gather_words(f->volume->cells, at);
    if ((k.trilinear || s->stochastic) &&
        f->leap_margin != 0) /* beside a brick: not here */
        wanted = mask_less_those(
            wanted, mask_and(on_high_faces(p[0], p[1], p[2]),
                             mask_less(cell, lanes_of(BRUME_CELL_EMPTY + 2u))));
    return lanes_where(wanted, cell);
}

#endif
