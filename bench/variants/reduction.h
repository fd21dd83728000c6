#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace tetrace {

/// A smallest part of a set that still fails: without any one of its elements it does not. Source: Zeller, Hildebrandt,
/// "Simplifying and Isolating Failure-Inducing Input", IEEE Transactions on Software Engineering 28(2), 2002 (ddmin).
/// all: fails. fails: asked for parts of it, none of them empty.
[[nodiscard]] inline std::vector<std::size_t>
smallest_failing(std::vector<std::size_t> all, const std::function<bool(const std::vector<std::size_t>&)>& fails)
{
    for (std::size_t parts = 2; all.size() > 1;) {
        parts = std::min(parts, all.size());
        bool is_smaller = false;
        // Each part alone, then all without it.
        for (std::size_t i = 0; i < 2 * parts && !is_smaller; ++i) {
            const auto place = [&](std::size_t part) {
                return all.begin() + static_cast<std::ptrdiff_t>(all.size() * part / parts);
            };
            const auto begin = place(i % parts), end = place(i % parts + 1);
            const bool is_alone = i < parts;
            if (!is_alone && parts == 2) break; // the other part, which was tried
            std::vector<std::size_t> tried(is_alone ? begin : all.begin(), is_alone ? end : begin);
            if (!is_alone) tried.insert(tried.end(), end, all.end());
            if (!fails(tried)) continue;
            parts = is_alone ? 2 : std::max<std::size_t>(parts - 1, 2);
            all = std::move(tried);
            is_smaller = true;
        }
        if (is_smaller) continue;
        if (parts == all.size()) break;
        parts *= 2;
    }
    return all;
}

} // namespace tetrace
