/* SPDX-License-Identifier: MIT */
/*
 * Vector noise by swaps.
 *
 * The energy -sum G(p - q) d(x_p, x_q) is replaced by that of a set of
 * half-spaces, drawn anew now and then: with f_k(p) = 1 when x_p is in
 * half-space k, and else 0, d(x_p, x_q) is in proportion to the number of k
 * with f_k(p) != f_k(q), and the energy to
 *
 *     sum_k sum_{p, q} G(p - q) f_k(p) f_k(q) + a constant.
 *
 * The fields F_k(p) = sum_q G(p - q) f_k(q) are kept for every pixel. Then a
 * swap of the points of p and q, which changes f_k by d_k at p and -d_k at q,
 * costs 2 sum_k (d_k (F_k(p) - F_k(q)) + d_k^2 (G(0) - G(p - q))): one short
 * product, whatever the kernel's size, and only a swap that is made has to
 * update the fields. So a pixel can look at many others and take the best.
 */
#include "space.h"

#include <stdlib.h>
#include <string.h>

#include "space_points.h"

/* Half-spaces of the first and of the other rounds, and how many rounds. */
#define COARSE 64
#define COARSE_ROUNDS 4
#define FINE 256
#define FINE_ROUNDS 6
#define CANDIDATES 256 /* pixels that one pixel looks at in a round */
#define WHOLE 32000    /* sum of the kernel: the fields fit 16 bits */
#define LEAST 4        /* smaller weights cost time and change nothing */

struct tap {
    uint32_t dx, dy, dt; /* modulo the texture's sides */
    int16_t weight;
};

struct places {
    enum noise_space space;
    uint32_t width, height, frames, bits; /* 2^bits pixels a frame */
    uint8_t (*bytes)[3];                  /* of every point */
    uint16_t *point;                      /* of every pixel, its number */
    uint32_t features;                    /* COARSE or FINE */
    int16_t *feature; /* of every point, `features` times 0 or 1 */
    int16_t *field;   /* of every pixel, as many */
    struct tap *taps;
    size_t tap_count;
    int16_t *own; /* G within a frame, by (dy, dx) modulo its sides */
    uint64_t random;
    noise_progress *progress;
    void *user;
    uint32_t done, all; /* half-spaces times frames */
};

/* 32 random bits: SplitMix64 (Steele, Lea and Flood 2014). */
static uint32_t draw(struct places *s)
{
    uint64_t z = s->random += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return (uint32_t)(z >> 32);
}

/// Set up ///

static bool make_places(struct places *s, const struct noise_texture *t,
                        enum noise_space space, uint32_t seed)
{
    const size_t area = (size_t)t->width * t->height;

    memset(s, 0, sizeof *s);
    s->space = space;
    s->width = t->width;
    s->height = t->height;
    s->frames = t->frames;
    while (1u << s->bits < area)
        s->bits++;
    s->random = seed;
    s->bytes = malloc(area * sizeof *s->bytes);
    s->feature = malloc(area * FINE * sizeof *s->feature);
    s->own = calloc(area, sizeof *s->own);
    s->point = malloc(area * t->frames * sizeof *s->point);
    s->field = malloc(area * t->frames * FINE * sizeof *s->field);
    return s->bytes && s->feature && s->own && s->point && s->field;
}

static void free_places(struct places *s)
{
    free(s->bytes);
    free(s->feature);
    free(s->own);
    free(s->point);
    free(s->field);
    free(s->taps);
}

static void add_tap(struct places *s, int32_t dx, int32_t dy, uint32_t dt,
                    int64_t weight)
{
    struct tap *tap = &s->taps[s->tap_count];

    tap->dx = (uint32_t)dx & (s->width - 1);
    tap->dy = (uint32_t)dy & (s->height - 1);
    tap->dt = dt;
    tap->weight = (int16_t)weight;
    if (weight < LEAST)
        return;
    s->tap_count++;
    if (dt == 0) {
        int16_t *own = &s->own[tap->dy * s->width + tap->dx];
        *own = (int16_t)(*own + weight);
    }
}

/* The weights, rounded to parts of WHOLE; the least are left out. */
static bool make_taps(struct places *s, const struct noise_space_kernel *k)
{
    const int32_t radius = (int32_t)k->radius, side = 2 * radius + 1;
    const size_t count = (size_t)side * (size_t)side * k->frames;
    int64_t sum = 0;
    size_t i = 0;

    s->taps = malloc(count * sizeof *s->taps);
    if (!s->taps)
        return false;
    for (size_t n = 0; n < count; n++)
        sum += k->weight[n];
    for (uint32_t dt = 0; dt < k->frames; dt++)
        for (int32_t dy = -radius; dy <= radius; dy++)
            for (int32_t dx = -radius; dx <= radius; dx++)
                add_tap(s, dx, dy, dt,
                        ((int64_t)k->weight[i++] * WHOLE + sum / 2) / sum);
    return true;
}

/* Every frame holds every point once, in random order. */
static void shuffle(struct places *s)
{
    const uint32_t area = 1u << s->bits;

    for (uint32_t i = 0; i < area; i++)
        space_point(s->space, i, s->bits, s->bytes[i]);
    for (uint32_t frame = 0; frame < s->frames; frame++) {
        uint16_t *point = s->point + (size_t)frame * area;
        for (uint32_t i = 0; i < area; i++) {
            const uint32_t k = (uint32_t)((uint64_t)draw(s) * (i + 1) >> 32);
            point[i] = point[k];
            point[k] = (uint16_t)i;
        }
    }
}

/// Fields ///

static int16_t *feature_of(const struct places *s, uint32_t pixel)
{
    return s->feature + (size_t)s->point[pixel] * s->features;
}

static int16_t *field_of(const struct places *s, size_t pixel)
{
    return s->field + pixel * s->features;
}

static void add_scaled(int16_t *restrict field, const int16_t *restrict change,
                       uint32_t n, int16_t weight)
{
    for (uint32_t k = 0; k < n; k++)
        field[k] = (int16_t)(field[k] + weight * change[k]);
}

/* The features at a pixel changed: so do the fields that see it. */
static void spread(struct places *s, uint32_t pixel, const int16_t *change)
{
    const uint32_t area = 1u << s->bits, frame = pixel / area;
    const uint32_t y = pixel % area / s->width, x = pixel % s->width;

    for (size_t i = 0; i < s->tap_count; i++) {
        const struct tap *tap = &s->taps[i];
        const uint32_t at = (x - tap->dx) & (s->width - 1);
        const uint32_t row = (y - tap->dy) & (s->height - 1);
        const uint32_t slice = (frame - tap->dt) & (s->frames - 1);
        add_scaled(field_of(s, slice * area + row * s->width + at), change,
                   s->features, tap->weight);
    }
}

static void find_features(struct places *s)
{
    const uint32_t shift[3] = {draw(s), draw(s), draw(s)};
    uint32_t bits = 0;

    while (1u << bits < s->features)
        bits++;
    for (uint32_t k = 0; k < s->features; k++) {
        struct half_space h;
        space_half_space(s->space, k, bits, shift, &h);
        for (uint32_t i = 0; i < 1u << s->bits; i++) {
            int16_t v[3];
            space_vector(s->space, s->bytes[i], v);
            s->feature[i * s->features + k] =
                h.normal[0] * v[0] + h.normal[1] * v[1] + h.normal[2] * v[2] >
                h.offset;
        }
    }
}

static void find_fields(struct places *s)
{
    const uint32_t pixels = s->frames << s->bits;

    memset(s->field, 0, (size_t)pixels * s->features * sizeof *s->field);
    for (uint32_t pixel = 0; pixel < pixels; pixel++)
        spread(s, pixel, feature_of(s, pixel));
}

/// Swaps ///

/* Half the change of the energy when pixels p and q of a frame swap. */
static int32_t cost(const struct places *s, uint32_t p, uint32_t q)
{
    const int16_t *a = feature_of(s, p), *b = feature_of(s, q);
    const int16_t *f = field_of(s, p), *g = field_of(s, q);
    const uint32_t dx = (p - q) & (s->width - 1);
    const uint32_t dy = (p / s->width - q / s->width) & (s->height - 1);
    int32_t product = 0, square = 0;

    for (uint32_t k = 0; k < s->features; k++) {
        const int16_t d = (int16_t)(b[k] - a[k]);
        product += d * (int16_t)(f[k] - g[k]);
        square += d * d;
    }
    return product + square * (s->own[0] - s->own[dy * s->width + dx]);
}

static void swap(struct places *s, uint32_t p, uint32_t q)
{
    const int16_t *a = feature_of(s, p), *b = feature_of(s, q);
    const uint16_t point = s->point[p];
    int16_t change[FINE], back[FINE];

    for (uint32_t k = 0; k < s->features; k++) {
        change[k] = (int16_t)(b[k] - a[k]);
        back[k] = (int16_t)-change[k];
    }
    s->point[p] = s->point[q];
    s->point[q] = point;
    spread(s, p, change);
    spread(s, q, back);
}

/* Every pixel of a frame, on average, looks at a run of others somewhere (a run
 * for the sake of the cache), and swaps with the best, if that lowers the
 * energy. */
static void improve(struct places *s, uint32_t frame)
{
    const uint32_t area = 1u << s->bits, first = frame * area;

    for (uint32_t n = 0; n < area; n++) {
        const uint32_t p = first + (draw(s) & (area - 1));
        const uint32_t from = draw(s);
        uint32_t best = p;
        int32_t least = 0;
        for (uint32_t i = 0; i < CANDIDATES; i++) {
            const uint32_t q = first + ((from + i) & (area - 1));
            const int32_t c = cost(s, p, q);
            if (c < least) {
                least = c;
                best = q;
            }
        }
        if (best != p)
            swap(s, p, best);
    }
}

static void write_texels(const struct places *s, struct noise_texture *t)
{
    const uint32_t pixels = s->frames << s->bits;

    for (uint32_t i = 0; i < pixels; i++)
        memcpy(t->values + (size_t)i * t->channels, s->bytes[s->point[i]],
               t->channels);
}

/* So many rounds with one set of half-spaces. */
static void improve_with(struct places *s, uint32_t features, uint32_t rounds)
{
    s->features = features;
    find_features(s);
    find_fields(s);
    for (uint32_t round = 0; round < rounds; round++)
        for (uint32_t frame = 0; frame < s->frames; frame++) {
            if (s->progress)
                s->progress(s->user, s->done, s->all);
            improve(s, frame);
            s->done += features;
        }
}

bool noise_space_fill(struct noise_texture *t, enum noise_space space,
                      const struct noise_space_kernel *kernel, uint32_t seed,
                      uint32_t rounds, noise_progress *progress, void *user)
{
    struct places s;
    const bool made = make_places(&s, t, space, seed) && make_taps(&s, kernel);

    rounds = rounds ? rounds : FINE_ROUNDS;
    s.progress = progress;
    s.user = user;
    s.all = (COARSE * COARSE_ROUNDS + FINE * rounds) * s.frames;
    if (made) {
        shuffle(&s);
        improve_with(&s, COARSE, COARSE_ROUNDS);
        improve_with(&s, FINE, rounds);
        write_texels(&s, t);
    }
    free_places(&s);
    return made;
}

/// Loss ///

struct vectors {
    const struct noise_texture *t;
    int16_t (*at)[3];
    uint16_t *distance; /* by the square: see space_distances */
};

static uint32_t apart(const struct vectors *v, size_t p, size_t q)
{
    const int32_t x = v->at[p][0] - v->at[q][0];
    const int32_t y = v->at[p][1] - v->at[q][1];
    const int32_t z = v->at[p][2] - v->at[q][2];
    return v->distance[x * x + y * y + z * z];
}

/* Between texels that are (dx, dy, dt) apart. */
static double mean_at(const struct vectors *v, int32_t dx, int32_t dy,
                      uint32_t dt)
{
    const struct noise_texture *t = v->t;
    uint64_t sum = 0;
    size_t p = 0;

    for (uint32_t frame = 0; frame < t->frames; frame++)
        for (uint32_t y = 0; y < t->height; y++)
            for (uint32_t x = 0; x < t->width; x++, p++) {
                const uint32_t x2 = (x + (uint32_t)dx) & (t->width - 1);
                const uint32_t y2 = (y + (uint32_t)dy) & (t->height - 1);
                const size_t slice = (frame + dt) & (t->frames - 1);
                sum += apart(v, p, (slice * t->height + y2) * t->width + x2);
            }
    return (double)sum / (double)p;
}

/* Of all pairs of slice 0, every 4096th of which suffices beyond 64x64. */
static double mean_of_slice(const struct vectors *v)
{
    const size_t area = (size_t)v->t->width * v->t->height;
    const size_t step = area > 4096 ? area / 4096 : 1;
    uint64_t sum = 0;

    for (size_t p = 0; p < area; p += step)
        for (size_t q = 0; q < area; q++)
            sum += apart(v, p, q);
    return (double)sum / (double)area / (double)(area / step);
}

static double loss_of(const struct vectors *v,
                      const struct noise_space_kernel *k)
{
    const int32_t radius = (int32_t)k->radius, side = 2 * radius + 1;
    const double mean = mean_of_slice(v);
    double sum = 0;
    size_t i = 0;

    for (uint32_t dt = 0; dt < k->frames; dt++)
        for (int32_t dy = -radius; dy <= radius; dy++)
            for (int32_t dx = -radius; dx <= radius; dx++, i++)
                if (k->weight[i])
                    sum += k->weight[i] * (mean - mean_at(v, dx, dy, dt));
    return sum / (mean * k->weight[side * radius + radius]);
}

bool noise_space_loss(const struct noise_texture *t, enum noise_space space,
                      const struct noise_space_kernel *kernel, double *loss)
{
    const size_t pixels = (size_t)t->width * t->height * t->frames;
    struct vectors v = {t, malloc(pixels * sizeof *v.at),
                        malloc(SPACE_SQUARES * sizeof *v.distance)};
    const bool made = v.at && v.distance;

    for (size_t i = 0; made && i < pixels; i++)
        space_vector(space, t->values + i * t->channels, v.at[i]);
    if (made) {
        space_distances(space, v.distance);
        *loss = loss_of(&v, kernel);
    }
    free(v.at);
    free(v.distance);
    return made;
}
