/* SPDX-License-Identifier: MIT */
/* Radix-2 Fourier transforms, decimation in time. */
#include "fft.h"

#include <math.h>
#include <stddef.h>

static void reverse_bits(double complex *v, uint32_t n)
{
    for (uint32_t i = 1, k = 0; i < n; i++) {
        uint32_t bit = n / 2;
        for (; k & bit; bit /= 2)
            k ^= bit;
        k |= bit;
        if (i < k) {
            const double complex other = v[i];
            v[i] = v[k];
            v[k] = other;
        }
    }
}

/* root[k] = exp(-2 pi i k / n), for k < n / 2: the same for all lines of n. */
struct roots {
    double complex root[FFT_MAX / 2];
    uint32_t n;
};

static void find_roots(struct roots *r, uint32_t n)
{
    const double pi = 3.14159265358979323846;

    r->n = n;
    r->root[0] = 1;
    for (uint32_t i = 1; i < n / 2; i++)
        r->root[i] = cos(2 * pi * i / n) - sin(2 * pi * i / n) * I;
}

static void transform(double complex *v, const struct roots *r)
{
    reverse_bits(v, r->n);
    for (uint32_t half = 1; half < r->n; half *= 2)
        for (uint32_t i = 0; i < half; i++) {
            const double complex root = r->root[i * (r->n / half / 2)];
            const double c = creal(root), s = cimag(root);
            for (uint32_t k = i; k < r->n; k += 2 * half) {
                const double re = creal(v[k + half]), im = cimag(v[k + half]);
                const double complex turned =
                    re * c - im * s + (re * s + im * c) * I;
                v[k + half] = v[k] - turned;
                v[k] += turned;
            }
        }
}

void fft_line(double complex *v, uint32_t n)
{
    struct roots r;

    find_roots(&r, n);
    transform(v, &r);
}

/* The lines of n values, `step` apart, that begin at v[0 .. step - 1]; then
 * `count` such groups of n * step values. */
static void lines(double complex *v, uint32_t n, size_t step, size_t count)
{
    double complex copy[FFT_MAX];
    struct roots r;

    find_roots(&r, n);
    for (size_t i = 0; i < count * step; i++) {
        double complex *first = v + i / step * step * n + i % step;
        for (uint32_t k = 0; k < n; k++)
            copy[k] = first[k * step];
        transform(copy, &r);
        for (uint32_t k = 0; k < n; k++)
            first[k * step] = copy[k];
    }
}

void fft_box(double complex *v, uint32_t width, uint32_t height,
             uint32_t frames)
{
    lines(v, width, 1, (size_t)height * frames);
    lines(v, height, width, frames);
    lines(v, frames, (size_t)width * height, 1);
}
