// SPDX-License-Identifier: MIT
//
// A contender: who draws what, from a line of text
//
//     name=NAME render=WHO vdb=FILE asset=FILE key=value...
//
// render   scalar, avx2, avx2-copy ...: a kernel of wide.h, on a copy of the
//          volume; a peer, see contender.cpp; or loads1, loads8, loads16: the
//          loads of our march alone
// vdb      what peers and the double reference read; without it no error
// asset    what our march reads
// part     draws one of so many strips of 16 rows (1)
// threads, tile=WxH, order=linear|morton|hilbert    of our march
//
// Other keys are the scene's, for all of them.
#ifndef BRUME_BENCH_CONTENDER_HPP
#define BRUME_BENCH_CONTENDER_HPP

#include <map>
#include <memory>
#include <string>
#include <vector>

extern "C" {
#include "ours.h"
}
#include "peers.hpp"

namespace bench
{

struct error_figures {
    double rmse = -1, mean = 0; // in 1/255; rmse < 0: not measured
};

using picture = std::vector<float>; // grey

// A volume once more, for the wide kernels.
struct copied {
    wide_copy copy;
    size_t bytes = 0; // of memory that it took
    double ms = 0;    // to make it
};

// Files that several contenders read are kept.
class library
{
  public:
    const grids &grid(const std::string &path);
    const volume_file &asset(const std::string &path);
    // A copy of it, with what the frame reads.
    const copied &copy(const std::string &path, const brume_frame &frame);

  private:
    std::map<std::string, grids> grids_;
    std::map<std::string, std::unique_ptr<volume_file>> assets_;
    std::map<std::string, copied> copies_;
};

class contender
{
  public:
    // Throws std::runtime_error: the line is wrong, a file cannot be read.
    contender(const std::string &line, library &files);

    const std::string &name() const
    {
        return name_;
    }
    int threads() const
    {
        return job_.threads;
    }
    void render();
    // What render drew, the pixels of `part` alone.
    picture drawn() const;
    // The same by the double march.
    picture exact() const;
    bool has_exact() const
    {
        return grids_ != nullptr;
    }
    // Scene and volume: contenders of one key draw one picture.
    const std::string &key() const
    {
        return key_;
    }

    size_t bytes() const; // of the volume, as this one reads it
    double prepare_ms() const
    {
        return copied_ ? copied_->ms : 0;
    }
    size_t cell_bytes() const; // of ours, of its grid of cells
    bool ours() const
    {
        return peer_ == nullptr;
    }
    bool draws() const
    {
        return lanes_ == 0;
    }
    lookup_count count() const; // of ours
    double covered() const;     // share of drawn pixels that are not empty

  private:
    using peer = void(const grids &, const view &, strips, float *);

    void set(const std::string &key, const std::string &value);
    strips rows() const
    {
        return {static_cast<int>(job_.part)};
    }
    void set_renderer(library &files);
    void set_ours(library &files);
    void set_places();
    void set_view();

    std::string name_, renderer_ = "scalar", vdb_, asset_, key_;
    std::vector<std::string> settings_;
    peer *peer_ = nullptr;
    const grids *grids_ = nullptr;
    const volume_file *file_ = nullptr;
    const copied *copied_ = nullptr;
    view view_{};
    std::unique_ptr<brume_frame> frame_ = std::make_unique<brume_frame>();
    ours_job job_{};
    std::vector<brume_radiance> radiance_;
    picture grey_;
    int lanes_ = 0; // of loads alone
    ours_places places_{};
    std::vector<uint32_t> place_;
};

// Of this thread's own clock, which stands still while somebody else has the
// processor, or of the wall's.
double clock_ms(bool wall);

error_figures compare(const picture &exact, const picture &drawn);

} // namespace bench

#endif
