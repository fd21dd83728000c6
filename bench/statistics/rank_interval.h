#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace tetrace {

/// An interval of a factor, both ends in it.
struct FactorInterval {
    double low = 0, high = 0;

    [[nodiscard]] bool contains(double factor) const { return low <= factor && factor <= high; }
};

/// The factors c for which `numerator` = c * `denominator` cannot be rejected: the interval of the inverted
/// Mann-Whitney test. Its ends are order statistics of all quotients of a sample of the one and a sample of the other.
/// If the two distributions differ only in the factor, whatever their shape, the interval misses it in at most `error`
/// of all cases. That holds for any number of samples, and for ties, since the ends belong to the interval. A few
/// outliers do not move it. Empty for too few samples to keep to `error` (see min_error(): 0.0079 for 5 and 5).
/// Above 50 samples the normal approximation serves. Samples are independent, positive and finite, as are their
/// quotients. Source: Mann and Whitney, "On a Test of Whether one of Two Random Variables is Stochastically Larger than
/// the Other" (1947); Lehmann, "Nonparametrics: Statistical Methods Based on Ranks" (1975), sections 1.2 and 2.6.
[[nodiscard]] std::optional<FactorInterval> rank_interval(std::vector<double> numerator,
                                                          std::vector<double> denominator, double error);

/// The error of the widest interval that n and m samples can give, from the smallest quotient to the largest:
/// 2 / binomial(n + m, n), rounded up a little; at most 1.
[[nodiscard]] double min_error(std::size_t n, std::size_t m);

/// How many of the smallest quotients of n and m samples lie outside an interval of that error, and how many of the
/// largest: its ends are the next ones. Empty where not even all n * m quotients make an interval.
[[nodiscard]] std::optional<std::size_t> quotients_left_out(std::size_t n, std::size_t m, double error);

/// Coverage that a MedianRatio's interval aims at.
inline constexpr double ratio_confidence = 0.95;

/// A ratio of two medians with its confidence interval.
struct MedianRatio {
    double value = 0;
    double low = 0, high = 0;

    [[nodiscard]] bool contains(double ratio) const { return low <= ratio && ratio <= high; }
};

/// The median of the numerator's samples over that of the denominator's, with a 95 % interval by the percentile
/// bootstrap: both sets are drawn again with replacement, independently, since rows are interleaved at random and no
/// sample of one belongs to a sample of the other; the interval is the middle 95 % of the resulting ratios. The drawing
/// starts from a fixed seed: equal samples give equal intervals.
/// Source: Efron and Tibshirani, "An Introduction to the Bootstrap" (1993), chapters 13 and 16; that times of programs
/// want ratios with intervals from resampling: Kalibera and Jones, "Rigorous Benchmarking in Reasonable Time" (2013).
/// Throws Error{internal} for no samples, or one that is not positive and finite.
[[nodiscard]] MedianRatio ratio_of_medians(const std::vector<double>& numerator,
                                           const std::vector<double>& denominator);

/// The geometric mean of the medians of several lists of samples, with a 95 % interval by the same bootstrap: each list
/// is drawn again with replacement, independently. Throws Error{internal} for no lists, and as ratio_of_medians().
[[nodiscard]] MedianRatio geometric_mean_of_medians(const std::vector<std::vector<double>>& lists);

/// The least number of runs whose interval comes from resampling.
inline constexpr std::size_t resampled_runs = 5;

/// The same of several runs, each with samples of both: the ratio of the medians of all samples, with an interval that
/// spans the runs. A run's samples share what differs between runs (places in memory, the driver's state), so that
/// only runs count as independent. From resampled_runs on, a 95 % interval by the hierarchical bootstrap: runs are
/// drawn with replacement, and in each run drawn its samples. With fewer runs, it is the range of their own ratios,
/// which holds the median over all runs in 50, 75 and 87.5 % of cases for 2, 3 and 4 runs. Source: Kalibera and Jones
/// (2013): repetition at the highest level that varies; Davison and Hinkley, "Bootstrap Methods and their Application"
/// (1997), on hierarchical data. Throws Error{internal} for no runs, lists of different lengths, and as
/// ratio_of_medians().
[[nodiscard]] MedianRatio ratio_over_runs(const std::vector<std::vector<double>>& numerator,
                                          const std::vector<std::vector<double>>& denominator);

} // namespace tetrace
