#pragma once

#include "bench/report/html/html.h"

#include <utility>
#include <vector>

namespace tetrace {

struct Series {
    std::string name;
    std::vector<std::pair<double, double>> points; ///< x, y; finite
};

/// Series over a common pair of axes, linear unless told; titles with their units.
struct LineChart {
    std::string label, x_title, y_title;
    std::vector<Series> series;
    bool x_logarithmic = false, y_logarithmic = false;
};

/// A series whose x ascend is drawn as a line, another as a cloud of its shape; its name stands beside its last point.
/// The drawing grows with the number of series, so that every name has its place in it.
/// A linear axis of values that are not negative starts at zero, unless they fill less than half of it.
/// Precondition: a series has a point; values on a logarithmic axis are positive.
[[nodiscard]] Html draw(const LineChart& chart);

} // namespace tetrace
