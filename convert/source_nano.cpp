// SPDX-License-Identifier: MIT
//
// NanoVDB files, by way of the library's own conversion to OpenVDB.
#include "source.hpp"

#include <filesystem>
#include <fstream>
#include <nanovdb/util/GridValidator.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/NanoToOpenVDB.h>

namespace bake
{

namespace
{

// No codec of the format expands by more (deflate: 1032).
constexpr uint64_t most_expansion = 1100;

std::string type_name(nanovdb::GridType type)
{
    return type < nanovdb::GridType::End ? nanovdb::toStr(type) : "unknown";
}

std::string class_name(nanovdb::GridClass c)
{
    return c < nanovdb::GridClass::End ? nanovdb::toStr(c) : "unknown";
}

// Each segment of the file starts with its version; an old one is refused
// before its fields are taken for what they are not.
void check_version(const std::string &path)
{
    nanovdb::io::Header head;
    std::ifstream in(path, std::ios::binary);

    if (!in.read(reinterpret_cast<char *>(&head), sizeof head))
        throw failure("is truncated in its head");
    if (head.version.getMajor() != NANOVDB_MAJOR_VERSION_NUMBER)
        throw failure(text("is of NanoVDB version %s; this program reads "
                           "version %d",
                           head.version.c_str(), NANOVDB_MAJOR_VERSION_NUMBER));
}

// Nodes refer to each other by offsets, which the conversion follows blindly.
template <class build> bool check_nodes(const nanovdb::GridHandle<> &handle)
{
    const auto *grid = handle.grid<build>();

    if (grid == nullptr)
        return false;
    if (grid->gridSize() > handle.size())
        throw failure("is corrupt: its grid is longer than the file says");
    const auto wrong = nanovdb::GridValidator<build>::check(*grid, true);
    if (!wrong.empty())
        throw failure("is corrupt: " + wrong);
    return true;
}

void check_grid(const nanovdb::GridHandle<> &handle)
{
    using namespace nanovdb;

    if (check_nodes<float>(handle) || check_nodes<double>(handle) ||
        check_nodes<int32_t>(handle) || check_nodes<int64_t>(handle) ||
        check_nodes<bool>(handle) || check_nodes<ValueMask>(handle) ||
        check_nodes<Fp4>(handle) || check_nodes<Fp8>(handle) ||
        check_nodes<Fp16>(handle) || check_nodes<FpN>(handle))
        return;
    throw failure("holds values of type " + type_name(handle.gridType()) +
                  ": not one density per voxel that can be read");
}

} // namespace

openvdb::GridBase::Ptr read_nano(const std::string &path,
                                 const std::string &choice)
{
    const uint64_t bytes = std::filesystem::file_size(path);
    std::vector<grid_entry> entries;

    check_version(path);
    const auto list = nanovdb::io::readGridMetaData(path);
    for (const auto &m : list)
        entries.push_back({m.gridName, type_name(m.gridType),
                           class_name(m.gridClass), m.voxelCount});
    const size_t n = choose_grid(entries, choice);
    if (list[n].gridSize / most_expansion > bytes ||
        list[n].gridSize < sizeof(nanovdb::GridData))
        throw failure(text("is corrupt: a grid of %llu bytes in a file of "
                           "%llu",
                           (unsigned long long)list[n].gridSize,
                           (unsigned long long)bytes));
    const auto handle = nanovdb::io::readGrid(path, n);
    check_grid(handle);
    return nanovdb::nanoToOpenVDB(handle);
}

} // namespace bake
