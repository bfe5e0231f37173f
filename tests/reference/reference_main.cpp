// SPDX-License-Identifier: MIT
//
// brume-reference: renders a float dump in double precision. The renderer
// under test is measured against it, so it shares no code with it.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "march.hpp"
#include "pfm.hpp"
#include "sky.hpp"

namespace {

using namespace reference;

struct options {
    std::string volume, scene, output;
    std::string emission;    // a float dump, or empty
    double emission_max = 0; // 0: the dump's own
    std::vector<std::string> settings;
    int threads = 0;               // 0: one per processor
    int directions = 0;            // 0: as the scene has it
    rectangle area = {0, 0, 0, 0}; // empty: the whole picture
    bool display = false;
    int bits = 0;                  // 0: not rounded
    bool step_check = false;
    bool help = false;
};

void print_help()
{
    std::cout
        << "usage: brume-reference VOLUME.float --scene FILE"
           " [--set key=value]... -o OUT.pfm\n\n"
           "Renders a float dump (brume-bake --dump-float) in double"
           " precision.\n\n"
           "  --scene FILE          the scene: key = value a line, # comments\n"
           "  --set key=value       one more setting; wins over the file\n"
           "  -o FILE               linear PFM, grey, or RGB when the"
           " background or\n"
           "                        light has colour\n"
           "  --emission FILE       the float dump of what glows\n"
           "  --emission-max V      its value of code 255 (its largest)\n"
           "  --threads N           default: one per processor; does not"
           " change the result\n"
           "  --display             values as shown: `output` applied, 0 to 1\n"
           "  --bits N              as --display, rounded to the nearest code of N bits\n"
           "  --directions N        over which the sky's visibility is averaged"
           " (256)\n"
           "  --view-range A,B,C,D  only pixels A <= x < C, B <= y < D\n"
           "  --step-check          render at half the step too; print how"
           " far apart the two\n"
           "                        are, in 1/255\n\n"
           "Scene keys and their defaults:\n";
    print_scene_keys(std::cout);
}

int parse_int(const std::string &text, int low, int high)
{
    char *end = nullptr;
    const long value = std::strtol(text.c_str(), &end, 10);
    if (text.empty() || *end != '\0' || value < low || value > high)
        throw std::runtime_error("'" + text + "' is not a number from " +
                                 std::to_string(low) + " to " +
                                 std::to_string(high));
    return static_cast<int>(value);
}

rectangle parse_range(const std::string &text)
{
    int value[4];
    size_t at = 0;
    for (int i = 0; i < 4; i++) {
        const size_t end = i < 3 ? text.find(',', at) : text.size();
        if (end == std::string::npos)
            throw std::runtime_error("--view-range: expected x0,y0,x1,y1");
        value[i] = parse_int(text.substr(at, end - at), 0, 65535);
        at = end + 1;
    }
    if (value[0] >= value[2] || value[1] >= value[3])
        throw std::runtime_error("--view-range: no pixel in " + text);
    return {value[0], value[1], value[2], value[3]};
}

options parse_options(const std::vector<std::string> &args)
{
    options o;
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
        else if (arg == "-o")
            o.output = value();
        else if (arg == "--emission")
            o.emission = value();
        else if (arg == "--emission-max")
            o.emission_max = std::strtod(value().c_str(), nullptr);
        else if (arg == "--threads")
            o.threads = parse_int(value(), 1, 1024);
        else if (arg == "--directions")
            o.directions = parse_int(value(), 1, 65536);
        else if (arg == "--bits")
            o.bits = parse_int(value(), 1, 16);
        else if (arg == "--display")
            o.display = true;
        else if (arg == "--view-range")
            o.area = parse_range(value());
        else if (arg == "--step-check")
            o.step_check = true;
        else if (arg[0] == '-' || !o.volume.empty())
            throw std::runtime_error("unexpected argument '" + arg + "'");
        else
            o.volume = arg;
    }
    return o;
}

scene load_scene(const options &o)
{
    scene_builder builder;
    if (!o.scene.empty())
        builder.read_file(o.scene);
    for (const std::string &pair : o.settings)
        builder.set_pair(pair);
    scene s = builder.finish();
    if (o.directions != 0)
        s.lit.sky_directions = o.directions;
    return s;
}

// The discretisation error to expect of the scene's step: `name=value` a
// line, like brume compare.
void print_step_check(const picture &a, const picture &b)
{
    double squares = 0, sum = 0, worst = 0;
    for (size_t i = 0; i < a.values.size(); i++) {
        const double d = 255 * (a.values[i] - b.values[i]);
        squares += d * d;
        sum += d;
        worst = std::max(worst, std::fabs(d));
    }
    const double n = static_cast<double>(a.values.size());
    std::printf("step_check_rmse=%.6f\nstep_check_mean=%.6f\n"
                "step_check_max=%.6f\n",
                std::sqrt(squares / n), sum / n, worst);
}

void round_to(picture &image, int bits)
{
    const double top = std::ldexp(1, bits) - 1;
    for (double &value : image.values)
        value = std::floor(value * top + 0.5) / top;
}

void run(const options &o)
{
    if (o.volume.empty() || o.output.empty())
        throw std::runtime_error("needs VOLUME.float and -o OUT.pfm;"
                                 " --help tells more");
    scene s = load_scene(o);
    rectangle area = o.area;
    if (area.x_max == 0)
        area = {0, 0, s.width, s.height};
    if (area.x_max > s.width || area.y_max > s.height)
        throw std::runtime_error("--view-range leaves the picture");
    const int processors =
        std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    const int threads = o.threads ? o.threads : processors;

    const volume v(read_float_dump(o.volume), s.max_density);
    std::unique_ptr<emission> glow;
    if (!o.emission.empty())
        glow = std::make_unique<emission>(read_float_dump(o.emission),
                                          o.emission_max);
    else if (!s.lit.glow.empty())
        throw std::runtime_error("emission needs --emission FILE");
    picture image = renderer(v, s, glow.get()).render(area, threads);
    if (o.step_check) {
        s.step /= 2;
        print_step_check(image,
                         renderer(v, s, glow.get()).render(area, threads));
    }
    if (o.display || o.bits != 0)
        for (double &value : image.values)
            value = display_value(s.lit.output, value);
    if (o.bits != 0)
        round_to(image, o.bits);
    write_pfm(o.output, image);
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
        std::fprintf(stderr, "brume-reference: %s\n", e.what());
        return 2;
    }
    return 0;
}
