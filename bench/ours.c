/* SPDX-License-Identifier: MIT */
#include "ours.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "scene_file.h"
#include "tile_order.h"

#define STRIP 16u /* rows */
#define MAX_THREADS 64

/// Kernels ///

bool ours_kernel(const char *name, enum wide_kernel *kernel, bool *copy)
{
    char plain[32];
    size_t n = strcspn(name, "-");
    if (n >= sizeof plain)
        return false;
    memcpy(plain, name, n);
    plain[n] = '\0';
    *copy = strcmp(name + n, "-copy") == 0;
    return (name[n] == '\0' || *copy) && wide_by_name(plain, kernel) &&
           wide_has(*kernel) && !(*copy && *kernel == WIDE_SCALAR);
}

int ours_frame(struct brume_frame *frame, const struct volume_file *file,
               const char *const *settings, size_t n, char *err,
               size_t err_size)
{
    struct scene_settings *said = calloc(1, sizeof *said);
    struct brume_scene scene;
    int failed = said == NULL;
    for (size_t i = 0; i < n && !failed; i++)
        failed = scene_set(said, settings[i], "contender", err, err_size);
    if (!failed)
        failed = scene_apply(said, file, &scene, NULL, err, err_size);
    free(said);
    if (failed)
        return -1;
    int error = brume_begin_frame(frame, &file->volume, &scene);
    if (error == BRUME_OK)
        return 0;
    strncpy(err, brume_error_text(error), err_size - 1);
    return -1;
}

/// Tiles ///

static uint32_t morton(uint32_t x, uint32_t y)
{
    uint32_t key = 0;
    for (unsigned bit = 0; bit < 16; bit++)
        key |= (x >> bit & 1u) << (2 * bit) | (y >> bit & 1u) << (2 * bit + 1);
    return key;
}

/* Which tiles, in which order; how many. */
static unsigned list_tiles(const struct ours_job *job, struct tile_place **list)
{
    unsigned w = job->tile_width, h = job->tile_height, n = 0;
    unsigned across = (job->frame->width + w - 1) / w;
    unsigned down = (job->frame->height + h - 1) / h;
    *list = malloc(sizeof **list * across * down);
    for (unsigned y = 0; *list && y < down; y++) {
        if (job->part > 1 && y * h / STRIP % job->part != job->part / 2)
            continue;
        for (unsigned x = 0; x < across; x++) {
            struct tile_place tile = {n, (uint16_t)x, (uint16_t)y};
            if (job->order != OURS_LINEAR)
                tile.key = job->order == OURS_MORTON ? morton(x, y)
                                                     : tile_order_hilbert(x, y);
            (*list)[n++] = tile;
        }
    }
    if (job->order != OURS_LINEAR)
        tile_order_sort(*list, n);
    return n;
}

/// Rendering ///

struct work {
    const struct ours_job *job;
    const struct tile_place *tiles;
    unsigned count;
    atomic_uint next;
};

static void render_tile(const struct ours_job *job,
                        const struct tile_place *tile)
{
    const struct brume_frame *f = job->frame;
    unsigned x = tile->x * job->tile_width, y = tile->y * job->tile_height;
    unsigned w = f->width - x, h = f->height - y;
    struct brume_radiance *out = job->out + (size_t)y * f->width + x;
    w = w < job->tile_width ? w : job->tile_width;
    h = h < job->tile_height ? h : job->tile_height;
    if (job->copy)
        wide_march_copy_rect(job->kernel, job->copy, f, x, y, w, h, out,
                             f->width);
    else
        wide_march_rect(job->kernel, f, x, y, w, h, out, f->width);
}

static void *work_off(void *arg)
{
    struct work *work = arg;
    unsigned i;
    while ((i = atomic_fetch_add(&work->next, 1)) < work->count)
        render_tile(work->job, &work->tiles[i]);
    return NULL;
}

void ours_render(const struct ours_job *job)
{
    struct tile_place *tiles = NULL;
    struct work work = {.job = job};
    pthread_t thread[MAX_THREADS];
    int made = 0;
    work.count = list_tiles(job, &tiles);
    work.tiles = tiles;
    atomic_init(&work.next, 0);
    while (made < job->threads - 1 && made < MAX_THREADS &&
           pthread_create(&thread[made], NULL, work_off, &work) == 0)
        made++;
    work_off(&work);
    while (made > 0)
        pthread_join(thread[--made], NULL);
    free(tiles);
}
