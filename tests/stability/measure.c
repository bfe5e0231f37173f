/* SPDX-License-Identifier: MIT */
#include <math.h>

#include "stability.h"

#define W STABILITY_WIDTH
#define H STABILITY_HEIGHT

/* Difference of two codes in 1/255. */
static double difference(uint16_t a, uint16_t b)
{
    return ((double)a - b) / 257;
}

static double worst_tile(const picture_t a, const picture_t b)
{
    double worst = 0;
    for (int tile = 0; tile < (W + 7) / 8 * ((H + 7) / 8); tile++) {
        int x = tile % ((W + 7) / 8) * 8, y = tile / ((W + 7) / 8) * 8;
        double sum = 0;
        int n = 0;
        for (int j = y; j < y + 8 && j < H; j++)
            for (int i = x; i < x + 8 && i < W; i++, n++) {
                double d = difference(a[j * W + i], b[j * W + i]);
                sum += d * d;
            }
        worst = fmax(worst, sum / n);
    }
    return sqrt(worst);
}

/* Projection of the picture's gradients on the truth's. Noise, which is as
 * often along as against them, does not count. */
static double sharpness(const picture_t a, const picture_t b)
{
    double both = 0, truth = 0;
    for (int y = 0; y + 1 < H; y++)
        for (int x = 0; x + 1 < W; x++) {
            int i = y * W + x;
            double ax = (double)a[i + 1] - a[i], ay = (double)a[i + W] - a[i];
            double bx = (double)b[i + 1] - b[i], by = (double)b[i + W] - b[i];
            both += ax * bx + ay * by;
            truth += bx * bx + by * by;
        }
    return truth > 0 ? both / truth : 1;
}

static void add_picture(struct measure *m, const picture_t picture,
                        const picture_t truth, int count)
{
    double n = (double)STABILITY_PIXELS * count;
    for (int i = 0; i < STABILITY_PIXELS; i++) {
        double d = difference(picture[i], truth[i]);
        m->ghosting += fabs(d) / n;
        m->error += d * d / n;
        m->bias += d / n;
    }
    m->tile = fmax(m->tile, worst_tile(picture, truth));
    m->sharpness += sharpness(picture, truth) / count;
}

/* Root of the mean, over pixels, of the variance over time. */
static double deviation_of(const picture_t *pictures, int count)
{
    double variance = 0;
    for (int i = 0; i < STABILITY_PIXELS; i++) {
        double sum = 0, square = 0;
        for (int k = 0; k < count; k++) {
            double d = difference(pictures[k][i], pictures[0][i]);
            sum += d;
            square += d * d;
        }
        variance += square / count - sum / count * sum / count;
    }
    return sqrt(fmax(0, variance) / STABILITY_PIXELS);
}

struct measure measure_of(const picture_t *pictures, const picture_t *truths,
                          int count, bool fixed)
{
    struct measure m = {0};
    for (int k = 0; k < count; k++)
        add_picture(&m, pictures[k], truths[fixed ? 0 : k], count);
    m.error = sqrt(m.error);
    for (int k = 1; k < count; k++)
        for (int i = 0; i < STABILITY_PIXELS; i++) {
            double change = difference(pictures[k][i], pictures[k - 1][i]);
            double wanted =
                fixed ? 0 : difference(truths[k][i], truths[k - 1][i]);
            m.flicker += fabs(change - wanted) / STABILITY_PIXELS / (count - 1);
        }
    if (fixed)
        m.deviation = deviation_of(pictures, count);
    return m;
}
