/* SPDX-License-Identifier: MIT */
/* Which wide kernel there is, and the way to it. */
#include "wide.h"

#include "brume_dense.h"

#include <string.h>

typedef void wide_march(const struct wide_copy *copy,
                        const struct brume_frame *frame, unsigned x, unsigned y,
                        unsigned w, unsigned h, struct brume_radiance *out,
                        size_t stride);

/* Sums towards the sun of a frame with lighting and uniform light, whose
 * lookups are not stochastic, from n points along x, `step` apart. */
typedef void wide_sums(const struct wide_copy *copy,
                       const struct brume_frame *frame, const uint32_t from[3],
                       uint32_t step, uint32_t n, uint32_t *sums);

/* wide_march.c, compiled for each kind of lanes; NULL where the makefile has
 * left one out. */
#define MAY_BE_LEFT_OUT __attribute__((weak))
wide_march wide_march_generic MAY_BE_LEFT_OUT;
wide_march wide_march_avx2 MAY_BE_LEFT_OUT;
wide_march wide_march_avx512 MAY_BE_LEFT_OUT;
wide_sums wide_march_generic_sums MAY_BE_LEFT_OUT;
wide_sums wide_march_avx2_sums MAY_BE_LEFT_OUT;
wide_sums wide_march_avx512_sums MAY_BE_LEFT_OUT;

static const char *const k_names[WIDE_KERNELS] = {"scalar", "avx2", "avx512",
                                                  "generic"};

/* What a kernel is compiled to; NULL what it is not. */
struct code {
    wide_march *march;
    wide_sums *sums;
};

static const struct code k_code[WIDE_KERNELS] = {
    [WIDE_AVX2] = {wide_march_avx2, wide_march_avx2_sums},
    [WIDE_AVX512] = {wide_march_avx512, wide_march_avx512_sums},
    [WIDE_GENERIC] = {wide_march_generic, wide_march_generic_sums}};

static bool processor_has(enum wide_kernel kernel)
{
#if defined(__x86_64__)
    bool avx2 =
        __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2");
    if (kernel == WIDE_AVX2)
        return avx2;
    if (kernel == WIDE_AVX512)
        return avx2 && __builtin_cpu_supports("avx512f") &&
               __builtin_cpu_supports("avx512bw") &&
               __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512vl") &&
               __builtin_cpu_supports("avx512cd");
#endif
    return kernel == WIDE_GENERIC;
}

bool wide_has(enum wide_kernel kernel)
{
    return kernel == WIDE_SCALAR ||
           (k_code[kernel].march != NULL && processor_has(kernel));
}

enum wide_kernel wide_best(void)
{
    return wide_has(WIDE_AVX512) ? WIDE_AVX512
           : wide_has(WIDE_AVX2) ? WIDE_AVX2
                                 : WIDE_SCALAR;
}

const char *wide_name(enum wide_kernel kernel)
{
    return k_names[kernel];
}

bool wide_by_name(const char *name, enum wide_kernel *kernel)
{
    for (int i = 0; i < WIDE_KERNELS; i++)
        if (strcmp(name, k_names[i]) == 0) {
            *kernel = (enum wide_kernel)i;
            return true;
        }
    return false;
}

int wide_march_copy_rect(enum wide_kernel kernel, const struct wide_copy *copy,
                         const struct brume_frame *frame, unsigned x,
                         unsigned y, unsigned w, unsigned h,
                         struct brume_radiance *out, size_t stride)
{
    wide_march *march = wide_has(kernel) ? k_code[kernel].march : NULL;
    /* The scalar one checks a rectangle, too: an empty one of this place. */
    int error = brume_march_rect(frame, x, y, w, march ? 0 : h, out, stride);
    if (error != BRUME_OK || march == NULL)
        return error;
    if (h > frame->lattice[1] - y || (h > 1 && stride < w))
        return BRUME_ERR_RECT;
    march(copy, frame, x, y, w, h, out, stride);
    return BRUME_OK;
}

int wide_march_rect(enum wide_kernel kernel, const struct brume_frame *frame,
                    unsigned x, unsigned y, unsigned w, unsigned h,
                    struct brume_radiance *out, size_t stride)
{
    return wide_march_copy_rect(kernel, NULL, frame, x, y, w, h, out, stride);
}

/// Cache ///

/* Sums of so many points are made at a time. */
#define POINTS 256u

static void cache_row(wide_sums *sums_along, const struct wide_copy *copy,
                      const struct brume_cache *c, uint8_t *codes,
                      const struct brume_frame *f, uint32_t row)
{
    const uint32_t s = c->spacing_log2, half = brume_half_voxel(f);
    const struct brume_number per_unit = units_of_cache(c);
    const uint32_t y = row % c->size[1], z = row / c->size[1];
    for (uint32_t x = 0; x < c->size[0]; x += POINTS) {
        uint32_t n = c->size[0] - x < POINTS ? c->size[0] - x : POINTS;
        uint32_t sums[POINTS];
        const uint32_t from[3] = {middle_of_point(x, s) - half,
                                  middle_of_point(y, s) - half,
                                  middle_of_point(z, s) - half};
        sums_along(copy, f, from, 0x10000u << s, n, sums);
        for (uint32_t i = 0; i < n; i++)
            codes[row * c->size[0] + x + i] = code_of_sum(f, sums[i], per_unit);
    }
}

int wide_cache_rows(enum wide_kernel kernel, const struct wide_copy *copy,
                    const struct brume_cache *cache, uint8_t *codes,
                    const struct brume_frame *frame, uint32_t row,
                    uint32_t rows)
{
    wide_sums *sums = wide_has(kernel) ? k_code[kernel].sums : NULL;
    if (frame != NULL &&
        (frame->lit.light != BRUME_UNIFORM || frame->lit.stochastic))
        sums = NULL;
    /* The scalar one checks: an empty piece of this place. */
    int error =
        brume_cache_rows(cache, codes, frame, row, sums != NULL ? 0 : rows);
    if (error != BRUME_OK || sums == NULL)
        return error;
    if (rows > (uint32_t)cache->size[1] * cache->size[2] - row)
        return BRUME_ERR_RECT;
    for (; rows > 0; rows--, row++)
        cache_row(sums, copy, cache, codes, frame, row);
    return BRUME_OK;
}
