#include "bench/statistics/break_even.h"

#include "core/base/error.h"

#include <algorithm>

namespace tetrace {

namespace {

/// Where the first is the one with the faster rays.
std::optional<double> paid_after(const TotalCost& first, const TotalCost& second)
{
    if (first.once_s <= second.once_s) return std::nullopt;
    return (first.once_s - second.once_s) / (second.ray_s - first.ray_s);
}

} // namespace

BreakEven break_even(const TotalCost& first, const TotalCost& second)
{
    using Ahead = BreakEven::Ahead;
    if (first.ray_s < second.ray_s) return {Ahead::first, paid_after(first, second)};
    if (second.ray_s < first.ray_s) return {Ahead::second, paid_after(second, first)};
    if (first.once_s == second.once_s) return {};
    return {first.once_s < second.once_s ? Ahead::first : Ahead::second, {}};
}

PairedRatio paired_ratio(const std::vector<double>& one_s, const std::vector<double>& other_s, Sampling sampling)
{
    if (one_s.size() != other_s.size() || one_s.empty())
        throw Error(ErrorKind::internal, "a paired ratio of times of other views, or of none");
    PairedRatio pair;
    for (std::size_t view = 0; view < one_s.size(); ++view) {
        if (!(one_s[view] > 0) || !(other_s[view] > 0))
            throw Error(ErrorKind::internal, "a paired ratio of times that are not positive");
        pair.views.push_back(other_s[view] / one_s[view]);
    }
    pair.median = median_of_views(pair.views, sampling);
    const auto [lowest, highest] = std::ranges::minmax_element(pair.views);
    pair.lowest = *lowest, pair.highest = *highest;
    const auto won = std::ranges::count_if(pair.views, [](double ratio) { return ratio > 1; });
    pair.won = static_cast<double>(won) / static_cast<double>(pair.views.size());
    return pair;
}

} // namespace tetrace
