#include "core/base/did_you_mean.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace tetrace {

namespace {

/// The least number of letters left out, added, or replaced, and of neighbours exchanged, that turns one text into the
/// other: the restricted distance of Damerau, "A technique for computer detection and correction of spelling errors"
/// (1964).
std::size_t slips_between(std::string_view a, std::string_view b)
{
    std::vector<std::vector<std::size_t>> slips(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i)
        for (std::size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                slips[i][j] = i + j;
                continue;
            }
            const std::size_t replaced = slips[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            slips[i][j] = std::min({replaced, slips[i - 1][j] + 1, slips[i][j - 1] + 1});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                slips[i][j] = std::min(slips[i][j], slips[i - 2][j - 2] + 1);
        }
    return slips[a.size()][b.size()];
}

} // namespace

std::string did_you_mean(const std::string& text, const std::vector<std::string>& names)
{
    std::size_t nearest = std::min<std::size_t>(2, text.size() / 3) + 1;
    std::string found;
    bool is_tie = false;
    for (const std::string& name : names) {
        const auto [shorter, longer] = std::minmax({text.size(), name.size()});
        if (longer - shorter > nearest) continue; // at least this many slips; a text may be as long as a command line
        if (const std::size_t slips = slips_between(text, name); slips < nearest) {
            nearest = slips;
            found = name;
            is_tie = false;
        } else if (!found.empty() && slips == nearest)
            is_tie = true;
    }
    return found.empty() || is_tie ? std::string() : "; did you mean " + found + "?";
}

} // namespace tetrace
