/* SPDX-License-Identifier: MIT */
/*
 * The energy of Donnelly, Wolfe, Buetepage and Valdes, "Filter-Adapted
 * Spatio-Temporal Sampling for Real-Time Rendering", 2024, as an integer
 * kernel.
 *
 * Let b be the error of an estimate at every pixel and f the filter that the
 * picture is seen through. The squared error after filtering, summed over the
 * picture, is sum_ij b_i b_j F(i - j), with F = f * f (the filter's
 * autocorrelation). So F is the energy between two samples on the same side of
 * a threshold, and an arrangement that minimises it for every threshold
 * minimises the mean error over random Heaviside integrands.
 *
 * Space   box and binomial: their weights. gauss: integrals of the Gaussian
 *         over pixels, cut where 0.995 of it is inside.
 * Time    ema(alpha, beta): the exponential moving average x <- x + alpha
 *         (v - x) that started with its first frame as it is, m frames ago:
 *         weights alpha (1 - alpha)^i for i < m - 1 and (1 - alpha)^(m - 1)
 *         for the first frame. How old the history is, is unknown: the pixel
 *         is rejected in a frame with probability beta, so m has the
 *         geometric distribution beta (1 - beta)^(m - 1), cut at the length
 *         of the texture. F is the mean of the autocorrelations over m,
 *         wrapped around the texture's length. beta = 0: all m alike.
 *         ema(alpha): m without end, whose autocorrelation is alpha / (2 -
 *         alpha) (1 - alpha)^|d|.
 * Values  several per pixel and frame, of which the estimate is the mean: two
 *         values of a frame weigh as much as a value and itself. They are
 *         slices of their own, and the torus has four dimensions.
 *
 * Numbers below are Q30 unless said otherwise, 1 = 2^30. Entries are off by
 * less than 2^-17 of the centre's weight, far below what the placement
 * notices; for sigma below 0.3, by 1e-4 (see gauss_over).
 */
#include "kernel.h"

#include <stdlib.h>
#include <string.h>

#define ONE (1u << 30)
#define SUM_LIMIT (1u << 29) /* of a kernel's entries: see cluster.c */
#define MAX_SIGMA (16u * KERNEL_MICRO)
#define MIN_SIGMA (KERNEL_MICRO / 10)

/// Parsing ///

/* A decimal number of at most 10 digits, 6 of them fraction digits, in
 * millionths. Returns the text after it, or NULL. */
static const char *decimal(const char *text, uint32_t *micro)
{
    uint32_t value = 0, unit = KERNEL_MICRO;
    int digits = 0;

    for (; *text >= '0' && *text <= '9'; text++, digits++) {
        value = 10u * value + (uint32_t)(*text - '0');
        if (value > 1000u)
            return NULL;
    }
    value *= KERNEL_MICRO;
    if (*text == '.')
        for (text++; *text >= '0' && *text <= '9' && unit > 1u;
             text++, digits++) {
            unit /= 10u;
            value += unit * (uint32_t)(*text - '0');
        }
    *micro = value;
    return digits > 0 && digits <= 10 ? text : NULL;
}

/* `name:value`, value from low to high millionths, and nothing after it. */
static bool named(const char *text, const char *name, uint32_t low,
                  uint32_t high, uint32_t *micro)
{
    size_t length = strlen(name);
    uint32_t value;

    if (strncmp(text, name, length) || text[length] != ':')
        return false;
    text = decimal(text + length + 1, &value);
    if (!text || *text || value < low || value > high)
        return false;
    *micro = value;
    return true;
}

static bool parse_gauss(const char *text, struct filter *filter)
{
    uint32_t sigma;

    if (!named(text, "gauss", MIN_SIGMA, MAX_SIGMA, &sigma))
        return false;
    *filter = (struct filter){FILTER_GAUSS, 0, sigma, 0};
    return true;
}

bool kernel_parse_space(const char *text, struct filter *filter)
{
    static const struct {
        const char *name;
        struct filter filter;
    } known[] = {
        {"none", {FILTER_NONE, 0, 0, 0}},
        {"box3", {FILTER_BOX, 3, 0, 0}},
        {"box5", {FILTER_BOX, 5, 0, 0}},
        {"binomial3", {FILTER_BINOMIAL, 3, 0, 0}},
        {"binomial5", {FILTER_BINOMIAL, 5, 0, 0}},
        {"gauss1", {FILTER_GAUSS, 0, KERNEL_MICRO, 0}},
    };

    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (!strcmp(text, known[i].name)) {
            *filter = known[i].filter;
            return true;
        }
    return parse_gauss(text, filter);
}

bool kernel_parse_time(const char *text, struct filter *filter)
{
    uint32_t alpha, beta;

    if (!strcmp(text, "none")) {
        *filter = (struct filter){FILTER_NONE, 0, 0, 0};
        return true;
    }
    if (strncmp(text, "ema:", 4))
        return parse_gauss(text, filter);
    text = decimal(text + 4, &alpha);
    if (!text || alpha < KERNEL_MICRO / 1000 || alpha > KERNEL_MICRO)
        return false;
    beta = KERNEL_ENDLESS;
    if (*text == ',') {
        text = decimal(text + 1, &beta);
        if (!text || beta >= KERNEL_MICRO)
            return false;
    }
    if (*text)
        return false;
    *filter = (struct filter){FILTER_EMA, 0, alpha, beta};
    return true;
}

bool kernel_parse_combine(const char *text, struct kernel_spec *spec)
{
    uint32_t time = 0, space = 0;
    enum combine combine = COMBINE_PRODUCT;

    if (!strncmp(text, "separate:", 9)) {
        combine = COMBINE_SEPARATE;
        space = KERNEL_MICRO;
        text = decimal(text + 9, &time);
    } else if (!strncmp(text, "hybrid:", 7)) {
        combine = COMBINE_HYBRID;
        text = decimal(text + 7, &time);
        if (text && *text == ',')
            text = decimal(text + 1, &space);
    } else if (!strcmp(text, "product")) {
        text = "";
    } else {
        return false;
    }
    if (!text || *text)
        return false;
    spec->combine = combine;
    spec->time_weight = time;
    spec->space_weight = space;
    return true;
}

/// Arithmetic ///

static uint32_t q30(uint32_t micro)
{
    return (uint32_t)(((uint64_t)micro * ONE + KERNEL_MICRO / 2) /
                      KERNEL_MICRO);
}

/* Both below 2^32; rounded to nearest. */
static uint32_t mul(uint64_t a, uint64_t b)
{
    return (uint32_t)((a * b + ONE / 2) >> 30);
}

/* x = n ln 2 + r, 0 <= r < ln 2; twelve terms of the series leave
 * r^13 / 13! < 2^-39. */
uint32_t kernel_exp(uint64_t x)
{
    const uint64_t one = 1u << 31, ln2 = 1488522236u;
    uint64_t n = x / ln2, r = x % ln2, e = one;

    if (n >= 32)
        return 0;
    for (uint32_t k = 12; k > 0; k--)
        e = one - (r * e >> 31) / k;
    return (uint32_t)(e >> n);
}

/* exp(-(x / sigma)^2 / 2), x in 1/64 pixel. */
static uint32_t gauss_at(uint32_t x, uint32_t sigma)
{
    /* x / sigma in Q24, from 8 on 0: exp(-32) < 2^-46. */
    uint64_t u = ((uint64_t)x * KERNEL_MICRO << 18) / sigma;

    return u >= 8u << 24 ? 0 : kernel_exp(u * u >> 18) >> 1;
}

/* The density of a Gaussian integrated over [i - 1/2, i + 1/2]: Simpson's rule
 * with 64 intervals, whose error is below (1/64)^4 / 60 sigma^-5. */
static uint32_t gauss_over(uint32_t i, uint32_t sigma)
{
    const uint64_t inverse_root_2pi = 428354853u; /* 0.39894228 */
    uint64_t sum = 0;

    for (uint32_t k = 0; k <= 64; k++) {
        uint32_t x = 64u * i + k;
        uint64_t weight = k == 0 || k == 64 ? 1 : k % 2 ? 4 : 2;
        sum += weight * gauss_at(x < 32u ? 32u - x : x - 32u, sigma);
    }
    uint64_t mean = sum / (3u * 64u);
    return mul(mean, inverse_root_2pi * KERNEL_MICRO / sigma);
}

/// Filters in one dimension ///

/* weight[0 .. radius] of a symmetric filter; 0 beyond. */
struct profile {
    uint32_t radius;
    uint32_t weight[2 * KERNEL_MAX_RADIUS + 1];
};

static void gauss_profile(struct profile *p, uint32_t sigma)
{
    uint64_t total = 0;
    const uint64_t enough = (uint64_t)ONE * 995 / 1000;

    for (uint32_t i = 0; total < enough && i < KERNEL_MAX_RADIUS; i++) {
        p->weight[i] = gauss_over(i, sigma);
        p->radius = i;
        total += (i ? 2u : 1u) * p->weight[i];
    }
}

/* The Gaussian itself at whole distances, 1 at the centre, cut at 4 sigma. */
static void plain_gauss_profile(struct profile *p, uint32_t sigma)
{
    p->radius = (4u * sigma + KERNEL_MICRO - 1) / KERNEL_MICRO;
    for (uint32_t i = 0; i <= p->radius; i++)
        p->weight[i] = gauss_at(64u * i, sigma);
}

static void profile_of(struct profile *p, const struct filter *f, bool plain)
{
    static const uint32_t binomial3[] = {ONE / 2, ONE / 4};
    static const uint32_t binomial5[] = {ONE / 16 * 6, ONE / 4, ONE / 16};

    memset(p, 0, sizeof *p);
    p->radius = f->size / 2;
    p->weight[0] = ONE;
    if (f->kind == FILTER_BOX)
        for (uint32_t i = 0; i <= p->radius; i++)
            p->weight[i] = (ONE + f->size / 2) / f->size;
    else if (f->kind == FILTER_BINOMIAL && f->size == 3)
        memcpy(p->weight, binomial3, sizeof binomial3);
    else if (f->kind == FILTER_BINOMIAL)
        memcpy(p->weight, binomial5, sizeof binomial5);
    else if (f->kind == FILTER_GAUSS && plain)
        plain_gauss_profile(p, f->a);
    else if (f->kind == FILTER_GAUSS)
        gauss_profile(p, f->a);
}

/* p * p. */
static void autocorrelate(struct profile *p)
{
    int radius = (int)p->radius;
    struct profile out = {2 * p->radius, {0}};

    for (int d = 0; d <= 2 * radius; d++)
        for (int i = d - radius; i <= radius; i++)
            out.weight[d] += mul(p->weight[abs(i)], p->weight[abs(d - i)]);
    *p = out;
}

/* Adds p to the circle out[0 .. size - 1]. */
static void fold(const struct profile *p, uint64_t *out, uint32_t size)
{
    for (uint32_t i = 0; i <= p->radius; i++) {
        out[i & (size - 1)] += p->weight[i];
        if (i)
            out[-i & (size - 1)] += p->weight[i];
    }
}

/* Adds `share` of the autocorrelation of the average over m frames. */
static void add_history(uint64_t *out, uint32_t size, uint32_t alpha,
                        uint32_t m, uint32_t share)
{
    uint32_t f[64], decay = ONE;

    for (uint32_t i = 0; i < m; i++) {
        f[i] = i + 1 < m ? mul(decay, alpha) : decay;
        decay = mul(decay, ONE - alpha);
    }
    for (uint32_t d = 0; d < m; d++) {
        uint64_t sum = 0;
        for (uint32_t i = 0; i + d < m; i++)
            sum += mul(f[i], f[i + d]);
        out[d & (size - 1)] += mul(sum, share);
        if (d)
            out[-d & (size - 1)] += mul(sum, share);
    }
}

/* An endless history: (1 - alpha)^|d| around the circle. */
static void endless_circle(uint64_t *out, uint32_t size, uint32_t alpha)
{
    uint32_t decay = ONE;

    for (uint32_t d = 0; decay > 1u; d++) {
        out[d & (size - 1)] += decay;
        if (d)
            out[-d & (size - 1)] += decay;
        decay = (uint32_t)((uint64_t)decay * (ONE - alpha) >> 30);
    }
}

static void ema_circle(uint64_t *out, uint32_t size, const struct filter *f)
{
    uint32_t alpha = q30(f->a), beta = q30(f->b), left = ONE, total = 0;
    uint32_t share[64];

    for (uint32_t m = 0; m < size; m++) {
        share[m] = beta ? mul(left, beta) : ONE / size;
        left = mul(left, ONE - beta);
        total += share[m];
    }
    for (uint32_t m = 0; m < size; m++)
        add_history(out, size, alpha, m + 1,
                    (uint32_t)(((uint64_t)share[m] << 30) / total));
}

/* A filter's kernel around a circle, 1 at the centre. */
static void circle(uint32_t *out, uint32_t size, const struct filter *f,
                   bool plain)
{
    struct profile p;
    uint64_t sum[256] = {0};

    if (f->kind == FILTER_EMA && f->b == KERNEL_ENDLESS) {
        endless_circle(sum, size, q30(f->a));
    } else if (f->kind == FILTER_EMA) {
        ema_circle(sum, size, f);
    } else {
        profile_of(&p, f, plain);
        if (!plain)
            autocorrelate(&p);
        fold(&p, sum, size);
    }
    for (uint32_t i = 0; i < size; i++)
        out[i] = (uint32_t)(((sum[i] << 24) / (sum[0] >> 6)));
}

/// The kernel ///

static uint32_t radius_of(const struct filter *f, bool plain)
{
    struct profile p;

    profile_of(&p, f, plain);
    return plain ? p.radius : 2 * p.radius;
}

/* One axis: a box of 2 radius + 1, or the whole circle when that is shorter. */
static void span(uint32_t radius, uint32_t size, uint32_t *count,
                 int32_t *first)
{
    bool whole = 2u * radius + 1u > size;

    *count = whole ? size : 2u * radius + 1u;
    *first = whole ? 0 : -(int32_t)radius;
}

/* The weight, 1 = 2^30, between pixels (space = 1 on the same pixel) and
 * frames; below (1 + 1000) 2^30. */
static uint64_t joined(const struct kernel_spec *spec, uint32_t space,
                       uint32_t time, bool centre, bool same_frame)
{
    uint64_t sum = 0;

    if (spec->combine != COMBINE_SEPARATE)
        sum += mul(space, time);
    if (same_frame)
        sum += (uint64_t)space * spec->space_weight / KERNEL_MICRO;
    if (centre)
        sum += (uint64_t)time * spec->time_weight / KERNEL_MICRO;
    return sum;
}

/* Entries with the largest centre whose sum is below the limit. */
static void scale_down(struct kernel *kernel, const uint64_t *wide,
                       size_t count)
{
    uint64_t sum = 0;
    int shift = 0;

    for (size_t i = 0; i < count; i++)
        sum += wide[i];
    while (sum >> shift >= SUM_LIMIT / kernel->values - count)
        shift++;
    uint64_t half = shift ? UINT64_C(1) << (shift - 1) : 0;
    for (size_t i = 0; i < count; i++)
        kernel->weight[i] = (int32_t)((wide[i] + half) >> shift);
}

static void mark_extents(struct kernel *kernel)
{
    uint32_t area = kernel->rows * kernel->cols;
    uint32_t centre =
        (uint32_t)(-kernel->top * (int32_t)kernel->cols - kernel->left);

    for (uint32_t z = 0; z < kernel->frames; z++) {
        const int32_t *weight = kernel->weight + z * area;
        int extent = weight[centre] ? EXTENT_CENTRE : EXTENT_NONE;
        for (uint32_t i = 0; i < area; i++)
            if (i != centre && weight[i])
                extent = EXTENT_BOX;
        kernel->extent[z] = (uint8_t)extent;
    }
}

static void join(uint64_t *wide, const struct kernel *kernel,
                 const struct kernel_spec *spec, uint32_t width,
                 uint32_t height)
{
    uint32_t x[256], y[256], time[64];

    circle(x, width, &spec->space, spec->plain);
    circle(y, height, &spec->space, spec->plain);
    circle(time, kernel->frames, &spec->time, spec->plain);
    for (uint32_t z = 0; z < kernel->frames; z++)
        for (uint32_t j = 0; j < kernel->rows; j++)
            for (uint32_t i = 0; i < kernel->cols; i++) {
                uint32_t dx = i + (uint32_t)kernel->left;
                uint32_t dy = j + (uint32_t)kernel->top;
                uint32_t space = mul(x[dx & (width - 1)], y[dy & (height - 1)]);
                *wide++ = joined(spec, space, time[z], !dx && !dy, !z);
            }
}

bool kernel_make(struct kernel *kernel, const struct kernel_spec *spec,
                 uint32_t width, uint32_t height, uint32_t slices)
{
    uint32_t values = spec->values ? spec->values : 1u;
    uint32_t frames = slices / values,
             radius = radius_of(&spec->space, spec->plain);

    memset(kernel, 0, sizeof *kernel);
    kernel->frames = frames;
    kernel->values = values;
    span(radius, width, &kernel->cols, &kernel->left);
    span(radius, height, &kernel->rows, &kernel->top);
    size_t count = (size_t)frames * kernel->rows * kernel->cols;
    uint64_t *wide = malloc(count * sizeof *wide);
    kernel->weight = malloc(count * sizeof *kernel->weight);
    kernel->extent = malloc(frames);
    if (!wide || !kernel->weight || !kernel->extent) {
        free(wide);
        kernel_free(kernel);
        return false;
    }
    join(wide, kernel, spec, width, height);
    scale_down(kernel, wide, count);
    mark_extents(kernel);
    free(wide);
    return true;
}

void kernel_free(struct kernel *kernel)
{
    free(kernel->weight);
    free(kernel->extent);
    memset(kernel, 0, sizeof *kernel);
}
