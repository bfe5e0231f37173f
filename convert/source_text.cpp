// SPDX-License-Identifier: MIT
#include "source_text.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "bake.hpp"

namespace bake
{

namespace
{

constexpr int values_per_line = 20;

// Words of C and C++, names that compilers predefine without leading
// underscores, and registers as the assemblers of common targets spell them.
const char taken_words[] =
    " alignas alignof and and_eq asm auto bitand bitor bool break case catch "
    "char char16_t char32_t char8_t class co_await co_return co_yield compl "
    "concept const const_cast consteval constexpr constinit continue decltype "
    "default delete do double dynamic_cast else enum explicit export extern "
    "false float for friend goto if inline int long main mutable namespace "
    "new noexcept not not_eq nullptr operator or or_eq private protected "
    "public register reinterpret_cast requires restrict return short signed "
    "sizeof static static_assert static_cast struct switch template this "
    "thread_local throw true try typedef typeid typename typeof typeof_unqual "
    "uint32_t union unsigned using virtual void volatile wchar_t while xor "
    "xor_eq "
    "arm i386 linux mips sparc sun unix "
    "fp gp ip lr pc ra sb sl sp tp wsp wzr xzr zero ";

bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

// r0, x12, fa0: one or two letters and one or two digits.
bool is_register(const std::string &s)
{
    size_t letters = 0;

    while (letters < s.size() && is_letter(s[letters]))
        letters++;
    const size_t digits = s.size() - letters;
    return letters >= 1 && letters <= 2 && digits >= 1 && digits <= 2 &&
           std::all_of(s.begin() + long(letters), s.end(), is_digit);
}

bool is_taken(const std::string &s)
{
    std::string low = s;

    for (char &c : low)
        c = char(std::tolower(uint8_t(c)));
    return is_register(low) ||
           std::string(taken_words).find(" " + low + " ") != std::string::npos;
}

std::string file_name(const std::string &path)
{
    return std::filesystem::path(path).filename().string();
}

// Bytes of the UTF-8 character at s[i] that may stand in a comment: no
// control character, nothing that turns the direction of the text (compilers
// warn of it). 0: none.
size_t printable(const std::string &s, size_t i)
{
    const uint8_t c = uint8_t(s[i]);
    const size_t n = c < 0x80   ? 1
                     : c < 0xc2 ? 0
                     : c < 0xe0 ? 2
                     : c < 0xf0 ? 3
                     : c < 0xf5 ? 4
                                : 0;
    uint32_t code = n == 1 ? c : c & (0x7fu >> n);

    if (n == 0 || n > s.size() - i)
        return 0;
    for (size_t k = 1; k < n; k++) {
        if ((uint8_t(s[i + k]) & 0xc0) != 0x80)
            return 0;
        code = code << 6 | (uint8_t(s[i + k]) & 0x3f);
    }
    const bool overlong = (n == 3 && code < 0x800) ||
                          (n == 4 && (code < 0x10000 || code > 0x10ffff));
    const bool surrogate = code >= 0xd800 && code <= 0xdfff;
    const bool control = code < 0x20 || (code >= 0x7f && code < 0xa0);
    const bool turns = code == 0x61c || (code >= 0x200e && code <= 0x200f) ||
                       (code >= 0x2028 && code <= 0x202e) ||
                       (code >= 0x2066 && code <= 0x2069);
    return overlong || surrogate || control || turns ? 0 : n;
}

// Any bytes as text that neither ends a comment, nor opens one in it, nor
// joins it to the next line.
std::string for_comment(const std::string &s)
{
    std::string out;

    for (size_t i = 0; i < s.size();) {
        const size_t n = printable(s, i);
        const char before = i > 0 ? s[i - 1] : '\0';
        const char after = i + 1 < s.size() ? s[i + 1] : '\0';
        const bool risky =
            (s[i] == '/' && (before == '*' || after == '*' || before == '?')) ||
            (s[i] == '\\' && after == '\0');
        if (n == 0 || risky)
            out += text("\\x%02x", unsigned(uint8_t(s[i++])));
        else
            for (size_t k = 0; k < n; k++)
                out += s[i++];
    }
    return out;
}

// A string for an assembler, all but plain ASCII in octal.
std::string for_assembler(const std::string &s)
{
    std::string out;

    for (const char c : s) {
        if (c == '"' || c == '\\')
            out += std::string("\\") + c;
        else if (uint8_t(c) < 0x20 || uint8_t(c) > 0x7e)
            out += text("\\%03o", unsigned(uint8_t(c)));
        else
            out += c;
    }
    return '"' + out + '"';
}

// The symbol for every $ of a pattern, the size for every @.
std::string fill(const char *pattern, const std::string &symbol, uint64_t size)
{
    std::string out;

    for (const char *p = pattern; *p != '\0'; p++)
        if (*p == '$')
            out += symbol;
        else if (*p == '@')
            out += std::to_string(size);
        else
            out += *p;
    return out;
}

std::string licence_lines(const std::string &licence)
{
    std::string out;

    if (licence.empty())
        return " * licence   none was given\n";
    for (size_t at = 0; at <= licence.size();) {
        const size_t end = std::min(licence.find('\n', at), licence.size());
        out += at == 0 ? " * licence   " : " *           ";
        out += for_comment(licence.substr(at, end - at)) + "\n";
        at = end + 1;
    }
    return out;
}

std::string comment(const source_text &t, uint64_t bytes)
{
    std::string out = "/* " + for_comment(file_name(t.path)) +
                      ": a volume for brume, written by brume-bake\n *\n";

    for (const std::string &fact : t.facts)
        out += " * " + for_comment(fact) + "\n";
    return out + licence_lines(t.licence) +
           fill(" *\n * To be declared so (in C++ as extern \"C\"):\n *\n"
                " *     extern const union $_asset {\n"
                " *         unsigned char bytes[@];\n"
                " *         uint32_t align;\n"
                " *     } $;\n"
                " *     extern const uint32_t $_size;\n",
                t.symbol, bytes);
}

void put(output &out, const std::string &s)
{
    out.write(s.data(), s.size());
}

void put_bytes(output &out, const std::vector<uint8_t> &bytes)
{
    std::string line;

    for (size_t i = 0; i < bytes.size(); i++) {
        line += std::to_string(bytes[i]);
        if (i + 1 < bytes.size())
            line += ',';
        if (i % values_per_line == values_per_line - 1 ||
            i + 1 == bytes.size()) {
            line += '\n';
            put(out, line);
            line.clear();
        }
    }
}

} // namespace

output_form form_of(const std::string &path)
{
    const std::string end = std::filesystem::path(path).extension().string();

    if (end == ".c")
        return output_form::c;
    return end == ".S" || end == ".s" ? output_form::assembly
                                      : output_form::binary;
}

std::string included_path(const std::string &path)
{
    return std::filesystem::path(path).replace_extension(".brume").string();
}

bool is_free_identifier(const std::string &name)
{
    const auto legal = [](char c) {
        return is_letter(c) || is_digit(c) || c == '_';
    };

    return !name.empty() && is_letter(name[0]) && !is_taken(name) &&
           std::all_of(name.begin(), name.end(), legal);
}

std::string symbol_for(const std::string &path)
{
    std::string s;

    for (const char c : std::filesystem::path(path).stem().string()) {
        if (is_letter(c) || is_digit(c))
            s += c;
        else if (!s.empty() && s.back() != '_')
            s += '_';
    }
    while (!s.empty() && s.back() == '_')
        s.pop_back();
    return is_free_identifier(s) ? s : s.empty() ? "asset" : "asset_" + s;
}

// Bytes stay bytes, in any order of a word's. The union aligns them; where
// words themselves are aligned to 2 only, as on m68k, gcc's attribute does.
void write_c(output &out, const source_text &t,
             const std::vector<uint8_t> &asset)
{
    put(out, comment(t, asset.size()));
    put(out, fill(" */\n"
                  "#include <stdint.h>\n\n"
                  "#ifdef __GNUC__\n"
                  "#define ALIGN_4 __attribute__((aligned(4)))\n"
                  "#else\n"
                  "#define ALIGN_4\n"
                  "#endif\n"
                  "#ifdef __cplusplus\n"
                  "extern \"C\" {\n"
                  "#endif\n\n"
                  "union $_asset {\n"
                  "    unsigned char bytes[@];\n"
                  "    uint32_t align;\n"
                  "};\n"
                  "extern const union $_asset $ ALIGN_4;\n"
                  "extern const uint32_t $_size;\n\n"
                  "const uint32_t $_size = @u;\n"
                  "const union $_asset $ = {{\n",
                  t.symbol, asset.size()));
    put_bytes(out, asset);
    put(out, "}};\n\n#ifdef __cplusplus\n}\n#endif\n");
}

// Everything here means the same to GNU as and clang for every ELF target, and
// needs no preprocessor. The padding is a union's, and counts as one's.
void write_assembly(output &out, const source_text &t, uint64_t bytes)
{
    put(out, comment(t, bytes) +
                 " *\n * The assembler looks for the file below in the "
                 "current folder and in those\n * given by -I.\n */\n");
    put(out, fill("    .section .rodata,\"a\",%progbits\n"
                  "    .balign 4\n"
                  "    .globl $\n"
                  "    .type $, %object\n"
                  "$:\n    .incbin ",
                  t.symbol, bytes) +
                 for_assembler(file_name(included_path(t.path))));
    put(out, fill("\n    .balign 4\n"
                  "    .size $, . - $\n"
                  "    .globl $_size\n"
                  "    .type $_size, %object\n"
                  "$_size:\n"
                  "    .4byte @\n"
                  "    .size $_size, 4\n"
                  "    .section .note.GNU-stack,\"\",%progbits\n",
                  t.symbol, bytes));
}

} // namespace bake
