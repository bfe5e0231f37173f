// SPDX-License-Identifier: MIT
//
// NanoVDB as it comes: compiled with -O3. And the double reference, the same
// march over the same float voxels.
#define BENCH_NAMESPACE shipped
#include "nano_field.hpp"

namespace bench
{

void nano_shipped(const grids &g, const view &v, strips rows, float *out)
{
    shipped::nano_render<float, shipped::plain>(g.nano, v, rows, out);
}

// What is outside of the box is 0, so that a light ray may end there.
struct exact : shipped::plain {
    static constexpr bool one_exp = true, box_ends = true;
};

template <int order>
static void render_double(const grids &g, const view &v, strips rows,
                          float *out)
{
    using access = nanovdb::DefaultReadAccessor<float>;
    using field = shipped::nano_field<double, access, order>;
    field f(g.nano);
    shipped::marcher<double, field, exact>(v, f).render(rows, out);
}

void nano_double(const grids &g, const view &v, strips rows, float *out)
{
    v.trilinear ? render_double<1>(g, v, rows, out)
                : render_double<0>(g, v, rows, out);
}

} // namespace bench
