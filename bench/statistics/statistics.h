#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace tetrace {

/// Samples above this spread make a row noisy.
inline constexpr double noisy_spread = 0.05;

/// A row is also noisy if calibration took at least this many times its fastest during half of its samples or more. Two
/// results of one machine whose pulses are that far apart do not compare.
inline constexpr double noisy_pulse = 1.25;

/// The one rule on samples: with fewer, a row's rate lacks an interval, compared both with another row of its run and
/// with the same row of another result. Of 3 samples, the bootstrap's 95 % intervals hold the true ratio in 90 % of
/// cases (median_ratio.h), and ranks give none at all for `compare`'s 1 % of false alarms (speed_verdict.h).
inline constexpr unsigned min_samples = 5;

/// Median and quartiles of a row's samples.
struct Statistics {
    double median = 0;
    double lower_quartile = 0;
    double upper_quartile = 0;

    /// Interquartile range / median.
    [[nodiscard]] double spread() const { return (upper_quartile - lower_quartile) / median; }
    [[nodiscard]] bool noisy() const { return spread() > noisy_spread; }
};

/// The p-quantile by linear interpolation between the order statistics around (n - 1) p: definition 7 of Hyndman and
/// Fan, "Sample Quantiles in Statistical Packages" (1996), the default of R and NumPy.
/// Throws Error{internal} for no samples. p in [0, 1].
[[nodiscard]] double quantile(std::vector<double> samples, double p);

/// Median and quartiles by quantile(). Throws Error{internal} for no samples, or one that is not positive and finite.
[[nodiscard]] Statistics statistics_of(const std::vector<double>& samples);

/// Coverage that every interval of `reproduce` aims at.
inline constexpr double reproduce_confidence = 0.95;

/// A number estimated from a sample of views, with its 95 % interval. Without bounds it is exact (nothing was left
/// out), or unbounded: the sample does not show how far off it may be.
struct Estimate {
    double value = 0;
    std::optional<double> low, high;
    bool exact = false;

    [[nodiscard]] double lowest() const { return exact ? value : low.value_or(-infinity); }
    [[nodiscard]] double highest() const { return exact ? value : high.value_or(infinity); }

private:
    static constexpr double infinity = std::numeric_limits<double>::infinity();
};

/// How the views of a sample were taken from the camera set's.
enum class Sampling {
    whole, ///< all of them, with all rays that the paper's images have: nothing is left to chance
    even,  ///< spread evenly over the set, or all of them with fewer rays
    chosen ///< otherwise: they say nothing about the others, and estimates from them are without bounds
};

/// Whether views (ascending numbers below population) are spread evenly: no gap, those at the ends included, is longer
/// than twice the mean.
[[nodiscard]] bool is_even(const std::vector<std::uint32_t>& views, std::size_t population);

/// Fewer views than these bound nothing: of the bootstrap's intervals at a nominal 95 %, 84 % hold the truth at 5
/// views, 88 % at 8 (normal variables).
inline constexpr std::size_t min_views = 10;

/// The mean of counts, one a view, as an estimate of the mean over the whole set.
/// whole: exact. even: percentile bootstrap over the views (2,000 resamples, fixed seed), without a correction for the
/// finite population, which errs on the safe side. A sample without any count gives no upper bound: the views left out
/// may hold any number. Throws Error{internal} for no counts.
[[nodiscard]] Estimate mean_count(const std::vector<double>& counts, Sampling sampling);

/// The median of numbers, one a view, as an estimate of the median over the whole set: its bounds are the order
/// statistics that the sign test leaves, whatever the distribution; at 10 views the second and the ninth.
/// Throws Error{internal} for no numbers.
/// Source: Conover, "Practical Nonparametric Statistics" (1971), confidence intervals for a quantile.
[[nodiscard]] Estimate median_of_views(const std::vector<double>& values, Sampling sampling = Sampling::even);

/// The sum of one list over that of another, pairs belonging to one view each: percentile bootstrap over the views.
/// Throws Error{internal} for no pairs, lists of different lengths, or a denominator that is not positive.
[[nodiscard]] Estimate ratio_of_sums(const std::vector<double>& numerator, const std::vector<double>& denominator,
                                     Sampling sampling = Sampling::even);

/// Pearson's correlation with its interval by Fisher's z, which takes the views as independent draws of two normal
/// variables. Empty for fewer than min_views pairs, or if one of the two does not vary.
/// Throws Error{internal} for lists of different lengths.
[[nodiscard]] std::optional<Estimate> correlation(const std::vector<double>& x, const std::vector<double>& y,
                                                  Sampling sampling = Sampling::even);

/// What part of y's mean the line of least squares has at x = 0: none where y is proportional to x. Percentile
/// bootstrap over the pairs. Precondition: as for a correlation that is not empty.
[[nodiscard]] Estimate intercept_share(const std::vector<double>& x, const std::vector<double>& y,
                                       Sampling sampling = Sampling::even);

/// The line of least squares y = slope x + intercept.
struct Line {
    double slope = 0, intercept = 0;
};
/// Precondition: as for a correlation that is not empty.
[[nodiscard]] Line fit_line(const std::vector<double>& x, const std::vector<double>& y);

} // namespace tetrace
