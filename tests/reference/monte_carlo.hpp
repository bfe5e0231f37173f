// SPDX-License-Identifier: MIT
//
// Multiple scattering of any order by paths from the eye, without bias: what
// single scattering, octaves and caches are wrong by. Units are those of
// docs/light.md: unshadowed light scatters as albedo * 4 pi p.
#ifndef BRUME_REFERENCE_MONTE_CARLO_HPP
#define BRUME_REFERENCE_MONTE_CARLO_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "march.hpp"
#include "medium.hpp"
#include "random.hpp"
#include "phase_sampling.hpp"

namespace reference
{

enum class light_source {
    sun,
    // Beyond the volume radiance is 1 in all directions.
    environment,
    // The same, but by a sun that each path finds in another direction: it
    // puts values of the phase function and shadows to the test.
    all_suns,
};

struct path_settings {
    double extinction = 1;       // per voxel at density 1
    double light_extinction = 1; // the same, from a vertex to the sun
    phase_model phase;
    light_source source = light_source::sun;
    int order = 0; // the last scattering that counts; 0: all
    // One estimate for each, all from the same paths.
    std::vector<double> albedos = {1};
};

class path_tracer
{
  public:
    // Keeps a reference to the medium.
    path_tracer(const medium &m, const path_settings &s, const vec3 &sun);

    // Adds the radiance of one path, for each albedo, to `light`. Returns
    // whether the path went through the medium without a collision.
    bool trace(const ray &r, random_source &random,
               std::vector<double> &light) const;

  private:
    struct path;
    void scatter(path &p, std::vector<double> &light) const;
    double lit(const path &p) const;
    double lit_by_lobe(const path &p) const;
    bool survives(path &p) const;

    const medium &medium_;
    const path_settings settings_;
    const vec3 sun_;
    const bool use_lobe_;
};

// Sums over passes, one path a pixel and pass. A pixel's values are its
// radiance for each albedo, and its transmittance.
struct path_sums {
    int width = 0, height = 0, values = 0;
    uint64_t passes = 0;
    std::vector<double> sum, squares; // values interleaved, row 0 on top

    path_sums(int w, int h, int n);
    double mean(size_t i) const
    {
        return sum[i] / static_cast<double>(passes);
    }
    double standard_error(size_t i) const; // of the mean
};

// Adds passes to `sums` until there are `passes`. A pixel's random numbers
// depend on the seed, the pixel and the pass, so that neither the number of
// threads nor a break shows.
void trace_passes(const path_tracer &tracer, const renderer &camera,
                  uint64_t seed, uint64_t passes, int threads, path_sums &sums);

// For the keys of sums.
uint64_t hash_of(const float_dump &dump);

// Sums on disk, for going on later: `key` says what they are sums of. Reading
// returns false when there is no such file. In the byte order of the machine.
// Both throw std::runtime_error: for a file with another key, too.
bool read_sums(const std::string &path, const std::string &key,
               path_sums &sums);
void write_sums(const std::string &path, const std::string &key,
                const path_sums &sums);

} // namespace reference

#endif
