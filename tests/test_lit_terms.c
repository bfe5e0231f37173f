/* SPDX-License-Identifier: MIT */
/*
 * Terms of a lit ray's light, each alone against docs/light.md in double: the
 * phase function of the angle to the sun, colours and haze.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "brume_noise_tables.h"
#include "support/lit.h"
#include "tap.h"

#define ONE 0x10000u
#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

enum { W = 48, H = 36, RAYS = W * H };

static struct brume_frame frame;
static struct brume_radiance first[RAYS], second[RAYS];

/// Phase functions ///

/* 1 - cos to the sun, which nothing cancels in. */
static double turned(const struct brume_scene *s, const double ray[3])
{
    const int32_t *n = s->sun;
    double length =
        sqrt((double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2]);
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += (ray[i] - n[i] / length) * (ray[i] - n[i] / length);
    return sum / 2;
}

static double henyey_greenstein(double g, double u)
{
    double way = (1 - g) * (1 - g) + 2 * g * u;
    return (1 - g * g) / (way * sqrt(way));
}

static void build(struct brume_phase *out, double g)
{
    const struct brume_phase_model m = {.g = (int32_t)lrint(ldexp(g, 30))};
    if (brume_phase_build(out, &m, 0, 0) != BRUME_OK)
        abort();
}

/* All rays with P or without (NULL), of an extinction, times a factor in
 * Q16.16 up to 256. */
static void march_phase(const struct lit_volume *v, struct brume_scene *s,
                        const struct brume_phase *p, double extinction,
                        uint32_t factor, struct brume_radiance *out)
{
    struct brume_lighting l = lit_white();
    l.phase = p;
    for (int c = 0; c < 3; c++)
        l.sun_colour[c] = factor > 16 * ONE ? 16 * ONE : factor;
    l.exposure = factor > 16 * ONE ? factor / 16 : 0;
    s->density_scale = (uint64_t)(extinction * 4294967296.0);
    s->lighting = &l;
    lit_march(&frame, v, s, out);
}

/* The largest error of P over the rays of a frame. Through what is opaque,
 * light is P, at 256 times for what is dark; P above 7 is seen through what is
 * thin, against light without P. Each has at least 1000 codes, and each is
 * wrong by half a one at most: 0.05 %, besides the 0.5 % of the tables. */
static double phase_error(const struct lit_volume *v, struct brume_scene *s,
                          double g, int *rays)
{
    static struct brume_radiance thin[RAYS], flat[RAYS], dark[RAYS];
    static struct brume_phase table;
    double worst = 0;
    build(&table, g);
    march_phase(v, s, &table, 4.0, ONE, first);
    march_phase(v, s, &table, 4.0, 256 * ONE, dark);
    march_phase(v, s, &table, 1.0 / 65536, ONE, thin);
    march_phase(v, s, NULL, 1.0 / 65536, 256 * ONE, flat);
    for (int i = 0; i < s->width * s->height; i++) {
        double ray[3], have = first[i].light / 65536.0;
        uint32_t codes = first[i].light;
        lit_ray(s, i % s->width, i / s->width, ray);
        double want = henyey_greenstein(g, turned(s, ray));
        if (first[i].transmittance != 0 || thin[i].light >= BRUME_MAX_LIGHT)
            continue; /* not opaque; the very peak, see below */
        if (want > 7) {
            have = 256.0 * thin[i].light / flat[i].light;
            codes = flat[i].light;
        } else if (want < 0.03) {
            have = dark[i].light / 65536.0 / 256;
            codes = dark[i].light;
        }
        worst = fmax(worst, fabs(have / want - 1));
        if (codes < 1000)
            return 1;
        ++*rays;
    }
    return worst;
}

static void check_phases(void)
{
    static const double k_g[] = {0, 0.3, -0.3, 0.85, 0.99, -0.99, 0.999};
    struct lit_volume v =
        lit_block((const int[]){8, 8, 8}, (const int[]){0, 0, 0},
                  (const int[]){64, 64, 64}, 65280);
    for (int i = 0; i < COUNT(k_g); i++)
        for (int to = 1; to >= -1; to -= 2) {
            struct brume_scene s = lit_scene(&v, 41, 31, NULL);
            int rays = 0;
            s.light = BRUME_NO_LIGHT;
            for (int a = 0; a < 3; a++) /* the middle ray's own direction */
                s.sun[a] = to * (s.target[a] - s.eye[a]);
            double worst = phase_error(&v, &s, k_g[i], &rays);
            tap_check(worst < 0.0055 && rays > 900,
                      "g %g, %s the sun: P of %d rays within %.3f %%", k_g[i],
                      to > 0 ? "towards" : "away from", rays, 100 * worst);
        }
    lit_volume_free(&v);
}

/* The one ray that looks straight at the sun, or away from it: P(1) = (1 + g) /
 * (1 - g)^2 is seen in a sheet of one sample, which takes away so little that
 * light is about 4. */
static void check_peaks(void)
{
    static const double k_g[] = {0.85, 0.99, -0.99, 0.999, -0.999};
    static struct brume_phase table;
    struct lit_volume v =
        lit_block((const int[]){3, 3, 3}, (const int[]){0, 0, 12},
                  (const int[]){24, 24, 13}, 65280);
    for (int i = 0; i < COUNT(k_g); i++) {
        double g = fabs(k_g[i]), peak = (1 + g) / ((1 - g) * (1 - g));
        double extinction = 4 / peak;
        struct brume_scene s = lit_scene(&v, 1, 1, NULL);
        for (int a = 0; a < 3; a++)
            s.eye[a] = s.target[a] = 12 * (int32_t)ONE;
        s.eye[2] = -40 * (int32_t)ONE;
        s.light = BRUME_NO_LIGHT;
        for (int a = 0; a < 3; a++)
            s.sun[a] = (s.target[a] - s.eye[a]) * (k_g[i] > 0 ? 1 : -1);
        build(&table, k_g[i]);
        march_phase(&v, &s, &table, extinction, ONE, first);
        double have = first[0].light / 65536.0 / -expm1(-extinction);
        tap_check(fabs(have / peak - 1) < 0.005,
                  "g %g, straight at its peak: %.1f, exactly %.1f", k_g[i],
                  have, peak);
    }
    lit_volume_free(&v);
}

/* Exposure is part of the light that is at most 8: a bright sun, seen with a
 * small exposure, is not cut before. */
static void check_exposed_peak(void)
{
    static struct brume_phase table;
    struct brume_lighting l = lit_white();
    struct lit_volume v =
        lit_block((const int[]){3, 3, 3}, (const int[]){0, 0, 0},
                  (const int[]){24, 24, 24}, 65280);
    struct brume_scene s = lit_scene(&v, 1, 1, &l);
    double peak = 1.85 / (0.15 * 0.15); /* 82.2 */
    build(&table, 0.85);
    s.light = BRUME_NO_LIGHT;
    s.density_scale = BRUME_Q32(4);
    for (int a = 0; a < 3; a++)
        s.sun[a] = s.target[a] - s.eye[a];
    l.phase = &table;
    l.exposure = ONE / 32;
    lit_march(&frame, &v, &s, first);
    double have = first[0].light / 65536.0 * 32;
    tap_check(fabs(have / peak - 1) < 0.005,
              "opaque, exposure 1/32, g 0.85 at its peak: %.2f, exactly %.2f",
              have, peak);
    lit_volume_free(&v);
}

/// Colour ///

static uint32_t channel(const struct brume_radiance *r, int c)
{
    return c == 0 ? r->light : c == 1 ? r->green : r->blue;
}

/* A number of 64ths, up to 16. */
static uint32_t random_colour(uint32_t *seed)
{
    return lit_random(seed) % 1025 * (ONE / 64);
}

/* The light of the sun (`which` -1) or of one ambient colour alone, of
 * brightness 1. */
static void march_term(const struct lit_volume *v, struct brume_scene s,
                       struct brume_lighting l, int which,
                       struct brume_radiance *out)
{
    for (int i = 0; i < 18; i++)
        l.ambient_colour[i / 3][i % 3] = i / 3 == which ? ONE : 0;
    for (int c = 0; c < 3; c++)
        l.sun_colour[c] = which < 0 ? ONE : 0;
    l.exposure = 0;
    s.albedo = ONE;
    s.lighting = &l;
    lit_march(&frame, v, &s, out);
}

/* Every channel is the sum of its terms, each times a factor of colour, albedo
 * and exposure, at most 8. A term of brightness 1 is half a code wrong, hence
 * half the factor; the factor is up to 2 codes too small, times light that is
 * at most 1; and a term is rounded to half a code. */
static double colour_excess(const struct lit_volume *v, uint32_t seed,
                            int *bright)
{
    static struct brume_radiance term[7][RAYS];
    struct brume_lighting l = lit_white();
    struct brume_scene s = lit_scene(v, W, H, &l);
    double excess = -HUGE_VAL;
    l.ambient = (uint8_t)(seed % 4);
    l.visibility = BRUME_SKY_SAMPLED;
    l.visibility_samples = 4;
    l.visibility_step = ONE;
    l.directions = &brume_noise_hemisphere;
    for (int c = 0; c < 3; c++)
        l.sun_colour[c] = random_colour(&seed);
    for (int i = 0; i < 18; i++)
        l.ambient_colour[i / 3][i % 3] = random_colour(&seed);
    l.exposure = 0x100 + lit_random(&seed) % 0x18000u;
    s.albedo = lit_random(&seed) % (ONE + 1);
    for (int j = -1; j < 6; j++)
        march_term(v, s, l, j, term[j + 1]);
    lit_march(&frame, v, &s, first);
    for (int i = 0; i < 3 * RAYS; i++) {
        double want = 0, slack = 0;
        for (int j = -1; j < 6; j++) {
            uint32_t light = term[j + 1][i / 3].light;
            uint32_t colour =
                j < 0 ? l.sun_colour[i % 3] : l.ambient_colour[j][i % 3];
            double factor =
                colour / 65536.0 * l.exposure / 65536.0 * s.albedo / 65536.0;
            want += light * factor;
            slack += factor / 2 + 0.5 + 2.0 * light / 65536;
        }
        want = fmin(want, BRUME_MAX_LIGHT);
        *bright += want == BRUME_MAX_LIGHT;
        excess =
            fmax(excess, fabs(channel(&first[i / 3], i % 3) - want) - slack);
    }
    return excess;
}

static void check_colours(const struct lit_volume *v)
{
    double excess = -HUGE_VAL;
    int bright = 0;
    for (uint32_t n = 0; n < 40; n++)
        excess = fmax(excess, colour_excess(v, n, &bright));
    tap_check(excess <= 0 && bright > 100,
              "40 random colours: channels are sums of grey terms (excess "
              "%.2f codes; %d at the limit of 8)",
              excess, bright);
}

/* Red and green of a sun whose blue differs are the grey sun's light. */
static void check_grey(const struct lit_volume *v)
{
    struct brume_lighting l = lit_white();
    struct brume_scene s = lit_scene(v, W, H, &l);
    int differ = 0, zero = 0, hit = 0;
    for (int i = 0; i < 18; i++)
        l.ambient_colour[i / 3][i % 3] = 60000;
    for (l.ambient = 0; l.ambient <= BRUME_AMBIENT_CUBE; l.ambient++) {
        l.sun_colour[2] = ONE;
        lit_march(&frame, v, &s, first);
        l.sun_colour[2] = 1;
        lit_march(&frame, v, &s, second);
        for (int i = 0; i < RAYS; i++) {
            differ += first[i].light != second[i].light ||
                      first[i].light != second[i].green ||
                      first[i].transmittance != second[i].transmittance ||
                      first[i].depth != second[i].depth;
            zero += (first[i].green | first[i].blue) != 0;
            hit += second[i].blue < second[i].green;
        }
    }
    tap_check(differ == 0 && zero == 0 && hit > RAYS / 10,
              "channels alike are the grey light (%d differ)", differ);
}

/// Haze ///

/* One ray with haze against that without, which has depth and light; in codes
 * beyond the bound: half a one of either image, 2^-15 of exp's tables, tau
 * rounded to 2^-12, and depth to 2^-11 of itself. */
static double haze_excess(const struct brume_radiance *clear,
                          const struct brume_radiance *hazy, uint32_t haze)
{
    uint32_t code = clear->depth;
    if (code == 65535)
        return memcmp(clear, hazy, sizeof *clear) != 0 ? 1 : -1;
    double d = exp2((code >> 11) - 16.0) * (1 + (code & 2047) / 2048.0);
    double x = d * 65536 / haze, w = exp(-x);
    double slack = w * (x * ldexp(1, -11) + ldexp(1, -12)) + ldexp(1, -15);
    double lost = 65536.0 - clear->transmittance;
    double off = fabs(65536.0 - hazy->transmittance - lost * w);
    double excess = off - lost * slack - 1;
    for (int c = 0; c < 3; c++) {
        double light = channel(clear, c);
        off = fabs(channel(hazy, c) - light * w);
        excess = fmax(excess, off - light * slack - 1);
    }
    return excess;
}

static void check_haze(const struct lit_volume *v)
{
    static const uint32_t k_haze[] = {ONE,       3 * ONE,    30 * ONE + 777,
                                      70 * ONE,  4000 * ONE, 0x7fff * ONE,
                                      0xffffffff};
    struct brume_lighting l = lit_white();
    struct brume_scene s = lit_scene(v, W, H, &l);
    double excess = -HUGE_VAL;
    int between = 0;
    l.sun_colour[0] = 7 * ONE;
    lit_march(&frame, v, &s, first);
    for (int n = 0; n < COUNT(k_haze); n++) {
        l.haze = k_haze[n];
        lit_march(&frame, v, &s, second);
        for (int i = 0; i < RAYS; i++) {
            excess = fmax(excess, haze_excess(&first[i], &second[i], l.haze));
            between += second[i].light > first[i].light / 8 &&
                       second[i].light < first[i].light / 2;
        }
    }
    tap_check(excess <= 0 && between > RAYS / 10,
              "haze: light * w, 1 - w (1 - T) (excess %.2f codes)", excess);
}

int main(void)
{
    struct lit_volume v = lit_cloud(1);
    check_phases();
    check_peaks();
    check_exposed_peak();
    check_colours(&v);
    check_grey(&v);
    check_haze(&v);
    lit_volume_free(&v);
    return tap_done();
}
