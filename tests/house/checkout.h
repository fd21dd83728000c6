#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tetrace::test {

/// Of the checkout.
inline const std::filesystem::path checkout = TETRACE_ROOT;

/// The lines, each with its end.
[[nodiscard]] inline std::string joined(const std::vector<std::string>& lines)
{
    std::string text;
    for (const std::string& line : lines)
        text += line + "\n";
    return text;
}

} // namespace tetrace::test
