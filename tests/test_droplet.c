/* SPDX-License-Identifier: MIT */
/*
 * The droplets' fits: their values, worked out apart from the program; that
 * they are what the core takes; and the mean cosine, which for cloud droplets
 * in visible light is known to be near 0.86.
 */
#include "tap.h"

#include "droplet.h"

#include <math.h>
#include <stddef.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))

static void test_values(void)
{
    static const struct {
        double diameter;
        struct droplet fit;
    } k_want[] = {
        {0.05, {0.034500, 0.025661, 250, 0.252181}},
        {0.1, {0.138000, 0.091768, 250, 0.237291}},
        {0.5, {0.793295, 0.718333, 250, 0.404244}},
        {1, {0.862000, 0.506916, 250, 0.240759}},
        {1.5, {0.838491, 0.312618, 250, 0.209995}},
        {2, {0.918084, 0.387490, 11.379178, 0.412068}},
        {4, {0.960015, 0.479359, 16.441606, 0.417044}},
        {5, {0.970678, 0.508342, 17.068098, 0.447829}},
        {10, {0.988177, 0.555671, 21.995521, 0.481955}},
        {20, {0.994610, 0.593791, 27.113694, 0.498159}},
        {50, {0.997952, 0.625084, 32.315428, 0.507618}},
    };
    for (size_t i = 0; i < COUNT(k_want); i++) {
        struct droplet got = droplet_fit(k_want[i].diameter);
        const struct droplet *want = &k_want[i].fit;
        tap_check(fabs(got.g_hg - want->g_hg) < 1e-6 &&
                      fabs(got.g_draine - want->g_draine) < 1e-6 &&
                      fabs(got.alpha - want->alpha) < 1e-6 &&
                      fabs(got.weight - want->weight) < 1e-6,
                  "%g um: g %.6f, Draine's %.6f, alpha %.6f, weight %.6f",
                  k_want[i].diameter, got.g_hg, got.g_draine, got.alpha,
                  got.weight);
    }
}

/* What the core refuses must not come from any size. */
static void test_range(void)
{
    int bad = 0;
    for (double d = DROPLET_MIN; d <= DROPLET_MAX; d *= 1.0005) {
        struct droplet fit = droplet_fit(d);
        bad += !(fabs(fit.g_hg) <= 0.999 && fabs(fit.g_draine) <= 0.999 &&
                 fit.alpha >= 0 && fit.alpha <= 1024 && fit.weight >= 0 &&
                 fit.weight <= 1);
    }
    tap_check(bad == 0, "every size is within the core's ranges (%d not)", bad);
}

/* Mean cosine of Draine's function: his equation for <cos>. */
static double mean_cosine(const struct droplet *f)
{
    double g = f->g_draine, a = f->alpha;
    double draine =
        g * (1 + a * (3 + 2 * g * g) / 5) / (1 + a * (1 + 2 * g * g) / 3);
    return f->weight * draine + (1 - f->weight) * f->g_hg;
}

static void test_mean_cosine(void)
{
    double before = 0;
    int falls = 0;
    for (double d = 5; d <= DROPLET_MAX; d *= 1.01) {
        struct droplet fit = droplet_fit(d);
        double mean = mean_cosine(&fit);
        falls += mean < before;
        before = mean;
    }
    struct droplet small = droplet_fit(5), cloud = droplet_fit(10);
    struct droplet least = droplet_fit(DROPLET_MIN);
    tap_check(falls == 0 && before > 0.88 && before < 0.90 &&
                  mean_cosine(&small) > 0.84 &&
                  fabs(mean_cosine(&cloud) - .864) < .002,
              "mean cosine of 5 .. 50 um rises from %.3f over %.3f to %.3f",
              mean_cosine(&small), mean_cosine(&cloud), before);
    tap_check(mean_cosine(&least) < 0.05, "of 0.05 um it is %.3f",
              mean_cosine(&least));
}

int main(void)
{
    test_values();
    test_range();
    test_mean_cosine();
    return tap_done();
}
