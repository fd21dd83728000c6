#include "bench/terminal/colour.h"

#include <array>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <sys/ioctl.h>
#include <unistd.h>

namespace tetrace {

namespace {

struct Tint {
    std::string_view code;
    std::array<std::string_view, 6> beginnings;
};

constexpr std::string_view end_of_colour = "\x1b[0m";

// Red, yellow, green: colours that terminals show legibly on black and on white.
constexpr std::array<Tint, 3> tints = {{
    {"\x1b[31m", {"wrong", "error", "not exact", "FAILED", "SLOWER", "SEEN"}},
    {"\x1b[33m", {"flawed", "noisy", "UNSURE", "NOISY", "MISSING", "DIFFERENT"}},
    {"\x1b[32m", {"FASTER"}},
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

} // namespace tetrace
