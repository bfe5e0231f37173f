/* SPDX-License-Identifier: MIT */
/* Parts of brume-atlas. They return exit statuses: 0, 1 failed, 2 usage; after
 * a line on stderr. */
#ifndef BRUME_LAB_ATLAS_H
#define BRUME_LAB_ATLAS_H

#include <stddef.h>

#include "support/asset_builder.h"

/* volume NAME FORMAT OUT.brume [OUT.float] (volumes.c) */
int atlas_volume(int argc, char **argv);

/* A volume's number, and its density at a point of the pool by the nearest
 * voxel. */
int atlas_find(const char *name, size_t *i);
double atlas_density(size_t i, const double p[3]);

/* leap NAME OUT.pfm ... (leap.c) */
int atlas_leap(int argc, char **argv);

#endif
