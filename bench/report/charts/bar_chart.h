#pragma once

#include "bench/report/html/html.h"

#include <optional>
#include <vector>

namespace tetrace {

/// A bar of a bar chart: a measured value with its spread.
struct Bar {
    std::string id;       ///< name of the mark (see svg_mark())
    std::string label;    ///< left of the bar
    std::string sublabel; ///< in small letters under it; may be empty
    std::size_t series = 0;
    double value = 0;                 ///< not negative, finite
    std::optional<double> low, high;  ///< the whisker
    std::vector<double> samples = {}; ///< one dot each
    std::string note = {};            ///< after the value
};

struct BarChart {
    std::string label; ///< description for readers who cannot see it
    std::string unit;
    std::vector<Bar> bars; ///< from top to bottom
};

/// Horizontal bars from zero, each with its value to its right, and with whisker and samples drawn over it.
/// Precondition: there is at least one bar.
[[nodiscard]] Html draw(const BarChart& chart);

/// A ratio with its interval.
struct Interval {
    std::string id, label, sublabel;
    std::size_t series = 0;
    double value = 0, low = 0, high = 0; ///< positive, finite
    bool noisy = false;                  ///< not to be relied on, whatever the interval
};

struct IntervalChart {
    std::string label;
    std::string below, above; ///< what a ratio below 1, and above 1, means
    std::vector<Interval> intervals;
};

/// Dots with intervals on a logarithmic axis (a linear one where all are close together), with a line at 1. A dot
/// that shows no difference, since its interval contains 1 or it is noisy, is hollow. Precondition: there is at least
/// one interval.
[[nodiscard]] Html draw(const IntervalChart& chart);

} // namespace tetrace
