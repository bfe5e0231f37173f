// SPDX-License-Identifier: MIT
//
// NanoVDB as somebody in a hurry compiles it: -O3 -march=native -ffast-math;
// see the Makefile.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#define BENCH_NAMESPACE fast
#define nanovdb nanovdb_fast
#include "nano_field.hpp"

namespace bench
{

// Doubling light samples seldom share a leaf, and an accessor that remembers
// only the two levels above is a tenth faster for them; not for uniform ones.
void nano_tuned(const grids &g, const view &v, strips rows, float *out)
{
    using access = nanovdb::ReadAccessor<float, 1, 2>;
    if (v.trilinear || v.uniform)
        fast::nano_render<float, fast::tuned>(g.nano, v, rows, out);
    else
        fast::render<fast::nano_field<float, access, 0>, fast::tuned>(
            g.nano, v, rows, out);
}

void nano_leaping(const grids &g, const view &v, strips rows, float *out)
{
    fast::nano_render<float, fast::leaping>(g.nano, v, rows, out);
}

void nano_leaf(const grids &g, const view &v, strips rows, float *out)
{
    using access = nanovdb::ReadAccessor<float, 0>;
    if (v.trilinear)
        fast::render<fast::leaf_field<float, access>, fast::tuned>(g.nano, v,
                                                                   rows, out);
    else
        nano_tuned(g, v, rows, out);
}

void nano_fp8(const grids &g, const view &v, strips rows, float *out)
{
    fast::nano_render<nanovdb::Fp8, fast::tuned>(g.nano_fp8, v, rows, out);
}

} // namespace bench
