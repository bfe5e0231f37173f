// SPDX-License-Identifier: MIT
//
// brume-papers: the double renderer with what papers do and the core does not,
// on purpose: forward Euler opacity, light for empty samples, steps that adapt.
// Prints how many densities it looked up.

#include <atomic>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "light.hpp"
#include "march.hpp"
#include "noise.hpp"
#include "pfm.hpp"
#include "phase.hpp"

namespace
{

using namespace reference;

struct options {
    std::string volume, scene, output;
    std::vector<std::string> settings;
    bool euler = false;    // a = 1 - sigma step, at least 0 (Toft et al. 2016)
    bool all_lit = false;  // samples of no density get light, too (Ford 2024,
                           // before the third rung)
    bool adaptive = false; // two steps at once where it is empty, one back on
                           // entry (Ford 2024)
    bool help = false;
};

const char help_text[] =
    "usage: brume-papers VOLUME.float --scene FILE [--set key=value]...\n"
    "                    [--euler] [--all-lit] [--adaptive] -o OUT.pfm\n\n"
    "As brume-reference, grey and without a sky. Prints view=N and light=N:\n"
    "densities looked up along the rays and towards the sun, per pixel.\n\n"
    "  --euler     opacity sigma step, at most 1, instead of 1 - exp\n"
    "  --all-lit   light is computed for samples without density, too\n"
    "  --adaptive  every other sample where it is empty; on meeting something\n"
    "              one sample back; after four empty ones as before\n";

options parse(const std::vector<std::string> &args)
{
    options o;
    for (size_t i = 0; i < args.size(); i++) {
        const auto value = [&]() -> const std::string & {
            if (++i == args.size())
                throw std::runtime_error(args[i - 1] + " needs a value");
            return args[i];
        };
        if (args[i] == "--help")
            o.help = true;
        else if (args[i] == "--scene")
            o.scene = value();
        else if (args[i] == "--set")
            o.settings.push_back(value());
        else if (args[i] == "-o")
            o.output = value();
        else if (args[i] == "--euler")
            o.euler = true;
        else if (args[i] == "--all-lit")
            o.all_lit = true;
        else if (args[i] == "--adaptive")
            o.adaptive = true;
        else if (args[i][0] == '-' || !o.volume.empty())
            throw std::runtime_error("unexpected argument '" + args[i] + "'");
        else
            o.volume = args[i];
    }
    if (!o.help && (o.volume.empty() || o.output.empty()))
        throw std::runtime_error("needs VOLUME.float and -o OUT.pfm;"
                                 " --help tells more");
    return o;
}

struct lookups {
    unsigned long long view = 0, light = 0;
};

// One ray. Lattice points are numbered from the eye, as in the reference.
class marcher
{
  public:
    marcher(const volume &v, const scene &s, const options &o)
        : volume_(v), scene_(s), options_(o), camera_(v, s),
          light_(v, scene_, camera_.sun())
    {
    }

    double pixel(int x, int y, lookups &n) const
    {
        const ray r = camera_.camera_ray(x, y);
        state s;
        double first, last;
        if (crosses(r, first, last))
            walk(r, jitter(x, y), first, last, s, n);
        return scene_.lit.exposure * scene_.albedo * s.light +
               scene_.background.x * s.transmittance;
    }

  private:
    struct state {
        double transmittance = 1, light = 0;
    };

    double jitter(int x, int y) const
    {
        if (!scene_.jitter_primary)
            return 0;
        return noise_value(scene_.noise_kind, static_cast<uint32_t>(x),
                           static_cast<uint32_t>(y), scene_.frame,
                           primary_channel, scene_.noise_values) /
               65536.0;
    }

    // Numbers of the lattice points in the box, without jitter.
    bool crosses(const ray &r, double &first, double &last) const
    {
        const vec3 low = volume_.box_min(), high = volume_.box_max();
        double from = 0, to = 1e30;
        const double o[3] = {r.origin.x, r.origin.y, r.origin.z};
        const double d[3] = {r.direction.x, r.direction.y, r.direction.z};
        const double a[3] = {low.x, low.y, low.z};
        const double b[3] = {high.x, high.y, high.z};
        for (int i = 0; i < 3; i++) {
            if (d[i] == 0 && (o[i] < a[i] || o[i] > b[i]))
                return false;
            if (d[i] == 0)
                continue;
            const double s = (a[i] - o[i]) / d[i], t = (b[i] - o[i]) / d[i];
            from = std::max(from, std::min(s, t));
            to = std::min(to, std::max(s, t));
        }
        first = std::max(0.0, std::floor(from / scene_.step) - 1);
        last = std::ceil(to / scene_.step) + 1;
        return from <= to;
    }

    void walk(const ray &r, double jitter, double first, double last, state &s,
              lookups &n) const
    {
        bool small = !options_.adaptive;
        int empty = 0;
        for (double k = first; k <= last;) {
            const vec3 p =
                r.origin + r.direction * ((k + jitter) * scene_.step);
            const double density = volume_.density(p, scene_.filter);
            const bool met = density > scene_.min_density;
            n.view++;
            if (!small && met) { // this one is looked up again
                small = true;
                empty = 0;
                k = std::max(first, k - 1);
                continue;
            }
            if (small && (met || options_.all_lit))
                add(r, p, density, s, n);
            if (s.transmittance < scene_.min_transmittance)
                break;
            empty = met ? 0 : empty + 1;
            small = !options_.adaptive || (small && empty < 4);
            k += small ? 1 : 2;
        }
    }

    void add(const ray &r, const vec3 &p, double density, state &s,
             lookups &n) const
    {
        const double tau = scene_.density_scale * density * scene_.step;
        const double a =
            options_.euler ? std::max(0.0, 1 - tau) : std::exp(-tau);
        s.light += s.transmittance * (1 - a) * in_scattered(r, p);
        s.transmittance *= a;
        n.light += static_cast<unsigned long long>(scene_.light_samples);
    }

    // Octaves of Wrenninge et al. 2013, as in the reference.
    double in_scattered(const ray &r, const vec3 &p) const
    {
        const lighting &l = scene_.lit;
        const double depth = light_.depth(p, 0);
        const double cosine = dot(r.direction, camera_.sun());
        double sum = 0, extinction = 1, share = 1, width = 1;
        for (int i = 0; i < l.octaves; i++) {
            sum += share * phase_value(widened(l.phase, width), cosine) *
                   std::exp(-extinction * depth);
            extinction *= l.octave_a;
            share *= l.octave_b;
            width *= l.octave_c;
        }
        return sum;
    }

    const volume &volume_;
    const scene scene_;
    const options options_;
    renderer camera_;
    sun_light light_;
};

picture render(const marcher &m, const scene &s, lookups &sum)
{
    picture out{s.width, s.height, 1, {}};
    out.values.resize(static_cast<size_t>(s.width) *
                      static_cast<size_t>(s.height));
    std::atomic<int> next{0};
    std::atomic<unsigned long long> view{0}, light{0};
    const auto work = [&] {
        for (int y; (y = next++) < s.height;) {
            lookups n;
            for (int x = 0; x < s.width; x++)
                out.values[static_cast<size_t>(y) *
                               static_cast<size_t>(s.width) +
                           static_cast<size_t>(x)] = m.pixel(x, y, n);
            view += n.view;
            light += n.light;
        }
    };
    std::thread helper(work);
    work();
    helper.join();
    sum = {view, light};
    return out;
}

void run(const options &o)
{
    scene_builder builder;
    if (!o.scene.empty())
        builder.read_file(o.scene);
    for (const std::string &pair : o.settings)
        builder.set_pair(pair);
    const scene s = builder.finish();
    if (s.background_is_rgb || s.lit.sky || s.lit.ambient != ambient_kind::none)
        throw std::runtime_error("the scene has a sky or a colour");
    const volume v(read_float_dump(o.volume), s.max_density);
    const marcher m(v, s, o);
    lookups n;
    write_pfm(o.output, render(m, s, n));
    const double pixels = static_cast<double>(s.width) * s.height;
    std::printf("view=%.6g\nlight=%.6g\n", static_cast<double>(n.view) / pixels,
                static_cast<double>(n.light) / pixels);
}

} // namespace

int main(int argc, char **argv)
{
    try {
        const options o = parse({argv + 1, argv + argc});
        if (o.help)
            std::fputs(help_text, stdout);
        else
            run(o);
    } catch (const std::exception &e) {
        std::fprintf(stderr, "brume-papers: %s\n", e.what());
        return 2;
    }
    return 0;
}
