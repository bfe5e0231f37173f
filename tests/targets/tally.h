/* SPDX-License-Identifier: MIT */
/* A BRUME_CONFIG that counts what the march looks up. For the host only: the
 * counters are what the core itself may not have, writable statics. */
#ifndef BRUME_TARGETS_TALLY_H
#define BRUME_TARGETS_TALLY_H

#include <stdint.h>

extern uint64_t tally_view_samples, tally_lit_samples, tally_light_samples,
    tally_rays_in_pool;
#define BRUME_TALLY(name, n) (tally_##name += (n))

#endif
