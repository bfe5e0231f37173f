/* SPDX-License-Identifier: MIT */
#include "render.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tile_order.h"

/* Rays of a task that marches: few enough to share out and to look up the same
 * bricks, many enough for a kernel of 16 lanes. */
#define TILE_WIDTH 16
#define TILE_HEIGHT 16
/* Rays of a task that reprojects. */
#define RESOLVE_WIDTH 64
#define RESOLVE_HEIGHT 16
/* Pixels of a task that filters, which reads up to 7 more on each side. */
#define SHOW_WIDTH 256
#define SHOW_HEIGHT 64

/* Of one thread. */
struct scratch {
    struct brume_radiance rays[TILE_WIDTH * TILE_HEIGHT];
    struct profile profile;
    struct brume_frame frame; /* with one pixel's background */
    void *work;               /* of brume_show_rect */
    size_t work_size;
};

struct renderer {
    struct pool *pool;
    enum wide_kernel kernel;
    struct profile *profile;
    const struct brume_volume *volume;
    struct wide_copy copy; /* of it, for wide kernels */
    struct brume_frame frame;
    struct brume_state *state;
    size_t state_size;
    struct scratch *scratch;  /* one for each thread */
    int32_t anchor[3];        /* of the pool, voxels */
    struct tile_place *order; /* of tiles that march, or NULL: row by row */
    unsigned order_size[2];   /* tiles across and down that it is for */

    unsigned bar_frames, bar_frame; /* of the progress bar: all, done */
    unsigned bar_tiles, bar_shown;
    atomic_uint bar_done; /* tiles of this frame */
};

/* A pass over `size` in tiles. */
struct sweep {
    struct renderer *renderer;
    const struct brume_frame *frame;
    const struct render_target *target;
    unsigned size[2], tile[2], across;
    const struct tile_place *order; /* or NULL: row by row */
    bool plain;                     /* rays go straight to pixels */
    atomic_int error;               /* the first one */
};

struct tile {
    unsigned x, y, w, h;
};

/// Progress ///

static void show_bar(struct renderer *r)
{
    unsigned done = atomic_fetch_add(&r->bar_done, 1) + 1;
    if (r->bar_frames == 0)
        return;
    double part = (r->bar_frame + (double)done / r->bar_tiles) / r->bar_frames;
    unsigned percent = (unsigned)(part * 100);
    bool end = done == r->bar_tiles && r->bar_frame + 1 >= r->bar_frames;
    if (percent == r->bar_shown && !end)
        return;
    r->bar_shown = percent;
    if (end)
        fputs("\r\033[K", stderr);
    else if (r->bar_frames > 1)
        fprintf(stderr, "\rrendering [%-25.*s] %3u %%  frame %u of %u",
                (int)percent / 4, "#########################", percent,
                r->bar_frame + 1, r->bar_frames);
    else
        fprintf(stderr, "\rrendering [%-25.*s] %3u %%", (int)percent / 4,
                "#########################", percent);
}

void renderer_progress(struct renderer *renderer, unsigned frames)
{
    renderer->bar_frames = frames;
    renderer->bar_frame = 0;
    renderer->bar_shown = 101;
}

void renderer_hush(struct renderer *renderer)
{
    if (renderer->bar_frames > 0)
        fputs("\r\033[K", stderr);
    renderer->bar_frames = 0;
}

/// Tiles ///

static unsigned min_unsigned(unsigned a, unsigned b)
{
    return a < b ? a : b;
}

static struct tile tile_at(const struct sweep *s, unsigned number)
{
    struct tile t = {number % s->across, number / s->across, 0, 0};
    if (s->order != NULL) {
        t.x = s->order[number].x;
        t.y = s->order[number].y;
    }
    t.x *= s->tile[0];
    t.y *= s->tile[1];
    t.w = min_unsigned(s->size[0] - t.x, s->tile[0]);
    t.h = min_unsigned(s->size[1] - t.y, s->tile[1]);
    return t;
}

/* Tiles begin at multiples of 8 pixels, so at whole bytes. */
static uint8_t *pixel_at(const struct render_target *target, unsigned x,
                         unsigned y)
{
    return (uint8_t *)target->dst + y * target->stride +
           brume_row_bytes(target->pixel_format, x);
}

static void note(struct sweep *s, int error)
{
    int none = BRUME_OK;
    if (error)
        atomic_compare_exchange_strong(&s->error, &none, error);
}

/* Thread time is read only for a profile. */
static struct profile *profile_of(struct renderer *r, unsigned worker,
                                  double *now)
{
    if (r->profile == NULL)
        return NULL;
    *now = profile_now();
    return &r->scratch[worker].profile;
}

/* How many pixels from (x, y) on, at most n, have the same behind them, which
 * becomes the frame's background. */
static unsigned set_behind(const struct sweep *s, struct brume_frame *frame,
                           unsigned x, unsigned y, unsigned n)
{
    const uint32_t(*over)[3] = s->target->over + (size_t)y * frame->width + x;
    unsigned same = 1;
    while (same < n && memcmp(over[0], over[same], sizeof *over) == 0)
        same++;
    for (int c = 0; c < 3; c++) /* without lighting 1 is the most */
        frame->background[c] =
            frame->lit.on ? over[0][c] : min_unsigned(over[0][c], 0x10000u);
    return same;
}

/* Rays to pixels. */
static void pack(struct sweep *s, unsigned worker, const struct tile *t)
{
    struct scratch *b = &s->renderer->scratch[worker];
    const struct render_target *to = s->target;
    if (to->over == NULL) {
        note(s, brume_pack_rect(s->frame, b->rays, TILE_WIDTH, t->x, t->y, t->w,
                                t->h, to->pixel_format,
                                pixel_at(to, t->x, t->y), to->stride));
        return;
    }
    b->frame = *s->frame;
    for (unsigned y = 0; y < t->h; y++)
        for (unsigned x = 0, n; x < t->w; x += n) {
            n = set_behind(s, &b->frame, t->x + x, t->y + y, t->w - x);
            note(s, brume_pack_rect(
                        &b->frame, b->rays + y * TILE_WIDTH + x, TILE_WIDTH,
                        t->x + x, t->y + y, n, 1, to->pixel_format,
                        pixel_at(to, t->x + x, t->y + y), to->stride));
        }
}

static void march_tile(void *arg, unsigned task, unsigned worker)
{
    struct sweep *s = arg;
    struct renderer *r = s->renderer;
    struct brume_radiance *rays = r->scratch[worker].rays;
    struct tile t = tile_at(s, task);
    double now = 0;
    struct profile *p = profile_of(r, worker, &now);
    note(s, wide_march_copy_rect(r->kernel, &r->copy, s->frame, t.x, t.y, t.w,
                                 t.h, rays, TILE_WIDTH));
    now = profile_add(p, PASS_MARCH, now);
    if (s->plain)
        pack(s, worker, &t);
    else
        note(s, brume_store_rect(s->frame, r->state, t.x, t.y, t.w, t.h, rays,
                                 TILE_WIDTH));
    profile_add(p, s->plain ? PASS_PACK : PASS_STORE, now);
    show_bar(r);
}

static void resolve_tile(void *arg, unsigned task, unsigned worker)
{
    struct sweep *s = arg;
    struct tile t = tile_at(s, task);
    double now = 0;
    struct profile *p = profile_of(s->renderer, worker, &now);
    note(s,
         brume_resolve_rect(s->frame, s->renderer->state, t.x, t.y, t.w, t.h));
    profile_add(p, PASS_RESOLVE, now);
}

/* The state to pixels. */
static void show(struct sweep *s, unsigned worker, const struct tile *t)
{
    struct scratch *b = &s->renderer->scratch[worker];
    const struct brume_state *state = s->renderer->state;
    const struct render_target *to = s->target;
    if (to->over == NULL) {
        note(s, brume_show_rect(s->frame, state, t->x, t->y, t->w, t->h,
                                to->pixel_format, pixel_at(to, t->x, t->y),
                                to->stride, b->work, b->work_size));
        return;
    }
    b->frame = *s->frame;
    for (unsigned y = t->y; y < t->y + t->h; y++)
        for (unsigned x = t->x, n; x < t->x + t->w; x += n) {
            n = set_behind(s, &b->frame, x, y, t->x + t->w - x);
            note(s, brume_show_rect(&b->frame, state, x, y, n, 1,
                                    to->pixel_format, pixel_at(to, x, y),
                                    to->stride, b->work, b->work_size));
        }
}

static void show_tile(void *arg, unsigned task, unsigned worker)
{
    struct sweep *s = arg;
    struct tile t = tile_at(s, task);
    double now = 0;
    struct profile *p = profile_of(s->renderer, worker, &now);
    show(s, worker, &t);
    profile_add(p, PASS_SHOW, now);
}

/* Makes the order of that many tiles, unless it is there. */
static const struct tile_place *order_of(struct renderer *r, unsigned across,
                                         unsigned down)
{
    if (r->order == NULL || r->order_size[0] != across ||
        r->order_size[1] != down) {
        free(r->order);
        r->order = tile_order_new(across, down);
        r->order_size[0] = across;
        r->order_size[1] = down;
    }
    return r->order;
}

static void sweep_over(struct sweep *s, const unsigned size[2],
                       const unsigned tile[2], pool_task *task)
{
    struct renderer *r = s->renderer;
    for (int i = 0; i < 2; i++) {
        s->size[i] = size[i];
        s->tile[i] = tile[i];
    }
    s->across = (size[0] + tile[0] - 1) / tile[0];
    unsigned down = (size[1] + tile[1] - 1) / tile[1];
    s->order = NULL;
    if (task == march_tile) {
        s->order = order_of(r, s->across, down);
        r->bar_tiles = s->across * down;
        atomic_store(&r->bar_done, 0);
    }
    pool_run(r->pool, task, s, s->across * down);
}

/* What the wide kernels read for a frame. */
static void copy_volume(struct renderer *r, const struct brume_frame *f)
{
    double now = r->profile != NULL ? profile_process() : 0;
    wide_copy_prepare(&r->copy, f, r->pool);
    profile_add_process(r->profile, PASS_COPY, now);
}

/// Memory ///

struct renderer *renderer_new(int threads, enum wide_kernel kernel)
{
    struct renderer *r = calloc(1, sizeof *r);
    if (r == NULL)
        return NULL;
    r->kernel = kernel;
    r->pool = pool_new(threads);
    r->scratch = calloc(pool_threads(r->pool), sizeof *r->scratch);
    if (r->pool != NULL && r->scratch != NULL)
        return r;
    renderer_free(r);
    return NULL;
}

void renderer_free(struct renderer *renderer)
{
    if (renderer == NULL)
        return;
    for (unsigned i = 0; renderer->scratch && i < pool_threads(renderer->pool);
         i++)
        free(renderer->scratch[i].work);
    pool_free(renderer->pool);
    wide_copy_free(&renderer->copy);
    free(renderer->order);
    free(renderer->scratch);
    free(renderer->state);
    free(renderer);
}

struct pool *renderer_pool(struct renderer *renderer)
{
    return renderer->pool;
}

void renderer_profile(struct renderer *renderer, struct profile *profile)
{
    renderer->profile = profile;
}

void renderer_volume(struct renderer *renderer,
                     const struct brume_volume *volume)
{
    wide_copy_free(&renderer->copy);
    wide_copy_init(&renderer->copy, volume,
                   renderer->kernel == WIDE_SCALAR ? 0 : WIDE_COPY_MOST);
    renderer->volume = volume;
}

void renderer_anchor(struct renderer *renderer, const int32_t voxels[3])
{
    memcpy(renderer->anchor, voxels, sizeof renderer->anchor);
}

/* The eye that reprojection remembers, from the fixed place. History is
 * dropped when that is too far for Q16.16. */
static void move_to_anchor(struct renderer *r)
{
    struct brume_frame *f = &r->frame;
    for (int i = 0; i < 3; i++) {
        int64_t eye = (int64_t)r->anchor[i] * 65536 + f->view.eye[i];
        if (eye < INT32_MIN || eye > INT32_MAX)
            f->cut = true;
        else
            f->view.eye[i] = (int32_t)eye;
    }
}

/* A state that is too small is begun anew: its layout changes anyway. */
static bool has_state(struct renderer *r, const struct brume_scene *scene)
{
    size_t size = brume_state_bytes(scene);
    if (size <= r->state_size)
        return r->state != NULL;
    free(r->state);
    r->state_size = 0;
    r->state = malloc(size);
    if (r->state == NULL || brume_state_init(r->state, size) != BRUME_OK)
        return false;
    r->state_size = size;
    return true;
}

static bool has_work(struct renderer *r)
{
    size_t size =
        brume_work_bytes(&r->frame, min_unsigned(r->frame.width, SHOW_WIDTH));
    for (unsigned i = 0; i < pool_threads(r->pool); i++) {
        struct scratch *b = &r->scratch[i];
        if (b->work_size >= size)
            continue;
        free(b->work);
        b->work = malloc(size);
        b->work_size = b->work == NULL ? 0 : size;
        if (b->work == NULL)
            return false;
    }
    return true;
}

/// Frames ///

static const unsigned k_tile[2] = {TILE_WIDTH, TILE_HEIGHT};
static const unsigned k_resolve[2] = {RESOLVE_WIDTH, RESOLVE_HEIGHT};
static const unsigned k_show[2] = {SHOW_WIDTH, SHOW_HEIGHT};

/* Does a frame need rays alone? */
static bool is_plain(const struct brume_scene *s)
{
    return s->temporal == BRUME_TEMPORAL_NONE &&
           s->spatial == BRUME_SPATIAL_NONE && s->resolution == BRUME_FULL &&
           s->update == BRUME_UPDATE_ALL;
}

/* The passes of a frame that has begun; its error. */
static int draw_passes(struct renderer *r, const struct brume_frame *frame,
                       bool plain, bool resolve,
                       const struct render_target *target)
{
    struct sweep s = {
        .renderer = r, .frame = frame, .target = target, .plain = plain};
    const unsigned lattice[2] = {frame->lattice[0], frame->lattice[1]};
    const unsigned grid[2] = {frame->grid[0], frame->grid[1]};
    const unsigned image[2] = {frame->width, frame->height};
    atomic_init(&s.error, BRUME_OK);
    sweep_over(&s, lattice, k_tile, march_tile);
    if (resolve)
        sweep_over(&s, grid, k_resolve, resolve_tile);
    if (!plain)
        sweep_over(&s, image, k_show, show_tile);
    r->bar_frame++;
    return atomic_load(&s.error);
}

static void collect(struct renderer *r)
{
    static const struct profile k_zero;
    for (unsigned i = 0; r->profile && i < pool_threads(r->pool); i++) {
        profile_sum(r->profile, &r->scratch[i].profile);
        r->scratch[i].profile = k_zero;
    }
}

static int no_memory(char *err, size_t err_size)
{
    snprintf(err, err_size, "not enough memory for the frame's state");
    return -1;
}

int renderer_draw(struct renderer *renderer, const struct brume_scene *scene,
                  const struct render_target *target, char *err,
                  size_t err_size)
{
    struct renderer *r = renderer;
    double now = profile_now();
    bool plain = is_plain(scene), taa = scene->temporal == BRUME_TAA;
    int error = brume_begin_frame(&r->frame, r->volume, scene);
    if (!error && !plain) {
        if (!has_state(r, scene) || !has_work(r))
            return no_memory(err, err_size);
        move_to_anchor(r);
        error = brume_begin_state(r->state, &r->frame);
    }
    profile_add(r->profile, PASS_BEGIN, now);
    if (!error)
        copy_volume(r, &r->frame);
    if (!error)
        error = draw_passes(r, &r->frame, plain, taa, target);
    collect(r);
    if (error)
        snprintf(err, err_size, "%s", brume_error_text(error));
    return error ? -1 : 0;
}

/// Cache ///

/* Rows of a cache that a task computes. */
#define TASK_ROWS 32u

struct fill {
    const struct renderer *renderer;
    const struct brume_cache *cache;
    uint8_t *codes;
    const struct brume_frame *light;
    uint32_t rows;
    atomic_int error; /* the first one */
};

static void fill_rows(void *arg, unsigned task, unsigned worker)
{
    struct fill *fill = arg;
    const struct renderer *r = fill->renderer;
    uint32_t first = task * TASK_ROWS, rows = fill->rows - first;
    int none = BRUME_OK;
    (void)worker;
    int error = wide_cache_rows(r->kernel, &r->copy, fill->cache, fill->codes,
                                fill->light, first,
                                rows < TASK_ROWS ? rows : TASK_ROWS);
    if (error)
        atomic_compare_exchange_strong(&fill->error, &none, error);
}

int renderer_fill_cache(struct renderer *renderer,
                        const struct brume_cache *cache, uint8_t *codes,
                        const struct brume_frame *light)
{
    struct fill fill = {.renderer = renderer,
                        .cache = cache,
                        .codes = codes,
                        .light = light,
                        .rows = (uint32_t)cache->size[1] * cache->size[2]};
    atomic_init(&fill.error, BRUME_OK);
    copy_volume(renderer, light);
    double now = renderer->profile != NULL ? profile_process() : 0;
    pool_run(renderer->pool, fill_rows, &fill,
             (fill.rows + TASK_ROWS - 1) / TASK_ROWS);
    profile_add_process(renderer->profile, PASS_CACHE, now);
    return atomic_load(&fill.error);
}

void render_frame(const struct brume_frame *frame, int pixel_format, void *dst,
                  size_t stride, int threads, bool progress)
{
    const struct render_target target = {pixel_format, dst, stride, NULL};
    struct renderer *r = renderer_new(threads, WIDE_SCALAR);
    if (r == NULL) { /* without memory it still draws, if slowly */
        brume_render_rect(frame, 0, 0, frame->width, frame->height,
                          pixel_format, dst, stride);
        return;
    }
    renderer_volume(r, frame->volume);
    renderer_progress(r, progress);
    draw_passes(r, frame, true, false, &target);
    renderer_free(r);
}
