#include "bench/statistics/break_even.h"

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

} // namespace tetrace
