// SPDX-License-Identifier: MIT
//
// The shadow that a volume throws on other things, against the definition of
// docs/light.md in double over what the reader of docs/SPEC.md finds in the
// asset, and against closed forms.

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "brume.h"
#include "reference/spec_reader.hpp"
#include "reference/volume.hpp"
#include "tap.h"

extern "C" {
#include "support/asset_builder.h"
}

using reference::vec3;

namespace
{

const double one = 65536; // Q16.16
const double degree = 3.14159265358979323846 / 180;
const double no_limit = 1e30;

/// Volumes ///

struct built {
    std::vector<uint8_t> bytes;
    brume_volume volume;
};

// Assets lie at a multiple of 4, as a vector's memory does.
built build(const asset_spec &spec)
{
    built out;
    size_t size;
    uint8_t *asset = asset_build(&spec, &size);
    out.bytes.assign(asset, asset + size);
    free(asset);
    if (brume_volume_open(&out.volume, out.bytes.data(), size, 0) != BRUME_OK)
        abort();
    return out;
}

const density_cloud cloud = {40, 5};

built cloud_of(int format, bool apron)
{
    asset_spec spec = asset_spec_of(5, 5, 5, format, density_in_cloud, &cloud);
    spec.apron = apron;
    return build(spec);
}

// 16 voxels a side in the middle of 32: faces at 7.5 and 23.5.
built cube()
{
    static const density_box box = {{8, 8, 8}, {24, 24, 24}, 65280};
    return build(asset_spec_of(4, 4, 4, BRUME_U8, density_in_box, &box));
}

reference::volume decode(const built &b, double max_density)
{
    const reference::asset a(b.bytes);
    reference::float_dump dump;
    const reference::ijk size = a.size();
    dump.size = {size.x, size.y, size.z};
    dump.world_from_index = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    for (size_t i = 0; i < reference::volume_of(size); i++)
        dump.voxels.push_back(
            static_cast<float>(a.density(reference::ijk_of(i, size))));
    return reference::volume(dump, max_density);
}

/// Maps ///

void set(int32_t out[3], const vec3 &v)
{
    const double p[3] = {v.x, v.y, v.z};
    for (int i = 0; i < 3; i++)
        out[i] = static_cast<int32_t>(std::floor(p[i] * one + 0.5));
}

vec3 of_q16(const int32_t q[3])
{
    return vec3{q[0] / one, q[1] / one, q[2] / one};
}

// Texels on the plane y = height, around where the cloud's shadow falls.
brume_shadow_map plane(double height, double azimuth, double elevation)
{
    const double away = (20 - height) / std::tan(elevation * degree);
    const double x = 20 - away * std::sin(azimuth * degree);
    const double z = 20 - away * std::cos(azimuth * degree);
    const double half = 40;
    brume_shadow_map map = {};
    map.width = 48;
    map.height = 40;
    map.step = 0x8000;
    set(map.origin, vec3{x - half, height, z - half});
    set(map.across, vec3{2 * half, 0, 0});
    set(map.down, vec3{0, 0, 2 * half});
    return map;
}

brume_scene scene_of(const built &b, double azimuth, double elevation)
{
    brume_scene s;
    brume_scene_default(&s, &b.volume);
    s.light_density_scale = BRUME_Q32(0.15);
    brume_direction(s.sun, static_cast<int32_t>(azimuth * one),
                    static_cast<int32_t>(elevation * one));
    return s;
}

struct texels {
    std::vector<uint8_t> light;
    std::vector<brume_shadow_depth> depth;
};

// In rectangles of w x h.
texels render(const built &b, const brume_scene &scene,
              const brume_shadow_map &map, unsigned w, unsigned h, bool depth)
{
    static brume_shadow shadow;
    const size_t all = size_t(map.width) * map.height;
    texels out = {std::vector<uint8_t>(all, 77),
                  std::vector<brume_shadow_depth>(all)};
    if (brume_shadow_begin(&shadow, &b.volume, &scene, &map) != BRUME_OK)
        abort();
    for (unsigned y = 0; y < map.height; y += h)
        for (unsigned x = 0; x < map.width; x += w) {
            const size_t at = size_t(y) * map.width + x;
            const unsigned n = map.width - x < w ? map.width - x : w;
            const unsigned m = map.height - y < h ? map.height - y : h;
            if (brume_shadow_rect(&shadow, x, y, n, m, &out.light[at],
                                  map.width, depth ? &out.depth[at] : nullptr,
                                  map.width) != BRUME_OK)
                abort();
        }
    return out;
}

texels render(const built &b, const brume_scene &scene,
              const brume_shadow_map &map, bool depth = false)
{
    return render(b, scene, map, map.width, map.height, depth);
}

bool same(const texels &a, const texels &b)
{
    return a.light == b.light &&
           std::memcmp(a.depth.data(), b.depth.data(),
                       a.depth.size() * sizeof a.depth[0]) == 0;
}

/// Reference ///

struct exact {
    double transmittance, sum;
    double front, mean; // distances, NaN without density
    double dense;       // the first with more density than 1/256
};

vec3 texel_of(const brume_shadow_map &map, int x, int y)
{
    vec3 p = of_q16(map.origin) + of_q16(map.across) * ((x + 0.5) / map.width) +
             of_q16(map.down) * ((y + 0.5) / map.height);
    if (map.heights != nullptr)
        p = p + of_q16(map.rise) *
                    (map.heights[size_t(y) * map.heights_stride + size_t(x)] /
                     65536.0);
    return p;
}

exact march(const reference::volume &volume, const brume_scene &s,
            const brume_shadow_map &map, const vec3 &from)
{
    const double step = map.step / one;
    const double scale = double(s.light_density_scale) / 4294967296.0;
    const vec3 sun =
        normalise(vec3{double(s.sun[0]), double(s.sun[1]), double(s.sun[2])});
    const auto filter = s.filter == BRUME_NEAREST
                            ? reference::lookup::nearest
                            : reference::lookup::trilinear;
    double sum = 0, moment = 0, front = NAN, dense = NAN;
    for (double t = step / 2; t < 1200; t += step) {
        const double d = volume.density(from + sun * t, filter);
        front = d > 0 && sum == 0 ? t : front;
        dense = d > 1.0 / 256 && std::isnan(dense) ? t : dense;
        sum += d;
        moment += d * t;
    }
    return {std::exp(-scale * step * sum), sum, front, moment / sum, dense};
}

struct error {
    double rmse, mean;
    int grey; // texels that are neither black nor lit
};

error compare(const built &b, const brume_scene &s, const brume_shadow_map &map)
{
    const double limit = double(s.max_density) / 4294967296.0;
    const reference::volume volume = decode(b, limit > 0 ? limit : no_limit);
    const texels got = render(b, s, map);
    double sum = 0, square = 0;
    int grey = 0;
    for (int y = 0; y < map.height; y++)
        for (int x = 0; x < map.width; x++) {
            const uint8_t code = got.light[size_t(y * map.width + x)];
            const double want =
                255 * march(volume, s, map, texel_of(map, x, y)).transmittance;
            sum += code - want;
            square += (code - want) * (code - want);
            grey += code > 2 && code < 253;
        }
    const double n = double(map.width) * map.height;
    return {std::sqrt(square / n), sum / n, grey};
}

void check_error(const error &e, const std::string &what)
{
    tap_check(e.rmse <= 0.5 && std::fabs(e.mean) <= 0.1 && e.grey > 100,
              "%s: RMSE %.3f, mean %+.3f of 255, %d grey texels", what.c_str(),
              e.rmse, e.mean, e.grey);
}

/// Tests ///

void test_formats()
{
    static const char *const names[] = {"", "u8", "u8r", "u4r"};
    for (int format = BRUME_U8; format <= BRUME_U4R; format++)
        for (int apron = 0; apron < 2; apron++)
            for (int filter = 0; filter < 2; filter++)
                for (int limit = 0; limit < 2; limit++) {
                    const built b = cloud_of(format, apron != 0);
                    brume_scene s = scene_of(b, -60, 35);
                    s.filter = uint8_t(filter);
                    s.max_density = limit ? BRUME_Q32(0.4) : 0;
                    check_error(compare(b, s, plane(-10, -60, 35)),
                                std::string(names[format]) +
                                    (apron ? ", apron" : "") +
                                    (filter ? ", trilinear" : ", nearest") +
                                    (limit ? ", max_density" : ""));
                }
}

void test_suns()
{
    static const double elevations[] = {10, 35, 80, 90, -20, -90};
    const built b = cloud_of(BRUME_U8R, false);
    for (double e : elevations)
        for (double azimuth : {0.0, 25.0, 135.0, 270.0}) {
            const double height = e < 0 ? 60 : -10;
            check_error(
                compare(b, scene_of(b, azimuth, e), plane(height, azimuth, e)),
                "sun at " + std::to_string(int(azimuth)) + ", " +
                    std::to_string(int(e)) + " degrees");
        }
    const brume_scene s = scene_of(b, 0, -20);
    const texels below = render(b, s, plane(-10, 0, 35));
    bool lit = true;
    for (uint8_t code : below.light)
        lit = lit && code == 255;
    tap_check(lit, "sun below the horizon: the ground below is not in shadow");
}

// Planes through the cloud and across it, and one upright.
void test_planes()
{
    const built b = cloud_of(BRUME_U8, false);
    const brume_scene s = scene_of(b, 40, 50);
    check_error(compare(b, s, plane(20, 40, 50)), "a plane through the cloud");
    brume_shadow_map map = plane(0, 40, 50);
    set(map.origin, vec3{8, 0, 40});
    set(map.across, vec3{32, 4, -40});
    set(map.down, vec3{-3, 40, 5});
    check_error(compare(b, s, map), "an upright plane in the cloud");
    for (uint32_t step : {0x1000u, 0x1b333u, 0x40000u}) {
        map = plane(-10, 40, 50);
        map.step = step;
        check_error(compare(b, s, map),
                    "steps of " + std::to_string(step / one) + " voxels");
    }
}

void test_heights()
{
    const built b = cloud_of(BRUME_U8R, false);
    const brume_scene s = scene_of(b, -60, 35);
    const brume_shadow_map flat = plane(-10, -60, 35);
    brume_shadow_map map = flat;
    std::vector<uint16_t> heights(50 * 40, 32768);
    map.heights = heights.data();
    map.heights_stride = 50;
    set(map.rise, vec3{0, 16, 0});
    set(map.origin, of_q16(flat.origin) - vec3{0, 8, 0});
    tap_check(same(render(b, s, map, true), render(b, s, flat, true)),
              "an even height field is a plane");
    for (size_t i = 0; i < heights.size(); i++)
        heights[i] = uint16_t(i * 40503);
    check_error(compare(b, s, map), "an uneven height field");
    map.heights = nullptr;
    map.origin[1] = flat.origin[1];
    tap_check(same(render(b, s, map, true), render(b, s, flat, true)),
              "without heights `rise` does nothing");
}

void test_cuts()
{
    const built b = cloud_of(BRUME_U4R, false);
    brume_scene s = scene_of(b, -60, 35);
    brume_shadow_map map = plane(-10, -60, 35);
    std::vector<uint16_t> heights(48 * 40);
    for (size_t i = 0; i < heights.size(); i++)
        heights[i] = uint16_t(i * 40503);
    map.heights = heights.data();
    map.heights_stride = 48;
    map.rise[1] = 8 << 16;
    const texels whole = render(b, s, map, true);
    static const unsigned sizes[][2] = {{1, 1}, {7, 5}, {48, 1}, {1, 40}};
    bool good = true;
    for (const auto &size : sizes)
        good = good && same(render(b, s, map, size[0], size[1], true), whole);
    tap_check(good, "any cutting into rectangles gives the same bytes");
    tap_check(render(b, s, map, false).light == whole.light,
              "nor does it matter whether depth is wanted");
    s.skip = false;
    tap_check(same(render(b, s, map, true), whole), "skip on and off");
    s.filter = BRUME_STOCHASTIC;
    tap_check(same(render(b, s, map, true), whole), "stochastic: as trilinear");
    s.jitter = BRUME_JITTER_BOTH;
    s.eye[0] += 12345;
    s.density_scale = s.density_scale * 2;
    s.min_density = BRUME_Q32(0.3);
    tap_check(same(render(b, s, map, true), whole),
              "camera, noise and view rays are nothing to it");
}

// exp(-sigma * length) with the sun above, at 90 degrees and aslant.
void test_closed_form()
{
    const built b = cube();
    brume_scene s = scene_of(b, 0, 90);
    s.filter = BRUME_NEAREST;
    s.light_density_scale = BRUME_Q32(0.1);
    brume_shadow_map map = {};
    map.width = map.height = 1;
    map.step = 0x4000;
    set(map.origin, vec3{15.5, -8, 15.5});
    tap_check(render(b, s, map).light[0] == std::lround(255 * std::exp(-1.6)),
              "a block of 16 voxels: 255 exp(-1.6)");
    set(map.origin, vec3{15.5, 15.5, 15.5});
    tap_check(render(b, s, map).light[0] == std::lround(255 * std::exp(-0.8)),
              "from its middle: 255 exp(-0.8)");
    set(map.origin, vec3{15.5, 24, 15.5});
    tap_check(render(b, s, map).light[0] == 255, "from above: 255");
    brume_direction(s.sun, 90 << 16, 30 << 16);
    map.step = 0x1000;
    set(map.origin, vec3{15.5 - 16 * std::cos(30 * degree), 7.5, 15.5});
    const double length = 16 / std::cos(30 * degree);
    const int want = int(std::lround(255 * std::exp(-0.1 * length)));
    tap_check(std::abs(render(b, s, map).light[0] - want) <= 1,
              "aslant: 255 exp(-0.1 %.2f)", length);
    s.light_density_scale = (uint64_t)1000 << 32;
    tap_check(render(b, s, map).light[0] == 0, "black where it is thick");
    s.light_density_scale = 0;
    tap_check(render(b, s, map).light[0] == 255, "lit where it is clear");
}

double distance_of(uint16_t code)
{
    return std::exp2((code >> 11) - 16) * (1 + (code & 2047) / 2048.0);
}

// Of texels that see more than a twentieth of a voxel of density; less has
// codes of few units, and so no place. Depths' codes are 2^-11 of a distance
// wide, which is 80 voxels at most here.
void check_depth(const texels &got, const std::vector<exact> &want,
                 const char *what)
{
    const double fine = 80.0 / 2048 + 0.01, step = 0.5;
    double most = 0;
    int found = 0, front = 0, nowhere = 0;
    for (size_t i = 0; i < want.size(); i++) {
        const exact &e = want[i];
        const brume_shadow_depth d = got.depth[i];
        if (std::isnan(e.front))
            nowhere += d.front != 65535 || d.mean != 65535;
        if (!(e.sum * step > 0.05))
            continue;
        found++;
        most = std::fmax(most, std::fabs(distance_of(d.mean) - e.mean));
        front += distance_of(d.front) < e.front - fine ||
                 distance_of(d.front) > e.dense + fine;
    }
    tap_check(found > 300 && most <= 0.1,
              "%s: mean depths of %d texels within %.3f voxels", what, found,
              most);
    tap_check(front == 0 && nowhere == 0,
              "%s: fronts where density begins (%d not), none elsewhere (%d)",
              what, front, nowhere);
}

void test_depth()
{
    const built b = cloud_of(BRUME_U8R, false);
    const reference::volume volume = decode(b, no_limit);
    const brume_shadow_map map = plane(-10, -60, 35);
    brume_scene s = scene_of(b, -60, 35);
    std::vector<exact> want;
    for (int i = 0; i < map.width * map.height; i++)
        want.push_back(
            march(volume, s, map, texel_of(map, i % map.width, i / map.width)));
    s.light_density_scale = BRUME_Q32(0.05);
    check_depth(render(b, s, map, true), want, "thin");
    s.light_density_scale = BRUME_Q32(20);
    check_depth(render(b, s, map, true), want, "dense");
}

// Through a homogeneous block what is in front says what comes through at any
// depth in it.
void test_partial()
{
    const built b = cube();
    brume_scene s = scene_of(b, 0, 90);
    s.filter = BRUME_NEAREST;
    s.light_density_scale = BRUME_Q32(0.1);
    brume_shadow_map map = {};
    map.width = map.height = 1;
    map.step = 0x1000;
    set(map.origin, vec3{15.5, -8, 15.5});
    const texels t = render(b, s, map, true);
    double most = 0;
    for (double way = 0; way < 40; way += 0.37) {
        const double left = std::fmax(0, std::fmin(16, 31.5 - way));
        const double got =
            brume_shadow_at(t.light[0], &t.depth[0], uint32_t(way * one)) / one;
        most = std::fmax(most, std::fabs(got - std::exp(-0.1 * left)));
    }
    // Half a code of 8 bits, and 1/64 voxel of depth at a tenth each.
    tap_check(most <= 0.5 / 255 + 0.003, "a point in a block: within %.4f",
              most);
    const brume_shadow_depth none = {65535, 65535};
    tap_check(brume_shadow_at(255, &none, 0) == 65536 &&
                  brume_shadow_at(255, &none, 0xffffffffU) == 65536,
              "a point on a way without density is lit");
    const brume_shadow_depth thin = {40000, 40000}, wide = {0, 65534};
    tap_check(brume_shadow_at(51, &thin, 0) / one > 0.199 &&
                  brume_shadow_at(51, &thin, 0) / one < 0.201 &&
                  brume_shadow_at(51, &thin, 0xffffffffU) == 65536,
              "a thin sheet: all or nothing");
    uint32_t before = 0;
    bool rises = true;
    for (uint32_t way = 0; way < 0xff000000U; way += 0xffffffU) {
        const uint32_t now = brume_shadow_at(0, &wide, way);
        rises = rises && now >= before && now <= 65536;
        before = now;
    }
    tap_check(rises, "more comes through the further one goes");
}

// Points anywhere on the ways to the sun through a cloud: what the texels below
// say of them, and maps through those points.
void test_points()
{
    const built b = cloud_of(BRUME_U8R, false);
    const brume_scene s = scene_of(b, -60, 35);
    const brume_shadow_map map = plane(-10, -60, 35);
    const texels ground = render(b, s, map, true);
    const vec3 sun =
        normalise(vec3{double(s.sun[0]), double(s.sun[1]), double(s.sun[2])});
    double square = 0, alone = 0;
    int count = 0;
    for (double way = 0; way < 100; way += 5) {
        brume_shadow_map above = map;
        set(above.origin, of_q16(map.origin) + sun * way);
        const texels want = render(b, s, above);
        for (size_t i = 0; i < want.light.size(); i++) {
            if (ground.depth[i].front == 65535)
                continue;
            const double got =
                brume_shadow_at(ground.light[i], &ground.depth[i],
                                uint32_t(way * one)) /
                one * 255;
            count++;
            square += std::pow(got - want.light[i], 2);
            alone += std::pow(ground.light[i] - double(want.light[i]), 2);
        }
    }
    const double rmse = std::sqrt(square / count);
    tap_check(count > 5000 && rmse <= 15 &&
                  rmse <= std::sqrt(alone / count) / 5,
              "%d points in a cloud: RMSE %.1f of 255, of T alone %.1f", count,
              rmse, std::sqrt(alone / count));
}

/// Refusals ///

int begin(const built &b, const brume_scene &s, const brume_shadow_map &map)
{
    static brume_shadow shadow;
    return brume_shadow_begin(&shadow, &b.volume, &s, &map);
}

void test_refusals()
{
    const built b = cube();
    const brume_scene s = scene_of(b, 0, 60);
    const brume_shadow_map good = plane(-10, 0, 60);
    static brume_shadow shadow;
    brume_shadow_map map = good;
    uint8_t out[4];
    brume_shadow_depth depth[4];
    tap_check(
        brume_shadow_begin(nullptr, &b.volume, &s, &map) == BRUME_ERR_NULL &&
            brume_shadow_begin(&shadow, nullptr, &s, &map) == BRUME_ERR_NULL &&
            brume_shadow_begin(&shadow, &b.volume, nullptr, &map) ==
                BRUME_ERR_NULL &&
            brume_shadow_begin(&shadow, &b.volume, &s, nullptr) ==
                BRUME_ERR_NULL,
        "NULL");
    map.width = 0;
    tap_check(begin(b, s, map) == BRUME_ERR_SIZE, "no texels");
    map.width = 16385;
    tap_check(begin(b, s, map) == BRUME_ERR_SIZE, "too many texels");
    map = good;
    for (uint32_t step : {0u, 0xfffu, 0x1000001u}) {
        map.step = step;
        tap_check(begin(b, s, map) == BRUME_ERR_STEP, "step %u", step);
    }
    map = good;
    map.origin[0] = 1 << 20;
    map.across[0] = INT32_MAX;
    tap_check(begin(b, s, map) == BRUME_ERR_SCENE, "an edge out of reach");
    map.origin[0] = INT32_MIN;
    tap_check(begin(b, s, map) == BRUME_ERR_SCENE, "a corner out of reach");
    map = good;
    const uint16_t height = 0;
    map.rise[1] = INT32_MAX;
    map.origin[1] = 1 << 20;
    tap_check(begin(b, s, map) == BRUME_OK, "no heights: no height");
    map.heights = &height;
    tap_check(begin(b, s, map) == BRUME_ERR_SIZE, "rows of too few heights");
    map.heights_stride = 48;
    tap_check(begin(b, s, map) == BRUME_ERR_SCENE, "heights out of reach");
    brume_scene dark = s;
    dark.sun[0] = dark.sun[1] = dark.sun[2] = 0;
    tap_check(begin(b, dark, good) == BRUME_ERR_SUN, "no sun");
    if (begin(b, s, good) != BRUME_OK ||
        brume_shadow_begin(&shadow, &b.volume, &s, &good) != BRUME_OK)
        abort();
    tap_check(brume_shadow_rect(&shadow, 47, 0, 2, 1, out, 2, nullptr, 0) ==
                      BRUME_ERR_RECT &&
                  brume_shadow_rect(&shadow, 0, 39, 1, 2, out, 1, nullptr, 0) ==
                      BRUME_ERR_RECT &&
                  brume_shadow_rect(&shadow, 0, 0, 2, 2, out, 1, nullptr, 0) ==
                      BRUME_ERR_RECT &&
                  brume_shadow_rect(&shadow, 0, 0, 2, 2, out, 2, depth, 1) ==
                      BRUME_ERR_RECT,
              "rectangles and strides");
    tap_check(brume_shadow_rect(nullptr, 0, 0, 1, 1, out, 1, nullptr, 0) ==
                      BRUME_ERR_NULL &&
                  brume_shadow_rect(&shadow, 0, 0, 1, 1, nullptr, 1, nullptr,
                                    0) == BRUME_ERR_NULL,
              "rectangles of nothing");
    tap_check(brume_shadow_rect(&shadow, 48, 40, 0, 0, out, 0, nullptr, 0) ==
                  BRUME_OK,
              "an empty rectangle");
}

// A ray may have 65535 samples: sums of full density then just fit.
void test_many_samples()
{
    static const density_box all = {{1, 0, 0}, {4088, 8, 8}, 65280};
    const built b =
        build(asset_spec_of(512, 1, 1, BRUME_U8R, density_in_box, &all));
    brume_scene s = scene_of(b, 90, 0);
    s.filter = BRUME_NEAREST;
    s.light_density_scale = BRUME_Q32(0.001);
    brume_shadow_map map = {};
    map.width = map.height = 1;
    map.step = 0x1000;
    set(map.origin, vec3{-20, 4, 4});
    tap_check(begin(b, s, map) == BRUME_ERR_STEP, "more than 65535 samples");
    map.step = 0x1001;
    const int want = int(std::lround(255 * std::exp(-4.087)));
    const texels t = render(b, s, map, true);
    tap_check(std::abs(t.light[0] - want) <= 1, "%d samples: %d is %d",
              int(4096 * one / map.step), t.light[0], want);
    tap_check(std::fabs(distance_of(t.depth[0].mean) - (20 + 2044)) < 2,
              "their mean depth: %.1f", distance_of(t.depth[0].mean));
}

// Maps as far away as they may be, and suns along the axes and nearly so.
void test_extremes()
{
    const built b = cloud_of(BRUME_U8R, false);
    const reference::volume volume = decode(b, no_limit);
    brume_scene s = scene_of(b, 90, 0);
    brume_shadow_map map = {};
    map.width = map.height = 64;
    map.step = 0x10000;
    for (int axis = 0; axis < 3; axis++)
        for (int sign = -1; sign <= 1; sign += 2) {
            double from[3] = {0, 0, 0}, edge[2][3] = {{0, 0, 0}, {0, 0, 0}};
            from[axis] = -32000.0 * sign;
            edge[0][(axis + 1) % 3] = edge[1][(axis + 2) % 3] = 40;
            set(map.origin, vec3{from[0], from[1], from[2]});
            set(map.across, vec3{edge[0][0], edge[0][1], edge[0][2]});
            set(map.down, vec3{edge[1][0], edge[1][1], edge[1][2]});
            for (int32_t off : {0, 1, 900}) {
                for (int i = 0; i < 3; i++)
                    s.sun[i] = i == axis ? sign * (1 << 30) : off;
                double most = 0;
                const texels t = render(b, s, map);
                for (int n = 0; n < 64; n++) {
                    const vec3 at = texel_of(map, n, 63 - n);
                    // The reference starts near the pool, on the lattice.
                    const vec3 sun = normalise(vec3{
                        double(s.sun[0]), double(s.sun[1]), double(s.sun[2])});
                    const exact e = march(volume, s, map, at + sun * 31000);
                    most = std::fmax(
                        most,
                        std::fabs(t.light[size_t((63 - n) * 64 + n)] / 255.0 -
                                  e.transmittance));
                }
                tap_check(most < 2.0 / 255,
                          "sun along axis %d (%d), off by %d: within %.4f",
                          axis, sign, int(off), most);
            }
        }
}

} // namespace

int main()
{
    test_formats();
    test_suns();
    test_planes();
    test_heights();
    test_cuts();
    test_closed_form();
    test_depth();
    test_partial();
    test_points();
    test_refusals();
    test_many_samples();
    test_extremes();
    return tap_done();
}
