/* SPDX-License-Identifier: MIT */
/* Discrete Fourier transforms of textures; sides are powers of two. */
#ifndef BRUME_TABLES_FFT_H
#define BRUME_TABLES_FFT_H

#include <complex.h>
#include <stdint.h>

#define FFT_MAX 256

/* In place, sum_x v[x] exp(-2 pi i k x / n), without a factor. */
void fft_line(double complex *v, uint32_t n);

/* All lines of [frames][height][width], along each axis. */
void fft_box(double complex *v, uint32_t width, uint32_t height,
             uint32_t frames);

#endif
