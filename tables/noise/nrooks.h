/* SPDX-License-Identifier: MIT */
/*
 * N-rooks sets: n points on an n x n board, one in each row and column, so
 * that both projections are evenly spread. Of all such sets these have the
 * greatest least distance on the torus, and their order is progressive: each
 * point is as far as possible from those before it.
 */
#ifndef BRUME_TABLES_NROOKS_H
#define BRUME_TABLES_NROOKS_H

#include <stdint.h>
#include <stdio.h>

#define NROOKS_MAX 16

struct nrooks {
    uint8_t column[NROOKS_MAX]; /* of the point in row y */
    uint8_t order[NROOKS_MAX];  /* row of the i-th point to use */
    uint32_t distance;          /* least one, squared; 0 for n = 1 */
};

/* The set of n = 1 .. NROOKS_MAX points. */
void noise_nrooks(struct nrooks *set, uint32_t n);

/* The committed table, core/brume_nrooks.c. Line 1 says that `command` made it.
 * Returns 0, or -1 when writing failed. */
int noise_nrooks_write(FILE *out, const char *command);

#endif
