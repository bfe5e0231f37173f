/* SPDX-License-Identifier: MIT */
/*
 * noise_march VOLUME.brume primary|light STEP [NOISE]...: how much of the
 * error of a jittered march each noise leaves after accumulation over time and
 * a filter over the image, relative to white noise. The integrands are real:
 * every pixel is rendered with each of 256 jitters, and a noise then only
 * chooses among them. Prints how the integrands correlate, too: tables are
 * optimised for Heaviside integrands, and docs/noise.md says how these differ.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "brume_inner.h"
#include "noises.h"
#include "volume_file.h"

#define W 256
#define H 192
#define PIXELS (W * H)
#define FRAMES 96 /* enough for the start to be forgotten: 0.9^96 = 4e-5 */
#define STARTS 8  /* of the noise's frames, evenly spread over 64 */
#define ALPHA 0.1f
#define FILTERS 5
#define COLUMNS (1 + FILTERS)

static float integrand[PIXELS][256]; /* less its mean */

/// Integrands ///

static void render_all(const struct brume_volume *v, int jitter, double step)
{
    static uint8_t values[64];
    static uint16_t pixels[PIXELS];
    static struct brume_frame frame;
    const struct brume_noise_table table = {values, 3, 3, 0, 8};
    struct brume_scene s;
    brume_scene_default(&s, v);
    s.width = W;
    s.height = H;
    s.fov = 26 << 16;
    s.output = BRUME_LINEAR;
    s.light = BRUME_LOG;
    s.light_step = 0x10000;
    s.light_samples = 8;
    s.step = (uint32_t)(step * 65536);
    s.min_transmittance = 0;
    s.background[0] = 0;
    s.jitter = (uint8_t)jitter;
    s.noise = BRUME_NOISE_TABLE;
    s.noise_table = &table;
    for (int k = 0; k < 256; k++) {
        memset(values, k, sizeof values);
        int error = brume_begin_frame(&frame, v, &s);
        if (error == BRUME_OK)
            error =
                brume_render_rect(&frame, 0, 0, W, H, BRUME_L16, pixels, W * 2);
        if (error != BRUME_OK) {
            fprintf(stderr, "noise_march: %s\n", brume_error_text(error));
            exit(1);
        }
        for (int i = 0; i < PIXELS; i++)
            integrand[i][k] = (float)pixels[i] / 65535;
    }
}

/* Takes the means off. Returns the standard deviation over pixels and jitters:
 * the error of one frame of white noise. */
static double centre(void)
{
    double square = 0;
    for (int i = 0; i < PIXELS; i++) {
        double mean = 0;
        for (int k = 0; k < 256; k++)
            mean += integrand[i][k] / 256;
        for (int k = 0; k < 256; k++) {
            integrand[i][k] -= (float)mean;
            square += (double)integrand[i][k] * integrand[i][k];
        }
    }
    return sqrt(square / PIXELS / 256);
}

/* E f(x) f(x + lag) / E f(x)^2, x and x + lag in [0, 1): 1/3 - max(x, y) +
 * (x^2 + y^2) / 2, times 6, for Heaviside integrands. */
static void print_correlation(void)
{
    double f2 = 0;
    for (int i = 0; i < PIXELS; i++)
        for (int k = 0; k < 256; k++)
            f2 += (double)integrand[i][k] * integrand[i][k] / 256;
    printf("lag        ");
    for (int lag = 0; lag < 256; lag += 16)
        printf(" %5.2f", lag / 256.0);
    printf("\nmarch      ");
    for (int lag = 0; lag < 256; lag += 16) {
        double sum = 0;
        for (int i = 0; i < PIXELS; i++)
            for (int k = 0; k + lag < 256; k++)
                sum += (double)integrand[i][k] * integrand[i][k + lag];
        printf(" %5.2f", sum / (256 - lag) / f2);
    }
    printf("\nHeaviside  ");
    for (int lag = 0; lag < 256; lag += 16) {
        double sum = 0;
        for (int k = 0; k + lag < 256; k++) {
            double x = (k + 0.5) / 256, y = (k + lag + 0.5) / 256;
            sum += 2 - 6 * y + 3 * (x * x + y * y);
        }
        printf(" %5.2f", sum / (256 - lag));
    }
    printf("\n\n");
}

/// Filters ///

static const struct {
    const char *name;
    int radius;
    float weight[4]; /* of distances 0 .. radius */
} k_filter[FILTERS] = {
    {"ema", 0, {1}},
    {"+gauss1", 3, {0.39905f, 0.24204f, 0.05401f, 0.00443f}},
    {"+binomial3", 1, {0.5f, 0.25f}},
    {"+box3", 1, {1 / 3.0f, 1 / 3.0f}},
    {"+box5", 2, {0.2f, 0.2f, 0.2f}},
};

static int clamped(int i, int n)
{
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}

/* Mean square of the filtered picture. */
static double filtered(const float *in, int filter)
{
    static float rows[PIXELS];
    const float *weight = k_filter[filter].weight;
    int radius = k_filter[filter].radius;
    double square = 0;
    for (int i = 0; i < PIXELS; i++) {
        int x = i % W, y = i / W;
        rows[i] = 0;
        for (int d = -radius; d <= radius; d++)
            rows[i] += weight[abs(d)] * in[y * W + clamped(x + d, W)];
    }
    for (int i = 0; i < PIXELS; i++) {
        int x = i % W, y = i / W;
        float sum = 0;
        for (int d = -radius; d <= radius; d++)
            sum += weight[abs(d)] * rows[clamped(y + d, H) * W + x];
        square += (double)sum * sum;
    }
    return square / PIXELS;
}

/// Noises ///

static void accumulate(const struct brume_scene *s, uint32_t channel,
                       uint32_t first, double square[COLUMNS])
{
    static float history[PIXELS];
    for (uint32_t f = 0; f < FRAMES; f++) {
        for (uint32_t i = 0; i < PIXELS; i++) {
            uint32_t j = brume_noise_value(s->noise, s->noise_table, i % W,
                                           i / W, first + f, channel);
            float now = integrand[i][j >> 8];
            history[i] = f ? history[i] + ALPHA * (now - history[i]) : now;
        }
        if (f == 0)
            square[0] += filtered(history, 1);
    }
    for (int k = 0; k < FILTERS; k++)
        square[1 + k] += filtered(history, k);
}

static int choose(struct brume_scene *s, const char *name)
{
    char err[512];
    if (noise_is_file(name)) {
        s->noise = BRUME_NOISE_TABLE;
        s->noise_table = noise_read(name, err, sizeof err);
        if (s->noise_table != NULL)
            return 0;
        fprintf(stderr, "noise_march: %s\n", err);
        return -1;
    }
    size_t n = strlen(name);
    unsigned number = 0;
    for (const char *w = noise_words; *w; number++) {
        size_t length = strcspn(w, " ");
        if (length == n && strncmp(w, name, n) == 0) {
            noise_choose(number, s);
            return 0;
        }
        w += length;
        w += strspn(w, " ");
    }
    fprintf(stderr, "noise_march: no noise is called %s\n", name);
    return -1;
}

static int print_row(const char *name, uint32_t channel)
{
    static double white[COLUMNS];
    double square[COLUMNS] = {0};
    struct brume_scene s;
    if (choose(&s, name) != 0)
        return -1;
    for (uint32_t start = 0; start < STARTS; start++)
        accumulate(&s, channel, 8 * start, square);
    if (white[0] == 0)
        memcpy(white, square, sizeof white);
    printf("%-24.24s", name);
    for (int k = 0; k < COLUMNS; k++)
        printf(" %10.3f", sqrt(square[k] / white[k]));
    printf("\n");
    return 0;
}

int main(int argc, char **argv)
{
    struct volume_file file;
    char err[512];
    int light = argc > 2 && strcmp(argv[2], "light") == 0;
    double step = argc > 3 ? atof(argv[3]) : 0;
    if (argc < 4 || step < 1.0 / 16 || step > 256 ||
        (!light && strcmp(argv[2], "primary") != 0)) {
        fprintf(stderr, "usage: noise_march VOLUME.brume primary|light STEP "
                        "[NOISE]...\n");
        return 2;
    }
    if (volume_file_open(&file, argv[1], err, sizeof err) != 0) {
        fprintf(stderr, "noise_march: %s\n", err);
        return 1;
    }
    render_all(&file.volume, light ? BRUME_JITTER_LIGHT : BRUME_JITTER_PRIMARY,
               step);
    printf("one frame of white noise: %.5f of white\n\n", centre());
    print_correlation();
    printf("%-24s %10s", "", "one+gauss1");
    for (int k = 0; k < FILTERS; k++)
        printf(" %10s", k_filter[k].name);
    printf("\n");
    int bad = print_row("white", (uint32_t)light);
    for (int i = 4; i < argc; i++)
        bad |= print_row(argv[i], (uint32_t)light);
    volume_file_close(&file);
    return bad != 0;
}
