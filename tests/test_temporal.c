/* SPDX-License-Identifier: MIT */
/*
 * What history keeps: the moving average against one in doubles, the window
 * against exact sums, and that every ray has its turn, every part of a step
 * and of a pixel its sample. Rays are stored, not marched: their values are
 * chosen here.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "brume_inner.h"
#include "support/asset_builder.h"
#include "support/passes.h"
#include "tap.h"

enum { SIDE = 16, RAYS = SIDE * SIDE };
static struct brume_volume s_volume;

static struct brume_scene scene_of(int temporal, int bits, double alpha)
{
    struct brume_scene s;
    brume_scene_default(&s, &s_volume);
    s.width = s.height = SIDE;
    s.output = BRUME_LINEAR;
    s.temporal = (uint8_t)temporal;
    s.history_bits = (uint8_t)bits;
    s.alpha = (uint32_t)(alpha * 65536);
    return s;
}

/* lowbias32, as a source of inputs. */
static uint32_t hash(uint32_t h)
{
    h = (h ^ h >> 16) * 0x7feb352du;
    h = (h ^ h >> 15) * 0x846ca68bu;
    return h ^ h >> 16;
}

/* A frame of the sequence with these rays, 16 bits each: of the lattice. */
static void store(struct passes *p, const struct brume_scene *s,
                  const uint16_t light[], const uint16_t transmittance[])
{
    static struct brume_radiance in[RAYS];
    passes_begin(p, &s_volume, s);
    for (int i = 0; i < p->frame.lattice[0] * p->frame.lattice[1]; i++) {
        in[i].light = of_sample(light[i]);
        in[i].transmittance = of_sample(transmittance[i]);
        in[i].depth = transmittance[i] == 65535 ? BRUME_NO_DEPTH : 40000;
    }
    passes_store(p, in);
}

static void history_of(const struct passes *p, struct brume_sample out[RAYS])
{
    for (uint32_t y = 0; y < SIDE; y++)
        brume_history_row(&p->frame, p->state, 0, y, SIDE, out + y * SIDE);
}

/// Moving average ///

enum input { CONSTANT, TWO_VALUES, NOISE, INPUTS };
static const char *const k_input[] = {"constants", "two values", "noise"};
static const double k_alpha[] = {1 / 64.0, 0.1, 0.5, 1};

/* Ray i of frame f, around a mean that differs from ray to ray. */
static uint16_t input_of(int input, uint32_t i, uint32_t f)
{
    uint32_t mean = 4096 + hash(i) % 57000;
    if (input == TWO_VALUES)
        return (uint16_t)(mean + 3001 - (hash(i + f * RAYS) & 1) * 6002);
    if (input == NOISE)
        return (uint16_t)(mean - 4000 + hash(i + f * RAYS) % 8001);
    return (uint16_t)mean;
}

struct error {
    double mean, worst_mean; /* over rays; of a ray over time */
    double deviation;        /* root mean square of single values */
};

/* Against doubles: 4096 frames, of which the last 3072 count, after a first
 * one that is all `start`. In 1/255. */
static struct error ema_error(int bits, double alpha, int input, uint16_t start)
{
    enum { FRAMES = 4096, LAST = 3072 };
    static double wanted[RAYS], sum[RAYS];
    static uint16_t in[RAYS];
    static struct brume_sample got[RAYS];
    struct error e = {0, 0, 0};
    struct passes p = {0};
    struct brume_scene s = scene_of(BRUME_EMA, bits, alpha);
    double a = s.alpha / 65536.0;
    memset(sum, 0, sizeof sum);
    for (uint32_t f = 0; f < FRAMES; f++) {
        s.frame = f;
        for (uint32_t i = 0; i < RAYS; i++) {
            in[i] = f == 0 ? start : input_of(input, i, f);
            wanted[i] = f == 0 ? in[i] : wanted[i] + a * (in[i] - wanted[i]);
        }
        store(&p, &s, in, in);
        if (f < FRAMES - LAST)
            continue;
        history_of(&p, got);
        for (int i = 0; i < RAYS; i++) {
            double d = (got[i].light - wanted[i]) / 257;
            sum[i] += d / LAST;
            e.deviation += d * d / RAYS / LAST;
        }
    }
    for (int i = 0; i < RAYS; i++) {
        e.mean += sum[i] / RAYS;
        e.worst_mean = fmax(e.worst_mean, fabs(sum[i]));
    }
    e.deviation = sqrt(e.deviation);
    passes_free(&p);
    return e;
}

/* 16 bits: the mean within 0.05 / 255, and no ray sticks. 8 bits: no bias
 * either, but a value is known to `deviation` only, which grows as alpha
 * falls: each frame's rounding has a variance of up to 1/4, and 1 / (2 alpha)
 * of them add up. */
static void test_ema(void)
{
    for (int a = 0; a < 4; a++)
        for (int input = 0; input < INPUTS; input++)
            for (int start = 0; start < 2; start++) {
                struct error e16 =
                    ema_error(16, k_alpha[a], input, start ? 65535 : 0);
                struct error e8 =
                    ema_error(8, k_alpha[a], input, start ? 65535 : 0);
                double most =
                    sqrt(0.25 / (2 * k_alpha[a] - k_alpha[a] * k_alpha[a]));
                tap_check(fabs(e16.mean) < 0.05 && e16.worst_mean < 0.05,
                          "ema, 16 bits, alpha %.4f, %s, from %d: mean %+.5f, "
                          "worst ray's %.5f, deviation %.5f",
                          k_alpha[a], k_input[input], start, e16.mean,
                          e16.worst_mean, e16.deviation);
                tap_check(fabs(e8.mean) < 0.05 && e8.deviation < most,
                          "ema, 8 bits: mean %+.5f, worst ray's %.5f, "
                          "deviation %.3f, below %.3f",
                          e8.mean, e8.worst_mean, e8.deviation, most);
            }
}

/* Constants are reached exactly, from below and above. */
static void test_ema_arrives(void)
{
    static uint16_t in[RAYS];
    static struct brume_sample got[RAYS];
    for (int start = 0; start < 2; start++) {
        struct passes p = {0};
        struct brume_scene s = scene_of(BRUME_EMA, 16, 1 / 64.0);
        int wrong = 0;
        for (s.frame = 0; s.frame < 4096; s.frame++) {
            for (uint32_t i = 0; i < RAYS; i++)
                in[i] = s.frame ? (uint16_t)hash(i) : start ? 65535 : 0;
            store(&p, &s, in, in);
        }
        history_of(&p, got);
        for (uint32_t i = 0; i < RAYS; i++)
            wrong += got[i].light != in[i] || got[i].transmittance != in[i];
        tap_check(wrong == 0, "ema, 16 bits, from %d: constants are reached",
                  start);
        passes_free(&p);
    }
}

/// Whatever the history ///

/* Rays that never change for 10,000 frames, half of them clear. `grain` is
 * what their values are multiples of: 257 for those that 8 bits can hold. */
static void check_steady(int temporal, int bits, uint32_t grain)
{
    static uint16_t light[RAYS], transmittance[RAYS];
    static struct brume_sample got[RAYS];
    struct passes p = {0};
    struct brume_scene s = scene_of(temporal, bits, 1 / 64.0);
    int wrong = 0;
    s.window = 7;
    for (uint32_t i = 0; i < RAYS; i++) {
        light[i] = i & 1 ? (uint16_t)(hash(i) % 256 * grain) : 0;
        transmittance[i] = i & 1 ? (uint16_t)(hash(~i) % 256 * grain) : 65535;
    }
    for (s.frame = 0; s.frame < 10000; s.frame++) {
        store(&p, &s, light, transmittance);
        if (s.frame % 97 != 0 && s.frame != 9999)
            continue;
        history_of(&p, got);
        for (int i = 0; i < RAYS; i++)
            wrong += got[i].light != light[i] ||
                     got[i].transmittance != transmittance[i];
    }
    tap_check(wrong == 0,
              "kind %d, %d bits: 10,000 frames of the same change nothing, "
              "and clear stays clear",
              temporal, bits);
    passes_free(&p);
}

static void test_steady(void)
{
    for (int temporal = BRUME_EMA; temporal <= BRUME_TAA; temporal++) {
        check_steady(temporal, 8, 257);
        check_steady(temporal, 16, 257);
        check_steady(temporal, 16, 251);
    }
}

/// Window ///

/* What each ray of the grid has seen. */
struct log {
    uint32_t seen;
    uint16_t value[512];
};

/* The rounded mean of a ray's last n values. */
static uint32_t mean_of(const struct log *log, uint32_t n)
{
    uint32_t count = log->seen < n ? log->seen : n, sum = 0;
    for (uint32_t k = 0; k < count; k++)
        sum += log->value[(log->seen - 1 - k) & 511u];
    return (sum + count / 2) / count;
}

/* Frames of random rays from frame number `first` on; how many rays are not
 * the exact mean of their last n values. */
static int window_wrong(int bits, uint32_t n, int update, uint32_t first,
                        uint32_t frames)
{
    static struct log logs[RAYS];
    static uint16_t in[RAYS];
    static struct brume_sample got[RAYS];
    struct passes p = {0};
    struct brume_scene s = scene_of(BRUME_WINDOW, bits, 1);
    int wrong = 0;
    s.window = (uint8_t)n;
    s.update = (uint8_t)update;
    memset(logs, 0, sizeof logs);
    for (uint32_t f = 0; f < frames; f++) {
        s.frame = first + f;
        for (uint32_t i = 0; i < RAYS; i++)
            in[i] = (uint16_t)(bits == 8 ? hash(i + f * RAYS) % 256 * 257
                                         : hash(i + f * RAYS));
        store(&p, &s, in, in);
        history_of(&p, got);
        for (uint32_t i = 0; i < RAYS; i++) {
            uint32_t x = i % SIDE, y = i / SIDE;
            struct log *log = &logs[i];
            if (brume_age_of(&p.frame, x, y) == 0)
                log->value[log->seen++ & 511u] =
                    in[brume_lattice_index(&p.frame, x, y)];
            uint32_t mean = log->seen > 0 ? mean_of(log, n) : 0;
            wrong += log->seen > 0 &&
                     (got[i].light != mean || got[i].transmittance != mean);
        }
    }
    passes_free(&p);
    return wrong;
}

static void test_window(void)
{
    for (int bits = 8; bits <= 16; bits += 8) {
        int wrong[3] = {0, 0, 0};
        for (uint32_t n = 1; n <= 16; n++)
            for (int update = 0; update < 3; update++)
                wrong[update] += window_wrong(bits, n, update, 5 + n,
                                              update ? 16 * (n + 2) : 3 * n);
        tap_check(wrong[0] == 0, "window, %d bits: exact for 1 to 16 frames",
                  bits);
        tap_check(wrong[1] == 0, "the same by turns, checker");
        tap_check(wrong[2] == 0, "the same by turns, bayer4");
        tap_check(window_wrong(bits, 7, 0, 0, 10000) == 0,
                  "window, %d bits: no drift in 10,000 frames", bits);
        tap_check(window_wrong(bits, 6, 2, 0xfffffff0u, 300) == 0,
                  "window, %d bits, bayer4: frame numbers wrap", bits);
    }
}

/* The count of frames in the state has an end too: it goes back by a multiple
 * of every window and period. */
static void test_count(void)
{
    static uint16_t in[RAYS];
    static struct brume_sample a[RAYS], b[RAYS];
    int differ = 0;
    for (uint32_t n = 1; n <= 16; n++)
        for (int update = 0; update < 3; update++) {
            struct passes p = {0}, q = {0};
            struct brume_scene s = scene_of(BRUME_WINDOW, 16, 1);
            uint32_t turns = n << brume_period_log2((uint32_t)update);
            s.window = (uint8_t)n;
            s.update = (uint8_t)update;
            for (s.frame = 0; s.frame < 600; s.frame++) {
                for (uint32_t i = 0; i < RAYS; i++)
                    in[i] = (uint16_t)hash(i + s.frame * RAYS);
                store(&p, &s, in, in);
                store(&q, &s, in, in);
                if (s.frame == 299)
                    q.state->frames +=
                        (0x80000000u - 150u - q.state->frames) / turns * turns;
                history_of(&p, a);
                history_of(&q, b);
                differ += memcmp(a, b, sizeof a) != 0;
            }
            passes_free(&p);
            passes_free(&q);
        }
    tap_check(differ == 0, "window: the count of frames wraps unseen");
}

/* After n frames nothing of older ones is left. */
static void test_window_forgets(void)
{
    static uint16_t in[RAYS];
    static struct brume_sample got[2][RAYS];
    int differ = 0;
    for (int bits = 8; bits <= 16; bits += 8)
        for (int n = 1; n <= 16; n++) {
            for (uint32_t k = 0; k < 2; k++) {
                struct passes p = {0};
                struct brume_scene s = scene_of(BRUME_WINDOW, bits, 1);
                s.window = (uint8_t)n;
                for (s.frame = 0; s.frame < 50; s.frame++) {
                    uint32_t old = s.frame < 50u - (uint32_t)n ? k * 999u : 0;
                    for (uint32_t i = 0; i < RAYS; i++)
                        in[i] = (uint16_t)hash(i + s.frame * RAYS + old);
                    store(&p, &s, in, in);
                }
                history_of(&p, got[k]);
                passes_free(&p);
            }
            differ += memcmp(got[0], got[1], sizeof got[0]) != 0;
        }
    tap_check(differ == 0, "window: no trace of frames before the last n");
}

/// Turns, strata, points ///

/* Every ray of the grid once in a period, and one in each cell at most. */
static int turns_wrong(unsigned w, unsigned h, int update, uint32_t first)
{
    static struct brume_frame frame;
    struct brume_scene s = scene_of(BRUME_EMA, 16, 1);
    uint32_t period = 1u << brume_period_log2((uint32_t)update);
    uint8_t *seen = calloc(w, h);
    int wrong = seen == NULL;
    s.width = (uint16_t)w;
    s.height = (uint16_t)h;
    s.update = (uint8_t)update;
    for (uint32_t f = 0; seen != NULL && f < period; f++) {
        uint8_t cell[2048] = {0};
        s.frame = first + f;
        wrong += brume_begin_frame(&frame, &s_volume, &s) != BRUME_OK;
        for (uint32_t i = 0; i < w * h; i++)
            if (brume_age_of(&frame, i % w, i / w) == 0) {
                wrong += cell[brume_lattice_index(&frame, i % w, i / w)]++;
                seen[i]++;
            }
    }
    for (uint32_t i = 0; seen != NULL && i < w * h; i++)
        wrong += seen[i] != 1;
    free(seen);
    return wrong;
}

static void test_turns(void)
{
    static const unsigned sizes[][2] = {{1, 1},   {1, 7},   {7, 1},  {2, 2},
                                        {13, 11}, {16, 16}, {37, 23}};
    int wrong = 0;
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++)
        for (int update = 0; update < 3; update++) {
            wrong += turns_wrong(sizes[i][0], sizes[i][1], update, 3);
            wrong += turns_wrong(sizes[i][0], sizes[i][1], update, 0xfffffff9u);
        }
    tap_check(wrong == 0, "every ray has one turn in 1, 2, 16 frames");
}

/* In n turns: each row and column of n x n in the pixel once; and the strata
 * one after the other fill the step to less than a 2^-12th. */
static void test_points(void)
{
    static struct brume_frame frame;
    int rooks = 0, strata = 0;
    for (uint32_t n = 1; n <= 16; n++)
        for (int update = 0; update < 3; update++) {
            uint32_t seen[3] = {0, 0, 0};
            struct brume_scene s = scene_of(BRUME_WINDOW, 16, 1);
            s.window = (uint8_t)n;
            s.update = (uint8_t)update;
            for (uint32_t k = 0; k < n; k++) {
                s.frame = (16 * n + k) << brume_period_log2((uint32_t)update);
                if (brume_begin_frame(&frame, &s_volume, &s) != BRUME_OK)
                    abort();
                seen[0] |= 1u << ((frame.point[0] * n) >> 16);
                seen[1] |= 1u << ((frame.point[1] * n) >> 16);
                seen[2] |= 1u << ((frame.stratum + frame.strata / 2) * n >> 16);
                strata += frame.strata > 0x10000u / n ||
                          frame.strata + 16 < 0x10000u / n ||
                          frame.stratum + frame.strata > 0x10000u;
            }
            rooks += seen[0] != (1u << n) - 1 || seen[1] != seen[0];
            strata += seen[2] != (1u << n) - 1;
        }
    tap_check(rooks == 0, "places in the pixel are N-rooks sets");
    tap_check(strata == 0, "strata divide the step");
}

int main(void)
{
    static const struct density_box box = {{4, 4, 4}, {28, 20, 36}, 32768};
    struct asset_spec spec =
        asset_spec_of(4, 3, 5, BRUME_U8, density_in_box, &box);
    size_t size;
    uint8_t *asset = asset_build(&spec, &size);
    if (brume_volume_open(&s_volume, asset, size, 0) != BRUME_OK)
        abort();
    test_ema();
    test_ema_arrives();
    test_steady();
    test_window();
    test_count();
    test_window_forgets();
    test_turns();
    test_points();
    free(asset);
    return tap_done();
}
