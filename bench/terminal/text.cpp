#include "bench/terminal/text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <sstream>
#include <vector>

namespace tetrace {

std::size_t display_width(const std::string& text)
{
    return static_cast<std::size_t>(
        std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

namespace {

/// Breaks a paragraph's words into lines of at most `width` columns.
std::vector<std::string> lines_of(const std::string& paragraph, std::size_t width)
{
    std::istringstream words(paragraph);
    std::vector<std::string> lines;
    for (std::string word; words >> word;) {
        if (lines.empty() || display_width(lines.back()) + 1 + display_width(word) > width)
            lines.push_back(word);
        else
            lines.back() += " " + word;
    }
    return lines;
}

/// Moves a word down where the last line would be one short word.
void move_to_orphan(std::vector<std::string>& lines)
{
    constexpr std::size_t short_word = 12;
    if (lines.size() < 2 || lines.back().size() > short_word || lines.back().find(' ') != std::string::npos) return;
    std::string& before = lines[lines.size() - 2];
    const std::size_t space = before.rfind(' ');
    if (space == std::string::npos) return;
    lines.back() = before.substr(space + 1) + " " + lines.back();
    before.resize(space);
}

std::string filled(const std::string& text, std::size_t width, std::size_t indent, bool has_orphans)
{
    const std::string margin(indent, ' ');
    std::string result;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find("\n\n", begin), text.size());
        std::vector<std::string> lines = lines_of(text.substr(begin, end - begin), width - std::min(width, indent));
        if (!has_orphans) move_to_orphan(lines);
        if (begin > 0) result += "\n";
        for (const std::string& line : lines)
            result.append(margin).append(line).append("\n");
        begin = end + 2;
    }
    return result;
}

/// Length in bytes of the UTF-8 character at `i`; 0 where there is none that XML can hold.
std::size_t character_length(const std::string& text, std::size_t i)
{
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
    if (byte(i) < 0x80) return byte(i) >= 0x20 || text[i] == '\n' || text[i] == '\t' ? 1 : 0;
    const std::size_t length = byte(i) >= 0xC2 && byte(i) < 0xE0   ? 2
                               : byte(i) >= 0xE0 && byte(i) < 0xF0 ? 3
                               : byte(i) >= 0xF0 && byte(i) < 0xF5 ? 4
                                                                   : 0;
    if (length == 0 || i + length > text.size()) return 0;
    std::uint32_t code = byte(i) & (0x7Fu >> length);
    for (std::size_t k = 1; k < length; ++k) {
        if ((byte(i + k) & 0xC0) != 0x80) return 0;
        code = code << 6 | (byte(i + k) & 0x3Fu);
    }
    const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
    const bool forbidden = (code >= 0xD800 && code < 0xE000) || code == 0xFFFE || code == 0xFFFF || code > 0x10FFFF;
    return overlong || forbidden ? 0 : length;
}

} // namespace

std::string wrapped(const std::string& text, std::size_t width, std::size_t indent)
{
    return filled(text, width, indent, true);
}

std::string wrapped_without_orphans(const std::string& text, std::size_t width, std::size_t indent)
{
    return filled(text, width, indent, false);
}

std::string with_commas(std::uint64_t value)
{
    const std::string digits = std::to_string(value);
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
        text += digits[i];
    }
    return text;
}

std::string size_text(std::uint64_t bytes)
{
    const double size = static_cast<double>(bytes);
    return bytes < 100'000 ? fmt::format("{:.1f} kB", size / 1e3) : fmt::format("{:.1f} MB", size / 1e6);
}

std::string seconds_text(double seconds)
{
    if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
    const auto whole = static_cast<std::uint64_t>(std::llround(seconds));
    return whole < 60 ? fmt::format("{} s", whole) : fmt::format("{} min {:02} s", whole / 60, whole % 60);
}

std::string xml_text(const std::string& text)
{
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = character_length(text, i);
        switch (length == 1 ? text[i] : 0) {
        case '&': result += "&amp;"; break;
        case '<': result += "&lt;"; break;
        case '>': result += "&gt;"; break;
        case '"': result += "&quot;"; break;
        case '\'': result += "&apos;"; break;
        default: result += length == 0 ? "?" : text.substr(i, length);
        }
        i += std::max<std::size_t>(length, 1);
    }
    return result;
}

} // namespace tetrace
