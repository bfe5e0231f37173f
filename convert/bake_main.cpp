// SPDX-License-Identifier: MIT
//
// brume-bake: an OpenVDB or NanoVDB density becomes a brume asset.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <new>
#include <tbb/global_control.h>

#include "brume.h"
#include "budget.hpp"
#include "options.hpp"
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
        read_grids();
        r_.seconds.read = watch_.lap();
        prepare_voxels();
        prepare_emission();
        if (o_.budget == 0)
            take_lod(std::max(o_.lod, 0));
        r_.seconds.voxels = watch_.lap();
        if (o_.budget > 0)
            fit_budget();
        else
            quantise_voxels();
        r_.seconds.quantise = watch_.lap();
        make_light();
        r_.seconds.light = watch_.lap();
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
        if (o_.form() == output_form::assembly)
            included_ = std::make_unique<atomic_file>(included_path(o_.output));
        if (!o_.report.empty())
            report_ = std::make_unique<atomic_file>(o_.report);
        if (!o_.dump.empty())
            dump_ = std::make_unique<atomic_file>(o_.dump);
        if (!o_.emission_dump.empty())
            emission_dump_ = std::make_unique<atomic_file>(o_.emission_dump);
    }

    // With a second grid one of the two may be missing, or have no voxels; no
    // name stands for another then.
    void read_grids()
    {
        const bool two = !o_.emission.empty();
        const std::string grid = two && o_.grid.empty() ? "density" : o_.grid;
        const grid_need need =
            two || o_.allow_empty ? grid_need::nothing : grid_need::voxels;

        src_ = read_source(o_.input, grid, o_.fog, need, bar_);
        if (two)
            glow_src_ = read_source(o_.input, o_.emission, false,
                                    grid_need::nothing, bar_);
        if (src_.missing && (!two || glow_src_.missing)) // for its message
            read_source(o_.input, grid, o_.fog, grid_need::voxels, bar_);
        for (const source *s : {&src_, &glow_src_})
            if (s->missing)
                notice("has no grid \"" + s->name + "\": it is 0 everywhere");
        if (src_.missing)
            std::copy_n(glow_src_.vol.world, 12, src_.vol.world);
    }

    void notice(const std::string &what)
    {
        bar_.clear();
        std::fprintf(stderr, "brume-bake: %s: notice: %s\n", o_.input.c_str(),
                     what.c_str());
    }

    // `of` is "" or says of which grid.
    void tell_about(const source &s, const std::string &of)
    {
        const bad_voxels &b = s.bad;

        if (b.total() > 0)
            notice(of + text("%llu NaN, %llu infinite and %llu negative voxels "
                             "are taken as 0",
                             (unsigned long long)b.nan,
                             (unsigned long long)b.infinite,
                             (unsigned long long)b.negative));
        if (s.background != 0)
            notice(of +
                   text("the background is %g, not 0: the volume is the box "
                        "of the active voxels",
                        s.background));
        if (s.from_level_set)
            notice("the level set was converted to a density");
    }

    // From what was read to what is quantised.
    void prepare_voxels()
    {
        tell_about(src_, "");
        if (!is_uniform(src_.vol)) {
            measure(src_.vol); // drops empty blocks
            src_.vol = make_uniform(src_.vol);
            r_.resampled = true;
            notice(text("its voxels are not cubes of one orientation: "
                        "resampled to cubes of %.6g",
                        std::hypot(src_.vol.world[0], src_.vol.world[4],
                                   src_.vol.world[8])));
        }
        if (o_.max_density > 0)
            clamp(src_.vol, o_.max_density);
    }

    // The second grid, in the index space of the first.
    void prepare_emission()
    {
        volume &vol = glow_.vol;

        glow_.on = !o_.emission.empty();
        if (!glow_.on || glow_src_.missing)
            return;
        tell_about(glow_src_, "grid \"" + glow_src_.name + "\": ");
        vol = std::move(glow_src_.vol);
        measure(vol); // drops empty blocks
        if (!same_transform(vol.world, src_.vol.world)) {
            vol = resample_to(vol, src_.vol.world);
            notice("grid \"" + glow_src_.name +
                   "\": resampled to the voxels "
                   "of grid \"" +
                   src_.name + "\"");
        }
        glow_.m = measure(vol);
        if (o_.emission_max > 0 && glow_.m.max > o_.emission_max) {
            notice(text("grid \"%s\": its maximum of %g is limited to %g",
                        glow_src_.name.c_str(), double(glow_.m.max),
                        double(o_.emission_max)));
            clamp(vol, o_.emission_max);
            glow_.m = measure(vol);
        }
        glow_.max = o_.emission_max > 0 ? o_.emission_max : glow_.m.max;
    }

    void require_voxels() const
    {
        if (m_.voxels > 0 || glow_.m.voxels > 0 || o_.allow_empty)
            return;
        if (glow_.on)
            throw failure("neither grid \"" + src_.name + "\" nor grid \"" +
                          o_.emission +
                          "\" has a voxel above 0 (see --allow-empty)");
        throw failure("grid \"" + src_.name +
                      "\" has no voxel with density above 0");
    }

    int side() const
    {
        return o_.apron ? apron_side : block_side;
    }

    void take_lod(int lod)
    {
        for (int i = 0; i < lod; i++)
            src_.vol = halve(src_.vol), glow_ = halve(glow_);
        r_.lod = lod;
        m_ = measure(src_.vol);
        require_voxels();
        if (o_.emission_max == 0)
            glow_.max = glow_.m.max;
        l_ = make_layout(src_.vol, glow_, box_of_both(m_, glow_), side(),
                         o_.order);
    }

    bool make(int format, const brick_limits &limit)
    {
        return make_bricks(src_.vol, m_, l_, {format, l_.side, m_.max}, limit,
                           bar_, pool_);
    }

    // The smallest format that keeps to the limits, or u8r: larger than u8 by
    // its ranges, and the most exact.
    void quantise_voxels()
    {
        brick_limits limits;
        limits.error = {auto_rmse * m_.mean, auto_worst * double(m_.max)};
        const quantisation_error &limit = limits.error;
        const quantisation_error &e = pool_.error;
        std::string failed;

        if (o_.format != "auto") {
            r_.why = "asked for";
            make(o_.formats()[0], {});
            return;
        }
        for (int id : {BRUME_U4R, BRUME_U8}) {
            if (make(id, limits)) {
                r_.why = within_limits + failed;
                return;
            }
            failed += text("; %s %s too large", pool_.format.name(),
                           e.rmse > limit.rmse ? "rmse" : "max error");
        }
        make(BRUME_U8R, {});
        const bool good = e.rmse <= limit.rmse && e.worst <= limit.worst;
        r_.why = (good ? within_limits : most_exact) + failed;
    }

    // Search, then make the choice again and hold it against the input.
    void fit_budget()
    {
        const int last = o_.lod >= 0 ? o_.lod : most_lod;
        budget_search search({o_.budget, o_.formats(), std::max(o_.lod, 0),
                              last, side(), o_.order, src_.name, o_.light},
                             std::move(src_.vol), std::move(glow_), bar_);
        if (search.input_measures().voxels == 0)
            throw failure("--budget needs density: grid \"" + src_.name +
                          "\" has none");
        const candidate best = search.choose();

        r_.lod = best.lod;
        m_ = search.measures_at(best.lod);
        const emission_grid &glow = search.emission_at(best.lod);
        l_ = make_layout(search.volume_at(best.lod), glow,
                         box_of_both(m_, glow), side(), o_.order);
        make_bricks(search.volume_at(best.lod), m_, l_,
                    {best.format, l_.side, m_.max}, {}, bar_, pool_);
        r_.budget.bytes = o_.budget;
        r_.budget.tried = search.tried();
        r_.budget.input_max = double(search.input_measures().max);
        r_.budget.error = measure_grid_error(search.volume_at(0),
                                             search.input_measures().voxels, l_,
                                             pool_, best.lod, bar_);
        r_.why = text("the least error that fits into %llu bytes",
                      (unsigned long long)o_.budget);
        src_.vol = search.take_volume(best.lod);
        glow_ = search.take_emission(best.lod);
        l_.glow = glow_.on ? &glow_ : nullptr;
        notice(budget_notice(r_.budget, best));
    }

    void make_light()
    {
        const uint64_t bytes =
            size_of_asset(pool_, src_.name,
                          sizes_of(o_.light, l_.cells, pool_.bricks))
                .total;

        if (bytes >= blob_limit)
            throw failure(text("with its sections for light the asset takes "
                               "%llu bytes; a file may have 2 GiB (try --lod)",
                               (unsigned long long)bytes));
        light_ = make_light_sections(o_.light, src_.vol.world, l_, pool_, bar_);
    }

    void fill_report()
    {
        r_.input = o_.input;
        r_.output = o_.output;
        r_.asked_format = o_.format;
        r_.light = o_.light;
        r_.src = &src_;
        r_.glow_name = glow_src_.name;
        r_.glow_bad = glow_src_.bad;
        r_.glow = &glow_;
        r_.m = &m_;
        r_.l = &l_;
        r_.pool = &pool_;
        r_.size = size_of_asset(pool_, src_.name, light_.sizes());
        if (o_.form() != output_form::binary)
            r_.symbol = o_.symbol.empty() ? symbol_for(o_.output) : o_.symbol;
    }

    void write_form()
    {
        const source_text t = {o_.output, r_.symbol,
                               o_.licence.empty() ? src_.licence : o_.licence,
                               facts(r_)};
        const auto bake_to = [&](output &out) {
            write_asset(out,
                        {src_.vol, m_, glow_, l_, pool_, light_, src_.name});
        };

        if (o_.form() == output_form::binary) {
            bake_to(*asset_);
        } else if (o_.form() == output_form::c) {
            memory_output bytes;
            bake_to(bytes);
            write_c(*asset_, t, bytes.bytes());
        } else {
            bake_to(*included_);
            write_assembly(*asset_, t, r_.size.total);
        }
    }

    void write()
    {
        fill_report();
        // Their pages then hold the file on its way to the disk, which is
        // quicker than to ask the kernel for new ones.
        if (!dump_)
            src_.vol.drop_voxels();
        write_form();
        if (dump_)
            write_float_dump(*dump_, src_.vol, l_);
        if (emission_dump_) {
            std::copy_n(src_.vol.world, 12, glow_.vol.world);
            write_float_dump(*emission_dump_, glow_.vol, l_);
        }
        r_.seconds.write = watch_.lap();
        if (report_) {
            const std::string json = to_json(r_);
            report_->write(json.data(), json.size());
        }
        std::vector<atomic_file *> all;
        for (const file *f :
             {&report_, &dump_, &emission_dump_, &included_, &asset_})
            if (*f)
                all.push_back(f->get());
        for (atomic_file *f : all)
            f->finish();
        commit_all(all);
    }

    const options &o_;
    stopwatch watch_;
    file asset_, included_, report_, dump_, emission_dump_;
    progress bar_;
    source src_, glow_src_; // the second one if there is one
    measures m_;
    emission_grid glow_;
    layout l_;
    brick_pool pool_;
    light_sections light_;
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
