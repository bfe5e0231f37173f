// SPDX-License-Identifier: MIT
#include "stored_grid.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <openvdb/io/Compression.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bake.hpp"

namespace bake
{

mapped_file::mapped_file(const std::string &path)
{
    const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat s = {};
    void *p = MAP_FAILED;

    if (fd >= 0 && fstat(fd, &s) == 0)
        p = mmap(nullptr, size_t(s.st_size), PROT_READ, MAP_SHARED, fd, 0);
    const int error = errno;
    if (fd >= 0)
        close(fd);
    if (p == MAP_FAILED)
        throw failure(std::strerror(error));
    data_ = static_cast<const char *>(p);
    size_ = size_t(s.st_size);
}

mapped_file::~mapped_file()
{
    munmap(const_cast<char *>(data_), size_);
}

mapped_stream::buffer::buffer(const mapped_file &file)
{
    char *p = const_cast<char *>(file.data()); // only ever read

    setg(p, p, p + file.size());
}

std::streambuf::pos_type
mapped_stream::buffer::seekoff(off_type offset, std::ios_base::seekdir from,
                               std::ios_base::openmode)
{
    const off_type size = egptr() - eback();
    const off_type base = from == std::ios_base::beg   ? 0
                          : from == std::ios_base::end ? size
                                                       : gptr() - eback();

    if (offset < -base || offset > size - base)
        return pos_type(off_type(-1));
    setg(eback(), eback() + base + offset, egptr());
    return pos_type(base + offset);
}

std::streambuf::pos_type
mapped_stream::buffer::seekpos(pos_type at, std::ios_base::openmode mode)
{
    return seekoff(off_type(at), std::ios_base::beg, mode);
}

mapped_stream::mapped_stream(const mapped_file &file)
    : std::istream(nullptr), buffer_(file)
{
    rdbuf(&buffer_);
    exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
}

void stored_grid::readBuffers(std::istream &in)
{
    first_ = in.tellg();
    meta_ = openvdb::io::getStreamMetadataPtr(in);
    // A second copy of the sizes of all leaves, which might be wrong.
    meta_->gridMetadata().removeMeta(META_FILE_DELAYED_LOAD);
}

stored_grid::reader::reader(const stored_grid &grid) : reader(grid, grid.first_)
{
}

// With metadata of its own: streams count references to theirs all the time,
// which slows down threads that share one.
stored_grid::reader::reader(const stored_grid &grid, std::streamoff at)
    : meta_(std::make_shared<openvdb::io::StreamMetadata>(*grid.meta_)),
      in_(*grid.file_), half_(grid.saveFloatAsHalf())
{
    openvdb::io::setStreamMetadataPtr(in_, meta_);
    in_.seekg(at);
}

void stored_grid::reader::read(const leaf &next, float *values)
{
    // The mask is stored again in front of the values.
    in_.seekg(leaf::NodeMaskType::memUsage(), std::ios_base::cur);
    openvdb::io::readCompressedValues(in_, values, leaf::SIZE, next.valueMask(),
                                      half_);
}

} // namespace bake
