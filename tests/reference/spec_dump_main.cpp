// SPDX-License-Identifier: MIT
//
// brume-spec-dump: what an asset holds, as read from docs/SPEC.md alone.

#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "float_dump.hpp"
#include "spec_check.hpp"
#include "spec_reader.hpp"

namespace {

using namespace reference;

const char usage[] =
    "usage: brume-spec-dump IN.brume [-o OUT.float] [--check]\n"
    "                       [--against ORIGINAL.float\n"
    "                       [--emission EMISSION.float]]\n\n"
    "  -o FILE         write the decoded voxels as a float dump\n"
    "  --check         print one line per violation of what SPEC.md says\n"
    "                  the converter writes; exit 1 when there is one\n"
    "  --against FILE  likewise, where the asset strays from the dump of\n"
    "                  the voxels before quantisation\n"
    "  --emission FILE and of those of the second grid\n\n"
    "Exit 2: the file is not an asset that a reader may open.\n";

struct options {
    std::string input, output, against, emission;
    bool check = false, help = false;
};

options parse_options(const std::vector<std::string> &args)
{
    options o;
    for (size_t i = 0; i < args.size(); i++) {
        const std::string &arg = args[i];
        if (arg == "--help" || arg == "-h")
            o.help = true;
        else if (arg == "--check")
            o.check = true;
        else if (arg == "-o" && i + 1 < args.size())
            o.output = args[++i];
        else if (arg == "--against" && i + 1 < args.size())
            o.against = args[++i];
        else if (arg == "--emission" && i + 1 < args.size())
            o.emission = args[++i];
        else if (arg[0] != '-' && o.input.empty())
            o.input = arg;
        else
            throw std::runtime_error("unexpected argument '" + arg + "'");
    }
    const bool idle = o.output.empty() && o.against.empty() && !o.check;
    if (!o.help && (o.input.empty() || idle))
        throw std::runtime_error(
            "needs IN.brume, and -o, --check or --against");
    return o;
}

float_dump decode(const asset &a)
{
    const ijk size = a.size();
    float_dump dump;
    dump.size = {size.x, size.y, size.z};
    dump.origin = {a.origin.x, a.origin.y, a.origin.z};
    dump.world_from_index = a.world_from_index;
    dump.voxels.resize(voxel_count(dump.size));
    for (size_t i = 0; i < dump.voxels.size(); i++)
        dump.voxels[i] = static_cast<float>(a.density(ijk_of(i, size)));
    return dump;
}

// How many there were.
size_t print(const std::string &path, const std::vector<std::string> &lines)
{
    for (const std::string &line : lines)
        std::printf("%s: %s\n", path.c_str(), line.c_str());
    return lines.size();
}

int run(const options &o)
{
    const asset a = read_asset(o.input);
    if (!o.output.empty())
        write_float_dump(o.output, decode(a));
    size_t violations = 0;
    if (o.check)
        violations += print(o.input, check_asset(a));
    float_dump glow;
    if (!o.emission.empty())
        glow = read_float_dump(o.emission);
    if (!o.against.empty())
        violations += print(
            o.input, check_against(a, read_float_dump(o.against),
                                   o.emission.empty() ? nullptr : &glow));
    return violations ? 1 : 0;
}

} // namespace

int main(int argc, char **argv)
{
    try {
        const options o = parse_options({argv + 1, argv + argc});
        if (!o.help)
            return run(o);
        std::fputs(usage, stdout);
    } catch (const std::exception &e) {
        std::fprintf(stderr, "brume-spec-dump: %s\n", e.what());
        return 2;
    }
    return 0;
}
