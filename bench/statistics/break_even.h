#pragma once

#include "bench/statistics/statistics.h"

#include <optional>
#include <vector>

namespace tetrace {

/// What tracing with a structure takes: once, to make it, and then each ray. Seconds.
struct TotalCost {
    double once_s = 0;
    double ray_s = 0;
};

/// Which of two structures takes less in all, once there are rays enough.
struct BreakEven {
    enum class Ahead { neither, first, second };
    Ahead ahead = Ahead::neither;
    /// The rays from which on it is ahead, the other one before; empty if it is so from the first ray on.
    std::optional<double> rays;
};

/// The one with the faster rays is ahead in the end; one with a faster build is ahead only until that is paid off; of
/// equal rays the faster build decides, for any number of them. Precondition: all are finite and not negative.
[[nodiscard]] BreakEven break_even(const TotalCost& first, const TotalCost& second);

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
