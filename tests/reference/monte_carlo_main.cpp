// SPDX-License-Identifier: MIT
//
// brume-monte-carlo: renders a float dump with multiple scattering of any
// order, without bias, in double precision.

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "monte_carlo.hpp"
#include "pfm.hpp"

namespace
{

using namespace reference;

struct options {
    std::string volume, scene, output, error, sums;
    std::vector<std::string> settings;
    std::string source = "sun";
    long passes = 64, order = 0, seed = 0, threads = 0; // 0: one a processor
    bool help = false;
};

void print_help()
{
    std::cout
        << "usage: brume-monte-carlo VOLUME.float --scene FILE"
           " [--set key=value]... -o OUT.pfm\n\n"
           "Renders a float dump (brume-bake --dump-float) by paths from the"
           " eye: multiple\nscattering of any order, without bias, in double"
           " precision. A path a pixel and\npass, through the pixel's middle;"
           " prints the mean standard error of a pixel.\n\n"
           "  --scene FILE       the scene: key = value a line, # comments\n"
           "  --set key=value    one more setting; wins over the file\n"
           "  --order N          the last scattering that counts; 0: all (0)\n"
           "  --light L          sun | environment (of radiance 1) | all-suns"
           " (the same, by\n"
           "                     suns from everywhere)  (sun)\n"
           "  --passes N         (64)\n"
           "  --seed N           (0)\n"
           "  -o FILE            linear PFM\n"
           "  --error FILE       PFM of the standard errors\n"
           "  --sums FILE        go on from the passes in FILE, and put all"
           " there\n"
           "  --threads N        default: one per processor; does not change"
           " the result\n\n"
           "Of the scene it takes size, eye, target, up, fov, sun, albedo, "
           "phase,"
           " filter,\ndensity_scale, light_density_scale, max_density,"
           " sun_colour, exposure, and what is\nbehind the volume."
           " light_density_scale must equal density_scale unless --order is"
           "\n1, and there can be no ambient light. All else is of methods"
           " that this one\nreplaces: steps, samples, octaves, jitter, the"
           " kind of light.\n";
}

long parse_long(const std::string &text, long low, long high)
{
    char *end = nullptr;
    const long value = std::strtol(text.c_str(), &end, 10);
    if (text.empty() || *end != '\0' || value < low || value > high)
        throw std::runtime_error("'" + text + "' is not a number from " +
                                 std::to_string(low) + " to " +
                                 std::to_string(high));
    return value;
}

options parse_options(const std::vector<std::string> &args)
{
    options o;
    const long most = 1L << 30;
    for (size_t i = 0; i < args.size(); i++) {
        const std::string &arg = args[i];
        const auto value = [&]() -> const std::string & {
            if (++i == args.size())
                throw std::runtime_error(arg + " needs a value");
            return args[i];
        };
        if (arg == "--help" || arg == "-h")
            o.help = true;
        else if (arg == "--scene")
            o.scene = value();
        else if (arg == "--set")
            o.settings.push_back(value());
        else if (arg == "--light")
            o.source = value();
        else if (arg == "-o")
            o.output = value();
        else if (arg == "--error")
            o.error = value();
        else if (arg == "--sums")
            o.sums = value();
        else if (arg == "--passes")
            o.passes = parse_long(value(), 1, most);
        else if (arg == "--order")
            o.order = parse_long(value(), 0, most);
        else if (arg == "--seed")
            o.seed = parse_long(value(), 0, most);
        else if (arg == "--threads")
            o.threads = parse_long(value(), 1, 1024);
        else if (arg.empty() || arg[0] == '-' || !o.volume.empty())
            throw std::runtime_error("unexpected argument '" + arg + "'");
        else
            o.volume = arg;
    }
    return o;
}

light_source parse_source(const std::string &text)
{
    if (text == "sun")
        return light_source::sun;
    if (text == "environment")
        return light_source::environment;
    if (text == "all-suns")
        return light_source::all_suns;
    throw std::runtime_error("--light: '" + text +
                             "' is none of sun, environment, all-suns");
}

scene load_scene(const options &o)
{
    scene_builder builder;
    if (!o.scene.empty())
        builder.read_file(o.scene);
    for (const std::string &pair : o.settings)
        builder.set_pair(pair);
    return builder.finish();
}

path_settings settings_of(const options &o, const scene &s)
{
    path_settings out;
    out.source = parse_source(o.source);
    if (out.source != light_source::environment) {
        if (s.lit.ambient != ambient_kind::none)
            throw std::runtime_error("ambient light is not traced: use"
                                     " --light environment");
        if (s.light == light_model::none)
            throw std::runtime_error("light = none: there is no sun");
        if (s.light_density_scale != s.density_scale && o.order != 1)
            throw std::runtime_error(
                "light_density_scale must equal density_scale where light is"
                " scattered more than once");
    }
    out.extinction = s.density_scale;
    out.light_extinction = s.light_density_scale;
    out.phase = s.lit.phase;
    out.order = static_cast<int>(o.order);
    out.albedos = {s.albedo};
    return out;
}

// What the sums are of, but for the number of passes.
std::string key_of(const options &o, const scene &s, const float_dump &d)
{
    const phase_model &p = s.lit.phase;
    char text[800];
    std::snprintf(
        text, sizeof text,
        "%016llx %dx%d eye %.17g %.17g %.17g target %.17g %.17g %.17g"
        " up %.17g %.17g %.17g fov %.17g sun %.17g %.17g scales %.17g %.17g"
        " albedo %.17g filter %d max %.17g phase %d %.17g %.17g %.17g %.17g"
        " light %s order %ld seed %ld",
        static_cast<unsigned long long>(hash_of(d)), s.width, s.height, s.eye.x,
        s.eye.y, s.eye.z, s.target.x, s.target.y, s.target.z, s.up.x, s.up.y,
        s.up.z, s.fov, s.sun_azimuth, s.sun_elevation, s.density_scale,
        s.light_density_scale, s.albedo, static_cast<int>(s.filter),
        s.max_density, static_cast<int>(p.kind), p.g, p.draine_g,
        p.draine_alpha, p.weight, o.source.c_str(), o.order, o.seed);
    return text;
}

// In rounds of a few passes; what there is goes to disk every ten seconds.
void trace_all(const path_tracer &tracer, const renderer &camera,
               const options &o, const std::string &key, path_sums &sums)
{
    const uint64_t passes = static_cast<uint64_t>(o.passes);
    const long processors =
        std::max(1L, static_cast<long>(std::thread::hardware_concurrency()));
    const int threads = static_cast<int>(o.threads ? o.threads : processors);
    auto saved = std::chrono::steady_clock::now();
    while (sums.passes < passes) {
        const uint64_t next = std::min(passes, sums.passes + 4);
        trace_passes(tracer, camera, static_cast<uint64_t>(o.seed), next,
                     threads, sums);
        if (isatty(2))
            std::fprintf(stderr, "\r%llu of %ld passes",
                         static_cast<unsigned long long>(next), o.passes);
        const auto now = std::chrono::steady_clock::now();
        if (!o.sums.empty() &&
            (next == passes || now - saved > std::chrono::seconds(10))) {
            write_sums(o.sums, key, sums);
            saved = now;
        }
    }
    if (isatty(2))
        std::fprintf(stderr, "\n");
}

// The camera needs none of the tables that some kinds of light do.
scene camera_scene(scene s)
{
    s.light = light_model::none;
    return s;
}

bool is_grey(const vec3 &c)
{
    return c.x == c.y && c.y == c.z;
}

// The background is behind what went through without a collision; light from
// everywhere is its own background, of 1.
picture make_picture(const scene &s, const renderer &camera,
                     const path_sums &sums, bool everywhere)
{
    const bool grey = everywhere || (is_grey(s.lit.sun_colour) &&
                                     !s.background_is_rgb && !s.lit.sky);
    const vec3 light =
        everywhere ? vec3{1, 1, 1} : s.lit.sun_colour * s.lit.exposure;
    picture out{s.width, s.height, grey ? 1 : 3, {}};
    size_t i = 0;
    for (int y = 0; y < s.height; y++)
        for (int x = 0; x < s.width; x++, i += 2) {
            const vec3 behind =
                everywhere ? vec3{1, 1, 1}
                           : camera.background(camera.camera_ray(x, y));
            const vec3 sum = light * sums.mean(i) + behind * sums.mean(i + 1);
            const double channels[3] = {sum.x, sum.y, sum.z};
            out.values.insert(out.values.end(), channels,
                              channels + out.channels);
        }
    return out;
}

// Of the light, without the background; the sun's colour is left out.
picture make_errors(const path_sums &sums, double exposure)
{
    picture out{sums.width, sums.height, 1, {}};
    for (size_t i = 0; i < sums.sum.size(); i += 2)
        out.values.push_back(exposure * sums.standard_error(i));
    return out;
}

void run(const options &o)
{
    if (o.volume.empty() || o.output.empty())
        throw std::runtime_error("needs VOLUME.float and -o OUT.pfm;"
                                 " --help tells more");
    const scene s = load_scene(o);
    const path_settings settings = settings_of(o, s);
    float_dump dump = read_float_dump(o.volume);
    const std::string key = key_of(o, s, dump);
    const volume v(std::move(dump), s.max_density);
    const medium inside(v, s.filter);
    const renderer camera(v, camera_scene(s));
    const path_tracer tracer(inside, settings, camera.sun());

    path_sums sums(s.width, s.height, 2);
    if (!o.sums.empty())
        read_sums(o.sums, key, sums);
    if (sums.passes > static_cast<uint64_t>(o.passes))
        throw std::runtime_error(o.sums + ": holds more passes already");
    trace_all(tracer, camera, o, key, sums);

    const bool everywhere = settings.source != light_source::sun;
    write_pfm(o.output, make_picture(s, camera, sums, everywhere));
    const picture errors =
        make_errors(sums, everywhere ? 1 : s.lit.exposure);
    if (!o.error.empty())
        write_pfm(o.error, errors);
    double squares = 0;
    for (double e : errors.values)
        squares += e * e / static_cast<double>(errors.values.size());
    std::printf("passes=%llu\nstandard_error=%.6f\n",
                static_cast<unsigned long long>(sums.passes),
                std::sqrt(squares));
}

} // namespace

int main(int argc, char **argv)
{
    try {
        const options o = parse_options({argv + 1, argv + argc});
        if (o.help)
            print_help();
        else
            run(o);
    } catch (const std::exception &e) {
        std::fprintf(stderr, "brume-monte-carlo: %s\n", e.what());
        return 2;
    }
    return 0;
}
