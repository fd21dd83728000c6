#include "core/base/printable.h"

#include <cstdint>

namespace tetrace {
namespace {

struct Character {
    std::uint32_t code = 0;
    std::size_t bytes = 0; ///< 0: the text does not begin with a character of UTF-8
};

/// Its first character.
Character first_of(std::string_view text)
{
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    if (byte(0) < 0x80) return {byte(0), 1};
    const std::size_t bytes = byte(0) >= 0xC2 && byte(0) < 0xE0   ? 2
                              : byte(0) >= 0xE0 && byte(0) < 0xF0 ? 3
                              : byte(0) >= 0xF0 && byte(0) < 0xF5 ? 4
                                                                  : 0;
    if (bytes == 0 || bytes > text.size()) return {};
    std::uint32_t code = byte(0) & (0x7Fu >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xC0) != 0x80) return {};
        code = code << 6 | (byte(i) & 0x3Fu);
    }
    const bool is_overlong = (bytes == 3 && code < 0x800) || (bytes == 4 && code < 0x10000);
    const bool is_surrogate = code >= 0xD800 && code < 0xE000;
    return is_overlong || is_surrogate || code > 0x10FFFF ? Character{} : Character{code, bytes};
}

bool is_shown(std::uint32_t code)
{
    const auto in = [code](std::uint32_t first, std::uint32_t last) { return first <= code && code <= last; };
    return code >= 0x20 && !in(0x7F, 0x9F) && !in(0x2028, 0x202E) && !in(0x2066, 0x2069) && !in(0xFFFE, 0xFFFF);
}

std::string printable(std::string_view text, std::string_view kept)
{
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const Character first = first_of(text);
        const bool stays = first.bytes > 0 && (is_shown(first.code) || kept.find(text[0]) != std::string_view::npos);
        const std::size_t bytes = first.bytes > 0 ? first.bytes : 1;
        result += stays ? text.substr(0, bytes) : "?";
        text.remove_prefix(bytes);
    }
    return result;
}

} // namespace

std::string printable_text(std::string_view text)
{
    return printable(text, "\t\n");
}

std::string printable_line(std::string_view name)
{
    return printable(name, "");
}

} // namespace tetrace
