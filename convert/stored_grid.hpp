// SPDX-License-Identifier: MIT
//
// A float grid of a .vdb file without its voxels: the tree and the masks are
// in memory, the values of the leaves stay in the file until somebody wants
// them. OpenVDB's own delayed loading does the same leaf by leaf, each with a
// stream and a look at the file's date; here a stream reads many leaves in a
// row, and several streams read at once.
#ifndef BRUME_CONVERT_STORED_GRID_HPP
#define BRUME_CONVERT_STORED_GRID_HPP

#include <openvdb/openvdb.h>

#include <cstddef>
#include <memory>
#include <streambuf>
#include <string>

namespace bake
{

// A file in memory. Only the pages looked at are read.
class mapped_file
{
  public:
    // Throws `failure` when the file cannot be mapped.
    explicit mapped_file(const std::string &path);
    ~mapped_file();
    mapped_file(const mapped_file &) = delete;
    mapped_file &operator=(const mapped_file &) = delete;

    const char *data() const
    {
        return data_;
    }
    size_t size() const
    {
        return size_;
    }

  private:
    const char *data_ = nullptr;
    size_t size_ = 0;
};

// The bytes of a file as a stream that throws std::ios_base::failure at the
// end.
class mapped_stream : public std::istream
{
  public:
    explicit mapped_stream(const mapped_file &file);

  private:
    class buffer : public std::streambuf
    {
      public:
        explicit buffer(const mapped_file &file);

      private:
        pos_type seekoff(off_type offset, std::ios_base::seekdir from,
                         std::ios_base::openmode) override;
        pos_type seekpos(pos_type at, std::ios_base::openmode) override;
    };

    buffer buffer_;
};

class stored_grid : public openvdb::FloatGrid
{
  public:
    using Ptr = std::shared_ptr<stored_grid>;
    using leaf = openvdb::FloatTree::LeafNodeType;

    explicit stored_grid(std::shared_ptr<const mapped_file> file)
        : file_(std::move(file))
    {
    }

    // What OpenVDB calls when it has read all but the voxels: remembers where
    // they are.
    void readBuffers(std::istream &in) override;

    // Reads leaves in the order of the tree, from the first one or from where
    // another reader is.
    class reader
    {
      public:
        explicit reader(const stored_grid &grid);
        reader(const stored_grid &grid, std::streamoff at);

        // The next leaf's LeafNode::SIZE values, z fastest.
        void read(const leaf &next, float *values);
        void skip(const leaf &next)
        {
            read(next, nullptr);
        }
        std::streamoff at()
        {
            return in_.tellg();
        }

      private:
        openvdb::io::StreamMetadata::Ptr meta_; // of in_, which refers to it
        mapped_stream in_;
        bool half_;
    };

  private:
    std::shared_ptr<const mapped_file> file_;
    std::streamoff first_ = 0;
    openvdb::io::StreamMetadata::Ptr meta_; // how the values are encoded
};

} // namespace bake

#endif
