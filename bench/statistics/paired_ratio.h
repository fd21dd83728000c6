#pragma once

#include "bench/statistics/interval.h"

#include <vector>

namespace tetrace {

/// How the times of two rows that trace the same views compare, view by view.
struct PairedRatio {
    std::vector<double> views; ///< the other's time over the one's; above 1 the one is faster
    Estimate median;           ///< over the views
    double lowest = 0, highest = 0;
    double won = 0; ///< share of the views in which the ratio is above 1
};

/// one_s, other_s: seconds of each view, in the same order. sampling: how the views were taken.
/// Throws Error{internal} for lists of different lengths, for none, or a time that is not positive.
[[nodiscard]] PairedRatio paired_ratio(const std::vector<double>& one_s, const std::vector<double>& other_s,
                                       Sampling sampling);

} // namespace tetrace
