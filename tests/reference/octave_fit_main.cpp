// SPDX-License-Identifier: MIT
//
// brume-octave-fit: fits a, b, c of Wrenninge's octaves to the Monte Carlo
// reference over volumes, views, suns, albedos and phase functions, and prints
// the tables of docs/octaves.md; tests/reference/fit_octaves.sh runs it.

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "octave_furnace.hpp"
#include "octave_search.hpp"
#include "octave_targets.hpp"

namespace
{

using namespace reference;

struct options {
    std::vector<std::string> volumes;
    std::vector<std::string> phases;
    target_options targets;
    bool help = false;
};

void print_help()
{
    std::cout
        << "usage: brume-octave-fit [options] NAME=FILE.float,EXTINCTION...\n\n"
           "Fits octave_a, octave_b, octave_c to Monte Carlo pictures of the"
           " volumes, whose\nextinction per voxel at density 1 is given, and"
           " prints tables as Markdown. A volume\nwith + before its name is"
           " shown, but not fitted to.\n\n"
           "  --phase P      a phase function as scenes have it; may be given"
           " several times\n"
           "                 (isotropic, hg:0.85, droplet:10)\n"
           "  --passes N     paths a pixel (256)\n"
           "  --side N       pixels on a side of a picture (40)\n"
           "  --cache DIR    keep the pictures' sums there, and go on from"
           " them\n"
           "  --threads N    default 1; does not change the result\n";
}

void tell(const std::string &text)
{
    if (isatty(2))
        std::fprintf(stderr, "\r%-70s\r", text.c_str());
}

/// Cells ///

std::string format(const char *how, double x)
{
    char text[40];
    std::snprintf(text, sizeof text, how, x);
    return text;
}

std::string percent(double x, const char *sign = "")
{
    const int digits = std::fabs(x) < 0.0995 ? 1 : 0;
    return format(
        ("%" + std::string(sign) + "." + std::to_string(digits) + "f").c_str(),
        100 * x);
}

std::string cell(const octave_error &e)
{
    return " " + percent(e.rmse) + ", " + percent(e.mean, "+") + " |";
}

std::string inner(const octave_model &m)
{
    if (m.count == 1)
        return "";
    return format(" %.2f, ", m.a) + format("%.2f, ", m.b) + format("%.2f", m.c);
}

std::string cell(const octave_model &m)
{
    return inner(m) + " |";
}

void print_line(const std::string &line)
{
    std::printf("%s\n", line.c_str());
}

void print_head(const std::vector<std::string> &columns)
{
    std::string head = "|", rule = "|";
    for (const std::string &c : columns) {
        head += " " + c + " |";
        rule += "---|";
    }
    print_line("\n" + head + "\n" + rule);
}

/// Tables ///

// One phase function's.
struct report {
    const std::vector<subject> &subjects;
    const phase_model phase;
    const octave_search &search;

    void fits() const;
    void alone() const;
    void views() const;
    void limits() const;
    void furnaces() const;

  private:
    static bool fitted(const octave_target &t)
    {
        return !t.probe;
    }
    static octave_search::choice in_group(size_t g)
    {
        return [g](const octave_target &t) {
            return t.group == static_cast<int>(g);
        };
    }
    octave_model fit(int count, size_t albedo,
                     const octave_search::rule &rule = nullptr) const
    {
        return search.fit(count, albedo, fitted, rule);
    }
    void row(size_t albedo, const std::string &name, const octave_model &m,
             double share = 1) const;
    void soft_row(size_t albedo, double a) const;
    double best_softening(size_t albedo) const;
    std::string
    errors(const std::function<octave_error(const octave_search::choice &)> &of)
        const;
    void furnace_row(size_t albedo, const std::string &name,
                     const octave_model &m, double share = 1) const;
};

double normalised(const octave_model &m)
{
    return 1 / m.weight_sum();
}

// RMSE and mean error over all fitted pictures, then of each volume.
std::string report::errors(
    const std::function<octave_error(const octave_search::choice &)> &of) const
{
    std::string line = cell(of(fitted));
    for (size_t g = 0; g < subjects.size(); g++)
        line += cell(of(in_group(g)));
    return line;
}

void report::row(size_t albedo, const std::string &name, const octave_model &m,
                 double share) const
{
    print_line("|" + format(" %g |", fit_albedos[albedo]) + " " + name + " |" +
               cell(m) + errors([&](const octave_search::choice &of) {
                   return search.error(m, albedo, of, share);
               }));
}

void report::soft_row(size_t albedo, double a) const
{
    print_line("|" + format(" %g |", fit_albedos[albedo]) + " 1, softened |" +
               format(" %.2f |", a) +
               errors([&](const octave_search::choice &of) {
                   return search.softened(a, albedo, of);
               }));
}

double report::best_softening(size_t albedo) const
{
    double best = 1;
    for (double a = 0; a < 1; a += octave_search::a_step)
        if (search.softened(a, albedo, fitted).rmse <
            search.softened(best, albedo, fitted).rmse)
            best = a;
    return best;
}

void report::fits() const
{
    std::vector<std::string> columns = {"albedo", "octaves", "a, b, c", "all"};
    for (const subject &s : subjects)
        columns.push_back(s.name);
    print_head(columns);
    for (size_t w = 0; w < fit_albedos.size(); w++) {
        octave_model m;
        row(w, "1", m);
        soft_row(w, 0.44); // the default scenes'
        soft_row(w, best_softening(w));
        m.count = max_octaves;
        row(w, "8, halves", m);
        for (int count : {2, 3, 4, 8})
            row(w, std::to_string(count) + ", fit", fit(count, w));
        for (int count : {2, 8}) {
            m = fit(count, w, normalised);
            row(w, std::to_string(count) + ", normalised", m, normalised(m));
        }
    }
}

// Each volume's own fit, and its error.
void report::alone() const
{
    std::vector<std::string> columns = {"albedo", "octaves"};
    for (const subject &s : subjects)
        columns.push_back(s.name + ": own a, b, c; error");
    print_head(columns);
    for (size_t w = 0; w < fit_albedos.size(); w++)
        for (int count : {2, 8}) {
            std::string line =
                "|" + format(" %g |", fit_albedos[w]) + format(" %g |", count);
            for (size_t g = 0; g < subjects.size(); g++) {
                const auto of_group = in_group(g);
                const octave_model m = search.fit(count, w, of_group);
                line += inner(m) + ";" + cell(search.error(m, w, of_group));
            }
            print_line(line);
        }
}

void report::views() const
{
    print_head(
        {"albedo", "octaves", "a, b, c", "sun behind", "beside", "ahead"});
    for (size_t w = 0; w < fit_albedos.size(); w++)
        for (int count : {1, 2, 8}) {
            const octave_model m = fit(count, w);
            std::string line = "|" + format(" %g |", fit_albedos[w]) +
                               format(" %g |", count) + cell(m);
            for (int view = 0; view < view_count; view++)
                line += cell(search.error(m, w, [view](const octave_target &t) {
                    return !t.probe && t.view == view;
                }));
            print_line(line);
        }
}

// Fits that keep more of the energy.
void report::limits() const
{
    std::vector<std::string> columns = {"albedo"};
    const std::vector<double> limits = {1.1, 1.25, 1.5, 2};
    for (double limit : limits)
        columns.push_back(format("sum <= %g", limit));
    columns.push_back("b <= a");
    columns.push_back("free");
    print_head(columns);
    for (size_t w = 0; w < fit_albedos.size(); w++) {
        std::string line = format("| %g |", fit_albedos[w]);
        const auto add = [&](const octave_search::rule &rule) {
            const octave_model m = fit(max_octaves, w, rule);
            line +=
                " " + percent(search.error(m, w, fitted).rmse) + ":" + cell(m);
        };
        for (double limit : limits)
            add([&](const octave_model &m) {
                return fit_albedos[w] * m.weight_sum() <= limit ? 1.0 : 0.0;
            });
        add([](const octave_model &m) { return m.b <= m.a ? 1.0 : 0.0; });
        add(nullptr);
        print_line(line);
    }
}

void report::furnace_row(size_t albedo, const std::string &name,
                         const octave_model &m, double share) const
{
    const double factor = share * fit_albedos[albedo];
    const furnace_peak p = furnace_of_cubes(phase, factor, m);
    std::string line = "|" + format(" %g |", fit_albedos[albedo]) + " " + name +
                       " |" + cell(m) + format(" %.2f |", m.weight_sum()) +
                       format(" %.2f at", p.value) + format(" %g |", p.depth);
    for (const subject &s : subjects) {
        const furnace f = furnace_of(
            *s.inside, view_scene(s, 0, 0, 16, "isotropic"), phase, factor, m);
        line += format(" %.2f,", f.mean) + format(" %.2f |", f.top);
    }
    print_line(line);
}

void report::furnaces() const
{
    std::vector<std::string> columns = {"albedo", "octaves", "a, b, c",
                                        "sum b^i", "cubes: top, at"};
    for (const subject &s : subjects)
        columns.push_back(s.name);
    print_head(columns);
    for (size_t w = 0; w < fit_albedos.size(); w++) {
        octave_model m;
        furnace_row(w, "1", m);
        m.count = max_octaves;
        furnace_row(w, "8, halves", m);
        for (int count : {2, 8})
            furnace_row(w, std::to_string(count) + ", fit", fit(count, w));
        for (int count : {2, 8}) {
            m = fit(count, w, normalised);
            furnace_row(w, std::to_string(count) + ", normalised", m,
                        normalised(m));
        }
    }
}

// Optical depth of pixels that the volume covers, for what "thick" means here.
void print_volumes(const std::vector<subject> &subjects, int side)
{
    print_head({"volume", "extinction", "optical depth: median", "largest"});
    for (const subject &s : subjects) {
        std::vector<double> depths;
        for (int view = 0; view < view_count; view++) {
            const renderer camera(*s.voxels,
                                  view_scene(s, view, 0, side, "isotropic"));
            for (int i = 0; i < side * side; i++) {
                const double d =
                    s.extinction *
                    s.inside->depth(camera.camera_ray(i % side, i / side));
                if (d > 0.01)
                    depths.push_back(d);
            }
        }
        std::sort(depths.begin(), depths.end());
        print_line("| " + s.name + format(" | %g |", s.extinction) +
                   format(" %.1f |", depths[depths.size() / 2]) +
                   format(" %.1f |", depths.back()));
    }
}

void print_noise(const std::vector<octave_target> &targets)
{
    std::string line =
        "\nNoise of the truth, % of a picture's mean, by albedo:";
    for (size_t w = 0; w < fit_albedos.size(); w++) {
        double noise = 0;
        for (const octave_target &t : targets)
            noise += t.noise[w] / (t.mean[w] * t.mean[w]) /
                     static_cast<double>(targets.size());
        line += (w ? ", " : " ") + percent(std::sqrt(noise));
    }
    print_line(line + ".");
}

void print_phase(const std::vector<subject> &subjects, const std::string &name,
                 const target_options &o)
{
    std::vector<octave_target> targets;
    for (size_t g = 0; g < subjects.size(); g++) {
        tell(name + ", " + subjects[g].name);
        add_targets(subjects[g], static_cast<int>(g), name, o, targets);
    }
    tell(name + ", fits");
    const phase_model phase =
        view_scene(subjects[0], 0, 0, o.side, name).lit.phase;
    const octave_search search(phase, fit_albedos, targets);
    const report r = {subjects, phase, search};
    std::printf("\n### %s\n", name.c_str());
    print_noise(targets);
    r.fits();
    r.alone();
    r.views();
    r.limits();
    tell(name + ", furnaces");
    r.furnaces();
    std::fflush(stdout);
    tell("");
}

/// Options ///

long parse_count(const std::string &text, long low, long high)
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
    for (size_t i = 0; i < args.size(); i++) {
        const std::string &arg = args[i];
        const auto value = [&]() -> const std::string & {
            if (++i == args.size())
                throw std::runtime_error(arg + " needs a value");
            return args[i];
        };
        if (arg == "--help" || arg == "-h")
            o.help = true;
        else if (arg == "--phase")
            o.phases.push_back(value());
        else if (arg == "--cache")
            o.targets.cache = value();
        else if (arg == "--passes")
            o.targets.passes =
                static_cast<uint64_t>(parse_count(value(), 2, 1 << 30));
        else if (arg == "--side")
            o.targets.side = static_cast<int>(parse_count(value(), 4, 1024));
        else if (arg == "--threads")
            o.targets.threads = static_cast<int>(parse_count(value(), 1, 1024));
        else if (arg.empty() || arg[0] == '-')
            throw std::runtime_error("unexpected argument '" + arg + "'");
        else
            o.volumes.push_back(arg);
    }
    if (o.phases.empty())
        o.phases = {"isotropic", "hg:0.85", "droplet:10"};
    return o;
}

void run(const options &o)
{
    if (o.volumes.empty())
        throw std::runtime_error("needs NAME=FILE.float,EXTINCTION...;"
                                 " --help tells more");
    std::vector<subject> subjects;
    for (const std::string &text : o.volumes)
        subjects.push_back(open_subject(text));
    if (subjects[0].probe)
        throw std::runtime_error("the first volume must be one to fit to");
    print_volumes(subjects, o.targets.side);
    for (const std::string &name : o.phases)
        print_phase(subjects, name, o.targets);
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
        std::fprintf(stderr, "brume-octave-fit: %s\n", e.what());
        return 2;
    }
    return 0;
}
