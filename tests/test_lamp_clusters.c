/* SPDX-License-Identifier: MIT */
/*
 * Culling of lamps cannot be seen: clusters that hold every lamp everywhere
 * give the same rays, to the byte, in random scenes; and rays are the same in
 * any cutting of a frame.
 */
#include <stdlib.h>
#include <string.h>

#include "support/lit.h"
#include "tap.h"

#define ONE 0x10000u
#define SCENES 3000

enum { W = 37, H = 29, RAYS = W * H };

static struct brume_frame frame;
static struct brume_radiance first[RAYS], second[RAYS];
static struct brume_clusters clusters;
static struct brume_lamp lamps[BRUME_MAX_LAMPS];
static struct brume_phase phase;
static uint32_t seed = 1;

static int between(int low, int high)
{
    return lit_between(&seed, low, high);
}

/// Scenes ///

/* 2^x of x in low .. high, Q16.16 both. */
static uint32_t length_of(int low, int high)
{
    int octave = between(low, high - 1);
    return (uint32_t)(ONE + lit_random(&seed) % ONE) << octave;
}

static void random_lamp(struct brume_lamp *p, const struct brume_scene *s)
{
    static const struct brume_lamp k_none;
    bool at_eye = between(0, 15) == 0;
    int spread = between(0, 3) == 0 ? 400 : 60;
    *p = k_none;
    p->radius = length_of(0, between(0, 7) == 0 ? 14 : 6);
    p->size = p->radius >> between(0, 5);
    p->size = p->size < ONE / 16 ? ONE / 16 : p->size;
    p->cos_outer = -(1 << 30);
    for (int i = 0; i < 3; i++) {
        p->position[i] = between(20 - spread, 20 + spread) * (int32_t)ONE +
                         between(0, 65535);
        if (at_eye)
            p->position[i] = s->eye[i];
        p->direction[i] = between(-9, 9);
        p->colour[i] = (uint32_t)between(0, 20) * ONE;
    }
    p->shadow_samples = (uint8_t)(between(0, 3) == 0 ? between(1, 4) : 0);
    if (between(0, 2) != 0)
        return;
    p->direction[2] += 100;
    p->cos_outer = between(-1000, 1000) * 1000000;
    p->cos_inner = p->cos_outer + between(0, 70) * 1000000;
}

/* Eyes in, near and far from the volume, and whatever moves rays. */
static void random_scene(struct brume_scene *s)
{
    int far = between(0, 4) == 0 ? 3000 : 70;
    for (int i = 0; i < 3; i++) {
        s->eye[i] = between(20 - far, 20 + far) * (int32_t)ONE + 77;
        s->target[i] = between(0, 40) * (int32_t)ONE;
    }
    s->up[0] = between(-1, 1);
    s->fov = far > 70 ? 2 * ONE : (uint32_t)between(5, 150) * ONE;
    s->width = (uint16_t)between(1, W);
    s->height = (uint16_t)between(1, H);
    s->step = (uint32_t)between(1, 48) * (ONE / 16);
    s->frame = (uint32_t)between(0, 100);
    s->filter = (uint8_t)between(0, 2);
    s->jitter = (uint8_t)between(0, 3);
    s->noise = BRUME_NOISE_WHITE;
    s->density_scale = BRUME_Q32(0.05);
    s->temporal = (uint8_t)between(0, 3);
    s->alpha = ONE / 4;
    s->window = (uint8_t)between(1, 16);
    s->subpixel = between(0, 1) != 0;
    s->update = (uint8_t)between(0, 2);
    s->resolution = (uint8_t)between(0, 2);
    s->light_samples = 2;
}

static void fill_clusters(uint32_t count)
{
    for (uint32_t n = 0; n < count; n++)
        for (int z = 0; z < BRUME_CLUSTER_SLICES; z++)
            for (int y = 0; y < BRUME_CLUSTER_SIDE; y++)
                for (int x = 0; x < BRUME_CLUSTER_SIDE; x++)
                    clusters.lamps[z][y][x][n / 32] |= 0x80000000u >> n % 32;
}

/* Bits of clusters that are set, of all there could be, in 1/1000. */
static double share_set(uint32_t count)
{
    uint32_t set = 0, all = 0;
    for (uint32_t n = 0; n < count; n++)
        for (int z = 0; z < BRUME_CLUSTER_SLICES; z++)
            for (int y = 0; y < BRUME_CLUSTER_SIDE; y++)
                for (int x = 0; x < BRUME_CLUSTER_SIDE; x++, all++)
                    set += clusters.lamps[z][y][x][n / 32] >> (31 - n % 32) & 1;
    return all > 0 ? 1000.0 * set / all : 0;
}

static int march(struct brume_radiance *out)
{
    int n = frame.lattice[0] * frame.lattice[1];
    memset(out, 0xa5, RAYS * sizeof *out);
    if (brume_march_rect(&frame, 0, 0, frame.lattice[0], frame.lattice[1], out,
                         frame.lattice[0]) != BRUME_OK)
        abort();
    return n;
}

/* The same rays in rectangles, in the order of a random cutting. */
static void march_cut(struct brume_radiance *out)
{
    unsigned w = frame.lattice[0], h = frame.lattice[1];
    unsigned cut_w = (unsigned)between(1, (int)w);
    unsigned cut_h = (unsigned)between(1, (int)h);
    memset(out, 0xa5, RAYS * sizeof *out);
    for (unsigned y = 0; y < h; y += cut_h)
        for (unsigned x = 0; x < w; x += cut_w)
            if (brume_march_rect(&frame, x, y, w - x < cut_w ? w - x : cut_w,
                                 h - y < cut_h ? h - y : cut_h, out + y * w + x,
                                 w) != BRUME_OK)
                abort();
}

/* What came of the scenes of a volume. */
struct tally {
    int clusters_differ, cuts_differ, lit, rays;
    double share;
};

static void check_scene(const struct lit_volume *v, struct tally *tally)
{
    struct brume_lighting l = {.lamps = lamps, .clusters = &clusters};
    struct brume_scene s = lit_scene(v, W, H, &l);
    random_scene(&s);
    l.phase = between(0, 2) == 0 ? &phase : NULL;
    l.lamp_count = (uint32_t)between(1, BRUME_MAX_LAMPS);
    for (uint32_t i = 0; i < l.lamp_count; i++)
        random_lamp(&lamps[i], &s);
    memset(&clusters, 0xff, sizeof clusters);
    if (brume_begin_frame(&frame, &v->volume, &s) != BRUME_OK)
        return;
    int n = march(first);
    march_cut(second);
    tally->cuts_differ += lit_differing(first, second, n);
    tally->share += frame.lit.clusters != NULL ? share_set(l.lamp_count) : 0;
    fill_clusters(l.lamp_count);
    march(second);
    tally->clusters_differ += lit_differing(first, second, n);
    for (int i = 0; i < n; i++)
        tally->lit += (first[i].light | first[i].green | first[i].blue) != 0;
    tally->rays += n;
}

static void check_volume(const struct lit_volume *v, int scenes)
{
    struct tally t = {0};
    for (int i = 0; i < scenes; i++)
        check_scene(v, &t);
    double lit = 100.0 * t.lit / t.rays;
    tap_check(t.clusters_differ == 0 && lit > 5 && t.share / scenes < 700,
              "%s: clusters cannot be seen: %d of %d rays differ; %.0f %% are "
              "lit, clusters hold %.0f %% of what they could",
              v->name, t.clusters_differ, t.rays, lit, t.share / scenes / 10);
    tap_check(t.cuts_differ == 0, "%s: any cutting: %d rays differ", v->name,
              t.cuts_differ);
}

/// The longest rays ///

/* Short steps add up what rounding makes of a step: 32760 voxels of 1/16. The
 * lamp is just beside, so that its edge is what is seen. */
static void test_long_rays(void)
{
    const int cells[3] = {4, 4, 4095}, low[3] = {0, 0, 0};
    const int high[3] = {32, 32, 32760};
    struct lit_volume v = lit_block(cells, low, high, 65280);
    struct brume_lighting l = {.lamps = lamps, .clusters = &clusters};
    struct brume_scene s = lit_scene(&v, 3, 3, &l);
    int differ = 0, lit = 0;
    for (int n = 0; n < 4; n++) {
        static const struct brume_lamp k_lamp = {
            .radius = 40 * ONE, .size = 40 * ONE, .cos_outer = -(1 << 30)};
        lamps[0] = k_lamp;
        for (int i = 0; i < 3; i++) {
            s.eye[i] = (i == 2 ? 5 : 9) * (int32_t)ONE + between(0, 65535);
            s.target[i] = (i == 2 ? 32700 : 16) * (int32_t)ONE;
            lamps[0].position[i] = s.target[i];
            lamps[0].colour[i] = 256 * ONE;
        }
        lamps[0].position[2] -= 100 * (int32_t)ONE;
        lamps[0].position[n & 1] += (n & 2 ? 39 : -39) * (int32_t)ONE;
        l.lamp_count = 1;
        s.fov = ONE;
        s.step = BRUME_MIN_STEP;
        s.density_scale = BRUME_Q32(0.0001);
        if (brume_begin_frame(&frame, &v.volume, &s) != BRUME_OK)
            abort();
        march(first);
        fill_clusters(1);
        march(second);
        differ += lit_differing(first, second, 9);
        for (int i = 0; i < 9; i++)
            lit += first[i].light != 0;
    }
    tap_check(differ == 0 && lit > 0,
              "rays of half a million samples: %d differ, %d of 36 lit", differ,
              lit);
    lit_volume_free(&v);
}

int main(void)
{
    const struct brume_phase_model m = {.g = 600000000};
    brume_phase_build(&phase, &m, 0, 0);
    for (int i = 0; i < LIT_CLOUDS; i++) {
        struct lit_volume v = lit_cloud(i);
        check_volume(&v, SCENES / LIT_CLOUDS);
        lit_volume_free(&v);
    }
    test_long_rays();
    return tap_done();
}
