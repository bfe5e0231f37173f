/* SPDX-License-Identifier: MIT */
/*
 * Light from the sky (core/brume_lit.c): constant, gradient and cube, open,
 * sampled and baked, against docs/light.md in double.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "brume_noise_tables.h"
#include "support/lit.h"
#include "tap.h"

#define ONE 0x10000u
#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

enum { W = 40, H = 30, RAYS = W * H };

static struct brume_frame frame;
static struct brume_radiance first[RAYS], second[RAYS];

/* A black sun under a sky of brightness 1 from everywhere. */
static struct brume_lighting white_sky(int ambient)
{
    struct brume_lighting l = {.ambient = (uint8_t)ambient};
    for (int i = 0; i < 18; i++)
        l.ambient_colour[i / 3][i % 3] = ONE;
    return l;
}

static void sample_sky(struct brume_lighting *l, uint32_t step, uint8_t samples,
                       const struct brume_direction_table *t)
{
    l->visibility = BRUME_SKY_SAMPLED;
    l->visibility_samples = samples;
    l->visibility_step = step;
    l->directions = t;
}

/* A table of one direction, and the same with the z of each axis. */
static struct brume_direction_table one_direction(int8_t values[192],
                                                  const int8_t way[3])
{
    struct brume_direction_table t = {values, 3, 3, 0};
    for (int i = 0; i < 192; i++)
        values[i] = way[i % 3];
    return t;
}

/// Open sky ///

/* What is lost of the background comes from the sky. Transmittance and each
 * ambient colour's light are rounded to half a code: 1.5 of them at most, which
 * is a whole number. */
static void check_furnace(const struct lit_volume *v)
{
    static const char *const k_name[] = {"", "constant", "gradient", "cube"};
    for (int ambient = 1; ambient <= 3; ambient++) {
        struct brume_lighting l = white_sky(ambient);
        double worst = 0;
        int lit = 0;
        for (int n = 0; n < 6; n++) {
            struct brume_scene s = lit_scene(v, W, H, &l);
            s.filter = (uint8_t)(n % 3);
            s.step = BRUME_MIN_STEP << 3 * (n / 3);
            s.min_transmittance = n & 1 ? 6553 : 0;
            s.jitter = BRUME_JITTER_PRIMARY;
            s.noise = BRUME_NOISE_WHITE;
            lit_march(&frame, v, &s, first);
            for (int i = 0; i < RAYS; i++) {
                double sum = (double)first[i].light + first[i].transmittance;
                worst = fmax(worst, fabs(sum - 65536));
                lit += first[i].light > 0;
            }
        }
        tap_check(worst <= 1 && lit > RAYS,
                  "%s, %s: light + transmittance is 1, within %.0f codes",
                  v->name, k_name[ambient], worst);
    }
}

/// Gradient ///

/* A block lit from above or below alone: one sample a ray, of height h between
 * the faces of the block along zenith, half a voxel beyond its voxels' middles;
 * in any direction of zenith. Light is h, in half codes; positions are of
 * 2^-16, in a Q17.14 along zenith, with a unit vector of 2^-26. */
static double gradient_error(const struct lit_volume *v, const double low[3],
                             const double high[3], const int32_t zenith[3],
                             int filter, int upper)
{
    struct brume_lighting l = white_sky(BRUME_AMBIENT_GRADIENT);
    struct brume_scene s = lit_one_sample(v, W, H, &l);
    double worst = 0, up[3], length = 0, floor_at = 0, height = 0;
    for (int i = 0; i < 3; i++) {
        l.zenith[i] = zenith[i];
        l.ambient_colour[upper][i] = 0;
        up[i] = zenith[i];
        length += up[i] * up[i];
    }
    if (length == 0) /* no direction stands for +y */
        length = up[1] = 1;
    for (int i = 0; i < 3; i++) {
        up[i] /= sqrt(length);
        floor_at += up[i] * (up[i] > 0 ? low[i] : high[i]);
        height += fabs(up[i]) * (high[i] - low[i]);
    }
    s.filter = (uint8_t)filter;
    lit_march(&frame, v, &s, first);
    for (int i = 0; i < RAYS; i++) {
        double p[3], h = -floor_at;
        if (first[i].transmittance != 0)
            continue;
        lit_sample_position(&s, i % W, i / W, p);
        for (int a = 0; a < 3; a++)
            h += up[a] * p[a];
        h = fmin(fmax(h / height, 0), 1);
        double off = first[i].light / 65536.0 - (upper ? h : 1 - h);
        worst = fmax(worst, fabs(off) * height);
    }
    return worst;
}

static void check_gradient(void)
{
    static const int32_t k_zenith[][3] = {{0, 0, 0},  {0, 1, 0},  {1, 0, 0},
                                          {0, 0, -1}, {-1, 0, 0}, {1, 2, -2},
                                          {-3, -1, 7}};
    /* Within the pool; and to its faces */
    static const int k_low[][3] = {{2, 3, 1}, {0, 0, 0}};
    static const int k_high[][3] = {{30, 29, 22}, {32, 32, 24}};
    for (int n = 0; n < 6; n++) {
        const int *from = k_low[n & 1], *to = k_high[n & 1];
        struct lit_volume v =
            lit_block((const int[]){4, 4, 3}, from, to, 65280);
        double low[3], high[3], worst = 0;
        for (int a = 0; a < 3; a++) {
            low[a] = from[a] - 0.5;
            high[a] = to[a] - 0.5;
        }
        for (int k = 0; k < 2 * COUNT(k_zenith); k++) {
            int32_t zenith[3];
            memcpy(zenith, k_zenith[k / 2], sizeof zenith);
            worst = fmax(worst,
                         gradient_error(&v, low, high, zenith, n / 2, k & 1));
        }
        tap_check(worst < ldexp(1, -10),
                  "gradient, filter %d, %s: heights within %.5f voxels", n / 2,
                  n & 1 ? "the pool's box" : "a box", worst);
        lit_volume_free(&v);
    }
}

/// Cube ///

/* How many rays see light of one ambient colour, with zenith along an axis and
 * nothing that hides the sky. */
static int rays_lit(const struct lit_volume *v, struct brume_scene s, int turn,
                    int colour, const struct brume_direction_table *t)
{
    struct brume_lighting l = {.ambient = BRUME_AMBIENT_CUBE};
    int lit = 0;
    sample_sky(&l, ONE, 0, t);
    l.zenith[turn / 2] = turn & 1 ? -1 : 1;
    for (int c = 0; c < 3; c++)
        l.ambient_colour[colour][c] = ONE;
    s.lighting = &l;
    lit_march(&frame, v, &s, first);
    for (int i = 0; i < RAYS; i++)
        lit += first[i].light > 0;
    return lit;
}

/* With one direction in the table, along its pole, the first sample sees
 * zenith's colour alone, and the second one that of its opposite. */
static void check_axes(const struct lit_volume *v)
{
    static int8_t values[192];
    static const int8_t k_pole[3] = {0, 0, 127};
    struct brume_direction_table t = one_direction(values, k_pole);
    struct brume_scene all = lit_scene(v, W, H, NULL);
    struct brume_scene one = lit_one_sample(v, W, H, NULL);
    int bad = 0, bad_one = 0, seen = 0;
    for (int n = 0; n < 36; n++) {
        int turn = n / 6, colour = n % 6;
        int lit = rays_lit(v, all, turn, colour, &t);
        int lit_one = rays_lit(v, one, turn, colour, &t);
        bad += (lit > 0) != (colour / 2 == turn / 2);
        bad_one += (lit_one > 0) != (colour == turn);
        seen += lit_one;
    }
    tap_check(bad == 0 && bad_one == 0 && seen > RAYS,
              "%s, cube: zenith along each axis has its own colour first, and "
              "its opposite's",
              v->name);
}

/* Six equal colours are one, whatever the directions. Each colour's light is
 * rounded to half a code, and so is that of the one: 3.5. */
static void check_equal_cube(const struct lit_volume *v)
{
    double worst = 0;
    int hidden = 0;
    for (uint32_t n = 0; n < 16; n++) {
        struct brume_lighting l = white_sky(BRUME_AMBIENT_CONSTANT);
        struct brume_scene s = lit_scene(v, W, H, &l);
        sample_sky(&l, ONE, 5, &brume_noise_hemisphere);
        l.zenith[n % 3] = 1;
        s.frame = n;
        lit_march(&frame, v, &s, first);
        l.ambient = BRUME_AMBIENT_CUBE;
        lit_march(&frame, v, &s, second);
        for (int i = 0; i < RAYS; i++) {
            worst = fmax(worst, fabs((double)second[i].light - first[i].light));
            hidden += first[i].light + first[i].transmittance < 60000;
        }
    }
    tap_check(worst <= 3 && hidden > RAYS,
              "cube of one colour, sampled: constant's light within %.0f codes",
              worst);
}

/// Sampled ///

/* A block as the core's nearest lookups have it, in voxels. */
struct block {
    double low[3], high[3], pool[3];
};

/* 1 in it, 0 outside, -1 when that is too near to tell, -2 outside of the
 * pool. */
static int density_in(const struct block *b, const double p[3])
{
    const double margin = 1.0 / 64;
    int inside = 1;
    for (int a = 0; a < 3; a++) {
        if (fabs(p[a] + 0.5) < margin || fabs(p[a] + 0.5 - b->pool[a]) < margin)
            return -1;
        if (p[a] < -0.5 || p[a] > b->pool[a] - 0.5)
            return -2;
    }
    for (int a = 0; a < 3; a++) {
        if (fabs(p[a] - b->low[a]) < margin || fabs(p[a] - b->high[a]) < margin)
            inside = -1;
        else if ((p[a] < b->low[a] || p[a] > b->high[a]) && inside == 1)
            inside = 0;
    }
    return inside;
}

/* What a ray in direction u lets through; -1 when that cannot be told. */
static double let_through(const struct block *b, const struct brume_scene *s,
                          const double p[3], const double u[3])
{
    const struct brume_lighting *l = s->lighting;
    double sum = 0;
    for (int k = 0; k < l->visibility_samples; k++) {
        double at[3], way = ldexp(l->visibility_step, k - 16);
        for (int a = 0; a < 3; a++)
            at[a] = p[a] + u[a] * way;
        int d = density_in(b, at);
        if (d == -2)
            break;
        if (d == -1)
            return -1;
        sum += d * way;
    }
    return exp(-ldexp((double)s->light_density_scale, -32) * sum);
}

static const int block_low[3] = {4, 7, 3}, block_high[3] = {29, 24, 22};

static struct lit_volume sky_block(struct block *b)
{
    const int cells[3] = {5, 4, 3};
    for (int a = 0; a < 3; a++) {
        b->low[a] = block_low[a] - 0.5;
        b->high[a] = block_high[a] - 0.5;
        b->pool[a] = 8 * cells[a];
    }
    return lit_block(cells, block_low, block_high, 65280);
}

/* One direction, along zenith, which is anywhere: each ray's light is what is
 * let through, with tau rounded to 2^-12 and a factor of its exponential to
 * 2^-15. A byte of the table is 127/128 at most. */
static void check_one_way(void)
{
    static int8_t values[192];
    static const int8_t k_pole[3] = {0, 0, 127};
    struct brume_direction_table t = one_direction(values, k_pole);
    struct block b;
    struct lit_volume v = sky_block(&b);
    uint32_t seed = 3;
    int rays = 0, between = 0;
    double worst = 0;
    for (int n = 0; n < 60; n++) {
        struct brume_lighting l = white_sky(BRUME_AMBIENT_CONSTANT);
        struct brume_scene s = lit_one_sample(&v, W, H, &l);
        double u[3], length = 0;
        uint32_t step = BRUME_MIN_STEP << n % 12;
        sample_sky(&l, step + (n % 2 ? step / 3 : 0), (uint8_t)(n % 17), &t);
        s.light_density_scale = BRUME_Q32(1.0 / 16);
        for (int a = 0; a < 3; a++) {
            l.zenith[a] = lit_between(&seed, -100, 100);
            length += (double)l.zenith[a] * l.zenith[a];
        }
        for (int a = 0; a < 3; a++)
            u[a] = l.zenith[a] / sqrt(length) * 127 / 128;
        lit_march(&frame, &v, &s, first);
        for (int i = 0; i < RAYS; i++) {
            double p[3];
            if (first[i].transmittance != 0)
                continue;
            lit_sample_position(&s, i % W, i / W, p);
            double want = let_through(&b, &s, p, u);
            if (want < 0)
                continue;
            double off = fabs(first[i].light / 65536.0 - want);
            worst = fmax(worst, off / (want * ldexp(1, -13) + ldexp(1, -15) +
                                       ldexp(1, -17)));
            between += want > 0.05 && want < 0.95;
            rays++;
        }
    }
    tap_check(worst <= 1 && rays > 20 * RAYS && between > RAYS,
              "sampled along zenith: %d rays within %.2f of their bound", rays,
              worst);
    lit_volume_free(&v);
}

/* Directions of the upper hemisphere, each as likely as another. */
enum { SIDE = 32, FRAMES = 64 };
static int8_t hemisphere[SIDE * SIDE * FRAMES * 3];

static struct brume_direction_table random_hemisphere(void)
{
    struct brume_direction_table t = {hemisphere, 5, 5, 6};
    uint32_t seed = 11;
    for (int i = 0; i < SIDE * SIDE * FRAMES; i++) {
        double z = lit_random(&seed) / 16777216.0;
        double phi = lit_random(&seed) / 16777216.0 * 2 * acos(-1);
        double r = sqrt(1 - z * z);
        hemisphere[3 * i] = (int8_t)lrint(127 * r * cos(phi));
        hemisphere[3 * i + 1] = (int8_t)lrint(127 * r * sin(phi));
        hemisphere[3 * i + 2] = (int8_t)lrint(127 * z);
    }
    return t;
}

/* The mean over the half of all directions that is above +y. */
static double mean_above(const struct block *b, const struct brume_scene *s,
                         const double p[3])
{
    enum { Z = 20, PHI = 40 };
    double sum = 0;
    int count = 0;
    for (int i = 0; i < Z * PHI; i++) {
        double z = (i / PHI + 0.5) / Z, r = sqrt(1 - z * z) * 127 / 128;
        double phi = (i % PHI + 0.5) * 2 * acos(-1) / PHI;
        const double u[3] = {r * cos(phi), z * 127 / 128, r * sin(phi)};
        double seen = let_through(b, s, p, u);
        sum += seen < 0 ? 0 : seen;
        count += seen >= 0;
    }
    return sum / count;
}

/* The first sample of each ray sees a direction of its own in each of 64
 * frames: their means over regions of 8 x 6 rays, in standard errors. */
static void check_all_ways(void)
{
    static double sum[RAYS], square[RAYS];
    struct brume_direction_table t = random_hemisphere();
    struct block b;
    struct lit_volume v = sky_block(&b);
    struct brume_lighting l = white_sky(BRUME_AMBIENT_CONSTANT);
    struct brume_scene s = lit_one_sample(&v, W, H, &l);
    double worst = 0;
    int regions = 0;
    sample_sky(&l, ONE, 5, &t);
    s.light_density_scale = BRUME_Q32(1.0 / 16);
    for (s.frame = 0; s.frame < FRAMES; s.frame++) {
        lit_march(&frame, &v, &s, first);
        for (int i = 0; i < RAYS; i++) {
            sum[i] += first[i].light / 65536.0 / FRAMES;
            square[i] +=
                first[i].light / 65536.0 * first[i].light / 65536.0 / FRAMES;
        }
    }
    for (int r = 0; r < RAYS / 48; r++) {
        double off = 0, variance = 0;
        for (int k = 0; k < 48; k++) {
            int i = (r / (W / 8) * 6 + k / 8) * W + r % (W / 8) * 8 + k % 8;
            double p[3];
            lit_sample_position(&s, i % W, i / W, p);
            if (first[i].transmittance != 0 || density_in(&b, p) != 1)
                continue;
            off += sum[i] - mean_above(&b, &s, p);
            variance += (square[i] - sum[i] * sum[i]) / (FRAMES - 1);
        }
        if (variance > 0)
            worst = fmax(worst, fabs(off) / sqrt(variance));
        regions += variance > 0;
    }
    tap_check(worst < 4 && regions >= 16,
              "sampled: means of %d regions within %.2f standard errors of the "
              "integral over directions",
              regions, worst);
    lit_volume_free(&v);
}

/// Baked ///

/* Between the eight cells' bytes around p, whose middles are 8 voxels apart;
 * and how far apart the eight are. */
static double baked_at(const struct brume_volume *v, const double p[3],
                       double *range)
{
    double sum = 0, low = 255, high = 0;
    for (int n = 0; n < 8; n++) {
        int at[3];
        double w = 1;
        for (int a = 0; a < 3; a++) {
            double q =
                fmin(fmax((p[a] + 0.5) / 8 - 0.5, 0), v->cell_count[a] - 1);
            at[a] = (int)q + (n >> a & 1);
            w *= n >> a & 1 ? q - floor(q) : 1 - q + floor(q);
            if (at[a] >= v->cell_count[a])
                at[a]--;
        }
        double byte =
            v->sky[(at[2] * v->cell_count[1] + at[1]) * v->cell_count[0] +
                   at[0]];
        sum += w * byte / 255;
        low = fmin(low, byte / 255);
        high = fmax(high, byte / 255);
    }
    *range = high - low;
    return sum;
}

/* Weights are cut to 1/256 on three axes, the value to 2^-16. */
static void check_baked(const struct lit_volume *v)
{
    struct brume_lighting l = white_sky(BRUME_AMBIENT_CONSTANT);
    double worst = 0;
    int rays = 0;
    l.visibility = BRUME_SKY_BAKED;
    for (uint8_t filter = 0; filter < 3; filter++) {
        struct brume_scene s = lit_one_sample(v, W, H, &l);
        s.filter = filter;
        lit_march(&frame, v, &s, first);
        for (int i = 0; i < RAYS; i++) {
            double p[3], range;
            if (first[i].transmittance != 0)
                continue;
            lit_sample_position(&s, i % W, i / W, p);
            double want = baked_at(&v->volume, p, &range);
            double off = fabs(first[i].light / 65536.0 - want);
            worst = fmax(worst, off - 3 * range / 256 - ldexp(2, -16));
            rays++;
        }
    }
    tap_check(worst <= 0 && rays > RAYS / 2,
              "%s, baked: %d rays see what is between the cells' bytes",
              v->name, rays);
}

int main(void)
{
    for (int i = 0; i < 2; i++) {
        struct lit_volume v = lit_cloud(3 * i + 1);
        check_furnace(&v);
        check_axes(&v);
        check_equal_cube(&v);
        check_baked(&v);
        lit_volume_free(&v);
    }
    check_gradient();
    check_one_way();
    check_all_ways();
    return tap_done();
}
