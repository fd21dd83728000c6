#pragma once

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

} // namespace tetrace
