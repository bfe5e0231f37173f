// SPDX-License-Identifier: MIT
//
// A progress bar on standard error, shown on a terminal only.
#ifndef BRUME_CONVERT_PROGRESS_HPP
#define BRUME_CONVERT_PROGRESS_HPP

#include <atomic>
#include <chrono>
#include <cstdint>

namespace bake
{

class progress
{
  public:
    progress();
    ~progress()
    {
        clear();
    }

    // Begin a stage of `total` steps.
    void stage(const char *name, uint64_t total);
    // `steps` more are done; any thread may say so.
    void advance(uint64_t steps);
    // Take the bar off the screen.
    void clear();

  private:
    void draw(uint64_t done);

    bool terminal_;
    std::atomic<bool> shown_{false};
    const char *name_ = "";
    uint64_t total_ = 0;
    std::atomic<uint64_t> done_{0};
    std::atomic<int64_t> next_ms_{0};
    std::chrono::steady_clock::time_point start_;
};

} // namespace bake

#endif
