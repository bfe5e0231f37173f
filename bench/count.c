/* SPDX-License-Identifier: MIT */
/*
 * The core's march once more, with its counters on: what one frame looks up.
 * Under names of its own, beside the march that is timed.
 */
#include <stdint.h>

static uint64_t tally_rays_in_pool, tally_view_samples, tally_lit_samples,
    tally_light_samples;
#define BRUME_TALLY(name, n) (tally_##name += (n))
#include "brume_lookup.h"

#include "ours.h"

/* density_at, and whether there was a brick to look into; and where, when
 * somebody wants to know. */
static uint64_t in_bricks;
static struct ours_places *wanted;

BRUME_INLINE bool counted(const struct brume_frame *f, uint32_t x, uint32_t y,
                          uint32_t z, uint32_t *d, struct kernel k)
{
    bool found = density_at(f, x, y, z, d, k);
    in_bricks += found;
    if (wanted && wanted->axis[0]) {
        const uint32_t p[3] = {x, y, z};
        for (int i = 0; i < 3; i++)
            wanted->axis[i][wanted->count] = p[i];
        wanted->count++;
    } else if (wanted) {
        const uint16_t *n = f->volume->cell_count;
        uint32_t cell = ((z >> 19) * n[1] + (y >> 19)) * n[0] + (x >> 19);
        wanted->place[wanted->count++] = cell << 9 | voxel_of(x, y, z, k);
    }
    return found;
}

#define find_density counted
#define brume_depth_of count_depth_of
#define brume_march_begin count_march_begin
#define brume_march_span count_march_span
#define brume_mean_depth count_mean_depth
#include "brume_march.c" /* by -Icore */

#define STRIP 16u

static void count_row(const struct brume_frame *f, unsigned y)
{
    struct brume_radiance out[BRUME_SPAN];
    for (unsigned x = 0; x < f->width; x += BRUME_SPAN) {
        unsigned n = f->width - x;
        count_march_span(f, x, y, n < BRUME_SPAN ? n : BRUME_SPAN, out);
    }
}

static void count_rows(const struct ours_job *job)
{
    for (unsigned y = 0; y < job->frame->height; y++)
        if (y / STRIP % job->part == job->part / 2)
            count_row(job->frame, y);
}

void ours_count(const struct ours_job *job, struct lookup_count *count)
{
    tally_rays_in_pool = tally_view_samples = 0;
    tally_lit_samples = tally_light_samples = in_bricks = 0;
    count_rows(job);
    count->rays = tally_rays_in_pool;
    count->view = tally_view_samples;
    count->lit = tally_lit_samples;
    count->light = tally_light_samples;
    count->in_bricks = in_bricks;
}

void ours_record(const struct ours_job *job, struct ours_places *places)
{
    places->count = 0;
    wanted = places;
    count_rows(job);
    wanted = NULL;
}
