// SPDX-License-Identifier: MIT
//
// The second reader on the section EMIT: it reads it, reports what the
// converter would not write, and opens and refuses what the core does.

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "tap.h"
#include "spec_check.hpp"
#include "spec_reader.hpp"

extern "C" {
#include "support/asset_light.h"
}

using namespace reference;

namespace
{

using blob = std::vector<uint8_t>;

const density_cloud cloud = {24, 7};

blob make_asset(int format, bool apron)
{
    asset_spec spec = asset_spec_of(3, 3, 3, format, density_in_cloud, &cloud);
    size_t size;
    spec.apron = apron;
    uint8_t *p =
        asset_add_emission(asset_build(&spec, &size), &size, 0x80000000u, -30);
    const blob b(p, p + size);
    std::free(p);
    return b;
}

size_t section_at(const blob &b)
{
    return asset_section(b.data(), BRUME_SECTION_EMIT);
}

bool reports(blob b, const std::string &kind)
{
    asset_seal(b.data(), b.size());
    const std::vector<std::string> lines = check_asset(asset(b));
    return std::any_of(lines.begin(), lines.end(),
                       [&](const std::string &line) {
                           return line.compare(0, kind.size(), kind) == 0;
                       });
}

/// Reading ///

void test_read(int format, bool apron)
{
    const blob b = make_asset(format, apron);
    const asset a(b);
    const size_t codes = section_at(b) + 16;
    bool good = a.emission && a.emission->value == 2;
    for (size_t i = 0; good && i < a.cell_count(); i++) {
        const ijk cell = ijk_of(i, a.cells);
        const ijk voxel = cell * 8 + ijk{3, 5, 6};
        const int want =
            a.occupied(cell)
                ? b[codes + 512 * size_t{a.brick(cell)} + 3 + 8 * (5 + 8 * 6)]
                : 0;
        good = a.emission_at(voxel) == want &&
               a.emission_value(voxel) == want * 2 / 255.0;
    }
    tap_check(good, "format %d, side %d: every cell's code of a voxel", format,
              a.side);
    tap_check(a.emission_at({-1, 0, 0}) == 0 && a.emission_at({24, 0, 0}) == 0,
              "  0 outside");
}

/// Reporting ///

// One brick in the middle of 3x3x3 cells, which the cells below read when
// there is an apron.
blob one_brick(bool apron, bool density)
{
    static const density_box box = {{8, 8, 8}, {16, 16, 16}, 256 * 100};
    asset_spec spec = asset_spec_of(3, 3, 3, BRUME_U8, density_in_box, &box);
    size_t size;
    spec.apron = apron;
    uint8_t *p =
        asset_add_emission(asset_build(&spec, &size), &size, 0x80000000u, -30);
    blob b(p, p + size);
    std::free(p);
    if (!density)
        std::fill_n(
            b.begin() +
                static_cast<long>(asset_section(b.data(), BRUME_SECTION_POOL)),
            asset_section_bytes(b.data(), BRUME_SECTION_POOL), uint8_t{0});
    return b;
}

void test_reports()
{
    blob b = one_brick(false, false);
    const size_t at = section_at(b);
    tap_check(!reports(b, "zero brick"), "a brick that only glows is no zero");
    std::fill_n(b.begin() + static_cast<long>(at + 16), 512, uint8_t{0});
    tap_check(reports(b, "zero brick"), "reported: one that does not");
    b = one_brick(false, true);
    tap_check(!reports(b, "emission"), "nothing is to report of a good one");
    std::fill_n(b.begin() + static_cast<long>(at), 8, uint8_t{0});
    tap_check(reports(b, "emission"), "reported: codes without a value");
}

/// Refusing ///

bool reader_opens(const blob &b)
{
    try {
        const asset a(b);
    } catch (const std::runtime_error &) {
        return false;
    }
    return true;
}

bool core_opens(const blob &b)
{
    brume_volume v;
    return brume_volume_open(&v, b.data(), b.size(), 0) == BRUME_OK;
}

uint32_t next_random(uint32_t &seed)
{
    seed ^= seed << 13;
    seed ^= seed >> 17;
    seed ^= seed << 5;
    return seed;
}

// The head, and the section's entry but for its last field, which the reader
// reports.
void test_alike()
{
    uint32_t seed = 0x2545f491;
    int opened = 0, refused = 0, differ = 0;
    for (int i = 0; i < 2000; i++) {
        blob b = make_asset(1 + i % 3, i & 1);
        const size_t entry =
            BRUME_HEADER_BYTES + 16 * (size_t{b[BRUME_OFF_SECTIONS]} - 1);
        const uint32_t r = next_random(seed);
        uint8_t &byte =
            r & 1 ? b[section_at(b) + (r >> 8) % 20] : b[entry + (r >> 8) % 12];
        byte =
            static_cast<uint8_t>(r & 2 ? r >> 24 : byte ^ 1U << (r >> 5 & 7));
        asset_seal(b.data(), b.size());
        const bool core = core_opens(b), reader = reader_opens(b);
        opened += core && reader;
        refused += !core && !reader;
        differ += core != reader;
    }
    tap_check(opened > 200 && refused > 200 && differ == 0,
              "2000 changed entries and heads: core and reader open %d and "
              "refuse %d, both the same",
              opened, refused);
}

} // namespace

int main()
{
    for (int format = 1; format <= 3; format++)
        for (bool apron : {false, true})
            test_read(format, apron);
    test_reports();
    test_alike();
    return tap_done();
}
