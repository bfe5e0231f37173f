// SPDX-License-Identifier: MIT

#include "contender.hpp"

#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <unistd.h>

#include "scene.hpp"

namespace bench
{

double clock_ms(bool wall)
{
    timespec t;
    clock_gettime(wall ? CLOCK_MONOTONIC : CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) +
           1e-6 * static_cast<double>(t.tv_nsec);
}

/// Files ///

const grids &library::grid(const std::string &path)
{
    const auto found = grids_.find(path);
    if (found != grids_.end())
        return found->second;
    return grids_[path] = read_grids(path);
}

const volume_file &library::asset(const std::string &path)
{
    std::unique_ptr<volume_file> &file = assets_[path];
    if (!file) {
        char text[400];
        file = std::make_unique<volume_file>();
        if (volume_file_open(file.get(), path.c_str(), text, sizeof text) != 0)
            throw std::runtime_error(text);
    }
    return *file;
}

// Memory of this process.
static size_t resident()
{
    std::ifstream in("/proc/self/statm");
    size_t all = 0, pages = 0;
    in >> all >> pages;
    return pages * static_cast<size_t>(sysconf(_SC_PAGESIZE));
}

const copied &library::copy(const std::string &path, const brume_frame &frame)
{
    const bool first = copies_.count(path) == 0;
    copied &copy = copies_[path];
    if (first)
        wide_copy_init(&copy.copy, &asset(path).volume, WIDE_COPY_MOST);
    const size_t before = resident();
    const double from = clock_ms(true);
    wide_copy_prepare(&copy.copy, &frame, nullptr);
    copy.ms += clock_ms(true) - from;
    copy.bytes += resident() - before;
    return copy;
}

/// The line ///

static int whole(const std::string &text, int most)
{
    const int value = std::atoi(text.c_str());
    if (value < 1 || value > most)
        throw std::runtime_error("'" + text + "' is out of range");
    return value;
}

void contender::set(const std::string &key, const std::string &value)
{
    if (key == "name")
        name_ = value;
    else if (key == "render")
        renderer_ = value;
    else if (key == "vdb")
        vdb_ = value;
    else if (key == "asset")
        asset_ = value;
    else if (key == "part")
        job_.part = static_cast<unsigned>(whole(value, 64));
    else if (key == "threads")
        job_.threads = whole(value, 64);
    else if (key == "tile") {
        job_.tile_width = static_cast<unsigned>(whole(value, 4096));
        job_.tile_height = static_cast<unsigned>(
            whole(value.substr(value.find('x') + 1), 4096));
    } else if (key == "order")
        job_.order = value == "morton"    ? OURS_MORTON
                     : value == "hilbert" ? OURS_HILBERT
                                          : OURS_LINEAR;
    else
        settings_.push_back(key + "=" + value);
}

contender::contender(const std::string &line, library &files)
{
    std::istringstream in(line);
    job_.part = 1;
    job_.threads = 1;
    job_.tile_width = 16; // as the renderer of the command
    job_.tile_height = 16;
    job_.order = OURS_HILBERT;
    for (std::string pair; in >> pair;) {
        const size_t equals = pair.find('=');
        if (equals == std::string::npos)
            throw std::runtime_error("expected key=value: '" + pair + "'");
        set(pair.substr(0, equals), pair.substr(equals + 1));
    }
    key_ = vdb_ + " " + asset_ + " " + std::to_string(job_.part);
    for (const std::string &setting : settings_)
        key_ += " " + setting;
    if (!vdb_.empty())
        grids_ = &files.grid(vdb_);
    if (!asset_.empty())
        file_ = &files.asset(asset_);
    set_renderer(files);
    if (grids_)
        set_view();
}

void contender::set_renderer(library &files)
{
    static const std::map<std::string, peer *> peers = {
        {"nano-shipped", nano_shipped}, {"nano-tuned", nano_tuned},
        {"nano-leaping", nano_leaping}, {"nano-fp8", nano_fp8},
        {"nano-leaf", nano_leaf},       {"pnano", pnano},
        {"open", open_tuned},           {"double", nano_double}};
    const auto found = peers.find(renderer_);
    if (found != peers.end()) {
        if (!grids_)
            throw std::runtime_error(renderer_ + " needs vdb=FILE");
        peer_ = found->second;
    } else {
        set_ours(files);
    }
}

void contender::set_ours(library &files)
{
    bool copy = false;
    if (renderer_.compare(0, 5, "loads") == 0) {
        lanes_ = whole(renderer_.substr(5), 16);
        if (!ours_can_replay(lanes_))
            throw std::runtime_error(renderer_ + " cannot be had here");
    } else if (!ours_kernel(renderer_.c_str(), &job_.kernel, &copy))
        throw std::runtime_error("no renderer '" + renderer_ + "' here");
    if (!file_)
        throw std::runtime_error(renderer_ + " needs asset=FILE");
    std::vector<const char *> settings;
    for (const std::string &setting : settings_)
        settings.push_back(setting.c_str());
    char text[400];
    if (ours_frame(frame_.get(), file_, settings.data(), settings.size(), text,
                   sizeof text) != 0)
        throw std::runtime_error(text);
    if (copy) {
        copied_ = &files.copy(asset_, *frame_);
        job_.copy = &copied_->copy;
    }
    radiance_.resize(static_cast<size_t>(frame_->width) * frame_->height);
    job_.frame = frame_.get();
    job_.out = radiance_.data();
    if (lanes_)
        set_places();
}

void contender::set_places()
{
    const brume_volume &v = file_->volume;
    if (v.format != BRUME_U8 || v.side != 8)
        throw std::runtime_error("loads alone are known for u8 without apron");
    const lookup_count n = count();
    place_.resize(n.view + n.light);
    places_ = {&v, place_.data(), 0, 1, {}};
    for (const std::string &setting : settings_)
        if (setting.compare(0, 7, "filter=") == 0)
            places_.rows = setting == "filter=trilinear" ? 4 : 1;
    ours_record(&job_, &places_);
}

/// The view ///

using reference::vec3;

static void store(double out[3], const vec3 &v)
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

// World to index space by the transposed matrix, which is a scale times a
// rotation: brume's volumes are.
static vec3 turned(const grids &g, const vec3 &v)
{
    const double *m = g.world_from_index;
    const double square = m[0] * m[0] + m[4] * m[4] + m[8] * m[8];
    return vec3{m[0] * v.x + m[4] * v.y + m[8] * v.z,
                m[1] * v.x + m[5] * v.y + m[9] * v.z,
                m[2] * v.x + m[6] * v.y + m[10] * v.z} *
           (1 / square);
}

static std::vector<float> jitters(const reference::scene &s, bool on,
                                  reference::channel channel)
{
    std::vector<float> out;
    for (int y = 0; y < s.height; y++)
        for (int x = 0; x < s.width; x++)
            out.push_back(
                !on ? 0.0F
                    : static_cast<float>(reference::noise_value(
                          s.noise_kind, static_cast<uint32_t>(x),
                          static_cast<uint32_t>(y), s.frame, channel)) /
                          65536.0F);
    return out;
}

static void set_camera(view &v, const reference::scene &s, const grids &g)
{
    const double *m = g.world_from_index;
    const double pixel = 2 * std::tan(s.fov * M_PI / 360) / s.height;
    const double azimuth = s.sun_azimuth * M_PI / 180;
    const double elevation = s.sun_elevation * M_PI / 180;
    const vec3 ahead = normalise(s.target - s.eye);
    const vec3 right = normalise(cross(ahead, s.up));
    const vec3 sun = {std::cos(elevation) * std::sin(azimuth),
                      std::sin(elevation),
                      std::cos(elevation) * std::cos(azimuth)};
    store(v.eye, turned(g, s.eye - vec3{m[3], m[7], m[11]}));
    store(v.ahead, normalise(turned(g, ahead)));
    store(v.right, normalise(turned(g, right)) * pixel);
    store(v.up, normalise(turned(g, cross(right, ahead))) * pixel);
    store(v.sun, normalise(turned(g, sun)));
}

void contender::set_view()
{
    reference::scene_builder builder;
    for (const std::string &setting : settings_)
        builder.set_pair(setting);
    const reference::scene s = builder.finish();
    view &v = view_;
    v.width = s.width;
    v.height = s.height;
    set_camera(v, s, *grids_);
    v.step = s.step;
    v.light_step = s.light_step;
    v.density_scale = s.density_scale;
    v.light_density_scale = s.light_density_scale;
    v.albedo = s.albedo;
    v.min_density = s.min_density;
    v.min_transmittance = s.min_transmittance;
    v.trilinear = s.filter == reference::lookup::trilinear;
    v.uniform = s.light == reference::light_model::uniform;
    v.light_samples =
        s.light == reference::light_model::none ? 0 : s.light_samples;
    for (int i = 0; i < 3; i++) {
        v.low[i] = grids_->low[i] - (v.trilinear ? 1 : 0.5);
        v.high[i] = grids_->high[i] + (v.trilinear ? 1 : 0.5);
    }
    v.jitter = jitters(s, s.jitter_primary, reference::primary_channel);
    v.light_jitter = jitters(s, s.jitter_light, reference::light_channel);
    grey_.resize(static_cast<size_t>(v.width) * v.height);
}

/// Rendering ///

void contender::render()
{
    if (peer_)
        peer_(*grids_, view_, rows(), grey_.data());
    else if (lanes_)
        ours_replay(&places_, lanes_);
    else
        ours_render(&job_);
}

picture contender::exact() const
{
    picture out(grey_.size());
    nano_double(*grids_, view_, rows(), out.data());
    return rows().cut(out, view_.width);
}

picture contender::drawn() const
{
    if (peer_)
        return rows().cut(grey_, view_.width);
    picture out;
    for (const brume_radiance &ray : rows().cut(radiance_, job_.frame->width))
        out.push_back(static_cast<float>(ray.light) / 65536.0F);
    return out;
}

size_t contender::bytes() const
{
    if (!peer_)
        return file_->volume.size + (copied_ ? copied_->bytes : 0);
    if (renderer_ == "nano-fp8")
        return grids_->nano_fp8_bytes;
    return renderer_ == "open" ? grids_->open_bytes : grids_->nano_bytes;
}

size_t contender::cell_bytes() const
{
    const uint16_t *n = file_->volume.cell_count;
    return size_t{4} * n[0] * n[1] * n[2];
}

lookup_count contender::count() const
{
    lookup_count out{};
    if (!peer_)
        ours_count(&job_, &out);
    return out;
}

double contender::covered() const
{
    size_t some = 0;
    const auto drawn = rows().cut(radiance_, job_.frame->width);
    for (const brume_radiance &ray : drawn)
        some += ray.transmittance < 0x10000u;
    return static_cast<double>(some) / static_cast<double>(drawn.size());
}

error_figures compare(const picture &exact, const picture &drawn)
{
    double squares = 0, sum = 0;
    for (size_t i = 0; i < exact.size(); i++) {
        const double d = 255.0 * (static_cast<double>(drawn[i]) -
                                  static_cast<double>(exact[i]));
        squares += d * d;
        sum += d;
    }
    const double n = static_cast<double>(exact.size());
    return {std::sqrt(squares / n), sum / n};
}

} // namespace bench
