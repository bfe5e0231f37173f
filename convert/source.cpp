// SPDX-License-Identifier: MIT
#include "source.hpp"

#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/Stream.h>
#include <openvdb/tools/LevelSetUtil.h>

#include "extract.hpp"
#include "stored_grid.hpp"

namespace bake
{

namespace
{

using openvdb::io::GridDescriptor;

enum class file_kind { vdb, nano };

file_kind find_kind(const std::string &path)
{
    char head[8] = {};
    std::error_code none;

    if (std::filesystem::is_directory(path, none))
        throw failure("is a directory");
    std::ifstream in(path, std::ios::binary);
    if (!in)
        throw failure(std::strerror(errno));
    in.read(head, sizeof head);
    if (in.gcount() == 0)
        throw failure("is empty");
    if (!std::memcmp(head, " BDV\0\0\0\0", 8))
        return file_kind::vdb;
    if (!std::memcmp(head, "NanoVDB", 7))
        return file_kind::nano;
    throw failure("is neither an OpenVDB nor a NanoVDB file");
}

// OpenVDB takes what a failed read leaves behind for sizes and counts: make
// the end of the file an exception instead.
void open_strictly(std::ifstream &in, const std::string &path)
{
    in.open(path, std::ios::binary);
    in.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
}

// The head of a .vdb file: the grids it lists, in the order of the file.
// OpenVDB itself does not notice when stored voxels are cut off.
class vdb_head : public openvdb::io::Archive
{
  public:
    explicit vdb_head(const std::string &path)
    {
        const auto bytes = std::filesystem::file_size(path);
        std::ifstream in;

        open_strictly(in, path);
        readHeader(in);
        has_offsets = inputHasGridOffsets();
        openvdb::io::setCurrentVersion(in);
        file_meta.readMeta(in);
        const int32_t count = readGridCount(in);
        for (int32_t i = 0; has_offsets && i < count; i++) {
            GridDescriptor d;
            d.read(in);
            if (d.getEndPos() < 0 || uint64_t(d.getEndPos()) > bytes)
                throw failure(
                    text("is truncated: it has %llu bytes and grid \"%s\" ends "
                         "at %lld",
                         (unsigned long long)bytes, d.gridName().c_str(),
                         (long long)d.getEndPos()));
            grids.push_back(d);
            d.seekToEnd(in);
        }
    }

    // Can read_stored() read this one? Nearly all are so.
    bool can_store(const GridDescriptor &d) const
    {
        return d.gridType() == openvdb::FloatGrid::gridType() &&
               !d.isInstance() &&
               fileVersion() >=
                   openvdb::OPENVDB_FILE_VERSION_NODE_MASK_COMPRESSION;
    }

    // A grid without its voxels. The stream is set up as io::File does it.
    stored_grid::Ptr read_stored(const std::string &path,
                                 const GridDescriptor &d)
    {
        const auto file = std::make_shared<const mapped_file>(path);
        auto grid = std::make_shared<stored_grid>(file);
        auto meta = std::make_shared<openvdb::io::StreamMetadata>();
        mapped_stream in(*file);

        meta->setSeekable(true);
        openvdb::io::setStreamMetadataPtr(in, meta, false);
        setFormatVersion(in);
        setLibraryVersion(in);
        setDataCompression(in);
        d.seekToGrid(in);
        grid->setSaveFloatAsHalf(d.saveFloatAsHalf());
        readGrid(grid, d, in);
        return grid;
    }

    bool has_offsets;
    openvdb::MetaMap file_meta;
    std::vector<GridDescriptor> grids;
};

// What metadata says of rights, in whichever of the usual fields.
std::string find_licence(const openvdb::MetaMap &meta)
{
    std::string all;

    for (auto i = meta.beginMeta(); i != meta.endMeta(); ++i) {
        std::string key = i->first;
        for (char &c : key)
            c = char(std::tolower(uint8_t(c)));
        const bool found = key.find("licen") != std::string::npos ||
                           key.find("copyright") != std::string::npos;
        if (found && i->second->typeName() == "string")
            all += (all.empty() ? "" : "\n") + i->second->str();
    }
    return all;
}

grid_entry describe(const openvdb::GridBase &grid, uint64_t voxels)
{
    return {grid.getName(), grid.type(),
            openvdb::GridBase::gridClassToString(grid.getGridClass()), voxels};
}

uint64_t stored_voxels(const openvdb::GridBase &grid)
{
    const auto m = grid.getMetadata<openvdb::Int64Metadata>(
        openvdb::GridBase::META_FILE_VOXEL_COUNT);

    return m ? uint64_t(m->value()) : 0;
}

void check_scalar(const grid_entry &g)
{
    if (!is_scalar(g.type))
        throw failure("grid \"" + g.name + "\" is of type " + g.type + " (" +
                      g.grid_class + "): not one density per voxel");
}

bool is_level_set(const grid_entry &g)
{
    return g.grid_class ==
           openvdb::GridBase::gridClassToString(openvdb::GRID_LEVEL_SET);
}

void check_class(const grid_entry &g, bool level_set_to_fog)
{
    if (is_level_set(g) && !level_set_to_fog)
        throw failure("grid \"" + g.name +
                      "\" is a level set: distances to "
                      "a surface, not density (see --level-set-to-fog)");
}

// A file written to a stream has no table of offsets: it is read whole.
openvdb::GridBase::Ptr read_streamed(const std::string &path,
                                     const std::string &choice, bool fog)
{
    std::ifstream in;

    open_strictly(in, path);
    const openvdb::GridPtrVecPtr grids =
        openvdb::io::Stream(in, false).getGrids();
    std::vector<grid_entry> entries;

    for (const openvdb::GridBase::Ptr &g : *grids)
        entries.push_back(describe(*g, g->activeVoxelCount()));
    const size_t n = choose_grid(entries, choice);
    check_scalar(entries[n]);
    check_class(entries[n], fog);
    return (*grids)[n];
}

openvdb::GridBase::Ptr read_vdb(const std::string &path,
                                const std::string &choice, bool fog,
                                std::string &licence)
{
    vdb_head head(path);
    licence = find_licence(head.file_meta);
    openvdb::io::File file(path);
    std::vector<grid_entry> entries;

    // Leaves are loaded from the file itself, when they are needed: not from
    // a copy in a temporary folder.
    file.setCopyMaxBytes(0);
    if (!head.has_offsets)
        return read_streamed(path, choice, fog);
    file.open(true);
    for (const GridDescriptor &d : head.grids) {
        grid_entry e = {d.gridName(), d.gridType(), "unknown", 0};
        // The rest is in the grid's metadata, which only known types have.
        if (openvdb::GridBase::isRegistered(d.gridType())) {
            const auto name = GridDescriptor::nameAsString(d.uniqueName());
            const auto grid = file.readGridMetadata(name);
            e = describe(*grid, stored_voxels(*grid));
            e.name = d.gridName();
        }
        entries.push_back(e);
    }
    const size_t n = choose_grid(entries, choice);
    check_scalar(entries[n]);
    check_class(entries[n], fog);
    if (head.can_store(head.grids[n]) && !is_level_set(entries[n]))
        return head.read_stored(path, head.grids[n]);
    return file.readGrid(
        GridDescriptor::nameAsString(head.grids[n].uniqueName()));
}

// sdfToFogVolume() is for floats; others are copied first.
openvdb::GridBase::Ptr make_fog(const openvdb::GridBase::Ptr &grid)
{
    openvdb::FloatGrid::Ptr fog;

    if (auto d = openvdb::gridPtrCast<openvdb::DoubleGrid>(grid))
        fog = std::make_shared<openvdb::FloatGrid>(*d);
    else
        fog = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
    if (!fog)
        throw failure("is a level set of type " + grid->type() +
                      "; only float and double ones can be converted");
    openvdb::tools::sdfToFogVolume(*fog);
    return fog;
}

std::string list_of(const std::vector<grid_entry> &grids)
{
    std::string list;

    for (size_t i = 0; i < grids.size(); i++)
        list +=
            text("\n  #%zu  %s  %s  %s  %llu voxels", i,
                 grids[i].name.empty() ? "(unnamed)" : grids[i].name.c_str(),
                 grids[i].type.c_str(), grids[i].grid_class.c_str(),
                 (unsigned long long)grids[i].voxels);
    return list;
}

size_t grid_number(const std::vector<grid_entry> &grids,
                   const std::string &choice)
{
    size_t n = 0, used = 0;

    try {
        n = std::stoul(choice.substr(1), &used);
    } catch (const std::exception &) {
        used = 0;
    }
    if (used == 0 || used + 1 != choice.size() || n >= grids.size())
        throw failure("has no grid " + choice + "; it has:" + list_of(grids),
                      status_usage);
    return n;
}

} // namespace

size_t choose_grid(const std::vector<grid_entry> &grids,
                   const std::string &choice)
{
    const std::string wanted = choice.empty() ? "density" : choice;
    size_t found = 0, last = 0;

    if (grids.empty())
        throw failure("has no grids");
    if (choice[0] == '#')
        return grid_number(grids, choice);
    for (size_t i = 0; i < grids.size(); i++)
        if (grids[i].name == wanted) {
            found++;
            last = i;
        }
    if (found == 1)
        return last;
    if (choice.empty() && grids.size() == 1)
        return 0;
    if (found > 1)
        throw failure(text("has %zu grids named \"%s\"; choose with --grid "
                           "'#i':",
                           found, wanted.c_str()) +
                          list_of(grids),
                      status_usage);
    throw no_such_grid(
        "has no grid named \"" + wanted +
            "\"; choose with --grid NAME or --grid '#i':" + list_of(grids),
        status_usage);
}

source read_source(const std::string &path, const std::string &choice,
                   bool level_set_to_fog, grid_need need, progress &bar)
try {
    source s;
    std::string file_licence;
    openvdb::GridBase::Ptr grid =
        find_kind(path) == file_kind::nano
            ? read_nano(path, choice)
            : read_vdb(path, choice, level_set_to_fog, file_licence);

    const grid_entry e = describe(*grid, 0);
    check_scalar(e);
    check_class(e, level_set_to_fog);
    s.licence = find_licence(*grid);
    if (s.licence.empty())
        s.licence = file_licence;
    if (grid->getGridClass() == openvdb::GRID_LEVEL_SET) {
        grid = make_fog(grid);
        s.from_level_set = true;
    }
    extracted x = extract(*grid, bar);
    if (x.active == 0 && need == grid_need::voxels)
        throw failure("has no active voxels");
    s.name = e.name;
    s.type = e.type;
    s.grid_class = e.grid_class;
    s.vol = std::move(x.vol);
    s.bad = x.bad;
    s.active = x.active;
    s.background = x.background;
    return s;
} catch (const no_such_grid &) {
    if (need == grid_need::voxels)
        throw;
    source none;
    none.name = choice;
    none.missing = true;
    return none;
} catch (const std::ios_base::failure &) {
    throw failure("is truncated or cannot be read");
}

} // namespace bake
