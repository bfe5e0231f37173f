// SPDX-License-Identifier: MIT
//
// The core's densities against those of the reader that was written from
// docs/SPEC.md alone, at voxels and between them, for every format with and
// without an apron.
//
// The core is asked through its public functions only. A frame of one pixel
// has its eye at the position in question and steps longer than the pool, so
// the sample k = 0, which is at the eye, is its only one. Then
//
//   - the pixel is black exactly when the density is not above min_density,
//     and min_density can be put between any two codes of the core: two
//     frames tell a density exactly;
//   - the radiance is 1 - exp(-density_scale * d * step).
//
// Densities are counted in the SPEC's units, of which 65280 are density_max;
// density_max is 1 here.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "brume.h"
#include "spec_reader.hpp"
#include "tap.h"

extern "C" {
#include "support/asset_builder.h"
}

using reference::asset;
using reference::ijk;

namespace
{

const double units_of_one = 65280;
const uint32_t one = 65536; // Q16.16
const ijk pool_cells = {3, 2, 2};
const ijk pool_size = pool_cells * 8;

uint32_t random_word()
{
    static uint32_t state = 0x6c078965U;
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state;
}

int random_below(int n)
{
    return static_cast<int>(random_word() % static_cast<uint32_t>(n));
}

// Densities

uint32_t hash(int x, int y, int z)
{
    uint32_t h = static_cast<uint32_t>(x + 64 * (y + 64 * z)) * 0x9e3779b1U;
    h = (h ^ h >> 15) * 0x85ebca6bU;
    return h ^ h >> 13;
}

// No two voxels are likely to be equal, so a wrong address shows. Cells have
// ranges of very different widths, some are empty, and so is the pool's
// outermost layer.
uint32_t patchy(int x, int y, int z, const void *)
{
    static const uint32_t widths[4] = {200, 3000, 20000, 65280};
    const uint32_t cell = hash(x >> 3, 77 + (y >> 3), z >> 3);
    if (x < 1 || y < 1 || z < 1 || x > pool_size.x - 2 || y > pool_size.y - 2 ||
        z > pool_size.z - 2 || cell % 5 == 0)
        return 0;
    const uint32_t width = widths[cell >> 8 & 3];
    const uint32_t base = (cell >> 12) % (65281 - width);
    const uint32_t h = hash(x, y, z);
    return h % 16 == 0 ? 0 : base + (h >> 4) % (width + 1);
}

// Up to the pool's faces.
uint32_t full(int, int, int, const void *)
{
    return 65280;
}

// The core under question

struct position {
    int32_t q[3]; // Q16.16
};

position centre_of(const ijk &v)
{
    return {{v.x * 65536, v.y * 65536, v.z * 65536}};
}

std::string to_text(const position &p)
{
    char text[80];
    std::snprintf(text, sizeof text, "(%.6f,%.6f,%.6f)", p.q[0] / 65536.0,
                  p.q[1] / 65536.0, p.q[2] / 65536.0);
    return text;
}

class core
{
  public:
    core(int format, bool apron, density_fn *density)
    {
        asset_spec spec = asset_spec_of(pool_cells.x, pool_cells.y,
                                        pool_cells.z, format, density, nullptr);
        size_t size;
        spec.apron = apron;
        blob_ = asset_build(&spec, &size);
        if (brume_volume_open(&volume_, blob_, size, 0) != BRUME_OK)
            throw std::runtime_error("the asset does not open");
        bytes_.assign(blob_, blob_ + size);
        set_scene();
    }
    core(const core &) = delete;
    core &operator=(const core &) = delete;
    ~core()
    {
        std::free(blob_);
    }

    const std::vector<uint8_t> &bytes() const
    {
        return bytes_;
    }
    void set_filter(brume_filter filter)
    {
        scene_.filter = static_cast<uint8_t>(filter);
    }
    // Voxels are cut to `units`; 0 to not cut.
    void set_clamp(int units)
    {
        scene_.max_density = between(units);
    }

    // low <= density <= high?
    bool is_within(const position &p, int low, int high)
    {
        scene_.density_scale = uint64_t{1000000} << 32; // any density is black
        return !is_above(p, high) && (low <= 0 || is_above(p, low - 1));
    }

    // In 65536ths, when a density of 1 / scale has optical depth 1.
    int radiance(const position &p, double scale)
    {
        scene_.density_scale = BRUME_Q32(scale / 256);
        scene_.min_density = 0;
        return render(p);
    }

  private:
    void set_scene()
    {
        brume_scene_default(&scene_, &volume_);
        scene_.width = scene_.height = 1;
        scene_.step = BRUME_MAX_STEP; // 256 voxels
        scene_.light_step = one;
        scene_.light = BRUME_NO_LIGHT;
        scene_.jitter = BRUME_JITTER_NONE;
        scene_.output = BRUME_LINEAR;
        for (uint32_t &channel : scene_.background)
            channel = 0;
    }

    // A density half a unit above.
    static uint64_t between(int units)
    {
        return units == 0 ? 0 : BRUME_Q32((units + 0.5) / units_of_one);
    }

    bool is_above(const position &p, int units)
    {
        scene_.min_density = between(units);
        return render(p) > 0;
    }

    // Looks along a direction that changes from call to call: it must not
    // matter.
    int render(const position &p)
    {
        static const int ways[5][3] = {
            {1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {-3, 2, 5}, {2, 7, -4}};
        const int *way = ways[calls_++ % 5];
        for (int i = 0; i < 3; i++) {
            scene_.eye[i] = p.q[i];
            scene_.target[i] = p.q[i] + way[i] * 1000000;
        }
        brume_frame frame;
        uint16_t pixel = 0;
        if (brume_begin_frame(&frame, &volume_, &scene_) != BRUME_OK ||
            brume_render_rect(&frame, 0, 0, 1, 1, BRUME_L16, &pixel, 2) !=
                BRUME_OK)
            throw std::runtime_error("cannot render at " + to_text(p));
        return pixel;
    }

    uint8_t *blob_;
    std::vector<uint8_t> bytes_;
    brume_volume volume_{};
    brume_scene scene_{};
    unsigned calls_ = 0;
};

// What SPEC.md says

// Voxel of a nearest lookup: floor(p + 1/2) on each axis.
ijk nearest_voxel(const position &p)
{
    return {(p.q[0] + 32768) >> 16, (p.q[1] + 32768) >> 16,
            (p.q[2] + 32768) >> 16};
}

int cut(int units, int clamp)
{
    return clamp && units > clamp ? clamp : units;
}

struct estimate {
    double units, tolerance;
};

// The eight voxels around a position blended in double. With an apron they
// are those of one brick, without one (or when voxels are cut) those of the
// pool.
class blend
{
  public:
    blend(const asset &a, int clamp)
        : asset_(a), clamp_(clamp), apron_(a.side == 9 && !clamp)
    {
    }

    // Positions are rounded to 1/256 of a voxel, as the core does. It rounds
    // a blend within a brick twice, to 1/256 of a code and to a unit; of a
    // blend of units the first is to 1/256 of a unit.
    estimate at(const position &p) const
    {
        int low[3];
        double w[3];
        for (int i = 0; i < 3; i++) {
            const int rounded = (p.q[i] + 128) >> 8;
            low[i] = rounded >> 8;
            w[i] = (rounded & 255) / 256.0;
        }
        const ijk first = {low[0], low[1], low[2]};
        double sum = 0;
        for (int k = 0; k < 8; k++) {
            const ijk d = {k & 1, k >> 1 & 1, k >> 2};
            sum += (d.x ? w[0] : 1 - w[0]) * (d.y ? w[1] : 1 - w[1]) *
                   (d.z ? w[2] : 1 - w[2]) * voxel(first, d);
        }
        return {sum, 0.5 + code_step(first) / 512.0};
    }

  private:
    static ijk cell_of(const ijk &v)
    {
        return {v.x >> 3, v.y >> 3, v.z >> 3};
    }

    bool is_occupied(const ijk &cell) const
    {
        return asset_.inside(cell) && asset_.occupied(cell);
    }

    int voxel(const ijk &first, const ijk &d) const
    {
        const ijk cell = cell_of(first);
        if (!apron_)
            return cut(asset_.units_at(first + d).value, clamp_);
        if (!is_occupied(cell))
            return 0;
        const ijk local = first + cell * -8;
        return asset_.units(asset_.brick(cell), local + d).value;
    }

    // Units per code of the brick, at least one.
    int code_step(const ijk &first) const
    {
        const ijk cell = cell_of(first);
        if (clamp_ || !asset_.ranged() || !is_occupied(cell))
            return 1;
        const int scale = asset_.range(asset_.brick(cell))[1];
        return scale > 1 ? scale : 1;
    }

    const asset &asset_;
    int clamp_;
    bool apron_;
};

// Checks

// Counts, and shows the first failure.
class tally
{
  public:
    void note(bool good, const position &p, double want)
    {
        count++;
        if (good)
            return;
        if (failures++ == 0)
            std::printf("# at %s, want %.3f units\n", to_text(p).c_str(), want);
    }
    int count = 0, failures = 0;
};

std::string name_of(int format, bool apron)
{
    static const char *const names[] = {"", "u8", "u8r", "u4r"};
    return std::string(names[format]) + (apron ? " with apron" : "");
}

// The asset says what it was made from: else both readers could be wrong.
void check_voxels(const asset &a, const std::string &name)
{
    int failures = 0;
    for (int i = 0; i < pool_size.x * pool_size.y * pool_size.z; i++) {
        const ijk v = ijk_of(static_cast<size_t>(i), pool_size);
        const reference::density_units u = a.units_at(v);
        const int want = static_cast<int>(patchy(v.x, v.y, v.z, nullptr));
        failures += 2 * std::abs(u.value - want) > u.step;
    }
    tap_check(failures == 0, "%s: voxels are within half a code", name.c_str());
}

void check_centres(core &c, const asset &a, const std::string &name)
{
    tally exact, radiance;
    c.set_filter(BRUME_NEAREST);
    for (int i = 0; i < pool_size.x * pool_size.y * pool_size.z; i++) {
        const ijk v = ijk_of(static_cast<size_t>(i), pool_size);
        const position p = centre_of(v);
        const int want = a.units_at(v).value;
        exact.note(c.is_within(p, want, want), p, want);
        // Optical depth 1 at the density that is expected, where the curve
        // is steep. Half a unit of rounding, and 1.0 is shown as 65535.
        const double scale = units_of_one / (want > 0 ? want : 1);
        const double expected = 65536 * (want > 0 ? 1 - std::exp(-1.0) : 0);
        radiance.note(std::fabs(c.radiance(p, scale) - expected) <= 1, p, want);
    }
    tap_check(exact.failures == 0, "%s: every voxel (%d) exactly", name.c_str(),
              exact.count);
    tap_check(radiance.failures == 0, "%s: and its radiance within 1 of 65536",
              name.c_str());
}

// Mostly in the pool, and on one position in two an axis near a cell's face.
position random_position()
{
    const int n[3] = {pool_size.x, pool_size.y, pool_size.z};
    position p;
    for (int i = 0; i < 3; i++)
        p.q[i] = random_below((n[i] + 2) * 65536) - 65536;
    const int axis = random_below(6);
    if (axis < 3) {
        const int cell = random_below(n[axis] / 8 + 1);
        p.q[axis] = cell * 8 * 65536 + random_below(3 * 65536) - 2 * 65536;
    }
    return p;
}

// On and next to the border of two voxels as well.
position near_half(position p)
{
    const int axis = random_below(3);
    const int32_t half = (p.q[axis] & ~0xffff) + 32768;
    p.q[axis] = half - random_below(2);
    return p;
}

void check_nearest(core &c, const asset &a, int clamp, const std::string &name)
{
    tally exact;
    c.set_filter(BRUME_NEAREST);
    c.set_clamp(clamp);
    for (int i = 0; i < 1500; i++) {
        position p = random_position();
        if (i % 3 == 0)
            p = near_half(p);
        const int want = cut(a.units_at(nearest_voxel(p)).value, clamp);
        exact.note(c.is_within(p, want, want), p, want);
    }
    c.set_clamp(0);
    tap_check(exact.failures == 0,
              "%s: nearest at %d positions%s, borders of voxels among them",
              name.c_str(), exact.count, clamp ? " under max_density" : "");
}

void check_trilinear(core &c, const asset &a, int clamp,
                     const std::string &name)
{
    tally bounds, radiance;
    const blend blended(a, clamp);
    c.set_filter(BRUME_TRILINEAR);
    c.set_clamp(clamp);
    for (int i = 0; i < 2500; i++) {
        position p = random_position();
        for (int k = 0; i % 2 == 0 && k < 3; k++)
            p.q[k] &= ~255; // a multiple of 1/256
        const estimate want = blended.at(p);
        const int low =
            static_cast<int>(std::ceil(want.units - want.tolerance - 1e-6));
        const int high = static_cast<int>(want.units + want.tolerance + 1e-6);
        bounds.note(c.is_within(p, low, high), p, want.units);
        const double from = want.units > 1 ? want.units : 1;
        const int got = c.radiance(p, units_of_one / from);
        const double least = (want.units - want.tolerance) / from;
        const double most = (want.units + want.tolerance) / from;
        radiance.note(got >= 65536 * (1 - std::exp(-least)) - 1 &&
                          got <= 65536 * (1 - std::exp(-most)) + 1,
                      p, want.units);
    }
    c.set_clamp(0);
    tap_check(bounds.failures == 0,
              "%s: trilinear at %d positions%s, within 1/2 unit + 1/512 code",
              name.c_str(), bounds.count, clamp ? " under max_density" : "");
    tap_check(radiance.failures == 0, "%s: and its radiance", name.c_str());
}

// The pool begins at -1/2 and ends before size - 1/2, to a 65536th.
void check_pool_faces(int format, bool apron, const std::string &name)
{
    core c(format, apron, full);
    const int n[3] = {pool_size.x, pool_size.y, pool_size.z};
    tally exact;
    c.set_filter(BRUME_NEAREST);
    for (int axis = 0; axis < 3; axis++)
        for (int outside = 0; outside < 2; outside++) {
            const int want = outside ? 0 : 65280;
            position p = centre_of({9, 9, 9});
            p.q[axis] = -32768 - outside;
            exact.note(c.is_within(p, want, want), p, want);
            p.q[axis] = n[axis] * 65536 - 32768 - !outside;
            exact.note(c.is_within(p, want, want), p, want);
        }
    tap_check(exact.failures == 0, "%s: the pool's six faces to 1/65536",
              name.c_str());
}

void check_format(int format, bool apron)
{
    const std::string name = name_of(format, apron);
    core c(format, apron, patchy);
    const asset a(c.bytes());
    check_voxels(a, name);
    check_centres(c, a, name);
    check_nearest(c, a, 0, name);
    check_trilinear(c, a, 0, name);
    // Two fifths, and not the density of a code.
    check_nearest(c, a, 26113, name);
    check_trilinear(c, a, 26113, name);
    check_pool_faces(format, apron, name);
}

} // namespace

int main()
{
    try {
        for (int format = BRUME_U8; format <= BRUME_U4R; format++)
            for (bool apron : {false, true})
                check_format(format, apron);
    } catch (const std::exception &e) {
        tap_check(false, "no surprise: %s", e.what());
    }
    return tap_done();
}
