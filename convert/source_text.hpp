// SPDX-License-Identifier: MIT
//
// An asset as source text, for programs without a file system: C, or assembly
// that includes the file. Both define the same two symbols,
//
//     const union NAME_asset { unsigned char bytes[N]; uint32_t align; } NAME;
//     const uint32_t NAME_size;
//
// so that a program links with either.
#ifndef BRUME_CONVERT_SOURCE_TEXT_HPP
#define BRUME_CONVERT_SOURCE_TEXT_HPP

#include <string>
#include <vector>

#include "atomic_file.hpp"

namespace bake
{

enum class output_form { binary, c, assembly };

// By the end of its name: .c, .S or .s, else the asset itself.
output_form form_of(const std::string &path);

// The asset that the assembly in `path` includes: beside it, as .brume.
std::string included_path(const std::string &path);

// A symbol made of the name of a file: other characters become '_', and what
// a compiler or an assembler would take for its own gets "asset_" before it.
std::string symbol_for(const std::string &path);

// Is it an identifier that C, C++ and assemblers leave to the user?
bool is_free_identifier(const std::string &name);

struct source_text {
    std::string path, symbol, licence;
    std::vector<std::string> facts; // lines of the comment, any bytes
};

void write_c(output &out, const source_text &t,
             const std::vector<uint8_t> &asset);

// For ELF targets, `bytes` the size of the included asset.
void write_assembly(output &out, const source_text &t, uint64_t bytes);

} // namespace bake

#endif
