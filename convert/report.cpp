// SPDX-License-Identifier: MIT
#include "report.hpp"

#include <cmath>
#include <filesystem>

namespace bake
{

namespace
{

// Text as a JSON string. Bytes above 0x7f pass as the UTF-8 they should be.
std::string quoted(const std::string &s)
{
    std::string out = "\"";

    for (const char c : s) {
        if (c == '"' || c == '\\')
            out += std::string("\\") + c;
        else if (uint8_t(c) < 0x20 || c == 0x7f)
            out += text("\\u%04x", unsigned(uint8_t(c)));
        else
            out += c;
    }
    return out + '"';
}

// An object, a field a line.
class json_object
{
  public:
    explicit json_object(int depth = 1) : indent_(size_t(2 * depth), ' ')
    {
    }

    void raw(const char *key, const std::string &value)
    {
        body_ += (body_.empty() ? "\n" : ",\n") + indent_ + quoted(key) + ": " +
                 value;
    }
    void add(const char *key, const std::string &v)
    {
        raw(key, quoted(v));
    }
    void add(const char *key, uint64_t v)
    {
        raw(key, std::to_string(v));
    }
    void add(const char *key, bool v)
    {
        raw(key, v ? "true" : "false");
    }
    void add(const char *key, double v)
    {
        // JSON has neither infinities nor NaN.
        raw(key, std::isfinite(v) ? text("%.9g", v) : "null");
    }
    std::string close() const
    {
        return "{" + body_ + "\n" + indent_.substr(2) + "}";
    }

  private:
    std::string indent_, body_;
};

std::string vector_of(ijk v)
{
    return text("[%d, %d, %d]", v.x, v.y, v.z);
}

double voxel_size(const volume &vol)
{
    return std::hypot(vol.world[0], vol.world[4], vol.world[8]);
}

uint64_t shared(const brick_pool &p)
{
    return p.occupied - p.bricks;
}

std::string grid_json(const report &r)
{
    json_object o(2);

    o.add("name", r.src->name);
    o.add("type", r.src->type);
    o.add("class", r.src->grid_class);
    o.add("active_voxels", r.src->active);
    o.add("background", r.src->background);
    o.add("converted_level_set", r.src->from_level_set);
    o.add("nan", r.src->bad.nan);
    o.add("infinite", r.src->bad.infinite);
    o.add("negative", r.src->bad.negative);
    return o.close();
}

std::string volume_json(const report &r)
{
    json_object o(2);

    o.add("lod", uint64_t(r.lod));
    o.add("resampled", r.resampled);
    o.add("voxels", r.m->voxels);
    o.raw("box_min", vector_of(r.m->tight.lo));
    o.raw("box_max", vector_of(r.m->tight.hi));
    o.add("voxel_size", voxel_size(r.src->vol));
    o.add("density_max", double(r.pool->format.density_max));
    o.add("density_mean", r.m->mean);
    return o.close();
}

std::string asset_json(const report &r)
{
    json_object o(2);

    o.add("format", std::string(r.pool->format.name()));
    o.add("asked", r.asked_format);
    o.add("why", r.why);
    o.add("side", uint64_t(r.pool->format.side));
    o.raw("cells", vector_of(r.l->cells));
    o.raw("origin", vector_of(r.l->origin));
    o.add("occupied_cells", r.pool->occupied);
    o.add("bricks", r.pool->bricks);
    o.add("shared_bricks", shared(*r.pool));
    o.add("bytes", r.size.total);
    o.add("cell_bytes", r.size.cell);
    o.add("pool_bytes", r.size.pool);
    o.add("range_bytes", r.size.range);
    o.add("name_bytes", r.size.name);
    o.add("mips_bytes", r.size.light.mips);
    o.add("sun_cache_bytes", r.size.light.sun);
    o.add("sky_visibility_bytes", r.size.light.sky);
    return o.close();
}

std::string error_json(const report &r)
{
    json_object o(2);

    o.add("rmse", r.pool->error.rmse);
    o.add("max", r.pool->error.worst);
    o.add("rmse_over_mean", r.pool->error.rmse / r.m->mean);
    o.add("max_over_mean", r.pool->error.worst / r.m->mean);
    return o.close();
}

std::string emission_json(const report &r)
{
    json_object o(2);

    o.add("name", r.glow_name);
    o.add("nan", r.glow_bad.nan);
    o.add("infinite", r.glow_bad.infinite);
    o.add("negative", r.glow_bad.negative);
    o.add("voxels", r.glow->m.voxels);
    o.add("max", double(r.glow->m.max));
    o.add("mean", r.glow->m.mean);
    o.add("value_of_255", double(r.glow->max));
    o.add("bytes", r.size.emission);
    o.add("rmse", r.pool->glow_error.rmse);
    o.add("max_error", r.pool->glow_error.worst);
    return o.close();
}

// In a line of the summary, or of the facts.
std::string emission_text(const report &r)
{
    return text("grid \"%s\", %llu voxels, max %.6g, mean %.6g; code 255 is "
                "%.6g, rmse %.3g, %llu bytes",
                r.glow_name.c_str(), (unsigned long long)r.glow->m.voxels,
                double(r.glow->m.max), r.glow->m.mean, double(r.glow->max),
                r.pool->glow_error.rmse, (unsigned long long)r.size.emission);
}

std::string seconds_json(const stage_seconds &s)
{
    json_object o(2);

    o.add("read", s.read);
    o.add("voxels", s.voxels);
    o.add("quantise", s.quantise);
    o.add("light", s.light);
    o.add("write", s.write);
    o.add("total", s.total());
    return o.close();
}

// The sections for light, and their bytes.
std::vector<std::string> light_texts(const report &r)
{
    const light_request &want = r.light;
    const light_sizes &bytes = r.size.light;
    std::vector<std::string> list;

    if (want.mips)
        list.push_back(text("mips %llu bytes", (unsigned long long)bytes.mips));
    if (want.sun_spacing > 0)
        list.push_back(text("depth towards the sun at %g,%g every %d voxels "
                            "%llu bytes",
                            want.sun[0], want.sun[1], want.sun_spacing,
                            (unsigned long long)bytes.sun));
    if (want.sky_extinction > 0)
        list.push_back(text("sky seen at extinction %g %llu bytes",
                            want.sky_extinction,
                            (unsigned long long)bytes.sky));
    return list;
}

std::string light_line(const report &r)
{
    const double light = double(r.size.light.total());
    std::string s = "light: ";

    for (const std::string &part : light_texts(r))
        s += part + ", ";
    return s + text("%.1f %% more, %.2f s\n",
                    100 * light / (double(r.size.total) - light),
                    r.seconds.light);
}

// Of a mean that is 0 where there is nothing.
double percent(double error, double mean)
{
    return mean > 0 ? 100 * error / mean : 0;
}

const char *format_of(const candidate &c)
{
    return brick_format{c.format, block_side, 1}.name();
}

std::string read_json(const read_error &e, double density_max)
{
    json_object o(4);

    o.add("rmse", e.rmse);
    o.add("mean", e.mean);
    o.add("max", e.worst);
    o.add("rmse_over_max", e.rmse / density_max);
    o.add("mean_over_max", e.mean / density_max);
    o.add("max_over_max", e.worst / density_max);
    return o.close();
}

// Sizes and errors of candidates that were given up are not known.
std::string candidate_json(const candidate &c, double density_max)
{
    return text("{\"lod\": %d, \"format\": \"%s\", \"fits\": %s, "
                "\"bytes\": %s, \"bytes_at_least\": %llu, "
                "\"rmse_over_max\": %s}",
                c.lod, format_of(c), c.fits ? "true" : "false",
                c.complete ? std::to_string(c.bytes).c_str() : "null",
                (unsigned long long)c.bytes,
                c.complete ? text("%.9g", c.rmse / density_max).c_str()
                           : "null");
}

std::string budget_json(const budget_report &b)
{
    json_object o(2), error(3);
    std::string list;

    error.raw("nearest", read_json(b.error.nearest, b.input_max));
    error.raw("trilinear", read_json(b.error.trilinear, b.input_max));
    o.add("limit", b.bytes);
    o.add("input_density_max", b.input_max);
    o.raw("error", error.close());
    for (const candidate &c : b.tried)
        list += (list.empty() ? "\n      " : ",\n      ") +
                candidate_json(c, b.input_max);
    o.raw("candidates", "[" + list + "\n    ]");
    return o.close();
}

} // namespace

std::string to_json(const report &r)
{
    json_object o;

    o.add("input", r.input);
    o.add("output", r.output);
    o.raw("grid", grid_json(r));
    o.raw("volume", volume_json(r));
    o.raw("asset", asset_json(r));
    o.raw("quantisation_error", error_json(r));
    if (r.pool->glows)
        o.raw("emission", emission_json(r));
    o.raw("seconds", seconds_json(r.seconds));
    if (r.budget.bytes > 0)
        o.raw("budget", budget_json(r.budget));
    return o.close() + "\n";
}

std::string budget_notice(const budget_report &b, const candidate &chosen)
{
    const double percent = 100 / b.input_max;

    return text("a budget of %llu bytes: %s at level of detail %d takes "
                "%llu; error against the input, of its maximum: rmse %.3g %%, "
                "mean %.2g %% nearest, %.3g %%, %.2g %% trilinear",
                (unsigned long long)b.bytes, format_of(chosen), chosen.lod,
                (unsigned long long)chosen.bytes,
                percent * b.error.nearest.rmse, percent * b.error.nearest.mean,
                percent * b.error.trilinear.rmse,
                percent * b.error.trilinear.mean);
}

std::vector<std::string> facts(const report &r)
{
    const ijk lo = r.m->tight.lo, hi = r.m->tight.hi;
    const brick_pool &p = *r.pool;
    const read_error &n = r.budget.error.nearest, &t = r.budget.error.trilinear;
    std::vector<std::string> list = {
        "grid      \"" + r.src->name + "\" of " +
            std::filesystem::path(r.input).filename().string(),
        text("voxels    %d x %d x %d, %llu with density, at level of detail %d",
             hi.x - lo.x + 1, hi.y - lo.y + 1, hi.z - lo.z + 1,
             (unsigned long long)r.m->voxels, r.lod),
        text("density   max %.6g, mean %.6g", double(p.format.density_max),
             r.m->mean),
        text("bricks    %llu of %d^3, in %d x %d x %d cells",
             (unsigned long long)p.bricks, p.format.side, r.l->cells.x,
             r.l->cells.y, r.l->cells.z),
        text("format    %s, %llu bytes", p.format.name(),
             (unsigned long long)r.size.total),
        text("error     rmse %.3g, max %.3g (%.3g %% and %.3g %% of the mean)",
             p.error.rmse, p.error.worst, percent(p.error.rmse, r.m->mean),
             percent(p.error.worst, r.m->mean))};

    if (p.glows)
        list.push_back("emission  " + emission_text(r));
    for (const std::string &part : light_texts(r))
        list.push_back("light     " + part);
    if (r.budget.bytes > 0)
        list.push_back(text("          of the input: rmse %.3g nearest, %.3g "
                            "trilinear (%.3g %% "
                            "and %.3g %% of its max)",
                            n.rmse, t.rmse, 100 * n.rmse / r.budget.input_max,
                            100 * t.rmse / r.budget.input_max));
    return list;
}

std::string summary(const report &r)
{
    const ijk lo = r.m->tight.lo, hi = r.m->tight.hi;
    const brick_pool &p = *r.pool;
    std::string s;

    s += text("%s: grid \"%s\", %d x %d x %d voxels, %llu with density, "
              "max %.6g, mean %.6g\n",
              r.input.c_str(), r.src->name.c_str(), hi.x - lo.x + 1,
              hi.y - lo.y + 1, hi.z - lo.z + 1, (unsigned long long)r.m->voxels,
              double(p.format.density_max), r.m->mean);
    s += text("format %s%s: %s\n", p.format.name(),
              p.format.side == apron_side ? " with apron" : "", r.why.c_str());
    s += text("error: rmse %.3g, max %.3g (%.3g %% and %.3g %% of the "
              "mean)\n",
              p.error.rmse, p.error.worst, percent(p.error.rmse, r.m->mean),
              percent(p.error.worst, r.m->mean));
    s += text("%d x %d x %d cells, %llu occupied, %llu bricks (%llu "
              "shared)\n",
              r.l->cells.x, r.l->cells.y, r.l->cells.z,
              (unsigned long long)p.occupied, (unsigned long long)p.bricks,
              (unsigned long long)shared(p));
    if (p.glows)
        s += "emission: " + emission_text(r) + "\n";
    if (r.light.any())
        s += light_line(r);
    s += text("%s: %llu bytes, %.2f s (read %.2f, voxels %.2f, quantise "
              "%.2f, write %.2f)\n",
              r.output.c_str(), (unsigned long long)r.size.total,
              r.seconds.total(), r.seconds.read, r.seconds.voxels,
              r.seconds.quantise, r.seconds.write);
    if (!r.symbol.empty())
        s += text("symbols %s and %s_size\n", r.symbol.c_str(),
                  r.symbol.c_str());
    return s;
}

} // namespace bake
