/* SPDX-License-Identifier: MIT */
/*
 * The committed tables tile: neighbours across the seam, where a table ends and
 * begins again, differ as much as neighbours within. Those of blue noise, over
 * space or time, differ more than chance; a piece cut out of a table shows that
 * the test would see a seam.
 */
#include <math.h>
#include <stdlib.h>

#include "brume_inner.h"
#include "brume_noise_tables.h"
#include "tap.h"

enum axis { AXIS_X, AXIS_Y, AXIS_TIME };

static const char *const k_axis[] = {"x", "y", "time"};

struct box {
    const struct brume_noise_table *table;
    uint32_t size[3]; /* of the piece to take: all of it, or less */
};

static int value(const struct box *b, const uint32_t at[3])
{
    return (int)(brume_noise_value(BRUME_NOISE_TABLE, b->table, at[0], at[1],
                                   at[2], 0) >>
                 8);
}

/* Mean |difference| of the neighbours on both sides of boundary `where`. */
static double step_at(const struct box *b, enum axis axis, uint32_t where)
{
    uint32_t j = (axis + 1u) % 3, k = (axis + 2u) % 3;
    uint32_t here[3], there[3];
    double sum = 0;
    for (uint32_t p = 0; p < b->size[j] * b->size[k]; p++) {
        here[axis] = where;
        there[axis] = (where + 1) % b->size[axis];
        here[j] = there[j] = p % b->size[j];
        here[k] = there[k] = p / b->size[j];
        sum += abs(value(b, here) - value(b, there));
    }
    return sum / (b->size[j] * b->size[k]);
}

/* How far the seam is from the mean of the other boundaries, in their standard
 * deviations. */
static double seam(const struct box *b, enum axis axis)
{
    uint32_t n = b->size[axis] - 1;
    double sum = 0, square = 0;
    for (uint32_t i = 0; i < n; i++) {
        double step = step_at(b, axis, i);
        sum += step;
        square += step * step;
    }
    double mean = sum / n, deviation = sqrt(square / n - mean * mean);
    return fabs(step_at(b, axis, n) - mean) / deviation;
}

static struct box whole(const struct brume_noise_table *t)
{
    struct box b = {
        t, {1u << t->width_log2, 1u << t->height_log2, 1u << t->frames_log2}};
    return b;
}

static void check_tiles(const char *name, const struct brume_noise_table *t)
{
    struct box b = whole(t);
    for (int axis = AXIS_X; axis <= AXIS_TIME; axis++) {
        if (b.size[axis] == 1)
            continue;
        double far = seam(&b, (enum axis)axis);
        tap_check(far < 4, "%s: no seam in %s (%.1f deviations)", name,
                  k_axis[axis], far);
    }
}

/* 7/8 of a table, which does not tile. */
static void check_piece(void)
{
    for (int axis = AXIS_X; axis <= AXIS_TIME; axis++) {
        struct box b = whole(&brume_noise_fast);
        b.size[axis] -= b.size[axis] / 8;
        double far = seam(&b, (enum axis)axis);
        tap_check(far > 8, "a piece of fast: a seam in %s (%.1f deviations)",
                  k_axis[axis], far);
    }
}

int main(void)
{
    check_tiles("fast", &brume_noise_fast);
    check_tiles("fast_small", &brume_noise_fast_small);
    check_tiles("fast_tiny", &brume_noise_fast_tiny);
    check_tiles("stbn", &brume_noise_stbn);
    check_tiles("stbn_small", &brume_noise_stbn_small);
    check_tiles("stbn_tiny", &brume_noise_stbn_tiny);
    check_tiles("blue", &brume_noise_blue);
    check_tiles("blue_slices", &brume_noise_blue_slices);
    check_piece();
    return tap_done();
}
