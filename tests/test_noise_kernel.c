/* SPDX-License-Identifier: MIT */
/* The integer kernels of the noise tables, against their definitions in
 * double. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kernel.h"
#include "tap.h"

#define WIDTH 32
#define FRAMES 16

static void test_exp(void)
{
    double worst = 0;

    for (uint64_t x = 0; x < UINT64_C(40) << 31; x += 1234567u) {
        double error = fabs(kernel_exp(x) - 0x1p31 * exp(-(double)x * 0x1p-31));
        worst = error > worst ? error : worst;
    }
    tap_check(worst < 0x1p4, "kernel_exp: error %.2g < 2^-27", worst * 0x1p-31);
}

/* The filters' taps, centre at [32]. */
static void taps_of(const char *name, double taps[65])
{
    double sigma = strchr(name, ':') ? atof(strchr(name, ':') + 1) : 1.0;
    double total = 0;

    memset(taps, 0, 65 * sizeof *taps);
    if (!strncmp(name, "box", 3)) {
        int radius = atoi(name + 3) / 2;
        for (int i = -radius; i <= radius; i++)
            taps[32 + i] = 1.0 / (2 * radius + 1);
    } else if (!strncmp(name, "binomial", 8)) {
        static const double five[] = {0.0625, 0.25, 0.375, 0.25, 0.0625};
        static const double three[] = {0.25, 0.5, 0.25};
        bool wide = name[8] == '5';
        memcpy(taps + (wide ? 30 : 31), wide ? five : three,
               (wide ? 5 : 3) * sizeof *taps);
    } else if (!strncmp(name, "gauss", 5)) {
        double scale = sqrt(0.5) / sigma;
        for (int i = 0; total < 0.995; i++) {
            taps[32 + i] = taps[32 - i] =
                0.5 * (erf(scale * (i + 0.5)) - erf(scale * (i - 0.5)));
            total += (i ? 2 : 1) * taps[32 + i];
        }
    } else {
        taps[32] = 1;
    }
}

static void space_of(const char *name, double out[WIDTH])
{
    double taps[65];

    taps_of(name, taps);
    memset(out, 0, WIDTH * sizeof *out);
    for (int i = 0; i < 65; i++)
        for (int j = 0; j < 65; j++)
            out[(i - j) & (WIDTH - 1)] += taps[i] * taps[j];
}

/* Eq. 14-17 of Donnelly et al. 2024, m frames with their weight. */
static void history_of(double alpha, double beta, double out[FRAMES])
{
    double total = 0;

    memset(out, 0, FRAMES * sizeof *out);
    for (int m = 1; m <= FRAMES; m++)
        total += beta > 0 ? beta * pow(1 - beta, m - 1) : 1;
    for (int m = 1; m <= FRAMES; m++) {
        double share = (beta > 0 ? beta * pow(1 - beta, m - 1) : 1) / total;
        for (int i = 0; i < m; i++)
            for (int j = 0; j < m; j++) {
                double a = pow(1 - alpha, i) * (i < m - 1 ? alpha : 1);
                double b = pow(1 - alpha, j) * (j < m - 1 ? alpha : 1);
                out[(i - j) & (FRAMES - 1)] += share * a * b;
            }
    }
}

static void time_of(const char *name, double out[FRAMES])
{
    double alpha = 0, beta = -1;

    if (!strncmp(name, "ema:", 4)) {
        const char *comma = strchr(name, ',');
        alpha = atof(name + 4);
        beta = comma ? atof(comma + 1) : -1;
    }
    if (beta >= 0) {
        history_of(alpha, beta, out);
    } else if (alpha > 0) {
        memset(out, 0, FRAMES * sizeof *out);
        for (int d = -1000; d <= 1000; d++)
            out[d & (FRAMES - 1)] += pow(1 - alpha, abs(d));
    } else {
        memset(out, 0, FRAMES * sizeof *out);
        out[0] = 1;
    }
}

/* The largest difference to the definition, relative to the centre. */
static double worst_error(const struct kernel *k, const char *space,
                          const char *time, double product, double w, double v)
{
    double s[WIDTH], t[FRAMES], worst = 0;
    const int32_t *weight = k->weight;
    int32_t centre = weight[-k->top * (int32_t)k->cols - k->left];

    space_of(space, s);
    time_of(time, t);
    for (uint32_t z = 0; z < k->frames; z++)
        for (uint32_t j = 0; j < k->rows; j++)
            for (uint32_t i = 0; i < k->cols; i++) {
                uint32_t x = i + (uint32_t)k->left, y = j + (uint32_t)k->top;
                double here =
                    s[x & (WIDTH - 1)] * s[y & (WIDTH - 1)] / (s[0] * s[0]);
                double expected = product * here * t[z] / t[0] +
                                  (!z ? v * here : 0) +
                                  (!x && !y ? w * t[z] / t[0] : 0);
                double error = fabs((double)*weight++ / centre -
                                    expected / (product + w + v));
                worst = error > worst ? error : worst;
            }
    return worst;
}

static void test_kernel(const char *space, const char *time,
                        const char *combine, double product, double w, double v)
{
    struct kernel_spec spec = {.values = 1};
    struct kernel k;
    int64_t sum = 0;

    if (!tap_check(kernel_parse_space(space, &spec.space) &&
                       kernel_parse_time(time, &spec.time) &&
                       kernel_parse_combine(combine, &spec) &&
                       kernel_make(&k, &spec, WIDTH, WIDTH, FRAMES),
                   "%s %s %s is made", space, time, combine))
        return;
    double error = worst_error(&k, space, time, product, w, v);
    tap_check(error < 0x1p-17, "its entries: error %.2g < 2^-17", error);
    bool positive = true;
    for (size_t i = 0; i < (size_t)k.frames * k.rows * k.cols; i++) {
        sum += k.weight[i];
        positive = positive && k.weight[i] >= 0;
    }
    tap_check(positive && sum < 1 << 29, "none is below 0, their sum < 2^29");
    kernel_free(&k);
}

int main(void)
{
    test_exp();
    test_kernel("gauss1", "ema:0.1,0.1", "product", 1, 0, 0);
    test_kernel("gauss:0.8", "ema:0.15", "hybrid:0.6,0.5", 1, 0.6, 0.5);
    test_kernel("gauss:0.3", "ema:0.5,0", "hybrid:2", 1, 2, 0);
    test_kernel("gauss:5.5", "ema:0.1,0.02", "product", 1, 0, 0);
    test_kernel("binomial3", "ema:0.1,0.1", "separate:6", 0, 6, 1);
    test_kernel("binomial5", "none", "product", 1, 0, 0);
    test_kernel("box3", "ema:1", "product", 1, 0, 0);
    test_kernel("box5", "ema:0.02,0.5", "hybrid:0.01", 1, 0.01, 0);
    test_kernel("none", "ema:0.1", "product", 1, 0, 0);
    return tap_done();
}
