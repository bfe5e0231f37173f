// SPDX-License-Identifier: MIT
#include "progress.hpp"

#include <cstdio>
#include <unistd.h>

namespace bake
{

namespace
{

constexpr int bar_width = 40;
constexpr int64_t redraw_ms = 100;

} // namespace

progress::progress()
    : terminal_(isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now())
{
}

void progress::stage(const char *name, uint64_t total)
{
    name_ = name;
    total_ = total;
    done_ = 0;
    if (terminal_)
        draw(0);
}

void progress::advance(uint64_t steps)
{
    using namespace std::chrono;
    const uint64_t done = done_ += steps;

    if (!terminal_)
        return;
    const int64_t now =
        duration_cast<milliseconds>(steady_clock::now() - start_).count();
    int64_t due = next_ms_;
    // The thread that wins the exchange draws; the others go on working.
    if (now >= due && next_ms_.compare_exchange_strong(due, now + redraw_ms))
        draw(done);
}

void progress::draw(uint64_t done)
{
    char bar[bar_width + 1];
    const uint64_t total = total_ > 0 ? total_ : 1;
    const int full = int(bar_width * (done < total ? done : total) / total);

    for (int i = 0; i < bar_width; i++)
        bar[i] = i < full ? '#' : '.';
    bar[bar_width] = '\0';
    std::fprintf(stderr, "\r%-10s [%s] %3d%%", name_, bar,
                 100 * full / bar_width);
    shown_ = true;
}

void progress::clear()
{
    if (shown_.exchange(false))
        std::fputs("\r\033[K", stderr);
}

} // namespace bake
