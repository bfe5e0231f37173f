// SPDX-License-Identifier: MIT
//
// brume-bake: an OpenVDB or NanoVDB density becomes a brume asset.
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <new>
#include <tbb/global_control.h>

#include "brume.h"
#include "report.hpp"
#include "resample.hpp"

namespace bake
{

namespace
{

// What `--format auto` accepts, over the non-zero voxels.
//
// RMSE: 1 % of the mean density shifts optical depth, a sum over many voxels
// of both signs, by far less than 1 %.
// Worst error: one step of u8, 1/255 of the maximum. A single voxel can then
// move a step through the densest part by one grey level of an 8-bit picture
// at most, so no voxel can show alone. u8 (half a step) always passes.
constexpr double auto_rmse = 0.01;
constexpr double auto_worst = 1.0 / 255;
const std::string within_limits =
    "the smallest with rmse <= 1 % of the mean and max <= 1/255 of the "
    "maximum";
const std::string most_exact = "the most exact, beyond the limits of auto";

constexpr int most_lod = 8;
constexpr int most_threads = 1024;

const char usage[] =
    "usage: brume-bake IN.vdb|IN.nvdb -o OUT.brume [option]...\n"
    "\n"
    "Bake the density of an OpenVDB or NanoVDB file into a brume asset.\n"
    "\n"
    "  -o FILE              the asset to write\n"
    "  --grid NAME|#i       the grid to take, by name or index from 0\n"
    "  --format F           auto (default), u8, u8r or u4r\n"
    "  --lod N              halve the resolution N times, 0 to 8\n"
    "  --max-density D      limit the density to D\n"
    "  --apron              store 9^3 voxels per brick, for fast trilinear\n"
    "  --order O            number bricks in morton (default) or linear "
    "order\n"
    "  --level-set-to-fog   convert a level set to a density\n"
    "  --report FILE        write figures as JSON\n"
    "  --dump-float FILE    write the voxels before quantisation\n"
    "  --threads N          use N threads (default: all); the output is the "
    "same\n"
    "  --help               this text\n"
    "\n"
    "Exit status: 0 done, 1 the input cannot be baked or a file not\n"
    "written, 2 wrong usage or a grid must be chosen.\n";

struct options {
    std::string input, output, grid, format = "auto", report, dump;
    int lod = 0, threads = 0;
    float max_density = 0; // 0: no limit
    bool apron = false, fog = false, help = false;
    brick_order order = brick_order::morton;
};

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

float positive_number(const std::string &key, const char *s)
{
    char *end;
    const float v = std::strtof(s, &end);

    if (end == s || *end != '\0' || !std::isfinite(v) || v <= 0)
        bad_usage(key + " takes a number above 0, not \"" + s + "\"");
    return v;
}

// Options that take a value. Returns false for a key that is not one.
bool set_value(options &o, const std::string &key, const char *v)
{
    if (key == "-o")
        o.output = v;
    else if (key == "--grid")
        o.grid = v;
    else if (key == "--format")
        o.format = v;
    else if (key == "--lod")
        o.lod = whole_number(key, v, 0, most_lod);
    else if (key == "--max-density")
        o.max_density = positive_number(key, v);
    else if (key == "--order" && !std::strcmp(v, "linear"))
        o.order = brick_order::linear;
    else if (key == "--order" && std::strcmp(v, "morton") != 0)
        bad_usage("--order is morton or linear, not \"" + std::string(v) +
                  "\"");
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

void check_options(const options &o)
{
    std::error_code none;

    if (o.input.empty())
        bad_usage("no input file");
    if (o.output.empty())
        bad_usage("no output file: -o FILE is missing");
    if (o.format != "auto" && format_id(o.format) == 0)
        bad_usage("--format is auto, u8, u8r or u4r, not \"" + o.format + "\"");
    for (const std::string &out : {o.output, o.report, o.dump})
        if (std::filesystem::equivalent(o.input, out, none))
            bad_usage(out + ": is the input itself");
    if (o.output == o.report || o.output == o.dump ||
        (o.report == o.dump && !o.dump.empty()))
        bad_usage("two outputs have one name");
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

class stopwatch
{
  public:
    double lap()
    {
        const auto now = std::chrono::steady_clock::now();
        const std::chrono::duration<double> d = now - last_;
        last_ = now;
        return d.count();
    }

  private:
    std::chrono::steady_clock::time_point last_ =
        std::chrono::steady_clock::now();
};

// One run of the program, in the order of its stages.
class baker
{
  public:
    explicit baker(const options &o) : o_(o)
    {
    }

    void run()
    {
        open_outputs();
        src_ = read_source(o_.input, o_.grid, o_.fog, bar_);
        r_.seconds.read = watch_.lap();
        prepare_voxels();
        r_.seconds.voxels = watch_.lap();
        quantise_voxels();
        r_.seconds.quantise = watch_.lap();
        bar_.clear();
        write();
        std::fputs(summary(r_).c_str(), stdout);
    }

  private:
    using file = std::unique_ptr<atomic_file>;

    // First of all, so that a long bake cannot end in a missing folder.
    void open_outputs()
    {
        asset_ = std::make_unique<atomic_file>(o_.output);
        if (!o_.report.empty())
            report_ = std::make_unique<atomic_file>(o_.report);
        if (!o_.dump.empty())
            dump_ = std::make_unique<atomic_file>(o_.dump);
    }

    void notice(const std::string &what)
    {
        bar_.clear();
        std::fprintf(stderr, "brume-bake: %s: notice: %s\n", o_.input.c_str(),
                     what.c_str());
    }

    void tell_about_source()
    {
        const bad_voxels &b = src_.bad;

        if (b.total() > 0)
            notice(text("%llu NaN, %llu infinite and %llu negative voxels "
                        "are taken as 0",
                        (unsigned long long)b.nan,
                        (unsigned long long)b.infinite,
                        (unsigned long long)b.negative));
        if (src_.background != 0)
            notice(text("the background is %g, not 0: the volume is the box "
                        "of the active voxels",
                        src_.background));
        if (src_.from_level_set)
            notice("the level set was converted to a density");
    }

    // From what was read to what is quantised.
    void prepare_voxels()
    {
        tell_about_source();
        if (!is_uniform(src_.vol)) {
            measure(src_.vol); // drops empty blocks
            if (!src_.vol.blocks.empty())
                src_.vol = make_uniform(src_.vol);
            r_.resampled = true;
            notice(text("its voxels are not cubes of one orientation: "
                        "resampled to cubes of %.6g",
                        std::hypot(src_.vol.world[0], src_.vol.world[4],
                                   src_.vol.world[8])));
        }
        for (int i = 0; i < o_.lod; i++)
            src_.vol = halve(src_.vol);
        if (o_.max_density > 0)
            clamp(src_.vol, o_.max_density);
        m_ = measure(src_.vol);
        if (m_.voxels == 0)
            throw failure("grid \"" + src_.name +
                          "\" has no voxel with "
                          "density above 0");
        l_ = make_layout(src_.vol, m_.tight, o_.apron ? apron_side : block_side,
                         o_.order);
    }

    bool make(int format, const quantisation_error &limit)
    {
        return make_bricks(src_.vol, m_, l_, {format, l_.side, m_.max}, limit,
                           bar_, pool_);
    }

    // The smallest format that keeps to the limits, or u8r: larger than u8 by
    // its ranges, and the most exact.
    void quantise_voxels()
    {
        const quantisation_error limit = {auto_rmse * m_.mean,
                                          auto_worst * double(m_.max)};
        const quantisation_error &e = pool_.error;
        std::string failed;

        if (o_.format != "auto") {
            r_.why = "asked for";
            make(format_id(o_.format), no_limit);
            return;
        }
        for (int id : {BRUME_U4R, BRUME_U8}) {
            if (make(id, limit)) {
                r_.why = within_limits + failed;
                return;
            }
            failed += text("; %s %s too large", pool_.format.name(),
                           e.rmse > limit.rmse ? "rmse" : "max error");
        }
        make(BRUME_U8R, no_limit);
        const bool good = e.rmse <= limit.rmse && e.worst <= limit.worst;
        r_.why = (good ? within_limits : most_exact) + failed;
    }

    void write()
    {
        // Their pages then hold the file on its way to the disk, which is
        // quicker than to ask the kernel for new ones.
        if (!dump_)
            src_.vol.drop_voxels();
        r_.size = write_asset(*asset_, src_.vol, m_, l_, pool_, src_.name);
        asset_->finish();
        if (dump_) {
            write_float_dump(*dump_, src_.vol, l_);
            dump_->finish();
        }
        r_.seconds.write = watch_.lap();
        r_.input = o_.input;
        r_.output = o_.output;
        r_.asked_format = o_.format;
        r_.src = &src_;
        r_.m = &m_;
        r_.l = &l_;
        r_.pool = &pool_;
        r_.lod = o_.lod;
        if (report_) {
            const std::string json = to_json(r_);
            report_->write(json.data(), json.size());
            report_->finish();
            report_->commit();
        }
        if (dump_)
            dump_->commit();
        asset_->commit();
    }

    const options &o_;
    stopwatch watch_;
    file asset_, report_, dump_;
    progress bar_;
    source src_;
    measures m_;
    layout l_;
    brick_pool pool_;
    report r_;
};

int complain(const std::string &input, const std::string &what, int code)
{
    std::fprintf(stderr, "brume-bake: %s%s%s\n", input.c_str(),
                 input.empty() ? "" : ": ", what.c_str());
    return code;
}

// Libraries put line breaks and bytes of the file into their messages; ours
// is one line.
std::string one_line(std::string s)
{
    for (char &c : s)
        if (uint8_t(c) < 0x20 || uint8_t(c) > 0x7e)
            c = ' ';
    return s.substr(0, 200);
}

int run(const options &o)
{
    const int threads =
        o.threads ? o.threads : tbb::this_task_arena::max_concurrency();
    const tbb::global_control limit(
        tbb::global_control::max_allowed_parallelism, size_t(threads));

    try {
        // The libraries report on std::cerr what they also throw.
        std::cerr.rdbuf(nullptr);
        openvdb::initialize();
        baker(o).run();
        return 0;
    } catch (const failure &e) {
        return complain(o.input, e.what(), e.code);
    } catch (const std::bad_alloc &) {
        return complain(o.input, "not enough memory", status_failed);
    } catch (const std::exception &e) {
        return complain(o.input, "cannot be read: " + one_line(e.what()),
                        status_failed);
    } catch (...) {
        return complain(o.input, "cannot be read", status_failed);
    }
}

} // namespace

} // namespace bake

int main(int count, char **args)
{
    bake::options o;

    try {
        o = bake::parse(count, args);
    } catch (const bake::failure &e) {
        return bake::complain("", e.what(), e.code);
    }
    if (o.help) {
        std::fputs(bake::usage, stdout);
        return 0;
    }
    return bake::run(o);
}
