/* SPDX-License-Identifier: MIT */
/*
 * Metrics against closed forms, and FLIP against values that its authors'
 * program gave for pictures beside the real volumes.
 */
#include "tap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "metrics.h"

#define W 48
#define H 40

static char err[300];

/// Pictures ///

static struct image grey_u8(void)
{
    struct image image;
    if (image_new_u8(&image, W, H, 1, err, sizeof err) != 0)
        abort();
    return image;
}

static struct image grey_f32(void)
{
    struct image image;
    if (image_new_f32(&image, W, H, 1, err, sizeof err) != 0)
        abort();
    return image;
}

static struct image constant(int value)
{
    struct image image = grey_u8();
    memset(image.u8, value, W * H);
    return image;
}

/* Texture from 40 to 200, the same for the same seed. */
static struct image textured(unsigned seed)
{
    struct image image = grey_u8();
    for (int i = 0; i < W * H; i++) {
        seed = seed * 1664525u + 1013904223u;
        image.u8[i] = (uint8_t)(40 + (seed >> 24) % 161);
    }
    return image;
}

static int near(double a, double b, double within)
{
    return fabs(a - b) <= within;
}

/// One picture ///

static struct metrics_error error_of(const struct image *a,
                                     const struct image *b)
{
    struct metrics_error e = {-1, -1, -1, -1, -1};
    if (metrics_error(a, b, &e, err, sizeof err) != 0)
        abort();
    return e;
}

static void test_error(void)
{
    struct image a = textured(1), b = textured(1);
    for (int i = 0; i < W * H; i++)
        b.u8[i] = (uint8_t)(b.u8[i] + 10);
    struct metrics_error e = error_of(&a, &b);
    tap_check(e.rmse == 10 && e.mean == 10 && e.max == 10 &&
                  e.worst_tile == 10 && near(e.psnr, 20 * log10(25.5), 1e-12),
              "an offset of 10: rmse %g, mean %g, psnr %g", e.rmse, e.mean,
              e.psnr);
    e = error_of(&b, &a);
    tap_check(e.mean == -10, "the other way round: mean %g", e.mean);
    image_free(&a);
    image_free(&b);
}

static double sharpness_of(const struct image *a, const struct image *b)
{
    double s = -1;
    if (metrics_sharpness(a, b, &s, err, sizeof err) != 0)
        abort();
    return s;
}

static void test_sharpness(void)
{
    struct image a = textured(2), b = textured(2), flat = constant(90);
    for (int i = 0; i < W * H; i++)
        b.u8[i] = (uint8_t)(b.u8[i] / 2);
    double s = sharpness_of(&a, &a);
    tap_check(s == 1, "sharpness of the same: %g", s);
    s = sharpness_of(&a, &b);
    tap_check(near(s, 0.5, 0.01), "of half the contrast: %g", s);
    s = sharpness_of(&a, &flat);
    tap_check(s == 0, "of nothing: %g", s);
    image_free(&a);
    image_free(&b);
    image_free(&flat);
}

static double ssim_of(const struct image *a, const struct image *b)
{
    double s = -2;
    if (metrics_ssim(a, b, &s, err, sizeof err) != 0)
        return -2;
    return s;
}

/* Of flat images only the term of luminance is left:
 * (2 m n + C1) / (m^2 + n^2 + C1). */
static void test_ssim(void)
{
    const double c1 = 6.5025, c2 = 58.5225;
    struct image a = constant(100), b = constant(120), t = textured(3);
    struct image shifted = textured(3), small = {0};
    double s = ssim_of(&a, &b), wanted = (24000 + c1) / (24400 + c1);
    tap_check(near(s, wanted, 1e-9), "ssim of 100 and 120: %.9f, %.9f", s,
              wanted);
    s = ssim_of(&t, &t);
    tap_check(near(s, 1, 1e-12), "of the same: %.12f", s);
    /* Contrast and structure are kept, luminance 120 becomes 140: fields of a
     * chessboard are far below a window's size. */
    for (int i = 0; i < W * H; i++) {
        t.u8[i] = (i / W + i % W) % 2 ? 100 : 140;
        shifted.u8[i] = (uint8_t)(t.u8[i] + 20);
    }
    s = ssim_of(&t, &shifted);
    wanted = (2 * 120 * 140 + c1) / (120.0 * 120 + 140 * 140 + c1);
    tap_check(near(s, wanted, 1e-6), "of a board shifted by 20: %.8f, %.8f", s,
              wanted);
    double back = ssim_of(&shifted, &t);
    tap_check(near(s, back, 1e-12), "symmetric");
    s = ssim_of(&t, &a);
    wanted =
        (2 * 120 * 100 + c1) / (120.0 * 120 + 100 * 100 + c1) * c2 / (400 + c2);
    tap_check(near(s, wanted, 1e-6), "a board and none: %.8f, %.8f", s, wanted);
    image_new_u8(&small, 10, 30, 1, err, sizeof err);
    tap_check(isnan(ssim_of(&small, &small)), "a side of 10: nan");
    image_free(&a);
    image_free(&b);
    image_free(&t);
    image_free(&shifted);
    image_free(&small);
}

/* An 11x11 image has one window: the formula itself, with two-dimensional
 * weights. */
static void test_ssim_window(void)
{
    struct image a = {0}, b = {0};
    double m[5] = {0}, weights = 0, s;
    image_new_u8(&a, 11, 11, 1, err, sizeof err);
    image_new_u8(&b, 11, 11, 1, err, sizeof err);
    for (int i = 0; i < 121; i++) {
        double x = i % 11 - 5, y = i / 11 - 5;
        double w = exp(-(x * x + y * y) / 4.5);
        a.u8[i] = (uint8_t)(i * 37 % 251);
        b.u8[i] = (uint8_t)(i * 91 % 241);
        weights += w;
        m[0] += w * a.u8[i];
        m[1] += w * b.u8[i];
        m[2] += w * a.u8[i] * a.u8[i];
        m[3] += w * b.u8[i] * b.u8[i];
        m[4] += w * a.u8[i] * b.u8[i];
    }
    for (int k = 0; k < 5; k++)
        m[k] /= weights;
    double covariance = m[4] - m[0] * m[1];
    double wanted = (2 * m[0] * m[1] + 6.5025) * (2 * covariance + 58.5225) /
                    ((m[0] * m[0] + m[1] * m[1] + 6.5025) *
                     (m[2] - m[0] * m[0] + m[3] - m[1] * m[1] + 58.5225));
    s = ssim_of(&a, &b);
    tap_check(near(s, wanted, 1e-9), "ssim of one window: %.9f, %.9f", s,
              wanted);
    image_free(&a);
    image_free(&b);
}

/// FLIP ///

static struct metrics_flip flip_of(const struct image *a, const struct image *b,
                                   bool linear)
{
    struct metrics_flip f = {-1, -1};
    if (metrics_flip(a, b, linear, METRICS_FLIP_DEGREE, &f, NULL, err,
                     sizeof err) != 0)
        f.mean = -1;
    return f;
}

static void test_flip(void)
{
    struct image a = textured(4), b = textured(5), black = constant(0);
    struct image white = constant(255), map = {0};
    struct metrics_flip f = flip_of(&a, &a, false), g;
    double sum = 0, max = 0;
    tap_check(f.mean == 0 && f.max == 0, "flip of the same is 0");
    f = flip_of(&a, &b, false);
    g = flip_of(&b, &a, false);
    tap_check(near(f.mean, g.mean, 1e-12) && near(f.max, g.max, 1e-12) &&
                  f.mean > 0.1,
              "symmetric: %.6f", f.mean);
    /* HyAB of black and white is 100, of green and blue 308.5; Hunt-adjusted
     * and to the power 0.7 these lie on the upper piece of the curve. */
    f = flip_of(&black, &white, false);
    tap_check(f.mean > 0.9 && f.max <= 1 && near(f.mean, f.max, 1e-9),
              "black and white: %.6f everywhere", f.mean);
    if (metrics_flip(&a, &b, false, METRICS_FLIP_DEGREE, &g, &map, err,
                     sizeof err) != 0)
        abort();
    for (int i = 0; i < W * H; i++) {
        sum += (double)map.f32[i] / (W * H);
        max = fmax(max, (double)map.f32[i]);
    }
    tap_check(near(sum, g.mean, 1e-6) && near(max, g.max, 1e-6),
              "a map of mean %.6f and maximum %.6f", sum, max);
    tap_check(metrics_flip(&a, &b, false, 0, &g, NULL, err, sizeof err) != 0,
              "%s", err);
    image_free(&a);
    image_free(&b);
    image_free(&black);
    image_free(&white);
    image_free(&map);
}

/* Linear light is what sRGB codes stand for; floats are as 8 bits are. */
static void test_flip_linear(void)
{
    struct image a = textured(6), b = textured(7), c = grey_f32();
    struct image d = grey_f32(), e = grey_f32();
    struct metrics_flip f = flip_of(&a, &b, false), g;
    for (int i = 0; i < W * H; i++) {
        double s = a.u8[i] / 255.0, t = b.u8[i] / 255.0;
        c.f32[i] = (float)pow((s + 0.055) / 1.055, 2.4);
        d.f32[i] = (float)pow((t + 0.055) / 1.055, 2.4);
        e.f32[i] = (float)t;
    }
    g = flip_of(&c, &d, true);
    tap_check(near(f.mean, g.mean, 1e-6), "linear light: %.6f, %.6f", g.mean,
              f.mean);
    g = flip_of(&a, &e, false);
    tap_check(near(f.mean, g.mean, 1e-6), "8 bits and float: %.6f", g.mean);
    image_free(&a);
    image_free(&b);
    image_free(&c);
    image_free(&d);
    image_free(&e);
}

/* Of README.md beside the pictures; 1e-3 and 5e-3 are its bounds. */
static const struct {
    const char *a, *b;
    double mean, max;
} published[] = {
    {"cloud_ref.pgm", "cloud_step8.pgm", 0.267639, 0.984513},
    {"cloud_ref.pgm", "cloud_nearest.pgm", 0.087783, 0.858322},
    {"cloud_ref.pgm", "cloud_ref.pgm", 0, 0},
    {"grad_ref.ppm", "grad_565.ppm", 0.060611, 0.142968},
    {"grad_ref.ppm", "grad_565_bayer4.ppm", 0.024170, 0.078620},
};

static int find_pictures(char path[400])
{
    const char *data = getenv("DATA");
    char file[500];
    for (int i = 0; i < 2; i++) {
        if (i == 0)
            snprintf(path, 400, "%.300s/../reference/flip",
                     data ? data : "../shared/data");
        else
            snprintf(path, 400, "../shared/reference/flip");
        snprintf(file, sizeof file, "%s/README.md", path);
        if (access(file, R_OK) == 0)
            return 0;
    }
    return -1;
}

static void test_published(void)
{
    char path[400], name[500];
    int found = find_pictures(path) == 0;
    for (size_t i = 0; i < sizeof published / sizeof *published; i++) {
        struct image a = {0}, b = {0};
        struct metrics_flip f = {-1, -1};
        if (!found) {
            tap_skip("FLIP of %s and %s: THE AUTHORS' PAIRS ARE NOT HERE",
                     published[i].a, published[i].b);
            continue;
        }
        snprintf(name, sizeof name, "%s/%s", path, published[i].a);
        int bad = image_read(name, &a, err, sizeof err);
        snprintf(name, sizeof name, "%s/%s", path, published[i].b);
        bad = bad || image_read(name, &b, err, sizeof err);
        if (!bad)
            f = flip_of(&a, &b, false);
        tap_check(!bad && near(f.mean, published[i].mean, 1e-3) &&
                      near(f.max, published[i].max, 5e-3),
                  "FLIP of %s and %s: mean %.6f (%.6f), max %.6f (%.6f)",
                  published[i].a, published[i].b, f.mean, published[i].mean,
                  f.max, published[i].max);
        image_free(&a);
        image_free(&b);
    }
}

/// Maps ///

static void test_maps(void)
{
    struct image a = constant(50), b = constant(50), map = {0}, heat = {0};
    int rises = 1;
    double before = -1;
    b.u8[7] = 101;
    tap_check(metrics_error_map(&a, &b, &map, err, sizeof err) == 0 &&
                  near((double)map.f32[7], 0.2, 1e-7) && map.f32[8] == 0,
              "an error of 51 is 0.2");
    for (int i = 0; i < W * H; i++)
        map.f32[i] = (float)i / (W * H - 1);
    tap_check(metrics_heat(&map, 1, &heat, err, sizeof err) == 0 &&
                  heat.u8[0] == 0 && heat.u8[2] == 4 &&
                  heat.u8[3 * W * H - 3] == 252 &&
                  heat.u8[3 * W * H - 2] == 253,
              "magma from black to pale yellow");
    for (int i = 0; i < W * H; i += W / 2) {
        const uint8_t *p = heat.u8 + 3 * i;
        double luma = 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
        rises = rises && luma > before;
        before = luma;
    }
    tap_check(rises, "ever lighter");
    image_free(&a);
    image_free(&b);
    image_free(&map);
    image_free(&heat);
}

/// Over time ///

typedef double signal_fn(int frame, int pixel);

static double still(int frame, int pixel)
{
    (void)frame;
    return 50 + pixel % 100;
}

/* A pixel's value rises by pixel % 4 a frame. */
static double ramp(int frame, int pixel)
{
    return 20 + frame * (pixel % 4);
}

static double ramp_before(int frame, int pixel)
{
    return ramp(frame - 3, pixel);
}

static double offset(int frame, int pixel)
{
    return still(frame, pixel) + 5;
}

/* +6 and -6 in turns. */
static double blinks(int frame, int pixel)
{
    return still(frame, pixel) + ((frame + pixel) % 2 ? 6 : -6);
}

/* EMA of the ramp with weight a in its steady state is (1 - a) / a frames
 * behind. */
static double ema_ramp(int frame, int pixel)
{
    return ramp(frame, pixel) - 9 * (pixel % 4);
}

static struct metrics_time time_of(signal_fn *reference, signal_fn *picture,
                                   int frames)
{
    struct metrics_sequence s = {0};
    struct metrics_time t;
    struct image a = grey_f32(), b = grey_f32();
    for (int k = 0; k < frames; k++) {
        for (int i = 0; i < W * H; i++) {
            a.f32[i] = (float)(reference(k, i) / 255);
            b.f32[i] = (float)(picture(k, i) / 255);
        }
        if (metrics_add(&s, &a, &b, err, sizeof err) != 0)
            abort();
    }
    metrics_finish(&s, &t);
    metrics_free(&s);
    image_free(&a);
    image_free(&b);
    return t;
}

static void test_time(void)
{
    struct metrics_time t = time_of(still, still, 8);
    tap_check(t.ghosting == 0 && t.flicker == 0 && t.deviation == 0 &&
                  t.lag == 0 && isinf(t.psnr),
              "the same frames");
    t = time_of(still, offset, 8);
    tap_check(near(t.ghosting, 5, 1e-5) && near(t.flicker, 0, 1e-5) &&
                  near(t.deviation, 0, 1e-5),
              "a constant offset: ghosting %.6f, flicker %.6f", t.ghosting,
              t.flicker);
    t = time_of(still, blinks, 8);
    tap_check(near(t.ghosting, 6, 1e-5) && near(t.flicker, 12, 1e-5) &&
                  near(t.deviation, 6, 1e-5) &&
                  near(t.psnr, 20 * log10(255 / 12.0), 1e-5),
              "blinking by 6: flicker %.5f, deviation %.5f, tpsnr %.5f",
              t.flicker, t.deviation, t.psnr);
    t = time_of(ramp, ramp, 8);
    tap_check(t.lag == 0 && t.flicker == 0, "motion without lag");
    t = time_of(ramp, ramp_before, 8);
    tap_check(near(t.lag, 3, 1e-5) && near(t.ghosting, 4.5, 1e-5) &&
                  near(t.flicker, 0, 1e-5),
              "three frames late: lag %.6f, ghosting %.6f", t.lag, t.ghosting);
    t = time_of(ramp, ema_ramp, 8);
    tap_check(near(t.lag, 9, 1e-5), "ema of 0.1: lag %.6f", t.lag);
    t = time_of(still, blinks, 1);
    tap_check(near(t.ghosting, 6, 1e-5) && t.flicker == 0 && isinf(t.psnr),
              "one frame");
}

static void test_sequence_errors(void)
{
    struct metrics_sequence s = {0};
    struct metrics_time t;
    struct image a = constant(1), b = constant(2), c = constant(3);
    struct image rgb = {0};
    image_new_u8(&rgb, W, H, 3, err, sizeof err);
    memset(rgb.u8, 2, 3 * W * H);
    tap_check(metrics_add(&s, &a, &b, err, sizeof err) == 0 &&
                  metrics_add(&s, &a, &rgb, err, sizeof err) == 0,
              "grey, then RGB");
    metrics_finish(&s, &t);
    tap_check(t.ghosting == 1 && t.flicker == 0, "which is the same");
    c.width--;
    tap_check(metrics_add(&s, &a, &c, err, sizeof err) != 0, "%s", err);
    a.width--;
    tap_check(metrics_add(&s, &a, &c, err, sizeof err) != 0, "%s", err);
    a.width++;
    metrics_finish(&s, &t);
    tap_check(s.frames == 2 && t.ghosting == 1, "errors change nothing");
    metrics_free(&s);
    tap_check(s.frames == 0 && s.first == NULL, "empty again");
    image_free(&a);
    image_free(&b);
    image_free(&c);
    image_free(&rgb);
}

int main(void)
{
    test_error();
    test_sharpness();
    test_ssim();
    test_ssim_window();
    test_flip();
    test_flip_linear();
    test_published();
    test_maps();
    test_time();
    test_sequence_errors();
    return tap_done();
}
