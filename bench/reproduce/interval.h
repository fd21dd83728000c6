#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace tetrace {

/// Coverage that every interval of `reproduce` aims at.
inline constexpr double reproduce_confidence = 0.95;

/// A number estimated from a sample of views, with its 95 % interval. Without bounds it is exact (nothing was left
/// out), or unbounded: the sample says nothing of its spread (one view).
struct Estimate {
    double value = 0;
    std::optional<double> low, high;
    bool exact = false;

    [[nodiscard]] double lowest() const { return exact ? value : low.value_or(-infinity); }
    [[nodiscard]] double highest() const { return exact ? value : high.value_or(infinity); }

private:
    static constexpr double infinity = std::numeric_limits<double>::infinity();
};

/// The mean of counts, one a view, as an estimate of the mean over `population` views.
/// All views: exact. A sample: percentile bootstrap over the views (2,000 resamples, fixed seed), without a correction
/// for the finite population, which errs on the safe side. A sample without any count: from 0 to 3 unit / views, the
/// rule of three (Hanley and Lippman-Hand, "If Nothing Goes Wrong, Is Everything All Right?", JAMA 1983).
/// unit: what one ray adds to a count. Throws Error{internal} for no counts, or more counts than views.
[[nodiscard]] Estimate mean_count(const std::vector<double>& counts, std::size_t population, double unit = 1);

/// The sum of one list over that of another, pairs belonging to one view each: percentile bootstrap over the views.
/// Throws Error{internal} for no pairs, lists of different lengths, or a denominator that is not positive.
[[nodiscard]] Estimate ratio_of_sums(const std::vector<double>& numerator, const std::vector<double>& denominator);

/// Pearson's correlation with its interval by Fisher's z, which takes the views as independent draws of two normal
/// variables. Empty for fewer than 4 pairs, or where one of the two does not vary.
/// Throws Error{internal} for lists of different lengths.
[[nodiscard]] std::optional<Estimate> correlation(const std::vector<double>& x, const std::vector<double>& y);

/// The line of least squares y = slope x + intercept.
struct Line {
    double slope = 0, intercept = 0;
};
/// Precondition: as for a correlation that is not empty.
[[nodiscard]] Line fit_line(const std::vector<double>& x, const std::vector<double>& y);

} // namespace tetrace
