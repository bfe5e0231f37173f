// SPDX-License-Identifier: MIT
//
// brume-cloud: models a cloud and writes it as an OpenVDB fog volume.
#include "cloud_grid.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <unistd.h>

namespace
{

enum { exit_ok = 0, exit_failed = 1, exit_usage = 2 };

const int min_side = 8, max_side = 4096, max_threads = 1024;

struct options {
    std::string output;
    std::string size = "256";
    const cloud::shape_type *type = nullptr;
    cloud::box_size box = {0, 0, 0};
    uint32_t seed = 1;
    double voxel_size = 1;
    int threads = 0;
};

__attribute__((format(printf, 2, 3), noreturn)) void
fail(int status, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fprintf(stderr, "brume-cloud: ");
    vfprintf(stderr, format, args);
    fprintf(stderr, "\n");
    va_end(args);
    exit(status);
}

/// Options ///

void print_usage()
{
    printf("usage: brume-cloud -o FILE.vdb [options]\n"
           "\n"
           "Models a cloud and writes it as an OpenVDB fog volume, grid "
           "\"density\",\n"
           "values 0 to 1, Y up. The same options give the same voxels on "
           "every machine\n"
           "and for every number of threads; the file also holds a random "
           "UUID.\n"
           "\n"
           "  -o, --output FILE   the file to write\n"
           "  --size N            voxels along the longest axis; the others "
           "fit the type\n"
           "  --size NXxNYxNZ     the exact box, %d to %d voxels per axis "
           "(default: 256)\n"
           "  --seed S            0 to 4294967295: another cloud of the type "
           "(default: 1)\n"
           "  --type TYPE         what to model, see below\n"
           "  --voxel-size V      world units per voxel (default: 1)\n"
           "  --threads N         1 to %d (default: one per processor)\n"
           "  --help              print this\n"
           "\n"
           "types:\n",
           min_side, max_side, max_threads);
    for (const cloud::shape_type &t : cloud::shape_types())
        printf("  %-8s  %s\n", t.name, t.help);
}

// A whole decimal number in [low, high]; fails with the option's name.
long long parse_integer(const char *option, const char *text, long long low,
                        long long high)
{
    char *end;
    errno = 0;
    const long long n = strtoll(text, &end, 10);
    if (end == text || *end || errno || n < low || n > high)
        fail(exit_usage,
             "%s must be a whole number from %lld to %lld, not "
             "'%s'",
             option, low, high, text);
    return n;
}

double parse_voxel_size(const char *text)
{
    char *end;
    const double v = strtod(text, &end);
    if (end == text || *end || !(v >= 1e-6 && v <= 1e6))
        fail(exit_usage,
             "--voxel-size must be a number from 1e-6 to 1e6, not "
             "'%s'",
             text);
    return v;
}

const cloud::shape_type *parse_type(const char *name)
{
    std::string known;
    for (const cloud::shape_type &t : cloud::shape_types()) {
        if (!strcmp(t.name, name))
            return &t;
        known += std::string(known.empty() ? "" : ", ") + t.name;
    }
    fail(exit_usage, "unknown type '%s'; the types are %s", name,
         known.c_str());
}

// One number for the longest axis, or three with 'x' between them.
cloud::box_size parse_size(const std::string &text,
                           const cloud::shape_type &type)
{
    int side[3];
    size_t at = 0, parts = 0;
    while (parts < 3 && at != std::string::npos) {
        const size_t end = text.find('x', at);
        const std::string part =
            text.substr(at, end == std::string::npos ? end : end - at);
        side[parts++] = int(parse_integer("each side of --size", part.c_str(),
                                          min_side, max_side));
        at = end == std::string::npos ? end : end + 1;
    }
    if (at != std::string::npos || parts == 2)
        fail(exit_usage, "--size must be N or NXxNYxNZ, not '%s'",
             text.c_str());
    if (parts == 1) {
        const int longest = side[0];
        for (int a = 0; a < 3; a++)
            side[a] = std::max(
                min_side, int(float(longest) * type.proportions[a] + 0.5f));
    }
    return {side[0], side[1], side[2]};
}

// A guard against plain mistakes, so it errs on the side of trying.
void check_memory(const options &o)
{
    const double leaf_bytes = 4.5; // per voxel: float, masks, nodes
    const double voxels = double(o.box.x) * o.box.y * o.box.z;
    const double need = voxels * double(o.type->stored_fraction) * leaf_bytes;
    const double have =
        double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
    if (need > have)
        fail(exit_usage,
             "%s of %dx%dx%d voxels would need about %.0f GiB of "
             "memory, of %.0f",
             o.type->name, o.box.x, o.box.y, o.box.z, need / (1 << 30),
             have / (1 << 30));
}

options parse_options(int argc, char **argv)
{
    options o;
    o.type = &cloud::shape_types()[0];
    for (int i = 1; i < argc; i++) {
        const std::string name = argv[i];
        if (name == "--help" || name == "-h") {
            print_usage();
            exit(exit_ok);
        }
        static const char *const known[] = {
            "-o",     "--output",     "--size",   "--seed",
            "--type", "--voxel-size", "--threads"};
        bool found = false;
        for (const char *k : known)
            found |= name == k;
        if (!found)
            fail(exit_usage, "unknown option '%s' (see --help)", argv[i]);
        if (i + 1 == argc)
            fail(exit_usage, "%s needs a value", argv[i]);
        const char *value = argv[++i];
        if (name == "-o" || name == "--output")
            o.output = value;
        else if (name == "--size")
            o.size = value;
        else if (name == "--seed")
            o.seed = uint32_t(parse_integer("--seed", value, 0, UINT32_MAX));
        else if (name == "--type")
            o.type = parse_type(value);
        else if (name == "--voxel-size")
            o.voxel_size = parse_voxel_size(value);
        else
            o.threads = int(parse_integer("--threads", value, 1, max_threads));
    }
    if (o.output.empty())
        fail(exit_usage, "no output file; give -o FILE.vdb (see --help)");
    o.box = parse_size(o.size, *o.type);
    check_memory(o);
    if (!o.threads)
        o.threads = std::max(1, int(std::thread::hardware_concurrency()));
    return o;
}

/// Output file ///

// The file under construction, for the signal handler. Empty: none.
char pending_path[4096];

void remove_pending()
{
    if (pending_path[0])
        unlink(pending_path);
    pending_path[0] = 0;
}

extern "C" void on_signal(int number)
{
    if (pending_path[0])
        unlink(pending_path);
    signal(number, SIG_DFL);
    raise(number);
}

// What rename() may replace: a regular file or nothing, through links. Not a
// directory, and not /dev/null.
std::string resolve_target(const std::string &path)
{
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::file_type kind = fs::status(path, error).type();
    if (kind != fs::file_type::regular && kind != fs::file_type::not_found &&
        kind != fs::file_type::none)
        fail(exit_failed, "cannot write '%s': not a regular file",
             path.c_str());
    if (!fs::is_symlink(path, error))
        return path;
    const std::string target = fs::weakly_canonical(path, error).string();
    return error ? path : target;
}

// Made before the work, next to the target, so that a bad directory shows
// at once and rename() stays within one file system.
void open_pending(const std::string &target)
{
    const int n = snprintf(pending_path, sizeof pending_path, "%s.%ld.tmp",
                           target.c_str(), long(getpid()));
    if (n < 0 || size_t(n) >= sizeof pending_path) {
        pending_path[0] = 0;
        fail(exit_failed, "the output path is too long");
    }
    const int file = open(pending_path, O_WRONLY | O_CREAT | O_EXCL, 0666);
    if (file < 0) {
        const char *why = strerror(errno);
        pending_path[0] = 0;
        fail(exit_failed, "cannot write '%s': %s", target.c_str(), why);
    }
    close(file);
    atexit(remove_pending);
    for (int number : {SIGINT, SIGTERM, SIGHUP})
        signal(number, on_signal);
}

void commit_pending(const std::string &target)
{
    if (rename(pending_path, target.c_str()))
        fail(exit_failed, "cannot write '%s': %s", target.c_str(),
             strerror(errno));
    pending_path[0] = 0;
}

/// Work ///

void show_progress(double done)
{
    static int shown = -1;
    const int width = 40, percent = int(done * 100);
    if (percent == shown || !isatty(STDERR_FILENO))
        return;
    shown = percent;
    const int bars = percent * width / 100;
    fprintf(stderr, "\r[%.*s%*s] %3d%%%s", bars,
            "########################################", width - bars, "",
            percent, percent == 100 ? "\n" : "");
}

void describe(openvdb::FloatGrid &grid, const options &o)
{
    char text[160];
    snprintf(text, sizeof text, "--type %s --size %dx%dx%d --seed %u",
             o.type->name, o.box.x, o.box.y, o.box.z, unsigned(o.seed));
    grid.setTransform(
        openvdb::math::Transform::createLinearTransform(o.voxel_size));
    grid.setCreator("brume-cloud");
    grid.insertMeta("brume_cloud", openvdb::StringMetadata(text));
}

void run(const options &o)
{
    openvdb::initialize();
    const std::string target = resolve_target(o.output);
    open_pending(target);
    const auto form = o.type->make(o.box, o.seed);
    const auto grid = cloud::make_grid(*form, o.box, o.threads, show_progress);
    if (grid->empty())
        throw std::runtime_error("the box is too small for this cloud");
    describe(*grid, o);
    cloud::write_grid(grid, pending_path);
    commit_pending(target);
}

} // namespace

int main(int argc, char **argv)
{
    const options o = parse_options(argc, argv);
    try {
        run(o);
    } catch (const std::bad_alloc &) {
        fail(exit_failed, "out of memory");
    } catch (const std::exception &e) {
        fail(exit_failed, "cannot write '%s': %s", o.output.c_str(), e.what());
    }
    return exit_ok;
}
