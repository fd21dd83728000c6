#pragma once

#include <vector>

namespace tetrace {

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
/// sample of one belongs to a sample of the other; the interval is the middle 95 % of the ratios that come out. The
/// drawing starts from a fixed seed: equal samples give equal intervals.
/// Source: Efron and Tibshirani, "An Introduction to the Bootstrap" (1993), chapters 13 and 16; that times of programs
/// want ratios with intervals from resampling: Kalibera and Jones, "Rigorous Benchmarking in Reasonable Time" (2013).
/// Throws Error{internal} for no samples, or one that is not positive and finite.
[[nodiscard]] MedianRatio ratio_of_medians(const std::vector<double>& numerator,
                                           const std::vector<double>& denominator);

} // namespace tetrace
