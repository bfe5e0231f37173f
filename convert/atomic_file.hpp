// SPDX-License-Identifier: MIT
//
// A file that appears whole or not at all: written beside its target under a
// temporary name, renamed by commit(), removed otherwise, also when a signal
// ends the program.
#ifndef BRUME_CONVERT_ATOMIC_FILE_HPP
#define BRUME_CONVERT_ATOMIC_FILE_HPP

#include <cstddef>
#include <cstdio>
#include <string>

namespace bake
{

class atomic_file
{
  public:
    // Throws `failure` when the file cannot be made there.
    explicit atomic_file(const std::string &path);
    ~atomic_file();
    atomic_file(const atomic_file &) = delete;
    atomic_file &operator=(const atomic_file &) = delete;

    void write(const void *data, size_t bytes);
    void write_at(long offset, const void *data, size_t bytes);
    // All is written: flush it and check that it arrived.
    void finish();
    // Give the finished file its name.
    void commit();

  private:
    [[noreturn]] void fail(const char *what);

    std::string path_, temporary_;
    std::FILE *file_ = nullptr;
    int slot_ = -1; // in the list of what a signal must remove
};

} // namespace bake

#endif
