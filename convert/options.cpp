// SPDX-License-Identifier: MIT
#include "options.hpp"

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "brume.h"

namespace bake
{

const char usage[] =
    "usage: brume-bake IN.vdb|IN.nvdb -o OUT [option]...\n"
    "\n"
    "Bake the density of an OpenVDB or NanoVDB file into a brume asset.\n"
    "\n"
    "  -o FILE              the asset to write: FILE.brume; or FILE.c, the\n"
    "                       asset as C; or FILE.S, assembly that includes\n"
    "                       FILE.brume, which is written too\n"
    "  --grid NAME|#i       the grid to take, by name or index from 0\n"
    "  --emission NAME|#i   add a second grid that glows: temperature, "
    "flames;\n"
    "                       either grid may be missing or empty\n"
    "  --emission-max V     its value of the largest code, the same for all\n"
    "                       frames of a sequence; limits it (default: its "
    "own)\n"
    "  --allow-empty        make an empty asset of grids without voxels: a\n"
    "                       frame in which nothing burns\n"
    "  --format F           auto (default), u8, u8r or u4r\n"
    "  --lod N              halve the resolution N times, 0 to 8\n"
    "  --budget BYTES       choose level of detail and format with the least\n"
    "                       error that fit (K, M: 1024, 1024^2); --lod and\n"
    "                       --format limit the choice\n"
    "  --max-density D      limit the density to D\n"
    "  --mips               add means over 2^3, 4^3, ... voxels, for\n"
    "                       light = cone\n"
    "  --sun-cache N        add the optical depth towards the sun at points N\n"
    "                       (2, 4 or 8) voxels apart, for light = cache\n"
    "  --sun AZ,EL          of --sun-cache: azimuth and elevation, degrees\n"
    "  --sky-visibility     add how much of the sky each 8^3 voxels see\n"
    "  --sky-extinction X   of --sky-visibility: of a density of 1 per voxel;\n"
    "                       the light_density_scale of the scenes\n"
    "  --apron              store 9^3 voxels per brick, for fast trilinear\n"
    "  --order O            number bricks in morton (default) or linear "
    "order\n"
    "  --level-set-to-fog   convert a level set to a density\n"
    "  --symbol NAME        name of the array in FILE.c or FILE.S (default:\n"
    "                       from FILE)\n"
    "  --licence TEXT       for the comment in FILE.c or FILE.S (default: "
    "what\n"
    "                       the input says)\n"
    "  --report FILE        write figures as JSON\n"
    "  --dump-float FILE    write the voxels before quantisation\n"
    "  --dump-emission FILE the same of the second grid\n"
    "  --threads N          use N threads (default: all); the output is the "
    "same\n"
    "  --help               this text\n"
    "\n"
    "Exit status: 0 done, 1 the input cannot be baked or a file not\n"
    "written, 2 wrong usage or a grid must be chosen.\n";

namespace
{

constexpr int most_threads = 1024;
constexpr double most_degrees = 3600;
constexpr uint64_t most_budget = (uint64_t(1) << 31) - 1;

[[noreturn]] void bad_usage(const std::string &what)
{
    throw failure(what + " (see brume-bake --help)", status_usage);
}

int whole_number(const std::string &key, const char *s, int lo, int hi)
{
    char *end;

    errno = 0;
    const long v = std::strtol(s, &end, 10);
    if (end == s || *end != '\0' || errno != 0 || v < lo || v > hi)
        bad_usage(text("%s takes a number from %d to %d, not \"%s\"",
                       key.c_str(), lo, hi, s));
    return int(v);
}

// `read` is std::strtof or std::strtod.
template <class real>
real positive_number(const std::string &key, const char *s,
                     real (*read)(const char *, char **))
{
    char *end;
    const real v = read(s, &end);

    if (end == s || *end != '\0' || !std::isfinite(v) || v <= 0)
        bad_usage(key + " takes a number above 0, not \"" + s + "\"");
    return v;
}

int spacing(const std::string &key, const char *s)
{
    const std::string v = s;

    if (v != "2" && v != "4" && v != "8")
        bad_usage(key + " takes 2, 4 or 8 voxels, not \"" + v + "\"");
    return v[0] - '0';
}

// Degrees, as scenes take them.
void angles(const std::string &key, const char *s, double out[2])
{
    char *end;

    out[0] = std::strtod(s, &end);
    const bool pair = end != s && *end == ',';
    const char *second = pair ? end + 1 : s;
    out[1] = std::strtod(second, &end);
    if (!pair || end == second || *end != '\0' ||
        !(std::fabs(out[0]) <= most_degrees) ||
        !(std::fabs(out[1]) <= most_degrees))
        bad_usage(text("%s takes azimuth,elevation in degrees, at most %g, "
                       "not \"%s\"",
                       key.c_str(), most_degrees, s));
}

// A number of bytes, or of KiB or MiB.
uint64_t byte_count(const std::string &key, const char *s)
{
    char *end;

    errno = 0;
    uint64_t v = std::strtoull(s, &end, 10);
    const bool sound = *s >= '0' && *s <= '9' && errno == 0 && v <= most_budget;
    if (*end == 'K' || *end == 'M')
        v <<= *end++ == 'K' ? 10 : 20;
    if (!sound || *end != '\0' || v == 0 || v > most_budget)
        bad_usage(key +
                  " takes bytes, as 65536 or 64K or 1M, below 2048M, "
                  "not \"" +
                  s + "\"");
    return v;
}

// Options that take a value. Returns false for a key that is not one.
bool set_value(options &o, const std::string &key, const char *v)
{
    if (key == "-o")
        o.output = v;
    else if (key == "--grid")
        o.grid = v;
    else if (key == "--emission")
        o.emission = v;
    else if (key == "--emission-max")
        o.emission_max = positive_number(key, v, std::strtof);
    else if (key == "--dump-emission")
        o.emission_dump = v;
    else if (key == "--format")
        o.format = v;
    else if (key == "--lod")
        o.lod = whole_number(key, v, 0, most_lod);
    else if (key == "--max-density")
        o.max_density = positive_number(key, v, std::strtof);
    else if (key == "--order" && !std::strcmp(v, "linear"))
        o.order = brick_order::linear;
    else if (key == "--order" && std::strcmp(v, "morton") != 0)
        bad_usage("--order is morton or linear, not \"" + std::string(v) +
                  "\"");
    else if (key == "--budget")
        o.budget = byte_count(key, v);
    else if (key == "--sun-cache")
        o.light.sun_spacing = spacing(key, v);
    else if (key == "--sun") {
        angles(key, v, o.light.sun);
        o.sun = true;
    } else if (key == "--sky-extinction")
        o.light.sky_extinction = positive_number(key, v, std::strtod);
    else if (key == "--symbol")
        o.symbol = v;
    else if (key == "--licence")
        o.licence = v;
    else if (key == "--report")
        o.report = v;
    else if (key == "--dump-float")
        o.dump = v;
    else if (key == "--threads")
        o.threads = whole_number(key, v, 1, most_threads);
    else if (key != "--order")
        return false;
    return true;
}

bool set_flag(options &o, const std::string &key)
{
    if (key == "--apron")
        o.apron = true;
    else if (key == "--allow-empty")
        o.allow_empty = true;
    else if (key == "--mips")
        o.light.mips = true;
    else if (key == "--sky-visibility")
        o.sky = true;
    else if (key == "--level-set-to-fog")
        o.fog = true;
    else if (key == "--help" || key == "-h")
        o.help = true;
    else
        return false;
    return true;
}

int format_id(const std::string &name)
{
    for (int id : {BRUME_U8, BRUME_U8R, BRUME_U4R})
        if (name == brick_format{id, 8, 1}.name())
            return id;
    return 0;
}

void check_outputs(const options &o)
{
    const bool two = o.form() == output_form::assembly;
    const std::string binary = two ? included_path(o.output) : "";
    std::error_code none;
    std::vector<std::string> seen;

    for (const std::string &out :
         {o.output, binary, o.report, o.dump, o.emission_dump}) {
        if (out.empty())
            continue;
        if (std::filesystem::equivalent(o.input, out, none))
            bad_usage(out + ": is the input itself");
        for (const std::string &other : seen)
            if (out == other)
                bad_usage("two outputs have one name");
        seen.push_back(out);
    }
}

void check_light(const options &o)
{
    if (o.light.sun_spacing > 0 && !o.sun)
        bad_usage("--sun-cache needs --sun AZ,EL");
    if (o.light.sun_spacing == 0 && o.sun)
        bad_usage("--sun needs --sun-cache 2, 4 or 8");
    if (o.light.sky_extinction == 0 && o.sky)
        bad_usage("--sky-visibility needs --sky-extinction X");
    if (o.light.sky_extinction > 0 && !o.sky)
        bad_usage("--sky-extinction needs --sky-visibility");
}

void check_emission(const options &o)
{
    if (o.emission.empty() && o.emission_max > 0)
        bad_usage("--emission-max needs --emission NAME");
    if (o.emission.empty() && !o.emission_dump.empty())
        bad_usage("--dump-emission needs --emission NAME");
    if (o.allow_empty && o.budget > 0)
        bad_usage(
            "--budget is of volumes that are not empty: no --allow-empty");
}

void check_options(const options &o)
{
    if (o.input.empty())
        bad_usage("no input file");
    if (o.output.empty())
        bad_usage("no output file: -o FILE is missing");
    if (o.format != "auto" && format_id(o.format) == 0)
        bad_usage("--format is auto, u8, u8r or u4r, not \"" + o.format + "\"");
    if (o.form() == output_form::binary && !(o.symbol + o.licence).empty())
        bad_usage("--symbol and --licence need -o FILE.c or FILE.S");
    if (!o.symbol.empty() && !is_free_identifier(o.symbol))
        bad_usage("--symbol takes a C identifier that starts with a letter "
                  "and is no keyword or register, not \"" +
                  o.symbol + "\"");
    check_emission(o);
    check_light(o);
    check_outputs(o);
}

} // namespace

std::vector<int> options::formats() const
{
    if (format == "auto")
        return {BRUME_U8, BRUME_U8R, BRUME_U4R};
    return {format_id(format)};
}

options parse(int count, char **args)
{
    options o;

    for (int i = 1; i < count; i++) {
        std::string key = args[i];
        const size_t equals = key.find('=');
        if (key.empty() || key[0] != '-') {
            if (!o.input.empty())
                bad_usage("two inputs: " + o.input + " and " + key);
            o.input = key;
        } else if (set_flag(o, key)) {
            continue;
        } else if (equals != std::string::npos &&
                   set_value(o, key.substr(0, equals), args[i] + equals + 1)) {
            continue;
        } else if (!set_value(o, key, i + 1 < count ? args[i + 1] : "1")) {
            bad_usage("unknown option " + key);
        } else if (++i >= count) {
            bad_usage(key + " needs a value");
        }
    }
    if (!o.help)
        check_options(o);
    return o;
}

} // namespace bake
