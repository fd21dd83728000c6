#include "bench/terminal/text.h"

#include "core/base/printable.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string_view>
#include <vector>

namespace tetrace {

namespace {

struct Tint {
    std::string_view code;
    std::array<std::string_view, 7> beginnings;
};

constexpr std::string_view end_of_colour = "\x1b[0m";

// Red, yellow, green: colours that terminals show legibly on black and on white.
constexpr std::array<Tint, 3> tints = {{
    {"\x1b[31m", {"wrong", "error", "not exact", "FAILED", "SLOWER", "SEEN", "BECAME WRONG"}},
    {"\x1b[33m", {"flawed", "noisy", "UNSURE", "NOISY", "MISSING", "DIFFERENT"}},
    {"\x1b[32m", {"FASTER", "BECAME RIGHT"}},
}};

} // namespace

std::string in_colour(const std::string& words)
{
    for (const Tint& tint : tints)
        for (const std::string_view beginning : tint.beginnings)
            if (!beginning.empty() && words.starts_with(beginning))
                return std::string(tint.code).append(words).append(end_of_colour);
    return words;
}

std::string without_colour(const std::string& text)
{
    std::string plain = text;
    const auto erase_all = [&](std::string_view code) {
        for (std::size_t at = plain.find(code); at != std::string::npos; at = plain.find(code, at))
            plain.erase(at, code.size());
    };
    for (const Tint& tint : tints)
        erase_all(tint.code);
    erase_all(end_of_colour);
    return plain;
}

bool is_colour_refused()
{
    const char* const no_colour = std::getenv("NO_COLOR");
    return no_colour != nullptr && *no_colour != '\0';
}

std::size_t terminal_columns(int file)
{
    if (::isatty(file) != 1) return 0;
    constexpr long min_columns = 20, max_columns = 10'000; // any other number is a mistake
    const char* const columns = std::getenv("COLUMNS");
    if (const long asked = columns != nullptr ? std::strtol(columns, nullptr, 10) : 0;
        asked > min_columns && asked < max_columns)
        return static_cast<std::size_t>(asked);
    winsize size{};
    return ::ioctl(file, TIOCGWINSZ, &size) == 0 && size.ws_col > min_columns ? size.ws_col : 80u;
}

bool has_colour(int file)
{
    const char* const terminal = std::getenv("TERM");
    return !is_colour_refused() && ::isatty(file) == 1 && terminal != nullptr && std::strcmp(terminal, "dumb") != 0;
}

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

std::string counted(std::uint64_t count, std::string_view one, std::string_view many)
{
    return fmt::format("{} {}", count, count == 1 ? one : many);
}

void append_item(std::string& text, std::string_view separator, std::string_view item)
{
    if (!text.empty()) text += separator;
    text += item;
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

std::string command_of(const std::vector<std::string>& arguments)
{
    std::string text = "tetrace";
    for (const std::string& argument : arguments)
        text += " " + shell_word(argument);
    return text;
}

} // namespace tetrace
