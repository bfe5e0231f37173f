// SPDX-License-Identifier: MIT
//
// A file that appears whole or not at all: written beside its target under a
// temporary name, renamed by commit(), removed otherwise, also when a signal
// ends the program.
#ifndef BRUME_CONVERT_ATOMIC_FILE_HPP
#define BRUME_CONVERT_ATOMIC_FILE_HPP

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace bake
{

// What a writer of bytes needs: to append, and to go back to what must be
// known last.
class output
{
  public:
    virtual ~output() = default;
    virtual void write(const void *data, size_t bytes) = 0;
    virtual void write_at(long offset, const void *data, size_t bytes) = 0;
};

class memory_output : public output
{
  public:
    void write(const void *data, size_t bytes) override;
    void write_at(long offset, const void *data, size_t bytes) override;
    const std::vector<uint8_t> &bytes() const
    {
        return bytes_;
    }

  private:
    std::vector<uint8_t> bytes_;
};

class atomic_file : public output
{
  public:
    // Throws `failure` when the file cannot be made there.
    explicit atomic_file(const std::string &path);
    ~atomic_file() override;
    atomic_file(const atomic_file &) = delete;
    atomic_file &operator=(const atomic_file &) = delete;

    void write(const void *data, size_t bytes) override;
    void write_at(long offset, const void *data, size_t bytes) override;
    // All is written: flush it and check that it arrived.
    void finish();
    // Give the finished file its name.
    void commit();
    // Take commit() back: what was there before is there again.
    void undo();

  private:
    [[noreturn]] void fail(const char *what);

    std::string path_, temporary_;
    std::string old_;    // a second name of what commit() replaced
    bool fresh_ = false; // there was none to replace
    std::FILE *file_ = nullptr;
    int slot_ = -1; // in the list of what a signal must remove
};

// All get their names, or none does.
void commit_all(const std::vector<atomic_file *> &files);

} // namespace bake

#endif
