/* SPDX-License-Identifier: MIT */
#include "render.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <unistd.h>

#define TILE_WIDTH 64
#define TILE_HEIGHT 16

struct job {
    const struct brume_frame *frame;
    int pixel_format;
    uint8_t *dst;
    size_t stride;
    unsigned across, tiles;
    atomic_uint next, done;
    bool progress;
};

static void show_progress(unsigned done, unsigned tiles)
{
    unsigned percent = done * 100 / tiles;
    if (percent == (done - 1) * 100 / tiles && done != tiles)
        return;
    fprintf(stderr, "\rrendering [%-25.*s] %3u %%", (int)percent / 4,
            "#########################", percent);
    if (done == tiles)
        fputs("\r\033[K", stderr);
}

static void *work(void *arg)
{
    struct job *job = arg;
    unsigned tile, bytes = brume_pixel_bytes(job->pixel_format);
    while ((tile = atomic_fetch_add(&job->next, 1)) < job->tiles) {
        unsigned x = tile % job->across * TILE_WIDTH;
        unsigned y = tile / job->across * TILE_HEIGHT;
        unsigned w = job->frame->width - x, h = job->frame->height - y;
        brume_render_rect(job->frame, x, y, w < TILE_WIDTH ? w : TILE_WIDTH,
                          h < TILE_HEIGHT ? h : TILE_HEIGHT, job->pixel_format,
                          job->dst + y * job->stride + (size_t)x * bytes,
                          job->stride);
        unsigned done = atomic_fetch_add(&job->done, 1) + 1;
        if (job->progress)
            show_progress(done, job->tiles);
    }
    return NULL;
}

int render_processors(void)
{
    long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n < 1 ? 1 : n > 256 ? 256 : (int)n;
}

void render_frame(const struct brume_frame *frame, int pixel_format, void *dst,
                  size_t stride, int threads, bool progress)
{
    struct job job = {.frame = frame,
                      .pixel_format = pixel_format,
                      .dst = dst,
                      .stride = stride,
                      .progress = progress};
    pthread_t thread[256];
    int made = 0;
    job.across = (frame->width + TILE_WIDTH - 1u) / TILE_WIDTH;
    job.tiles = job.across * ((frame->height + TILE_HEIGHT - 1u) / TILE_HEIGHT);
    atomic_init(&job.next, 0);
    atomic_init(&job.done, 0);
    while (made < threads - 1 &&
           pthread_create(&thread[made], NULL, work, &job) == 0)
        made++;
    work(&job);
    while (made > 0)
        pthread_join(thread[--made], NULL);
}
