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

} // namespace tetrace
