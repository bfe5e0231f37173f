// SPDX-License-Identifier: MIT

#include "spec_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "findings.hpp"

namespace reference {

namespace {

const double infinity = std::numeric_limits<double>::infinity();

/// Layout ///

bool all_zero(const asset &a, size_t from, size_t to)
{
    return std::all_of(a.blob() + from, a.blob() + to,
                       [](uint8_t b) { return b == 0; });
}

void check_reserved(const asset &a, findings &found)
{
    std::vector<std::pair<size_t, size_t>> fields = {{26, 2}, {76, 4}};
    for (size_t i = 0; i < a.sections.size(); i++)
        fields.emplace_back(176 + 16 * i + 12, 4);
    for (const auto &[at, bytes] : fields)
        if (!all_zero(a, at, at + bytes))
            found.add("reserved", "byte " + std::to_string(at) +
                                      " is not zero");
}

void check_gaps(const asset &a, findings &found)
{
    std::vector<section> sorted = a.sections;
    std::sort(sorted.begin(), sorted.end(),
              [](const section &p, const section &q) {
                  return std::make_pair(p.offset, p.bytes) <
                         std::make_pair(q.offset, q.bytes);
              });
    sorted.push_back({"end", a.blob_size(), 0});
    size_t end = 176 + 16 * a.sections.size();
    for (const section &s : sorted) {
        if (s.offset < end)
            found.add("sections", s.id + " overlaps another");
        else if (!all_zero(a, end, s.offset))
            found.add("gap", "non-zero bytes before " + s.id);
        end = std::max(end, s.offset + s.bytes);
    }
}

// With side 9 the codes end before the brick does; the unused half byte of
// u4r counts as padding too.
void check_brick_padding(const asset &a, findings &found)
{
    if (a.side == 8)
        return;
    const bool nibbles = a.format == code_format::u4r;
    for (uint32_t b = 0; b < a.bricks; b++) {
        const uint8_t *data = a.brick_data(b);
        bool zero = !nibbles || data[364] >> 4 == 0;
        for (size_t i = a.brick_bytes() - 3; i < a.brick_bytes(); i++)
            zero = zero && data[i] == 0;
        if (!zero)
            found.add("padding", "brick " + std::to_string(b) +
                                     " does not end in zeros");
    }
}

// How many bytes follow the first of a character; -1 when none may start so.
int utf8_tail(uint8_t lead)
{
    if (lead < 0x80)
        return 0;
    if (lead < 0xc2 || lead > 0xf4)
        return -1;
    return lead < 0xe0 ? 1 : lead < 0xf0 ? 2 : 3;
}

bool is_utf8(const uint8_t *s, size_t count)
{
    for (size_t i = 0; i < count;) {
        int tail = utf8_tail(s[i++]);
        if (tail < 0)
            return false;
        for (; tail > 0; tail--)
            if (i == count || s[i++] >> 6 != 2)
                return false;
    }
    return true;
}

void check_name(const asset &a, findings &found)
{
    const section *s = a.find("NAME");
    if (!s)
        return;
    const uint8_t *name = a.blob() + s->offset;
    if (s->bytes > 255)
        found.add("name", "longer than 255 bytes");
    if (s->bytes && name[s->bytes - 1] == 0)
        found.add("name", "ends in a zero");
    if (!is_utf8(name, s->bytes))
        found.add("name", "is not UTF-8");
}

// Relative, of squares: files often hold matrices made in single precision.
const double tolerance = 1e-6;

void check_transform(const asset &a, findings &found)
{
    const std::array<double, 12> &m = a.world_from_index;
    const auto row_dot = [&m](size_t i, size_t j) {
        return m[4 * i] * m[4 * j] + m[4 * i + 1] * m[4 * j + 1] +
               m[4 * i + 2] * m[4 * j + 2];
    };
    const double scale2 = row_dot(0, 0), slack = tolerance * scale2;
    const double determinant = m[0] * (m[5] * m[10] - m[6] * m[9]) -
                               m[1] * (m[4] * m[10] - m[6] * m[8]) +
                               m[2] * (m[4] * m[9] - m[5] * m[8]);
    // Written so that a NaN fails too.
    if (!(std::fabs(row_dot(1, 1) - scale2) <= slack &&
          std::fabs(row_dot(2, 2) - scale2) <= slack &&
          std::fabs(row_dot(0, 1)) <= slack &&
          std::fabs(row_dot(0, 2)) <= slack &&
          std::fabs(row_dot(1, 2)) <= slack && scale2 > 0))
        found.add("transform", "not one scale times a rotation");
    else if (determinant < 0)
        found.add("transform", "mirrors");
}

/// Cells ///

// The Chebyshev distance of every cell to the nearest occupied one: breadth
// first over the 26 neighbours, whose path length is that distance.
std::vector<int> exact_distances(const asset &a)
{
    std::vector<int> distance(a.cell_count(), -1);
    std::vector<size_t> queue;
    for (size_t i = 0; i < distance.size(); i++)
        if (a.occupied(ijk_of(i, a.cells))) {
            distance[i] = 0;
            queue.push_back(i);
        }
    const long nx = a.cells.x, ny = a.cells.y;
    for (size_t head = 0; head < queue.size(); head++) {
        const size_t from = queue[head];
        for (int n = 0; n < 27; n++) {
            const ijk d = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
            if (!a.inside(ijk_of(from, a.cells) + d))
                continue;
            const size_t to = static_cast<size_t>(
                static_cast<long>(from) + d.x + nx * (d.y + ny * d.z));
            if (distance[to] < 0) {
                distance[to] = distance[from] + 1;
                queue.push_back(to);
            }
        }
    }
    return distance;
}

void check_distances(const asset &a, findings &found)
{
    const std::vector<int> exact = exact_distances(a);
    for (size_t i = 0; i < exact.size(); i++) {
        const ijk cell = ijk_of(i, a.cells);
        const int want =
            exact[i] < 0 ? 255 : std::min(exact[i], 255); // < 0: no bricks
        if (a.distance(cell) != want)
            found.add("distance", "cell " + to_text(cell) + " says " +
                                      std::to_string(a.distance(cell)) +
                                      " instead of " + std::to_string(want));
    }
}

/// Bricks ///

// Own voxels and apron.
bool brick_is_zero(const asset &a, uint32_t brick)
{
    const int n = a.side;
    for (int i = 0; i < n * n * n; i++)
        if (a.units(brick, {i % n, i / n % n, i / n / n}).value != 0)
            return false;
    return true;
}

void check_occupancy(const asset &a, findings &found)
{
    std::vector<bool> used(a.bricks, false), glowing(a.bricks, false);
    for (size_t i = 0; i < a.cell_count(); i++) {
        const ijk cell = ijk_of(i, a.cells);
        if (!a.occupied(cell))
            continue;
        used[a.brick(cell)] = true;
        if (glows(a, cell))
            glowing[a.brick(cell)] = true;
    }
    for (uint32_t b = 0; b < a.bricks; b++) {
        if (!used[b])
            found.add("unused", "no cell holds brick " + std::to_string(b));
        if (brick_is_zero(a, b) && !glowing[b])
            found.add("zero brick", "brick " + std::to_string(b) +
                                        " stands for an empty cell");
    }
}

void check_shared(const asset &a, findings &found)
{
    std::map<std::string, uint32_t> first;
    for (uint32_t b = 0; b < a.bricks; b++) {
        const uint8_t *data = a.brick_data(b);
        std::string key(data, data + a.brick_bytes());
        if (a.ranged())
            for (int value : a.range(b))
                key += "," + std::to_string(value);
        for (int i = 0; a.emission && i < 512; i++)
            key += static_cast<char>(
                a.emission_code(b, {i & 7, i >> 3 & 7, i >> 6}));
        const auto [at, fresh] = first.emplace(std::move(key), b);
        if (!fresh)
            found.add("identical", "bricks " + std::to_string(at->second) +
                                       " and " + std::to_string(b));
    }
}

// Every voxel in the last plane of an axis of a brick of side 9.
template <typename F> void for_each_apron_voxel(F visit)
{
    for (int i = 0; i < 9 * 9 * 9; i++) {
        const ijk v = {i % 9, i / 9 % 9, i / 81};
        if (v.x == 8 || v.y == 8 || v.z == 8)
            visit(v);
    }
}

// The densities, in units, that are written as this code: half a step to
// either side, and all that lies beyond the ends of the brick's range. Half a
// unit more, as a base may itself have been rounded.
struct code_interval {
    double low, high;
};

code_interval written_as(const density_units &u)
{
    const double reach = 0.5 * u.step + 0.5;
    const bool ends = u.step > 0; // else the brick is constant
    return {u.lowest && ends ? -infinity : u.value - reach,
            u.highest && ends ? infinity : u.value + reach};
}

// u8 codes repeat exactly. Two bricks with ranges of their own write one
// density as different codes: there must be one that gives both.
bool apron_agrees(const asset &a, const density_units &here,
                  const density_units &there)
{
    if (!a.ranged())
        return here.value == there.value;
    const code_interval p = written_as(here), q = written_as(there);
    return p.low <= q.high && q.low <= p.high;
}

void check_aprons(const asset &a, findings &found)
{
    if (a.side == 8)
        return;
    for (size_t i = 0; i < a.cell_count(); i++) {
        const ijk cell = ijk_of(i, a.cells);
        for_each_apron_voxel([&](const ijk &v) {
            const density_units there = a.units_at(cell * 8 + v);
            if (!a.occupied(cell)) {
                if (there.value != 0)
                    found.add("apron", "cell " + to_text(cell) +
                                           " is empty, its apron is not");
                return;
            }
            const density_units here = a.units(a.brick(cell), v);
            if (!apron_agrees(a, here, there))
                found.add("apron",
                          "cell " + to_text(cell) + " voxel " + to_text(v) +
                              " has " + std::to_string(here.value) +
                              " for " + std::to_string(there.value));
        });
    }
}

/// Voxels ///

struct voxel_summary {
    ijk low, high; // the box of the voxels that are not zero, of both grids
    uint64_t count;
    double sum; // density
};

void widen(const ijk &v, voxel_summary &s)
{
    s.low = {std::min(s.low.x, v.x), std::min(s.low.y, v.y),
             std::min(s.low.z, v.z)};
    s.high = {std::max(s.high.x, v.x), std::max(s.high.y, v.y),
              std::max(s.high.z, v.z)};
}

void add_voxel(const ijk &v, double density, voxel_summary &s)
{
    widen(v, s);
    s.count++;
    s.sum += density;
}

voxel_summary summarise(const asset &a)
{
    voxel_summary s = {a.size(), {-1, -1, -1}, 0, 0};
    for (size_t i = 0; i < a.cell_count(); i++) {
        const ijk cell = ijk_of(i, a.cells);
        for (int n = 0; n < 512 && a.occupied(cell); n++) {
            const ijk v = cell * 8 + ijk{n & 7, n >> 3 & 7, n >> 6};
            if (a.units_at(v).value != 0)
                add_voxel(v, a.density(v), s);
            if (a.emission_at(v) != 0)
                widen(v, s);
        }
    }
    return s;
}

bool same(const ijk &a, const ijk &b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

void check_outer_layer(const asset &a, const voxel_summary &s,
                       findings &found)
{
    const ijk last = a.size() + ijk{-1, -1, -1};
    if (s.low.x == 0 || s.low.y == 0 || s.low.z == 0 ||
        s.high.x == last.x || s.high.y == last.y || s.high.z == last.z)
        found.add("border", "the outermost layer is not zero: " +
                                to_text(s.low) + " to " + to_text(s.high));
}

// The header tells of the voxels before quantisation, which may turn the
// faintest to 0. Their sum is kept "near": within a percent, or the half step
// that 8 bits are off by.
void check_mean(const asset &a, const voxel_summary &s, findings &found)
{
    const double mean = s.sum / a.voxels;
    const double slack =
        std::max(0.01 * a.density_mean, a.density_max / 510);
    if (!(std::fabs(mean - a.density_mean) <= slack))
        found.add("density_mean", std::to_string(a.density_mean) +
                                      " instead of " + std::to_string(mean));
}

bool within(const ijk &p, const ijk &low, const ijk &high)
{
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x &&
           p.y <= high.y && p.z <= high.z;
}

void check_voxels(const asset &a, findings &found)
{
    const voxel_summary s = summarise(a);
    if (std::min<uint64_t>(s.count, 0xffffffffU) > a.voxels)
        found.add("voxels", std::to_string(a.voxels) + " of " +
                                std::to_string(s.count));
    const bool nothing = s.high.x < 0;
    if (nothing != (a.bricks == 0))
        found.add("bricks", std::to_string(a.bricks) + " bricks hold " +
                                std::to_string(s.count) + " voxels");
    if (nothing)
        return;
    if (!within(s.low, a.box_min, a.box_max) ||
        !within(s.high, a.box_min, a.box_max))
        found.add("box", to_text(a.box_min) + " to " + to_text(a.box_max) +
                             " lacks some of " + to_text(s.low) + " to " +
                             to_text(s.high));
    check_outer_layer(a, s, found);
    if (s.count > 0)
        check_mean(a, s, found);
}

/// Against the voxels before quantisation ///

// Whether this is the nearest code that there is for the density.
bool well_quantised(const asset &a, const density_units &u, double density)
{
    // Without density there is no unit; 0 is 0.
    const double in_units = density == 0 ? 0 : density * 65280 / a.density_max;
    const double slack = 1e-9 * 65280;
    // An empty cell holds what rounds to code 0 in u8, else to no unit.
    const code_interval empty = {0, a.ranged() ? 0.5 : 128};
    const code_interval i = u.stored ? written_as(u) : empty;
    return in_units >= i.low - slack && in_units <= i.high + slack;
}

voxel_summary compare_voxels(const asset &a, const float_dump &dump,
                             findings &found)
{
    voxel_summary s = {a.size(), {-1, -1, -1}, 0, 0};
    for (size_t i = 0; i < dump.voxels.size(); i++) {
        const ijk v = ijk_of(i, a.size());
        const double want = static_cast<double>(dump.voxels[i]);
        const bool zero_lost = want == 0 && a.units_at(v).value != 0;
        if (zero_lost || !well_quantised(a, a.units_at(v), want))
            found.add(zero_lost ? "zero" : "quantisation",
                      "voxel " + to_text(v) + " is " +
                          std::to_string(a.density(v)) + " for " +
                          std::to_string(want));
        if (want != 0)
            add_voxel(v, want, s);
    }
    return s;
}

} // namespace

std::vector<std::string> check_asset(const asset &a)
{
    findings found;
    check_reserved(a, found);
    check_gaps(a, found);
    check_brick_padding(a, found);
    check_name(a, found);
    check_transform(a, found);
    check_distances(a, found);
    check_occupancy(a, found);
    check_shared(a, found);
    check_aprons(a, found);
    check_voxels(a, found);
    check_light(a, found);
    check_emission(a, found);
    return found.lines();
}

std::vector<std::string> check_against(const asset &a, const float_dump &dump,
                                       const float_dump *glow)
{
    findings found;
    const ijk size = a.size();
    const std::array<int, 3> origin = {a.origin.x, a.origin.y, a.origin.z};
    if (dump.size != std::array<int, 3>{size.x, size.y, size.z}) {
        found.add("dump", "has another size");
        return found.lines();
    }
    if (dump.origin != origin || dump.world_from_index != a.world_from_index)
        found.add("dump", "has another origin or transform");
    voxel_summary s = compare_voxels(a, dump, found);
    if (glow != nullptr)
        check_emission_against(a, *glow, found);
    for (size_t i = 0; glow != nullptr && i < glow->voxels.size(); i++)
        if (glow->voxels[i] > 0)
            widen(ijk_of(i, size), s);
    if (std::min<uint64_t>(s.count, 0xffffffffU) != a.voxels)
        found.add("voxels", std::to_string(a.voxels) + " instead of " +
                                std::to_string(s.count));
    if (s.high.x < 0)
        return found.lines();
    if ((glow != nullptr || !a.emission) &&
        (!same(s.low, a.box_min) || !same(s.high, a.box_max)))
        found.add("box", to_text(a.box_min) + " to " + to_text(a.box_max) +
                             " instead of " + to_text(s.low) + " to " +
                             to_text(s.high));
    const double mean =
        s.count > 0 ? s.sum / static_cast<double>(s.count) : 0;
    if (!(std::fabs(a.density_mean - mean) <= 1e-6 * mean))
        found.add("density_mean", std::to_string(a.density_mean) +
                                      " instead of " + std::to_string(mean));
    return found.lines();
}

} // namespace reference
