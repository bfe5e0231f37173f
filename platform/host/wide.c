/* SPDX-License-Identifier: MIT */
/* Which wide kernel there is, and the way to it. */
#include "wide.h"

#include <string.h>

typedef void wide_march(const struct wide_copy *copy,
                        const struct brume_frame *frame, unsigned x, unsigned y,
                        unsigned w, unsigned h, struct brume_radiance *out,
                        size_t stride);

/* wide_march.c, compiled for each kind of lanes; NULL where the makefile has
 * left one out. */
#define MAY_BE_LEFT_OUT __attribute__((weak))
wide_march wide_march_generic MAY_BE_LEFT_OUT;
wide_march wide_march_avx2 MAY_BE_LEFT_OUT;
wide_march wide_march_avx512 MAY_BE_LEFT_OUT;

static const char *const k_names[WIDE_KERNELS] = {"scalar", "avx2", "avx512",
                                                  "generic"};

/* The march of a kernel, or NULL. */
static wide_march *march_of(enum wide_kernel kernel)
{
    switch (kernel) {
    case WIDE_AVX2: return wide_march_avx2;
    case WIDE_AVX512: return wide_march_avx512;
    case WIDE_GENERIC: return wide_march_generic;
    default: return NULL;
    }
}

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
           (march_of(kernel) != NULL && processor_has(kernel));
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
    wide_march *march = wide_has(kernel) ? march_of(kernel) : NULL;
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
