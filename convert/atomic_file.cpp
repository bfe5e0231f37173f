// SPDX-License-Identifier: MIT
#include "atomic_file.hpp"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sys/stat.h>
#include <unistd.h>

#include "bake.hpp"

namespace bake
{

namespace
{

// What a signal handler may touch: plain arrays, and unlink(). One slot per
// output: asset, its source text, report and dump.
constexpr int slots = 4;
constexpr size_t path_bytes = 4096;
char pending[slots][path_bytes];

extern "C" void remove_pending(int signal_number)
{
    for (int i = 0; i < slots; i++)
        if (pending[i][0] != '\0')
            unlink(pending[i]);
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);
}

int remember(const std::string &path)
{
    for (int i = 0; i < slots; i++)
        if (pending[i][0] == '\0' && path.size() < path_bytes) {
            std::memcpy(pending[i], path.c_str(), path.size() + 1);
            for (int s : {SIGINT, SIGTERM, SIGHUP})
                std::signal(s, remove_pending);
            return i;
        }
    return -1;
}

// mkstemp() gives 0600; a new file should get what the umask allows.
mode_t default_mode()
{
    const mode_t mask = umask(0);

    umask(mask);
    return 0666 & ~mask;
}

} // namespace

void memory_output::write(const void *data, size_t bytes)
{
    const auto *p = static_cast<const uint8_t *>(data);

    bytes_.insert(bytes_.end(), p, p + bytes);
}

void memory_output::write_at(long offset, const void *data, size_t bytes)
{
    std::memcpy(&bytes_[size_t(offset)], data, bytes);
}

atomic_file::atomic_file(const std::string &path) : path_(path)
{
    std::error_code none;
    const auto kind = std::filesystem::status(path, none).type();

    // A rename would put a file in the place of a directory or a device.
    if (kind != std::filesystem::file_type::not_found &&
        kind != std::filesystem::file_type::regular)
        throw failure(path + ": is not a file that could be replaced");
    // Replace what a link points to, not the link.
    if (std::filesystem::is_symlink(path, none))
        path_ = std::filesystem::weakly_canonical(path, none).string();
    temporary_ = path_ + ".XXXXXX";
    const int fd = mkstemp(&temporary_[0]);
    if (fd < 0)
        throw failure(path + ": cannot be written: " + std::strerror(errno));
    slot_ = remember(temporary_);
    fchmod(fd, default_mode());
    file_ = fdopen(fd, "wb");
    if (file_ == nullptr)
        fail("cannot be written");
}

atomic_file::~atomic_file()
{
    if (file_ != nullptr)
        std::fclose(file_);
    if (!temporary_.empty())
        unlink(temporary_.c_str());
    if (!old_.empty())
        unlink(old_.c_str());
    if (slot_ >= 0)
        pending[slot_][0] = '\0';
}

void atomic_file::fail(const char *what)
{
    throw failure(path_ + ": " + what + ": " + std::strerror(errno));
}

void atomic_file::write(const void *data, size_t bytes)
{
    if (bytes > 0 && std::fwrite(data, 1, bytes, file_) != bytes)
        fail("cannot be written");
}

void atomic_file::write_at(long offset, const void *data, size_t bytes)
{
    if (std::fseek(file_, offset, SEEK_SET) != 0)
        fail("cannot be written");
    write(data, bytes);
}

void atomic_file::finish()
{
    std::FILE *file = file_;

    file_ = nullptr;
    if (std::fclose(file) != 0)
        fail("cannot be written");
}

// The old file keeps a second name until all is done. Where links are not to
// be had, a rename that fails cannot be taken back, but loses nothing.
void atomic_file::commit()
{
    const std::string old = temporary_ + "~";

    if (link(path_.c_str(), old.c_str()) == 0)
        old_ = old;
    else
        fresh_ = errno == ENOENT;
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0)
        fail("cannot be renamed into place");
    temporary_.clear();
}

void atomic_file::undo()
{
    if (fresh_)
        unlink(path_.c_str());
    else if (!old_.empty() && std::rename(old_.c_str(), path_.c_str()) == 0)
        old_.clear();
}

void commit_all(const std::vector<atomic_file *> &files)
{
    size_t done = 0;

    try {
        for (; done < files.size(); done++)
            files[done]->commit();
    } catch (...) {
        while (done-- > 0)
            files[done]->undo();
        throw;
    }
}

} // namespace bake
