/* SPDX-License-Identifier: MIT */
/*
 * Lighting at random, of every kind that a volume has the sections for: for
 * tests that compare two ways to the same bytes.
 */
#ifndef BRUME_TESTS_RANDOM_LIGHT_H
#define BRUME_TESTS_RANDOM_LIGHT_H

#include "brume.h"

/* Gives the scene lighting, and perhaps light and a filter that need it, drawn
 * by `below`: 0 .. n - 1. It lives until the next call. */
void random_light_fill(struct brume_scene *out,
                       const struct brume_volume *volume,
                       uint32_t (*below)(uint32_t n));

#endif
