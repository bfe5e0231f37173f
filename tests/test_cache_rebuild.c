/* SPDX-License-Identifier: MIT */
/*
 * The sun's cache while the sun moves: codes of three suns, of which one is
 * made a few rows a frame while the picture goes from the oldest to the newer
 * one. Nothing pops, and when the sun has stopped the picture is that of a
 * cache made at once.
 */
#include <math.h>
#include <stdlib.h>

#include "support/lit.h"
#include "tap.h"

#define SIDE 24
#define RAYS (SIDE * SIDE)
#define ROUND 16 /* frames that making one set of codes takes */
#define MOVING \
    96 /* frames of a moving sun, then as many at rest as it takes \
        */
#define FRAMES (MOVING + 3 * ROUND)

static struct brume_frame frame;

/* A degree every second frame, from low in the front to high. */
static void set_sun(struct brume_scene *s, int f)
{
    int32_t half_degrees = f < MOVING ? f : MOVING;
    brume_direction(s->sun, (-30 + half_degrees / 2) * 65536,
                    (10 * 65536) + half_degrees * 32768);
}

/* Rows of a set of codes for the sun of frame f. */
static void make(const struct lit_volume *v, struct brume_scene *s,
                 struct lit_cache *m, int f, uint32_t row, uint32_t rows)
{
    struct brume_lighting light = lit_white();
    s->lighting = &light;
    s->light = BRUME_UNIFORM;
    set_sun(s, f);
    if (brume_begin_frame(&frame, &v->volume, s) != BRUME_OK ||
        brume_cache_rows(&m->cache, m->codes, &frame, row, rows) != BRUME_OK)
        abort();
}

static void draw(const struct lit_volume *v, struct brume_scene *s,
                 const struct brume_cache *cache, struct brume_radiance *out)
{
    struct brume_lighting light = lit_white();
    light.cache = cache;
    s->lighting = &light;
    s->light = BRUME_CACHE;
    lit_march(&frame, v, s, out);
}

/* Root of the mean square of what changed, and what changed most, of 1. */
struct change {
    double rms, most;
};

static struct change change_of(const struct brume_radiance *a,
                               const struct brume_radiance *b)
{
    struct change c = {0, 0};
    for (int i = 0; i < RAYS; i++) {
        double d = fabs((double)a[i].light - b[i].light) / 65536.0;
        c.rms += d * d;
        c.most = fmax(c.most, d);
    }
    c.rms = sqrt(c.rms / RAYS);
    return c;
}

enum way { AT_ONCE, BLENDED, SWAPPED, WAYS };

/* Largest change from one frame to the next, but for the first frames, of each
 * way; returns whether the last blended picture is that made at once. */
static bool film(const struct lit_volume *v, struct brume_scene *s,
                 struct change most[WAYS])
{
    static struct brume_radiance picture[WAYS][2][RAYS];
    struct lit_cache set[3], now = lit_cache_room(v, 2);
    uint32_t all = (uint32_t)now.cache.size[1] * now.cache.size[2];
    int from = 0, to = 1, next = 2;
    for (int i = 0; i < 3; i++) {
        set[i] = lit_cache_room(v, 2);
        make(v, s, &set[i], 0, 0, all);
    }
    for (int f = 0; f < FRAMES; f++) {
        int k = f % ROUND, here = f & 1;
        uint32_t row = all * (uint32_t)k / ROUND;
        uint32_t end = all * (uint32_t)(k + 1) / ROUND;
        struct brume_cache blended = set[from].cache;
        blended.to = set[to].codes;
        blended.blend = 65536u * (uint32_t)k / ROUND;
        make(v, s, &now, f, 0, all);
        draw(v, s, &now.cache, picture[AT_ONCE][here]);
        draw(v, s, &blended, picture[BLENDED][here]);
        draw(v, s, &set[to].cache, picture[SWAPPED][here]);
        for (int w = 0; w < WAYS && f > 0; w++) {
            struct change c = change_of(picture[w][0], picture[w][1]);
            most[w].rms = fmax(most[w].rms, c.rms);
            most[w].most = fmax(most[w].most, c.most);
        }
        make(v, s, &set[next], f - k, row, end - row);
        if (k == ROUND - 1) {
            int oldest = from;
            from = to;
            to = next;
            next = oldest;
        }
    }
    int last = (FRAMES - 1) & 1;
    bool same = lit_differing(picture[AT_ONCE][last], picture[BLENDED][last],
                              RAYS) == 0;
    for (int i = 0; i < 3; i++)
        free(set[i].codes);
    free(now.codes);
    return same;
}

static void check_volume(int number)
{
    struct lit_volume v = lit_cloud(number);
    struct brume_scene s = lit_scene(&v, SIDE, SIDE, NULL);
    struct change most[WAYS] = {{0, 0}};
    s.filter = number & 1 ? BRUME_TRILINEAR : BRUME_NEAREST;
    s.light_samples = 64;
    s.light_step = 0x10000;
    bool same = film(&v, &s, most);
    /* Going through 16 frames' change in 16 steps of one size is no rougher
     * than each frame's own by more than the unevenness within them. */
    tap_check(most[BLENDED].rms <= 1.5 * most[AT_ONCE].rms,
              "%s: from frame to frame at most %.5f changes, %.5f when made at "
              "once",
              v.name, most[BLENDED].rms, most[AT_ONCE].rms);
    tap_check(most[BLENDED].most <= 2 * most[AT_ONCE].most,
              "%s: no ray by more than %.4f, %.4f when made at once", v.name,
              most[BLENDED].most, most[AT_ONCE].most);
    tap_check(most[SWAPPED].rms >= 5 * most[BLENDED].rms,
              "%s: sets that are swapped pop: %.5f", v.name, most[SWAPPED].rms);
    tap_check(same, "%s: at rest it is the cache made at once", v.name);
    lit_volume_free(&v);
}

int main(void)
{
    for (int i = 0; i < LIT_CLOUDS; i++)
        check_volume(i);
    return tap_done();
}
