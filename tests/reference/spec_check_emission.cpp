// SPDX-License-Identifier: MIT
//
// The second grid, EMIT, against what SPEC.md says is in it, and against the
// dump of its values before quantisation.

#include <algorithm>
#include <cmath>

#include "findings.hpp"

namespace reference
{

bool glows(const asset &a, const ijk &cell)
{
    const int n = a.side;
    for (int i = 0; a.emission && i < n * n * n; i++)
        if (a.emission_at(cell * 8 + ijk{i % n, i / n % n, i / n / n}) != 0)
            return true;
    return false;
}

static void check_largest(const asset &a, findings &found)
{
    bool any = false;
    for (uint32_t b = 0; b < a.bricks; b++)
        for (int i = 0; i < 512; i++)
            any = any || a.emission_code(b, {i & 7, i >> 3 & 7, i >> 6}) != 0;
    if (any && !(a.emission->value > 0))
        found.add("emission", "codes that stand for nothing");
}

void check_emission(const asset &a, findings &found)
{
    if (!a.emission)
        return;
    check_largest(a, found);
    for (size_t i = 0; i < a.cell_count(); i++) {
        const ijk cell = ijk_of(i, a.cells);
        if (!a.occupied(cell) && glows(a, cell))
            found.add("emission", "cell " + to_text(cell) +
                                      " is empty and its neighbours glow");
    }
}

void check_emission_against(const asset &a, const float_dump &dump,
                            findings &found)
{
    const ijk size = a.size();
    if (!a.emission ||
        dump.size != std::array<int, 3>{size.x, size.y, size.z}) {
        found.add("emission", "there is none, or the dump has another size");
        return;
    }
    for (size_t i = 0; i < dump.voxels.size(); i++) {
        const ijk v = ijk_of(i, size);
        const double value = static_cast<double>(dump.voxels[i]);
        const double want =
            a.emission->value > 0 ? 255 * value / a.emission->value : 0;
        const int code = a.emission_at(v);
        if (!(std::fabs(code - want) <= 0.5 + 1e-6) ||
            (value == 0 && code != 0))
            found.add("emission", "voxel " + to_text(v) + " has code " +
                                      std::to_string(code) + " for " +
                                      std::to_string(want));
    }
}

} // namespace reference
