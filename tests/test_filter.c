/* SPDX-License-Identifier: MIT */
/*
 * Spatial filters and upsampling against their definitions in double: random
 * rays are put into a state as if they had been marched, shown, and compared
 * with a direct implementation of two dimensions. What no rounding may change
 * is checked exactly: constants, mirror images.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "brume_inner.h"
#include "support/asset_builder.h"
#include "tap.h"

#define TOP 65535 /* code of 1.0 */
#define OCTAVE 2048.0
#define NOWHERE 65535 /* depth of a ray that met nothing */

static const char *const k_name[] = {
    "none", "box3", "box5", "gauss1", "binomial3", "binomial5", "bilateral15"};
enum { KERNELS = 7 };

static uint32_t s_random = 1;

static uint32_t random_below(uint32_t n)
{
    s_random = s_random * 1664525u + 1013904223u;
    return (uint32_t)((uint64_t)s_random * n >> 32);
}

static void *allocate(size_t size)
{
    void *p = malloc(size ? size : 1);
    if (p == NULL)
        abort();
    return p;
}

/// Images ///

/* Rays of the grid, in codes of 16 bits. */
struct image {
    int w, h;
    int *light, *transmittance, *depth;
};

static struct image image_make(int w, int h)
{
    size_t size = (size_t)w * (size_t)h * sizeof(int);
    struct image m = {w, h, allocate(size), allocate(size), allocate(size)};
    return m;
}

static void image_free(struct image *m)
{
    free(m->light);
    free(m->transmittance);
    free(m->depth);
}

/* Depths in clusters of an octave, a few rays without: neighbours mix in every
 * proportion. */
static void fill_random(struct image *m)
{
    for (int i = 0; i < m->w * m->h; i++) {
        m->light[i] = (int)random_below(TOP + 1);
        m->transmittance[i] = (int)random_below(TOP + 1);
        m->depth[i] = (int)(40000u + random_below(3000));
        if (random_below(8) == 0)
            m->depth[i] = NOWHERE;
    }
}

static struct image mirrored(const struct image *m, bool across, bool down)
{
    struct image out = image_make(m->w, m->h);
    for (int y = 0; y < m->h; y++)
        for (int x = 0; x < m->w; x++) {
            int from =
                (down ? m->h - 1 - y : y) * m->w + (across ? m->w - 1 - x : x);
            out.light[y * m->w + x] = m->light[from];
            out.transmittance[y * m->w + x] = m->transmittance[from];
            out.depth[y * m->w + x] = m->depth[from];
        }
    return out;
}

/// What is under test ///

struct setting {
    int spatial;
    double falloff; /* multiple of 2^-16 */
    int resolution, upsample;
};

static struct brume_volume s_volume;

static void scene_of(struct brume_scene *scene, struct setting t, int w, int h)
{
    brume_scene_default(scene, &s_volume);
    scene->width = (uint16_t)w;
    scene->height = (uint16_t)h;
    scene->output = BRUME_LINEAR;
    scene->spatial = (uint8_t)t.spatial;
    scene->edge_falloff = (uint32_t)(t.falloff * 65536);
    scene->resolution = (uint8_t)t.resolution;
    scene->upsample = (uint8_t)t.upsample;
}

/* One channel of the rays as 16-bit pixels: light over a black background, or,
 * without light, transmittance before a white one. */
static void show(const struct image *m, struct setting t, int w, int h,
                 bool light, uint16_t *out)
{
    struct brume_scene scene;
    struct brume_frame frame;
    size_t count = (size_t)m->w * (size_t)m->h, row = 2 * (size_t)w;
    struct brume_radiance *rays = allocate(count * sizeof *rays);

    scene_of(&scene, t, w, h);
    for (int c = 0; c < 3; c++)
        scene.background[c] = light ? 0 : 0x10000;
    if (brume_begin_frame(&frame, &s_volume, &scene) != BRUME_OK ||
        frame.grid[0] != m->w || frame.grid[1] != m->h)
        abort();
    for (size_t i = 0; i < count; i++) {
        rays[i].light = light ? of_sample((uint32_t)m->light[i]) : 0;
        rays[i].transmittance = of_sample((uint32_t)m->transmittance[i]);
        rays[i].depth = (uint32_t)m->depth[i];
    }
    size_t size = brume_state_bytes(&scene);
    struct brume_state *state = allocate(size);
    size_t work_size = brume_work_bytes(&frame, (unsigned)w);
    void *work = allocate(work_size);
    if (brume_state_init(state, size) != BRUME_OK ||
        brume_begin_state(state, &frame) != BRUME_OK ||
        brume_store_rect(&frame, state, 0, 0, (unsigned)m->w, (unsigned)m->h,
                         rays, (size_t)m->w) != BRUME_OK ||
        brume_show_rect(&frame, state, 0, 0, (unsigned)w, (unsigned)h,
                        BRUME_L16, out, row, work, work_size) != BRUME_OK)
        abort();
    free(work);
    free(state);
    free(rays);
}

/// Definitions ///

/* Normal distribution over [x - 1/2, x + 1/2]. */
static double gauss_over(int x)
{
    return (erf((x + .5) / sqrt(2)) - erf((x - .5) / sqrt(2))) / 2;
}

/* Kernel weights w[0 .. 2 radius], summing to 1. */
static int exact_kernel(int spatial, double *w)
{
    static const int k_radius[] = {0, 1, 2, 3, 1, 2, 7};
    static const double k_binomial[2][5] = {{1, 2, 1}, {1, 4, 6, 4, 1}};
    const int radius = k_radius[spatial];
    double sum = 0;

    for (int i = 0; i <= 2 * radius; i++) {
        int x = i - radius;
        w[i] = spatial == BRUME_GAUSS1        ? gauss_over(x)
               : spatial == BRUME_BINOMIAL3   ? k_binomial[0][i]
               : spatial == BRUME_BINOMIAL5   ? k_binomial[1][i]
               : spatial == BRUME_BILATERAL15 ? exp(-x * x / (2 * 1.5 * 1.5))
                                              : 1;
        sum += w[i];
    }
    for (int i = 0; i <= 2 * radius; i++)
        w[i] /= sum;
    return radius;
}

/* The same in Q0.16: rounded, the middle takes what is left. */
static int core_kernel(int spatial, double *w)
{
    int radius = exact_kernel(spatial, w);
    double outer = 0;
    for (int i = 0; i <= 2 * radius; i++) {
        w[i] = floor(65536 * w[i] + .5) / 65536;
        outer += i == radius ? 0 : w[i];
    }
    w[radius] = 1 - outer;
    return radius;
}

/* Likeness of rays i and j: by depth or, when one of them has none, by what
 * they let through. */
static double likeness(const struct image *m, const double *clear, int i, int j,
                       double falloff, double sky)
{
    int a = m->depth[i], b = m->depth[j];
    if (a == b)
        return 1;
    if (a == NOWHERE || b == NOWHERE)
        return exp(-sky * fabs(clear[i] - clear[j]) / 65536);
    return exp(-falloff * abs(a - b) / OCTAVE);
}

static int clamped(int i, int n)
{
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}

/* One pass along an axis over both channels: v[0] light, v[1] transmittance. */
static void pass(const struct image *m, double *const in[2],
                 double *const out[2], const double *w, int radius,
                 double falloff, bool down)
{
    for (int y = 0; y < m->h; y++)
        for (int x = 0; x < m->w; x++) {
            double total[2] = {0, 0}, sum = 0;
            int here = y * m->w + x;
            for (int k = -radius; k <= radius; k++) {
                int i = down ? clamped(y + k, m->h) * m->w + x
                             : y * m->w + clamped(x + k, m->w);
                double e = w[k + radius];
                if (falloff != 0)
                    e *= likeness(m, in[1], here, i, falloff, 8);
                total[0] += e * in[0][i];
                total[1] += e * in[1][i];
                sum += e;
            }
            out[0][here] = total[0] / sum;
            out[1][here] = total[1] / sum;
        }
}

static void filter(const struct image *m, struct setting t, bool exact,
                   double *const v[2])
{
    double w[15], *other[2];
    size_t count = (size_t)m->w * (size_t)m->h;
    int radius = exact ? exact_kernel(t.spatial, w) : core_kernel(t.spatial, w);

    for (int c = 0; c < 2; c++) {
        other[c] = allocate(count * sizeof(double));
        for (size_t i = 0; i < count; i++)
            v[c][i] = c ? m->transmittance[i] : m->light[i];
    }
    pass(m, v, other, w, radius, t.falloff, true);
    pass(m, other, v, w, radius, t.falloff, false);
    free(other[0]);
    free(other[1]);
}

/* Pixel (x, y) of a channel, between rays. */
static double upsampled(const struct image *m, double *const v[2], int channel,
                        struct setting t, int x, int y)
{
    double scale = 1 << t.resolution;
    double gx = (x + .5) / scale - .5, gy = (y + .5) / scale - .5;
    int x0 = (int)floor(gx), y0 = (int)floor(gy);
    int near = clamped((int)floor(gy + .5), m->h) * m->w +
               clamped((int)floor(gx + .5), m->w);
    double total = 0, sum = 0;

    for (int i = 0; i < 4; i++) {
        double wx = i % 2 ? gx - x0 : 1 - gx + x0;
        double wy = i / 2 ? gy - y0 : 1 - gy + y0;
        int ray = clamped(y0 + i / 2, m->h) * m->w + clamped(x0 + i % 2, m->w);
        double w = wx * wy;
        if (t.upsample == BRUME_UPSAMPLE_AWARE)
            w *= likeness(m, v[1], ray, near, 4, 2);
        total += w * v[channel][ray];
        sum += w;
    }
    return total / sum;
}

static double *defined(const struct image *m, struct setting t, int w, int h,
                       int channel, bool exact)
{
    size_t count = (size_t)m->w * (size_t)m->h * sizeof(double);
    double *v[2] = {allocate(count), allocate(count)};
    double *out = allocate((size_t)w * (size_t)h * sizeof *out);

    filter(m, t, exact, v);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            out[y * w + x] = t.resolution ? upsampled(m, v, channel, t, x, y)
                                          : v[channel][y * w + x];
    free(v[0]);
    free(v[1]);
    return out;
}

/// Comparing ///

struct error {
    double worst, squares, sum;
    long count;
};

static void compare(struct error *e, const uint16_t *out, const double *exact,
                    int count)
{
    for (int i = 0; i < count; i++) {
        double d = out[i] - exact[i];
        e->worst = fabs(d) > e->worst ? fabs(d) : e->worst;
        e->squares += d * d;
        e->sum += d;
        e->count++;
    }
}

/* Both channels of a random image of w x h pixels. */
static void compare_random(struct error *e, struct setting t, int w, int h,
                           bool exact)
{
    int r = t.resolution;
    struct image m =
        image_make((w + (1 << r) - 1) >> r, (h + (1 << r) - 1) >> r);
    uint16_t *out = allocate(2 * (size_t)w * (size_t)h);

    fill_random(&m);
    for (int light = 0; light < 2; light++) {
        show(&m, t, w, h, light, out);
        double *want = defined(&m, t, w, h, light ? 0 : 1, exact);
        compare(e, out, want, w * h);
        free(want);
    }
    free(out);
    image_free(&m);
}

static const int k_sizes[][2] = {{1, 1},  {1, 9},   {9, 1},  {2, 2},
                                 {3, 17}, {16, 16}, {41, 7}, {67, 53}};

static struct error errors_of(struct setting t, bool exact)
{
    struct error e = {0, 0, 0, 0};
    for (size_t i = 0; i < sizeof k_sizes / sizeof *k_sizes; i++)
        compare_random(&e, t, k_sizes[i][0], k_sizes[i][1], exact);
    return e;
}

/// Tests ///

/* A row whose only light ray is 1.0 gives the weights, as the column pass
 * repeats the row. */
static void test_weights(void)
{
    for (int k = 1; k < KERNELS; k++) {
        struct setting t = {k, 0, 0, 0};
        struct image m = image_make(31, 1);
        uint16_t out[31];
        double exact[15], core[15], far = 0;
        int radius = exact_kernel(k, exact), sum = 0, wrong = 0;

        core_kernel(k, core);
        memset(m.light, 0, 31 * sizeof(int));
        memset(m.transmittance, 0, 31 * sizeof(int));
        memset(m.depth, 0, 31 * sizeof(int));
        m.light[15] = TOP;
        show(&m, t, 31, 1, true, out);
        for (int i = 0; i < 31; i++) {
            int at = i - 15 + radius;
            bool inside = at >= 0 && at <= 2 * radius;
            double w = inside ? exact[at] : 0;
            far = fmax(far, fabs(out[i] - 65536 * w));
            wrong += out[i] != (inside ? 65536 * core[at] : 0);
            sum += out[i];
        }
        tap_check(sum == 65536 && wrong == 0 && far < 1,
                  "%s: weights sum to 1, and are off by %.2f / 65536",
                  k_name[k], far);
        image_free(&m);
    }
}

/* Rounding: half a code in either pass and in upsampling. */
static void test_plain(void)
{
    for (int k = 0; k < KERNELS; k++)
        for (int r = 0; r < 3; r++) {
            struct setting t = {k, 0, r, BRUME_UPSAMPLE_BILINEAR};
            struct error e = errors_of(t, false), f = errors_of(t, true);
            double bound = (k ? 1 : 0) + (r ? .5 : 0) + 1e-6;
            tap_check(e.worst <= bound && f.worst <= bound + 2.5,
                      "%s, 1/%d: off by %.3f of %.1f codes at most; with exact "
                      "weights %.3f",
                      k_name[k], 1 << r, e.worst, bound, f.worst);
        }
}

/* The error of weights: see brume_filter.c. A pass is wrong by at most what
 * the weights are, times the range of 65536 codes. */
static double edge_bound(int spatial)
{
    double w[15], half = .5 / 65536, outer = 0;
    int radius = core_kernel(spatial, w);
    for (int i = 0; i < radius; i++)
        outer += 2 * (half + w[i] / 16384);
    return 65536 * (outer / w[radius] + 1. / 8192);
}

static void test_edge(void)
{
    static const double k_falloff[] = {.25, 3, 64, 1024};
    for (int k = 1; k < KERNELS; k++)
        for (size_t i = 0; i < 4; i++) {
            struct setting t = {k, k_falloff[i], 0, 0};
            struct error e = errors_of(t, false);
            double rms = sqrt(e.squares / (double)e.count);
            tap_check(e.worst <= 2 * edge_bound(k) && rms < 2,
                      "%s, edge %g: off by %.1f of %.0f codes, rms %.2f",
                      k_name[k], t.falloff, e.worst, 2 * edge_bound(k), rms);
        }
}

static void test_aware(void)
{
    for (int k = 0; k < KERNELS; k++)
        for (int r = 1; r < 3; r++) {
            struct setting t = {k, k ? 3 : 0, r, BRUME_UPSAMPLE_AWARE};
            struct error e = errors_of(t, false);
            double rms = sqrt(e.squares / (double)e.count);
            tap_check(e.worst <= 32 + (k ? 2 * edge_bound(k) : 0) && rms < 2,
                      "%s, 1/%d aware: off by %.1f codes, rms %.2f", k_name[k],
                      1 << r, e.worst, rms);
        }
}

/* No darkening: over 2 * 3 * 3551 random values, errors must cancel. */
static void test_mean(void)
{
    for (int k = 1; k < KERNELS; k++)
        for (int edge_aware = 0; edge_aware < 2; edge_aware++) {
            struct setting t = {k, edge_aware ? 4 : 0, 0, 0};
            struct error e = {0, 0, 0, 0};
            for (int i = 0; i < 8; i++)
                compare_random(&e, t, 130, 120, true);
            double mean = e.sum / (double)e.count;
            double sigma = sqrt(e.squares / (double)e.count / (double)e.count);
            tap_check(fabs(mean) < 4 * sigma && fabs(mean) < .02,
                      "%s, %s: mean error %.4f codes (one sigma %.4f)",
                      k_name[k], edge_aware ? "edge-aware" : "plain", mean,
                      sigma);
        }
}

/* Calls f for every setting; counts what it finds wrong. */
static int over_settings(int (*f)(struct setting t))
{
    int wrong = 0;
    for (int k = 0; k < KERNELS; k++)
        for (int e = 0; e < (k ? 3 : 1); e++)
            for (int r = 0; r < 3; r++)
                for (int up = 0; up < (r ? 2 : 1); up++) {
                    struct setting t = {k,
                                        e == 0   ? 0
                                        : e == 1 ? 1.5
                                                 : 200,
                                        r, up};
                    wrong += f(t);
                }
    return wrong;
}

static int constants(struct setting t)
{
    static const int k_value[] = {0, 1, 2, 255, 32767, 32768, 65534, 65535};
    const int w = 23, h = 14;
    int wrong = 0;
    for (size_t v = 0; v < 8; v++) {
        struct image m =
            image_make((w + (1 << t.resolution) - 1) >> t.resolution,
                       (h + (1 << t.resolution) - 1) >> t.resolution);
        uint16_t out[23 * 14];
        fill_random(&m); /* depths stay random */
        for (int i = 0; i < m.w * m.h; i++)
            m.light[i] = m.transmittance[i] = k_value[v];
        for (int light = 0; light < 2; light++) {
            show(&m, t, w, h, light, out);
            for (int i = 0; i < w * h; i++)
                wrong += out[i] != k_value[v];
        }
        image_free(&m);
    }
    return wrong;
}

static int mirror_images(struct setting t)
{
    const int r = t.resolution, w = 5 << r, h = 7 << r;
    struct image m = image_make(5, 7);
    uint16_t out[20 * 28], other[20 * 28];
    int wrong = 0;

    fill_random(&m);
    show(&m, t, w, h, true, out);
    for (int flip = 1; flip < 4; flip++) {
        bool across = flip & 1, down = flip & 2;
        struct image n = mirrored(&m, across, down);
        show(&n, t, w, h, true, other);
        for (int i = 0; i < w * h; i++) {
            int x = i % w, y = i / w;
            wrong += other[i] !=
                     out[(down ? h - 1 - y : y) * w + (across ? w - 1 - x : x)];
        }
        image_free(&n);
    }
    image_free(&m);
    return wrong;
}

int main(void)
{
    static const struct density_cloud k_cloud = {72, 5};
    struct asset_spec spec =
        asset_spec_of(9, 9, 9, BRUME_U8, density_in_cloud, &k_cloud);
    size_t size;
    uint8_t *asset = asset_build(&spec, &size);

    if (brume_volume_open(&s_volume, asset, size, 0) != BRUME_OK)
        abort();
    test_weights();
    test_plain();
    test_edge();
    test_aware();
    test_mean();
    tap_check(over_settings(constants) == 0,
              "a constant stays the same in all settings");
    tap_check(over_settings(mirror_images) == 0,
              "a mirrored image gives the mirrored result in all settings");
    free(asset);
    return tap_done();
}
