#include "bench/terminal/text.h"

#include "core/base/printable.h"

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

std::string percent_text(double share)
{
    if (share > 0 && share < 0.01) return "<1 %";
    if (share < 1 && share > 0.99) return ">99 %";
    return fmt::format("{:.0f} %", 100 * share);
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
    for (const char c : printable_text(text))
        switch (c) {
        case '&': result += "&amp;"; break;
        case '<': result += "&lt;"; break;
        case '>': result += "&gt;"; break;
        case '"': result += "&quot;"; break;
        case '\'': result += "&apos;"; break;
        default: result += c;
        }
    return result;
}

std::string shell_word(const std::string& word)
{
    constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
    std::string text = "'";
    for (const char c : word)
        text += c == '\'' ? "'\\''" : std::string(1, c);
    return text + "'";
}

} // namespace tetrace
