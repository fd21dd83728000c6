#pragma once

#include "bench/statistics/rank_interval.h"
#include "core/base/enum_names.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace tetrace {

/// What the samples of one row in two results, before and after, say about its speed.
enum class SpeedVerdict {
    same,   ///< the whole interval of the ratio is within the tolerance: a difference, if any, is too small
            ///< to matter
    faster, ///< else, the interval is above 1
    slower, ///< else, the interval is below 1
    unsure, ///< the samples do not decide: the interval contains 1 and exceeds the tolerance, or is missing
};
template <>
inline constexpr auto enum_names<SpeedVerdict> = names_up_to<SpeedVerdict::unsure>("SAME", "FASTER", "SLOWER",
                                                                                   "UNSURE");

/// The chance, at most, that a comparison calls any of its rows faster or slower where nothing has changed, however
/// many rows it has. Each row's interval has this divided by their number as its error (Bonferroni's inequality, which
/// does not ask for rows to be independent), so that all intervals of a comparison hold together.
inline constexpr double comparison_error = 0.01;

/// A row's speed after, compared with that before.
struct SpeedChange {
    double ratio = 1;                       ///< median seconds before over those after: above 1 it has become faster
    std::optional<FactorInterval> interval; ///< of the ratio, which it contains; empty for too few samples
    double error = 1;                       ///< of the interval: how often, at most, it misses the true ratio
    SpeedVerdict verdict = SpeedVerdict::unsure;

    /// Slower, and by more than the tolerance: what took 1 second takes more than 1 + tolerance.
    [[nodiscard]] bool is_regression(double tolerance) const
    {
        return verdict == SpeedVerdict::slower && ratio < 1 / (1 + tolerance);
    }
};

/// Compares the samples of a row, one of `rows`. tolerance: a share, 0.03 for ratios from 1 / 1.03 to 1.03.
///
/// The interval is that of rank_interval(), widened where need be to contain the ratio of the medians (with two humps
/// in the samples a median can leap). Its error is comparison_error / rows; if a row has too few samples for that, the
/// smallest that they allow: 5 samples and 5 give 0.0079. It needs min_samples.
/// Chosen by simulation, against the percentile bootstrap of the ratio of medians with 99 % (2,000 resamples): 2,000
/// comparisons of one row each, error 0.01. Noise: A normal, 2 %; B 1 % and exponential delays of 1 %; C Student's t
/// with 3 degrees of freedom, 1 %; D two humps 8 % apart. In %, how many were called faster or slower where nothing
/// changed (two standard deviations of 1 % are 0.45 %), and how many where the time changed by 5 %:
///
///     samples  method     A         B         C         D
///      5       ranks      0.6   56  0.7   89  1.1   81  1.2    6
///              bootstrap  1.3   72  1.4   94  2.0   88  2.0    8
///     10       ranks      1.0   98  0.7  100  0.6   99  0.9   30
///              bootstrap  0.9   96  0.6  100  0.6   99  1.0   13
///     20       ranks      0.9  100  0.8  100  0.8  100  1.3   59
///              bootstrap  0.7  100  0.3  100  0.3  100  0.5    8
///
/// The bootstrap breaks the promise for 5 samples and cannot keep to the small errors that many rows ask for; ranks
/// keep both, and find more with two humps. For one of 20 rows, with error 0.0005, ranks find the 5 % behind A in
/// 80 % for 10 samples, in all for 20. What they need is independent samples: with a correlation of 0.5 between
/// successive ones, 7 to 13 % are false alarms. So rows are interleaved at random as they are measured. What
/// differs between runs, such as the layout of memory or the temperature, is in no sample: the tolerance is for that.
/// Throws Error{internal} for no samples, or one that is not positive and finite.
[[nodiscard]] SpeedChange compare_speed(const std::vector<double>& before_s, const std::vector<double>& after_s,
                                        std::size_t rows, double tolerance);

/// The least samples per row, in both results, with which the intervals of `rows` rows have error
/// comparison_error / rows.
[[nodiscard]] std::size_t samples_needed(std::size_t rows);

} // namespace tetrace
