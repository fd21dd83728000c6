#pragma once

#include "bench/report/html/html.h"

#include <optional>
#include <vector>

namespace tetrace {

/// A bar of a bar chart: a measured value with its spread.
struct Bar {
    std::string id;       ///< what the mark is called (see svg_mark())
    std::string label;    ///< stands left of the bar
    std::string sublabel; ///< in small letters under it; may be empty
    std::size_t series = 0;
    double value = 0;                 ///< not negative, finite
    std::optional<double> low, high;  ///< the whisker
    std::vector<double> samples = {}; ///< a dot each
    std::string note = {};            ///< behind the value
};

struct BarChart {
    std::string label; ///< what it shows, for who cannot see it
    std::string unit;
    std::vector<Bar> bars; ///< from top to bottom
};

/// Horizontal bars from zero, each with its value written beside it, whisker and samples over it.
/// Precondition: there is a bar.
[[nodiscard]] Html draw(const BarChart& chart);

/// A ratio with its interval.
struct Interval {
    std::string id, label, sublabel;
    std::size_t series = 0;
    double value = 0, low = 0, high = 0; ///< positive, finite
};

struct IntervalChart {
    std::string label;
    std::string below, above; ///< what a ratio below, above 1 means
    std::vector<Interval> intervals;
};

/// Dots with intervals on a logarithmic axis (a linear one where all lie close together), with a line at 1. A dot whose
/// interval holds 1, which tells no difference, is hollow. Precondition: there is an interval.
[[nodiscard]] Html draw(const IntervalChart& chart);

} // namespace tetrace
