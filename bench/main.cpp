// SPDX-License-Identifier: MIT
//
// brume-bench: contenders, one a line of standard input, in turns A B C A B C,
// as figures on standard output, one a line. See contender.hpp.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <unistd.h>

#include "contender.hpp"

namespace bench
{

struct row {
    std::unique_ptr<contender> who;
    error_figures error;
    std::vector<double> ms, ratio; // of every run; ratio: first over this
};

static void progress(const std::string &what, size_t done, size_t all)
{
    if (!isatty(STDERR_FILENO))
        return;
    if (done == all)
        std::fputs("\r\033[K", stderr);
    else
        std::fprintf(stderr, "\r\033[K%3zu %%  %s", 100 * done / all,
                     what.c_str());
}

static double median(std::vector<double> v)
{
    std::sort(v.begin(), v.end());
    const size_t n = v.size();
    return n % 2 ? v[n / 2] : (v[n / 2 - 1] + v[n / 2]) / 2;
}

static std::vector<row> read_rows(library &files)
{
    std::vector<row> rows;
    std::string line;
    while (std::getline(std::cin, line)) {
        if (line.find_first_not_of(" \t") == std::string::npos)
            continue;
        progress("reading", 0, 1);
        rows.emplace_back();
        rows.back().who = std::make_unique<contender>(line, files);
    }
    if (rows.empty())
        throw std::runtime_error("no contender on standard input");
    return rows;
}

// Everybody once, which also warms caches; how far from the reference; and
// whether all kernels of ours draw one picture.
static void measure_errors(std::vector<row> &rows)
{
    std::map<std::string, picture> exact, ours;
    size_t done = 0;
    for (row &r : rows) {
        progress("reference: " + r.who->name(), done++, rows.size());
        r.who->render();
        if (r.who->ours() && r.who->draws()) {
            picture &first = ours[r.who->key()];
            if (first.empty())
                first = r.who->drawn();
            else if (first != r.who->drawn())
                throw std::runtime_error(r.who->name() +
                                         " draws other pixels than another "
                                         "kernel");
        }
        if (!r.who->has_exact())
            continue;
        picture &reference = exact[r.who->key()];
        if (reference.empty())
            reference = r.who->exact();
        r.error = compare(reference, r.who->drawn());
    }
}

// One thread is timed by its own clock, several by the wall's.
static void measure_times(std::vector<row> &rows, int runs)
{
    bool wall = false;
    for (const row &r : rows)
        wall = wall || r.who->threads() > 1;
    size_t done = 0, all = rows.size() * static_cast<size_t>(runs);
    for (int run = 0; run < runs; run++)
        for (row &r : rows) {
            progress(r.who->name(), done++, all);
            const double from = clock_ms(wall);
            r.who->render();
            r.ms.push_back(clock_ms(wall) - from);
            r.ratio.push_back(rows[0].ms.back() / r.ms.back());
        }
    progress("", all, all);
}

static void print(const std::vector<row> &rows)
{
    std::puts("name,ratio,ratio_least,ratio_most,ms,ms_least,ms_most,rmse,mean,"
              "bytes,lookups,view,light,lit,in_bricks,rays,cell_bytes,covered,"
              "prepare_ms");
    for (const row &r : rows) {
        const auto ends = std::minmax_element(r.ms.begin(), r.ms.end());
        const auto span = std::minmax_element(r.ratio.begin(), r.ratio.end());
        const lookup_count n = r.who->count();
        std::printf("%s,%.4g,%.4g,%.4g,%.3f,%.3f,%.3f,", r.who->name().c_str(),
                    median(r.ratio), *span.first, *span.second, median(r.ms),
                    *ends.first, *ends.second);
        if (r.error.rmse < 0)
            std::printf(",,%zu,", r.who->bytes());
        else
            std::printf("%.3f,%.3f,%zu,", r.error.rmse, r.error.mean,
                        r.who->bytes());
        if (r.who->ours())
            std::printf("%llu,%llu,%llu,%llu,%llu,%llu,%zu,%.4f,%.1f\n",
                        static_cast<unsigned long long>(n.view + n.light),
                        static_cast<unsigned long long>(n.view),
                        static_cast<unsigned long long>(n.light),
                        static_cast<unsigned long long>(n.lit),
                        static_cast<unsigned long long>(n.in_bricks),
                        static_cast<unsigned long long>(n.rays),
                        r.who->cell_bytes(), r.who->covered(),
                        r.who->prepare_ms());
        else
            std::puts(",,,,,,,,");
    }
}

} // namespace bench

static void print_kernels()
{
    enum wide_kernel kernel;
    bool copy;
    for (const char *name :
         {"scalar", "generic", "avx2", "avx2-copy", "avx512", "avx512-copy"})
        if (ours_kernel(name, &kernel, &copy))
            std::puts(name);
}

static const char usage[] =
    "usage: brume-bench [RUNS] <CONTENDERS\n"
    "       brume-bench --kernels\n\n"
    "Renders every contender, one a line, RUNS times (7) in turns, and prints "
    "their\nfigures; or the kernels of ours that this machine has. "
    "bench/contender.hpp says\nwhat a line holds, bench/run.sh has them.";

int main(int argc, char **argv)
{
    const std::string first = argc > 1 ? argv[1] : "7";
    if (first == "--kernels") {
        print_kernels();
        return 0;
    }
    const int runs = std::atoi(first.c_str());
    if (argc > 2 || runs < 1) {
        std::puts(usage);
        return first == "--help" ? 0 : 2;
    }
    try {
        bench::library files;
        std::vector<bench::row> rows = bench::read_rows(files);
        bench::measure_errors(rows);
        bench::measure_times(rows, runs);
        bench::print(rows);
    } catch (const std::exception &e) {
        std::fprintf(stderr, "brume-bench: %s\n", e.what());
        return 1;
    }
    return 0;
}
